//! Toda's chain and the sine-Gordon equation: random states, with the results of the compiled and the hand-written stepper.

use super::{Shown, System, stretched};
use clebsch::nalgebra::SMatrix;
use clebsch_models::lattices::{sine_gordon::*, toda_chain::*};
use clebsch_oracle::handwritten::lattices::{sine_gordon as pendulums, toda_chain as springs};
use clebsch_oracle::oracle::points::Source;

fn numbers(values: &[f64]) -> Vec<SMatrix<f64, 1, 1>> {
    values.iter().map(|x| SMatrix::repeat(*x)).collect()
}

fn values(numbers: &[SMatrix<f64, 1, 1>]) -> Vec<f64> {
    numbers.iter().map(|x| x[0]).collect()
}

fn every_second(values: &[f64], share: f64) -> Vec<f64> {
    let each = values.iter().enumerate();
    each.map(|(i, x)| if i % 2 == 0 { x * (1.0 + share) } else { *x })
        .collect()
}

/// Toda's chain.
#[derive(Clone)]
pub struct Springs {
    springs: springs::Springs,
    ends: springs::Ends,
    places: Vec<f64>,
    momenta: Vec<f64>,
    h: f64,
}

impl System for Springs {
    const KINDS: usize = 6;
    const ENDS: usize = 2;

