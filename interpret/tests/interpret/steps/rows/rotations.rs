//! Rotations of the plane and of four dimensions.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{Square, dot};
use clebsch_oracle::oracle::step::Edge;

fn trace<T: Number, const N: usize>(e: &Edge<'_, T>) -> T {
    e.turn::<N>("R").trace()
}

fn sine<T: Number>(e: &Edge<'_, T>) -> T {
    e.turn::<2>("R").0[1][0]
}

fn plane_top<T: Number>(e: &Edge<'_, T>) -> T {
    let (a, b): ([T; 2], [T; 2]) = (e.given.column("a"), e.given.column("b"));
    let height = e.at_nodes(|at| dot(&a, &at.square::<2>("R").apply(&b)));
    -e.given.real("j") * trace::<T, 2>(e) / e.h - e.h * height
}

fn plane_square<T: Number>(e: &Edge<'_, T>) -> T {
    e.given.real("j") * square(sine(e)) / (of::<T>(2.0) * e.h)
}

fn plane_exponential<T: Number>(e: &Edge<'_, T>) -> T {
    e.given.real("j") * (-trace::<T, 2>(e) / of(2.0)).exp() / e.h
}

fn plane_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    -e.given.real("j") * trace::<T, 2>(e) / e.h
        + e.given.real("c") * sine(e).power(4) / e.h.power(3)
}

fn plane_field<T: Number>(e: &Edge<'_, T>) -> T {
    let swollen = of::<T>(1.0) + square(e.tail.real("x"));
    let turning = of::<T>(2.0) - trace::<T, 2>(e);
    swollen * e.given.real("j") * turning / e.h + point(e, "m", "x")
}

fn plane_rational<T: Number>(e: &Edge<'_, T>) -> T {
    let quotient = e.given.real("c") / (of::<T>(3.0) + trace::<T, 2>(e));
    -e.given.real("j") * trace::<T, 2>(e) / e.h + quotient / e.h
}

fn four<T: Number>(e: &Edge<'_, T>) -> T {
    body::<T, 4>(e, "J", "R")
}

fn four_square<T: Number>(e: &Edge<'_, T>) -> T {
    let turn = e.turn::<4>("R");
    four(e) - e.given.real("c") * (turn * turn).trace() / e.h
}

fn four_trace<T: Number>(e: &Edge<'_, T>) -> T {
    let less = of::<T>(4.0) - trace::<T, 4>(e);
    four(e) + e.given.real("c") * square(less) / e.h.power(3)
}

fn four_gap<T: Number>(e: &Edge<'_, T>) -> T {
    let gap = e.turn::<4>("R") - Square::identity();
    let moved = gap.apply(&e.given.column::<4>("a"));
    four(e) + e.given.real("c") * norm(&moved) / e.h
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model PlaneTop { param j: Real; param a, b: Vec<2>; group R: SO<2> velocity W; constraint next(R) = R*W;
            lagrangian = -j*tr(W)/h - h*dot(a, R*b); }",
        action!(plane_top),
        &["j"],
    ),
    Row::of(
        "model PlaneSquare { param j: Real; group R: SO<2> velocity W; constraint next(R) = R*W;
            lagrangian = (j/(2*h))*W[2, 1]^2; }",
        action!(plane_square),
        &["j"],
    ),
    Row::of(
        "model PlaneExponential { param j: Real; group R: SO<2> velocity W; constraint next(R) = R*W;
            lagrangian = (j/h)*exp(-tr(W)/2); }",
        action!(plane_exponential),
        &["j"],
    ),
    Row::of(
        "model PlaneFourth { param j, c: Real; group R: SO<2> velocity W; constraint next(R) = R*W;
            lagrangian = -j*tr(W)/h + (c/h^3)*W[2, 1]^4; }",
        action!(plane_fourth),
        &["j", "c"],
    ),
    Row::of(
        "model PlaneFourthSpace { param j, c: Real; group R: SO<2> velocity W; constraint next(R) = W*R;
            lagrangian = -j*tr(W)/h + (c/h^3)*W[2, 1]^4; }",
        action!(plane_fourth),
        &["j", "c"],
    ),
    Row::of(
        "model PlaneField { param j, m: Real; group R: SO<2> velocity W; field x: Real; constraint next(R) = R*W;
            lagrangian = (1 + x^2)*j*(2 - tr(W))/h + m*(next(x) - x)^2/(2*h); }",
        action!(plane_field),
        &["j", "m"],
    ),
    Row::of(
        "model PlaneRational { param j, c: Real; group R: SO<2> velocity W; constraint next(R) = R*W;
            lagrangian = -j*tr(W)/h + c/(h*(3 + tr(W))); }",
        action!(plane_rational),
        &["j", "c"],
    ),
    Row::of(
        "model FourFree { param J: Sym<4>; group R: SO<4> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h; }",
        action!(four),
        &["J"],
    )
    .misses(2.3e-11),
    Row::of(
        "model FourSpace { param J: Sym<4>; group R: SO<4> velocity W; constraint next(R) = W*R;
            lagrangian = -tr(J*R^T*next(R))/h; }",
        action!(four),
        &["J"],
    )
    .misses(2.6e-11),
    Row::of(
        "model FourSquare { param J: Sym<4>; param c: Real; group R: SO<4> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h - (c/h)*tr(W*W); }",
        action!(four_square),
        &["J", "c"],
    )
    .misses(5.0e-12),
    Row::of(
        "model FourTrace { param J: Sym<4>; param c: Real; group R: SO<4> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h^3)*(4 - tr(W))^2; }",
        action!(four_trace),
        &["J", "c"],
    ),
    Row::of(
        "model FourGap { param J: Sym<4>; param c: Real; param a: Vec<4>; group R: SO<4> velocity W;
            constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h)*dot((W - Id)*a, (W - Id)*a); }",
        action!(four_gap),
        &["J", "c"],
    )
    .misses(1.7e-11),
];
