//! Regression tests: statements whose sums over sites were once derived with a different meaning, each against a hand-written
//! action.

use super::common::lattices::compare::agrees;
use super::common::lattices::sum::{Bodies, Kind, Sum, Typed, around, number};
use super::common::lattices::{FREE, derived};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};

/// A factor in front of a sum in which one term contains only neighbours.
const FACTORED: &str = "model Factored {
    label i in 0..N; param a, b: Real; field u: Real at nodes;
    lagrangian = (next(u) - u)^2/(2*h) - h*(a*u^2/2 + b*next(u, i)*prev(u, i));
}";

/// The same action, expanded.
const MULTIPLIED: &str = "model Multiplied {
    label i in 0..N; param a, b: Real; field u: Real at nodes;
    lagrangian = (next(u) - u)^2/(2*h) - h*a*u^2/2 - h*b*next(u, i)*prev(u, i);
}";

/// An end parameter and a site parameter with the same name.
const CALLED_ALIKE: &str = "model CalledAlike {
    label i in 0..N; param a: Real at nodes; param b: Real; field u: Real at nodes;
    lagrangian = (next(u) - u)^2/(2*h) - h*a*u^2/2 - h*b*next(u, i)*prev(u, i);
    end i = 0 { spring { param a: Real; term -h*a*cos(u); } }
}";

struct Line {
    nodes: usize,
    bodies: Bodies,
    a: Vec<f64>,
    b: f64,
    h: f64,
}

impl Line {
    fn of(segments: usize, source: &mut Source) -> Self {
        let nodes = segments + 1;
        let mut bodies = Bodies::default();
        for i in 0..nodes {
            bodies.add("u", Some(i), Kind::Number);
        }
        let one = source.between(0.5, 1.5);
        Line {
            nodes,
            bodies,
            a: vec![one; nodes],
            b: source.between(0.5, 1.5),
            h: source.between(0.2, 1.0),
        }
    }
}

impl Typed for Line {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn draw(&self, source: &mut Source) -> Vec<f64> {
        (0..self.nodes).map(|_| source.between(-1.0, 1.0)).collect()
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let mut all = vec![
            NamedValue::scalar("h", self.h),
            NamedValue::scalar("a", self.a[0]),
            NamedValue::scalar("b", self.b),
        ];
        for (i, a) in self.a.iter().enumerate() {
            all.push(NamedValue::scalar(&format!("a_{i}"), *a));
        }
        all
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let u = |x: &[T], i: isize| x[around(i, self.nodes)];
        for i in sum.over("kinetic", 0, self.nodes) {
            let moved = u(head, i) - u(tail, i);
            sum.edge(moved * moved * number(0.5 / self.h));
        }
        for i in sum.over("potential", 0, self.nodes) {
            let a = self.a[around(i, self.nodes)];
            let at = |x: &[T]| u(x, i) * u(x, i) * number(-self.h * a / 2.0);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("second neighbours", 1, self.nodes - 1) {
            let at = |x: &[T]| u(x, i + 1) * u(x, i - 1) * number(-self.h * self.b);
            sum.node(at(tail), at(head));
        }
    }
}

fn check(text: &str) {
    let mut source = Source::seeded(1);
    let d = derived(text, &[("i", 3)], FREE);
    let line = Line::of(3, &mut source);
    agrees(&d, &line, &mut source);
}

#[test]
fn terms_multiplied_out() {
    check(MULTIPLIED);
}

#[test]
fn a_factor_is_multiplied_into_a_sum() {
    check(FACTORED);
}

#[test]
fn parameters_of_an_end_have_names_of_their_own() {
    let refused = clebsch_core::derive_source(CALLED_ALIKE).expect_err("is refused");
    assert!(refused.to_string().contains("`a` is declared twice"));
}

#[test]
fn an_undeclared_name_is_refused() {
    let text = MULTIPLIED.replace("h*a*u^2/2", "h*a*u_1*u/2");
    assert!(clebsch_core::derive_source(&text).is_err(), "{text}");
}
