//! Linear maps.

use crate::steps::row::Row;
use crate::steps::words::*;
use clebsch_oracle::action;
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::oracle::step::Edge;

fn gap<T: Number, const N: usize>(e: &Edge<'_, T>) -> Mat<T, N> {
    e.map::<N>("Q") - Square::identity()
}

/// `tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h)`.
fn stretch<T: Number, const N: usize>(e: &Edge<'_, T>) -> T {
    let d = e.changed::<N>("Q");
    (d * e.given.square("I0") * d.transpose()).trace() / (of::<T>(2.0) * e.h)
}

fn plane<T: Number>(e: &Edge<'_, T>) -> T {
    let k = e.given.real("k");
    stretch::<T, 2>(e) - e.h * e.at_nodes(|at| k * square(at.square::<2>("Q").determinant()))
}

fn plane_body<T: Number>(e: &Edge<'_, T>) -> T {
    let g = gap::<T, 2>(e);
    (e.given.square::<2>("C") * g * e.given.square("I0") * g.transpose()).trace()
        / (of::<T>(2.0) * e.h)
}

fn plane_space<T: Number>(e: &Edge<'_, T>) -> T {
    let g = e.head.square::<2>("Q") * e.tail.square::<2>("Q").inverse() - Square::identity();
    (e.given.square::<2>("C") * g * e.given.square("I0") * g.transpose()).trace()
        / (of::<T>(2.0) * e.h)
}

fn plane_logarithm<T: Number>(e: &Edge<'_, T>) -> T {
    stretch::<T, 2>(e) + e.given.real("c") * square(e.map::<2>("Q").determinant().ln()) / e.h
}

fn space_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let k = e.given.real("k");
    let potential = e.at_nodes(|at| {
        let q = at.square::<3>("Q");
        k * square((q.transpose() * q).trace())
    });
    stretch::<T, 3>(e) - e.h * potential / of(4.0)
}

fn gap_fourth<T: Number>(e: &Edge<'_, T>) -> T {
    let g = gap::<T, 2>(e);
    let size = (g.transpose() * g).trace();
    e.given.real("m") * size / (of::<T>(2.0) * e.h)
        + e.given.real("c") * square(size) / e.h.power(3)
}

fn swollen<T: Number>(e: &Edge<'_, T>) -> T {
    let d = e.changed::<2>("Q");
    let x = of::<T>(1.0) + square(e.tail.real("x"));
    x * (d * e.given.square("I0") * d.transpose()).trace() / (of::<T>(2.0) * e.h)
        + point(e, "m", "x")
}

pub const ROWS: &[Row] = &[
    Row::of(
        "model MapPlane { param I0: Sym<2>; param k: Real; group Q: GL<2> velocity G; constraint next(Q) = Q*G;
            lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) - h*k*det(Q)^2; }",
        action!(plane),
        &["I0"],
    )
    .refused(1),
    Row::of(
        "model MapBody { param C, I0: Sym<2>; group Q: GL<2> velocity G; constraint next(Q) = Q*G;
            lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h); }",
        action!(plane_body),
        &["I0"],
    )
    .positive(&["C"])
    .refused(1),
    Row::of(
        "model MapSpace { param C, I0: Sym<2>; group Q: GL<2> velocity G; constraint next(Q) = G*Q;
            lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h); }",
        action!(plane_space),
        &["I0"],
    )
    .positive(&["C"]),
    Row::of(
        "model MapLogarithm { param I0: Sym<2>; param c: Real; group Q: GL<2> velocity G; constraint next(Q) = Q*G;
            lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) + (c/h)*log(det(G))^2; }",
        action!(plane_logarithm),
        &["I0", "c"],
    )
    .misses(1.6e-12),
    Row::of(
        "model MapSpaceFourth { param I0: Sym<3>; param k: Real; group Q: GL<3> velocity G; constraint next(Q) = Q*G;
            lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) - (h/4)*k*tr(Q^T*Q)^2; }",
        action!(space_fourth),
        &["I0"],
    )
    .refused(1),
    Row::of(
        "model MapGapFourth { param m, c: Real; group Q: GL<2> velocity G; constraint next(Q) = Q*G;
            let s = tr((G - Id)^T*(G - Id)); lagrangian = m*s/(2*h) + (c/h^3)*s^2; }",
        action!(gap_fourth),
        &["m", "c"],
    ),
    Row::of(
        "model MapSwollen { param I0: Sym<2>; param m: Real; group Q: GL<2> velocity G; field x: Real;
            constraint next(Q) = Q*G;
            lagrangian = (1 + x^2)*tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) + m*(next(x) - x)^2/(2*h); }",
        action!(swollen),
        &["I0", "m"],
    ),
];
