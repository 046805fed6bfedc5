//! Constraints `hold λ: a = b;`: the quantities that they may contain, and the shape of their multiplier. Faulty
//! constraints are errors with the tokens where they occur.

use super::declare::Declared;
use super::messages::{self, shape_text};
use super::spec::{Hold, Spec};
use crate::algebra::Algebra;
use crate::diagnostic::{Diagnostic, Errors, Place};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Shift};
use crate::syntax::ast::Name;

/// Checks a constraint; its multiplier becomes a symbol of the model.
pub(super) fn hold(
    declared: &mut Declared,
    name: &Name,
    (left, right): (Expr, Expr),
    place: Place,
    largest: u32,
    errors: &mut Errors,
) -> Option<Hold> {
    let value = entries(&declared.symbols, expr::sub(left.clone(), right.clone()));
    if value.size() > largest {
        errors.push(messages::too_large(place, value.size(), largest, true));
        return None;
    }
    if let Some(refused) = refused(&declared.symbols, name, &value, place) {
        errors.push(refused);
        return None;
    }
    if !declared.admit(name, errors) {
        return None;
    }
    let shape = value.shape();
    let multiplier = declared
        .symbols
        .add(&name.text, shape, Structure::General, Role::Multiplier);
    declared.symbols.describe(multiplier, name.latex(), &[]);
    Some(Hold {
        multiplier,
        left,
        right,
        value,
        place,
        name_place: name.place,
    })
}

/// The independent entries of a matrix as one vector: for a symmetric matrix the entries on and above the diagonal,
/// row by row; for a skew matrix its axial vector or the entries below the diagonal; otherwise all entries. Scalars
/// and vectors are unchanged.
fn entries(symbols: &Symbols, value: Expr) -> Expr {
    let shape = value.shape();
    let (Dim::Fixed(rows), Dim::Fixed(cols)) = (shape.rows, shape.cols) else {
        return value;
    };
    if shape.is_scalar() || shape.is_vector() {
        return value;
    }
    let (Ok(rows), Ok(cols)) = (u8::try_from(rows), u8::try_from(cols)) else {
        return value;
    };
    let algebra = Algebra::new(symbols);
    let flipped = || expr::transpose(symbols, value.clone());
    let square = shape.is_square();
    let symmetric = square && algebra.is_zero(&expr::sub(value.clone(), flipped()));
    let skew = square && !symmetric && algebra.is_zero(&expr::add(value.clone(), flipped()));
    if skew && rows == 3 {
        return expr::vee(value);
    }
    let wanted = |i: u8, j: u8| match (symmetric, skew) {
        (true, _) => i <= j,
        (_, true) => i > j,
        _ => true,
    };
    let all = (0..rows).flat_map(|i| (0..cols).map(move |j| (i, j)));
    let all: Vec<(u8, u8)> = all.filter(|(i, j)| wanted(*i, *j)).collect();
    let Ok(count) = u8::try_from(all.len()) else {
        return value;
    };
    let count = Dim::Fixed(u32::from(count));
    let each = (0..).zip(all).map(|(k, (i, j))| {
        let column = expr::mul(value.clone(), expr::unit(shape.cols, j));
        let entry = expr::dot(expr::unit(shape.rows, i), column);
        expr::mul(entry, expr::unit(count, k))
    });
    expr::sum(each.collect::<Vec<_>>(), Shape::vector(count))
}

/// Rejects constraints that depend on time: their rate of change would have a part that does not depend on
/// velocities.
pub(super) fn without_clocks(spec: &Spec) -> Result<(), Errors> {
    let clocks = spec.clocks();
    let mut errors = Errors::new();
    for hold in &spec.holds {
        let letters = expr::letters(&hold.value);
        let Some(clock) = letters.iter().find(|l| clocks.contains(&l.symbol)) else {
            continue;
        };
        let name = &spec.symbols.get(clock.symbol).name;
        let message = format!(
            "`{name}` advances with the step by itself, and a `hold` constraint must not depend on time: no velocity could \
             satisfy it"
        );
        errors.push(Diagnostic::new(hold.place, message).help(format!(
            "drive the configuration by a stiff spring, as in `-h*(K/2)*(x - A*sin(w*{name}))^2`, or constrain it to a field \
             that clebsch solves for"
        )));
    }
    errors.propagate()
}

/// The error in the equation, if there is one.
fn refused(symbols: &Symbols, name: &Name, value: &Expr, place: Place) -> Option<Diagnostic> {
    let letters = expr::letters(value);
    let role = |r: Role| letters.iter().find(|l| symbols.get(l.symbol).role == r);
    if let Some(v) = role(Role::Velocity) {
        let message = format!(
            "`{}` is a velocity, and a `hold` constraint may contain only configurations at a node",
            symbols.get(v.symbol).name
        );
        return Some(Diagnostic::new(place, message).help(
            "constrain the configuration, for example `hold λ: dot(x, x) = L^2;`; clebsch constrains its rate of change too. \
             Nonholonomic constraints are not supported yet",
        ));
    }
    if letters.iter().any(|l| l.shift != Shift::HERE) {
        let mut moving = letters.iter().filter(|l| {
            let role = symbols.get(l.symbol).role;
            matches!(role, Role::Element | Role::Advected)
        });
        let end = moving.all(|l| l.shift == Shift::NEXT);
        return Some(messages::held_over_the_step(place, end));
    }
    let algebra = Algebra::new(symbols);
    if algebra.is_zero(value) {
        let message = format!(
            "both sides of the constraint of `{}` are equal, so its multiplier is undetermined",
            name.text
        );
        return Some(
            Diagnostic::new(place, message)
                .help("remove the constraint, or correct one of its sides"),
        );
    }
    if role(Role::Element)
        .or_else(|| role(Role::Advected))
        .is_none()
    {
        let message = format!(
            "the constraint of `{}` contains no configuration, so it constrains nothing",
            name.text
        );
        return Some(Diagnostic::new(place, message).help(
            "a `hold` constraint must contain a configuration, for example `hold λ: det(Q) = 1;`; write a condition on \
             parameters with `assume`",
        ));
    }
    let shape = value.shape();
    if !shape.is_scalar() && !shape.is_vector() {
        let message = format!(
            "this constraint is {}, but a multiplier must be a number or a vector",
            shape_text(symbols, shape)
        );
        return Some(Diagnostic::new(place, message).help(
            "constrain independent entries, each with its own multiplier: `hold a: dot(Q*E1, Q*E1) = 1;`, `hold b: dot(Q*E1, \
             Q*E2) = 0;`; write a column as `A*E1`",
        ));
    }
    None
}
