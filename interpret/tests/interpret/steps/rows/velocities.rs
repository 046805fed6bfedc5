//! Rotations in the body frame: powers, products and functions of the velocity.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{Square, cross, dot, vee};
use clebsch_oracle::oracle::step::Edge;

/// The axial vector of `R^T*next(R)`.
fn axial<T: Number>(e: &Edge<'_, T>) -> [T; 3] {
    vee(&e.turn::<3>("R"))
}

fn free<T: Number>(e: &Edge<'_, T>) -> T {
    body::<T, 3>(e, "J", "R")
}

fn axial_energy<T: Number>(e: &Edge<'_, T>) -> T {
    form(&e.given.square::<3>("I"), &axial(e)) / (of::<T>(2.0) * e.h)
}

fn axial_square<T: Number>(e: &Edge<'_, T>) -> T {
    e.given.real("c") * norm(&axial(e)) / e.h
}

fn axial_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    free(e) + e.given.real("c") * square(norm(&axial(e))) / e.h.power(3)
}

fn axial_sixth<T: Number>(e: &Edge<'_, T>) -> T {
    free(e) + e.given.real("c") * norm(&axial(e)).power(3) / e.h.power(5)
}

fn axial_trace<T: Number>(e: &Edge<'_, T>) -> T {
    free(e) - e.given.real("c") * norm(&axial(e)) * e.turn::<3>("R").trace() / e.h
}

fn axial_product<T: Number>(e: &Edge<'_, T>) -> T {
    let along = |name| dot(&e.given.column::<3>(name), &axial(e));
    free(e) + e.given.real("c") * along("a") * along("b") / e.h
}

fn axial_cross<T: Number>(e: &Edge<'_, T>) -> T {
    let across = |name| cross(&axial(e), &e.given.column::<3>(name));
    free(e) + e.given.real("c") * dot(&across("a"), &across("b")) / e.h
}

fn axial_hat<T: Number>(e: &Edge<'_, T>) -> T {
    let a: [T; 3] = e.given.column("a");
    let turned = e.turn::<3>("R").apply(&a);
    free(e) + e.given.real("c") * dot(&axial(e), &cross(&a, &turned)) / e.h
}

fn trace_of_square<T: Number>(e: &Edge<'_, T>) -> T {
    let turn = e.turn::<3>("R");
    free(e) - e.given.real("c") * (turn * turn).trace() / e.h
}

fn square_of_trace<T: Number>(e: &Edge<'_, T>) -> T {
    let less = of::<T>(3.0) - e.turn::<3>("R").trace();
    free(e) + e.given.real("c") * square(less) / e.h.power(3)
}

fn half_angle<T: Number>(e: &Edge<'_, T>) -> T {
    let trace = e.turn::<3>("R").trace();
    -of::<T>(4.0) * e.given.real("c") * (of::<T>(1.0) + trace).sqrt() / e.h
}

fn logarithm<T: Number>(e: &Edge<'_, T>) -> T {
    let trace = e.turn::<3>("R").trace();
    free(e) - e.given.real("c") * (of::<T>(1.0) + trace).ln() / e.h
}

fn exponential<T: Number>(e: &Edge<'_, T>) -> T {
    free(e) + e.given.real("c") * norm(&axial(e)).exp() / e.h
}

fn rational<T: Number>(e: &Edge<'_, T>) -> T {
    let trace = e.turn::<3>("R").trace();
    form(&e.given.square::<3>("I"), &axial(e)) / (e.h * (of::<T>(1.0) + trace))
}

fn rational_beside<T: Number>(e: &Edge<'_, T>) -> T {
    free(e) - e.given.real("c") / (e.h * (of::<T>(2.0) + norm(&axial(e))))
}

fn root<T: Number>(e: &Edge<'_, T>) -> T {
    let inside = of::<T>(1.0) + form(&e.given.square::<3>("I"), &axial(e)) / square(e.h);
    e.h * inside.sqrt()
}

fn gap<T: Number>(e: &Edge<'_, T>) -> Square<T, 3> {
    e.turn::<3>("R") - Square::identity()
}

