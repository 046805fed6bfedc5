//! A rod closed to a ring, with frames in the spatial representation and positions with an offset around the ring. Nodes depend on
//! the frames of both adjacent segments.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, column, fixed, minus, number, turn};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::{Square, dot};
use std::array::from_fn;

const TEXT: &str = "model Hoop {
    label i in 0..N step s; periodic;
    param m: Real at nodes; param I0, Cs: Sym<3> at segments; param C0: Mat<3>; param g: Vec<3>;
    field φ: Vec<3> at nodes offset A; group Λ: SO<3> at segments velocity ω; constraint next(Λ) = ω*Λ;
    let F = Λ^T*(next(φ, i) - φ)/s - E3;
    lagrangian = m*dot(next(φ) - φ, next(φ) - φ)/(2*h) - s*tr(I0*Λ^T*ω*Λ)/h - (h*s/2)*dot(F, Cs*F)
        + (h/s)*tr(C0*Λ^T*next(Λ, i)) + h*m*dot(g, prev(Λ, i)*E1 + Λ*E2) - h*dot(φ, prev(Λ, i)*g);
}";

struct Hoop {
    segments: usize,
    ring: bool,
    bodies: Bodies,
    places: Vec<usize>,
    frames: Vec<usize>,
    m: Vec<f64>,
    i0: Vec<Square<f64, 3>>,
    cs: Vec<Square<f64, 3>>,
    c0: Square<f64, 3>,
    g: [f64; 3],
    once_around: [f64; 3],
    h: f64,
    s: f64,
}

impl Hoop {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let mut bodies = Bodies::default();
        let nodes = ends.nodes(segments);
        let places = (0..nodes).map(|j| bodies.add("φ", Some(j), Kind::Vector(3)));
        let places = places.collect();
        let frames = (0..segments).map(|j| bodies.add("Λ", Some(j), Kind::Spatial));
        let frames = frames.collect();
        Hoop {
            segments,
            ring: ends == Ends::Ring,
            bodies,
            places,
            frames,
            m: (0..nodes).map(|_| source.between(0.5, 1.5)).collect(),
            i0: (0..segments).map(|_| source.positive()).collect(),
            cs: (0..segments).map(|_| source.positive()).collect(),
            c0: source.matrix(),
            g: source.vector(),
            once_around: source.vector(),
            h: source.between(0.2, 1.0),
            s: source.between(0.3, 1.5),
        }
    }

    fn place<T: Number>(&self, x: &[T], i: isize) -> [T; 3] {
        let count = self.places.len();
        let here: [T; 3] = column(x, self.places[around(i, count)]);
        let turns = if self.ring {
            i.div_euclid(count as isize)
        } else {
            0
        };
        from_fn(|c| here[c] + number(turns as f64 * self.once_around[c]))
    }

    fn frame<T: Number>(&self, x: &[T], i: isize) -> Square<T, 3> {
        turn(x, self.frames[around(i, self.segments)])
    }
}

impl Typed for Hoop {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let mut all = vec![
            NamedValue::scalar("h", self.h),
            NamedValue::scalar("s", self.s),
            NamedValue::square("C0", 0, &self.c0),
            NamedValue::column("g", 0, &self.g),
            NamedValue::column("A", 0, &self.once_around),
        ];
        for (j, m) in self.m.iter().enumerate() {
            all.push(NamedValue::scalar(&format!("m_{j}"), *m));
        }
        for j in 0..self.segments {
            all.push(NamedValue::square(&format!("I0_{j}"), 0, &self.i0[j]));
            all.push(NamedValue::square(&format!("Cs_{j}"), 0, &self.cs[j]));
        }
        all
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let (n, h, s) = (self.segments, self.h, self.s);
        let nodes = self.places.len();
        let c0 = Square::constant(&self.c0);
        for i in sum.over("inertia of places", 0, nodes) {
            let moved = minus(&self.place(head, i), &self.place(tail, i));
            sum.edge(dot(&moved, &moved) * number(self.m[around(i, nodes)] / (2.0 * h)));
        }
        for i in sum.over("inertia of frames", 0, n) {
            let inertia = Square::constant(&self.i0[around(i, n)]);
            let turned = self.frame(tail, i).transpose() * self.frame(head, i);
            sum.edge((inertia * turned).trace() * number(-s / h));
        }
        for i in sum.over("strain", 0, n) {
            let stiffness = Square::constant(&self.cs[around(i, n)]);
            let at = |x: &[T]| {
                let along = minus(&self.place(x, i + 1), &self.place(x, i));
                let strain = self.frame(x, i).transpose().apply(&along);
                let strain = minus(&strain.map(|c| c / number(s)), &fixed(&[0.0, 0.0, 1.0]));
                dot(&strain, &stiffness.apply(&strain)) * number(-h * s / 2.0)
            };
            sum.node(at(tail), at(head));
        }
        // On an open chain, the first and the last node have only one adjacent segment.
        let (inner, last) = if self.ring { (0, n) } else { (1, n) };
        for i in sum.over("bending", 0, if self.ring { n } else { n - 1 }) {
            let at = |x: &[T]| {
                (c0 * self.frame(x, i).transpose() * self.frame(x, i + 1)).trace() * number(h / s)
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("both segments", inner, last) {
            let at = |x: &[T]| {
                let before = self.frame(x, i - 1).apply(&fixed(&[1.0, 0.0, 0.0]));
                let after = self.frame(x, i).apply(&fixed(&[0.0, 1.0, 0.0]));
                let both = from_fn(|c| before[c] + after[c]);
                dot(&fixed(&self.g), &both) * number(h * self.m[around(i, nodes)])
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("segment before", inner, nodes) {
            let at = |x: &[T]| {
                let pull = self.frame(x, i - 1).apply(&fixed(&self.g));
                dot(&self.place(x, i), &pull) * number(-h)
            };
            sum.node(at(tail), at(head));
        }
    }
}

pub fn check(segments: usize, ends: Ends) {
    judged(TEXT, &[("i", segments)], ends, |source| {
        Hoop::of(segments, ends, source)
    });
}

// With 50 segments the derivation exceeds the engine's limit.
