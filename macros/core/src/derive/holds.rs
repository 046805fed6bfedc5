//! `hold` constraints: `h <λ, g>` at the start of the edge is added to the action. The multiplier is an unknown of
//! that step, and its equation is the constraint at the end of the edge. The solvers treat the multiplier as the
//! velocity of an additional additive configuration. Takes the model; gives the constraint forces, the equations of
//! the multipliers, and the invariants that the constraint forces preserve.

mod solved;

pub(crate) use solved::Solved;

use super::action::Action;
use super::balance::{Balance, pairing};
use super::invariants::{CasimirSearch, Family, Integrability, Invariant, Kind};
use super::select_solver::StepEquation;
use super::variation::{Variation, at};
use super::{Derivation, Letters};
use crate::algebra::Algebra;
use crate::check::spec::{Advected, Configuration, Hold, Side, Spec};
use crate::diagnostic::Diagnostic;
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::groups::{Additive, Group};

/// The letters of one constraint besides its multiplier.
#[derive(Clone, Debug)]
pub struct ConstraintLetters {
    /// The element whose increment is the multiplier: the state does not contain it.
    pub element: SymbolId,
    /// A free variation: the multiplier on arrival.
    pub variation: SymbolId,
    /// A second free variation.
    pub direction: SymbolId,
    /// Letters that every configuration needs.
    others: [SymbolId; 3],
}

/// The letters of all constraints.
pub(super) fn letters(spec: &Spec, symbols: &mut Symbols) -> Vec<ConstraintLetters> {
    let mut all = Vec::new();
    for hold in &spec.holds {
        let symbol = symbols.get(hold.multiplier).clone();
        let mut own = |base: &str, role| {
            let name = symbols.fresh_name(&format!("{base}_{}", symbol.name));
            symbols.add(&name, symbol.shape, Structure::General, role)
        };
        let [variation, direction] = ["δ", "η"].map(|base| own(base, Role::Variation));
        let others = ["P", "M", "p"].map(|base| own(base, Role::Derived));
        // This name appears only in error messages.
        let element = symbols.add(
            &symbols.fresh_name(&format!("constraint_{}", symbol.name)),
            symbol.shape,
            Structure::General,
            Role::Derived,
        );
        all.push(ConstraintLetters {
            element,
            variation,
            direction,
            others,
        });
    }
    all
}

fn here(symbol: SymbolId) -> Letter {
    at(symbol, Shift::HERE)
}

/// `<λ, g>` with `multiplier` for `λ`.
fn work(letters: &Letters, hold: &Hold, multiplier: SymbolId) -> Expr {
    let multiplier = expr::here(&letters.symbols, multiplier);
    pairing(letters, &multiplier, &hold.value)
}

/// The action of a step, with the work of the constraint forces at the start of the edge.
pub(super) fn with_reactions(spec: &Spec, letters: &Letters, free: &Action) -> Action {
    if spec.holds.is_empty() {
        return free.clone();
    }
    let step = expr::here(&letters.symbols, spec.step);
    let mut action = free.clone();
    for hold in &spec.holds {
        let term = expr::mul(step.clone(), work(letters, hold, hold.multiplier));
        action.total = expr::add(action.total, term.clone());
        action.distributed = expr::add(action.distributed, term);
    }
    action
}

/// The changes of the quantities at a node if all configurations move, each along its variation.
pub(crate) fn node_changes(variations: &[Variation], letters: &Letters) -> Vec<(Letter, Expr)> {
    let mut all: Vec<(Letter, Expr)> = Vec::new();
    let each = variations
        .iter()
        .flat_map(|v| v.advected.iter().chain([&v.element]));
    for (letter, change) in each {
        if change.is_zero() || letters.symbols.get(letter.symbol).role == Role::Velocity {
            continue;
        }
        match all.iter_mut().find(|(known, _)| known == letter) {
            Some((_, sum)) => *sum = expr::add(sum.clone(), change.clone()),
            None => all.push((*letter, change.clone())),
        }
    }
    all
}

/// The rate of change of a constraint, with the letters of variation as velocities.
pub(crate) fn rate(d: &Derivation, hold: &Hold) -> Expr {
    let s = &d.letters.symbols;
    let changes = node_changes(&d.variations, &d.letters);
    expr::directional(s, &hold.value, &changes)
}

