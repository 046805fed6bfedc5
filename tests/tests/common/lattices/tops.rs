//! Tops in a chain with elastic torques: open, and as a ring.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, fixed, number, turn};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::{Square, dot};

const TEXT: &str = "model CoupledTops {
    label i in 0..N step s; periodic;
    param J, C0: Sym<3>; param gU, z: Vec<3>;
    group Λ: SO<3> at nodes velocity Ω; advected Γ: Vec<3> at nodes = Λ^T*z;
    constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ;
    lagrangian = -s*tr(J*Ω)/h - h*s*dot(gU, Γ) + (h/s)*tr(C0*Λ^T*next(Λ, i));
}";

struct Tops {
    segments: usize,
    nodes: usize,
    bodies: Bodies,
    tops: Vec<usize>,
    j: Square<f64, 3>,
    c0: Square<f64, 3>,
    gu: [f64; 3],
    z: [f64; 3],
    h: f64,
    s: f64,
}

impl Tops {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let nodes = ends.nodes(segments);
        let mut bodies = Bodies::default();
        let tops = (0..nodes).map(|i| bodies.add("Λ", Some(i), Kind::Rotation));
        Tops {
            tops: tops.collect(),
            segments,
            nodes,
            bodies,
            j: source.positive(),
            c0: source.symmetric(),
            gu: source.vector(),
            z: source.vector(),
            h: source.between(0.2, 1.0),
            s: source.between(0.3, 1.5),
        }
    }
}

impl Typed for Tops {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn parameters(&self) -> Vec<NamedValue> {
        vec![
            NamedValue::scalar("h", self.h),
            NamedValue::scalar("s", self.s),
            NamedValue::square("J", 0, &self.j),
            NamedValue::square("C0", 0, &self.c0),
            NamedValue::column("gU", 0, &self.gu),
            NamedValue::column("z", 0, &self.z),
        ]
    }

    fn advected(&self, shift: i8, x: &[f64]) -> Vec<NamedValue> {
        let seen = |i: usize| turn(x, self.tops[i]).transpose().apply(&self.z);
        let each = (0..self.nodes).map(|i| NamedValue::column(&format!("Γ_{i}"), shift, &seen(i)));
        each.collect()
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let top = |x: &[T], i: isize| turn(x, self.tops[around(i, self.nodes)]);
        let (j, c0) = (Square::constant(&self.j), Square::constant(&self.c0));
        for i in sum.over("kinetic", 0, self.nodes) {
            let velocity = top(tail, i).transpose() * top(head, i);
            sum.edge((j * velocity).trace() * number(-self.s / self.h));
        }
        for i in sum.over("weight", 0, self.nodes) {
            let at = |x: &[T]| {
                let up = top(x, i).transpose().apply(&fixed(&self.z));
                dot(&fixed(&self.gu), &up) * number(-self.h * self.s)
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("torque", 0, self.segments) {
            let at = |x: &[T]| {
                (c0 * top(x, i).transpose() * top(x, i + 1)).trace() * number(self.h / self.s)
            };
            sum.node(at(tail), at(head));
        }
    }
}

pub fn check(segments: usize, ends: Ends) {
    let (_, changes) = judged(TEXT, &[("i", segments)], ends, |source| {
        Tops::of(segments, ends, source)
    });
    if let Some((changes, constant)) = changes {
        // In a ring of one, the top is its own neighbour.
        let alone = ends == Ends::Ring && segments == 1;
        assert_eq!(constant > 0, alone, "{constant} of {changes}");
    }
}
