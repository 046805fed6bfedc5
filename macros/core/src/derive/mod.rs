//! From a checked model to its derivation: the action of one step, constraint-preserving variations, the discrete
//! Euler-Lagrange balance, Clebsch relations, momentum maps, the certificate, the equations that each step solves,
//! invariants, time reversal, the continuous limit.

pub mod action;
pub mod advection_rule;
mod assumptions;
mod axial;
pub mod balance;
pub mod blocks;
pub mod bracket;
pub(crate) mod cancellation;
pub mod certificate;
pub mod clebsch;
pub mod continuous;
pub mod convex;
mod first_order;
#[cfg(test)]
mod functionals;
pub mod holds;
mod intermediate_positions;
pub mod invariants;
pub mod kinetic;
mod left_factor;
pub mod lie;
pub mod limit;
pub mod momentum;
pub mod momentum_update;
mod occurrence;
mod outline;
pub mod parts;
pub mod quaternionic;
pub mod reduction;
pub mod reversal;
pub mod rounding;
pub mod schur_reduction;
pub mod seen_from_body;
pub mod select_solver;
pub mod spatial_increment_form;
pub mod tangent;
pub mod two_sided_linear;
pub mod variation;
pub mod warnings;

pub use outline::{Outline, outline};

use crate::algebra::Algebra;
use crate::check::spec::Spec;
use crate::diagnostic::{Diagnostic, Errors, Place};
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::work::{self, Count, Work};
use std::sync::OnceLock;

/// The letters that the derivation adds to the letters of the model.
#[derive(Clone, Debug)]
pub struct Letters {
    /// The model's symbols and the ones below.
    pub symbols: Symbols,
    /// For each configuration: a free element of its Lie algebra, the variation `ξ`.
    pub variation: Vec<SymbolId>,
    /// For each configuration: a second free element, the direction of a tangent `η`.
    pub direction: Vec<SymbolId>,
    /// For each configuration: its velocity `ζ` in continuous time, an element of the Lie algebra
    /// (for SO(3) its axial vector).
    pub rate: Vec<SymbolId>,
    /// For each configuration: the rate of change of `ζ`.
    pub acceleration: Vec<SymbolId>,
    /// For each configuration: the multiplier of its reconstruction.
    pub momentum: Vec<SymbolId>,
    /// For each advected quantity: the multiplier of its constraint.
    pub multiplier: Vec<SymbolId>,
    /// For each advected quantity: a placeholder of its shape and structure.
    pub placeholder: Vec<SymbolId>,
    /// For each configuration: the name of its edge momentum, an element of the Lie algebra.
    pub edge_momentum: Vec<SymbolId>,
    /// For each configuration: the name of its node momentum, a covector (a vector for SO(3)).
    pub node_momentum: Vec<SymbolId>,
    /// For each constraint: its letters besides the multiplier.
    pub held: Vec<holds::ConstraintLetters>,
    /// The spectral parameter of a Lax form.
    pub spectral: SymbolId,
}

