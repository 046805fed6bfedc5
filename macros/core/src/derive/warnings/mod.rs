//! Warns about valid models that are probably not intended: no kinetic energy, a wrong sign, a step of first order
//! that looks symmetric, parameters and terms without effect, assumptions without content. Takes a derivation's
//! parts; gives warnings, each with its tokens and a remedy. The warnings do not change the derivation, and the work
//! is bounded: an expression that is too large to decide gives no warning.

mod assumptions;
mod difference;
mod draw;
mod effect;
mod feasible;
mod limit;
mod order;
#[cfg(test)]
mod point_masses;
mod sign;
mod terms;
#[cfg(test)]
mod tests;

pub(crate) use effect::unused_let;

use super::action::Action;
use super::kinetic::Kinetic;
use super::limit::Limit;
use super::reversal::Reversal;
use super::select_solver::Solve;
use super::variation::Variation;
use super::{Derivation, Letters};
use crate::algebra::{Algebra, assumed};
use crate::check::spec::Spec;
use crate::diagnostic::Diagnostic;
use crate::expr::shape::Structure;
use crate::expr::{self, Expr, Letter, Part, Shift};
use crate::print::document::Remark;

/// The topic of a warning.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Topic {
    /// The action of a step does not have a limit of small steps.
    NoLimit,
    /// The kinetic energy does not depend on every velocity.
    DegenerateKineticEnergy,
    /// The kinetic energy is not positive.
    SignOfKineticEnergy,
    /// The step is not symmetric under time reversal, although the model does not request a one-sided rule.
    FirstOrder,
    /// A parameter that is not used.
    UnusedParameter,
    /// An abbreviation that is not used.
    UnusedLet,
    /// A potential, or a term, that is constant along every motion.
    ConstantTerm,
    /// A function of a moving quantity that is not differentiable everywhere.
    NotSmooth,
    /// An assumption that every choice of the parameters satisfies, or none.
    Assumption,
    /// A term of a chain that contains one neighbour and not the site itself.
    OneNeighbour,
}

impl Topic {
    /// The name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Topic::NoLimit => "no-limit",
            Topic::DegenerateKineticEnergy => "degenerate-kinetic-energy",
            Topic::SignOfKineticEnergy => "sign-of-kinetic-energy",
            Topic::FirstOrder => "first-order",
            Topic::UnusedParameter => "unused-parameter",
            Topic::UnusedLet => "unused-let",
            Topic::ConstantTerm => "constant-term",
            Topic::NotSmooth => "not-smooth",
            Topic::Assumption => "assumption",
            Topic::OneNeighbour => "one-neighbour",
        }
    }
}

/// One warning.
#[derive(Clone, Debug)]
pub struct Warning {
    /// The topic.
    pub topic: Topic,
    /// Its tokens, its text and a remedy.
    pub diagnostic: Diagnostic,
}

impl Warning {
    /// A warning.
    pub fn new(topic: Topic, diagnostic: Diagnostic) -> Warning {
        Warning { topic, diagnostic }
    }

    /// The warning as data.
    pub fn remark(&self) -> Remark {
        Remark {
            topic: self.topic.name(),
            message: self.diagnostic.message.clone(),
            help: self.diagnostic.help.clone(),
            at: self.diagnostic.place.line_and_column(),
        }
    }
}

/// The parts of a derivation that the warnings use.
pub(crate) struct Inputs<'a> {
    pub(crate) spec: &'a Spec,
    pub(crate) letters: &'a Letters,
    pub(crate) action: &'a Action,
    pub(crate) variations: &'a [Variation],
    pub(crate) reversal: &'a Reversal,
    pub(crate) limit: &'a Result<Limit, String>,
    pub(crate) kinetic: Option<&'a Kinetic>,
    pub(crate) solve: &'a Solve,
    pub(crate) assumed: &'a [Expr],
    pub(crate) algebra: &'a Algebra<'a>,
}

/// The size of the largest expression that is evaluated at points.
const LARGEST: u32 = 20_000;

