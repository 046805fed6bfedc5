//! Judges one step. Takes the numbers of two nodes; gives the residual of every equation and the bound on its rounding.

use crate::group::{Group, MOST_OF_A_DEFECT};
use crate::holds;
use crate::lagrangian::derivatives;
use crate::number::{Number, UNIT, larger};
use crate::run::FAR_BELOW;
use crate::scene::Scene;
use crate::setup::Setup;
use crate::sites::{Moving, moving, varied};
use crate::stated::{Role, Side, Stated};
use crate::statements;
use crate::two_frames::{Rounding, TwoFrames};
use std::borrow::Cow;
use std::sync::Arc;

/// Roundings of the terms of an equation that a solver may leave, in addition to the rounding of the evaluation.
pub const LEFT_BY_SOLVERS: f64 = 8.0;

/// Like `LEFT_BY_SOLVERS`, for constraints. A search for multipliers ends when corrections are at most 32 double
/// roundings of the terms.
pub const LEFT_OF_WHAT_IS_HELD: f64 = 128.0;

/// Products of numbers larger than this may overflow.
const LARGE: f64 = 1e150;

/// The residual of one equation.
#[derive(Clone, Debug)]
pub struct Part {
    /// The name of the equation.
    pub what: String,
    /// The site, of a quantity that has one.
    pub site: Option<usize>,
    /// The component, counted from 1.
    pub component: usize,
    /// The end of the edge: 0 or 1.
    pub node: usize,
    /// The residual.
    pub residual: f64,
    /// The largest residual that rounding explains.
    pub bound: f64,
    /// The sum of the sizes of its terms.
    pub terms: f64,
}

impl Part {
    /// The residual in units of its bound: 0 if the residual is zero, NaN if the residual or the bound is NaN.
    #[must_use]
    pub fn ratio(&self) -> f64 {
        match self.residual == 0.0 && !self.bound.is_nan() {
            true => 0.0,
            false => self.residual.abs() / self.bound,
        }
    }

    /// Whether the equation tests anything, that is, whether its terms can have rounding errors.
    #[must_use]
    pub fn tests(&self) -> bool {
        self.terms > 0.0
    }

    /// The residual in roundings of its own terms.
    #[must_use]
    pub fn roundings(&self) -> f64 {
        self.residual.abs() / (UNIT * self.terms)
    }

    /// The residual of one component of a constraint.
    #[must_use]
    pub fn held(name: &str, index: Option<i64>, node: usize, x: &Number) -> Self {
        Self {
            what: name.to_owned(),
            site: index.and_then(|i| usize::try_from(i).ok()),
            component: 1,
            node,
            residual: x.value,
            bound: LEFT_OF_WHAT_IS_HELD * x.error,
            terms: 0.0,
        }
    }
}

/// The judgement of a step.
#[derive(Clone, Debug)]
pub struct Judged {
    /// The equation whose residual is largest relative to its bound.
    pub worst: Option<Part>,
    /// The number of equations that test anything.
    pub tested: u64,
    /// The largest residual of the tested equations, in roundings of its own terms.
    pub roundings: f64,
}

impl Judged {
    /// The judgement of an empty set of equations.
    #[must_use]
    pub fn nothing() -> Self {
        Self {
            worst: None,
            tested: 0,
            roundings: 0.0,
        }
    }

    /// Whether all residuals are far below the rounding of their terms. They are if the arithmetic of a step is exact, as for
    /// forces that balance.
    #[must_use]
    pub fn is_exact(&self) -> bool {
        self.tested > 0 && self.roundings < FAR_BELOW
    }

    /// The judgement of both sets of equations.
    #[must_use]
    pub fn and(mut self, other: Self) -> Self {
        self.tested += other.tested;
        self.roundings = larger(self.roundings, other.roundings);
        if let Some(part) = other.worst {
            self.take(part);
        }
        self
    }

    /// Stores another equation if its residual is the largest so far.
    fn take(&mut self, part: Part) {
        let worse = |a: &Part, b: &Part| a.ratio().is_nan() || b.ratio() <= a.ratio();
        if !self.worst.as_ref().is_some_and(|w| worse(w, &part)) {
            self.worst = Some(part);
        }
    }
}