    fn draw(source: &mut Source, n: usize, ends: usize) -> Self {
        let nodes = n + 1 - ends;
        let mut list = |size: f64| (0..nodes).map(|_| source.between(-size, size)).collect();
        Self {
            places: list(1.0),
            momenta: list(1.0),
            springs: springs::Springs {
                mass: source.between(0.5, 2.0),
                stiffness: source.between(0.5, 2.0),
                softening: source.between(0.5, 2.0),
            },
            ends: match ends {
                0 => springs::Ends::Open,
                _ => springs::Ends::Ring(source.between(-1.0, 1.0)),
            },
            h: source.between(0.01, 0.1),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Option<Self> {
        let mut moved = self.clone();
        match kind {
            0 => moved.momenta = every_second(&self.momenta, share),
            1 => moved.places = every_second(&self.places, share),
            2 => moved.springs.mass *= 1.0 + share,
            3 => moved.springs.stiffness *= 1.0 + share,
            4 => moved.springs.softening *= 1.0 + share,
            _ => match &mut moved.ends {
                springs::Ends::Open => return None,
                springs::Ends::Ring(length) => *length *= 1.0 + share,
            },
        }
        Some(moved)
    }

    fn by_hand(&self, steps: usize) -> Option<Shown> {
        let (q, p) = (&self.places, &self.momenta);
        let mut chain = springs::TodaChain::start(self.springs, self.ends, q, p, self.h);
        (0..steps).for_each(|_| chain.step());
        Some(vec![chain.places().to_vec(), chain.momenta().to_vec()])
    }

    fn generated(&self, steps: usize) -> Option<Shown> {
        let parameters = TodaChainParameters {
            m: self.springs.mass,
            a: self.springs.stiffness,
            b: self.springs.softening,
        };
        let (n, ends) = match self.ends {
            springs::Ends::Open => (self.places.len() - 1, TodaChainEnds::Open),
            springs::Ends::Ring(length) => (self.places.len(), TodaChainEnds::Ring { L: length }),
        };
        let chain = TodaChain::new(parameters, TodaChainSites { N: n, ends }).ok()?;
        let initial = TodaChainInitial {
            q: numbers(&self.places),
            momentum_q: numbers(&self.momenta),
        };
        let (mut state, mut work) = chain.start(initial, self.h).ok()?;
        for _ in 0..steps {
            chain.step(&mut state, &mut work).ok()?;
        }
        Some(vec![values(state.q()), values(state.momentum_q())])
    }
}

/// Pendulums on a wire.
#[derive(Clone)]
pub struct Pendulums {
    wire: pendulums::Wire,
    angles: Vec<f64>,
    momenta: Vec<f64>,
    h: f64,
}

impl Pendulums {
    /// Whether an end prescribes the first and the last node.
    fn held(&self) -> [bool; 2] {
        match self.wire.ends {
            pendulums::Ends::Ring(_) => [false; 2],
            pendulums::Ends::Open {
                first_pinned,
                last_pinned,
            } => [first_pinned, last_pinned],
        }
    }

    /// The momenta of the free nodes.
    fn of_moving(&self, momenta: Vec<f64>) -> Vec<f64> {
        let [first, last] = self.held().map(usize::from);
        momenta[first..momenta.len() - last].to_vec()
    }
}

impl System for Pendulums {
    const KINDS: usize = 8;
    const ENDS: usize = 5;

    fn draw(source: &mut Source, n: usize, ends: usize) -> Self {
        let nodes = n + usize::from(ends != 0);
        let mut list =
            |low: f64, high: f64| (0..nodes).map(|_| source.between(low, high)).collect();
        Self {
            angles: list(-3.0, 3.0),
            momenta: list(-1.0, 1.0),
            wire: pendulums::Wire {
                weights: list(0.2, 1.0),
                spacing: source.between(0.3, 1.0),
                stiffness: source.between(0.5, 2.0),
                ends: match ends {
                    0 => pendulums::Ends::Ring(source.between(-6.0, 6.0)),
                    _ => pendulums::Ends::Open {
                        first_pinned: ends == 2 || ends == 4,
                        last_pinned: ends >= 3,
                    },
                },
            },
            h: source.between(0.01, 0.1),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Option<Self> {
        let mut moved = self.clone();
        let (wire, last) = (&mut moved.wire, self.angles.len() - 1);
        let [first_held, last_held] = self.held();
        let at = match kind {
            0 => 0,
            1 => last / 2,
            _ => last,
        };
        match kind {
            // The weight of a prescribed node appears in no equation.
            0..3 if first_held && at == 0 || last_held && at == last => return None,
            0..3 => wire.weights[at] *= 1.0 + share,
            3 => wire.spacing *= 1.0 + share,
            4 => wire.stiffness *= 1.0 + share,
            5 => moved.angles = every_second(&self.angles, share),
            6 => moved.momenta = self.momenta.iter().map(|p| p * (1.0 + share)).collect(),
            _ => match &mut wire.ends {
                pendulums::Ends::Open { .. } => return None,
                pendulums::Ends::Ring(length) => [*length] = stretched([*length], share),
            },
        }
        Some(moved)
    }

    fn by_hand(&self, steps: usize) -> Option<Shown> {
        let mut line =
            pendulums::SineGordon::start(&self.wire, &self.angles, &self.momenta, self.h);
        (0..steps).for_each(|_| line.step());
        let momenta = self.of_moving(line.momenta().to_vec());
        Some(vec![line.angles().to_vec(), momenta])
    }

    fn generated(&self, steps: usize) -> Option<Shown> {
        let parameters = SineGordonParameters {
            s: self.wire.spacing,
            w: self.wire.weights.clone(),
            k: self.wire.stiffness,
        };
        let [first, last] = self.held();
        let (n, ends) = match self.wire.ends {
            pendulums::Ends::Ring(length) => {
                (self.angles.len(), SineGordonEnds::Ring { L: length })
            }
            pendulums::Ends::Open { .. } => {
                let first = match first {
                    true => SineGordonFirst::Pinned,
                    false => SineGordonFirst::Free,
                };
                let last = match last {
                    true => SineGordonLast::Pinned,
                    false => SineGordonLast::Free,
                };
                (self.angles.len() - 1, SineGordonEnds::Open { first, last })
            }
        };
        let line = SineGordon::new(parameters, SineGordonSites { N: n, ends }).ok()?;
        let initial = SineGordonInitial {
            u: numbers(&self.angles),
            momentum_u: numbers(&self.momenta),
        };
        let (mut state, mut work) = line.start(initial, self.h).ok()?;
        for _ in 0..steps {
            line.step(&mut state, &mut work).ok()?;
        }
        let momenta = self.of_moving(values(state.momentum_u()));
        Some(vec![values(state.u()), momenta])
    }
}
