//! Rotations in the body frame, with advected quantities, fields and other bodies.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{dot, vee};
use clebsch_oracle::oracle::step::{Edge, Place};

fn free<T: Number>(e: &Edge<'_, T>) -> T {
    body::<T, 3>(e, "J", "R")
}

fn axial<T: Number>(e: &Edge<'_, T>, attitude: &str) -> [T; 3] {
    vee(&e.turn::<3>(attitude))
}

/// A vector of space, seen from the body.
fn seen<T: Number>(at: &Place<'_, T>, of_space: &[T; 3]) -> [T; 3] {
    at.square::<3>("R").transpose().apply(of_space)
}

fn top_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let (a, z): ([T; 3], [T; 3]) = (e.given.column("a"), e.given.column("z"));
    let c = e.given.real("c");
    free(e)
        - e.h
            * e.at_nodes(|at| {
                let height = dot(&a, &seen(at, &z));
                height + c * height.power(4)
            })
}

fn carried<T: Number>(e: &Edge<'_, T>) -> T {
    let z = e.start.square::<3>("R").apply(&e.given.column("G"));
    let k = e.given.square::<3>("K");
    free(e) - e.h * e.at_nodes(|at| form(&k, &seen(at, &z)))
}

fn carried_velocity<T: Number>(e: &Edge<'_, T>) -> T {
    let z = e.start.square::<3>("R").apply(&e.given.column("G"));
    let along = dot(&seen(&e.tail, &z), &axial(e, "R"));
    free(e) + e.given.real("c") * square(along) / e.h
}

fn carried_inertia<T: Number>(e: &Edge<'_, T>) -> T {
    let g = seen(&e.tail, &e.given.column("z"));
    let w = axial(e, "R");
    (form(&e.given.square("I"), &w) + e.given.real("c") * square(dot(&g, &w)))
        / (of::<T>(2.0) * e.h)
}

fn field_inertia<T: Number>(e: &Edge<'_, T>) -> T {
    let swollen = of::<T>(1.0) + e.at_nodes(|at| square(at.real("x")));
    let j = e.given.square::<3>("J");
    let potential = e.at_nodes(|at| square(at.real("x"))) * e.given.real("k") * e.h / of(2.0);
    swollen * (j.trace() - (j * e.turn("R")).trace()) / e.h + point(e, "m", "x") - potential
}

fn field_inertia_axial<T: Number>(e: &Edge<'_, T>) -> T {
    let swollen = of::<T>(1.0) + square(e.tail.real("x"));
    let turning = form(&e.given.square::<3>("I"), &axial(e, "R"));
    swollen * turning / (of::<T>(2.0) * e.h) + point(e, "m", "x")
}

fn bead_inertia<T: Number>(e: &Edge<'_, T>) -> T {
    let w = axial(e, "R");
    let along = dot(&e.tail.column::<3>("x"), &w);
    let turning = form(&e.given.square::<3>("I"), &w) + e.given.real("c") * square(along);
    turning / (of::<T>(2.0) * e.h) + mass::<T, 3>(e, "m", "x")
}

fn body_inertia<T: Number>(e: &Edge<'_, T>) -> T {
    let apart = e.tail.square::<3>("R").transpose() * e.tail.square("S");
    let swollen = of::<T>(4.0) + apart.trace();
    free(e) + body::<T, 3>(e, "K", "S") + e.given.real("c") * swollen * norm(&axial(e, "R")) / e.h
}

fn jointed<T: Number>(e: &Edge<'_, T>) -> T {
    let moved = |attitude: &str, arm: &str| {
        let arm: [T; 3] = e.given.column(arm);
        minus(
            &e.head.square::<3>(attitude).apply(&arm),
            &e.tail.square::<3>(attitude).apply(&arm),
        )
    };
    free(e) + body::<T, 3>(e, "K", "S")
        - e.given.real("c") * dot(&moved("R", "a"), &moved("S", "b")) / e.h
}

