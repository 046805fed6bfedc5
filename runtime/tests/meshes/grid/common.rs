//! Settings and numbers for the tests.

use clebsch::Real;
use clebsch::mesh::{Domain, Functional, Setting, Wall};
use clebsch::nalgebra::SVector;
pub use clebsch::scalar::largest;

/// Pseudo-random numbers in [0, 1): the high bits of a linear congruential generator (Knuth's constants).
pub struct Numbers(u64);

impl Numbers {
    pub fn new(seed: u64) -> Self {
        Self(seed ^ 0x9e37_79b9_7f4a_7c15)
    }

    pub fn next(&mut self) -> f64 {
        let (a, c) = (6_364_136_223_846_793_005, 1_442_695_040_888_963_407);
        self.0 = self.0.wrapping_mul(a).wrapping_add(c);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub fn list(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.next()).collect()
    }
}

/// The kinds of domains of the plane: torus, channels, basin.
pub fn planes() -> [Domain<2>; 4] {
    let lengths = [1.5, 2.0];
    [
        Domain::torus(lengths),
        Domain::channel(lengths),
        Domain {
            lengths,
            walls: [Wall::Periodic, Wall::Solid],
        },
        Domain::basin(lengths),
    ]
}

pub fn lines() -> [Domain<1>; 2] {
    [Domain::torus([1.5]), Domain::basin([1.5])]
}

pub fn setting<const D: usize>(
    domain: Domain<D>,
    grid: [usize; D],
    particles: usize,
) -> Setting<D> {
    Setting {
        domain,
        grid: Some(grid),
        particles,
    }
}

/// Positions throughout a domain and near its ends: up to 0.9 of a cell beyond walls, and several periods away.
pub fn places<const D: usize>(of: &Setting<D>, seed: u64) -> Vec<[f64; D]> {
    let mut numbers = Numbers::new(seed);
    let grid = of.grid.expect("a grid");
    let one = |i: usize| {
        core::array::from_fn(|d| {
            let length = of.domain.lengths[d];
            let cell = length / grid[d] as f64;
            let x = match i % 4 {
                0 => -0.9 * cell + 1.8 * cell * numbers.next(),
                1 => length - 0.9 * cell + 1.8 * cell * numbers.next(),
                _ => length * numbers.next(),
            };
            match of.domain.walls[d] {
                Wall::Periodic => x + length * ((i % 7) as f64 - 3.0),
                Wall::Solid => x,
            }
        })
    };
    (0..of.particles).map(one).collect()
}

/// A particle field in the form that a functional takes.
pub trait Field<T, const D: usize>: Copy {
    fn of(place: [T; D]) -> Self;
    fn parts(self) -> [T; D];
}

impl<T: Real> Field<T, 1> for T {
    fn of([x]: [T; 1]) -> Self {
        x
    }

    fn parts(self) -> [T; 1] {
        [self]
    }
}

impl<T: Real> Field<T, 2> for SVector<T, 2> {
    fn of(place: [T; 2]) -> Self {
        Self::from(place)
    }

    fn parts(self) -> [T; 2] {
        [self[0], self[1]]
    }
}

/// The values of a functional.
pub fn values<T: Real, const D: usize, F: Functional<T, D>>(
    of: &mut F,
    at: &[F::Argument],
) -> Vec<T> {
    let mut out = vec![T::zero(); of.sites()];
    of.value(at, &mut out).expect("has a value");
    out
}

/// The sum, accumulated in two numbers.
pub fn sum(all: impl IntoIterator<Item = f64>) -> f64 {
    let (mut sum, mut rest) = (0.0_f64, 0.0);
    for x in all {
        let next = sum + x;
        rest += match sum.abs() >= x.abs() {
            true => (sum - next) + x,
            false => (x - next) + sum,
        };
        sum = next;
    }
    sum + rest
}
