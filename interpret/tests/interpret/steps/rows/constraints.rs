//! Constraints on configurations.

use crate::steps::row::{Named, Row};
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{Square, dot};
use clebsch_oracle::oracle::step::{Edge, Place};

fn pendulum<T: Number>(e: &Edge<'_, T>) -> T {
    let weight = e.given.real("m") * e.given.real("g");
    let height = e.at_nodes(|at| at.column::<3>("x")[2].power(2) + at.column::<3>("x")[2]);
    mass::<T, 3>(e, "m", "x") - e.h * weight * height
}

fn of_pendulum<T: Number>(given: &Place<'_, T>, at: &Place<'_, T>) -> Vec<T> {
    vec![norm(&at.column::<3>("x")) - square(given.real("l"))]
}

/// Removes the part of a momentum along the first vector.
fn tangent(across: &[f64], momentum: &mut [f64]) {
    let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let part = inner(across, momentum) / inner(across, across);
    momentum
        .iter_mut()
        .zip(across)
        .for_each(|(p, x)| *p -= part * x);
}

fn settle_pendulum(named: &mut Named) {
    // Far from the point of suspension.
    let length = named["x"].iter().map(|x| x * x).sum::<f64>().sqrt();
    let x: Vec<f64> = named["x"].iter().map(|x| x / length).collect();
    named.insert("x", x.clone());
    named.insert("l", vec![x.iter().map(|x| x * x).sum::<f64>().sqrt()]);
    let momentum = momentum_of(named, "x");
    tangent(&x, momentum);
}

/// The momentum of a configuration. If the configuration is the only one, the momentum is named without it.
fn momentum_of<'a>(named: &'a mut Named, name: &str) -> &'a mut Vec<f64> {
    let own = format!("_{name}");
    let found = named.iter_mut().find(|(key, _)| {
        let is_momentum = key.contains("momentum") || key.starts_with('p');
        is_momentum && (key.ends_with(&own) || **key == "momentum" || **key == "p")
    });
    found.map(|(_, list)| list).expect("has a momentum")
}

fn rod<T: Number>(e: &Edge<'_, T>) -> T {
    mass::<T, 2>(e, "m", "x") + mass::<T, 2>(e, "M", "y")
        - e.h * e.given.real("g") * e.at_nodes(|at| at.column::<2>("y")[1].power(3))
}

fn of_rod<T: Number>(given: &Place<'_, T>, at: &Place<'_, T>) -> Vec<T> {
    let apart = minus(&at.column::<2>("y"), &at.column("x"));
    vec![norm(&apart) - square(given.real("l"))]
}

fn settle_rod(named: &mut Named) {
    let apart: Vec<f64> = named["y"]
        .iter()
        .zip(&named["x"])
        .map(|(y, x)| y - x)
        .collect();
    named.insert("l", vec![apart.iter().map(|x| x * x).sum::<f64>().sqrt()]);
    // Equal velocities keep the distance.
    let (m, big) = (named["m"][0], named["M"][0]);
    let first = momentum_of(named, "x").clone();
    *momentum_of(named, "y") = first.iter().map(|p| p * big / m).collect();
}

fn area<T: Number>(e: &Edge<'_, T>) -> T {
    let d = e.changed::<2>("Q");
    let potential = e.at_nodes(|at| {
        let q = at.square::<2>("Q");
        square((q.transpose() * q).trace())
    });
    e.given.real("m") * (d * d.transpose()).trace() / (of::<T>(2.0) * e.h)
        - e.h * e.given.real("k") * potential
}

fn of_area<T: Number>(_: &Place<'_, T>, at: &Place<'_, T>) -> Vec<T> {
    vec![at.square::<2>("Q").determinant() - of(1.0)]
}

fn settle_area(named: &mut Named) {
    let q = &named["Q"];
    let (a, b, c) = (1.0 + 0.5 * q[0], 0.5 * q[1], 0.5 * q[2]);
    let d = (1.0 + b * c) / a;
    named.insert("Q", vec![a, b, c, d]);
    tangent(&[d, -c, -b, a], momentum_of(named, "Q"));
}

fn frame<T: Number>(e: &Edge<'_, T>) -> T {
    let d = e.changed::<3>("Q");
    (d * e.given.square("J") * d.transpose()).trace() / (of::<T>(2.0) * e.h)
}

