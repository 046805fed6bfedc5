//! Chains of numbers and vectors.

use crate::steps::line::Line;
use crate::steps::quantity::At::{Nodes, Segments, Whole};
use crate::steps::quantity::Sites;
use crate::steps::quantity::What::{Mass, Positive, Vector};
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::step::{Edge, Place};

const FREE: Option<[&str; 2]> = Some(["free", "free"]);
const PINNED: Option<[&str; 2]> = Some(["pinned", "pinned"]);
const MIXED: Option<[&str; 2]> = Some(["free", "pinned"]);

const ALL: &[Sites] = &[
    (5, None),
    (1, FREE),
    (1, MIXED),
    (2, FREE),
    (2, PINNED),
    (3, MIXED),
    (3, None),
    (5, PINNED),
    (12, FREE),
    (12, None),
    (40, FREE),
    (40, PINNED),
    (40, None),
];

const INNER: &[Sites] = &[
    (5, None),
    (2, FREE),
    (3, PINNED),
    (3, MIXED),
    (5, FREE),
    (12, None),
    (40, MIXED),
];

/// Masses of nodes.
fn points<T: Number>(e: &Edge<'_, T>) -> T {
    let each = (0..e.tail.table.sites("q")).map(|i| {
        let d = e.head.real_at("q", i) - e.tail.real_at("q", i);
        e.given.real_at("m", i) * square(d) / (of::<T>(2.0) * e.h)
    });
    sum(each)
}

/// The strain of a segment.
fn strain<T: Number>(e: &Edge<'_, T>, at: &Place<'_, T>, (i, j, seam): (usize, usize, bool)) -> T {
    let beyond = if seam { e.given.real("L") } else { of(0.0) };
    (at.real_at("q", j) + beyond - at.real_at("q", i)) / e.given.real("s")
}

fn quartic<T: Number>(e: &Edge<'_, T>) -> T {
    let (s, a) = (e.given.real("s"), e.given.real("a"));
    let energy = e.at_nodes(|at| {
        let each = segments(e).into_iter().map(|seg| {
            let r = strain(e, at, seg);
            e.given.real_at("k", seg.0) * square(r) / of(2.0) + a * r.power(4) / of(4.0)
        });
        sum(each)
    });
    points(e) - e.h * s * energy
}

fn exponential<T: Number>(e: &Edge<'_, T>) -> T {
    let energy = e.at_nodes(|at| {
        let each = segments(e)
            .into_iter()
            .map(|seg| (-strain(e, at, seg)).exp() * e.given.real_at("k", seg.0));
        sum(each)
    });
    points(e) - e.h * energy
}

fn bending<T: Number>(e: &Edge<'_, T>) -> T {
    let (s, b, c) = (e.given.real("s"), e.given.real("B"), e.given.real("c"));
    let energy = e.at_nodes(|at| {
        let each = inner(e).into_iter().map(|[before, behind]| {
            let bent = (strain(e, at, behind) - strain(e, at, before)) / s;
            b * square(bent) / of(2.0) + c * bent.power(4) / of(4.0)
        });
        sum(each)
    });
    points(e) - e.h * s * energy
}

fn kinetic<T: Number>(e: &Edge<'_, T>) -> T {
    let c = e.given.real("c");
    let each = (0..e.tail.table.sites("q")).map(|i| {
        let d = e.head.real_at("q", i) - e.tail.real_at("q", i);
        c * d.power(4) / e.h.power(3)
    });
    let energy = e.at_nodes(|at| {
        sum(segments(e)
            .into_iter()
            .map(|seg| strain(e, at, seg).power(4)))
    });
    points(e) + sum(each) - e.h * e.given.real("k") * energy / of(4.0)
}

fn tied<T: Number>(e: &Edge<'_, T>) -> T {
    let moved = |i| e.head.real_at("q", i) - e.tail.real_at("q", i);
    let each = segments(e)
        .into_iter()
        .map(|(i, j, _)| moved(i) * moved(j) * e.given.real("c") / e.h);
    let energy = e.at_nodes(|at| {
        sum(segments(e)
            .into_iter()
            .map(|seg| strain(e, at, seg).power(4)))
    });
    points(e) + sum(each) - e.h * e.given.real("k") * energy / of(4.0)
}

fn growing<T: Number>(e: &Edge<'_, T>) -> T {
    let each = (0..e.tail.table.sites("q")).map(|i| {
        let d = e.head.real_at("q", i) - e.tail.real_at("q", i);
        let heavy =
            of::<T>(1.0) + square((e.head.real_at("q", i) + e.tail.real_at("q", i)) / of(2.0));
        heavy * e.given.real_at("m", i) * square(d) / (of::<T>(2.0) * e.h)
    });
    let energy = e.at_nodes(|at| {
        sum(segments(e)
            .into_iter()
            .map(|seg| square(strain(e, at, seg))))
    });
    sum(each) - e.h * e.given.real("k") * energy / of(2.0)
}

