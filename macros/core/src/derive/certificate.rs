//! The certificate: a proof by normal form that the balance is a combination of the Clebsch relations with the
//! variations as coefficients, in which all multipliers cancel. It also proves that the named form (with momentum
//! maps) is the balance. Its steps are small identities that a second prover can check. A model whose certificate
//! fails does not compile.

#[cfg(test)]
mod tests;

use super::Letters;
use super::action::Action;
use super::balance::{Balance, pairing};
use super::clebsch::{Relation, constraint_terms};
use super::momentum::Momentum;
use super::variation::{Variation, at, on_shell, previous_elements};
use crate::algebra::{Algebra, Decision};
use crate::check::spec::Spec;
use crate::diagnostic::{Diagnostic, Errors};
use crate::expr::shape::Shape;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Letter, Node, Shift};
use std::collections::{BTreeMap, BTreeSet};

/// The derivation to prove.
pub struct Inputs<'a> {
    /// The model.
    pub spec: &'a Spec,
    /// All letters.
    pub letters: &'a Letters,
    /// The action of a step.
    pub action: &'a Action,
    /// The variations.
    pub variations: &'a [Variation],
    /// The balances.
    pub balances: &'a [Balance],
    /// The Clebsch relations.
    pub relations: &'a [Relation],
    /// The named forms.
    pub momenta: &'a [Momentum],
    /// The normal forms.
    pub algebra: &'a Algebra<'a>,
}

/// One identity of the proof, between scalars.
#[derive(Clone, Debug)]
pub struct Step {
    /// A description of the identity.
    pub name: String,
    /// Left side.
    pub left: Expr,
    /// Right side.
    pub right: Expr,
    /// How it was proved.
    pub known: Decision,
}

/// A finished proof.
#[derive(Clone, Debug)]
pub struct Certificate {
    /// The identities, each with its decision.
    pub steps: Vec<Step>,
}

impl Certificate {
    /// The number of identities, and how they were proved.
    pub fn summary(&self) -> String {
        let exact = self
            .steps
            .iter()
            .filter(|s| s.known == Decision::ExactEvaluation)
            .count();
        let normal = self.steps.len() - exact;
        if exact == 0 {
            format!("{normal} identities proved by normal form")
        } else {
            format!(
                "{normal} identities proved by normal form, {exact} (of three dimensions) by exact evaluation at random points modulo 2^61 - 1"
            )
        }
    }
}

/// Proves the identities of the derivation, or reports those that remain.
pub fn certify(x: &Inputs) -> Result<Certificate, Errors> {
    let mut steps = Vec::new();
    let back = PreviousNode {
        shell: on_shell(x.spec, x.letters),
        elements: previous_elements(x.spec, x.letters),
    };
    for i in 0..x.spec.configurations.len() {
        constraint_steps(x, i, &back, &mut steps);
        gradient_steps(x, i, &mut steps);
        combination(x, i, &back, &mut steps);
        named_form(x, i, &mut steps);
    }
    let mut errors = Errors::new();
    for step in &mut steps {
        let difference = expr::sub(step.left.clone(), step.right.clone());
        if let Some(known) = x.algebra.zero(&difference) {
            step.known = known;
        } else if !x.algebra.exhausted() {
            let rest = x.algebra.lower(&difference);
            let style = crate::print::Style::new(&x.spec.time_index);
            let text = crate::print::expression(
                &x.algebra.raise(&rest),
                &x.letters.symbols,
                &style,
                crate::print::Format::Text,
            );
            errors.push(
                Diagnostic::new(
                    x.spec.lagrangian_place,
                    format!("clebsch cannot prove the derivation of this model: {}: {text} remains", step.name),
                )
                .help("write the same Lagrangian in simpler terms: the algebra knows products, transposes, traces, hats and \
                    inverses, but not every identity of functions"),
            );
        }
    }
    errors.propagate()?;
    Ok(Certificate { steps })
}