fn gap_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let d = gap(e);
    let stretch = (d * e.given.square("J") * d.transpose()).trace();
    stretch / (of::<T>(2.0) * e.h) + e.given.real("c") * square(stretch) / e.h.power(3)
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model FreeBody { param J: Sym<3>; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h; }",
        action!(free),
        &["J"],
    ),
    Row::of(
        "model AxialEnergy { param I: Sym<3>; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = dot(vee(W), I*vee(W))/(2*h); }",
        action!(axial_energy),
        &["I"],
    ),
    Row::of(
        "model AxialSquare { param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = c*dot(vee(W), vee(W))/h; }",
        action!(axial_square),
        &["c"],
    ),
    Row::of(
        "model AxialFourth { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h^3)*dot(vee(W), vee(W))^2; }",
        action!(axial_fourth),
        &["J", "c"],
    ),
    Row::of(
        "model AxialSixth { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h^5)*dot(vee(W), vee(W))^3; }",
        action!(axial_sixth),
        &["J", "c"],
    ),
    Row::of(
        "model AxialTrace { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h - (c/h)*dot(vee(W), vee(W))*tr(W); }",
        action!(axial_trace),
        &["J"],
    )
    .misses(7.8e-12),
    Row::of(
        "model AxialProduct { param J: Sym<3>; param c: Real; param a, b: Vec<3>;
            group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h)*dot(a, vee(W))*dot(b, vee(W)); }",
        action!(axial_product),
        &["J"],
    )
    .misses(6.3e-12),
    Row::of(
        "model AxialCross { param J: Sym<3>; param c: Real; param a, b: Vec<3>;
            group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h)*dot(cross(vee(W), a), cross(vee(W), b)); }",
        action!(axial_cross),
        &["J"],
    )
    .misses(1.4e-11),
    Row::of(
        "model AxialHat { param J: Sym<3>; param c: Real; param a: Vec<3>;
            group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h)*dot(vee(W), hat(a)*W*a); }",
        action!(axial_hat),
        &["J"],
    )
    .misses(2.9e-11),
    Row::of(
        "model TraceOfSquare { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h - (c/h)*tr(W*W); }",
        action!(trace_of_square),
        &["J", "c"],
    )
    .misses(4.5e-12),
    Row::of(
        "model SquareOfTrace { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h^3)*(3 - tr(W))^2; }",
        action!(square_of_trace),
        &["J", "c"],
    ),
    Row::of(
        "model HalfAngle { param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -(4*c/h)*sqrt(1 + tr(W)); }",
        action!(half_angle),
        &["c"],
    ),
    Row::of(
        "model LogarithmicEnergy { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h - (c/h)*log(1 + tr(W)); }",
        action!(logarithm),
        &["J", "c"],
    )
    .misses(3.1e-12),
    Row::of(
        "model ExponentialEnergy { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h)*exp(dot(vee(W), vee(W))); }",
        action!(exponential),
        &["J", "c"],
    )
    .misses(9.9e-12),
    Row::of(
        "model RationalEnergy { param I: Sym<3>; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = dot(vee(W), I*vee(W))/(h*(1 + tr(W))); }",
        action!(rational),
        &["I"],
    ),
    Row::of(
        "model RationalBeside { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h - c/(h*(2 + dot(vee(W), vee(W)))); }",
        action!(rational_beside),
        &["J", "c"],
    )
    .misses(4.2e-12),
    Row::of(
        "model RootEnergy { param I: Sym<3>; group R: SO<3> velocity W; constraint next(R) = R*W;
            lagrangian = h*sqrt(1 + dot(vee(W), I*vee(W))/h^2); }",
        action!(root),
        &["I"],
    )
    // Momenta have a length of at most the root of the inertia.
    .refused(5),
    Row::of(
        "model GapFourth { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = R*W;
            let s = tr((W - Id)*J*(W - Id)^T);
            lagrangian = s/(2*h) + (c/h^3)*s^2; }",
        action!(gap_fourth),
        &["J"],
    ),
];
