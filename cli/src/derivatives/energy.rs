//! The energy of a model with fixed quantities, as `clebsch_analysis` takes it. Takes a problem; gives values and two
//! derivatives at states, and in one parameter.

use crate::derivatives::fixed::{self, Fixed, Place};
use crate::derivatives::flow::{State, Steps, matrix};
use crate::derivatives::problem::Problem;
use crate::derivatives::symmetry;
use crate::overrides::quantity::Quantity;
use crate::terminal::failure::Failure;
use clebsch::derivatives::{Derivatives, NoDerivative, Point};
use clebsch::nalgebra::{DMatrix, DVector};
use clebsch_analysis::{Energy, First, Flow};
use std::cell::RefCell;

/// Values of the parameter whose models are kept at the same time.
const MOST: usize = 8;

/// The distance of parameters in differences, relative to the size of the parameter: the cube root of rounding.
const DISTANCE: f64 = 6e-6;

/// The energy of a model with fixed quantities.
pub(crate) struct CaseEnergy<'a> {
    problem: &'a Problem,
    steps: &'a Steps,
    energy: usize,
    fixed: Vec<Fixed>,
    parameter: Option<Parameter>,
    models: RefCell<Vec<(f64, Box<dyn Derivatives>)>>,
}

/// A parameter that is varied.
pub(crate) struct Parameter {
    /// The quantity.
    pub quantity: Quantity,
    /// The size of its values.
    pub size: f64,
}

impl<'a> CaseEnergy<'a> {
    /// The energy of a problem.
    ///
    /// # Errors
    /// Failed: the model lacks an energy.
    pub fn new(
        problem: &'a Problem,
        steps: &'a Steps,
        fixed: Vec<Fixed>,
        parameter: Option<Parameter>,
    ) -> Result<Self, Failure> {
        let energy = fixed::energy(&problem.card).ok_or_else(|| {
            Failure::Failed(format!(
                "model `{}` conserves no energy, so it has no critical points of it. Use `clebsch linearise` or `clebsch orbit`",
                problem.card.kebab
            ))
        })?;
        Ok(Self {
            problem,
            steps,
            energy,
            fixed,
            parameter,
            models: RefCell::default(),
        })
    }

    /// The values of the fixed quantities at a state.
    ///
    /// # Errors
    /// A function cannot be evaluated.
    pub fn values(&self, at: &State, p: f64) -> Result<Vec<f64>, NoDerivative> {
        Ok(self.first(at, p)?.conserved.as_slice().to_vec())
    }

    /// The state as a state of the model with this value of the parameter, and this model.
    fn used<R>(
        &self,
        at: &State,
        p: f64,
        used: impl Fn(&mut dyn Derivatives, &Point) -> Result<R, NoDerivative>,
    ) -> Result<R, NoDerivative> {
        let at = at.as_ref().map_err(Clone::clone)?;
        let Some(parameter) = &self.parameter else {
            return self.steps.with(|own| used(own, at));
        };
        let mut models = self.models.borrow_mut();
        let known = models
            .iter()
            .position(|(own, _)| own.to_bits() == p.to_bits());
        let place = match known {
            Some(place) => place,
            None => {
                let mut case = self.problem.plan.case.clone();
                let mut motion = self.problem.plan.motion.clone();
                parameter.quantity.put(p, &mut case, &mut motion);
                let opened = self.problem.open_case(&case)?;
                if models.len() == MOST {
                    models.remove(0);
                }
                models.push((p, opened));
                models.len() - 1
            }
        };
        let Some((_, model)) = models.get_mut(place) else {
            return Err(NoDerivative::Unrecorded { what: "the energy" });
        };
        // Advected quantities of a state depend on parameters.
        let at = model.moved(at, &vec![0.0; self.steps.dimension()])?;
        used(&mut **model, &at)
    }

    /// The gradient of the energy plus multipliers times fixed quantities, and the fixed quantities.
    fn balance(
        &self,
        at: &State,
        p: f64,
        multipliers: &[f64],
    ) -> Result<(DVector<f64>, DVector<f64>), NoDerivative> {
        let first = self.first(at, p)?;
        let multipliers = DVector::from_column_slice(multipliers);
        Ok((
            first.gradient + first.gradients.tr_mul(&multipliers),
            first.conserved,
        ))
    }
}

impl Energy for CaseEnergy<'_> {
    type State = State;
    type Error = NoDerivative;

    fn dimension(&self) -> usize {
        self.steps.dimension()
    }

    fn constraints(&self) -> usize {
        self.fixed.len()
    }

    fn first(&self, at: &State, p: f64) -> Result<First, NoDerivative> {
        let found = self.used(at, p, |own, at| {
            let slopes = matrix(&own.conserved(at)?);
            let values = own.invariants(at)?;
            Ok((values, slopes, at.clone()))
        });
        let (values, slopes, at) = found?;
        let n = self.dimension();
        let value = |at: usize| values.get(at).copied().unwrap_or(f64::NAN);
        let needs = |place: &Place| matches!(place, Place::Coordinate(_));
        // An entry of an initial value is its own coordinate, counted from the start.
        let moved = match self.fixed.iter().any(|own| needs(&own.place)) {
            true => {
                let start = self.steps.start();
                self.steps.difference(&start, &Ok(at))
            }
            false => Vec::new(),
        };
        let mut gradients = DMatrix::zeros(self.fixed.len(), n);
        let mut conserved = DVector::zeros(self.fixed.len());
        for (i, own) in self.fixed.iter().enumerate() {
            match own.place {
                Place::Invariant(component) => {
                    conserved[i] = value(component);
                    gradients.row_mut(i).copy_from(&slopes.row(component));
                }
                Place::Coordinate(j) => {
                    conserved[i] = moved.get(j).copied().unwrap_or(f64::NAN);
                    gradients[(i, j)] = 1.0;
                }
            }
        }
        Ok(First {
            energy: value(self.energy),
            gradient: slopes.row(self.energy).transpose(),
            conserved,
            gradients,
        })
    }

    fn second(
        &self,
        at: &State,
        p: f64,
        multipliers: &[f64],
    ) -> Result<DMatrix<f64>, NoDerivative> {
        let mut weights = vec![0.0; self.problem.card.invariant_count()];
        weights[self.energy] = 1.0;
        for (own, multiplier) in self.fixed.iter().zip(multipliers) {
            if let Place::Invariant(component) = own.place {
                weights[component] += multiplier;
            }
        }
        self.used(at, p, |own, at| Ok(matrix(&own.curvature(at, &weights)?)))
    }

    fn in_parameter(
        &self,
        at: &State,
        p: f64,
        multipliers: &[f64],
    ) -> Result<(DVector<f64>, DVector<f64>), NoDerivative> {
        let Some(parameter) = &self.parameter else {
            let zeros = (self.dimension(), self.fixed.len());
            return Ok((DVector::zeros(zeros.0), DVector::zeros(zeros.1)));
        };
        let d = DISTANCE * parameter.size;
        let (above, more) = self.balance(at, p + d, multipliers)?;
        let (below, less) = self.balance(at, p - d, multipliers)?;
        Ok(((above - below) / (2.0 * d), (more - less) / (2.0 * d)))
    }

    fn moved(&self, at: &State, by: &[f64]) -> State {
        self.steps.moved(at, by)
    }

    fn difference(&self, from: &State, to: &State) -> Vec<f64> {
        self.steps.difference(from, to)
    }

    fn symmetries(&self, at: &State) -> DMatrix<f64> {
        symmetry::directions(self.problem, self.steps, self.energy, at)
    }
}
