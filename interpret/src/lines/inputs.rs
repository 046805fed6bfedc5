//! The input from which a chain is built and started: fills the structs of the emitted program from lists of numbers.
//! Takes the types that emission declares; gives values of these types.

use super::Unstarted;
use crate::functional::Extent;
use crate::lower::Shared;
use crate::program::type_name;
use crate::sites::Column;
use crate::value::{Frame, Layout, Struct, Value};
use crate::{Refused, text};
use clebsch::card::OpenError;
use clebsch::linalg::Dense;
use clebsch::line::{LineError, Place};
use clebsch::mesh::{Domain, Wall};
use clebsch::of_numbers::OfNumbers;
use clebsch::{ParameterError, StartError};
use clebsch_core::lattice::ChainConfig;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Returns the numbers of a quantity by its name in the emitted code: one site after the other, matrices in row-major
/// order.
pub type Numbers<'a> = dyn Fn(&str) -> Option<Vec<f64>> + 'a;

/// The form in which a field is read.
#[derive(Clone, Debug)]
enum FieldForm {
    /// An array of rows and columns.
    Array(usize, usize),
    /// A number.
    Number,
    /// A rotation, from its matrix.
    Rotation,
    /// A unit quaternion, from its components.
    Quaternion,
    /// A momentum of three components in the body.
    Momentum,
    /// A value of this kind for every site.
    Sites(Box<FieldForm>),
    /// The end conditions.
    Ends,
    /// A number of sites.
    Count,
    /// Numbers that are f64 for any scalar.
    Doubles(usize),
    /// Cells along each direction.
    Cells(usize),
    /// A box with its walls: lengths along each direction, then 1 for each with walls, 0 for each without.
    Box(usize),
    /// No value.
    Marker,
}

/// A struct of input data.
#[derive(Clone, Debug)]
pub struct InputStruct {
    layout: Arc<Layout>,
    fields: Vec<(String, FieldForm)>,
}

/// The arguments of a generic type.
fn arguments(ty: &syn::Type) -> Vec<&syn::GenericArgument> {
    let syn::Type::Path(path) = ty else {
        return Vec::new();
    };
    match path.path.segments.last().map(|s| &s.arguments) {
        Some(syn::PathArguments::AngleBracketed(list)) => list.args.iter().collect(),
        _ => Vec::new(),
    }
}

/// The sizes among the arguments of a type.
pub fn sizes(ty: &syn::Type) -> Vec<usize> {
    let none = BTreeMap::new();
    let sizes = arguments(ty).into_iter().filter_map(|a| match a {
        syn::GenericArgument::Const(e) => crate::lower::constant(e, &none),
        _ => None,
    });
    sizes.collect()
}

fn read(ty: &syn::Type) -> Option<FieldForm> {
    let none = BTreeMap::new();
    let sizes = sizes(ty);
    if let syn::Type::Array(array) = ty {
        let size = crate::lower::constant(&array.len, &none)?;
        return match type_name(&array.elem)?.as_str() {
            "f64" => Some(FieldForm::Doubles(size)),
            "usize" => Some(FieldForm::Cells(size)),
            _ => None,
        };
    }
    Some(match (type_name(ty)?.as_str(), sizes.as_slice()) {
        ("Domain", [size]) => FieldForm::Box(*size),
        ("T" | "f64", _) => FieldForm::Number,
        ("SMatrix", [rows, cols]) => FieldForm::Array(*rows, *cols),
        ("SVector", [rows]) => FieldForm::Array(*rows, 1),
        ("Rotation", _) => FieldForm::Rotation,
        ("UnitQuaternion", _) => FieldForm::Quaternion,
        ("BodyMomentum", _) => FieldForm::Momentum,
        ("usize", _) => FieldForm::Count,
        ("PhantomData", _) => FieldForm::Marker,
        ("Vec", _) => match arguments(ty).first()? {
            syn::GenericArgument::Type(inner) => FieldForm::Sites(Box::new(read(inner)?)),
            _ => return None,
        },
        (name, _) if name.ends_with("Ends") => FieldForm::Ends,
        _ => return None,
    })
}

/// A box of one or two directions, each of which ends in walls or is periodic.
pub(crate) fn extent(lengths: &[f64], solid: &[bool]) -> Option<Extent> {
    let wall = |solid: &bool| match solid {
        true => Wall::Solid,
        false => Wall::Periodic,
    };
    Some(match (lengths, solid) {
        ([length], [w]) => Extent::Line(Domain {
            lengths: [*length],
            walls: [wall(w)],
        }),
        ([width, height], [w, v]) => Extent::Plane(Domain {
            lengths: [*width, *height],
            walls: [wall(w), wall(v)],
        }),
        _ => return None,
    })
}

