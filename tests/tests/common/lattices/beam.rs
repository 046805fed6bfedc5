//! A scalar beam with terms of every range: nodes, segments, inner nodes of second differences, two steps along the chain, segments
//! before and after a node, sums over stated sites, products of neighbouring velocities, and ends that prescribe a neighbour. Some
//! rings are shorter than the terms are wide.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, number};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};

const TEXT: &str = "model Beam {
    label i in 0..N step s; periodic;
    param m, c: Real at nodes; param k, p: Real at segments; param w: Real;
    field u: Real at nodes offset L;
    let v = next(u) - u;
    let bend = next(u, i) - 2*u + prev(u, i);
    lagrangian = m*v^2/(2*h) + w*v*next(v, i)/h - h*(k*(next(u, i) - u)^2/2 + c*sin(u))
        - h*bend^2/(2*s^3) - h*p*cos(next(next(u, i), i) - u) - h*prev(k, i)*c*cos(u)
        + h*w*next(p, i)*p*sin(u) + h*w*sum(cos(u), segments) - h*w*sum(m*u, nodes);
    end i = 0 { free; spring { param c0: Real; term -(h/2)*c0*(next(u, i) - u)^2; } pinned { u = given; } }
    end i = N { free; pinned { u = given; } spring { param c0: Real; term -(h/2)*c0*k*(u - prev(u, i))^2; } }
}";

struct Beam {
    segments: usize,
    ends: Ends,
    bodies: Bodies,
    /// Indices of free fields, values of prescribed ones.
    places: Vec<Result<usize, f64>>,
    m: Vec<f64>,
    c: Vec<f64>,
    k: Vec<f64>,
    p: Vec<f64>,
    springs: [f64; 2],
    w: f64,
    h: f64,
    s: f64,
    once_around: f64,
}

impl Beam {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let mut bodies = Bodies::default();
        let mut places = Vec::new();
        let count = ends.nodes(segments);
        for i in 0..count {
            let first = i == 0 && ends.is_at(false, "pinned");
            let last = i == segments && ends.is_at(true, "pinned");
            places.push(match first || last {
                true => Err(source.between(-1.0, 1.0)),
                false => Ok(bodies.add("u", Some(i), Kind::Number)),
            });
        }
        let mut list =
            |n: usize| -> Vec<f64> { (0..n).map(|_| source.between(0.5, 1.5)).collect() };
        let (m, c, k, p) = (list(count), list(count), list(segments), list(segments));
        Beam {
            segments,
            ends,
            bodies,
            places,
            m,
            c,
            k,
            p,
            springs: [source.between(0.5, 1.5), source.between(0.5, 1.5)],
            w: source.between(0.1, 0.4),
            h: source.between(0.2, 1.0),
            s: source.between(0.3, 1.5),
            once_around: segments as f64 * source.between(0.5, 1.5),
        }
    }
}

impl Typed for Beam {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let named = [
            ("w", self.w),
            ("h", self.h),
            ("s", self.s),
            ("L", self.once_around),
        ];
        let mut all: Vec<NamedValue> = named.map(|(n, v)| NamedValue::scalar(n, v)).to_vec();
        for (i, place) in self.places.iter().enumerate() {
            all.push(NamedValue::scalar(&format!("m_{i}"), self.m[i]));
            all.push(NamedValue::scalar(&format!("c_{i}"), self.c[i]));
            all.extend(
                place
                    .err()
                    .map(|u| NamedValue::scalar(&format!("u_{i}"), u)),
            );
        }
        for i in 0..self.segments {
            all.push(NamedValue::scalar(&format!("k_{i}"), self.k[i]));
            all.push(NamedValue::scalar(&format!("p_{i}"), self.p[i]));
        }
        let [first, last] = self.springs;
        all.push(NamedValue::scalar("c0_0", first));
        all.push(NamedValue::scalar(&format!("c0_{}", self.segments), last));
        all
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let (n, h, s, w) = (self.segments, self.h, self.s, self.w);
        let count = self.places.len();
        let ring = self.ends == Ends::Ring;
        let node = |i: isize| around(i, count);
        let segment = |i: isize| around(i, n);
        let u = |x: &[T], i: isize| {
            let place = match self.places[node(i)] {
                Ok(at) => x[at],
                Err(held) => number(held),
            };
            let mut turns = 0.0;
            if ring {
                turns = i.div_euclid(count as isize) as f64;
            }
            place + number(turns * self.once_around)
        };
        let moved = |i: isize| u(head, i) - u(tail, i);
        // The end of each sum: one node after its last node.
        let (nodes, last_but_one, last_but_two) = match ring {
            true => (n, n, n),
            false => (n + 1, n, n.saturating_sub(1)),
        };
        for i in sum.over("kinetic", 0, nodes) {
            sum.edge(moved(i) * moved(i) * number(self.m[node(i)] / (2.0 * h)));
        }
        for i in sum.over("joint", 0, last_but_one) {
            sum.edge(moved(i) * moved(i + 1) * number(w / h));
        }
        for i in sum.over("strain", 0, last_but_one) {
            let at = |x: &[T]| {
                let r = u(x, i + 1) - u(x, i);
                r * r * number(-h * self.k[segment(i)] / 2.0)
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("well", 0, nodes) {
            let at = |x: &[T]| u(x, i).sin() * number(-h * self.c[node(i)]);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("bending", if ring { 0 } else { 1 }, last_but_one) {
            let at = |x: &[T]| {
                let bend = u(x, i + 1) - number::<T>(2.0) * u(x, i) + u(x, i - 1);
                bend * bend * number(-h / (2.0 * s * s * s))
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("second neighbours", 0, last_but_two) {
            let at = |x: &[T]| (u(x, i + 2) - u(x, i)).cos() * number(-h * self.p[segment(i)]);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("segment before", if ring { 0 } else { 1 }, nodes) {
            let factor = -h * self.k[segment(i - 1)] * self.c[node(i)];
            let at = |x: &[T]| u(x, i).cos() * number(factor);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("segment and the next", 0, last_but_two) {
            let factor = h * w * self.p[segment(i + 1)] * self.p[segment(i)];
            let at = |x: &[T]| u(x, i).sin() * number(factor);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("as many as segments", 0, last_but_one) {
            let at = |x: &[T]| u(x, i).cos() * number(h * w);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("as many as nodes", 0, nodes) {
            let at = |x: &[T]| u(x, i) * number(-h * w * self.m[node(i)]);
            sum.node(at(tail), at(head));
        }
        let end = count as isize - 1;
        if self.ends.is_at(false, "spring") {
            let at = |x: &[T]| {
                let r = u(x, 1) - u(x, 0);
                r * r * number(-h / 2.0 * self.springs[0])
            };
            sum.node(at(tail), at(head));
        }
        if self.ends.is_at(true, "spring") {
            let at = |x: &[T]| {
                let r = u(x, end) - u(x, end - 1);
                r * r * number(-h / 2.0 * self.springs[1] * self.k[n - 1])
            };
            sum.node(at(tail), at(head));
        }
    }
}

pub fn check(segments: usize, ends: Ends) {
    judged(TEXT, &[("i", segments)], ends, |source| {
        Beam::of(segments, ends, source)
    });
}
