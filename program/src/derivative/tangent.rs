//! The derivative of a tape along one direction.

use super::Copied;
use crate::tape::{Scalar, Step, Tape};

impl Tape {
    /// The tape that also computes derivatives along a direction. Its inputs are the `inputs` inputs of this tape, followed by the
    /// direction `dx_i` in the same order; its outputs are the outputs of this tape, followed by `sum_i dy_j/dx_i dx_i`, one for each
    /// output `j`. `None` if the tape calls whole functions.
    #[must_use]
    pub fn tangent(&self, inputs: usize) -> Option<Tape> {
        let mut own = Copied::of(self)?;
        let mut along: Vec<Option<Scalar>> = Vec::with_capacity(self.steps.len());
        for (at, step) in self.steps.iter().enumerate() {
            let change = own.pushed(*step, at, &along, inputs);
            along.push(change);
        }
        let mut outputs: Vec<Scalar> = Vec::with_capacity(2 * self.outputs.len());
        outputs.extend(self.outputs.iter().map(|x| own.steps[x.step()]));
        for output in &self.outputs {
            outputs.push(own.or_zero(along[output.step()]));
        }
        Some(own.recording.tape(outputs))
    }
}

impl Copied {
    /// The change of a step along the direction; `None` if it is zero everywhere.
    fn pushed(
        &mut self,
        step: Step,
        at: usize,
        along: &[Option<Scalar>],
        inputs: usize,
    ) -> Option<Scalar> {
        let change = |x: Scalar| along[x.step()];
        match step {
            Step::Input(k) => Some(self.input(inputs + k as usize)),
            Step::Double(_) | Step::Output(..) => None,
            Step::Add(a, b) => self.sum(change(a), change(b)),
            Step::Sub(a, b) => {
                let less = change(b).map(|b| self.recording.step(Step::Neg(b)));
                match (change(a), change(b)) {
                    (Some(a), Some(b)) => Some(self.recording.step(Step::Sub(a, b))),
                    (one, _) => one.or(less),
                }
            }
            Step::Mul(a, b) => {
                let [x, y] = [a, b].map(|x| self.steps[x.step()]);
                let by_a = change(a).map(|a| self.recording.step(Step::Mul(a, y)));
                let by_b = change(b).map(|b| self.recording.step(Step::Mul(x, b)));
                self.sum(by_a, by_b)
            }
            Step::Div(a, b) => {
                let (divisor, quotient) = (self.steps[b.step()], self.steps[at]);
                let by_b = change(b).map(|b| {
                    let product = self.recording.step(Step::Mul(quotient, b));
                    self.recording.step(Step::Neg(product))
                });
                let above = self.sum(change(a), by_b)?;
                Some(self.recording.step(Step::Div(above, divisor)))
            }
            Step::Neg(a) => {
                let a = change(a)?;
                Some(self.recording.step(Step::Neg(a)))
            }
            Step::Function(function, a) => self.times_slope(change(a)?, function, [a.step(), at]),
            Step::WherePositive(a, b) => {
                let (decides, b) = (self.steps[a.step()], change(b)?);
                Some(self.recording.step(Step::WherePositive(decides, b)))
            }
        }
    }
}
