//! Bodies along a line: rotations at nodes and at segments, unit quaternions, rods.

use crate::steps::line::Line;
use crate::steps::quantity::At::{Nodes, Segments, Whole};
use crate::steps::quantity::Sites;
use crate::steps::quantity::What::{Mass, Moments, Positive, Quaternion, Stiffness, Turn, Vector};
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::vee;
use clebsch_oracle::oracle::step::{Edge, Place};

const FREE: Option<[&str; 2]> = Some(["free", "free"]);

const OPEN: &[Sites] = &[
    (3, FREE),
    (1, FREE),
    (2, FREE),
    (5, None),
    (12, FREE),
    (12, None),
];

/// `R^T*next(R)` of a site.
fn turn<T: Number>(e: &Edge<'_, T>, i: usize) -> Mat<T, 3> {
    e.tail.square_at::<3>("R", i).transpose() * e.head.square_at("R", i)
}

fn bodies<T: Number>(e: &Edge<'_, T>) -> T {
    let each = (0..e.tail.table.sites("R"))
        .map(|i| -(e.given.square_at::<3>("J", i) * turn(e, i)).trace() / e.h);
    sum(each)
}

/// Pairs of neighbours among the sites of a quantity.
fn pairs<T: Number>(e: &Edge<'_, T>, of_name: &str) -> Vec<(usize, usize)> {
    let count = e.tail.table.sites(of_name);
    let (_, is_ring) = extent(e);
    let last = if is_ring { count } else { count - 1 };
    (0..last).map(|i| (i, (i + 1) % count)).collect()
}

/// `R^T*next(R, i)` of a pair.
fn between<T: Number>(at: &Place<'_, T>, (i, j): (usize, usize)) -> Mat<T, 3> {
    at.square_at::<3>("R", i).transpose() * at.square_at("R", j)
}

fn tops<T: Number>(e: &Edge<'_, T>) -> T {
    let b = e.given.square::<3>("B");
    let energy = e.at_nodes(|at| {
        let each = pairs(e, "R").into_iter().map(|pair| {
            let u = between(at, pair);
            -(b * u).trace() + e.given.real("c") * square(norm(&vee(&u)))
        });
        sum(each)
    });
    bodies(e) - e.h * energy
}

fn fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let each = (0..e.tail.table.sites("R"))
        .map(|i| e.given.real("c") * square(norm(&vee(&turn(e, i)))) / e.h.power(3));
    let b = e.given.square::<3>("B");
    let energy = e.at_nodes(|at| {
        sum(pairs(e, "R")
            .into_iter()
            .map(|pair| (b * between(at, pair)).trace()))
    });
    bodies(e) + sum(each) + e.h * energy
}

fn sections<T: Number>(e: &Edge<'_, T>) -> T {
    let parts = |q: Mat<T, 4>| {
        let [w, x, y, z] = q.0.map(|row| row[0]);
        (w, [x, y, z])
    };
    let each = (0..e.tail.table.sites("q")).map(|i| {
        let (_, v) = parts(e.tail.square_at::<4>("q", i).transpose() * e.head.square_at("q", i));
        of::<T>(2.0) * form(&e.given.square_at::<3>("I", i), &v) / e.h
    });
    let k = e.given.square::<3>("K");
    let energy = e.at_nodes(|at| {
        let each = pairs(e, "q").into_iter().map(|(i, j)| {
            let (_, v) = parts(at.square_at::<4>("q", i).transpose() * at.square_at("q", j));
            let bent = form(&k, &v);
            of::<T>(2.0) * bent + e.given.real("c") * square(bent)
        });
        sum(each)
    });
    sum(each) - e.h * energy
}