/// `<μ, dg>`, with the variation of the multiplier for `μ`. Its derivatives along the velocities are the constraint
/// forces, and its derivatives along `μ` are the rate of change of the constraint.
pub(crate) fn rate_paired(d: &Derivation, which: usize) -> Expr {
    let letters = &d.letters;
    let mu = expr::here(&letters.symbols, letters.held[which].variation);
    pairing(letters, &mu, &rate(d, &d.spec.holds[which]))
}

/// The force of one constraint on configuration `i`, a covector in the frame of its side, for the given letter of the
/// multiplier.
pub(crate) fn reaction(
    spec: &Spec,
    letters: &Letters,
    variations: &[Variation],
    i: usize,
    hold: &Hold,
) -> Expr {
    let s = &letters.symbols;
    let v = &variations[i];
    let changes: Vec<(Letter, Expr)> = v.advected.iter().chain([&v.element]).cloned().collect();
    let change = expr::directional(s, &work(letters, hold, hold.multiplier), &changes);
    let y = expr::gradient(s, &change, here(letters.variation[i]));
    spec.configurations[i].group.of_gradient(s, y)
}

/// The forces of all constraints on configuration `i` per unit time, in the form of [`reaction`].
pub(crate) fn reactions(d: &Derivation, i: usize) -> Vec<Expr> {
    let all = d.spec.holds.iter();
    let all = all.map(|hold| reaction(&d.spec, &d.letters, &d.variations, i, hold));
    all.filter(|e| !e.is_zero()).collect()
}

/// The value of a constraint at the end of the edge, expressed by its start and the velocities.
fn at_the_end(s: &Symbols, spec: &Spec, hold: &Hold) -> Expr {
    let next = expr::shift_time(s, &hold.value, Shift::NEXT.time);
    expr::substitute(s, &next, &spec.end_of_edge())
}

/// Whether a constraint at the end of the step depends on the velocity of configuration `i`.
pub(super) fn holds(s: &Symbols, spec: &Spec, hold: &Hold, i: usize) -> bool {
    let velocity = here(spec.configurations[i].velocity);
    expr::contains(&at_the_end(s, spec, hold), velocity)
}

/// The multiplier as a configuration.
fn configuration(s: &Symbols, hold: &Hold, held: &ConstraintLetters) -> Configuration {
    let shape = s.get(hold.multiplier).shape;
    let add = |a, b| expr::add(expr::here(s, a), expr::here(s, b));
    Configuration {
        element: held.element,
        velocity: hold.multiplier,
        group: Group::Additive(Additive(shape)),
        side: Side::Spatial,
        update: add(held.element, hold.multiplier),
        place: hold.place,
        name_place: hold.name_place,
        group_place: hold.place,
        copy: None,
    }
}

/// The constraint as the equation of its multiplier.
fn equation(value: Expr) -> Balance {
    let zero = expr::zero(value.shape());
    Balance {
        increment: None,
        outgoing: value.clone(),
        incoming: zero.clone(),
        edge_out: value,
        node_out: zero.clone(),
        edge_in: zero.clone(),
        node_in: zero.clone(),
        gradient: zero,
        advected_gradients: Vec::new(),
        variation_out: expr::integer(0),
        variation_in: expr::integer(0),
    }
}