/// Judges steps of one model and case.
#[derive(Clone, Debug)]
pub struct Judge {
    stated: Arc<Stated>,
    setup: Setup,
}

impl Judge {
    /// For a statement and the data of a case.
    ///
    /// # Errors
    /// Why it cannot be judged.
    pub fn new(stated: Arc<Stated>, setup: Setup) -> Result<Self, String> {
        match stated.functionals.is_empty() {
            true => Ok(Self { stated, setup }),
            false => Err("functionals of all sites are not supported here".to_owned()),
        }
    }

    /// Judges step number `step`, from the numbers of one node to the numbers of the next node.
    ///
    /// # Errors
    /// Why the statement cannot be evaluated.
    pub fn step(&self, step: u64, before: &[f64], after: &[f64]) -> Result<Judged, String> {
        self.part(step, 1.0, before, after)
    }

    /// Judges a substep with this share of step number `step`.
    ///
    /// # Errors
    /// As [`Judge::step`].
    pub fn part(
        &self,
        step: u64,
        share: f64,
        before: &[f64],
        after: &[f64],
    ) -> Result<Judged, String> {
        let setup = match share == 1.0 {
            true => Cow::Borrowed(&self.setup),
            false => Cow::Owned(self.setup.clone().with_step(self.setup.h * share)),
        };
        let parts = self.parts_of(&setup, step, before, after)?;
        // If terms overflow, nothing is measured.
        let mut numbers = before.iter().chain(after).map(|x| x.abs());
        let is_large = |x: f64| (LARGE..f64::INFINITY).contains(&x);
        if numbers.any(is_large) && parts.iter().any(|p| p.ratio().is_nan()) {
            return Err("terms of the action exceed the largest double".to_owned());
        }
        let tested = parts.iter().filter(|p| p.tests());
        let mut out = Judged {
            worst: None,
            tested: tested.clone().count() as u64,
            roundings: tested.map(Part::roundings).fold(0.0, larger),
        };
        let detects = |change: &f64| self.detects(&changed(after, *change), &setup, step, before);
        if out.is_exact() && CHANGES.iter().any(detects) {
            out.tested = 0;
        }
        parts.into_iter().for_each(|part| out.take(part));
        Ok(out)
    }

    /// Whether some equation rejects a step to these numbers, or cannot be evaluated there.
    fn detects(&self, changed: &[f64], setup: &Setup, step: u64, before: &[f64]) -> bool {
        let is_rejected = |p: &Part| p.tests() && (p.ratio() > 1.0 || p.ratio().is_nan());
        let parts = self.parts_of(setup, step, before, changed);
        parts.map_or(true, |parts| parts.iter().any(is_rejected))
    }

    /// The residuals of all equations of a step.
    ///
    /// # Errors
    /// Why the statement cannot be evaluated.
    pub fn parts(&self, step: u64, before: &[f64], after: &[f64]) -> Result<Vec<Part>, String> {
        self.parts_of(&self.setup, step, before, after)
    }

    fn parts_of(
        &self,
        setup: &Setup,
        step: u64,
        before: &[f64],
        after: &[f64],
    ) -> Result<Vec<Part>, String> {
        let stated = &self.stated;
        let moving = moving(stated, setup, step);
        if moving.is_empty() {
            return Err("no moving quantity is observed".to_owned());
        }
        let varied = varied(&moving);
        let nodes = [before, after];
        let slopes = derivatives(stated, setup, nodes, &moving, &varied)?;
        let scene = Scene::new(stated, setup, nodes, &varied);
        let mut out = statements::carried(stated, setup, (before, after), &moving)?;
        for node in [0, 1] {
            let (mut parts, mut variables) = (Vec::new(), Vec::new());
            for m in &moving {
                out.extend(self.orthonormal(m, nodes[node], node));
                let momentum = self.momentum(m, nodes[node])?;
                let first = usize::try_from(m.first).unwrap_or(usize::MAX);
                for (i, p) in momentum.numbers.iter().enumerate() {
                    let of = first + node * m.components + i;
                    let slope = slopes.get(of).copied().unwrap_or_default();
                    let terms = p.abs() + slope.terms;
                    let rounded = momentum.rounding.sizes[i] + slope.terms;
                    let brought = if node == 0 { -slope.value } else { slope.value };
                    let residual = p - brought;
                    variables.push(of);
                    parts.push(Part {
                        what: format!("momentum of {}", m.name),
                        site: m.site,
                        component: i + 1,
                        node,
                        residual,
                        bound: slope.error
                            + momentum.rounding.errors[i]
                            + UNIT * residual.abs()
                            + LEFT_BY_SOLVERS * UNIT * rounded,
                        terms,
                    });
                }
            }
            if !stated.holds.is_empty() {
                let (held, gradients) = holds::held(&scene, stated, setup, &moving, node)?;
                out.extend(held);
                holds::without_reactions(&mut parts, &variables, &gradients);
            }
            out.append(&mut parts);
        }
        Ok(out)
    }

