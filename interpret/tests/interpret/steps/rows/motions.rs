//! Rigid motions of the plane and of space.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::{Square, dot, vee};
use clebsch_oracle::oracle::step::{Edge, Place};

/// The rotation of a homogeneous matrix.
fn rot<T: Number, const N: usize, const M: usize>(at: &Place<'_, T>) -> Mat<T, N> {
    let g = at.square::<M>("G");
    Square::from_entries(|i, j| g.0[i][j])
}

/// Its place.
fn pos<T: Number, const N: usize, const M: usize>(at: &Place<'_, T>) -> [T; N] {
    let g = at.square::<M>("G");
    std::array::from_fn(|i| g.0[i][M - 1])
}

fn turn<T: Number, const N: usize, const M: usize>(e: &Edge<'_, T>) -> Mat<T, N> {
    rot::<T, N, M>(&e.tail).transpose() * rot::<T, N, M>(&e.head)
}

fn moved<T: Number, const N: usize, const M: usize>(e: &Edge<'_, T>) -> [T; N] {
    minus(&pos::<T, N, M>(&e.head), &pos::<T, N, M>(&e.tail))
}

/// In the plane the moment of inertia is one number.
fn rigid<T: Number, const N: usize, const M: usize>(e: &Edge<'_, T>) -> T {
    let turn = turn::<T, N, M>(e);
    let turning = match N {
        2 => e.given.real("j") * turn.trace() / e.h,
        _ => (e.given.square::<N>("J") * turn).trace() / e.h,
    };
    e.given.real("m") * norm(&moved::<T, N, M>(e)) / (of::<T>(2.0) * e.h) - turning
}

fn sledge<T: Number>(e: &Edge<'_, T>) -> T {
    let (a, w): ([T; 2], [T; 2]) = (e.given.column("a"), e.given.column("w"));
    let height = e.at_nodes(|at| {
        let held = rot::<T, 2, 3>(at).apply(&a);
        dot(&w, &plus(&pos::<T, 2, 3>(at), &held))
    });
    rigid::<T, 2, 3>(e) - e.h * height
}

fn fourth<T: Number, const N: usize, const M: usize>(e: &Edge<'_, T>) -> T {
    let y = moved::<T, N, M>(e);
    rigid::<T, N, M>(e) + e.given.real("c") * square(norm(&y)) / e.h.power(3)
}

fn plane_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    fourth::<T, 2, 3>(e)
}

fn space_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    fourth::<T, 3, 4>(e)
}

/// The mean of the translation seen from both ends of the step.
fn mean<T: Number>(e: &Edge<'_, T>) -> [T; 3] {
    let from_start = rot::<T, 3, 4>(&e.tail)
        .transpose()
        .apply(&moved::<T, 3, 4>(e));
    let from_end = turn::<T, 3, 4>(e).transpose().apply(&from_start);
    times(of(0.5), &plus(&from_start, &from_end))
}

fn driven<T: Number>(e: &Edge<'_, T>) -> T {
    let turning = (e.given.square::<3>("J") * turn::<T, 3, 4>(e)).trace() / e.h;
    let (b, z): ([T; 4], [T; 4]) = (e.given.column("b"), e.given.column("Z"));
    let plane = e.at_nodes(|at| dot(&b, &at.square::<4>("G").transpose().apply(&z)));
    form(&e.given.square("M"), &mean(e)) / (of::<T>(2.0) * e.h) - turning - e.h * plane
}

fn axial<T: Number>(e: &Edge<'_, T>) -> T {
    let along = dot(&e.given.column("a"), &vee(&turn::<T, 3, 4>(e)));
    rigid::<T, 3, 4>(e) + e.given.real("c") * square(along) / e.h
}

fn screw<T: Number>(e: &Edge<'_, T>) -> T {
    let seen = rot::<T, 3, 4>(&e.tail)
        .transpose()
        .apply(&moved::<T, 3, 4>(e));
    rigid::<T, 3, 4>(e) + e.given.real("c") * dot(&vee(&turn::<T, 3, 4>(e)), &seen) / e.h
}

