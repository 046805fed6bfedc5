//! Error messages of `check` that state a mistake, its reason and its remedy.

use super::declare::DeclaredGroup;
use super::spec::{Configuration, Spec};
use crate::algebra::Rational;
use crate::diagnostic::{Diagnostic, Place, article};
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{Letter, Shift};
use crate::syntax::ast::Name;

/// A shape in the user's notation.
pub fn shape_text(symbols: &Symbols, shape: Shape) -> String {
    let dim = |d| symbols.dim_text(d);
    if shape.is_scalar() {
        "a number".to_owned()
    } else if shape.is_vector() {
        format!("a vector of length {}", dim(shape.rows))
    } else {
        let (rows, cols) = (dim(shape.rows), dim(shape.cols));
        format!("{} {rows} x {cols} matrix", article(&rows))
    }
}

/// The error for an expression with more nodes than allowed; `lets` says whether the model has `let` definitions.
pub fn too_large(place: Place, size: u32, largest: u32, lets: bool) -> Diagnostic {
    let d = Diagnostic::new(
        place,
        format!(
            "this expression is too large: it has {size} quantities, numbers and operations, and the limit is {largest}"
        ),
    );
    let d = d.help("use fewer terms or bodies, or turn parts of the expression into parameters");
    match lets {
        true => d.help("a `let` counts in full wherever it is used"),
        false => d,
    }
}

/// The error for a model that exceeds the work limit while names and shapes are checked.
pub fn too_much_work(place: Place, excess: Option<String>) -> Diagnostic {
    let excess = excess.map(|e| format!(": {e}")).unwrap_or_default();
    Diagnostic::new(place, format!("this model is too large to derive{excess}"))
        .of_size()
        .help("shorten it, or turn parts of it into parameters")
}

pub fn no_lagrangian(place: Place) -> Diagnostic {
    Diagnostic::new(place, "the model has no Lagrangian").help(
        "add `lagrangian = ...;`, the discrete Lagrangian of one step, for example `-tr(J*Ω)/h`",
    )
}

pub fn second_lagrangian(place: Place) -> Diagnostic {
    Diagnostic::new(place, "the model has two Lagrangians").help("add them up in one statement")
}

pub fn assumption_not_constant(place: Place) -> Diagnostic {
    Diagnostic::new(
        place,
        "an assumption may contain parameters only, and this one changes in time",
    )
    .help("remove the moving quantities, or write the relation as the definition of an advected quantity")
}

pub fn scale_not_constant(place: Place) -> Diagnostic {
    Diagnostic::new(
        place,
        "`scale` must be a non-zero number that depends on the step and parameters only",
    )
    .help("for the normalisation of rigid bodies in the thesis, write `scale -h;`")
}

pub fn definition_not_of_configuration(place: Place) -> Diagnostic {
    Diagnostic::new(
        place,
        "a definition may contain only the configuration and parameters, at the same node",
    )
    .help("write for example `advected Γ: Vec<3> = Λ^T * z;`")
}

pub fn missing_constraint(
    symbols: &Symbols,
    quantity: SymbolId,
    velocity: SymbolId,
    place: Place,
) -> Diagnostic {
    let q = symbols.get(quantity);
    let (name, v) = (&q.name, &symbols.get(velocity).name);
    let example = match q.role {
        Role::Element => format!("constraint next({name}) = {name} * {v};"),
        _ if q.shape.is_vector() => format!("constraint next({name}) = {v}^T * {name};"),
        _ => format!("constraint next({name}) = {v}^T * {name} * {v};"),
    };
    Diagnostic::new(place, format!("`{name}` has no evolution constraint")).help(format!(
        "add its Clebsch constraint, for example `{example}`"
    ))
}

/// The error for a quantity without a constraint, in a model that has only fields.
pub fn not_carried_by_field(
    symbols: &Symbols,
    quantity: SymbolId,
    field: SymbolId,
    place: Place,
) -> Diagnostic {
    let (q, x) = (symbols.get(quantity), symbols.get(field));
    let (name, field) = (&q.name, &x.name);
    let example = match q.shape == x.shape {
        true => format!("constraint next({name}) = {name} + (next({field}) - {field});"),
        false => format!("constraint next({name}) = {name};"),
    };
    Diagnostic::new(
        place,
        format!("`{name}` has no evolution constraint"),
    )
    .help(format!(
        "add a constraint, for example `{example}`; if `{name}` is a function of `{field}`, write it in terms of `{field}` in \
         the Lagrangian instead"
    ))
}

/// The error for the constraint of a field, which must not have one.
pub fn constraint_of_field(name: &str, place: Place) -> Diagnostic {
    Diagnostic::new(
        place,
        format!("a field cannot have a constraint: every entry of `{name}` moves freely, by its increment `next({name}) - \
            {name}`"),
    )
    .help(format!(
        "remove the constraint: the Lagrangian determines the increment, through the kinetic energy in `next({name}) - {name}`"
    ))
    .help("to multiply a configuration by its velocity, declare it with `group`")
}

