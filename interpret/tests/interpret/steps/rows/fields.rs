//! Fields: numbers, vectors and matrices.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{Square, dot};
use clebsch_oracle::oracle::step::Edge;

fn number_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let potential = e.given.real("k") * e.at_nodes(|at| at.real("x").power(4)) / of(4.0);
    point(e, "m", "x") + e.given.real("b") * e.change("x").power(4) / e.h.power(3) - e.h * potential
}

fn number_exponential<T: Number>(e: &Edge<'_, T>) -> T {
    e.given.real("m") * e.h * (e.change("x") / e.h).cosh()
}

fn number_rational<T: Number>(e: &Edge<'_, T>) -> T {
    let mean = (e.tail.real("x") + e.head.real("x")) / of(2.0);
    e.given.real("m") * square(e.change("x")) / (of::<T>(2.0) * e.h * (of::<T>(1.0) + square(mean)))
}

fn vector_root<T: Number>(e: &Edge<'_, T>) -> T {
    let inside = of::<T>(1.0) + norm(&e.changes::<3>("x")) / square(e.h);
    mass::<T, 3>(e, "m", "x") + e.given.real("b") * e.h * inside.sqrt()
}

fn vector_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let d: [T; 2] = e.changes("x");
    let k = e.given.real("k");
    mass::<T, 2>(e, "m", "x") + e.given.real("b") * square(norm(&d)) / e.h.power(3)
        - e.h * k * e.at_nodes(|at| square(norm(&at.column::<2>("x")))) / of(4.0)
}

fn vector_mass<T: Number>(e: &Edge<'_, T>) -> T {
    let both = plus(&e.tail.column::<2>("x"), &e.head.column("x"));
    let swollen = of::<T>(1.0) + norm(&both) / of(4.0);
    swollen * mass::<T, 2>(e, "m", "x")
}

fn angles<T: Number>(e: &Edge<'_, T>) -> T {
    let (m, c) = (e.given.real("m"), e.given.real("c"));
    let (p, q) = (e.change("p"), e.change("q"));
    let turned = (e.tail.real("p") - e.tail.real("q")).cos();
    let height = e.at_nodes(|at| of::<T>(2.0) * at.real("p").cos() + at.real("q").cos());
    m * (square(p) + square(q)) / (of::<T>(2.0) * e.h)
        + c * m * p * q * turned / e.h
        + e.h * e.given.real("g") * height
}

/// A field with two rows and three columns, and an inertia on either side.
fn sheet<T: Number>(e: &Edge<'_, T>) -> T {
    let (a, b) = (e.given.square::<2>("A"), e.given.square::<3>("B"));
    let d: [T; 6] = e.changes("F");
    let row = |i: usize| [0, 1, 2].map(|k| d[3 * i + k]);
    let each = (0..4).map(|k| a.0[k / 2][k % 2] * dot(&row(k / 2), &b.apply(&row(k % 2))));
    let kinetic = each.fold(of::<T>(0.0), |sum, x| sum + x) / (of::<T>(2.0) * e.h);
    let k = e.given.real("k");
    kinetic - e.h * k * e.at_nodes(|at| square(norm(&at.column::<6>("F"))))
}

fn matrix_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let d = e.changed::<2>("A");
    let size = (d * d.transpose()).trace();
    let k = e.given.real("k");
    let potential = e.at_nodes(|at| k * square(at.square::<2>("A").determinant()));
    e.given.real("m") * size / (of::<T>(2.0) * e.h)
        + e.given.real("b") * square(size) / e.h.power(3)
        - e.h * potential
}

fn diagonal<T: Number>(e: &Edge<'_, T>) -> T {
    let d: [T; 3] = e.changes("D");
    let potential = e.at_nodes(|at| {
        let [x, y, z] = at.column::<3>("D");
        x * y * z
    });
    e.given.real("m") * norm(&d) / (of::<T>(2.0) * e.h) - e.h * e.given.real("k") * potential
}

fn symmetric<T: Number>(e: &Edge<'_, T>) -> T {
    let whole = |s: [T; 3]| Square([[s[0], s[1]], [s[1], s[2]]]);
    let d = whole(e.changes("S"));
    let k = e.given.square::<2>("K");
    let potential = e.at_nodes(|at| {
        let s = whole(at.column("S"));
        (k * s).trace() + (s * s).trace()
    });
    e.given.real("m") * (d * d).trace() / (of::<T>(2.0) * e.h) - e.h * potential
}

fn midpoint<T: Number>(e: &Edge<'_, T>) -> T {
    let mean = (e.tail.real("x") + e.head.real("x")) / of(2.0);
    point(e, "m", "x") - e.h * e.given.real("k") * (mean.power(4) / of(4.0) - mean.cos())
}

fn magnetic<T: Number>(e: &Edge<'_, T>) -> T {
    let d: [T; 3] = e.changes("x");
    let turned = clebsch_oracle::oracle::square::cross(&e.given.column("B"), &e.tail.column("x"));
    let logs = e.at_nodes(|at| (of::<T>(3.0) + norm(&at.column::<3>("x"))).ln());
    mass::<T, 3>(e, "m", "x") + dot(&turned, &d) / of(2.0) - e.h * e.given.real("k") * logs
}

fn driven<T: Number>(e: &Edge<'_, T>) -> T {
    let (w, t) = (e.given.real("w"), e.given.real("t"));
    // The clock advances by the step size.
    let height =
        (w * t).sin() * e.tail.real("x").cos() + (w * (t + e.h)).sin() * e.head.real("x").cos();
    point(e, "m", "x") + e.h * e.given.real("k") * height / of(2.0)
}

