//! Names of emitted items and locals. The model's names stay as written, and no name of the model shadows another
//! emitted name.

use crate::derive::Derivation;
use crate::diagnostic::Diagnostic;
use crate::expr::BY_CASE;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The names of one model.
pub struct Names {
    /// The name of the module that contains the items.
    pub module: String,
    taken: Vec<String>,
}

impl Names {
    /// The names of a model.
    pub fn new(d: &Derivation) -> Names {
        let s = &d.letters.symbols;
        Names {
            module: module(&d.spec.name),
            taken: s
                .ids()
                .map(|id| variable(s, id).to_string())
                .chain(super::sizes::constants(s).iter().map(ToString::to_string))
                .chain(
                    s.functionals()
                        .iter()
                        .map(|f| local_name(s, &f.name).to_string()),
                )
                .collect(),
        }
    }

    /// The name of a local that differs from every local of the model.
    pub fn local(&self, base: &str) -> Ident {
        let mut name = base.to_owned();
        while self.taken.contains(&name) {
            name.push('_');
        }
        format_ident!("{name}")
    }
}

/// The symbol's own name, which is the name of its field or method.
pub fn own(d: &Derivation, id: SymbolId) -> Ident {
    format_ident!("{}", d.letters.symbols.get(id).name)
}

/// Types, traits and variants that emitted code uses by their plain names. A model cannot have one of these names.
const TYPES: [&str; 58] = [
    "AboutBody",
    "Additive",
    "BodyMomentum",
    "BodyMomentumMatrix",
    "Box",
    "Card",
    "Coadjoint",
    "Dimension",
    "Edge",
    "Err",
    "Field",
    "FieldMomentum",
    "Free",
    "Functional",
    "Group",
    "InLanes",
    "Invariant",
    "Kind",
    "KineticWarning",
    "LeftFactor",
    "LeftFactorError",
    "LineError",
    "Linear",
    "Method",
    "MoserVeselovError",
    "Moving",
    "None",
    "Ok",
    "OpenError",
    "Option",
    "Order",
    "Orthogonal",
    "ParameterError",
    "Placed",
    "Poinsot",
    "QuaternionBody",
    "QuaternionError",
    "Real",
    "Result",
    "Reversible",
    "Rotation",
    "SMatrix",
    "SVector",
    "Settings",
    "SideBySide",
    "Some",
    "SpatialMomentum",
    "SpatialMomentumMatrix",
    "StartError",
    "StepCause",
    "StepError",
    "Stepper",
    "Steps",
    "T",
    "TurnedRotation",
    "UnitQuaternion",
    "Unsolved",
    "Vec",
];

/// Whether emitted code uses a type or a trait with this name: one of [`TYPES`], or a type of a group.
pub(super) fn is_a_type(name: &str) -> bool {
    if !name.starts_with(|c: char| c.is_ascii_uppercase()) {
        return false;
    }
    let of_groups = crate::groups::TABLE.iter().any(|line| {
        let size = crate::expr::shape::Dim::Fixed(line.size.unwrap_or(3));
        match (line.group)(size).kept() {
            crate::groups::ElementStorage::Coordinates(own) => {
                let frames = ["Body", "Spatial", "Carried"];
                let mut momenta = frames.iter().filter_map(|frame| name.strip_prefix(frame));
                own.element == name || momenta.any(|rest| rest == own.momentum)
            }
            _ => false,
        }
    });
    of_groups || TYPES.contains(&name)
}