pub fn not_a_reconstruction(symbols: &Symbols, g: &DeclaredGroup, place: Place) -> Diagnostic {
    let (e, v) = (&symbols.get(g.element).name, &symbols.get(g.velocity).name);
    Diagnostic::new(
        place,
        format!("the constraint of the configuration `{e}` must multiply it by its velocity `{v}` on one side"),
    )
    .help(format!("write `constraint next({e}) = {e} * {v};` (body) or `constraint next({e}) = {v} * {e};` (spatial)"))
}

pub fn unused_velocity(spec: &Spec, c: &Configuration) -> Diagnostic {
    let v = &spec.symbols.get(c.velocity).name;
    if c.group.is_additive() {
        let x = &spec.symbols.get(c.element).name;
        let example = c.group.kinetic_example(x);
        let d = Diagnostic::new(
            spec.lagrangian_place,
            format!("`next({x})` does not appear in the Lagrangian, so a step cannot be solved for `{x}`"),
        )
        .help(format!("add a kinetic term, for example `{example}`"));
        // The Lagrangian may contain the increment of another field, multiplied by this field at the start of the step.
        let used = crate::expr::letters(&spec.lagrangian);
        let stands = |element, shift| used.iter().any(|l| l.symbol == element && l.shift == shift);
        let mut others = spec.configurations.iter();
        let other = others.find(|o| o.group.is_additive() && stands(o.element, Shift::NEXT));
        return match other.filter(|_| stands(c.element, Shift::HERE)) {
            Some(other) => {
                let y = &spec.symbols.get(other.element).name;
                d.help(format!("a product with the increment of `{y}` needs both ends of `{x}`: write `({x} + next({x}))/2` \
                    times `next({y}) - {y}`"))
            }
            None => d,
        };
    }
    Diagnostic::new(
        spec.lagrangian_place,
        format!(
            "the velocity `{v}` does not appear in the Lagrangian, so its motion is not determined"
        ),
    )
    .help(format!("add a kinetic term, for example `-tr(J*{v})/h`"))
}

/// Time levels of the edge of one step.
pub const EDGE: core::ops::RangeInclusive<i8> = 0..=1;

pub fn shift_too_far(place: Place, symbols: &Symbols, letter: Letter) -> Diagnostic {
    let x = &symbols.get(letter.symbol).name;
    let before = letter.shift.time < *EDGE.start();
    let (which, written) = match before {
        true => ("an earlier", format!("prev({x})")),
        false => ("a later", format!("next(next({x}))")),
    };
    let d = Diagnostic::new(
        place,
        format!(
            "`{written}` belongs to {which} step: the Lagrangian of one step has `{x}` at its start and `next({x})` at its end"
        ),
    );
    d.help(match before {
        true => format!("shift the term by one step: write `{x}` for `prev({x})` and `next({x})` for `{x}`"),
        false => format!("shift the term by one step: write `next({x})` for `next(next({x}))` and `{x}` for `next({x})`"),
    })
}

pub fn shifted_velocity(place: Place, velocity: &str) -> Diagnostic {
    Diagnostic::new(
        place,
        format!(
            "the velocity `{velocity}` belongs to its edge and cannot be shifted to another edge"
        ),
    )
    .help(format!(
        "write `{velocity}` for the velocity of the step from k to k+1"
    ))
}

/// The error for `v^2` of a vector.
pub fn power_of_vector(place: Place, what: &str, q: Rational) -> Diagnostic {
    let two = Rational::integer(2);
    let d = Diagnostic::new(
        place,
        format!("only numbers and square matrices have powers; this is {what}"),
    );
    match q == two {
        true => d.help("for the square of the length, write `dot(a, a)`"),
        false => d.help("for a power of the length, take a power of a number: `dot(a, a)` is the square, `dot(a, a)^2` the \
            fourth power"),
    }
}

/// The meaning of a word of the language, for words that are easily taken for names.
fn meaning(word: &str) -> Option<&'static str> {
    Some(match word {
        "Id" => "the identity matrix",
        "T" => "the transpose, as in `A^T`",
        "E1" | "E2" | "E3" => "a unit vector along an axis",
        "re" | "im" => "a function, a part of a quaternion",
        "sum" => "a function, the sum over sites",
        "rate" => "a function, the rate of change",
        "tr" | "Tr" => "a function, the trace",
        _ => return None,
    })
}

/// The error for a name that is reserved by the language.
pub fn reserved(name: &Name) -> Diagnostic {
    let word = name.text.as_str();
    let means = meaning(word).unwrap_or("a function");
    let message = format!("`{word}` has a fixed meaning in the language: it is {means}");
    Diagnostic::new(name.place, message).help(match word {
        "T" => "choose another name, for example `K` for a kinetic energy",
        _ => "choose another name",
    })
}

/// The error for a constraint with values at both ends of a step; `end` if all values are at the end.
pub fn held_over_the_step(place: Place, end: bool) -> Diagnostic {
    if end {
        let message = "a `hold` constraint applies at one node, and this one contains `next(...)`";
        return Diagnostic::new(place, message)
            .help("remove `next`: the constraint applies at every node");
    }
    let message = "this constraint contains `next(...)`, so it constrains velocities: nonholonomic constraints are not \
        supported yet";
    Diagnostic::new(place, message).help(
        "if it is the increment of a function of the configuration, constrain that function: for `next(x) - x = r*(next(φ) - \
         φ)`, write `hold λ: x - r*φ = c;`",
    )
}