fn axial_coupled<T: Number>(e: &Edge<'_, T>) -> T {
    let in_space = |attitude| e.tail.square::<3>(attitude).apply(&axial(e, attitude));
    free(e)
        + body::<T, 3>(e, "K", "S")
        + e.given.real("c") * dot(&in_space("R"), &in_space("S")) / e.h
}

fn axial_of_two<T: Number>(e: &Edge<'_, T>) -> T {
    let along = |name, attitude| dot(&e.given.column::<3>(name), &axial(e, attitude));
    free(e)
        + body::<T, 3>(e, "K", "S")
        + e.given.real("c") * along("a", "R") * along("b", "S") / e.h
}

fn midpoint<T: Number>(e: &Edge<'_, T>) -> T {
    let both = e.tail.square::<3>("R") + e.head.square("R");
    let height = dot(&both.apply(&e.given.column("a")), &e.given.column("z"));
    free(e) - e.h * square(height) / of(4.0)
}

fn attitude_inertia<T: Number>(e: &Edge<'_, T>) -> T {
    let a = e.tail.square::<3>("R").apply(&e.given.column("a"));
    let swollen = of::<T>(4.0) + dot(&e.given.column("z"), &a);
    free(e) + e.given.real("c") * swollen * norm(&axial(e, "R")) / e.h
}

fn dragged<T: Number>(e: &Edge<'_, T>) -> T {
    let w = e.tail.square::<3>("R").apply(&axial(e, "R"));
    free(e) + mass::<T, 3>(e, "m", "x") + e.given.real("c") * dot(&w, &e.changes("x")) / e.h
}