/// Rejects a model with a reserved name, and a configuration or an advected quantity with the name of an invariant.
/// Names that every stepper needs are rejected at their declaration. Parameters and velocities may have any other
/// name, since they become fields and locals only.
pub fn refusal(d: &Derivation) -> Option<Diagnostic> {
    let spec = &d.spec;
    let model = spec.name.as_str();
    if is_a_type(model) {
        let message = format!("`{model}` is a name that the emitted code uses");
        return Some(
            Diagnostic::new(spec.name_place, message)
                .help(format!("write for example `model {model}Model`")),
        );
    }
    let functions = d.letters.symbols.functionals();
    if let Some(open) = functions.iter().find(|f| f.path == BY_CASE) {
        let name = &open.name;
        let message = format!(
            "the case gives the function `{name}`, but a compiled stepper needs it in the model"
        );
        return Some(Diagnostic::new(spec.name_place, message).help(format!(
            "run the model from its file, with [functions] in its case, or write `given {name}(...): ... = \"EXPRESSION\";` or \
             the path of a Rust function"
        )));
    }
    let taken: Vec<&String> = d.invariants.iter().map(|v| &v.name).collect();
    let elements = spec
        .configurations
        .iter()
        .map(|c| (c.element, c.name_place));
    let advected = spec.advected.iter().map(|a| (a.quantity, a.name_place));
    for (id, place) in elements.chain(advected) {
        let name = &d.letters.symbols.get(id).name;
        if taken.contains(&name) {
            return Some(crate::check::name_of_function(name, place));
        }
    }
    None
}

/// Functions and locals that emitted code uses by their plain names, besides [`TYPES`]; a local of the model with
/// such a name would shadow them. The hygiene test states a model with all of these names.
const INSIDE: [&str; 126] = [
    "all",
    "all_finite",
    "along",
    "assembled",
    "axial_of_difference",
    "axis",
    "basis",
    "body",
    "chosen_solver",
    "columns",
    "columns_from",
    "count",
    "not_less",
    "size_of",
    "size_of_energy",
    "sum_of_sizes",
    "crossed",
    "crossing",
    "trace_complement",
    "determinant",
    "diagonal",
    "diagonal_of",
    "diagonal_part",
    "diagonal_times",
    "times_diagonal",
    "e",
    "even_count",
    "factor",
    "forced",
    "found",
    "h",
    "i",
    "inclusion",
    "inertia",
    "initial",
    "into_columns",
    "into_rows",
    "inverse_or_nan",
    "j",
    "joined",
    "kinetic",
    "largest_step",
    "length",
    "linear_of",
    "matrix",
    "matrix_basis",
    "matrix_of",
    "method",
    "momentum",
    "motion_of",
    "motion_rotation",
    "motion_translation",
    "n",
    "number_of",
    "order",
    "orthogonal_of",
    "out",
    "parameters",
    "parts",
    "pencil_coefficients",
    "potential",
    "pure_quaternion",
    "put",
    "put_matrix",
    "put_skew",
    "put_vector",
    "quaternion_imaginary",
    "quaternion_of",
    "quaternion_real",
    "quaternion_rotation",
    "reach",
    "reach_of",
    "rest",
    "rotation_at",
    "rotation_of",
    "rows",
    "rows_from",
    "same",
    "scratch",
    "search",
    "settings",
    "sizes",
    "skew_basis",
    "skew_coordinates",
    "skew_part",
    "solve",
    "solve_leading_or_nan",
    "solve_or_nan",
    "solver",
    "spectrum",
    "spectrum_scales",
    "state",
    "steps",
    "symmetric_part",
    "total",
    "trial",
    "twist",
    "unit",
    "value",
    "velocity",
    "work",
    "advance_side_by_side",
    "anchor",
    "asked",
    "bound",
    "bound_step",
    "certificate",
    "change",
    "equations",
    "failed",
    "first",
    "fold",
    "care",
    "given",
    "lane",
    "model",
    "near",
    "newton",
    "root",
    "solution",
    "solved",
    "spread",
    "step",
    "traced",
    "values",
    "verdict",
];

/// The symbol's name as a local variable: its own, unless emitted code uses that name. The scalar `T` is a type, so a
/// local may have its name.
pub fn variable(symbols: &Symbols, id: SymbolId) -> Ident {
    let own = &symbols.get(id).name;
    match symbols.get(id).role == Role::Step && own == "h" {
        true => format_ident!("{own}"),
        false => local_name(symbols, own),
    }
}