impl Inputs<'_> {
    /// A kinetic term and a potential in the notation of this model, for advice.
    fn examples(&self) -> [String; 2] {
        let first = self.spec.configurations.first();
        match first.filter(|_| self.spec.has_only_fields()) {
            Some(c) => {
                let x = self.letters.symbols.get(c.element);
                let name = &x.name;
                let square = match (x.shape.is_scalar(), x.shape.is_vector()) {
                    (true, _) => format!("{name}^2"),
                    (false, true) => format!("dot({name}, {name})"),
                    (false, false) => format!("tr({name}^T*{name})"),
                };
                [c.group.kinetic_example(name), format!("h*k*{square}/2")]
            }
            _ => ["-tr(J*Ω)/h".to_owned(), "h*dot(gU, Γ)".to_owned()],
        }
    }

    /// Whether an expression vanishes for all admitted parameters, tested at exact points. Expressions that are too
    /// large count as not vanishing.
    fn vanishes(&self, e: &Expr) -> bool {
        e.size() <= LARGEST && assumed::vanishes(&self.letters.symbols, self.assumed, e)
    }

    /// An engine for further decisions, with the remaining work.
    fn engine(&self) -> Algebra<'_> {
        self.algebra.over(&self.letters.symbols)
    }

    /// An expression as text.
    fn text(&self, e: &Expr) -> String {
        let style = crate::print::Style::new(&self.spec.time_index);
        let e = expr::collect(&self.letters.symbols, e);
        crate::print::expression(
            &e,
            &self.letters.symbols,
            &style,
            crate::print::Format::Text,
        )
    }

    /// The action with the symmetric part in place of every square parameter matrix without structure: a model with a
    /// general left factor is judged by symmetric ones. `None` if the model contains no such parameter.
    fn for_symmetric_matrices(&self, action: &Action) -> Option<Action> {
        let s = &self.letters.symbols;
        let symmetric: Vec<(Letter, Expr)> = self
            .spec
            .parameters
            .iter()
            .filter(|p| {
                let symbol = s.get(**p);
                symbol.structure == Structure::General
                    && symbol.shape.is_square()
                    && !symbol.shape.is_scalar()
            })
            .map(|p| {
                let letter = Letter {
                    symbol: *p,
                    shift: Shift::HERE,
                };
                (letter, expr::part(Part::Symmetric, expr::here(s, *p)))
            })
            .collect();
        let with = |e: &Expr| expr::substitute(s, e, &symmetric);
        (!symmetric.is_empty()).then(|| Action {
            total: with(&action.total),
            edge: with(&action.edge),
            nodal: with(&action.nodal),
            distributed: with(&action.distributed),
        })
    }
}

/// All warnings of a model, in the order of their topics.
pub(crate) fn warnings(x: &Inputs) -> Vec<Warning> {
    let mut all = Vec::new();
    match limit::per_unit_time(x) {
        Some(whole) => all.push(whole),
        None => {
            all.extend(limit::limit(x));
            all.extend(sign::degenerate(x));
            all.extend(sign::sign(x));
        }
    }
    // If a power of the step size is wrong, one warning is enough.
    let none = |k: &Kinetic| !k.first_order && k.rank.is_some_and(|r| r.0 == 0);
    let has_no_limit = |why: &String| *why != super::limit::DRIVEN;
    let mut power_is_wrong =
        x.limit.as_ref().is_err_and(has_no_limit) || x.kinetic.is_some_and(none);
    if !power_is_wrong {
        let vanishing = terms::vanishing(x);
        power_is_wrong = vanishing.is_some();
        all.extend(vanishing);
    }
    if !power_is_wrong {
        all.extend(order::order(x));
    }
    all.extend(effect::parameters(x));
    let unused = x.spec.unused_lets.iter();
    all.extend(unused.map(|(name, place)| unused_let(name, *place)));
    all.extend(terms::without_effect(x));
    all.extend(effect::kinks(x));
    all.extend(assumptions::assumptions(x));
    all
}

impl Derivation {
    /// The warnings as text for a terminal: file, line, column, the line itself and carets.
    pub fn render_warnings(&self, source: &str, file: &str) -> String {
        let list = self.warnings.iter();
        list.map(|w| w.diagnostic.render("warning", source, file))
            .collect()
    }
}
