//! Tops in a chain whose first or last top is prescribed. Its velocity is the identity, and its advected quantity is constant, by
//! definition or by an explicit value. Neighbours are coupled by velocities, elements and advected quantities.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, fixed, number, turn};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::{Square, cross, dot};

const TEXT: &str = "model HeldTops {
    label i in 0..N step s; periodic;
    param J: Sym<3> at nodes; param C: Mat<3> at segments; param g, d, z: Vec<3>; param eps: Real;
    group Λ: SO<3> at nodes velocity Ω; advected Γ: Vec<3> at nodes = Λ^T*z; advected b: Vec<3> at nodes;
    constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; constraint next(b) = Ω^T*b;
    lagrangian = -s*tr(J*Ω)/h - h*s*dot(g, Γ + cross(b, d)) + (h/s)*tr(C*Λ^T*next(Λ, i))
        - (eps/h)*dot((Ω - Id)*d, (next(Ω, i) - Id)*d) + h*dot(b, next(Γ, i));
    end i = 0 { held { Λ = given; } free; }
    end i = N { free; held { Λ = given; } }
}";

struct Tops {
    segments: usize,
    bodies: Bodies,
    tops: Vec<Result<usize, Square<f64, 3>>>,
    /// The advected quantities at the identity.
    carried: Vec<[f64; 3]>,
    j: Vec<Square<f64, 3>>,
    c: Vec<Square<f64, 3>>,
    g: [f64; 3],
    d: [f64; 3],
    z: [f64; 3],
    eps: f64,
    h: f64,
    s: f64,
}

impl Tops {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let count = ends.nodes(segments);
        let mut bodies = Bodies::default();
        let mut tops = Vec::new();
        for i in 0..count {
            let first = i == 0 && ends.is_at(false, "held");
            let last = i == segments && ends.is_at(true, "held");
            tops.push(match first || last {
                true => Err(source.orthogonal()),
                false => Ok(bodies.add("Λ", Some(i), Kind::Rotation)),
            });
        }
        Tops {
            segments,
            bodies,
            tops,
            carried: (0..count).map(|_| source.vector()).collect(),
            j: (0..count).map(|_| source.positive()).collect(),
            c: (0..segments).map(|_| source.matrix()).collect(),
            g: source.vector(),
            d: source.vector(),
            z: source.vector(),
            eps: source.between(0.3, 0.7),
            h: source.between(0.2, 1.0),
            s: source.between(0.3, 1.5),
        }
    }

    fn top<T: Number>(&self, x: &[T], i: isize) -> Square<T, 3> {
        match &self.tops[around(i, self.tops.len())] {
            Ok(at) => turn(x, *at),
            Err(held) => Square::constant(held),
        }
    }
}

impl Typed for Tops {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let mut all = vec![
            NamedValue::scalar("h", self.h),
            NamedValue::scalar("s", self.s),
            NamedValue::scalar("eps", self.eps),
            NamedValue::column("g", 0, &self.g),
            NamedValue::column("d", 0, &self.d),
            NamedValue::column("z", 0, &self.z),
        ];
        for (i, top) in self.tops.iter().enumerate() {
            all.push(NamedValue::square(&format!("J_{i}"), 0, &self.j[i]));
            if let Err(held) = top {
                let b = held.transpose().apply(&self.carried[i]);
                all.push(NamedValue::square(&format!("Λ_{i}"), 0, held));
                all.push(NamedValue::column(&format!("b_{i}"), 0, &b));
            }
        }
        for i in 0..self.segments {
            all.push(NamedValue::square(&format!("C_{i}"), 0, &self.c[i]));
        }
        all
    }

    fn advected(&self, shift: i8, x: &[f64]) -> Vec<NamedValue> {
        let mut all = Vec::new();
        for (i, top) in self.tops.iter().enumerate() {
            if let Ok(at) = top {
                let seen = |v: &[f64; 3]| turn(x, *at).transpose().apply(v);
                all.push(NamedValue::column(&format!("Γ_{i}"), shift, &seen(&self.z)));
                all.push(NamedValue::column(
                    &format!("b_{i}"),
                    shift,
                    &seen(&self.carried[i]),
                ));
            }
        }
        all
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let (h, s) = (self.h, self.s);
        let count = self.tops.len();
        let velocity = |i: isize| self.top(tail, i).transpose() * self.top(head, i);
        let gamma = |x: &[T], i: isize| self.top(x, i).transpose().apply(&fixed(&self.z));
        let b = |x: &[T], i: isize| {
            let carried = fixed(&self.carried[around(i, count)]);
            self.top(x, i).transpose().apply(&carried)
        };
        for i in sum.over("kinetic", 0, count) {
            let j = Square::constant(&self.j[around(i, count)]);
            sum.edge((j * velocity(i)).trace() * number(-s / h));
        }
        for i in sum.over("weight", 0, count) {
            let at = |x: &[T]| dot(&fixed(&self.g), &gamma(x, i)) * number(-h * s);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("field", 0, count) {
            let at = |x: &[T]| {
                let product = cross(&b(x, i), &fixed(&self.d));
                dot(&fixed(&self.g), &product) * number(-h * s)
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("torque", 0, self.segments) {
            let c = Square::constant(&self.c[around(i, self.segments)]);
            let at = |x: &[T]| {
                (c * self.top(x, i).transpose() * self.top(x, i + 1)).trace() * number(h / s)
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("joint", 0, self.segments) {
            let swept = |i: isize| (velocity(i) - Square::identity()).apply(&fixed(&self.d));
            sum.edge(dot(&swept(i), &swept(i + 1)) * number(-self.eps / h));
        }
        for i in sum.over("carried", 0, self.segments) {
            let at = |x: &[T]| dot(&b(x, i), &gamma(x, i + 1)) * number(h);
            sum.node(at(tail), at(head));
        }
    }
}

pub fn check(segments: usize, ends: Ends) {
    judged(TEXT, &[("i", segments)], ends, |source| {
        Tops::of(segments, ends, source)
    });
}
