//! Words and signs of Python and other languages: the underlined part and the message.

use crate::diagnostic::Diagnostic;
use crate::pipeline::derive_source;

/// A model with a scalar and a planar vector, one more statement and one more potential.
fn source(statements: &str, term: &str) -> String {
    format!(
        "model M {{ param m, k, c: Real; field q: Real; field x: Vec<2>; {statements} lagrangian = m*(next(q) - q)^2/(2*h) \
         + m*dot(next(x) - x, next(x) - x)/(2*h) - h*({term}); }}"
    )
}

/// The first mistake of a model, and the underlined part of its text.
fn first(source: &str) -> (String, Diagnostic) {
    let Err(errors) = derive_source(source) else {
        panic!("derives: {source}");
    };
    let first = errors.first();
    let (start, end) = (
        first.place.first.start().column,
        first.place.last.end().column,
    );
    let marked = source.chars().skip(start).take(end - start).collect();
    (marked, first)
}

/// Checks the underlined part and the message of each model.
fn check_messages(all: &[(&str, &str, &str, &str)]) {
    for (statements, term, marked, wanted) in all {
        let (found, d) = first(&source(statements, term));
        assert_eq!(found, *marked, "{statements} {term}\n{}", d.text());
        assert!(
            d.text().contains(wanted),
            "{statements} {term}\n{}",
            d.text()
        );
        // At most two sentences of advice, and not the list of all functions.
        assert!(d.help.len() <= 2, "{}", d.text());
        assert!(!d.text().contains("functions: tr"), "{}", d.text());
    }
}

#[test]
fn forces_are_said_not_to_be_supported_and_damping_to_be_stated_by_a_clock() {
    for statement in ["force", "friction", "dissipation", "damping", "torque"] {
        let (marked, d) = first(&source(&format!("{statement} = -c*q;"), "k*q^2"));
        assert_eq!(marked, statement);
        let wanted = format!("`{statement}` is not a statement: forces without a potential");
        assert!(d.message.starts_with(&wanted), "{}", d.message);
        let help = d.help.join(" ");
        assert!(help.contains("`exp(γ*(t + next(t))/2)`"), "{help}");
        assert!(!help.contains("`let "), "{help}");
    }
    // The suggested model derives and is of second order.
    let advised = "model Damped { param m, k, γ: Real; field x: Real; advected t: Real; constraint next(t) = t + h; \
         lagrangian = exp(γ*(t + next(t))/2)*m*(next(x) - x)^2/(2*h) - exp(γ*t)*h*k*x^2/2; }";
    let derived = derive_source(advised).unwrap_or_else(|e| panic!("{e}"));
    assert!(derived.reversible && derived.warnings.is_empty());
}

#[test]
fn functions_of_other_languages_are_told_with_what_does_them() {
    check_messages(&[
        ("", "min(q, c)", "min", "`(a + b - abs(a - b))/2`"),
        ("", "max(q, 0)", "max", "`(a + b + abs(a - b))/2`"),
        (
            "",
            "k*acos(q)^2",
            "acos",
            "no inverse of sine, cosine or tangent",
        ),
        (
            "",
            "k*arcsin(q)",
            "arcsin",
            "no inverse of sine, cosine or tangent",
        ),
        (
            "",
            "k*atan2(x[2], x[1])",
            "atan2",
            "Declare the angle as a configuration",
        ),
        ("", "k*acosh(q)", "acosh", "`log(x + sqrt(x^2 - 1))`"),
        ("", "k*abs(x)", "x", "`sqrt(dot(x, x))`"),
        ("", "k*norm(x)", "norm", "`sqrt(dot(x, x))`"),
        ("", "k*length(x)", "length", "`sqrt(dot(x, x))`"),
        ("", "k*heaviside(q)", "heaviside", "`(1 + sign(x))/2`"),
        ("", "k*floor(q)", "floor", "no rounding or remainder"),
        ("", "k*dot(x, vec(0, 1))", "vec", "`a*E1 + b*E2`"),
        ("", "k*diff(q)^2", "diff", "`(next(x) - x)/h`"),
        ("", "k*sin^2(q)", "sin^2", "write `sin(...)^2`"),
        ("", "k*sin^-1(q)", "sin^-1", "no inverse of sine"),
        (
            "",
            "k*np.sin(q)",
            ".",
            "functions need no module: write `sin(...)`",
        ),
        ("", "k*math.acos(q)", ".", "no inverse of sine"),
        ("", "k*x.dot(x)", ".", "write `dot(x, ...)`"),
        ("", "k*x.T*x", ".", "write the transpose as `x^T`"),
        ("", "k*x.norm()", ".", "`sqrt(dot(x, x))`"),
        ("", "k*q.dot^2", ".", "`(next(q) - q)/h`"),
        ("", "k*x.y", ".", "write a component of a vector as `x[2]`"),
    ]);
}

