//! Numerical values of the residual of the discrete equations at three nodes, and of the equations of motion at one
//! time.

use super::{Assignment, EvalError, Evaluator, Matrix, evaluate};
use crate::check::spec::Group;
use crate::derive::Derivation;
use crate::derive::advection_rule::AdvectionRule;
use crate::expr::shape::Structure;
use crate::expr::{self, Expr, Shift};
use crate::schedule::{Program, program};

/// The components of a covector in the basis of its Lie algebra. SO(3): the vector. SO(n): for `i < j`, row by row,
/// the pairing with the element that has -1 at (i, j) and +1 at (j, i). GL(n): all entries, row by row, since the
/// variations are matrix units. SU(2): the vector, whose variation is half the imaginary unit. Rigid motions: the
/// angular, then the linear components.
fn coordinates(group: Group, m: &Matrix) -> Vec<f64> {
    if group.dual().1 != Structure::Skew {
        return m.data.clone();
    }
    let pairs = (0..m.rows).flat_map(|i| (i + 1..m.rows).map(move |j| (i, j)));
    pairs.map(|(i, j)| m.get(j, i)).collect()
}

impl Derivation {
    /// The residual of the discrete Euler-Lagrange equations at node k, incoming minus outgoing edge, for each
    /// configuration. The macro emits the same program.
    pub fn residual_program(&self) -> Program {
        program(&self.letters.symbols, &self.residual_expressions(), "t")
    }

    pub(super) fn residual_expressions(&self) -> Vec<Expr> {
        let s = &self.letters.symbols;
        self.balances
            .iter()
            .map(|b| {
                let incoming = expr::shift_time(s, &b.incoming, Shift::PREVIOUS.time);
                expr::sub(incoming, b.outgoing.clone())
            })
            .collect()
    }

    /// Evaluates the residual at three consecutive configurations (levels -1, 0, 1), which need
    /// not be a solution. Velocities and defined advected quantities are computed; values of
    /// parameters, the step and undefined advected quantities must be given. See the emitted
    /// `balance` for the meaning of the components.
    pub fn residual(&self, values: &Assignment) -> Result<Vec<f64>, EvalError> {
        let residual = || Evaluator::of(&self.residual_program());
        self.evaluate_residual(self.residual.get_or_init(residual), values)
    }

    pub(super) fn evaluate_residual(
        &self,
        residual: &Evaluator,
        values: &Assignment,
    ) -> Result<Vec<f64>, EvalError> {
        let results = residual.run(&self.completed(values)?)?;
        let groups = self.spec.configurations.iter().zip(&results);
        Ok(groups.flat_map(|(c, m)| coordinates(c.group, m)).collect())
    }

    /// Evaluates the continuous equations of motion, `-dμ/dt ± ad*_ζ μ + Σ ∂L/∂a ◇ a`, at one time of any curve. The
    /// values are elements and undefined advected quantities at level 0, velocities under the names of
    /// [`Letters::rate`](crate::derive::Letters), and accelerations under the names of `acceleration`. The components
    /// are in the order of [`Derivation::residual`]; divided by the step size, that residual has these equations as
    /// its limit. None if the action has no limit.
    pub fn continuous_balance(&self, values: &Assignment) -> Result<Option<Vec<f64>>, EvalError> {
        let s = &self.letters.symbols;
        let Some(continuous) = &self.continuous else {
            return Ok(None);
        };
        let mut all = values.clone();
        for (a, t) in self.spec.advected.iter().zip(&self.transports) {
            if let AdvectionRule::Defined(definition) = t {
                let value = evaluate(s, definition, &all)?;
                let name = &s.get(a.quantity).name;
                all.set(name, 0, value.rows, value.cols, &value.data);
            }
        }
        let mut out = Vec::new();
        for (c, e) in self.spec.configurations.iter().zip(&continuous.balances) {
            out.extend(coordinates(c.group, &evaluate(s, e, &all)?));
        }
        Ok(Some(out))
    }

    /// Adds velocities on both edges and defined advected quantities at all three nodes.
    fn completed(&self, values: &Assignment) -> Result<Assignment, EvalError> {
        let s = &self.letters.symbols;
        let mut all = values.clone();
        for c in &self.spec.configurations {
            for level in [-1, 0] {
                let at = |time: i8| {
                    let label = [0, 0];
                    expr::letter(s, c.element, Shift { time, label })
                };
                let (g, next) = (at(level), at(level + 1));
                let inverse = expr::inverse(s, g.clone());
                let w = match c.side.is_body() {
                    _ if c.group.is_additive() => expr::sub(next, g),
                    true => expr::mul(inverse, next),
                    false => expr::mul(next, inverse),
                };
                let w = evaluate(s, &w, values)?;
                all.set(&s.get(c.velocity).name, level, w.rows, w.cols, &w.data);
            }
        }
        for (a, t) in self.spec.advected.iter().zip(&self.transports) {
            let AdvectionRule::Defined(definition) = t else {
                continue;
            };
            for level in [-1, 0, 1] {
                let e = expr::shift_time(s, definition, level);
                let value = evaluate(s, &e, &all)?;
                all.set(
                    &s.get(a.quantity).name,
                    level,
                    value.rows,
                    value.cols,
                    &value.data,
                );
            }
        }
        Ok(all)
    }
}
