//! Depth on a grid: B-splines spread the masses of particles over nodes, `H_i = Σ_a m_a Φ_i(X_a) / w_i`. Φ_i is the
//! spline of node i with its images behind walls, and w_i the weight of the node in the trapezoid rule. Then
//! `Σ w_i H_i = Σ m_a` to rounding. Takes positions that need not be wrapped; the transposed derivative gathers
//! `m_a Σ_i seed_i Φ_i'(X_a) / w_i`, the exact gradient.

use super::super::{Functional, MeshError, Setting};
use super::nodes::Nodes;
use super::padded::Padded;
use super::position::Position;
use super::sorted::{Rows, Sorted};
use super::spline::{Basis, Splines};
use super::stencil::{gather, interpolate, scatter};
use crate::line::Threads;
use crate::{ParameterError, Problem, Real};
use nalgebra::SVector;

/// The number of rows in a stripe, which one thread deposits. Stripes of even number come first, then stripes of odd
/// number: neighbours overlap by `K - 1` rows, so the order of the sum is fixed.
const STRIPE: usize = 8;

/// The least number of particles for a thread; with fewer, waking the thread costs more than it saves.
const FEWEST: usize = 4096;

/// The largest number of particles: indices have 32 bits.
const MOST: usize = u32::MAX as usize;

/// Deposit and gather with splines of support `K`.
#[derive(Clone, Debug)]
struct Deposit<T, const D: usize, const K: usize> {
    nodes: Nodes<D>,
    mass: Vec<T>,
    sorted: Sorted<T, D>,
    padded: Padded<T, D>,
}

impl<T: Real, const D: usize, const K: usize> Deposit<T, D, K>
where
    Splines<K>: Basis<K>,
{
    fn new(setting: &Setting<D>, mass: &[T]) -> Result<Self, ParameterError> {
        let nodes = Nodes::new(setting)?;
        let refused = |problem, remedy| ParameterError {
            field: "mass",
            problem,
            remedy,
        };
        if mass.len() != setting.particles || mass.len() > MOST {
            return Err(refused(
                Problem::AssumptionFails {
                    text: "there is one mass for each particle, and fewer than 2^32 particles",
                },
                "give one mass for each particle",
            ));
        }
        if let Some(index) = mass.iter().position(|m| !m.is_finite()) {
            return Err(refused(
                Problem::NotFinite {
                    index,
                    value: mass[index].value(),
                },
                "give finite masses",
            ));
        }
        if T::LANES > 1 {
            return Err(refused(
                Problem::AssumptionFails {
                    text: "the scalar has one lane",
                },
                "run the members of an ensemble one after another",
            ));
        }
        Ok(Self {
            nodes,
            mass: mass.to_vec(),
            sorted: Sorted::new(mass.len(), nodes.axes()[0].intervals()),
            padded: Padded::new::<K>(&nodes),
        })
    }

    fn share(&mut self, threads: Threads) {
        let most = if cfg!(feature = "rayon") {
            threads.0
        } else {
            1
        };
        self.sorted.share(most.min(self.mass.len() / FEWEST));
    }

    fn value<A: Position<T, D>>(&mut self, at: &[A], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(at, self.mass.len())?;
        MeshError::unless_of_length(out, self.nodes.count())?;
        self.sorted.sort(self.nodes.axes(), at, &self.mass)?;
        let width = self.padded.width();
        let places = self.padded.cleared();
        let stripe = STRIPE * width;
        for parity in 0..2 {
            let places = places.get_mut(parity * stripe..).unwrap_or_default();
            let spread = |(pair, places): (usize, &mut [T])| {
                let first = (2 * pair + parity) * STRIPE;
                let last = (first + STRIPE).min(self.nodes.axes()[0].intervals());
                for (row, from) in (first..last).zip((0..).step_by(width)) {
                    for particles in self.sorted.row(row).filter(|row| !row.is_empty()) {
                        scatter::<T, D, K>(&mut places[from..from + K * width], width, particles);
                    }
                }
            };
            #[cfg(feature = "rayon")]
            if let Some(each) = self.sorted.each(places.len().div_ceil(2 * stripe)) {
                use rayon::prelude::*;
                let groups = places.par_chunks_mut(2 * stripe * each).enumerate();
                groups.for_each(|(group, places)| {
                    let pairs = (group * each..).zip(places.chunks_mut(2 * stripe));
                    pairs.for_each(spread);
                });
                continue;
            }
            places.chunks_mut(2 * stripe).enumerate().for_each(spread);
        }
        self.padded.fold(out);
        Ok(())
    }

    fn pull_back<A: Position<T, D>>(&mut self, seed: &[T], out: &mut [A]) -> Result<(), MeshError> {
        MeshError::unless_of_length(seed, self.nodes.count())?;
        MeshError::unless_of_length(out, self.mass.len())?;
        self.padded.extend(seed);
        let (places, width) = (self.padded.places(), self.padded.width());
        let density = core::array::from_fn(|d| self.nodes.axes()[d].density());
        let collect = |(rows, out): (Rows<'_, T, D>, &mut [A])| {
            for (row, from) in (0..self.nodes.axes()[0].intervals()).zip((0..).step_by(width)) {
                let particles = rows.row(row);
                if !particles.is_empty() {
                    let places = &places[from..from + K * width];
                    gather::<T, A, D, K>(places, width, &density, particles, out);
                }
            }
        };
        let ranges = self
            .sorted
            .ranges()
            .zip(out.chunks_mut(self.sorted.range()));
        #[cfg(feature = "rayon")]
        if let Some(each) = self.sorted.each(self.sorted.ranges().count()) {
            use rayon::prelude::*;
            let groups = super::sorted::grouped(ranges, each).into_par_iter();
            groups.for_each(|group| group.into_iter().for_each(collect));
            return Ok(());
        }
        ranges.for_each(collect);
        Ok(())
    }

    /// Runs once for each start, so one thread suffices.
    fn interpolate(&mut self, values: &[T], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(values, self.nodes.count())?;
        MeshError::unless_of_length(out, self.mass.len())?;
        let weights = self.nodes.weights::<T>();
        let seed: Vec<T> = values.iter().zip(weights).map(|(v, w)| *v * w).collect();
        self.padded.extend(&seed);
        let (places, width) = (self.padded.places(), self.padded.width());
        let ranges = self.sorted.ranges();
        for (rows, out) in ranges.zip(out.chunks_mut(self.sorted.range())) {
            for (row, from) in (0..self.nodes.axes()[0].intervals()).zip((0..).step_by(width)) {
                let places = &places[from..from + K * width];
                interpolate::<T, D, K>(places, width, rows.row(row), out);
            }
        }
        Ok(())
    }
}

