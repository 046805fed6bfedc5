//! Particles of shallow water in a periodic channel: depths from second neighbours, an offset around the ring, and a term linear in
//! velocities.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, number};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};

const TEXT: &str = "model ShallowWater1D {
    time k step dt; label i in 0..N; periodic;
    param m: Real at nodes; param g, f: Real; field X: Real at nodes offset L; field Y: Real at nodes;
    let depth = 2*m/(next(X, i) - prev(X, i));
    lagrangian = m*((next(X) - X)^2 + (next(Y) - Y)^2)/(2*dt) + m*f*((X + next(X))/2)*(next(Y) - Y)
        - dt*(g/2)*m*depth;
}";

struct Water {
    ring: bool,
    bodies: Bodies,
    m: Vec<f64>,
    g: f64,
    f: f64,
    dt: f64,
    spacing: f64,
}

impl Water {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let count = ends.nodes(segments);
        let mut bodies = Bodies::default();
        for name in ["X", "Y"] {
            for i in 0..count {
                bodies.add(name, Some(i), Kind::Number);
            }
        }
        Water {
            ring: ends == Ends::Ring,
            bodies,
            m: (0..count).map(|_| source.between(0.5, 1.5)).collect(),
            g: source.between(0.5, 1.5),
            f: source.between(0.5, 1.5),
            dt: source.between(0.2, 1.0),
            spacing: source.between(1.0, 2.0),
        }
    }

    fn once_around(&self) -> f64 {
        self.spacing * self.m.len() as f64
    }
}

impl Typed for Water {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn draw(&self, source: &mut Source) -> Vec<f64> {
        let count = self.m.len();
        let along = (0..count).map(|i| self.spacing * (i as f64 + source.between(-0.3, 0.3)));
        let mut all: Vec<f64> = along.collect();
        all.extend((0..count).map(|_| source.between(-1.0, 1.0)));
        all
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let named = [
            ("g", self.g),
            ("f", self.f),
            ("dt", self.dt),
            ("L", self.once_around()),
        ];
        let masses = self.m.iter().enumerate();
        let masses = masses.map(|(i, m)| NamedValue::scalar(&format!("m_{i}"), *m));
        let named = named.map(|(n, v)| NamedValue::scalar(n, v)).into_iter();
        named.chain(masses).collect()
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let count = self.m.len();
        let at = |i: isize| around(i, count);
        for i in sum.over("kinetic", 0, count) {
            let (x, y) = (at(i), count + at(i));
            let (u, v) = (head[x] - tail[x], head[y] - tail[y]);
            sum.edge((u * u + v * v) * number(self.m[at(i)] / (2.0 * self.dt)));
        }
        for i in sum.over("rotation", 0, count) {
            let (x, y) = (at(i), count + at(i));
            let centred = (tail[x] + head[x]) * number(0.5);
            sum.edge(centred * (head[y] - tail[y]) * number(self.m[at(i)] * self.f));
        }
        // On an open chain, the first and the last particle have a neighbour on one side only.
        let (first, beyond) = if self.ring {
            (0, count)
        } else {
            (1, count - 1)
        };
        for i in sum.over("depth", first, beyond) {
            let place = |x: &[T], j: isize| {
                let mut place = x[at(j)];
                if self.ring && at(i) == count - 1 && j > i {
                    place = place + number(self.once_around());
                }
                if self.ring && at(i) == 0 && j < i {
                    place = place - number(self.once_around());
                }
                place
            };
            let m = self.m[at(i)];
            let energy = |x: &[T]| {
                let width = place(x, i + 1) - place(x, i - 1);
                number::<T>(-self.dt * self.g / 2.0 * m * 2.0 * m) / width
            };
            sum.node(energy(tail), energy(head));
        }
    }
}

pub fn check(segments: usize, ends: Ends) {
    let (_, changes) = judged(TEXT, &[("i", segments)], ends, |source| {
        Water::of(segments, ends, source)
    });
    let Some((changes, constant)) = changes else {
        return;
    };
    // On a ring of one or two sites, both neighbours are the same particle at a fixed distance.
    let few = ends == Ends::Ring && segments <= 2;
    assert_eq!(constant > 0, few, "{constant} of {changes}");
}
