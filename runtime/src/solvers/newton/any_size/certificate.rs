//! What is known to be principal without another proof, as [`Certificate`](crate::solvers::newton::Certificate) says it,
//! in lists: of any group and any number of unknowns.
//! Takes what was found out; gives a test that every step can afford.

use super::{Chart, NodeList, Parts};
use crate::linalg::{Dense, DenseFactors};
use crate::solvers::newton::certificate::{COMMON, DRIFT, LARGER, LASTS, PATIENCE, Purpose};
use crate::solvers::newton::node::Spread;
use crate::solvers::newton::principal::Care;

/// Velocities that are principal roots: see [`Certificate`](crate::solvers::newton::Certificate).
#[derive(Clone, Debug)]
pub(super) struct Certificate {
    pub(super) reach: Vec<f64>,
    pub(super) node: Option<NodeList>,
    pub(super) spread: Spread,
    pub(super) inverse: Dense<f64>,
    pub(super) factored: Option<NodeList>,
    pub(super) bounded: bool,
    pub(super) stale: bool,
    pub(super) left: u32,
    pub(super) misses: u32,
    pub(super) purpose: Purpose,
}

impl Certificate {
    pub(super) fn none(purpose: Purpose) -> Self {
        Self {
            reach: Vec::new(),
            node: None,
            spread: Spread::HERE,
            inverse: Dense::zeros(0, 0),
            factored: None,
            bounded: false,
            stale: false,
            left: 0,
            misses: 0,
            purpose,
        }
    }

    pub(super) fn holds<C: Chart>(
        &self,
        chart: &C,
        velocity: &C::Element,
        values: &NodeList,
    ) -> bool {
        let Some(node) = &self.node else {
            return false;
        };
        let everywhere = !values.any();
        chart.is_within(velocity, &self.reach)
            && (everywhere || self.bounded && self.left > 0 && values.is_near(node, self.spread))
    }

    pub(super) fn wants_tangent(&mut self, values: &NodeList) -> bool {
        let served = |at: &NodeList| self.bounded && values.is_near(at, Spread::drifted(DRIFT));
        self.stale =
            values.any() && self.node.is_some() && !self.factored.as_ref().is_some_and(served);
        self.stale
    }

    pub(super) fn ask(&mut self, parts: &Parts, factors: &DenseFactors, values: &NodeList) {
        if !values.any() {
            return;
        }
        let now = factors.inverse_bounds(parts.count(), |i| parts.part_of(i));
        self.inverse = Dense::from_fn(now.rows, now.cols, |a, b| {
            LARGER * now.at(a, b) + COMMON * (now.at(a, a) * now.at(b, b)).sqrt()
        });
        self.left = 0;
    }

    pub(super) fn note<C: Chart>(
        &mut self,
        chart: &C,
        factors: &DenseFactors,
        trial: &C::Element,
        values: &NodeList,
    ) {
        if !values.any() || !self.stale {
            return;
        }
        let parts = chart.parts();
        let found = factors.inverse_bounds(parts.count(), |i| parts.part_of(i));
        let mut bounded = chart.is_within(trial, &self.reach);
        for (x, most) in found.data.iter().zip(&self.inverse.data) {
            // NaN is not bounded.
            bounded &= x <= most;
        }
        self.factored = Some(values.clone());
        self.bounded = bounded;
    }

    pub(super) fn care(&self, values: &NodeList) -> Care {
        Care {
            lasting: self.purpose == Purpose::Run && self.misses.is_multiple_of(PATIENCE),
            everywhere: !values.any(),
            proved: self.purpose != Purpose::Trial,
        }
    }

    /// Renews it after a proof that the solution is the principal root.
    pub(super) fn close(&mut self, reach: Vec<f64>, spread: Spread, values: &NodeList) {
        let lasts = reach.first().is_some_and(|x| *x > 0.0);
        if !lasts {
            self.misses = self.misses.wrapping_add(1);
            return;
        }
        let spread = Spread {
            turned: true,
            share: f64::INFINITY,
        }
        .and(spread);
        *self = Self {
            reach,
            node: Some(values.clone()),
            spread,
            inverse: self.inverse.clone(),
            factored: Some(values.clone()),
            bounded: true,
            stale: self.stale,
            left: LASTS,
            misses: 0,
            purpose: self.purpose,
        };
    }
}
