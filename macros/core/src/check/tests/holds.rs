//! Errors about constraints and user-defined functions, and the round trip of their statements through model text.

use crate::pipeline::derive_source;

fn refused(body: &str) -> String {
    let text = format!("model M {{ {body} }}");
    match derive_source(&text) {
        Ok(_) => format!("derives: {text}"),
        Err(errors) => errors.to_string(),
    }
}

const POINT: &str = "param m, L: Real; field x: Vec<3>; \
    lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*x[3];";

fn held(hold: &str) -> String {
    refused(&format!("{POINT} {hold}"))
}

#[test]
fn constraints_are_read_back_and_hold_at_both_levels() {
    let text = format!("model M {{ {POINT} hold λ: dot(x, x) = L^2; }}");
    let d = derive_source(&text).unwrap_or_else(|e| panic!("{e}"));
    let source = crate::document::source(&d);
    assert!(source.contains("hold λ: dot(x, x) = L^2;"), "{source}");
    let again = derive_source(&source).unwrap_or_else(|e| panic!("{source}\n{e}"));
    assert_eq!(crate::document::source(&again), source);
    let names: Vec<&str> = d.invariants.iter().map(|v| v.name.as_str()).collect();
    for wanted in [
        "momentum_angular_E3",
        "constraint_lambda",
        "constraint_rate_lambda",
    ] {
        assert!(names.contains(&wanted), "{names:?}");
    }
    // Momenta that a constraint force changes are not invariants.
    let free = derive_source(&format!("model M {{ {POINT} }}")).unwrap_or_else(|e| panic!("{e}"));
    assert!(
        free.invariants.len() > 1,
        "the momentum across the weight is kept"
    );
    assert!(!names.contains(&"momentum_1"), "{names:?}");
    assert!(d.reversible);
}

#[test]
fn constraints_that_cannot_be_held_are_told_on_their_tokens() {
    for (hold, wanted) in [
        (
            "hold λ: m = L;",
            "the constraint of `λ` contains no configuration",
        ),
        (
            "hold λ: dot(x, next(x)) = L^2;",
            "nonholonomic constraints are not supported yet",
        ),
        ("hold λ: dot(next(x), next(x)) = L^2;", "remove `next`"),
        (
            "hold λ: dot(x, x) = dot(x, x);",
            "both sides of the constraint of `λ` are equal",
        ),
        ("hold m: dot(x, x) = L^2;", "`m` is declared twice"),
        (
            "hold λ: x*x^T = Id;",
            "6 equations constrain only 3 directions",
        ),
        ("hold λ: dot(x, x) = x;", "this is"),
        (
            "hold λ dot(x, x) = L^2;",
            "the name of the multiplier, then the equation",
        ),
        (
            "hold λ: dot(x, x);",
            "the name of the multiplier, then the equation",
        ),
        (
            "hold λ: dot(x, x) = L^2; hold ν: 2*dot(x, x) = m;",
            "the constraint of `ν` follows from the others",
        ),
        ("hold λ: cross(E3, x) = 0;", "constrain only 2 directions"),
    ] {
        let told = held(hold);
        assert!(told.contains(wanted), "{hold}\n{told}");
    }
    let turning = "param J: Sym<3>; group R: SO<3> velocity W; constraint next(R) = R*W; lagrangian = -tr(J*W)/h;";
    let told = refused(&format!("{turning} hold λ: tr(W) = 3;"));
    assert!(told.contains("`W` is a velocity"), "{told}");
    // The error for an equation between rotated vectors of equal length.
    let two = format!(
        "param a, b: Vec<3>; group S: SO<3> velocity V; constraint next(S) = S*V; {turning}"
    );
    let two = two.replace("-tr(J*W)/h", "-tr(J*W)/h - tr(J*V)/h");
    let told = refused(&format!("{two} hold l: R*a = S*b;"));
    assert!(
        told.contains("3 equations constrain only 2 directions"),
        "{told}"
    );
    assert!(told.contains("`dot(R*c, S*b) = 0`"), "{told}");
    let told = refused(&format!("{two} hold l: dot(R*a, S*b) = 0;"));
    assert!(told.starts_with("derives"), "{told}");
}

const SHAPE: &str = "param I0: Sym<3>; field Q: Mat<3>;";

fn given(statement: &str, potential: &str) -> String {
    refused(&format!(
        "{SHAPE} {statement} lagrangian = tr((next(Q) - Q)*I0*(next(Q) - Q)^T)/(2*h) - h*({potential});"
    ))
}

#[test]
fn functions_are_given_by_paths() {
    let statement = "given f(Sym<3>): Real = clebsch::functions::carlson_rf;";
    let told = given(statement, "f(Q*Q^T)");
    assert!(told.starts_with("derives"), "{told}");
    for (statement, potential, wanted) in [
        (statement, "f(Q)", "takes a symmetric matrix here"),
        (
            statement,
            "f(Q*Q^T, Q)",
            "takes 1 arguments, and this call has 2",
        ),
        (statement, "f(det(Q))", "this is"),
        (
            "given f(Sym<3>): Real;",
            "f(Q*Q^T)",
            "give the path of the function",
        ),
    ] {
        let told = given(statement, potential);
        assert!(told.contains(wanted), "{statement} {potential}\n{told}");
    }
}

