//! Distinguishes balances that are linear in several velocities together from those that are not.

use crate::derive_source;

fn reason(body: &str) -> String {
    let text = format!(
        "model Joint {{ param m, n, k: Real; param A, C: Sym<2>; param B, D: Sym<3>; {body} }}"
    );
    let derived = derive_source(&text);
    let d = derived.unwrap_or_else(|e| panic!("{text}: {e:?}"));
    d.solve.reason
}

#[test]
fn one_linear_system_is_named_so() {
    let pair = "field X, Y: Vec<3>; let d = next(X) - X; let e = next(Y) - Y; \
         lagrangian = m*dot(d, d)/(2*h) + n*dot(e, e)/(2*h) + k*dot(d, e)/h";
    let two_terms = "field X: Mat<2, 3>; let d = next(X) - X; \
         lagrangian = tr(d^T*A*d*B)/(2*h) + tr(d^T*C*d*D)/(2*h)";
    for body in [pair, two_terms] {
        let linear = reason(&format!("{body} - h*k*m;"));
        assert!(linear.contains("one linear system"), "{linear}");
    }
    let quartic = reason(&format!("{pair} + dot(d, d)^2/h^3;"));
    assert!(!quartic.contains("linear system"), "{quartic}");
    // With one pair of factors, the balance separates into two small systems and needs no Newton iteration.
    let one_term = reason(
        "field X: Mat<2, 3>; let d = next(X) - X; lagrangian = tr(d^T*A*d*B)/(2*h) - h*tr(X^T*X);",
    );
    assert!(one_term.contains("two small linear systems"), "{one_term}");
}