/// The error for a constraint that follows from the previous constraints for every configuration.
pub(super) fn dependent(d: &Derivation, assumed: &[Expr]) -> Option<Diagnostic> {
    let count = d.spec.holds.len();
    if count == 0 {
        return None;
    }
    let solved = Solved::of(&d.spec, &d.letters, &Algebra::new(&d.letters.symbols));
    let number = |j: usize| {
        let shape = d.letters.symbols.get(d.spec.holds[j].multiplier).shape;
        let size = |n| d.letters.symbols.sizes(n).1;
        size(shape.rows) * size(shape.cols)
    };
    let rank_of = |count: usize| {
        let all: Vec<usize> = (0..count).collect();
        let whole = d.with_multipliers(&all);
        let paired: Vec<Expr> = all.iter().map(|i| rate_paired(d, *i)).collect();
        // Evaluated where the constraints hold: two vectors of equal length may be equal under fewer conditions than
        // they have components.
        let form = expr::sum(paired, Shape::SCALAR);
        let form = expr::substitute(&d.letters.symbols, &form, solved.list());
        // The rank of the form on velocities and multipliers is twice the rank of the derivatives.
        let rank = super::kinetic::rank(&whole.spec, &whole.letters, &form, assumed);
        let wanted: usize = all.iter().map(|j| number(*j)).sum();
        rank.map(|(rank, _)| (rank / 2, wanted))
            .filter(|(rank, wanted)| rank < wanted)
    };
    rank_of(count)?;
    for j in 0..count {
        let Some((rank, wanted)) = rank_of(j + 1) else {
            continue;
        };
        let hold = &d.spec.holds[j];
        let name = &d.letters.symbols.get(hold.multiplier).name;
        let message = format!(
            "the constraint of `{name}` follows from the others, or some of its components follow from one another: {wanted} \
             equations constrain only {rank} directions, so its multiplier is undetermined"
        );
        let is_turned = |e: &Expr| e.shape().is_vector() && rank + 1 == wanted;
        let help = match hold.left.shape() == hold.value.shape() {
            true if is_turned(&hold.left) => {
                "remove what the other constraints state already; to make vectors of equal length, such as `R*a` and `S*b`, \
                 parallel, use two numbers: `dot(R*c, S*b) = 0` and `dot(R*d, S*b) = 0` with `c` and `d` perpendicular to \
                 `a`"
            }
            true => "remove what the other constraints state already",
            false => {
                "an equation of matrices constrains all entries, of symmetric matrices the entries on and above the diagonal, \
                 of skew matrices the axial vector: for rotations, write `vee(A^T*B) = 0` instead of `A = B`"
            }
        };
        return Some(Diagnostic::new(hold.place, message).help(help));
    }
    None
}

impl Derivation {
    /// The derivation whose unknowns include the multipliers of these constraints, after the velocities of the
    /// configurations.
    pub fn with_multipliers(&self, which: &[usize]) -> Derivation {
        let mut own = self.clone();
        let s = &self.letters.symbols;
        for j in which {
            let (Some(hold), Some(held)) = (self.spec.holds.get(*j), self.letters.held.get(*j))
            else {
                continue;
            };
            let value = at_the_end(s, &self.spec, hold);
            own.spec.configurations.push(configuration(s, hold, held));
            own.balances.push(equation(value));
            let letters = &mut own.letters;
            letters.variation.push(held.variation);
            letters.direction.push(held.direction);
            letters.rate.push(held.variation);
            letters.acceleration.push(held.direction);
            let [momentum, edge, node] = held.others;
            letters.momentum.push(momentum);
            letters.edge_momentum.push(edge);
            letters.node_momentum.push(node);
            own.solve
                .riccati
                .push(StepEquation::None("a multiplier".to_owned()));
            if let Some(list) = &mut own.solve.seen_from_body {
                list.push(seen_from_body(&self.spec, s, hold));
            }
        }
        own
    }
}

/// The constraint at the end of the edge, with the letters of spatial velocities for the velocities in the body
/// frame.
fn seen_from_body(spec: &Spec, s: &Symbols, hold: &Hold) -> Expr {
    let (mut ends, mut velocities) = (Vec::new(), Vec::new());
    for c in &spec.configurations {
        if c.side.is_body() || c.group.is_additive() {
            ends.push((at(c.element, Shift::NEXT), c.update.clone()));
            continue;
        }
        let (g, v) = (expr::here(s, c.element), expr::here(s, c.velocity));
        ends.push((at(c.element, Shift::NEXT), expr::mul(g.clone(), v.clone())));
        let seen = expr::product([g.clone(), v, expr::inverse(s, g)]);
        velocities.push((here(c.velocity), seen));
    }
    for a in &spec.advected {
        let end = expr::substitute(s, &a.update, &velocities);
        ends.push((at(a.quantity, Shift::NEXT), end));
    }
    let next = expr::shift_time(s, &hold.value, Shift::NEXT.time);
    expr::substitute(s, &next, &ends)
}

