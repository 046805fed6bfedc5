//! A set of particles without neighbours and a scalar chain, both coupled to one body.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, column, fixed, minus, number, turn};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::{Square, dot};

const TEXT: &str = "model CloudAndString {
    label a in 0..P; label i in 0..N step s; periodic;
    param J: Sym<3>; param r: Vec<3> at a; param m, k: Real at a; param c: Real at segments; param e, z: Vec<3>;
    group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω;
    field X: Vec<3> at a; field u: Real at nodes;
    lagrangian = -tr(J*Ω)/h + m*dot(next(X) - X, next(X) - X)/(2*h) - (h/2)*k*dot(X - Λ*r, X - Λ*r)
        + s*(next(u) - u)^2/(2*h) - h*c*(next(u, i) - u)^2/(2*s) - h*s*u*dot(z, Λ*e);
}";

struct Cloud {
    particles: usize,
    segments: usize,
    nodes: usize,
    bodies: Bodies,
    j: Square<f64, 3>,
    r: Vec<[f64; 3]>,
    m: Vec<f64>,
    k: Vec<f64>,
    c: Vec<f64>,
    e: [f64; 3],
    z: [f64; 3],
    h: f64,
    s: f64,
}

impl Cloud {
    fn of(particles: usize, segments: usize, ends: Ends, source: &mut Source) -> Self {
        let nodes = ends.nodes(segments);
        let mut bodies = Bodies::default();
        bodies.add("Λ", None, Kind::Rotation);
        for a in 0..particles {
            bodies.add("X", Some(a), Kind::Vector(3));
        }
        for i in 0..nodes {
            bodies.add("u", Some(i), Kind::Number);
        }
        Cloud {
            particles,
            segments,
            nodes,
            bodies,
            j: source.positive(),
            r: (0..particles).map(|_| source.vector()).collect(),
            m: (0..particles).map(|_| source.between(0.5, 1.5)).collect(),
            k: (0..particles).map(|_| source.between(0.5, 1.5)).collect(),
            c: (0..segments).map(|_| source.between(0.5, 1.5)).collect(),
            e: source.vector(),
            z: source.vector(),
            h: source.between(0.2, 1.0),
            s: source.between(0.3, 1.5),
        }
    }
}

impl Typed for Cloud {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let mut all = vec![
            NamedValue::scalar("h", self.h),
            NamedValue::scalar("s", self.s),
            NamedValue::square("J", 0, &self.j),
            NamedValue::column("e", 0, &self.e),
            NamedValue::column("z", 0, &self.z),
        ];
        for a in 0..self.particles {
            all.push(NamedValue::column(&format!("r_{a}"), 0, &self.r[a]));
            all.push(NamedValue::scalar(&format!("m_{a}"), self.m[a]));
            all.push(NamedValue::scalar(&format!("k_{a}"), self.k[a]));
        }
        for i in 0..self.segments {
            all.push(NamedValue::scalar(&format!("c_{i}"), self.c[i]));
        }
        all
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let (h, s) = (self.h, self.s);
        let particle = |x: &[T], a: usize| -> [T; 3] { column(x, 9 + 3 * a) };
        let string = |x: &[T], i: isize| x[9 + 3 * self.particles + around(i, self.nodes)];
        let velocity = turn(tail, 0).transpose() * turn(head, 0);
        sum.edge((Square::constant(&self.j) * velocity).trace() * number(-1.0 / h));
        for a in sum.over("particles", 0, self.particles) {
            let a = around(a, self.particles);
            let moved = minus(&particle(head, a), &particle(tail, a));
            sum.edge(dot(&moved, &moved) * number(self.m[a] / (2.0 * h)));
        }
        for a in sum.over("springs", 0, self.particles) {
            let a = around(a, self.particles);
            let at = |x: &[T]| {
                let away = minus(&particle(x, a), &turn(x, 0).apply(&fixed(&self.r[a])));
                dot(&away, &away) * number(-h / 2.0 * self.k[a])
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("string", 0, self.nodes) {
            let moved = string(head, i) - string(tail, i);
            sum.edge(moved * moved * number(s / (2.0 * h)));
        }
        for i in sum.over("tension", 0, self.segments) {
            let c = self.c[around(i, self.segments)];
            let at = |x: &[T]| {
                let rise = string(x, i + 1) - string(x, i);
                rise * rise * number(-h * c / (2.0 * s))
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("pull", 0, self.nodes) {
            let at = |x: &[T]| {
                let along = dot(&fixed(&self.z), &turn(x, 0).apply(&fixed(&self.e)));
                string(x, i) * along * number(-h * s)
            };
            sum.node(at(tail), at(head));
        }
    }
}

pub fn check(particles: usize, segments: usize, ends: Ends) {
    let (_, changes) = judged(TEXT, &[("a", particles), ("i", segments)], ends, |source| {
        Cloud::of(particles, segments, ends, source)
    });
    if let Some((changes, constant)) = changes {
        assert_eq!(constant, 0, "of {changes}");
    }
}
