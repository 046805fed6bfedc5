//! The elastic rod: random states, with the results of the compiled and the hand-written stepper.

use super::tops::{body_momenta, entries, entries_of, matrix, rotations};
use super::{Shown, System, attitude, moments, stretched, turn, turned};
use clebsch::nalgebra::Vector3;
use clebsch_models::lattices::geometrically_exact_rod::*;
use clebsch_oracle::handwritten::attitude::{Quaternion, Vector, scaled_matrix};
use clebsch_oracle::handwritten::lattices::geometrically_exact_rod::{ElasticRod, End, Ends, Rod};
use clebsch_oracle::oracle::points::Source;

/// An elastic rod.
#[derive(Clone)]
pub struct Elastic {
    rod: Rod,
    places: Vec<Vector>,
    momenta: Vec<Vector>,
    attitudes: Vec<Quaternion>,
    body_momenta: Vec<Vector>,
    h: f64,
}

/// The first and the last end of an open rod, from twelve pairs.
fn ends(source: &mut Source, pair: usize) -> [End; 2] {
    let mut end = |which: usize| match which {
        0 => End::FREE,
        1 => End::Pinned,
        2 => End::Clamped {
            wall: attitude(source),
            bonds: 2.0,
        },
        _ => End::Loaded(source.vector()),
    };
    [end(pair % 3), end(pair / 3)]
}

impl Elastic {
    /// Whether an end prescribes the first and the last node.
    fn held(&self) -> [bool; 2] {
        match self.rod.ends {
            Ends::Ring(_) => [false; 2],
            Ends::Open { first, last } => [first, last].map(|end| !matches!(end, End::Loaded(_))),
        }
    }

    /// The momenta of the free nodes.
    fn of_moving(&self, momenta: Vec<f64>) -> Vec<f64> {
        let [first, last] = self.held().map(|held| 3 * usize::from(held));
        momenta[first..momenta.len() - last].to_vec()
    }

    fn sites(&self) -> GeometricallyExactRodSites {
        use {GeometricallyExactRodFirst as First, GeometricallyExactRodLast as Last};
        let ends = match self.rod.ends {
            Ends::Ring(growth) => GeometricallyExactRodEnds::Ring { X: growth.into() },
            Ends::Open { first, last } => GeometricallyExactRodEnds::Open {
                first: match first {
                    End::Loaded(_) => First::Free,
                    End::Pinned => First::Pinned,
                    End::Clamped { wall, .. } => First::Clamped {
                        Λw: matrix(&wall.matrix()),
                    },
                },
                last: match last {
                    End::Loaded(force) if force == [0.0; 3] => Last::Free,
                    End::Loaded(force) => Last::Load {
                        force: force.into(),
                    },
                    End::Pinned => Last::Pinned,
                    End::Clamped { wall, .. } => Last::Clamped {
                        Λw: matrix(&wall.matrix()),
                    },
                },
            },
        };
        GeometricallyExactRodSites {
            N: self.attitudes.len(),
            ends,
        }
    }
}

/// An end with one datum increased by a fraction: the clamp stiffness if `bonds`, otherwise the wall.
fn other_end(end: &mut End, bonds: bool, share: f64) -> Option<()> {
    match end {
        End::Clamped {
            bonds: strength, ..
        } if bonds => *strength *= 1.0 + share,
        End::Clamped { wall, .. } => *wall = wall.times(&turn([0.0, 0.6, 0.8], share)),
        End::Loaded(force) if *force != [0.0; 3] && !bonds => *force = stretched(*force, share),
        _ => return None,
    }
    Some(())
}

impl System for Elastic {
    const KINDS: usize = 20;
    const ENDS: usize = 13;

