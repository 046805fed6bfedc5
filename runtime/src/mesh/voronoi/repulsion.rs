//! A repulsion between particles that are too close, `mesh core: Real at a = pair_core(X, m, rc, kappa);`. Cell areas
//! do not depend on the distance of their sites, so nothing else separates particles in shear. Takes positions on a
//! torus, masses, a radius and a strength; gives energies and exact derivatives.

use super::bins::Bins;
use super::masses::check_masses;
use super::mesh::{Plane, cleared};
use crate::mesh::{Functional, MeshError, Setting, Wall};
use crate::{ParameterError, Problem, Real};
use nalgebra::SVector;

/// Half the energy of all pairs that contain a particle. A pair at the distance `R < rc` has the energy
/// `kappa <m> (1 - R/rc)^3`, where `<m>` is the mean of the masses and `kappa` is a squared velocity.
///
/// The energy is twice continuously differentiable, and zero if all particles are at least `rc` apart. For a layer
/// with the depth `h0` and the wave speed `c0^2 = g h0`, use `kappa = c0^2 / 10` and `rc` of 0.7 times the distance of
/// particles at rest: these values resist shear.
#[allow(non_camel_case_types)] // Models name it.
#[derive(Clone, Debug)]
pub struct pair_core<T> {
    bins: Bins,
    radius: T,
    /// `kappa <m>`.
    strength: T,
    /// The pairs within the radius at the last evaluation, in both orders, sorted by first particle.
    pairs: Vec<Pair<T>>,
}

/// A particle and a close neighbour.
#[derive(Clone, Copy, Debug)]
struct Pair<T> {
    first: u32,
    second: u32,
    /// The vector from the first particle to the second.
    apart: SVector<T, 2>,
    distance: T,
}

impl<T: Real> pair_core<T> {
    /// The number of pairs within the radius at the last evaluation.
    #[must_use]
    pub fn pairs(&self) -> usize {
        self.pairs.len() / 2
    }

    /// `1 - distance / radius`.
    fn nearness(&self, distance: T) -> T {
        T::one() - distance / self.radius
    }
}

impl<T: Real> Functional<T, 2> for pair_core<T> {
    type Argument = SVector<T, 2>;
    /// The masses, the radius and the strength.
    type Data<'a> = (&'a [T], T, T);

    fn new(
        setting: &Setting<2>,
        (masses, radius, strength): (&[T], T, T),
    ) -> Result<Self, ParameterError> {
        check_masses(masses, setting.particles)?;
        let refused = |field, problem, remedy| ParameterError {
            field,
            problem,
            remedy,
        };
        let value = radius.value();
        let shortest = setting.domain.lengths[0].min(setting.domain.lengths[1]);
        if !(radius.is_finite() && value > 0.0) {
            let remedy = "give the distance at which particles begin to repel, about 0.7 of their distance in equilibrium";
            return Err(refused("rc", Problem::NotPositive { value }, remedy));
        }
        if value > 0.5 * shortest {
            let text = "the radius is at most half of either period";
            let remedy =
                "give a smaller radius, so that no particle interacts with two copies of another";
            return Err(refused("rc", Problem::AssumptionFails { text }, remedy));
        }
        if setting.domain.walls != [Wall::Periodic; 2] || T::LANES > 1 {
            let text = "the domain is periodic in both directions, and the scalar has one lane";
            let remedy = "place the particles on a torus";
            return Err(refused("domain", Problem::AssumptionFails { text }, remedy));
        }
        if !(strength.is_finite() && strength.value() >= 0.0) {
            let value = strength.value();
            let remedy = "give the square of a velocity, about a tenth of the squared wave speed";
            return Err(refused("kappa", Problem::NotPositive { value }, remedy));
        }
        let sum = masses.iter().fold(T::zero(), |sum, m| sum + *m);
        let mean = sum / T::from_f64(setting.particles as f64);
        Ok(Self {
            bins: Bins::new(setting.domain.lengths, value, setting.particles),
            radius,
            strength: strength * mean,
            pairs: Vec::new(),
        })
    }

    fn sites(&self) -> usize {
        self.bins.particles()
    }

    fn value(&mut self, at: &[Self::Argument], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(at, self.sites())?;
        MeshError::unless_of_length(out, self.sites())?;
        self.bins
            .sort(|site| [at[site][0].value(), at[site][1].value()])?;
        self.pairs.clear();
        let half = T::from_f64(0.5) * self.strength;
        for (first, out) in out.iter_mut().enumerate() {
            let mut sum = T::zero();
            let pairs = &mut self.pairs;
            let (radius, bins) = (self.radius, &self.bins);
            bins.near(first, |second, shift| {
                let apart = at[second] - at[first] + Plane::from(shift).map(T::from_f64);
                let square = apart[0] * apart[0] + apart[1] * apart[1];
                if square.value() >= (radius * radius).value() {
                    return Ok(());
                }
                if square.value() <= 0.0 {
                    let (first, second) = (first.min(second), first.max(second));
                    return Err(MeshError::Coincident { first, second });
                }
                let distance = square.sqrt();
                let nearness = T::one() - distance / radius;
                sum += nearness * nearness * nearness;
                pairs.push(Pair {
                    first: first as u32,
                    second: second as u32,
                    apart,
                    distance,
                });
                Ok(())
            })?;
            *out = half * sum;
        }
        Ok(())
    }

    fn pull_back(
        &mut self,
        _: &[Self::Argument],
        seed: &[T],
        out: &mut [Self::Argument],
    ) -> Result<(), MeshError> {
        cleared(seed, out, self.sites())?;
        let scale = T::from_f64(1.5) * self.strength / self.radius;
        for pair in &self.pairs {
            let (first, second) = (pair.first as usize, pair.second as usize);
            let nearness = self.nearness(pair.distance);
            let push = (seed[first] + seed[second]) * scale * nearness * nearness / pair.distance;
            // The energy rises if the first particle moves towards the second, so its gradient there points along
            // `apart`.
            out[first] += pair.apart * push;
        }
        Ok(())
    }
}