fn spun<T: Number>(e: &Edge<'_, T>) -> T {
    free(e)
        + point(e, "m", "x")
        + e.given.real("c") * square(e.tail.real("x")) * dot(&e.given.column("a"), &axial(e, "R"))
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model TopFourth { param J: Sym<3>; param a, z: Vec<3>; param c: Real; group R: SO<3> velocity W;
            advected G: Vec<3> = R^T*z; constraint next(R) = R*W; constraint next(G) = W^T*G;
            lagrangian = -tr(J*W)/h - h*(dot(a, G) + c*dot(a, G)^4); }",
        action!(top_fourth),
        &["J"],
    )
    .refused(1),
    Row::of(
        "model CarriedForm { param J, K: Sym<3>; group R: SO<3> velocity W; advected G: Vec<3>;
            constraint next(R) = R*W; constraint next(G) = W^T*G;
            lagrangian = -tr(J*W)/h - h*dot(G, K*G); }",
        action!(carried),
        &["J"],
    ),
    Row::of(
        "model CarriedVelocity { param J: Sym<3>; param c: Real; group R: SO<3> velocity W; advected G: Vec<3>;
            constraint next(R) = R*W; constraint next(G) = W^T*G;
            lagrangian = -tr(J*W)/h + (c/h)*dot(G, vee(W))^2; }",
        action!(carried_velocity),
        &["J"],
    )
    .misses(3.9e-12),
    Row::of(
        "model CarriedInertia { param I: Sym<3>; param c: Real; param z: Vec<3>; group R: SO<3> velocity W;
            advected G: Vec<3> = R^T*z; constraint next(R) = R*W; constraint next(G) = W^T*G;
            lagrangian = (dot(vee(W), I*vee(W)) + c*dot(G, vee(W))^2)/(2*h); }",
        action!(carried_inertia),
        &["I", "c"],
    ),
    Row::of(
        "model FieldInertia { param J: Sym<3>; param m, k: Real; group R: SO<3> velocity W; field x: Real;
            constraint next(R) = R*W;
            lagrangian = (1 + (x^2 + next(x)^2)/2)*(tr(J) - tr(J*W))/h + m*(next(x) - x)^2/(2*h) - h*k*x^2/2; }",
        action!(field_inertia),
        &["J", "m"],
    ),
    Row::of(
        "model FieldInertiaAxial { param I: Sym<3>; param m: Real; group R: SO<3> velocity W; field x: Real;
            constraint next(R) = R*W;
            lagrangian = (1 + x^2)*dot(vee(W), I*vee(W))/(2*h) + m*(next(x) - x)^2/(2*h); }",
        action!(field_inertia_axial),
        &["I", "m"],
    ),
    Row::of(
        "model BeadInertia { param I: Sym<3>; param m, c: Real; group R: SO<3> velocity W; field x: Vec<3>;
            constraint next(R) = R*W; let d = next(x) - x;
            lagrangian = (dot(vee(W), I*vee(W)) + c*dot(x, vee(W))^2)/(2*h) + m*dot(d, d)/(2*h); }",
        action!(bead_inertia),
        &["I", "m", "c"],
    ),
    Row::of(
        "model BodyInertia { param J, K: Sym<3>; param c: Real; group R: SO<3> velocity W; group S: SO<3> velocity U;
            constraint next(R) = R*W; constraint next(S) = S*U;
            lagrangian = -tr(J*W)/h - tr(K*U)/h + (c/h)*(4 + tr(R^T*S))*dot(vee(W), vee(W)); }",
        action!(body_inertia),
        &["J", "K", "c"],
    ),
    Row::of(
        "model Jointed { param J, K: Sym<3>; param c: Real; param a, b: Vec<3>;
            group R: SO<3> velocity W; group S: SO<3> velocity U; advected D: SO<3> = R^T*S;
            constraint next(R) = R*W; constraint next(S) = S*U; constraint next(D) = W^T*D*U;
            lagrangian = -(tr(J*W) + tr(K*U) + c*dot((W - Id)*a, D*(U - Id)*b))/h; }",
        action!(jointed),
        &["J", "K"],
    )
    .misses(2.4e-11),
    Row::of(
        "model AxialCoupled { param J, K: Sym<3>; param c: Real;
            group R: SO<3> velocity W; group S: SO<3> velocity U;
            constraint next(R) = R*W; constraint next(S) = S*U;
            lagrangian = -tr(J*W)/h - tr(K*U)/h + (c/h)*dot(R*vee(W), S*vee(U)); }",
        action!(axial_coupled),
        &["J", "K"],
    )
    .misses(1.4e-11),
    Row::of(
        "model AxialOfTwo { param J, K: Sym<3>; param c: Real; param a, b: Vec<3>;
            group R: SO<3> velocity W; group S: SO<3> velocity U;
            constraint next(R) = R*W; constraint next(S) = S*U;
            lagrangian = -tr(J*W)/h - tr(K*U)/h + (c/h)*dot(a, vee(W))*dot(b, vee(U)); }",
        action!(axial_of_two),
        &["J", "K"],
    )
    .misses(5.3e-12),
    Row::of(
        "model MidpointPotential { param J: Sym<3>; param a, z: Vec<3>; group R: SO<3> velocity W;
            constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h - h*dot((R + next(R))*a, z)^2/4; }",
        action!(midpoint),
        &["J"],
    )
    .misses(5.5e-12),
    Row::of(
        "model AttitudeInertia { param J: Sym<3>; param c: Real; param a, z: Vec<3>; group R: SO<3> velocity W;
            constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + (c/h)*(4 + dot(z, R*a))*dot(vee(W), vee(W)); }",
        action!(attitude_inertia),
        &["J", "c"],
    ),
    Row::of(
        "model Dragged { param J: Sym<3>; param m, c: Real; group R: SO<3> velocity W; field x: Vec<3>;
            constraint next(R) = R*W; let d = next(x) - x;
            lagrangian = -tr(J*W)/h + m*dot(d, d)/(2*h) + (c/h)*dot(R*vee(W), d); }",
        action!(dragged),
        &["J", "m"],
    )
    .misses(1.0e-11),
    Row::of(
        "model Spun { param J: Sym<3>; param m, c: Real; param a: Vec<3>; group R: SO<3> velocity W; field x: Real;
            constraint next(R) = R*W;
            lagrangian = -tr(J*W)/h + m*(next(x) - x)^2/(2*h) + c*x^2*dot(a, vee(W)); }",
        action!(spun),
        &["J", "m"],
    ),
];