/// The functionals that models name, for lines and for the plane.
macro_rules! named {
    ($(#[$doc:meta])* $name:ident, $support:literal) => {
        $(#[$doc])*
        // Named as in models.
        #[allow(non_camel_case_types)]
        #[derive(Clone, Debug)]
        pub struct $name<T, const D: usize>(Deposit<T, D, $support>);

        named!($name, 1, T);
        named!($name, 2, SVector<T, 2>);

        impl<T: Real, const D: usize> $name<T, D> {
            /// Interpolates values at the nodes to the particles of the last deposit, by the same splines:
            /// `Σ_i values_i Φ_i(X_a)`, independent of their masses. The pull-back of the values times the weights of
            /// nodes is the gradient of this interpolant times the mass.
            ///
            /// # Errors
            /// If one of the lists has the wrong length.
            pub fn interpolate(&mut self, values: &[T], out: &mut [T]) -> Result<(), MeshError> {
                self.0.interpolate(values, out)
            }
        }
    };
    ($name:ident, $d:literal, $position:ty) => {
        impl<T: Real> Functional<T, $d> for $name<T, $d> {
            type Argument = $position;
            type Data<'a> = (&'a [T],);

            fn new(setting: &Setting<$d>, (mass,): (&[T],)) -> Result<Self, ParameterError> {
                Deposit::new(setting, mass).map(Self)
            }

            fn sites(&self) -> usize {
                self.0.nodes.count()
            }

            fn value(&mut self, at: &[$position], out: &mut [T]) -> Result<(), MeshError> {
                self.0.value(at, out)
            }

            fn pull_back(
                &mut self,
                _: &[$position],
                seed: &[T],
                out: &mut [$position],
            ) -> Result<(), MeshError> {
                self.0.pull_back(seed, out)
            }

            fn share(&mut self, threads: Threads) {
                self.0.share(threads);
            }
        }
    };
}

named! {
    /// Depth on a grid by cubic B-splines, `mesh H: Real at n = deposit(X, m);`: its argument is the positions of
    /// particles, its data their masses.
    deposit, 4
}

named! {
    /// Depth on a grid by quintic B-splines, with four continuous derivatives.
    deposit_quintic, 6
}