/// A declared name as a local variable.
pub(super) fn local_name(symbols: &Symbols, own: &str) -> Ident {
    let mut name = own.to_owned();
    let sizes = super::sizes::constants(symbols);
    while INSIDE.contains(&name.as_str())
        || name != "T" && is_a_type(&name)
        || sizes.iter().any(|n| *n == name)
        || name != *own && symbols.find(&name).is_some()
    {
        name.push('_');
    }
    format_ident!("{name}")
}

/// The symbol's field and its local variable, as struct patterns and literals write them.
pub fn field(d: &Derivation, id: SymbolId) -> TokenStream {
    let (field, local) = (own(d, id), variable(&d.letters.symbols, id));
    if field == local {
        quote!(#field)
    } else {
        quote!(#field: #local)
    }
}

/// The symbol's name at another time level or in another role.
pub fn tagged(d: &Derivation, names: &Names, id: SymbolId, tag: &str) -> Ident {
    names.local(&format!("{}_{tag}", d.letters.symbols.get(id).name))
}

/// An item of the model, such as `HeavyTopState`.
pub fn item(d: &Derivation, suffix: &str) -> Ident {
    format_ident!("{}{suffix}", d.spec.name)
}

/// `base` if there is one configuration, otherwise `base_Λ1`.
pub fn per_configuration(d: &Derivation, base: &str, i: usize) -> Ident {
    match d.spec.configurations.as_slice() {
        [_] => format_ident!("{base}"),
        list => {
            let element = list
                .get(i)
                .map(|c| d.letters.symbols.get(c.element).name.clone());
            format_ident!("{base}_{}", element.unwrap_or_default())
        }
    }
}

/// The module of a model: its name in lower case. It is changed if it is a Rust keyword (`model Loop`) or a crate
/// that the user's code may need (`model Core`).
pub(super) fn module(model: &str) -> String {
    let mut name = snake(model);
    let crates = [
        "alloc",
        "clebsch",
        "core",
        "nalgebra",
        "proc_macro",
        "std",
        "test",
    ];
    if crate::check::is_rust_word(&name) || crates.contains(&name.as_str()) {
        name.push_str("_model");
    }
    name
}

/// `HeavyTop` as `heavy_top`.
fn snake(name: &str) -> String {
    separated(name, '_')
}

/// `HeavyTop` as `heavy-top`.
pub fn kebab(name: &str) -> String {
    separated(&crate::expr::symbol::ascii(name), '-').replace('_', "-")
}

fn separated(name: &str, separator: char) -> String {
    let chars: Vec<char> = name.chars().collect();
    let mut out = String::new();
    for (i, c) in chars.iter().enumerate() {
        let starts = c.is_uppercase()
            && i > 0
            && (!chars[i - 1].is_uppercase() || chars.get(i + 1).is_some_and(|n| n.is_lowercase()))
            && chars[i - 1] != '_'
            && !is_dimensions(&chars, i - 1);
        if starts || is_dimensions(&chars, i) {
            out.push(separator);
        }
        out.extend(c.to_lowercase());
    }
    out
}

/// Whether a number of dimensions starts at `i`, such as the `2D` of `ShallowWater2D`, which counts as a word.
fn is_dimensions(chars: &[char], i: usize) -> bool {
    let after_word = i > 0 && chars[i - 1].is_lowercase();
    let ends = chars.get(i + 2).is_none_or(|c| c.is_uppercase());
    after_word && chars[i].is_ascii_digit() && chars.get(i + 1) == Some(&'D') && ends
}

#[cfg(test)]
mod tests {
    use super::{kebab, snake};

    #[test]
    fn names_of_models_change_case() {
        assert_eq!(snake("HeavyTop"), "heavy_top");
        assert_eq!(kebab("HeavyTop"), "heavy-top");
        assert_eq!(kebab("BodyN"), "body-n");
        assert_eq!(snake("SO3Body"), "so3_body");
        assert_eq!(kebab("ShallowWater2D"), "shallow-water-2d");
        assert_eq!(kebab("ParticleMesh2DTall"), "particle-mesh-2d-tall");
        assert_eq!(kebab("Top2Deep"), "top2-deep");
        assert_eq!(kebab("Top23"), "top23");
        assert_eq!(kebab("RodA2D"), "rod-a2-d");
    }
}
