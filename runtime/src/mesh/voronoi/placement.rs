//! Initial positions of particles: rectangular, staggered or hexagonal lattices, or random positions that are then
//! spread evenly. Takes a periodic domain; gives positions in it. The random numbers come from a linear congruential
//! generator (Knuth's multiplier), so positions are the same on every machine.

use super::mesh::{Plane, Voronoi};
use crate::mesh::{Domain, MeshError};
use crate::{ParameterError, Problem};
use nalgebra::SVector;

/// Random displacements from a lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Jitter {
    /// The largest displacement along either direction, in units of the square root of the area of a particle.
    pub size: f64,
    /// The seed of the random numbers.
    pub seed: u64,
}

impl Jitter {
    /// No displacement.
    pub const NONE: Self = Self { size: 0.0, seed: 0 };
}

/// A sequence of random numbers between 0 and 1, determined by its seed.
#[derive(Clone, Copy, Debug)]
struct Sequence(u64);

impl Sequence {
    fn next(&mut self) -> f64 {
        let next = self.0.wrapping_mul(6_364_136_223_846_793_005);
        self.0 = next.wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A lattice of `rows` rows of `columns` particles. If `shifted`, every second row is displaced by half a column.
#[must_use]
pub fn lattice(
    domain: &Domain<2>,
    [columns, rows]: [usize; 2],
    shifted: bool,
    jitter: Jitter,
) -> Vec<SVector<f64, 2>> {
    let [width, height] = domain.lengths;
    let (n, m) = (columns as f64, rows as f64);
    let reach = jitter.size * (domain.measure() / (n * m)).sqrt();
    let mut random = Sequence(jitter.seed);
    let mut draw = move || reach * (2.0 * random.next() - 1.0);
    let mut places = Vec::with_capacity(columns * rows);
    for j in 0..rows {
        let shift = if shifted && j % 2 == 1 { 0.75 } else { 0.25 };
        for i in 0..columns {
            let x = (i as f64 + shift) / n * width + draw();
            let y = (j as f64 + 0.5) / m * height + draw();
            places.push(Plane::new(x, y));
        }
    }
    places
}

/// Staggered rows of `columns` particles. The number of rows is chosen so that the cells are as close to regular
/// hexagons as the domain allows.
#[must_use]
pub fn hexagonal(domain: &Domain<2>, columns: usize, jitter: Jitter) -> Vec<SVector<f64, 2>> {
    let [width, height] = domain.lengths;
    let spacing = width / columns as f64 * 0.75_f64.sqrt();
    let rows = 2 * (height / (2.0 * spacing)).round().max(1.0) as usize;
    lattice(domain, [columns, rows], true, jitter)
}

/// Random particles, moved `sweeps` times to the centres of mass of their cells, all at once (Lloyd, 1982).
///
/// # Errors
/// If [`Voronoi::new`] rejects the domain or the number of particles, or if two particles coincide.
pub fn scattered(
    domain: &Domain<2>,
    particles: usize,
    sweeps: usize,
    seed: u64,
) -> Result<Vec<SVector<f64, 2>>, ParameterError> {
    let mut mesh = Voronoi::new(domain, particles)?;
    let mut random = Sequence(seed);
    // Skip the numbers that a lattice with the same seed uses.
    for _ in 0..2 * particles {
        random.next();
    }
    let [width, height] = domain.lengths;
    let mut places = Vec::with_capacity(particles);
    for _ in 0..particles {
        let x = random.next() * width;
        places.push(Plane::new(x, random.next() * height));
    }
    relax(&mut mesh, &mut places, sweeps).map_err(|_| ParameterError {
        field: "seed",
        problem: Problem::AssumptionFails {
            text: "no two particles start at the same position",
        },
        remedy: "use another seed",
    })?;
    Ok(places)
}

/// Moves all particles to the centres of mass of their cells, `sweeps` times.
///
/// # Errors
/// The errors of [`Voronoi::update`].
pub fn relax(
    mesh: &mut Voronoi<f64>,
    places: &mut [SVector<f64, 2>],
    sweeps: usize,
) -> Result<(), MeshError> {
    let mut areas = vec![0.0; mesh.sites()];
    let mut centres = vec![Plane::zeros(); mesh.sites()];
    for _ in 0..sweeps {
        mesh.update(places)?;
        mesh.areas(&mut areas)?;
        mesh.centroids(&areas, &mut centres)?;
        for (place, centre) in places.iter_mut().zip(&centres) {
            *place += centre;
        }
    }
    Ok(())
}
