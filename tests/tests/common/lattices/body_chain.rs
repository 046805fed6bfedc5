//! Bodies in a chain whose kinetic energy couples the velocities of neighbours.

use super::FREE;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, fixed, number, turn};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::{Square, dot};

const TEXT: &str = "model CoupledBodyChain {
    label i in 0..N; param J: Sym<3>; param d: Vec<3>; param eps: Real;
    group Λ: SO<3> at nodes velocity Ω; constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(J*Ω)/h - (eps/h)*dot((Ω - Id)*d, Λ^T*next(Λ, i)*(next(Ω, i) - Id)*d);
}";

struct Chain {
    segments: usize,
    bodies: Bodies,
    elements: Vec<usize>,
    j: Square<f64, 3>,
    d: [f64; 3],
    eps: f64,
    h: f64,
}

impl Chain {
    fn of(segments: usize, source: &mut Source) -> Self {
        let mut bodies = Bodies::default();
        let elements = (0..=segments).map(|i| bodies.add("Λ", Some(i), Kind::Rotation));
        Chain {
            elements: elements.collect(),
            segments,
            bodies,
            j: source.positive(),
            d: source.vector(),
            eps: source.between(0.3, 0.7),
            h: source.between(0.2, 1.0),
        }
    }
}

impl Typed for Chain {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn parameters(&self) -> Vec<NamedValue> {
        vec![
            NamedValue::scalar("h", self.h),
            NamedValue::scalar("eps", self.eps),
            NamedValue::square("J", 0, &self.j),
            NamedValue::column("d", 0, &self.d),
        ]
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let body = |x: &[T], i: isize| turn(x, self.elements[around(i, self.segments + 1)]);
        let j = Square::constant(&self.j);
        for i in sum.over("kinetic", 0, self.segments + 1) {
            let velocity = body(tail, i).transpose() * body(head, i);
            sum.edge((j * velocity).trace() * number(-1.0 / self.h));
        }
        for i in sum.over("joint", 0, self.segments) {
            let swept = |i: isize| {
                let velocity = body(tail, i).transpose() * body(head, i);
                (velocity - Square::identity()).apply(&fixed(&self.d))
            };
            let relative = body(tail, i).transpose() * body(tail, i + 1);
            let joined = dot(&swept(i), &relative.apply(&swept(i + 1)));
            sum.edge(joined * number(-self.eps / self.h));
        }
    }
}

pub fn check(segments: usize) {
    let (_, changes) = judged(TEXT, &[("i", segments)], FREE, |source| {
        Chain::of(segments, source)
    });
    if let Some((changes, constant)) = changes {
        assert_eq!(constant, 0, "of {changes}");
    }
}