/// Converts the result of reading a value. If the value is not valid, the error names the parameter.
fn opened<X>(
    name: &'static str,
    read: Result<X, OpenError>,
    told: fn(X) -> Value<f64>,
) -> Result<Value<f64>, ParameterError> {
    match read {
        Ok(x) => Ok(told(x)),
        Err(OpenError::Start(StartError::Initial(e)) | OpenError::Parameter(e)) => Err(e),
        Err(_) => clebsch::validate::finite(name, &[f64::NAN]).map(|()| Value::Unit),
    }
}

impl FieldForm {
    fn count(&self) -> usize {
        match self {
            FieldForm::Array(rows, cols) => rows * cols,
            FieldForm::Rotation => 9,
            FieldForm::Quaternion => 4,
            FieldForm::Momentum => 3,
            FieldForm::Doubles(size) | FieldForm::Cells(size) => *size,
            FieldForm::Box(size) => 2 * size,
            _ => 1,
        }
    }

    /// The value at one site, or at all sites.
    fn one(&self, name: &'static str, list: &[f64]) -> Result<Value<f64>, ParameterError> {
        let matrix = |rows, cols| {
            let entry = |i: usize, j: usize| list.get(i * cols + j).copied().unwrap_or(f64::NAN);
            Value::of(Dense::from_fn(rows, cols, entry))
        };
        Ok(match self {
            FieldForm::Array(rows, cols) => matrix(*rows, *cols),
            FieldForm::Number => Value::Real(list.first().copied().unwrap_or(f64::NAN)),
            FieldForm::Rotation => {
                opened(name, OfNumbers::of_numbers(name, list), Value::Rotation)?
            }
            FieldForm::Quaternion => {
                let read = OfNumbers::of_numbers(name, list);
                opened(name, read, Value::Quaternion)?
            }
            FieldForm::Momentum => {
                let v = nalgebra::Vector3::from_fn(|i, _| list.get(i).copied().unwrap_or(f64::NAN));
                Value::Momentum(Frame::Body, v)
            }
            FieldForm::Doubles(_) => Value::List(list.iter().map(|x| Value::Double(*x)).collect()),
            FieldForm::Cells(_) => {
                let cells = list.iter().map(|x| Value::Int(*x as i64));
                Value::List(cells.collect())
            }
            FieldForm::Box(size) => {
                let (lengths, walls) = list.split_at((*size).min(list.len()));
                let solid: Vec<bool> = walls.iter().map(|x| *x != 0.0).collect();
                match extent(lengths, &solid) {
                    Some(extent) => Value::Extent(extent),
                    None => Value::Unit,
                }
            }
            _ => Value::Unit,
        })
    }

    fn of(&self, name: &str, numbers: &Numbers<'_>) -> Result<Value<f64>, Unstarted> {
        let list = numbers(name).ok_or_else(|| Unstarted::Missing(name.to_owned()))?;
        let fits = |count: usize| match list.len() == count {
            true => Ok(()),
            false => Err(Unstarted::Components {
                quantity: name.to_owned(),
                components: self.count(),
                found: list.len(),
            }),
        };
        let FieldForm::Sites(inner) = self else {
            fits(self.count())?;
            let value = self.one(text(name), &list);
            return value.map_err(|e| Unstarted::Line(e.into()));
        };
        let size = inner.count();
        let sites = list.len() / size;
        fits(sites * size)?;
        Ok(Value::Sites(match &**inner {
            FieldForm::Number => Column::Numbers(list),
            FieldForm::Array(rows, cols) => Column::of_rows([*rows, *cols], &list),
            inner => {
                let name = text(name);
                let mut all = Vec::with_capacity(sites);
                for (site, one) in list.chunks_exact(size).enumerate() {
                    let at = Place {
                        quantity: name,
                        site,
                    };
                    let value = inner.one(name, one);
                    all.push(value.map_err(|error| LineError::Site { at, error })?);
                }
                Column::Values(all)
            }
        }))
    }
}

impl InputStruct {
    /// The struct of this name.
    pub fn named(shared: &mut Shared<'_>, name: &str) -> Result<Self, Refused> {
        let layout = shared.layout(name)?;
        let declared = shared.program.structs.get(name);
        let fields = declared.into_iter().flatten().map(|(field, ty)| {
            let unknown = || Refused::Construct(format!("the type of `{field}`"));
            Ok((field.clone(), read(ty).ok_or_else(unknown)?))
        });
        Ok(InputStruct {
            layout,
            fields: fields.collect::<Result<_, Refused>>()?,
        })
    }

    /// The fields that describe the domain of particles, with the number of their components.
    pub fn space(&self) -> impl Iterator<Item = (&str, usize)> {
        self.fields.iter().filter_map(|(name, read)| match read {
            FieldForm::Doubles(_) | FieldForm::Cells(_) | FieldForm::Box(_) => {
                Some((name.as_str(), read.count()))
            }
            _ => None,
        })
    }