    /// The distance of a matrix or quaternion from the group of rotations.
    fn orthonormal(&self, m: &Moving<'_>, numbers: &[f64], node: usize) -> Option<Part> {
        let q = self.stated.quantities.get(m.name)?;
        let Role::Element(group, _) = &q.role else {
            return None;
        };
        let own = self.setup.observed(m.name, m.site)?;
        Some(Part {
            what: format!("orthonormality of {}", m.name),
            site: m.site,
            component: 1,
            node,
            residual: group.defect(own.of(numbers)),
            bound: MOST_OF_A_DEFECT * UNIT,
            terms: 0.0,
        })
    }

    /// The momentum of a configuration at a node, with the uncertainty of its components.
    fn momentum(&self, m: &Moving<'_>, node: &[f64]) -> Result<Momentum, String> {
        let missing = || format!("the momentum of `{}` is not observed", m.name);
        let q = self.stated.quantities.get(m.name).ok_or_else(missing)?;
        let base = match &q.role {
            Role::Element(_, Side::Body) => "body_momentum",
            Role::Element(_, Side::Space) => "spatial_momentum",
            _ => "momentum",
        };
        let own = self
            .setup
            .momentum(base, m.name, m.site)
            .ok_or_else(missing)?;
        let numbers = own.of(node);
        let size = numbers.iter().fold(0.0, |a: f64, x| a.max(x.abs()));
        let numbers = match &q.role {
            Role::Element(group, _) => group.momentum(numbers),
            _ => Some(numbers.to_vec()),
        };
        let numbers = numbers
            .filter(|n| n.len() == m.components)
            .ok_or_else(missing)?;
        // Momenta of groups are stored in one frame and transformed to the other.
        let error = match &q.role {
            Role::Element(..) => 4.0 * UNIT * size,
            _ => UNIT * size,
        };
        let rounding = match &q.role {
            Role::Element(Group::Linear(n), side) => {
                let element = self.setup.observed(m.name, m.site).ok_or_else(missing)?;
                let frames = TwoFrames::at(*n, element.of(node), *side).ok_or_else(missing)?;
                frames.rounding(&numbers).ok_or_else(missing)?
            }
            _ => Rounding {
                errors: vec![error; numbers.len()],
                sizes: numbers.iter().map(|p| p.abs()).collect(),
            },
        };
        Ok(Momentum { numbers, rounding })
    }
}

struct Momentum {
    numbers: Vec<f64>,
    rounding: Rounding,
}

/// Changes of the state, relative to its numbers. A check must detect one of them: large forces that balance hide a small
/// change.
const CHANGES: [f64; 4] = [1e-6, 1e-3, 1.0, 1e3];

/// The numbers of a node, each changed by this fraction. A zero changes by the same fraction of the largest number, or of 1.
fn changed(numbers: &[f64], change: f64) -> Vec<f64> {
    let most = numbers.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let whole = if most > 0.0 { most } else { 1.0 };
    let mut sign = -change;
    let each = numbers.iter().map(|x| {
        sign = -sign;
        x + sign * if *x == 0.0 { whole } else { x.abs() }
    });
    each.collect()
}