/// Everything derived from one model.
#[derive(Clone, Debug)]
pub struct Derivation {
    /// The checked model.
    pub spec: Spec,
    /// Symbols of the model and of the derivation.
    pub letters: Letters,
    /// The action of one step and its parts.
    pub action: action::Action,
    /// How every quantity varies, per configuration.
    pub variations: Vec<variation::Variation>,
    /// The balance of every configuration.
    pub balances: Vec<balance::Balance>,
    /// Stationarity of the Clebsch action, in the form of the thesis.
    pub relations: Vec<clebsch::Relation>,
    /// The proof that the balance is a combination of the Clebsch relations.
    pub certificate: certificate::Certificate,
    /// Momentum maps and the named form of the balance.
    pub momenta: Vec<momentum::Momentum>,
    /// How the momentum of every configuration is updated from one node to the next.
    pub carries: Vec<momentum_update::MomentumUpdate>,
    /// The equations that each step solves.
    pub solve: select_solver::Solve,
    /// How advected quantities follow from the configuration.
    pub transports: Vec<advection_rule::AdvectionRule>,
    /// Whether the one-step action is symmetric under time reversal.
    pub reversible: bool,
    /// Time-reversal symmetry: in general, under the assumptions, or the remainder that breaks the symmetry.
    pub reversal: reversal::Reversal,
    /// The Lagrangian in the limit of small steps, or why the limit does not exist.
    pub limit: Result<limit::Limit, String>,
    /// The equations of motion of that limit, if it exists.
    pub continuous: Option<continuous::Continuous>,
    /// The kinetic energy. It is known even for some actions without a limit.
    pub kinetic: Option<kinetic::Kinetic>,
    /// The Lie-Poisson bracket of the reduced space.
    pub bracket: bracket::Bracket,
    /// Conserved quantities.
    pub invariants: Vec<invariants::Invariant>,
    /// The number of Casimirs, the Lax form and the discrete energy.
    pub integrability: invariants::Integrability,
    /// Warnings about statements that are valid but probably not intended.
    pub warnings: Vec<warnings::Warning>,
    /// The work of the derivation.
    pub work: Work,
    /// The scheduled residual, computed on first use.
    pub(crate) residual: OnceLock<crate::interpret::Evaluator>,
}

