//! Local coordinates of initial values. A rotation or a rigid motion is moved from the right, by coordinates in the body frame. Every
//! other value is moved entry by entry, within the symmetric, skew or diagonal matrices if it is one of these.

use super::source::Coordinates;
use super::values::{count, map, numbers};
use crate::newton::moved;
use crate::opened::InitialForm;
use crate::sites::Column;
use crate::value::{MatrixGroup, Struct, Value};
use clebsch::Real;
use clebsch::card::{Field, Kind};
use clebsch::linalg::Dense;

/// How an initial value is moved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LocalForm {
    /// A rotation or a rigid motion.
    Element,
    /// A symmetric matrix: entries on and above the diagonal, row by row.
    Symmetric,
    /// A skew matrix: the coordinates of its group.
    Skew,
    /// A diagonal matrix: its diagonal.
    Diagonal,
    /// Any array: all entries, row by row.
    Entries,
}

impl LocalForm {
    /// How each field of a struct is moved. The momentum of a matrix group follows the element of the group.
    pub fn of_fields(forms: &[InitialForm], fields: &[Field]) -> Vec<Self> {
        let mut is_linear = false;
        let each = forms.iter().zip(fields).map(|(form, field)| {
            match form {
                InitialForm::Of("Linear") => is_linear = true,
                InitialForm::Of("Orthogonal") => is_linear = false,
                _ => {}
            }
            LocalForm::of(*form, field, is_linear)
        });
        each.collect()
    }

    fn of(form: InitialForm, field: &Field, is_linear: bool) -> Self {
        match (form, field.kind) {
            (InitialForm::Of("BodyMomentumMatrix" | "SpatialMomentumMatrix"), _) => match is_linear
            {
                true => LocalForm::Entries,
                false => LocalForm::Skew,
            },
            (_, Kind::Skew) => LocalForm::Skew,
            (_, Kind::Symmetric | Kind::SecondMoments) => LocalForm::Symmetric,
            (_, Kind::Diagonal) => LocalForm::Diagonal,
            (
                InitialForm::Of(
                    "Rotation" | "UnitQuaternion" | "RigidMotion" | "PlaneMotion" | "Orthogonal",
                ),
                _,
            ) => LocalForm::Element,
            _ => LocalForm::Entries,
        }
    }
}

/// The number of local coordinates of each initial value.
pub fn dimensions<T: Real>(given: &Value<T>, forms: &[LocalForm]) -> Vec<usize> {
    let Value::Struct(s) = given else {
        return Vec::new();
    };
    let pairs = s.values.iter().zip(forms);
    pairs.map(|(value, form)| dimension(value, *form)).collect()
}

/// The number of local coordinates of a value.
pub fn dimension<T: Real>(value: &Value<T>, form: LocalForm) -> usize {
    // The number of rows of a square matrix.
    let rows = || count(value).isqrt();
    match (value, form) {
        (Value::Sites(column), form) => column.values().map(|v| dimension(&v, form)).sum(),
        (Value::Rotation(_) | Value::Quaternion(_) | Value::Plane(_) | Value::Attitude(_), _) => 3,
        (Value::Motion(_), _) => 6,
        (Value::Element(MatrixGroup::Orthogonal, _), _) | (_, LocalForm::Skew) => {
            rows() * rows().saturating_sub(1) / 2
        }
        (_, LocalForm::Symmetric) => rows() * (rows() + 1) / 2,
        (_, LocalForm::Diagonal) => rows(),
        _ => count(value),
    }
}

/// The initial values moved by local coordinates, in the order of the card. Returns nothing if there are too few coordinates.
pub fn moved_all<T: Real>(
    given: &Value<T>,
    coordinates: &Coordinates,
    xi: &[T],
) -> Option<Value<T>> {
    let Value::Struct(s) = given else {
        return None;
    };
    let pairs = s.values.iter().zip(&coordinates.forms);
    let all = pairs.map(|(value, form)| dimension(value, *form)).sum();
    let mut of_fields = vec![T::zero(); all];
    for (place, x) in coordinates.order.iter().zip(xi) {
        *of_fields.get_mut(*place)? = *x;
    }
    let mut rest = of_fields.as_slice();
    let mut values = s.values.clone();
    for (value, form) in values.iter_mut().zip(&coordinates.forms) {
        let (own, others) = rest.split_at_checked(dimension(value, *form))?;
        rest = others;
        *value = moved_one(value, *form, own)?;
    }
    Some(Value::Struct(Struct {
        layout: s.layout.clone(),
        values,
    }))
}

fn moved_one<T: Real>(value: &Value<T>, form: LocalForm, xi: &[T]) -> Option<Value<T>> {
    if let Value::Sites(column) = value {
        let mut rest = xi;
        let each = column.values().map(|value| {
            let (own, others) = rest.split_at_checked(dimension(&value, form))?;
            rest = others;
            moved_one(&value, form, own)
        });
        let all = each.collect::<Option<Vec<_>>>()?;
        return Some(Value::Sites(match column {
            Column::Values(_) => Column::Values(all),
            _ => Column::of(all)?,
        }));
    }
    if form == LocalForm::Element {
        return moved(value, xi, false);
    }
    let mut all = Vec::new();
    numbers(value, &mut all)?;
    let shape = match value {
        Value::Matrix(_) => [3, 3],
        Value::Dense(a) | Value::Impulse(_, a) | Value::Element(_, a) => [a.rows, a.cols],
        _ => [all.len(), 1],
    };
    let change = change(form, shape, xi);
    let mut by = change.data.iter();
    map(value, &mut |x: T| by.next().map_or(x, |by| x + *by))
}

/// The change of a matrix by coordinates.
fn change<T: Real>(form: LocalForm, [rows, cols]: [usize; 2], xi: &[T]) -> Dense<T> {
    let entry = |k: usize| xi.get(k).copied().unwrap_or(T::zero());
    match form {
        LocalForm::Skew => Dense::skew_from(rows, xi),
        LocalForm::Symmetric => Dense::from_fn(rows, cols, |i, j| {
            let (i, j) = (i.min(j), i.max(j));
            entry(i * rows - i * (i + 1) / 2 + j)
        }),
        LocalForm::Diagonal => Dense::from_fn(rows, cols, |i, j| match i == j {
            true => entry(i),
            false => T::zero(),
        }),
        LocalForm::Element | LocalForm::Entries => {
            Dense::from_fn(rows, cols, |i, j| entry(i * cols + j))
        }
    }
}
