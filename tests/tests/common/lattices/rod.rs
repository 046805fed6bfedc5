//! The geometrically exact rod: positions at nodes, frames at segments, and every pair of ends.

use super::Ends;
use super::change::judged;
use super::sum::{Bodies, Kind, Sum, Typed, around, column, fixed, minus, number, turn};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::{NamedValue, Source};
use clebsch_oracle::oracle::square::{Square, dot};

const TEXT: &str = "model GeometricallyExactRod {
    label i in 0..N step s;
    param m: Real at nodes; param I0, Cs: Sym<3> at segments; param C0: Sym<3>; param g: Vec<3>;
    field φ: Vec<3> at nodes; group Λ: SO<3> at segments velocity Ω; constraint next(Λ) = Λ*Ω;
    let V = (next(φ) - φ)/h; let F = Λ^T*(next(φ, i) - φ)/s - E3;
    lagrangian = h*m*(dot(V, V)/2 + dot(g, φ)) - s*tr(I0*Ω)/h - (h*s/2)*dot(F, Cs*F)
        + (h/s)*tr(C0*Λ^T*next(Λ, i));
    end i = 0 {
        free; pinned { φ = given; }
        clamped { param Λw: SO<3>; φ = given; term (2*h/s)*tr(C0*Λw^T*Λ); }
    }
    end i = N {
        free; pinned { φ = given; }
        clamped { param Λw: SO<3>; φ = given; term (2*h/s)*tr(C0*Λ^T*Λw); }
        load { param force: Vec<3>; term h*dot(force, φ); }
    }
}";

const FIRST: [&str; 3] = ["free", "pinned", "clamped"];
const LAST: [&str; 4] = ["free", "pinned", "clamped", "load"];

/// The source of a node's position.
enum Place {
    Moving(usize),
    Held([f64; 3]),
}

struct Rod {
    segments: usize,
    ends: Ends,
    bodies: Bodies,
    places: Vec<Place>,
    frames: Vec<usize>,
    m: Vec<f64>,
    i0: Vec<Square<f64, 3>>,
    cs: Vec<Square<f64, 3>>,
    c0: Square<f64, 3>,
    g: [f64; 3],
    walls: [Square<f64, 3>; 2],
    force: [f64; 3],
    h: f64,
    s: f64,
}

impl Rod {
    fn of(segments: usize, ends: Ends, source: &mut Source) -> Self {
        let mut bodies = Bodies::default();
        let held = |last: bool| ends.is_at(last, "pinned") || ends.is_at(last, "clamped");
        let mut places = Vec::new();
        for j in 0..=segments {
            places.push(
                match (j == 0 && held(false)) || (j == segments && held(true)) {
                    true => Place::Held(source.vector()),
                    false => Place::Moving(bodies.add("φ", Some(j), Kind::Vector(3))),
                },
            );
        }
        let frames = (0..segments).map(|j| bodies.add("Λ", Some(j), Kind::Rotation));
        Rod {
            frames: frames.collect(),
            segments,
            ends,
            bodies,
            places,
            m: (0..=segments).map(|_| source.between(0.5, 1.5)).collect(),
            i0: (0..segments).map(|_| source.positive()).collect(),
            cs: (0..segments).map(|_| source.positive()).collect(),
            c0: source.positive(),
            g: source.vector(),
            walls: [source.orthogonal(), source.orthogonal()],
            force: source.vector(),
            h: source.between(0.2, 1.0),
            s: source.between(0.3, 1.5),
        }
    }

    fn place<T: Number>(&self, x: &[T], i: isize) -> [T; 3] {
        match &self.places[around(i, self.segments + 1)] {
            Place::Moving(at) => column(x, *at),
            Place::Held(place) => fixed(place),
        }
    }

    fn frame<T: Number>(&self, x: &[T], i: isize) -> Square<T, 3> {
        turn(x, self.frames[around(i, self.segments)])
    }
}

impl Typed for Rod {
    fn bodies(&self) -> &Bodies {
        &self.bodies
    }