    /// The names of its fields, and whether the values of a field are elements of a group.
    pub fn names(&self) -> impl Iterator<Item = (&str, bool)> {
        self.fields.iter().map(|(name, read)| {
            let of_site = match read {
                FieldForm::Sites(inner) => inner,
                other => other,
            };
            let is_element = matches!(of_site, FieldForm::Rotation | FieldForm::Quaternion);
            (name.as_str(), is_element)
        })
    }

    /// The value of one of its fields.
    pub fn one(&self, field: &str, numbers: &Numbers<'_>) -> Result<Value<f64>, Unstarted> {
        let own = self.fields.iter().find(|(name, _)| name == field);
        match own {
            Some((name, read)) => read.of(name, numbers),
            None => Err(Unstarted::Missing(field.to_owned())),
        }
    }

    /// The struct as a value. `other` supplies the fields that are not numbers.
    pub fn value(
        &self,
        numbers: &Numbers<'_>,
        other: &dyn Fn(&str) -> Option<Value<f64>>,
    ) -> Result<Value<f64>, Unstarted> {
        let values = self.fields.iter().map(|(name, read)| match read {
            FieldForm::Marker => Ok(Value::Unit),
            FieldForm::Count | FieldForm::Ends => {
                other(name).ok_or_else(|| Unstarted::Missing(name.clone()))
            }
            read => read.of(name, numbers),
        });
        Ok(Value::Struct(Struct {
            layout: self.layout.clone(),
            values: values.collect::<Result<_, _>>()?,
        }))
    }
}

/// The structs of all end conditions of a chain.
#[derive(Clone, Debug, Default)]
pub struct Ends {
    /// The variants of both ends, in order.
    alternatives: [Vec<InputStruct>; 2],
    open: Option<InputStruct>,
    ring: Option<InputStruct>,
}

impl Ends {
    /// The end conditions of a model.
    pub fn of(shared: &mut Shared<'_>, name: &str) -> Result<Self, Refused> {
        let mut ends = Ends::default();
        for (at, suffix) in ["First", "Last"].into_iter().enumerate() {
            let owner = format!("{name}{suffix}");
            let order = shared.program.variants.get(&owner).cloned();
            for variant in order.unwrap_or_default() {
                // A variant that only marks the scalar type is not an end condition.
                if let Ok(given) = InputStruct::named(shared, &format!("{owner}::{variant}")) {
                    ends.alternatives[at].push(given);
                }
            }
        }
        let mut variant = |which: &str| {
            let full = format!("{name}Ends::{which}");
            let known = shared.program.structs.contains_key(&full);
            known.then(|| Self::whole(shared, &full)).transpose()
        };
        ends.open = variant("Open")?;
        ends.ring = variant("Ring")?;
        Ok(ends)
    }

    /// A variant whose fields are ends or numbers.
    fn whole(shared: &mut Shared<'_>, name: &str) -> Result<InputStruct, Refused> {
        let layout = shared.layout(name)?;
        let declared = shared.program.structs.get(name);
        let fields = declared.into_iter().flatten().map(|(field, ty)| {
            let read = read(ty).unwrap_or(FieldForm::Ends);
            (field.clone(), read)
        });
        Ok(InputStruct {
            layout,
            fields: fields.collect(),
        })
    }

    /// The chosen end conditions as a value.
    pub fn value(
        &self,
        choice: &ChainConfig,
        numbers: &Numbers<'_>,
    ) -> Result<Value<f64>, Unstarted> {
        let missing = |what: &str| Unstarted::Missing(what.to_owned());
        if choice.periodic {
            let ring = self.ring.as_ref().ok_or_else(|| missing("periodic"))?;
            return ring.value(numbers, &|_| None);
        }
        let chosen = |at: usize| -> Result<Value<f64>, Unstarted> {
            let given = self.alternatives[at].get(choice.ends[at]);
            let given = given.ok_or_else(|| missing(["the first end", "the last end"][at]))?;
            // If both ends have a parameter, its name contains the end, `F_0` or `F_N`.
            let own = |name: &str| {
                let of_end = format!("{name}_{}", ["0", "N"][at]);
                numbers(&of_end).or_else(|| numbers(name))
            };
            given.value(&own, &|_| None)
        };
        let open = self.open.as_ref().ok_or_else(|| missing("ends"))?;
        let mut values = Vec::new();
        for (field, read) in &open.fields {
            values.push(match (field.as_str(), read) {
                ("first", _) => chosen(0)?,
                ("last", _) => chosen(1)?,
                _ => Value::Unit,
            });
        }
        Ok(Value::Struct(Struct {
            layout: open.layout.clone(),
            values,
        }))
    }
}

/// The numbers of sites by the names of their fields.
pub fn counts(names: &[String], choice: &ChainConfig, field: &str) -> Option<Value<f64>> {
    let at = names.iter().position(|name| name == field)?;
    Some(Value::Int(i64::try_from(choice.count(at)).ok()?))
}