fn of_frame<T: Number>(_: &Place<'_, T>, at: &Place<'_, T>) -> Vec<T> {
    let q = at.square::<3>("Q");
    let off = q.transpose() * q - Square::identity();
    let entries = (0..3).flat_map(|i| (i..3).map(move |j| (i, j)));
    entries.map(|(i, j)| off.0[i][j]).collect()
}

fn settle_frame(named: &mut Named) {
    let p = momentum_of(named, "Q").clone();
    let j = Square::<f64, 3>::from_entries(|r, c| named["J"][3 * r + c]);
    let spin = clebsch_oracle::oracle::square::hat(&[
        p[0] / j.0[0][0],
        p[1] / j.0[0][0],
        p[2] / j.0[0][0],
    ]);
    named.insert("Q", vec![0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
    let q = Square::<f64, 3>::from_entries(|r, c| named["Q"][3 * r + c]);
    *momentum_of(named, "Q") = (q * spin * j).0.concat();
}

fn joint<T: Number>(e: &Edge<'_, T>) -> T {
    let weight = e.at_nodes(|at| dot(&e.given.column::<3>("g"), &at.column("x")));
    body::<T, 3>(e, "J", "R") + mass::<T, 3>(e, "m", "x") - e.h * weight
}

fn of_joint<T: Number>(given: &Place<'_, T>, at: &Place<'_, T>) -> Vec<T> {
    let held = plus(
        &at.column::<3>("x"),
        &at.square::<3>("R").apply(&given.column("a")),
    );
    minus(&held, &given.column("c")).to_vec()
}

fn settle_joint(named: &mut Named) {
    use clebsch_oracle::oracle::square::cross;
    let column = |list: &[f64]| [list[0], list[1], list[2]];
    let square = |list: &[f64]| Square::<f64, 3>::from_entries(|r, c| list[3 * r + c]);
    let (turn, j, m) = (square(&named["R"]), square(&named["J"]), named["m"][0]);
    let (x, a) = (column(&named["x"]), column(&named["a"]));
    named.insert("c", plus(&x, &turn.apply(&a)).to_vec());
    let spin = times(1.0 / j.trace(), &column(momentum_of(named, "R")));
    let turning = minus(&times(j.trace(), &spin), &j.apply(&spin));
    *momentum_of(named, "R") = turning.to_vec();
    let velocity = turn.apply(&cross(&spin, &a));
    *momentum_of(named, "x") = times(-m, &velocity).to_vec();
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model HeldPendulum { param m, g, l: Real; field x: Vec<3>; hold n: dot(x, x) = l^2;
            lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*(x[3]^2 + x[3]); }",
        action!(pendulum, of_pendulum),
        &["m"],
    )
    .settled(settle_pendulum),
    Row::of(
        "model HeldRod { param m, M, g, l: Real; field x, y: Vec<2>; hold n: dot(y - x, y - x) = l^2;
            let u = next(x) - x; let v = next(y) - y;
            lagrangian = (m*dot(u, u) + M*dot(v, v))/(2*h) - h*g*y[2]^3; }",
        action!(rod, of_rod),
        &["m", "M"],
    )
    .settled(settle_rod),
    Row::of(
        "model HeldArea { param m, k: Real; field Q: Mat<2>; hold n: det(Q) = 1; let D = next(Q) - Q;
            lagrangian = m*tr(D*D^T)/(2*h) - h*k*tr(Q^T*Q)^2; }",
        action!(area, of_area),
        &["m"],
    )
    .settled(settle_area),
    Row::of(
        "model HeldFrame { param J: Sym<3>; field Q: Mat<3>; hold n: Q^T*Q = Id; let D = next(Q) - Q;
            lagrangian = tr(D*J*D^T)/(2*h); }",
        action!(frame, of_frame),
        &["J"],
    )
    // These components would stretch the axes, which the constraint prevents.
    .idle(&["momentum[1]", "momentum[3]", "momentum[8]"])
    .settled(settle_frame),
    Row::of(
        "model HeldJoint { param J: Sym<3>; param m: Real; param a, c, g: Vec<3>; group R: SO<3> velocity W;
            field x: Vec<3>; constraint next(R) = R*W; hold n: x + R*a = c; let d = next(x) - x;
            lagrangian = -tr(J*W)/h + m*dot(d, d)/(2*h) - h*dot(g, x); }",
        action!(joint, of_joint),
        &["J", "m"],
    )
    .settled(settle_joint)
    .refused(1)
    .misses(3.5e-09),
];
