//! Velocities of particles from their momenta. Takes the momenta of the model, which are affine in the
//! velocities; gives velocities, masses, and the rotation of the frame. The rotation is the curl of the part of
//! a momentum that is independent of the velocity.

use crate::plan::Plan;
use clebsch::card::Card;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::ChainConfig;
use clebsch_interpret::lines::LineModel;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Computes velocities from momenta.
pub(super) struct Kinematics {
    model: Arc<LineModel>,
    choice: ChainConfig,
    /// Parameters, by their ASCII names. A parameter at sites has the values of all sites.
    numbers: HashMap<String, Vec<f64>>,
    field: String,
    size: usize,
    lengths: Vec<f64>,
}

/// The motion of all particles, concatenated.
pub(super) struct Motion {
    pub velocities: Vec<f64>,
    /// Present if the mass matrix of every particle is a multiple of the identity.
    pub masses: Option<Vec<f64>>,
    /// In the plane, with masses.
    pub rotations: Option<Vec<f64>>,
}

impl Kinematics {
    /// For the positions in `field`. `None` if the text of the model cannot be read, or if the plan has no
    /// sites.
    pub(super) fn of(
        (card, plan): (&Card, &Plan),
        field: &str,
        size: usize,
        lengths: &[f64],
    ) -> Option<Self> {
        let mut numbers: HashMap<String, Vec<f64>> = HashMap::new();
        let names: HashSet<&str> = card.parameters.iter().map(|p| p.ascii).collect();
        for (own, value) in card.parameters.iter().zip(&plan.case.parameters) {
            numbers.insert(own.ascii.to_owned(), value.clone());
            // The copies are in the order of their sites.
            if let Some((base, site)) = own.ascii.rsplit_once('_')
                && site.parse::<usize>().is_ok()
                && !names.contains(base)
            {
                numbers.entry(base.to_owned()).or_default().extend(value);
            }
        }
        Some(Self {
            model: LineModel::read(card.source).ok()?,
            choice: plan.choice.clone()?,
            numbers,
            field: field.to_owned(),
            size,
            lengths: lengths.to_vec(),
        })
    }

    /// The values of a parameter.
    pub(super) fn parameter(&self, name: &str) -> Option<&Vec<f64>> {
        self.numbers.get(name)
    }

    /// The momenta for these positions and velocities.
    fn momenta(&self, places: &[f64], velocities: &[f64]) -> Option<Vec<f64>> {
        let given = |name: &str| match ascii(name) {
            own if own == ascii(&self.field) => Some(places.to_vec()),
            own => self.numbers.get(&own).cloned(),
        };
        let found = self
            .model
            .momenta(&self.choice, &given, &self.field, velocities);
        found.ok().flatten()
    }

    /// The motion for these positions and momenta.
    pub(super) fn motion(&self, places: &[f64], momenta: &[f64]) -> Option<Motion> {
        let count = places.len() / self.size;
        let along = |d: usize| -> Vec<f64> {
            let unit = |i: usize| f64::from(u8::from(i % self.size == d));
            (0..places.len()).map(unit).collect()
        };
        let rest = self.momenta(places, &vec![0.0; places.len()])?;
        let pushed: Option<Vec<Vec<f64>>> = (0..self.size)
            .map(|d| self.momenta(places, &along(d)))
            .collect();
        let pushed = pushed?;
        // Entry (i, j) of the mass of a particle.
        let mass = |a: usize, i: usize, j: usize| {
            let at = a * self.size + i;
            Some(pushed.get(j)?.get(at)? - rest.get(at)?)
        };
        let own = |a: usize, i: usize| {
            let at = a * self.size + i;
            Some(momenta.get(at)? - rest.get(at)?)
        };
        let mut velocities = Vec::with_capacity(places.len());
        let mut masses = Some(Vec::with_capacity(count));
        for a in 0..count {
            match self.size {
                1 => velocities.push(own(a, 0)? / mass(a, 0, 0)?),
                2 => {
                    let [m, n] = [mass(a, 0, 0)?, mass(a, 0, 1)?];
                    let [k, l] = [mass(a, 1, 0)?, mass(a, 1, 1)?];
                    let [p, q] = [own(a, 0)?, own(a, 1)?];
                    let whole = m * l - n * k;
                    velocities.extend([(l * p - n * q) / whole, (m * q - k * p) / whole]);
                    // The entries are differences with rounding errors, hence the tolerance.
                    let same = (m - l).abs() + n.abs() + k.abs() <= 1e-6 * m.abs();
                    masses = masses.filter(|_| same);
                }
                _ => return None,
            }
            if let Some(masses) = &mut masses {
                masses.push(mass(a, 0, 0)?);
            }
        }
        let rotations = masses
            .as_ref()
            .filter(|_| self.size == 2)
            .and_then(|masses| self.rotations(places, &rest, masses));
        Some(Motion {
            velocities,
            masses,
            rotations,
        })
    }

    /// The curl of the momenta of particles at rest, by finite differences over a small part of the domain.
    fn rotations(&self, places: &[f64], rest: &[f64], masses: &[f64]) -> Option<Vec<f64>> {
        if rest.iter().all(|p| *p == 0.0) {
            return Some(vec![0.0; masses.len()]);
        }
        let still = vec![0.0; places.len()];
        let difference = |d: usize| -> Option<(Vec<f64>, Vec<f64>, f64)> {
            let reach = f64::EPSILON.cbrt() * self.lengths.get(d)?;
            let moved = |by: f64| -> Vec<f64> {
                let each = places.iter().enumerate();
                each.map(|(i, x)| if i % 2 == d { x + by } else { *x })
                    .collect()
            };
            let [up, down] = [moved(reach), moved(-reach)];
            Some((
                self.momenta(&up, &still)?,
                self.momenta(&down, &still)?,
                2.0 * reach,
            ))
        };
        let (right, left, wide) = difference(0)?;
        let (upper, lower, tall) = difference(1)?;
        let curl = |(a, mass): (usize, &f64)| {
            let of = |list: &[f64], d: usize| list.get(2 * a + d).copied();
            let along = (of(&right, 1)? - of(&left, 1)?) / wide;
            let across = (of(&upper, 0)? - of(&lower, 0)?) / tall;
            Some((along - across) / mass)
        };
        masses.iter().enumerate().map(curl).collect()
    }
}
