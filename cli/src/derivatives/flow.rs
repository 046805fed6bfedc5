//! The steps of a model as a flow of `clebsch_analysis`. Takes a trajectory with derivatives; gives steps of any size.

use clebsch::derivatives::{Derivatives, Jacobian, NoDerivative, Point};
use clebsch::nalgebra::DMatrix;
use clebsch_analysis::Flow;
use std::cell::RefCell;

/// Step sizes that are kept at the same time.
const MOST: usize = 12;

/// A state, or why it does not exist.
pub(crate) type State = Result<Point, NoDerivative>;

/// The steps of a model.
pub(crate) struct Steps {
    /// The trajectory of the case first, then the same with other step sizes.
    flows: RefCell<Vec<Box<dyn Derivatives>>>,
    h: f64,
    start: Point,
    dimension: usize,
}

impl Steps {
    /// The steps of a trajectory.
    pub fn new(own: Box<dyn Derivatives>) -> Self {
        Self {
            h: own.h(),
            start: own.start(),
            dimension: own.dimensions().iter().sum(),
            flows: RefCell::new(vec![own]),
        }
    }

    /// The start of the case.
    pub fn start(&self) -> State {
        Ok(self.start.clone())
    }

    /// Uses the trajectory of the case.
    pub fn with<R>(&self, used: impl FnOnce(&mut dyn Derivatives) -> R) -> R {
        used(&mut *self.flows.borrow_mut()[0])
    }

    /// Uses the trajectory with steps of size `h`.
    fn by_step<R>(
        &self,
        h: f64,
        used: impl FnOnce(&mut dyn Derivatives) -> Result<R, NoDerivative>,
    ) -> Result<R, NoDerivative> {
        let mut flows = self.flows.borrow_mut();
        let known = flows
            .iter()
            .position(|flow| flow.h().to_bits() == h.to_bits());
        let at = match known {
            Some(at) => at,
            None => {
                let other = flows[0].with_step(h)?;
                if flows.len() == MOST {
                    flows.remove(1);
                }
                flows.push(other);
                flows.len() - 1
            }
        };
        used(&mut *flows[at])
    }

    /// The observables and the invariants of a state, one after another.
    ///
    /// # Errors
    /// The state does not exist, or a function cannot be evaluated.
    pub fn seen(&self, at: &State) -> Result<Vec<f64>, NoDerivative> {
        let at = at.as_ref().map_err(Clone::clone)?;
        self.with(|own| seen(own, at))
    }
}

/// The observables and the invariants of a state, one after another.
///
/// # Errors
/// A function cannot be evaluated.
pub(crate) fn seen(own: &mut dyn Derivatives, at: &Point) -> Result<Vec<f64>, NoDerivative> {
    let mut all = own.observe(at)?;
    all.extend(own.invariants(at)?);
    Ok(all)
}

/// A matrix from its columns.
pub(crate) fn matrix(of: &Jacobian) -> DMatrix<f64> {
    DMatrix::from_column_slice(of.rows, of.cols, &of.entries)
}

impl Flow for Steps {
    type State = State;
    type Error = NoDerivative;

    fn dimension(&self) -> usize {
        self.dimension
    }

    fn step(&self, at: &State, h: f64) -> Result<State, NoDerivative> {
        let at = at.as_ref().map_err(Clone::clone)?;
        // No time, no change.
        if h == 0.0 {
            return Ok(Ok(at.clone()));
        }
        self.by_step(h, |flow| flow.step(at)).map(Ok)
    }

    fn tangent(&self, at: &State, h: f64) -> Result<(State, DMatrix<f64>), NoDerivative> {
        let at = at.as_ref().map_err(Clone::clone)?;
        let (next, tangent) = self.by_step(h, |flow| flow.tangent(at))?;
        Ok((Ok(next), matrix(&tangent)))
    }

    fn moved(&self, at: &State, by: &[f64]) -> State {
        let at = at.as_ref().map_err(Clone::clone)?;
        self.by_step(self.h, |flow| flow.moved(at, by))
    }

    fn difference(&self, from: &State, to: &State) -> Vec<f64> {
        let undefined = || vec![f64::NAN; self.dimension];
        let (Ok(from), Ok(to)) = (from, to) else {
            return undefined();
        };
        let found = self.by_step(self.h, |flow| flow.difference(from, to));
        found.unwrap_or_else(|_| undefined())
    }
}