    fn parameters(&self) -> Vec<NamedValue> {
        let n = self.segments;
        let mut all = vec![
            NamedValue::scalar("h", self.h),
            NamedValue::scalar("s", self.s),
            NamedValue::square("C0", 0, &self.c0),
            NamedValue::column("g", 0, &self.g),
            NamedValue::square("Λw_0", 0, &self.walls[0]),
            NamedValue::square(&format!("Λw_{n}"), 0, &self.walls[1]),
            NamedValue::column(&format!("force_{n}"), 0, &self.force),
        ];
        for (j, place) in self.places.iter().enumerate() {
            all.push(NamedValue::scalar(&format!("m_{j}"), self.m[j]));
            if let Place::Held(place) = place {
                all.push(NamedValue::column(&format!("φ_{j}"), 0, place));
            }
        }
        for j in 0..n {
            all.push(NamedValue::square(&format!("I0_{j}"), 0, &self.i0[j]));
            all.push(NamedValue::square(&format!("Cs_{j}"), 0, &self.cs[j]));
        }
        all
    }

    fn action<T: Number>(&self, tail: &[T], head: &[T], sum: &mut Sum<T>) {
        let (n, h, s) = (self.segments, self.h, self.s);
        let c0 = Square::constant(&self.c0);
        for i in sum.over("inertia of places", 0, n + 1) {
            let moved = minus(&self.place(head, i), &self.place(tail, i));
            let m = self.m[around(i, n + 1)];
            sum.edge(dot(&moved, &moved) * number(m / (2.0 * h)));
        }
        for i in sum.over("gravity", 0, n + 1) {
            let m = self.m[around(i, n + 1)];
            let at = |x: &[T]| dot(&fixed(&self.g), &self.place(x, i)) * number(h * m);
            sum.node(at(tail), at(head));
        }
        for i in sum.over("inertia of frames", 0, n) {
            let velocity = self.frame(tail, i).transpose() * self.frame(head, i);
            let inertia = Square::constant(&self.i0[around(i, n)]);
            sum.edge((inertia * velocity).trace() * number(-s / h));
        }
        for i in sum.over("strain", 0, n) {
            let stiffness = Square::constant(&self.cs[around(i, n)]);
            let at = |x: &[T]| {
                let along = minus(&self.place(x, i + 1), &self.place(x, i));
                let mut strain = self.frame(x, i).transpose().apply(&along);
                for component in &mut strain {
                    *component = *component / number(s);
                }
                strain[2] = strain[2] - number(1.0);
                dot(&strain, &stiffness.apply(&strain)) * number(-h * s / 2.0)
            };
            sum.node(at(tail), at(head));
        }
        for i in sum.over("bending", 0, n - 1) {
            let at = |x: &[T]| {
                (c0 * self.frame(x, i).transpose() * self.frame(x, i + 1)).trace() * number(h / s)
            };
            sum.node(at(tail), at(head));
        }
        let walls = self.walls.each_ref().map(Square::constant);
        if self.ends.is_at(false, "clamped") {
            let at = |x: &[T]| {
                (c0 * walls[0].transpose() * self.frame(x, 0)).trace() * number(2.0 * h / s)
            };
            sum.node(at(tail), at(head));
        }
        if self.ends.is_at(true, "clamped") {
            let at = |x: &[T]| {
                let last = turn(x, self.frames[n - 1]);
                (c0 * last.transpose() * walls[1]).trace() * number(2.0 * h / s)
            };
            sum.node(at(tail), at(head));
        }
        if self.ends.is_at(true, "load") {
            let Place::Moving(last) = self.places[n] else {
                panic!("a loaded end moves")
            };
            let at = |x: &[T]| dot(&fixed(&self.force), &column(x, last)) * number(h);
            sum.node(at(tail), at(head));
        }
    }
}

pub fn check(segments: usize, first: &'static str, last: &'static str) {
    let ends = Ends::Open(first, last);
    let (rod, changes) = judged(TEXT, &[("i", segments)], ends, |source| {
        Rod::of(segments, ends, source)
    });
    if let Some((changes, constant)) = changes {
        println!("{constant} of {changes} changes move what is held");
        // For each prescribed position: the signs of its inertia and weight, either removed from its sum, and either counted twice
        // at the other end of the sum.
        let held = rod.places.iter().filter(|p| matches!(p, Place::Held(_)));
        // A single frame has no bending energy, and a sum one site too long bends a frame against itself.
        let nothing = if segments == 1 { 4 } else { 0 };
        assert_eq!(constant, 6 * held.count() + nothing);
    }
}

/// All pairs of first and last ends.
pub fn any_ends(segments: usize) {
    for first in FIRST {
        for last in LAST {
            check(segments, first, last);
        }
    }
}