#[test]
fn fields_of_diagonal_matrices_are_their_diagonals() {
    let text = "model M { param k: Real; field D: Diag<3>; let V = next(D) - D; \
        lagrangian = tr(V*V)/(2*h) - h*k*det(D); }";
    let d = derive_source(text).unwrap_or_else(|e| panic!("{e}"));
    let source = crate::document::source(&d);
    assert!(
        source.contains("field D: Vec<3>;") && source.contains("diag(D)"),
        "{source}"
    );
    derive_source(&source).unwrap_or_else(|e| panic!("{source}\n{e}"));
}

#[test]
fn fields_of_symmetric_and_skew_matrices_are_their_entries() {
    let of = |shape: &str, lagrangian: &str| {
        let text =
            format!("model M {{ param k: Real; field S: {shape}; lagrangian = {lagrangian}; }}");
        derive_source(&text).unwrap_or_else(|e| panic!("{text}\n{e}"))
    };
    let same = |[shape, stated]: [&str; 2], [kept, by_hand]: [&str; 2]| {
        let (a, b) = (of(shape, stated), of(kept, by_hand));
        let algebra = crate::algebra::Algebra::new(&a.letters.symbols);
        assert!(
            algebra.equal(&a.spec.lagrangian, &b.spec.lagrangian),
            "{shape}"
        );
        // The stored text uses the independent entries, each once.
        let source = crate::document::source(&a);
        assert!(source.contains(&format!("field S: {kept};")), "{source}");
    };
    same(
        [
            "Sym<2>",
            "tr((next(S) - S)^2)/(2*h) - h*k*det(S) - h*S[2, 1]^4",
        ],
        [
            "Vec<3>",
            "((next(S)[1] - S[1])^2 + 2*(next(S)[2] - S[2])^2 + (next(S)[3] - S[3])^2)/(2*h) \
             - h*k*(S[1]*S[3] - S[2]^2) - h*S[2]^4",
        ],
    );
    same(
        ["Skew<3>", "-tr((next(S) - S)^2)/(4*h) - h*k*S[3, 2]"],
        ["Vec<3>", "dot(next(S) - S, next(S) - S)/(2*h) - h*k*S[1]"],
    );
    same(
        ["Skew<2>", "-tr((next(S) - S)^2)/(4*h) - h*k*S[2, 1]^2"],
        ["Real", "(next(S) - S)^2/(2*h) - h*k*S^2"],
    );
    // The stored text derives the same model.
    let d = of("Sym<3>", "tr((next(S) - S)^2)/(2*h) - h*k*tr(S)^2");
    let source = crate::document::source(&d);
    derive_source(&source).unwrap_or_else(|e| panic!("{source}\n{e}"));
}

#[test]
fn matrices_are_held_by_their_independent_entries() {
    let body = "field Q: Mat<3>; param A: Mat<3>; \
        lagrangian = tr((next(Q) - Q)*(next(Q) - Q)^T)/(2*h) - h*tr(A*Q);";
    for (hold, components) in [
        ("Q^T*Q = Id", 6),
        ("sym(A^T*Q) = 0", 6),
        ("skew(A^T*Q) = 0", 3),
        ("Q*E1*E2^T*A = A*Q", 9),
    ] {
        let text = format!("model M {{ {body} hold l: {hold}; }}");
        let d = derive_source(&text).unwrap_or_else(|e| panic!("{hold}: {e}"));
        let shape = d.spec.holds[0].value.shape();
        let wanted = crate::expr::shape::Dim::Fixed(components);
        assert_eq!(shape, crate::expr::shape::Shape::vector(wanted), "{hold}");
        let source = crate::document::source(&d);
        let again = derive_source(&source).unwrap_or_else(|e| panic!("{source}: {e}"));
        assert_eq!(crate::document::source(&again), source);
    }
    let turning = "param J: Sym<3>; param A: SO<3>; group Λ: SO<3> velocity W; \
        constraint next(Λ) = Λ*W; lagrangian = -tr(J*W)/h;";
    let told = refused(&format!("{turning} hold l: Λ = A;"));
    for wanted in ["9 equations constrain only 3 directions", "vee(A^T*B) = 0"] {
        assert!(told.contains(wanted), "{told}");
    }
}

#[test]
fn a_sum_needs_sites() {
    let told = held("hold λ: sum(x) = E1;");
    assert!(told.contains("runs over the sites of a label"), "{told}");
    // Without parentheses it looks like a factor.
    let told = held("hold λ: sum x = E1;");
    for wanted in [
        "`sum` needs its summand in parentheses",
        "`hold p: sum(m*x) = X;`",
        "leave out `sum`",
    ] {
        assert!(told.contains(wanted), "{told}");
    }
}

#[test]
fn constraints_know_no_time() {
    let clock = "advected τ: Real; constraint next(τ) = τ + h;";
    let message = held(&format!("{clock} hold λ: dot(x, x) = (L + m*τ)^2;"));
    for part in [
        "`τ` advances with the step by itself",
        "drive the configuration by a stiff spring",
    ] {
        assert!(message.contains(part), "{message}");
    }
}