fn plane<T: Number>(e: &Edge<'_, T>) -> T {
    let (s, k) = (e.given.real("s"), e.given.real("k"));
    let each = (0..e.tail.table.sites("x")).map(|i| {
        let d = minus(&e.head.column_at::<2>("x", i), &e.tail.column_at("x", i));
        e.given.real_at("m", i) * norm(&d) / (of::<T>(2.0) * e.h)
    });
    let energy = e.at_nodes(|at| {
        let each = segments(e).into_iter().map(|(i, j, seam)| {
            let beyond = if seam {
                e.given.column("L")
            } else {
                [of(0.0); 2]
            };
            let r = minus(
                &plus(&at.column_at::<2>("x", j), &beyond),
                &at.column_at("x", i),
            );
            square(norm(&r) / square(s) - of(1.0))
        });
        sum(each)
    });
    sum(each) - e.h * s * k * energy / of(8.0)
}

macro_rules! chain {
    ($name:literal, $rest:literal, $kinds:expr, $action:expr, $sites:expr, $reach:expr) => {
        Line {
            text: concat!(
                "model ", $name, " { label i in 0..N step s; periodic; param m: Real at nodes; field q: Real at nodes offset L;
                 let d = next(q) - q; let r = (next(q, i) - q)/s; ", $rest,
                " end i = 0 { free; pinned { q = given; } } end i = N { free; pinned { q = given; } } }"
            ),
            action: $action,
            given: $kinds,
            moving: &[("q", Nodes, Vector(1))],
            pinned: &["q"],
            sites: $sites,
            reach: $reach,
            refused: 0,
            known: None,
        }
    };
}

pub const ROWS: &[Line] = &[
    chain!(
        "ChainQuartic",
        "param k: Real at segments; param a: Real; lagrangian = m*d^2/(2*h) - h*s*(k*r^2/2 + a*r^4/4);",
        &[("s", Whole, Positive), ("L", Whole, Positive), ("m", Nodes, Mass), ("k", Segments, Positive), ("a", Whole, Positive)],
        action!(quartic),
        ALL,
        0
    ),
    chain!(
        "ChainExponential",
        "param k: Real at segments; lagrangian = m*d^2/(2*h) - h*k*exp(-r);",
        &[("s", Whole, Positive), ("L", Whole, Positive), ("m", Nodes, Mass), ("k", Segments, Positive)],
        action!(exponential),
        ALL,
        0
    ),
    chain!(
        "ChainBending",
        "param B, c: Real; let b = (next(q, i) - 2*q + prev(q, i))/s^2;
         lagrangian = m*d^2/(2*h) - h*s*(B*b^2/2 + c*b^4/4);",
        &[("s", Whole, Positive), ("L", Whole, Positive), ("m", Nodes, Mass), ("B", Whole, Positive), ("c", Whole, Positive)],
        action!(bending),
        INNER,
        0
    ),
    chain!(
        "ChainFourth",
        "param k, c: Real; lagrangian = m*d^2/(2*h) + (c/h^3)*d^4 - h*k*r^4/4;",
        &[("s", Whole, Positive), ("L", Whole, Positive), ("m", Nodes, Mass), ("k", Whole, Positive), ("c", Whole, Mass)],
        action!(kinetic),
        ALL,
        0
    ),
    chain!(
        "ChainTied",
        "param k, c: Real;
         lagrangian = m*d^2/(2*h) + (c/h)*(next(q) - q)*(next(next(q, i)) - next(q, i)) - h*k*r^4/4;",
        &[("s", Whole, Positive), ("L", Whole, Positive), ("m", Nodes, Mass), ("k", Whole, Positive), ("c", Whole, Positive)],
        action!(tied),
        INNER,
        1
    ),
    chain!(
        "ChainGrowing",
        "param k: Real; lagrangian = (1 + ((q + next(q))/2)^2)*m*d^2/(2*h) - h*k*r^2/2;",
        &[("s", Whole, Positive), ("L", Whole, Positive), ("m", Nodes, Mass), ("k", Whole, Positive)],
        action!(growing),
        ALL,
        0
    ),
    Line {
        text: "model ChainPlane { label i in 0..N step s; periodic; param m: Real at nodes; param k: Real;
            field x: Vec<2> at nodes offset L; let d = next(x) - x; let r = (next(x, i) - x)/s;
            lagrangian = m*dot(d, d)/(2*h) - (h*s*k/8)*(dot(r, r) - 1)^2;
            end i = 0 { free; pinned { x = given; } } end i = N { free; pinned { x = given; } } }",
        action: action!(plane),
        given: &[("s", Whole, Positive), ("L", Whole, Vector(2)), ("m", Nodes, Mass), ("k", Whole, Positive)],
        moving: &[("x", Nodes, Vector(2))],
        pinned: &["x"],
        sites: ALL,
        reach: 0,
        refused: 0,
        known: None,
    },
];
