//! Unit quaternions.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::dot;
use clebsch_oracle::oracle::step::{Edge, Place};

/// The components of `q^T*next(q)`: the first column of the matrix of a left multiplication.
fn turn<T: Number>(e: &Edge<'_, T>, q: &str) -> [T; 4] {
    e.turn::<4>(q).0.map(|row| row[0])
}

fn re<T: Number>(e: &Edge<'_, T>) -> T {
    turn(e, "q")[0]
}

fn im<T: Number>(e: &Edge<'_, T>) -> [T; 3] {
    let [_, x, y, z] = turn(e, "q");
    [x, y, z]
}

/// The vertical in the body frame: the imaginary part of `q^T quat(z) q`, by the formula of Rodrigues.
fn seen<T: Number>(at: &Place<'_, T>, z: &[T; 3]) -> [T; 3] {
    let [w, x, y, u] = at.square::<4>("q").0.map(|row| row[0]);
    let v = [-x, -y, -u];
    let two = of::<T>(2.0);
    let first = times(square(w) - norm(&v), z);
    let second = times(two * dot(&v, z), &v);
    let third = times(two * w, &clebsch_oracle::oracle::square::cross(&v, z));
    plus(&plus(&first, &second), &third)
}

fn top<T: Number>(e: &Edge<'_, T>) -> T {
    let (a, z): ([T; 3], [T; 3]) = (e.given.column("a"), e.given.column("z"));
    let c = e.given.real("c");
    let v = im(e);
    let turning = form(&e.given.square::<3>("I"), &v) - c * norm(&v);
    -(of::<T>(4.0) * c / e.h) * re(e) + of::<T>(2.0) * turning / e.h
        - e.h * e.at_nodes(|at| dot(&a, &seen(at, &z)))
}

fn energy<T: Number>(e: &Edge<'_, T>) -> T {
    of::<T>(2.0) * form(&e.given.square::<3>("I"), &im(e)) / e.h
}

fn fourth<T: Number>(e: &Edge<'_, T>) -> T {
    energy(e) + e.given.real("c") * square(norm(&im(e))) / e.h.power(3)
}

fn exponential<T: Number>(e: &Edge<'_, T>) -> T {
    let c = e.given.real("c");
    -(of::<T>(4.0) * c / e.h) * re(e) + e.given.real("b") * norm(&im(e)).exp() / e.h
}

fn space<T: Number>(e: &Edge<'_, T>) -> T {
    // The components of `next(q)*q^T`.
    let w = e.turn_in_space::<4>("q").0.map(|row| row[0]);
    let v = [w[1], w[2], w[3]];
    -(of::<T>(4.0) * e.given.real("c") / e.h) * w[0]
        + of::<T>(2.0) * form(&e.given.square::<3>("K"), &v) / e.h
}

fn rational<T: Number>(e: &Edge<'_, T>) -> T {
    e.given.real("c") * norm(&im(e)) / (square(re(e)) * e.h)
}

fn field<T: Number>(e: &Edge<'_, T>) -> T {
    let swollen = of::<T>(1.0) + square(e.tail.real("x"));
    e.given.real("c") * swollen * norm(&im(e)) / e.h + point(e, "m", "x")
}

fn logarithm<T: Number>(e: &Edge<'_, T>) -> T {
    -e.given.real("c") * re(e).ln() / e.h
}

fn two<T: Number>(e: &Edge<'_, T>) -> T {
    let [_, x, y, z] = turn(e, "r");
    let other = [x, y, z];
    energy(e)
        + of::<T>(2.0) * form(&e.given.square::<3>("K"), &other) / e.h
        + e.given.real("b") * dot(&im(e), &other) / e.h
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model QuaternionTop { param I: Diag<3>; param c: Real; param a, z: Vec<3>; group q: SU<2> velocity W;
            advected G: Vec<3> = rot(q)^T*z; constraint next(q) = q*W; constraint next(G) = rot(W)^T*G;
            lagrangian = -(4*c/h)*re(W) + (2/h)*dot(im(W), (I - c*Id)*im(W)) - h*dot(a, G); }",
        action!(top),
        &["I", "c"],
    )
    .refused(1),
    Row::of(
        "model QuaternionEnergy { param I: Sym<3>; group q: SU<2> velocity W; constraint next(q) = q*W;
            lagrangian = (2/h)*dot(im(W), I*im(W)); }",
        action!(energy),
        &["I"],
    ),
    Row::of(
        "model QuaternionFourth { param I: Sym<3>; param c: Real; group q: SU<2> velocity W; constraint next(q) = q*W;
            lagrangian = (2/h)*dot(im(W), I*im(W)) + (c/h^3)*dot(im(W), im(W))^2; }",
        action!(fourth),
        &["I", "c"],
    ),
    Row::of(
        "model QuaternionExponential { param b, c: Real; group q: SU<2> velocity W; constraint next(q) = q*W;
            lagrangian = -(4*c/h)*re(W) + (b/h)*exp(dot(im(W), im(W))); }",
        action!(exponential),
        &["b", "c"],
    ),
    Row::of(
        "model QuaternionSpace { param K: Sym<3>; param c: Real; group q: SU<2> velocity W; constraint next(q) = W*q;
            lagrangian = -(4*c/h)*re(W) + (2/h)*dot(im(W), K*im(W)); }",
        action!(space),
        &["K", "c"],
    ),
    Row::of(
        "model QuaternionRational { param c: Real; group q: SU<2> velocity W; constraint next(q) = q*W;
            lagrangian = (c/h)*dot(im(W), im(W))/re(W)^2; }",
        action!(rational),
        &["c"],
    ),
    Row::of(
        "model QuaternionField { param c, m: Real; group q: SU<2> velocity W; field x: Real; constraint next(q) = q*W;
            lagrangian = (c/h)*(1 + x^2)*dot(im(W), im(W)) + m*(next(x) - x)^2/(2*h); }",
        action!(field),
        &["c", "m"],
    ),
    Row::of(
        "model QuaternionLogarithm { param c: Real; group q: SU<2> velocity W; constraint next(q) = q*W;
            lagrangian = -(c/h)*log(re(W)); }",
        action!(logarithm),
        &["c"],
    ),
    Row::of(
        "model QuaternionTwo { param I, K: Sym<3>; param b: Real; group q: SU<2> velocity W; group r: SU<2> velocity U;
            constraint next(q) = q*W; constraint next(r) = r*U;
            lagrangian = (2/h)*dot(im(W), I*im(W)) + (2/h)*dot(im(U), K*im(U)) + (b/h)*dot(im(W), im(U)); }",
        action!(two),
        &["I", "K"],
    ),
];