/// Replacements at the previous node, which are the same for every step of the proof.
struct PreviousNode {
    shell: Vec<(Letter, Expr)>,
    elements: Vec<(Letter, Expr)>,
}

fn name_of(x: &Inputs, l: Letter) -> String {
    x.letters.symbols.get(l.symbol).name.clone()
}

/// The variations preserve every constraint: directly on the outgoing edge; on the incoming edge, with node k
/// expressed by node k-1. A constraint in which nothing varies is trivial.
fn constraint_steps(x: &Inputs, i: usize, earlier: &PreviousNode, steps: &mut Vec<Step>) {
    let s = &x.letters.symbols;
    let v = &x.variations[i];
    let nodes = x.spec.configurations.iter().map(|c| (c.element, &c.update));
    let nodes = nodes.chain(x.spec.advected.iter().map(|a| (a.quantity, &a.update)));
    let multipliers = x.letters.momentum.iter().chain(&x.letters.multiplier);
    let (outgoing, incoming) = (v.on_outgoing(), v.on_incoming());
    let moved: BTreeMap<Letter, &Expr> = v
        .advected
        .iter()
        .chain([&v.element])
        .map(|(l, e)| (*l, e))
        .collect();
    let moving: BTreeSet<Letter> = outgoing
        .iter()
        .filter(|(_, change)| !change.is_zero())
        .map(|(l, _)| *l)
        .collect();
    for ((quantity, update), p) in nodes.zip(multipliers) {
        let own = at(quantity, Shift::HERE);
        let met = expr::letters(update);
        if !met.iter().chain([&own]).any(|l| moving.contains(l)) {
            continue;
        }
        let name = &s.get(quantity).name;
        let p_next = expr::letter(s, *p, Shift::NEXT);
        let change = expr::directional(s, update, &outgoing);
        steps.push(Step {
            known: Decision::NormalForm,
            name: format!("the variation keeps the constraint of {name} on the outgoing edge"),
            left: pairing(x.letters, &p_next, &change),
            right: expr::integer(0),
        });
        let p_here = expr::here(s, *p);
        let back = expr::shift_time(s, update, Shift::PREVIOUS.time);
        let change = expr::directional(s, &back, &incoming);
        let change = expr::substitute(s, &change, &earlier.elements);
        let own = moved.get(&own);
        let own = own.map_or_else(|| expr::zero(s.get(quantity).shape), |e| (*e).clone());
        let own = expr::substitute(s, &own, &earlier.shell);
        steps.push(Step {
            known: Decision::NormalForm,
            name: format!("the variation keeps the constraint of {name} on the incoming edge"),
            left: pairing(x.letters, &p_here, &own),
            right: pairing(x.letters, &p_here, &change),
        });
    }
}

/// Gradients of the action, paired with the variations, are its directional derivatives.
fn gradient_steps(x: &Inputs, i: usize, steps: &mut Vec<Step>) {
    let s = &x.letters.symbols;
    let l = &x.action.total;
    let v = &x.variations[i];
    for (letter, change) in v.on_outgoing() {
        if change.is_zero() {
            continue;
        }
        let g = expr::gradient(s, l, letter);
        if g.is_zero() {
            continue;
        }
        steps.push(Step {
            known: Decision::NormalForm,
            name: format!(
                "⟨∇ℓ, δ{0}⟩ is the derivative of ℓ along δ{0}",
                name_of(x, letter)
            ),
            left: pairing(x.letters, &g, &change),
            right: expr::directional(s, l, &[(letter, change)]),
        });
    }
}