    fn draw(source: &mut Source, n: usize, which: usize) -> Self {
        let ring = which == 12;
        let nodes = n + usize::from(!ring);
        let s = source.between(0.4, 1.0);
        let (along, off): (Vector, Vector) = (source.vector(), source.vector());
        // One section type for all segments, or one per segment.
        let alike = source.chance(50).then(|| moments(source));
        let places: Vec<Vector> = (0..nodes)
            .map(|i| {
                let off: Vector = source.vector();
                std::array::from_fn(|k| s * (i as f64) * along[k] + 0.2 * off[k])
            })
            .collect();
        Self {
            places,
            momenta: (0..nodes).map(|_| source.vector()).collect(),
            attitudes: (0..n).map(|_| attitude(source)).collect(),
            body_momenta: (0..n).map(|_| source.vector()).collect(),
            rod: Rod {
                spacing: s,
                masses: (0..nodes).map(|_| source.between(0.3, 1.0)).collect(),
                poinsots: (0..n)
                    .map(|_| alike.unwrap_or_else(|| moments(source)))
                    .collect(),
                shear: source.positive::<3>().0,
                bending: source.positive::<3>().0,
                gravity: source.vector(),
                ends: match ring {
                    true => Ends::Ring(std::array::from_fn(|k| {
                        s * (n as f64) * along[k] + 0.2 * off[k]
                    })),
                    false => {
                        let [first, last] = ends(source, which);
                        Ends::Open { first, last }
                    }
                },
            },
            h: source.between(0.01, 0.1),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Option<Self> {
        let mut moved = self.clone();
        let factor = 1.0 + share;
        let larger = |all: &[Vector]| all.iter().map(|v| stretched(*v, share)).collect();
        let (rod, last, sections) = (&mut moved.rod, self.places.len() - 1, self.attitudes.len());
        let [first_held, last_held] = self.held();
        match kind {
            0 => moved.momenta = larger(&self.momenta),
            1 => moved.body_momenta = larger(&self.body_momenta),
            2 => moved.attitudes = turned(&self.attitudes, share),
            3 => {
                let all = moved.places.iter_mut().step_by(2);
                all.for_each(|x| *x = stretched(*x, share));
            }
            4 => rod.spacing *= factor,
            5 => rod.shear = scaled_matrix(factor, &rod.shear),
            6 => rod.bending = scaled_matrix(factor, &rod.bending),
            7 => rod.gravity = stretched(rod.gravity, share),
            // The mass of a prescribed node appears in no equation.
            8 if first_held => return None,
            8 => rod.masses[0] *= factor,
            9 if last_held => return None,
            9 => rod.masses[last] *= factor,
            10 if last == 1 => return None,
            10 => rod.masses[last / 2] *= factor,
            11..14 => {
                let at = [0, sections / 2, sections - 1][kind - 11];
                rod.poinsots[at] = scaled_matrix(factor, &rod.poinsots[at]);
            }
            14..18 => {
                let Ends::Open { first, last } = &mut rod.ends else {
                    return None;
                };
                let end = if kind < 16 { first } else { last };
                other_end(end, kind % 2 == 1, share)?;
            }
            18 => {
                let Ends::Ring(growth) = &mut rod.ends else {
                    return None;
                };
                *growth = stretched(*growth, share);
            }
            // Adds to a single entry, because a common factor might cancel.
            _ => {
                rod.bending[0][2] += share;
                rod.bending[2][0] += share;
            }
        }
        Some(moved)
    }

    fn by_hand(&self, steps: usize) -> Option<Shown> {
        let mut rod = ElasticRod::start(
            &self.rod,
            &self.places,
            &self.momenta,
            &self.attitudes,
            &self.body_momenta,
            self.h,
        )
        .ok()?;
        for _ in 0..steps {
            rod.step().ok()?;
        }
        Some(vec![
            rod.places().flatten().collect(),
            self.of_moving(rod.momenta().flatten().collect()),
            entries(rod.attitudes()),
            rod.spatial_momenta().flatten().collect(),
        ])
    }

    fn generated(&self, steps: usize) -> Option<Shown> {
        let rod = &self.rod;
        let parameters = GeometricallyExactRodParameters {
            s: rod.spacing,
            m: rod.masses.clone(),
            J: rod.poinsots.iter().map(matrix).collect(),
            S: matrix(&rod.shear),
            B: matrix(&rod.bending),
            g: rod.gravity.into(),
        };
        let vectors = |all: &[Vector]| -> Vec<Vector3<f64>> {
            all.iter().map(|v| Vector3::from(*v)).collect()
        };
        let rod = GeometricallyExactRod::new(parameters, self.sites()).ok()?;
        let initial = GeometricallyExactRodInitial {
            φ: vectors(&self.places),
            momentum_φ: vectors(&self.momenta),
            Λ: rotations(&self.attitudes),
            body_momentum_Λ: body_momenta(&self.body_momenta),
        };
        let (mut state, mut work) = rod.start(initial, self.h).ok()?;
        for _ in 0..steps {
            rod.step(&mut state, &mut work).ok()?;
        }
        let flat = |all: &[Vector3<f64>]| -> Vec<f64> {
            all.iter().flat_map(|v| v.as_slice().to_vec()).collect()
        };
        let momenta: Vec<Vector3<f64>> = state.spatial_momentum_Λ().map(|m| m.0).collect();
        Some(vec![
            flat(state.φ()),
            self.of_moving(flat(state.momentum_φ())),
            entries_of(state.Λ()),
            flat(&momenta),
        ])
    }
}
