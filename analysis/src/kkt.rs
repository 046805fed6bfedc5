//! The equations of a critical point at fixed conserved quantities: dE + sum of lambda_i dC_i = 0 and C = c.

use crate::equilibrium::EquilibriumError;
use crate::error;
use crate::flow::{Energy, First};
use crate::newton::Equations;
use crate::singular::Singular;
use nalgebra::{DMatrix, DVector};

/// A state with multipliers and a value of the parameter. The multipliers are in the units of the equations.
#[derive(Clone)]
pub(crate) struct Point<S> {
    pub state: S,
    pub multipliers: DVector<f64>,
    pub p: f64,
}

/// The equations in units of the start, so that tolerances do not depend on the units of energy and of conserved
/// quantities.
pub(crate) struct Kkt<'a, E> {
    pub energy: &'a E,
    /// The values c of the conserved quantities, in their units.
    values: DVector<f64>,
    /// The unit of energy: the largest second derivative or force at the start.
    pub unit: f64,
    /// The units of the conserved quantities: the norms of their gradients at the start.
    units: DVector<f64>,
}

type Result<T, E> = std::result::Result<T, EquilibriumError<<E as Energy>::Error>>;

impl<'a, E: Energy> Kkt<'a, E> {
    /// The equations, and the multipliers that come closest to balancing the gradient at the start. Accepts as many
    /// finite values as the energy has conserved quantities.
    pub fn new(
        energy: &'a E,
        values: &[f64],
        start: &E::State,
        p: f64,
    ) -> Result<(Self, Point<E::State>), E> {
        let (n, m) = (energy.dimension(), energy.constraints());
        error::number("coordinates", n, usize::MAX)?;
        error::finite("parameter", &[p])?;
        let values = DVector::from_column_slice(values);
        error::vector("values of the conserved quantities", &values, m)?;
        let mut kkt = Self {
            energy,
            values,
            unit: 1.0,
            units: DVector::from_element(m, 1.0),
        };
        let first = kkt.first(start, p)?;
        let balance = Singular::new(&first.gradients.transpose());
        let multipliers = -balance.solve(&first.gradient, f64::EPSILON, 0.0);
        let mut point = Point {
            state: start.clone(),
            multipliers,
            p,
        };
        let one_if_zero = |x: f64| if x > 0.0 && x.is_finite() { x } else { 1.0 };
        kkt.unit = one_if_zero(kkt.second(&point)?.amax().max(first.gradient.amax()));
        kkt.units = DVector::from_iterator(
            m,
            first
                .gradients
                .row_iter()
                .map(|row| one_if_zero(row.norm())),
        );
        kkt.values.component_div_assign(&kkt.units);
        point.multipliers = point.multipliers.component_mul(&kkt.units) / kkt.unit;
        Ok((kkt, point))
    }

    /// The multipliers in the units of the user.
    pub fn multipliers(&self, at: &Point<E::State>) -> DVector<f64> {
        at.multipliers.component_div(&self.units) * self.unit
    }

    /// The number of equations at a fixed parameter.
    pub fn size(&self) -> usize {
        self.energy.dimension() + self.energy.constraints()
    }

    /// The energy in the unit of the user, and all other values in the units of the equations, checked.
    pub fn first(&self, at: &E::State, p: f64) -> Result<First, E> {
        let mut first = self
            .energy
            .first(at, p)
            .map_err(|source| EquilibriumError::Energy { p, source })?;
        let (n, m) = (self.energy.dimension(), self.energy.constraints());
        error::finite("energy", &[first.energy])?;
        error::vector("gradient of the energy", &first.gradient, n)?;
        error::vector("vector of conserved quantities", &first.conserved, m)?;
        error::matrix(
            "matrix of gradients of the conserved quantities",
            &first.gradients,
            (m, n),
        )?;
        first.gradient /= self.unit;
        first.conserved.component_div_assign(&self.units);
        for (mut row, unit) in first.gradients.row_iter_mut().zip(self.units.iter()) {
            row /= *unit;
        }
        Ok(first)
    }

    /// The Hessian with multipliers, checked and made symmetric.
    pub fn second(&self, at: &Point<E::State>) -> Result<DMatrix<f64>, E> {
        let second = self
            .energy
            .second(&at.state, at.p, self.multipliers(at).as_slice());
        let second = second.map_err(|source| EquilibriumError::Energy { p: at.p, source })?;
        let n = self.energy.dimension();
        error::matrix("Hessian", &second, (n, n))?;
        Ok((&second + second.transpose()) * (0.5 / self.unit))
    }

    /// The derivative of the equations with respect to the parameter.
    pub fn in_parameter(&self, at: &Point<E::State>) -> Result<DVector<f64>, E> {
        let both = self
            .energy
            .in_parameter(&at.state, at.p, self.multipliers(at).as_slice());
        let (gradient, conserved) =
            both.map_err(|source| EquilibriumError::Energy { p: at.p, source })?;
        let (n, m) = (self.energy.dimension(), self.energy.constraints());
        error::vector("derivative of the gradient with respect to p", &gradient, n)?;
        error::vector(
            "derivative of the conserved quantities with respect to p",
            &conserved,
            m,
        )?;
        Ok(stacked(
            &(gradient / self.unit),
            &conserved.component_div(&self.units),
        ))
    }
}

fn stacked(a: &DVector<f64>, b: &DVector<f64>) -> DVector<f64> {
    DVector::from_iterator(a.len() + b.len(), a.iter().chain(b.iter()).copied())
}

impl<E: Energy> Equations for Kkt<'_, E> {
    type State = Point<E::State>;
    type Error = EquilibriumError<E::Error>;

    fn residual(&self, at: &Self::State) -> Result<DVector<f64>, E> {
        let first = self.first(&at.state, at.p)?;
        let gradient = &first.gradient + first.gradients.tr_mul(&at.multipliers);
        let residual = stacked(&gradient, &(&first.conserved - &self.values));
        error::finite("residual of the equilibrium", residual.as_slice())?;
        Ok(residual)
    }

    /// The derivative leaves out the change of coordinates along a step, which vanishes at a solution.
    fn linearised(&self, at: &Self::State) -> Result<(DVector<f64>, DMatrix<f64>), E> {
        let residual = self.residual(at)?;
        let gradients = self.first(&at.state, at.p)?.gradients;
        let (n, m) = (self.energy.dimension(), self.energy.constraints());
        let mut derivative = DMatrix::zeros(n + m, n + m);
        derivative
            .view_mut((0, 0), (n, n))
            .copy_from(&self.second(at)?);
        derivative.view_mut((n, 0), (m, n)).copy_from(&gradients);
        derivative
            .view_mut((0, n), (n, m))
            .copy_from(&gradients.transpose());
        Ok((residual, derivative))
    }

    /// Moves the state and the multipliers, and the parameter by a last number if there is one.
    fn moved(&self, at: &Self::State, by: &DVector<f64>) -> Self::State {
        let (n, m) = (self.energy.dimension(), self.energy.constraints());
        Point {
            state: self.energy.moved(&at.state, &by.as_slice()[..n]),
            multipliers: &at.multipliers + by.rows(n, m),
            p: at.p + by.get(n + m).copied().unwrap_or(0.0),
        }
    }
}