/// `Σ ⟨E_v, δv⟩ = δS`: the balance is a combination of the Clebsch relations. The relations are affine in the
/// multipliers, so the sum splits into one block for the action and one for each multiplier, and each block must
/// cancel separately.
fn combination(x: &Inputs, i: usize, back: &PreviousNode, steps: &mut Vec<Step>) {
    let s = &x.letters.symbols;
    // The relations follow from the constrained action: the sum of the action and these terms.
    debug_assert_eq!(
        constraint_terms(x.spec, x.letters).len(),
        x.letters.momentum.len() + x.letters.multiplier.len()
    );
    let b = &x.balances[i];
    let balance = expr::add(b.variation_out.clone(), b.variation_in.clone());
    let name = &s.get(x.spec.configurations[i].element).name;
    let mut block = |what: String, left: Expr, right: Expr| {
        let close = |e: Expr| {
            let e = expr::substitute(s, &e, &back.elements);
            expr::substitute(s, &e, &back.shell)
        };
        steps.push(Step {
            known: Decision::NormalForm,
            name: format!(
                "the balance of {name} is a combination of the Clebsch relations: {what}"
            ),
            left: close(left),
            right: close(right),
        });
    };
    let action = |gradient: &Expr| with_multiplier(x, gradient, None);
    let met = met(x, i);
    block("the action".to_owned(), combined(x, &met, &action), balance);
    let quantities = x.spec.configurations.iter().map(|c| c.element);
    let quantities = quantities.chain(x.spec.advected.iter().map(|a| a.quantity));
    let multipliers = x.letters.momentum.iter().chain(&x.letters.multiplier);
    for (quantity, multiplier) in quantities.zip(multipliers) {
        let own = |gradient: &Expr| {
            let occurs = |shift| expr::contains(gradient, at(*multiplier, shift));
            if ![Shift::HERE, Shift::NEXT].into_iter().any(occurs) {
                return expr::zero(gradient.shape());
            }
            let (with, without) = (
                with_multiplier(x, gradient, Some(*multiplier)),
                with_multiplier(x, gradient, None),
            );
            difference(with, without)
        };
        let left = combined(x, &met, &own);
        if !left.is_zero() {
            let what = format!("the multiplier of {} cancels", s.get(quantity).name);
            block(what, left, expr::integer(0));
        }
    }
}

/// A relation whose variable varies.
struct VariedRelation<'a> {
    relation: &'a Relation,
    /// The change of its variable.
    here: Option<Expr>,
    /// The change of the velocity of the incoming edge, whose relation is one level earlier.
    incoming: Option<&'a Expr>,
}

/// The relations whose variables the variation of one configuration changes.
fn met<'a>(x: &Inputs<'a>, i: usize) -> Vec<VariedRelation<'a>> {
    let v = &x.variations[i];
    let changes: BTreeMap<Letter, Expr> = v
        .on_outgoing()
        .into_iter()
        .filter(|(_, change)| !change.is_zero())
        .collect();
    let all = x.relations.iter().map(|relation| VariedRelation {
        relation,
        here: changes.get(&relation.variable).cloned(),
        incoming: (v.incoming.0.symbol == relation.variable.symbol).then_some(&v.incoming.1),
    });
    all.filter(|m| m.here.is_some() || m.incoming.is_some())
        .collect()
}

/// The relations paired with the variations; `part` is applied to each gradient.
fn combined(x: &Inputs, met: &[VariedRelation], part: &dyn Fn(&Expr) -> Expr) -> Expr {
    let s = &x.letters.symbols;
    let mut terms = Vec::new();
    for m in met {
        let gradient = part(&m.relation.gradient);
        if gradient.is_zero() {
            continue;
        }
        if let Some(change) = &m.here {
            terms.push(pairing(x.letters, &gradient, change));
        }
        if let Some(change) = m.incoming {
            let earlier = expr::shift_time(s, &gradient, Shift::PREVIOUS.time);
            terms.push(pairing(x.letters, &earlier, change));
        }
    }
    expr::sum(terms, Shape::SCALAR)
}

/// An expression with every multiplier but one set to zero.
fn with_multiplier(x: &Inputs, e: &Expr, kept: Option<SymbolId>) -> Expr {
    let s = &x.letters.symbols;
    let multipliers = x.letters.momentum.iter().chain(&x.letters.multiplier);
    let present = expr::letters(e);
    let nothing: Vec<_> = multipliers
        .filter(|m| Some(**m) != kept && present.iter().any(|l| l.symbol == **m))
        .flat_map(|m| {
            let zero = expr::zero(s.get(*m).shape);
            [Shift::HERE, Shift::NEXT].map(|shift| (Letter { symbol: *m, shift }, zero.clone()))
        })
        .collect();
    expr::substitute(s, e, &nothing)
}