fn coupled<T: Number>(e: &Edge<'_, T>) -> T {
    let (x, y) = (e.change("x"), e.change("y"));
    let heavy = of::<T>(1.0) + square(e.tail.real("y"));
    heavy * point(e, "m", "x")
        + point(e, "m", "y")
        + e.given.real("b") * square(x * y) / e.h.power(3)
}

fn wall<T: Number>(e: &Edge<'_, T>) -> T {
    let g = e.given.real("g");
    point(e, "m", "x") + e.h * e.at_nodes(|at| at.real("x").ln() - g * at.real("x").fraction(3, 2))
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model NumberFourth { param m, b, k: Real; field x: Real; let d = next(x) - x;
            lagrangian = m*d^2/(2*h) + (b/h^3)*d^4 - h*k*x^4/4; }",
        action!(number_fourth),
        &["m", "b"],
    ),
    Row::of(
        "model NumberExponential { param m: Real; field x: Real; lagrangian = m*h*cosh((next(x) - x)/h); }",
        action!(number_exponential),
        &["m"],
    ),
    Row::of(
        "model NumberRational { param m: Real; field x: Real;
            lagrangian = m*(next(x) - x)^2/(2*h*(1 + ((x + next(x))/2)^2)); }",
        action!(number_rational),
        &["m"],
    ),
    Row::of(
        "model VectorRoot { param m, b: Real; field x: Vec<3>; let d = next(x) - x;
            lagrangian = m*dot(d, d)/(2*h) + b*h*sqrt(1 + dot(d, d)/h^2); }",
        action!(vector_root),
        &["m", "b"],
    ),
    Row::of(
        "model VectorFourth { param m, b, k: Real; field x: Vec<2>; let d = next(x) - x;
            lagrangian = m*dot(d, d)/(2*h) + (b/h^3)*dot(d, d)^2 - (h/4)*k*dot(x, x)^2; }",
        action!(vector_fourth),
        &["m", "b"],
    ),
    Row::of(
        "model VectorMass { param m: Real; field x: Vec<2>; let d = next(x) - x; let y = (x + next(x))/2;
            lagrangian = (1 + dot(y, y))*m*dot(d, d)/(2*h); }",
        action!(vector_mass),
        &["m"],
    ),
    Row::of(
        "model TwoAngles { param m, c, g: Real; field p, q: Real; let u = next(p) - p; let v = next(q) - q;
            lagrangian = m*(u^2 + v^2)/(2*h) + (c/h)*m*u*v*cos(p - q) + h*g*(2*cos(p) + cos(q)); }",
        action!(angles),
        &["m"],
    ),
    Row::of(
        "model MatrixFourth { param m, b, k: Real; field A: Mat<2>; let D = next(A) - A;
            lagrangian = m*tr(D*D^T)/(2*h) + (b/h^3)*tr(D*D^T)^2 - h*k*det(A)^2; }",
        action!(matrix_fourth),
        &["m", "b"],
    ),
    Row::of(
        "model DiagonalField { param m, k: Real; field D: Diag<3>; let d = next(D) - D;
            lagrangian = m*tr(d*d)/(2*h) - h*k*det(D); }",
        action!(diagonal),
        &["m"],
    ),
    Row::of(
        "model SymmetricField { param m: Real; param K: Sym<2>; field S: Sym<2>; let d = next(S) - S;
            lagrangian = m*tr(d*d)/(2*h) - h*(tr(K*S) + tr(S*S)); }",
        action!(symmetric),
        &["m"],
    ),
    Row::of(
        "model MidpointField { param m, k: Real; field x: Real; let y = (x + next(x))/2;
            lagrangian = m*(next(x) - x)^2/(2*h) - h*k*(y^4/4 - cos(y)); }",
        action!(midpoint),
        &["m"],
    ),
    Row::of(
        "model Sheet { param A: Sym<2>; param B: Sym<3>; param k: Real; field F: Mat<2, 3>; let D = next(F) - F;
            lagrangian = tr(A*D*B*D^T)/(2*h) - h*k*tr(F*F^T)^2; }",
        action!(sheet),
        &["A"],
    )
    .positive(&["B"]),
    Row::of(
        "model MagneticField { param m, k: Real; param B: Vec<3>; field x: Vec<3>; let d = next(x) - x;
            lagrangian = m*dot(d, d)/(2*h) + dot(cross(B, x), d)/2 - h*k*log(3 + dot(x, x)); }",
        action!(magnetic),
        &["m"],
    ),
    Row::of(
        "model DrivenField { param m, k, w: Real; field x: Real; advected t: Real; constraint next(t) = t + h;
            lagrangian = m*(next(x) - x)^2/(2*h) + h*k*sin(w*t)*cos(x); }",
        action!(driven),
        &["m"],
    ),
    Row::of(
        "model CoupledFields { param m, b: Real; field x, y: Real; let u = next(x) - x; let v = next(y) - y;
            lagrangian = (1 + y^2)*m*u^2/(2*h) + m*v^2/(2*h) + (b/h^3)*u^2*v^2; }",
        action!(coupled),
        &["m", "b"],
    ),
    Row::of(
        "model BeforeWall { param m, g: Real; field x: Real;
            lagrangian = m*(next(x) - x)^2/(2*h) + h*(log(x) - g*x^(3/2)); }",
        action!(wall),
        &["m"],
    )
    .positive(&["x"]),
];