fn rod<T: Number>(e: &Edge<'_, T>) -> T {
    let s = e.given.real("s");
    let each = (0..e.tail.table.sites("x")).map(|i| {
        let d = minus(&e.head.column_at::<3>("x", i), &e.tail.column_at("x", i));
        e.given.real_at("m", i) * norm(&d) / (of::<T>(2.0) * e.h)
    });
    let (b, c) = (e.given.square::<3>("B"), e.given.real("c"));
    let energy = e.at_nodes(|at| {
        let stretched = segments(e).into_iter().map(|(i, j, seam)| {
            let beyond = if seam {
                e.given.column("L")
            } else {
                [of(0.0); 3]
            };
            let along = minus(
                &plus(&at.column_at::<3>("x", j), &beyond),
                &at.column_at("x", i),
            );
            let seen = at.square_at::<3>("R", i).transpose().apply(&along);
            let f = [seen[0] / s, seen[1] / s, seen[2] / s - of(1.0)];
            s * c * square(norm(&f)) / of(4.0)
        });
        let bent = pairs(e, "R")
            .into_iter()
            .map(|pair| -(b * between(at, pair)).trace() / s);
        sum(stretched) + sum(bent)
    });
    sum(each) + s * bodies(e) - e.h * energy
}

pub const ROWS: &[Line] = &[
    Line {
        text: "model LineOfTops { label i in 0..N; periodic; param J: Sym<3> at nodes; param B: Sym<3>; param c: Real;
            group R: SO<3> at nodes velocity W; constraint next(R) = R*W; let U = R^T*next(R, i);
            lagrangian = -tr(J*W)/h + h*tr(B*U) - h*c*dot(vee(U), vee(U))^2; }",
        action: action!(tops),
        given: &[("J", Nodes, Moments), ("B", Whole, Stiffness), ("c", Whole, Positive)],
        moving: &[("R", Nodes, Turn)],
        pinned: &[],
        sites: OPEN,
        reach: 0,
        refused: 0,
        known: None,
    },
    Line {
        text: "model LineOfFourths { label i in 0..N; periodic; param J: Sym<3> at nodes; param B: Sym<3>; param c: Real;
            group R: SO<3> at nodes velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h^3)*dot(vee(W), vee(W))^2 + h*tr(B*R^T*next(R, i)); }",
        action: action!(fourth),
        given: &[("J", Nodes, Moments), ("B", Whole, Stiffness), ("c", Whole, Mass)],
        moving: &[("R", Nodes, Turn)],
        pinned: &[],
        sites: OPEN,
        reach: 0,
        refused: 0,
        known: None,
    },
    Line {
        text: "model LineOfQuaternions { label i in 0..N; param I: Sym<3> at nodes; param K: Sym<3>; param c: Real;
            group q: SU<2> at nodes velocity W; constraint next(q) = q*W; let v = im(q^T*next(q, i));
            lagrangian = (2/h)*dot(im(W), I*im(W)) - 2*h*dot(v, K*v) - h*c*dot(v, K*v)^2; }",
        action: action!(sections),
        given: &[("I", Nodes, Moments), ("K", Whole, Stiffness), ("c", Whole, Positive)],
        moving: &[("q", Nodes, Quaternion)],
        pinned: &[],
        sites: &[(3, FREE), (1, FREE), (2, FREE), (5, FREE), (12, FREE)],
        reach: 0,
        refused: 0,
        known: None,
    },
    Line {
        text: "model RodQuartic { label i in 0..N step s; periodic; param m: Real at nodes; param J: Sym<3> at segments;
            param B: Sym<3>; param c: Real; field x: Vec<3> at nodes offset L;
            group R: SO<3> at segments velocity W; constraint next(R) = R*W;
            let d = next(x) - x; let F = R^T*(next(x, i) - x)/s - E3;
            lagrangian = m*dot(d, d)/(2*h) - s*tr(J*W)/h - (h*s*c/4)*dot(F, F)^2
                + (h/s)*tr(B*R^T*next(R, i));
            end i = 0 { free; pinned { x = given; } } end i = N { free; pinned { x = given; } } }",
        action: action!(rod),
        given: &[
            ("s", Whole, Positive),
            ("L", Whole, Vector(3)),
            ("m", Nodes, Mass),
            ("J", Segments, Moments),
            ("B", Whole, Stiffness),
            ("c", Whole, Positive),
        ],
        moving: &[("x", Nodes, Vector(3)), ("R", Segments, Turn)],
        pinned: &["x"],
        sites: &[
            (3, None),
            (1, FREE),
            (2, Some(["pinned", "free"])),
            (3, Some(["pinned", "pinned"])),
            (5, FREE),
            (12, FREE),
            (12, None),
        ],
        reach: 0,
        refused: 0,
        known: None,
    },
];