#[test]
fn signs_of_other_languages_are_told() {
    check_messages(&[
        (
            "",
            "k*(x[1] > 0)*x[1]",
            ">",
            "piecewise potentials are not supported yet",
        ),
        ("", "k*q*(q >= 0)", ">", "the comparison `>=`"),
        ("", "k*q*(q == 0)", "=", "the comparison `==`"),
        (
            "",
            "k*where(q < 0, q, 0)",
            "<",
            "`(x + abs(x))/2` is x where x > 0",
        ),
        ("", "if q > 0 { q } else { 0 }", ">", "`abs` and `sign`"),
        ("", "k*q > 0", ">", "piecewise potentials"),
        ("", "k*(x @ x)", "@", "`dot(a, b)`"),
        ("", "k*dot(x, [0, 1])", "[", "`a*E1 + b*E2`"),
        ("", "k*dot(x, (0, 1))", ",", "`a*E1 + b*E2`"),
        (
            "",
            "sum(m[i]*m[j])",
            "i",
            "sums over pairs of sites are not supported yet",
        ),
        (
            "",
            "k*sum(q for i in range(3))",
            "in",
            "the language has no loops",
        ),
        ("", "k*q**2", "*", "write a power as `a^2`"),
        ("let u == q;", "u", "=", "one `=`"),
        (
            "assume 0 < m < 1;",
            "q",
            "<",
            "`assume 0 < m; assume m < 1;`",
        ),
        (
            "hold l: dot(x, x) <= 1;",
            "q",
            "<",
            "inequalities, such as contact",
        ),
        (
            "param a: Real, b: Real;",
            "a*b*q",
            ",",
            "names of one shape",
        ),
        ("% remark\n", "q", "%", "write a comment after `//`"),
    ]);
}

#[test]
fn words_of_other_languages_are_told_at_the_start_of_a_statement() {
    check_messages(&[
        ("g2 = 9.81;", "q", "g2", "`param g2: Real;`"),
        ("h = 0.01;", "q", "h", "give the step size in the case file"),
        ("const g2 = 9.81;", "q", "const", "`param m: Real;`"),
        ("var y: Real;", "q", "var", "`field q: Real;`"),
        ("def V(q): return q;", "q", "def", "`given V(Real): Real"),
        ("let V = lambda q: q;", "V", ":", "`given V(Real): Real"),
        ("let V(q) = q^2;", "q", "(", "`let V = k*q^2/2;`"),
        ("import numpy as np;", "q", "import", "need no import"),
        ("for i in 0..3 { }", "q", "for", "the language has no loops"),
        (
            "if q > 0 { }",
            "q",
            "if",
            "the language has no conditionals",
        ),
        ("initial q = 1;", "q", "initial", "`clebsch case FILE`"),
        ("T = m*q^2;", "q", "T", "`let K = ...;`"),
        ("param g2;", "q", ";", "`param m: Real;`"),
        (
            "constraint dot(x, x) = 1;",
            "q",
            "dot",
            "`hold λ: dot(x, x) = L^2;`",
        ),
    ]);
}

#[test]
fn names_and_shapes_are_told_with_what_is_meant() {
    check_messages(&[
        (
            "",
            "q*cos(c*t)",
            "t",
            "cannot depend on the time `t` unless you declare a clock",
        ),
        (
            "",
            "q*cos(c*time)",
            "time",
            "`advected clock: Real; constraint next(clock) = clock + h;`, and write `clock`",
        ),
        ("", "k*v^2", "v", "`let v = (next(q) - q)/h;`"),
        ("param a: R3;", "dot(a, a)*q", "R3", "write `Vec<3>`"),
        ("", "k*x'*q", "'", "`(next(x) - x)/h`"),
        ("", "k*(q1 - q0)^2", "q1", "`next(q)`"),
        (
            "",
            "k*(q(k+1) - q)^2",
            "q",
            "`next(q)` for its value at the next node",
        ),
        ("", "W*q", "W", "`let W = ...;`"),
        ("", "q^(2*k)", "*", "`exp(p*log(x))`"),
        ("param a b: Real;", "q", "b", "`param a, b: Real;`"),
        (
            "param I: Diag<3>; group R: SO<3> velocity ω; constraint next(R) = R*ω;",
            "dot(ω, I*ω)",
            "ω",
            "`-tr(J*ω)/h`",
        ),
        ("", "k*ẋ^2", "ẋ", "`(next(x) - x)/h`"),
        ("let L = T - m;", "q", "T", "for example `K`"),
        ("param T: Real;", "q", "T", "the transpose, as in `A^T`"),
        ("", "k*(next(x) - x)^2", "(next(x) - x)", "`dot(a, a)`"),
        (
            "",
            "k*x^2",
            "x",
            "only numbers and square matrices have powers",
        ),
        (
            "",
            "k*q*prev(q)",
            "prev(q)",
            "`q` for `prev(q)` and `next(q)` for `q`",
        ),
        ("", "k*dot(q, q)", "q", "`a^2`"),
        ("", "cross(x, x)", "x", "`dot(perp(a), b)`"),
    ]);
    // The suggested clock derives.
    let clock = "advected t: Real; constraint next(t) = t + h;";
    assert!(derive_source(&source(clock, "q*cos(c*t)")).is_ok());
    // The usual names of moments of inertia are allowed.
    let moments = derive_source(&source("param I1, I2, I3: Real;", "(I1 + I2 + I3)*q"));
    assert!(moments.is_ok(), "{moments:?}");
}

#[test]
fn constraints_on_velocities_are_said_not_to_be_supported() {
    check_messages(&[
        (
            "hold v: x[2]*(next(q) - q) = next(x)[1] - x[1];",
            "q",
            "x[2]*(next(q) - q) = next(x)[1] - x[1]",
            "nonholonomic constraints are not supported yet",
        ),
        (
            "hold v: dot(next(x), next(x)) = 1;",
            "q",
            "dot(next(x), next(x)) = 1",
            "remove `next`",
        ),
    ]);
}
