//! Scalar chains: the Toda chain with an offset around the ring, and a chain of pendulums (sine-Gordon) with free and prescribed
//! ends.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, number};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};

const TODA: &str = "model TodaChain {
    label i in 0..N; periodic;
    param m, a, b: Real; field q: Real at nodes offset L;
    let r = next(q, i) - q;
    lagrangian = m*(next(q) - q)^2/(2*h) - h*((a/b)*exp(-b*r) + a*r);
}";

const PENDULUMS: &str = "model SineGordon {
    label i in 0..N step s; periodic;
    param w: Real; field u: Real at nodes;
    lagrangian = s*(next(u) - u)^2/(2*h) - h*(next(u, i) - u)^2/(2*s) - h*s*w*(1 - cos(u));
    end i = 0 { free; pinned { u = given; } }
    end i = N { free; pinned { u = given; } }
}";

struct Toda {
    segments: usize,
    ring: bool,
    bodies: Bodies,
    m: f64,
    a: f64,
    b: f64,
    h: f64,
    once_around: f64,
}

impl Toda {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let mut bodies = Bodies::default();
        for i in 0..ends.nodes(segments) {
            bodies.add("q", Some(i), Kind::Number);
        }
        Toda {
            segments,
            ring: ends == Ends::Ring,
            bodies,
            m: source.between(0.5, 1.5),
            a: source.between(0.5, 1.5),
            b: source.between(0.5, 1.5),
            h: source.between(0.2, 1.0),
            once_around: segments as f64 * source.between(0.5, 1.5),
        }
    }
}

impl Typed for Toda {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn draw(&self, source: &mut Source) -> Vec<f64> {
        let spacing = self.once_around / self.segments as f64;
        let count = self.bodies.0.len();
        (0..count)
            .map(|i| i as f64 * spacing + source.between(-0.5, 0.5))
            .collect()
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let named = [
            ("m", self.m),
            ("a", self.a),
            ("b", self.b),
            ("h", self.h),
            ("L", self.once_around),
        ];
        named.map(|(n, v)| NamedValue::scalar(n, v)).to_vec()
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let count = tail.len();
        for i in sum.over("kinetic", 0, count) {
            let moved = head[around(i, count)] - tail[around(i, count)];
            sum.edge(moved * moved * number(self.m / (2.0 * self.h)));
        }
        let stretch = |x: &[T], i: isize| {
            let (here, next) = (around(i, count), around(i + 1, count));
            // After the last site of a ring comes the first, with the offset once around.
            let seam = if self.ring && next == 0 {
                self.once_around
            } else {
                0.0
            };
            x[next] + number(seam) - x[here]
        };
        for i in sum.over("repulsion", 0, self.segments) {
            let at = |x: &[T]| {
                (stretch(x, i) * number(-self.b)).exp() * number(-self.h * self.a / self.b)
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("tension", 0, self.segments) {
            let at = |x: &[T]| stretch(x, i) * number(-self.h * self.a);
            sum.node(at(tail), at(head));
        }
    }
}

struct Pendulums {
    segments: usize,
    bodies: Bodies,
    /// Indices of free angles, values of prescribed ones.
    angles: Vec<Result<usize, f64>>,
    w: f64,
    h: f64,
    s: f64,
}

impl Pendulums {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let mut bodies = Bodies::default();
        let mut angles = Vec::new();
        for i in 0..ends.nodes(segments) {
            let first = i == 0 && ends.is_at(false, "pinned");
            let last = i == segments && ends.is_at(true, "pinned");
            angles.push(match first || last {
                true => Err(source.between(-3.0, 3.0)),
                false => Ok(bodies.add("u", Some(i), Kind::Number)),
            });
        }
        Pendulums {
            segments,
            bodies,
            angles,
            w: source.between(0.5, 1.5),
            h: source.between(0.2, 1.0),
            s: source.between(0.3, 1.5),
        }
    }
}

impl Typed for Pendulums {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn draw(&self, source: &mut Source) -> Vec<f64> {
        let each = self.bodies.0.iter();
        each.map(|_| source.between(-3.0, 3.0)).collect()
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let named = [("w", self.w), ("h", self.h), ("s", self.s)];
        let held = self.angles.iter().enumerate().filter_map(|(i, u)| {
            let u = u.err()?;
            Some(NamedValue::scalar(&format!("u_{i}"), u))
        });
        let named = named.map(|(n, v)| NamedValue::scalar(n, v)).into_iter();
        named.chain(held).collect()
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let (h, s) = (self.h, self.s);
        let count = self.angles.len();
        let angle = |x: &[T], i: isize| match self.angles[around(i, count)] {
            Ok(at) => x[at],
            Err(held) => number(held),
        };
        for i in sum.over("kinetic", 0, count) {
            let moved = angle(head, i) - angle(tail, i);
            sum.edge(moved * moved * number(s / (2.0 * h)));
        }
        for i in sum.over("torsion", 0, self.segments) {
            let at = |x: &[T]| {
                let twist = angle(x, i + 1) - angle(x, i);
                twist * twist * number(-h / (2.0 * s))
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("weight", 0, count) {
            let at = |x: &[T]| (number::<T>(1.0) - angle(x, i).cos()) * number(-h * s * self.w);
            sum.node(at(tail), at(head));
        }
    }
}

pub fn toda(segments: usize, ends: Ends) {
    let (_, changes) = judged(TODA, &[("i", segments)], ends, |source| {
        Toda::of(segments, ends, source)
    });
    let Some((changes, constant)) = changes else {
        return;
    };
    // A single site in a ring has a constant distance from itself.
    let alone = ends == Ends::Ring && segments == 1;
    assert_eq!(constant > 0, alone, "{constant} of {changes}");
}

pub fn pendulums(segments: usize, ends: Ends) {
    let (line, changes) = judged(PENDULUMS, &[("i", segments)], ends, |source| {
        Pendulums::of(segments, ends, source)
    });
    let Some((changes, constant)) = changes else {
        return;
    };
    if ends != Ends::Ring {
        // For each prescribed angle: two signs, two removed summands, two duplicated ones. If both are prescribed, also the torsion
        // between them, from a sum one site too long.
        let held = line.angles.iter().filter(|u| u.is_err()).count();
        let between = if held == 2 { 2 } else { 0 };
        assert_eq!(constant, 6 * held + between, "of {changes}");
    }
}