fn letters(spec: &Spec) -> Letters {
    let mut symbols = spec.symbols.clone();
    let many = spec.configurations.len() > 1;
    // Letters as papers use them, or another letter if the model uses the first one: two names that differ by a number
    // alone are easily confused.
    let free = |letters: &[&'static str]| spec.symbols.free_letter(letters, many);
    let mut numbered = |letters: &[&'static str], i: usize, shape: Shape, structure, role| {
        let base = free(letters);
        let name = if many {
            format!("{base}{}", i + 1)
        } else {
            base.to_owned()
        };
        let name = symbols.fresh_name(&name);
        symbols.add(&name, shape, structure, role)
    };
    let (mut variation, mut direction, mut momentum, mut edge, mut node) =
        (Vec::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (i, c) in spec.configurations.iter().enumerate() {
        let shape = c.group.shape();
        let (algebra, structure) = c.group.variation();
        variation.push(numbered(
            &["ξ", "χ", "ϱ"],
            i,
            algebra,
            structure,
            Role::Variation,
        ));
        direction.push(numbered(
            &["η", "θ", "ϑ"],
            i,
            algebra,
            structure,
            Role::Variation,
        ));
        momentum.push(numbered(
            &["P", "Y", "Ξ"],
            i,
            shape,
            Structure::General,
            Role::Multiplier,
        ));
        edge.push(numbered(
            &["M", "Π", "Φ"],
            i,
            algebra,
            structure,
            Role::Derived,
        ));
        let (covector, structure) = c.group.dual();
        let name = match c.group.is_additive() {
            true => ["p", "ϖ", "ς"],
            false => c.side.of(["μ", "ν", "κ"], ["m", "ϖ", "ς"]),
        };
        node.push(numbered(&name, i, covector, structure, Role::Derived));
    }
    let (mut multiplier, mut placeholder) = (Vec::new(), Vec::new());
    for a in &spec.advected {
        let s = symbols.get(a.quantity).clone();
        // A multiplier is paired with the difference of two quantities of this structure.
        let name = symbols.fresh_name(&format!("V_{}", s.name));
        let dual = match s.structure {
            Structure::Symmetric | Structure::Diagonal | Structure::Skew => s.structure,
            Structure::General
            | Structure::Orthogonal
            | Structure::Invertible
            | Structure::UnitQuaternion
            | Structure::RigidMotion => Structure::General,
        };
        multiplier.push(symbols.add(&name, s.shape, dual, Role::Multiplier));
        let name = symbols.fresh_name(&format!("d{}", s.name));
        // The position in a word must remain visible, and skew letters would be written as hats.
        let marker = match dual {
            Structure::Skew => Structure::General,
            other => other,
        };
        placeholder.push(symbols.add(&name, s.shape, marker, Role::Variation));
    }
    // The velocity and the acceleration of the limit, of the same kind.
    let (mut rate, mut acceleration) = (Vec::new(), Vec::new());
    for (i, c) in spec.configurations.iter().enumerate() {
        let (shape, structure) = c.group.dual();
        let number = if many {
            (i + 1).to_string()
        } else {
            String::new()
        };
        let letter = free(&["ζ", "υ", "ϕ"]);
        let name = symbols.fresh_name(&format!("{letter}{number}"));
        rate.push(symbols.add(&name, shape, structure, Role::Variation));
        let name = symbols.fresh_name(&format!("d{letter}{number}"));
        acceleration.push(symbols.add(&name, shape, structure, Role::Variation));
    }
    let held = holds::letters(spec, &mut symbols);
    let name = symbols.fresh_name("λ");
    let spectral = symbols.add(&name, Shape::SCALAR, Structure::General, Role::Variation);
    Letters {
        held,
        spectral,
        symbols,
        rate,
        acceleration,
        variation,
        direction,
        momentum,
        multiplier,
        placeholder,
        edge_momentum: edge,
        node_momentum: node,
    }
}

impl Derivation {
    /// How a step is solved, in one sentence for the documentation of emitted code. If no parameters are admissible,
    /// the sentence says that no step is solved.
    pub fn how_solved(&self) -> String {
        let reason = &self.solve.reason;
        let degenerate = self.kinetic.as_ref().and_then(kinetic::Kinetic::degenerate);
        match degenerate.filter(|_| self.solve.needs_second_moments()) {
            None => reason.clone(),
            Some((rank, n)) => format!(
                "{reason}; but the kinetic energy has rank {rank} of {n}, so every choice of the parameters is rejected at \
                 the start"
            ),
        }
    }
}

/// Derives a checked model. Work is counted, and a model that exceeds the limit fails: all results until then are
/// void, including errors.
pub fn derive(spec: Spec) -> Result<Derivation, Errors> {
    let count = Count::begin();
    let whole = place_of_most(&spec);
    let derived = derived(spec, &count);
    match work::exhausted() {
        true => Err(too_large(whole, work::excess()).into()),
        false => derived,
    }
}

/// The position of the largest part of a Lagrangian: one term if it is more than half of it, otherwise all terms.
fn place_of_most(spec: &Spec) -> Place {
    let largest = spec.terms.iter().max_by_key(|(e, _)| e.size());
    let half = spec.lagrangian.size() / 2;
    let found = largest.filter(|(e, _)| e.size() > half);
    found.map_or(spec.lagrangian_place, |(_, place)| *place)
}

/// The error for a model that exceeds a limit, with the limit.
fn too_large(place: Place, excess: Option<String>) -> Diagnostic {
    let message = match excess {
        Some(excess) => format!("this model is too large to derive: {excess}"),
        None => "this model is too large to derive".to_owned(),
    };
    Diagnostic::new(place, message)
        .of_size()
        .help("use fewer bodies or terms, lower powers of sums or fewer nested products, or turn parts into parameters")
}

/// All results, in the order of their dependencies.
fn derived(spec: Spec, count: &Count) -> Result<Derivation, Errors> {
    let stated = spec.clone();
    let spec = reduction::reduce(spec)?;
    let letters = letters(&spec);
    let algebra = Algebra::new(&letters.symbols);
    let whole = place_of_most(&spec);
    let bounded = |algebra: &Algebra| match algebra.exhausted() {
        true => Err(Errors::from(too_large(whole, algebra.excess()))),
        false => Ok(()),
    };
    // Quantities that the constraints do not affect are derived without constraint forces.
    let free = action::action(&spec);
    let action = holds::with_reactions(&spec, &letters, &free);
    // The constraints first: if an action is on the wrong side, all later results are meaningless.
    let variations = variation::variations(&spec, &letters, &algebra);
    bounded(&algebra)?;
    let variations = variations?;
    let transports = advection_rule::transports(&spec, &letters, &algebra);
    bounded(&algebra)?;
    let transports = transports?;
    let balances = balance::balances(&spec, &letters, &action, &variations, &algebra);
    let free_balances = match spec.holds.is_empty() {
        true => balances.clone(),
        false => balance::balances(&spec, &letters, &free, &variations, &algebra),
    };
    let relations = clebsch::relations(&spec, &letters, &action, &algebra);
    let momenta = momentum::momenta(&spec, &letters, &balances, &variations, &algebra);
    let certificate = certificate::certify(&certificate::Inputs {
        spec: &spec,
        letters: &letters,
        action: &action,
        variations: &variations,
        balances: &balances,
        relations: &relations,
        momenta: &momenta,
        algebra: &algebra,
    });
    bounded(&algebra)?;
    let certificate = certificate?;
    let solve =
        select_solver::select_solver(&stated, &spec, &letters, &balances, &transports, &algebra);
    let carries = momentum_update::carries(&momentum_update::Inputs {
        spec: &spec,
        letters: &letters,
        action: &action,
        variations: &variations,
        balances: &balances,
        transports: &transports,
    });
    let assumed = assumptions::equations(&spec, &letters.symbols);
    let reversal = reversal::reversal(&spec, &free, &assumed, &algebra);
    let limit = limit::limit(&spec, &letters, &free, &variations, &assumed, &algebra);
    let kinetic = kinetic::kinetic(
        &spec,
        &letters,
        &free,
        limit.as_ref().ok(),
        &assumed,
        &algebra,
    );
    let continuous = limit
        .as_ref()
        .ok()
        .map(|l| continuous::continuous(&spec, &letters, &variations, l, &algebra));
    // All results so far must be decided; the search for invariants may be incomplete.
    if work::cut_short() {
        return Err(too_large(whole, work::excess()).into());
    }
    let bracket = bracket::bracket(&spec, &letters, &free, &variations);
    let (invariants, integrability) = invariants::invariants(&invariants::Inputs {
        spec: &spec,
        letters: &letters,
        action: &free,
        variations: &variations,
        balances: &free_balances,
        held: (!spec.holds.is_empty()).then_some((&action, balances.as_slice())),
        bracket: &bracket,
        solve: &solve,
        // If the momenta do not determine the velocities, no energy is listed.
        limit: limit.as_ref().ok().filter(|_| {
            let degenerate = kinetic.as_ref().and_then(kinetic::Kinetic::degenerate);
            degenerate.is_none()
        }),
        assumed: &assumed,
        algebra: &algebra,
    });
    let found = holds::InvariantSearch {
        invariants,
        integrability,
    };
    let projected = limit.is_ok();
    let holds::InvariantSearch {
        invariants,
        integrability,
    } = holds::kept(&spec, &letters, &variations, projected, &algebra, found);
    bounded(&algebra)?;
    let warnings = warnings::warnings(&warnings::Inputs {
        spec: &spec,
        letters: &letters,
        action: &free,
        variations: &variations,
        reversal: &reversal,
        limit: &limit,
        kinetic: kinetic.as_ref(),
        solve: &solve,
        assumed: &assumed,
        algebra: &algebra,
    });
    let d = Derivation {
        work: count.work(algebra.spent()),
        spec,
        letters,
        action,
        variations,
        balances,
        relations,
        certificate,
        momenta,
        carries,
        solve,
        transports,
        reversible: reversal.is_symmetric(),
        reversal,
        limit,
        continuous,
        kinetic,
        bracket,
        invariants,
        integrability,
        warnings,
        residual: OnceLock::new(),
    };
    match holds::dependent(&d, &assumed) {
        Some(refused) => Err(refused.into()),
        None => Ok(d),
    }
}