/// `a - b`, without equal summands on both sides.
fn difference(a: Expr, b: Expr) -> Expr {
    let shape = a.shape();
    let terms = |e: Expr| match e.node() {
        Node::Sum(terms) => terms.clone(),
        _ if e.is_zero() => Vec::new(),
        _ => vec![e],
    };
    let (mut left, mut right) = (terms(a), Vec::new());
    for term in terms(b) {
        match left.iter().position(|other| *other == term) {
            Some(same) => drop(left.remove(same)),
            None => right.push(expr::neg(term)),
        }
    }
    expr::sum(left.into_iter().chain(right), shape)
}

/// `-(M + node terms) + (Ad* M + node terms)` paired with `ξ` is the variation of the action.
fn named_form(x: &Inputs, i: usize, steps: &mut Vec<Step>) {
    let s = &x.letters.symbols;
    let (b, m) = (&x.balances[i], &x.momenta[i]);
    let c = &x.spec.configurations[i];
    let xi = expr::here(s, x.letters.variation[i]);
    let back = |e: &Expr| expr::shift_time(s, e, Shift::PREVIOUS.time);
    let weight = c.group.weight();
    let matrix = |e: &Expr| expr::scale(weight, pairing(x.letters, e, &xi));
    let node = |e: Expr| c.group.pairing(s, e, xi.clone());
    let v = &x.variations[i];
    let l = &x.action.total;
    let before = back(l);
    let mut at_node = v.advected.clone();
    at_node.push(v.element.clone());
    let name = &s.get(c.element).name;
    // One block per source, so that each block is small.
    let mut block = |what: &str, left: Expr, right: Expr| {
        if !left.is_zero() || !right.is_zero() {
            steps.push(Step {
                known: Decision::NormalForm,
                name: format!("{what} of {name}"),
                left,
                right,
            });
        }
    };
    block(
        "momentum map of the outgoing edge",
        expr::neg(matrix(&m.start)),
        expr::directional(s, l, std::slice::from_ref(&v.outgoing)),
    );
    block(
        "diamonds of the outgoing edge",
        expr::neg(node(b.node_out.clone())),
        expr::directional(s, l, &at_node),
    );
    block(
        "momentum map of the incoming edge",
        matrix(&back(&m.end)),
        expr::directional(s, &before, std::slice::from_ref(&v.incoming)),
    );
    block(
        "diamonds of the incoming edge",
        node(back(&b.node_in)),
        expr::directional(s, &before, &at_node),
    );
    // The residual contains the node terms unchanged; the remainder is the momentum map.
    block(
        "emitted residual, outgoing edge,",
        node(difference(b.outgoing.clone(), b.node_out.clone())),
        matrix(&m.start),
    );
    block(
        "emitted residual, incoming edge,",
        node(back(&difference(b.incoming.clone(), b.node_in.clone()))),
        matrix(&back(&m.end)),
    );
    // The named maps of the multipliers, by their definition.
    let p = expr::here(s, x.letters.momentum[i]);
    let paired = pairing(x.letters, &p, &v.element.1);
    block(
        "the momentum map of the multiplier",
        matrix(&m.cotangent),
        expr::scale(weight, paired),
    );
    for (j, (letter, change)) in v.advected.iter().enumerate() {
        let Some(diamond) = m.diamonds.get(j).filter(|e| !e.is_zero()) else {
            continue;
        };
        let multiplier = expr::here(s, x.letters.multiplier[j]);
        block(
            &format!("the diamond of {} along the variation", name_of(x, *letter)),
            matrix(diamond),
            pairing(x.letters, &multiplier, change),
        );
    }
}
