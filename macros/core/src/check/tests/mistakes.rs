//! What is written in the way of papers or of other languages, and what is said of it.

use crate::pipeline::derive_source;

fn said(statements: &str, term: &str) -> String {
    let text = format!(
        "model M {{ time k step dt; param m: Real; field q: Real; field x: Vec<3>; {statements} \
         lagrangian = m*(next(q) - q)^2/(2*dt) + m*dot(next(x) - x, next(x) - x)/(2*dt) - dt*({term}); }}"
    );
    match derive_source(&text) {
        Ok(_) => format!("derives: {text}"),
        Err(errors) => errors.to_string(),
    }
}

#[test]
fn notation_of_papers_is_told_with_what_to_write() {
    for (statements, term, wanted) in [
        ("", "x·x", "`dot(a, b)`"),
        ("", "m·(q)", "write `a*b` for a product"),
        ("param A: Mat<3>;", "dot(x, Aᵀ*x)", "`A^T` for a transpose"),
        ("", "q[k+1]", "the next node in time is `next(q)`"),
        ("", "q_{k+1}", "at the next node in time `next(q)`"),
        ("", "q_next", "the value at the next node is `next(q)`"),
        ("", "x_3", "a component is written `x[3]`"),
        ("", "q/h", "the time step is `dt` here"),
        ("", "q % 2", "there is no remainder of a division"),
        ("param l = 1;", "q", "values stand in the case"),
        (
            "param l: R^3;",
            "q",
            "a vector of three components is `Vec<3>`",
        ),
        ("param l: Scalar;", "q", "write `Real`"),
        ("", "M_PI*q", "the language writes `pi`"),
        ("", "dot(e_z, x)", "the language writes `E3`"),
        ("", "q^m", "`exp(a*log(x))`"),
        (
            "given f(Real): Real = x^2;",
            "f(q)",
            "the expression stands in quotes",
        ),
        ("let u: Real = q;", "u", "write `=` before an expression"),
        ("hamiltonian = q;", "q", "the discrete Lagrangian of a step"),
    ] {
        let found = said(statements, term);
        assert!(found.contains(wanted), "{statements} {term}\n{found}");
    }
}

#[test]
fn unit_vectors_have_the_size_of_what_is_beside_them() {
    // The first configuration is a number, which has none.
    let found = said(
        "group U: SU<2> velocity V; constraint next(U) = U*V;",
        "dot(rot(U)*E1 - rot(U)*E2, rot(U)*E1 - x) + 2*dot(im(V), im(V))/dt^2",
    );
    assert!(found.contains("derives"), "{found}");
}
