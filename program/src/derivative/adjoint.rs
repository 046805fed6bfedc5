//! The transposed derivative of a tape, in reverse order of its steps (Linnainmaa, 1976).

use super::Copied;
use crate::tape::{Scalar, Step, Tape};

impl Tape {
    /// The tape that pulls weights of the outputs back to the inputs. Its inputs are the `inputs` inputs of this tape, followed by one
    /// weight `w_j` for each output; its outputs are `sum_j w_j dy_j/dx_i`, one for each input `i`. It takes at most four times the
    /// operations of this tape. `None` if the tape calls whole functions.
    #[must_use]
    pub fn adjoint(&self, inputs: usize) -> Option<Tape> {
        let mut own = Copied::of(self)?;
        let mut weights: Vec<Option<Scalar>> = vec![None; self.steps.len()];
        for (j, output) in self.outputs.iter().enumerate() {
            let weight = own.input(inputs + j);
            let slot = output.step();
            weights[slot] = own.sum(weights[slot], Some(weight));
        }
        let mut pulled: Vec<Option<Scalar>> = vec![None; inputs];
        for at in (0..self.steps.len()).rev() {
            let Some(weight) = weights[at] else {
                continue;
            };
            let step = self.steps[at];
            let terms = own.pulled(step, at, weight);
            for (operand, term) in terms.into_iter().flatten() {
                let slot = operand.step();
                weights[slot] = own.sum(weights[slot], Some(term));
            }
            if let Step::Input(k) = step
                && let Some(slot) = pulled.get_mut(k as usize)
            {
                *slot = own.sum(*slot, Some(weight));
            }
        }
        let outputs = pulled.into_iter().map(|x| own.or_zero(x)).collect();
        Some(own.recording.tape(outputs))
    }
}

impl Copied {
    /// The terms that a step with this weight adds to the weights of its operands.
    fn pulled(&mut self, step: Step, at: usize, weight: Scalar) -> [Option<(Scalar, Scalar)>; 2] {
        match step {
            Step::Input(_) | Step::Double(_) | Step::Output(..) => [None, None],
            Step::Add(a, b) => [Some((a, weight)), Some((b, weight))],
            Step::Sub(a, b) => {
                let less = self.recording.step(Step::Neg(weight));
                [Some((a, weight)), Some((b, less))]
            }
            Step::Mul(a, b) => {
                let [x, y] = [a, b].map(|x| self.steps[x.step()]);
                let by_a = self.recording.step(Step::Mul(weight, y));
                let by_b = self.recording.step(Step::Mul(weight, x));
                [Some((a, by_a)), Some((b, by_b))]
            }
            Step::Div(a, b) => {
                let (divisor, quotient) = (self.steps[b.step()], self.steps[at]);
                let by_a = self.recording.step(Step::Div(weight, divisor));
                let product = self.recording.step(Step::Mul(by_a, quotient));
                let by_b = self.recording.step(Step::Neg(product));
                [Some((a, by_a)), Some((b, by_b))]
            }
            Step::Neg(a) => {
                let less = self.recording.step(Step::Neg(weight));
                [Some((a, less)), None]
            }
            Step::Function(function, a) => {
                let slope = self.times_slope(weight, function, [a.step(), at]);
                [slope.map(|slope| (a, slope)), None]
            }
            Step::WherePositive(a, b) => {
                let decides = self.steps[a.step()];
                let chosen = self.recording.step(Step::WherePositive(decides, weight));
                [Some((b, chosen)), None]
            }
        }
    }
}