/// The size of the terms of a constraint, and the effect of the rounding of the configuration in units of rounding: a
/// logarithm near zero is as uncertain as its argument.
pub(crate) fn scale(s: &Symbols, hold: &Hold) -> Expr {
    let mut terms = vec![expr::magnitude_by_differences(s, &hold.value)];
    if hold.value.shape().is_scalar() {
        let letters = expr::letters(&hold.value).into_iter();
        for l in letters.filter(|l| s.get(l.symbol).role != Role::Parameter) {
            let own = expr::letter(s, l.symbol, l.shift);
            let gradient = expr::gradient(s, &hold.value, l);
            terms.push(expr::mul(
                expr::lengths_of_differences(s, &gradient),
                expr::magnitude(s, &own),
            ));
        }
    }
    expr::sum(terms, Shape::SCALAR)
}

/// The result of the search for invariants. Momenta belong to the motion with constraint forces, the other invariants
/// to the motion without them.
pub(super) struct InvariantSearch {
    pub invariants: Vec<Invariant>,
    pub integrability: Integrability,
}

/// The invariants that constraint forces do not change wherever the constraints are satisfied. The constraints are
/// added; their rates of change are added too if the steps enforce them.
pub(super) fn kept(
    spec: &Spec,
    letters: &Letters,
    variations: &[Variation],
    projected: bool,
    algebra: &Algebra,
    found: InvariantSearch,
) -> InvariantSearch {
    let InvariantSearch {
        invariants,
        mut integrability,
    } = found;
    if spec.holds.is_empty() {
        return InvariantSearch {
            invariants,
            integrability,
        };
    }
    let s = &letters.symbols;
    let kicks: Vec<Vec<(Letter, Expr)>> = spec
        .holds
        .iter()
        .map(|hold| {
            let each = letters.node_momentum.iter().enumerate();
            each.map(|(i, m)| (here(*m), reaction(spec, letters, variations, i, hold)))
                .collect()
        })
        .collect();
    let solved = Solved::of(spec, letters, algebra);
    // A constraint force may contain an advected quantity, and a momentum the configuration that defines it.
    let defined = |a: &Advected| Some((here(a.quantity), a.definition.clone()?));
    let definitions: Vec<(Letter, Expr)> = spec.advected.iter().filter_map(defined).collect();
    let vanishes = |change: &Expr| {
        solved.vanishes(change, algebra)
            || !definitions.is_empty()
                && solved.vanishes(&expr::substitute(s, change, &definitions), algebra)
    };
    let unmoved = |value: &Expr| {
        let mut changes = kicks.iter().map(|kick| expr::directional(s, value, kick));
        changes.all(|change| vanishes(&change))
    };
    let is_left = |v: &Invariant| match (&v.kind, &v.value) {
        (Kind::Energy, _) => true,
        (Kind::Spectrum, _) | (_, None) => false,
        (_, Some(value)) => unmoved(value),
    };
    let mut invariants: Vec<Invariant> = invariants.into_iter().filter(is_left).collect();
    for v in invariants
        .iter_mut()
        .filter(|v| v.kind == Kind::Energy && v.exact)
    {
        v.exact = false;
        v.reason = "the stepper is symplectic".to_owned();
    }
    integrability.lax = None;
    integrability.discrete_energy.exact = false;
    integrability.casimirs = CasimirSearch::NotSought(
        "the `hold` constraints restrict the motion to a smaller space than the bracket describes"
            .to_owned(),
    );
    for (j, hold) in spec.holds.iter().enumerate() {
        let multiplier = s.get(hold.multiplier);
        invariants.push(Invariant {
            name: format!("constraint_{}", multiplier.ascii),
            kind: Kind::Value,
            family: Family::Held,
            scale: Some(scale(s, hold)),
            value: Some(hold.value.clone()),
            exact: true,
            reason: format!("enforced by the multiplier {}", multiplier.name),
        });
        if projected {
            invariants.push(Invariant {
                name: format!("constraint_rate_{}", multiplier.ascii),
                kind: Kind::ConstraintRate(j),
                family: Family::Held,
                scale: None,
                value: None,
                exact: true,
                reason: format!(
                    "the rate of change of the constraint of {} vanishes: the momentum is projected at every node",
                    multiplier.name
                ),
            });
        }
    }
    InvariantSearch {
        invariants,
        integrability,
    }
}