fn exponential<T: Number>(e: &Edge<'_, T>) -> T {
    let w = vee(&turn::<T, 3, 4>(e));
    rigid::<T, 3, 4>(e) + e.given.real("c") * norm(&w).exp() / e.h
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model SledgeOnSlope { param j, m: Real; param a, w: Vec<2>; group G: SE<2> velocity V;
            constraint next(G) = G*V; let y = pos(next(G)) - pos(G);
            lagrangian = -j*tr(rot(V))/h + m*dot(y, y)/(2*h) - h*dot(w, pos(G) + rot(G)*a); }",
        action!(sledge),
        &["j", "m"],
    ),
    Row::of(
        "model SledgeFourth { param j, m, c: Real; group G: SE<2> velocity V;
            constraint next(G) = G*V; let y = pos(next(G)) - pos(G);
            lagrangian = -j*tr(rot(V))/h + m*dot(y, y)/(2*h) + (c/h^3)*dot(y, y)^2; }",
        action!(plane_fourth),
        &["j", "m", "c"],
    ),
    Row::of(
        "model SledgeFourthSpace { param j, m, c: Real; group G: SE<2> velocity V;
            constraint next(G) = V*G; let y = pos(next(G)) - pos(G);
            lagrangian = -j*tr(rot(G)^T*rot(next(G)))/h + m*dot(y, y)/(2*h) + (c/h^3)*dot(y, y)^2; }",
        action!(plane_fourth),
        &["j", "m", "c"],
    ),
    Row::of(
        "model DrivenByPlanes { param J, M: Sym<3>; param b, Z: Vec<4>; group G: SE<3> velocity V;
            advected P: Vec<4> = G^T*Z; constraint next(G) = G*V; constraint next(P) = V^T*P;
            let u = (pos(V) - pos(V^-1))/2;
            lagrangian = -tr(J*rot(V))/h + dot(u, M*u)/(2*h) - h*dot(b, P); }",
        action!(driven),
        &["J", "M"],
    )
    // The height of the plane has no effect on the motion.
    .idle(&["Z[3]"])
    .refused(1)
    .misses(2.1e-12),
    Row::of(
        "model RigidFourth { param J: Sym<3>; param m, c: Real; group G: SE<3> velocity V;
            constraint next(G) = G*V; let y = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) + (c/h^3)*dot(y, y)^2; }",
        action!(space_fourth),
        &["J", "m", "c"],
    ),
    Row::of(
        "model RigidFourthSpace { param J: Sym<3>; param m, c: Real; group G: SE<3> velocity V;
            constraint next(G) = V*G; let y = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + m*dot(y, y)/(2*h) + (c/h^3)*dot(y, y)^2; }",
        action!(space_fourth),
        &["J", "m", "c"],
    ),
    Row::of(
        "model RigidAxial { param J: Sym<3>; param m, c: Real; param a: Vec<3>; group G: SE<3> velocity V;
            constraint next(G) = G*V; let y = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) + (c/h)*dot(a, vee(rot(V)))^2; }",
        action!(axial),
        &["J", "m"],
    )
    .misses(3.6e-12),
    Row::of(
        "model RigidScrew { param J: Sym<3>; param m, c: Real; group G: SE<3> velocity V;
            constraint next(G) = G*V; let y = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) + (c/h)*dot(vee(rot(V)), pos(V)); }",
        action!(screw),
        &["J", "m"],
    )
    .misses(2.8e-12),
    Row::of(
        "model RigidExponential { param J: Sym<3>; param m, c: Real; group G: SE<3> velocity V;
            constraint next(G) = G*V; let y = pos(next(G)) - pos(G);
            lagrangian = -tr(J*rot(V))/h + m*dot(y, y)/(2*h) + (c/h)*exp(dot(vee(rot(V)), vee(rot(V)))); }",
        action!(exponential),
        &["J", "m", "c"],
    ),
];
