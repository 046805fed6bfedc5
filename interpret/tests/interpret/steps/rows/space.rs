//! Rotations in the space frame.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{dot, vee};
use clebsch_oracle::oracle::step::Edge;

fn axial<T: Number>(e: &Edge<'_, T>, attitude: &str) -> [T; 3] {
    vee(&e.turn_in_space::<3>(attitude))
}

fn free<T: Number>(e: &Edge<'_, T>) -> T {
    body::<T, 3>(e, "J", "R")
}

fn carried_moments<T: Number>(e: &Edge<'_, T>) -> T {
    let start = e.start.square::<3>("R");
    let moments = start.transpose() * e.given.square("J") * start;
    -(moments * e.turn("R")).trace() / e.h
}

fn fourth<T: Number>(e: &Edge<'_, T>) -> T {
    free(e) + e.given.real("c") * square(norm(&axial(e, "R"))) / e.h.power(3)
}

fn energy<T: Number>(e: &Edge<'_, T>) -> T {
    form(&e.given.square::<3>("I"), &axial(e, "R")) / (of::<T>(2.0) * e.h)
}

fn carried<T: Number>(e: &Edge<'_, T>) -> T {
    let b: [T; 3] = e.given.column("b");
    let z: [T; 3] = e.given.column("z");
    let along = dot(&e.tail.square::<3>("R").apply(&b), &axial(e, "R"));
    let weight = e.at_nodes(|at| dot(&at.square::<3>("R").apply(&b), &z));
    free(e) + e.given.real("c") * square(along) / e.h - e.h * weight
}

fn exponential<T: Number>(e: &Edge<'_, T>) -> T {
    free(e) + e.given.real("c") * norm(&axial(e, "R")).exp() / e.h
}

fn field_inertia<T: Number>(e: &Edge<'_, T>) -> T {
    let swollen = of::<T>(1.0) + square(e.tail.real("x"));
    free(e) + e.given.real("c") * swollen * norm(&axial(e, "R")) / e.h + point(e, "m", "x")
}

fn two<T: Number>(e: &Edge<'_, T>) -> T {
    let both = dot(&axial(e, "R"), &axial(e, "S"));
    free(e) + body::<T, 3>(e, "K", "S") + e.given.real("c") * both / e.h
}

fn sides<T: Number>(e: &Edge<'_, T>) -> T {
    let seen = e.tail.square::<3>("R").apply(&vee(&e.turn("R")));
    free(e) + body::<T, 3>(e, "K", "S") + e.given.real("c") * dot(&seen, &axial(e, "S")) / e.h
}

fn trace<T: Number>(e: &Edge<'_, T>) -> T {
    let less = of::<T>(3.0) - e.turn_in_space::<3>("R").trace();
    free(e) + e.given.real("c") * square(less) / e.h.power(3)
}

fn product<T: Number>(e: &Edge<'_, T>) -> T {
    let along = |name| dot(&e.given.column::<3>(name), &axial(e, "R"));
    free(e) + e.given.real("c") * along("a") * along("b") / e.h
}

fn rational<T: Number>(e: &Edge<'_, T>) -> T {
    let trace = e.turn_in_space::<3>("R").trace();
    form(&e.given.square::<3>("I"), &axial(e, "R")) / (e.h * (of::<T>(1.0) + trace))
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model SpaceMoments { group R: SO<3> velocity W; advected J: Sym<3>; constraint next(R) = W*R;
            constraint next(J) = W*J*W^T; lagrangian = -tr(W*J)/h; }",
        action!(carried_moments),
        &["J"],
    )
    .misses(6.8e-10),
    Row::of(
        "model SpaceFourth { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = W*R;
            lagrangian = -tr(J*R^T*next(R))/h + (c/h^3)*dot(vee(W), vee(W))^2; }",
        action!(fourth),
        &["J", "c"],
    ),
    Row::of(
        "model SpaceEnergy { param I: Sym<3>; group R: SO<3> velocity W; constraint next(R) = W*R;
            lagrangian = dot(vee(W), I*vee(W))/(2*h); }",
        action!(energy),
        &["I"],
    ),
    Row::of(
        "model SpaceCarried { param J: Sym<3>; param c: Real; param b, z: Vec<3>; group R: SO<3> velocity W;
            advected a: Vec<3> = R*b; constraint next(R) = W*R; constraint next(a) = W*a;
            lagrangian = -tr(J*R^T*next(R))/h + (c/h)*dot(a, vee(W))^2 - h*dot(a, z); }",
        action!(carried),
        &["J", "c"],
    )
    .misses(3.4e-12),
    Row::of(
        "model SpaceExponential { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = W*R;
            lagrangian = -tr(J*R^T*next(R))/h + (c/h)*exp(dot(vee(W), vee(W))); }",
        action!(exponential),
        &["J", "c"],
    )
    .misses(3.0e-12),
    Row::of(
        "model SpaceFieldInertia { param J: Sym<3>; param c, m: Real; group R: SO<3> velocity W; field x: Real;
            constraint next(R) = W*R;
            lagrangian = -tr(J*R^T*next(R))/h + (c/h)*(1 + x^2)*dot(vee(W), vee(W)) + m*(next(x) - x)^2/(2*h); }",
        action!(field_inertia),
        &["J", "c", "m"],
    ),
    Row::of(
        "model SpaceTwo { param J, K: Sym<3>; param c: Real; group R: SO<3> velocity W; group S: SO<3> velocity U;
            constraint next(R) = W*R; constraint next(S) = U*S;
            lagrangian = -tr(J*R^T*next(R))/h - tr(K*S^T*next(S))/h + (c/h)*dot(vee(W), vee(U)); }",
        action!(two),
        &["J", "K"],
    )
    .misses(5.6e-12),
    Row::of(
        "model BothSides { param J, K: Sym<3>; param c: Real; group R: SO<3> velocity W; group S: SO<3> velocity U;
            constraint next(R) = R*W; constraint next(S) = U*S;
            lagrangian = -tr(J*W)/h - tr(K*S^T*next(S))/h + (c/h)*dot(R*vee(W), vee(U)); }",
        action!(sides),
        &["J", "K"],
    )
    .misses(2.9e-12),
    Row::of(
        "model SpaceTrace { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; constraint next(R) = W*R;
            lagrangian = -tr(J*R^T*next(R))/h + (c/h^3)*(3 - tr(W))^2; }",
        action!(trace),
        &["J", "c"],
    ),
    Row::of(
        "model SpaceProduct { param J: Sym<3>; param c: Real; param a, b: Vec<3>; group R: SO<3> velocity W;
            constraint next(R) = W*R;
            lagrangian = -tr(J*R^T*next(R))/h + (c/h)*dot(a, vee(W))*dot(b, vee(W)); }",
        action!(product),
        &["J"],
    )
    .misses(1.7e-11),
    Row::of(
        "model SpaceRational { param I: Sym<3>; group R: SO<3> velocity W; constraint next(R) = W*R;
            lagrangian = dot(vee(W), I*vee(W))/(h*(1 + tr(W))); }",
        action!(rational),
        &["I"],
    ),
];
