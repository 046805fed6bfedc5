//! Reserved names of functions of the stepper and its state. Configurations and advected quantities become functions
//! of the state, so they cannot have these names. Parameters and velocities become fields and local variables, so
//! they can.

use super::declare::Declared;
use crate::diagnostic::{Diagnostic, Errors, Place};
use crate::expr::shape::Shape;
use crate::expr::symbol::Symbols;

/// Methods and constants of every model.
const MEMBERS: [&str; 46] = [
    "kinetic_warning",
    "ADMITTED",
    "CARD",
    "FINGERPRINT",
    "SOURCE",
    "advance",
    "advance_many",
    "at_node",
    "at_node_0",
    "attempt",
    "balance",
    "begin",
    "discrete_energy",
    "domain_arguments",
    "edge",
    "edge_momentum",
    "energies",
    "energy",
    "factor_at",
    "left_domain",
    "new",
    "node",
    "open",
    "invariants",
    "observe",
    "parameters",
    "prepared",
    "refused",
    "scales",
    "sized",
    "start",
    "start_of_order",
    "start_with",
    "stays_inside",
    "step",
    "step_untested",
    "with_solver",
    "workspace",
    "workspace_with",
    "arrived",
    "is_defined",
    "principal",
    "residual_at",
    "rounding",
    "settled",
    "tangent_at",
];

/// Momenta at a node, and the rounding remainders of a position and of a momentum. If there are several
/// configurations, the name of the element is appended to each.
const MOMENTA: [&str; 5] = [
    "momentum",
    "body_momentum",
    "spatial_momentum",
    "place_rest",
    "momentum_rest",
];

/// The error for a name that is also a function of the stepper or of its state.
pub(crate) fn name_of_function(name: &str, place: Place) -> Diagnostic {
    Diagnostic::new(
        place,
        format!("`{name}` is already the name of a function of the stepper or of its state"),
    )
    .help(format!(
        "choose another name, for example `{name}1`; a parameter may be called `{name}`"
    ))
}

/// Rejects configurations and advected quantities with such names.
pub(super) fn refuse(declared: &Declared, errors: &mut Errors) {
    let s = &declared.symbols;
    let elements = declared.configurations.iter().map(|c| (c.element, c.place));
    let advected = declared.advected.iter().map(|a| (a.quantity, a.place));
    let momenta: Vec<String> = match declared.configurations.as_slice() {
        [_] => MOMENTA.map(str::to_owned).to_vec(),
        several => several
            .iter()
            .flat_map(|c| MOMENTA.map(|base| format!("{base}_{}", s.get(c.element).name)))
            .collect(),
    };
    for (id, place) in elements.chain(advected) {
        let name = &s.get(id).name;
        if MEMBERS.contains(&name.as_str()) || momenta.contains(name) {
            errors.push(name_of_function(name, place));
        } else if is_column(&s.get(id).ascii) {
            errors.push(name_of_column(name, place));
        }
    }
    components(declared, errors);
}

/// Whether the files of every run have a column of this name besides the columns of the model.
fn is_column(ascii: &str) -> bool {
    ascii == "time" || ascii.starts_with("invariant_")
}

/// The error for a name that is also another column of a run's files.
fn name_of_column(name: &str, place: Place) -> Diagnostic {
    Diagnostic::new(
        place,
        format!("the output files already have a column named `{name}`"),
    )
    .help(format!("choose another name, for example `{name}1`"))
}

/// Rejects names that are also names of components: `x_1` next to a vector `x`.
fn components(declared: &Declared, errors: &mut Errors) {
    let s = &declared.symbols;
    let elements = declared.configurations.iter().map(|c| (c.element, c.place));
    let advected = declared.advected.iter().map(|a| (a.quantity, a.place));
    let all: Vec<_> = elements.chain(advected).collect();
    for (id, place) in &all {
        let Some((stem, digits)) = s.get(*id).ascii.rsplit_once('_') else {
            continue;
        };
        // For a quantity with components, the columns have longer names.
        if !s.get(*id).shape.is_scalar() {
            continue;
        }
        let whole = all.iter().find(|(other, _)| {
            let own = s.get(*other);
            own.ascii == stem && is_component(digits, own.shape, s)
        });
        if let Some((whole, _)) = whole {
            let name = &s.get(*id).name;
            let of = &s.get(*whole).name;
            errors.push(
                Diagnostic::new(
                    *place,
                    format!("the output files name component {digits} of `{of}` `{name}`, so they would have two columns of \
                        that name"),
                )
                .help(format!("choose another name, for example `{stem}{digits}`")),
            );
        }
    }
}

/// Whether these digits are the index of a vector component, or the row and column of a matrix entry.
fn is_component(digits: &str, shape: Shape, s: &Symbols) -> bool {
    let [rows, cols] = [shape.rows, shape.cols].map(|dim| s.sizes(dim).1);
    let number = |text: &str, most: usize| {
        let number = text.parse::<usize>();
        number.is_ok_and(|number| (1..=most).contains(&number))
    };
    match (shape.is_scalar(), cols, digits.split_at_checked(1)) {
        (true, ..) => false,
        (_, 1, _) => number(digits, rows),
        (_, _, Some((row, column))) => number(row, rows) && number(column, cols),
        _ => false,
    }
}
