//! Names of functions that every stepper and its state have. A configuration and an advected quantity become
//! functions of the state, and cannot bear one of them; parameters and velocities become fields and
//! locals only, and can.

use super::declare::Declared;
use crate::diagnostic::{Diagnostic, Errors, Place};

/// Methods and constants that every model has.
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

/// Momenta at a node, and what rounding has left of a place and of a
/// momentum; of several configurations each with the
/// name of its element.
const MOMENTA: [&str; 5] = [
    "momentum",
    "body_momentum",
    "spatial_momentum",
    "place_rest",
    "momentum_rest",
];

/// The refusal of a name that a function of the stepper or of its state bears.
pub(crate) fn name_of_function(name: &str, place: Place) -> Diagnostic {
    Diagnostic::new(
        place,
        format!(
            "`{name}` is already a function of the model's stepper or of its state, and this would become another one"
        ),
    )
    .help(format!(
        "choose another name, for example `{name}1`; a parameter may be called `{name}`"
    ))
}

/// Refuses configurations and advected quantities under such names.
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
        }
    }
}
