//! Lagrangians that are not quadratic in the velocity have no quadratic limit. Takes statements; gives reasons.

use super::{DRIVEN, NOT_QUADRATIC};
use crate::derive_source;
use crate::print::{Format, Style, expression};

/// The reason why the model of this statement has no limit; None if it has one.
fn reason(statement: &str) -> Option<String> {
    let source = format!("model M {{ param a, b: Real; {statement} }}");
    let derived = derive_source(&source).unwrap_or_else(|e| panic!("{statement}: {e}"));
    derived.limit.err()
}

const POINT: &str = "param w: Vec<3>; field X: Vec<3>; let d = next(X) - X;";
const LINEAR: &str = "group Q: GL<2> velocity G; constraint next(Q) = Q*G; let F = G - Id;";
const BODY: &str = "param J: Sym<3>; group R: SO<3> velocity V; constraint next(R) = R*V;";

#[test]
fn powers_beyond_the_second_that_stay_are_not_dropped() {
    for statement in [
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + (b/h^3)*dot(d, d)^2;"),
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + (b/h^2)*dot(w, d)^3;"),
        format!("{POINT} lagrangian = (a/2 + b*dot(d, d)/h^2)*dot(d, d)/h - h*dot(X, X);"),
        format!("{LINEAR} lagrangian = a*tr(F*F^T)/(2*h) + (b/h^3)*tr(F*F^T)^2;"),
        format!("{BODY} lagrangian = -tr(J*V)/h + (b/h^3)*tr(Id - V)^2;"),
    ] {
        assert_eq!(
            reason(&statement).as_deref(),
            Some(NOT_QUADRATIC),
            "{statement}"
        );
    }
}

/// The series of a function of velocity over step size has all powers. The relativistic particle is an example.
#[test]
fn functions_of_the_velocity_over_the_step_are_not_cut_off_at_its_square() {
    for statement in [
        format!("{POINT} lagrangian = -h*a*b^2*sqrt(1 - dot(d, d)/(b^2*h^2)) - h*dot(w, X);"),
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + h*b*cosh(dot(w, d)/h);"),
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + h*b*sin(dot(d, d)^2/h^4);"),
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + h/(b + dot(d, d)^3/h^6);"),
        format!("{BODY} lagrangian = -tr(J*V)/h + b*h*sin(tr(Id - V)/h^2);"),
    ] {
        assert_eq!(
            reason(&statement).as_deref(),
            Some(NOT_QUADRATIC),
            "{statement}"
        );
    }
    for statement in [
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + h*b*cosh(dot(w, d));"),
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + b*exp(h*dot(w, d));"),
        format!("{BODY} lagrangian = -tr(J*V)/h + b*sin(tr(Id - V)/h);"),
    ] {
        assert_eq!(reason(&statement), None, "{statement}");
    }
}

#[test]
fn powers_that_vanish_with_the_step_are() {
    for statement in [
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + (b/h)*dot(d, d)^2;"),
        format!("{POINT} lagrangian = a*dot(d, d)/(2*h) + (b/h^2)*dot(d, d)^2;"),
        format!("{BODY} lagrangian = -tr(J*V)/h + (b/h)*tr(Id - V)^2;"),
        format!("{BODY} lagrangian = -tr(J*V)/h + (b/h^2)*tr(Id - V)^2;"),
    ] {
        assert_eq!(reason(&statement), None, "{statement}");
    }
}

/// Polynomials of differences. Multiplied out, they would lose the digits that two positions have in common.
#[test]
fn potentials_of_differences_are_told_by_differences() {
    let potential = |term: &str| {
        let source = format!(
            "model M {{ param a, b, l: Real; field x, y: Vec<3>; field u, v: Real;
             lagrangian = (dot(next(x) - x, next(x) - x) + dot(next(y) - y, next(y) - y) + (next(u) - u)^2 + (next(v) - v)^2)/(2*h)
                - {term}; }}"
        );
        let d = derive_source(&source).unwrap_or_else(|e| panic!("{term}: {e}"));
        let limit = d.limit.unwrap_or_else(|e| panic!("{term}: {e}"));
        let style = Style::new(&d.spec.time_index);
        expression(&limit.potential, &d.letters.symbols, &style, Format::Text)
    };
    let half = "½ a (u_k - v_k - l)² + ¼ b (u_k - v_k)⁴";
    for (term, expected) in [
        (
            "h*a*(dot(x - y, x - y) - l^2)^2",
            "a ((x_k - y_k)·(x_k - y_k) - l²)²",
        ),
        ("h*(a*(u - v - l)^2/2 + b*(u - v)^4/4)", half),
        ("h*a*(next(u) - next(v) - l)^4", "a (u_k - v_k - l)⁴"),
        // A single position shares no digits with another.
        ("h*a*(u + l)^2", "2 a l u_k + a l² + a u_k²"),
    ] {
        assert_eq!(potential(term), expected);
    }
}

/// If the Lagrangian depends on time, clebsch lists no energy and gives no warning, wherever the clock occurs.
#[test]
fn what_a_clock_drives_has_no_energy() {
    let clock = "advected τ: Real; constraint next(τ) = τ + h;";
    let behind = "advected y: Real; constraint next(y) = y + h*τ;";
    let counted = "advected n: Real; constraint next(n) = n + 1;";
    let point = format!("{POINT} {clock}");
    for statement in [
        format!("{point} lagrangian = a*dot(d, d)/(2*h) - h*b*τ*dot(w, X);"),
        format!("{point} lagrangian = a*dot(d, d)/(2*h) - h*b*sin(a*τ)*dot(w, X);"),
        format!("{point} {behind} lagrangian = a*dot(d, d)/(2*h) - h*b*y*dot(w, X);"),
        format!("{BODY} {clock} lagrangian = -tr(J*V)/h - h*a*b*τ*dot(R*E1, E2);"),
        // A counter of steps as the clock.
        format!("{POINT} {counted} lagrangian = a*dot(d, d)/(2*h) - h*b*sin(n)*dot(w, X);"),
    ] {
        let source = format!("model M {{ param a, b: Real; {statement} }}");
        let d = derive_source(&source).unwrap_or_else(|e| panic!("{statement}: {e}"));
        assert_eq!(d.limit.as_ref().err().map(String::as_str), Some(DRIVEN));
        assert!(
            d.invariants.iter().all(|i| i.name != "energy"),
            "{statement}"
        );
        assert_eq!(d.discrete_energy(), ("not conserved", DRIVEN));
        assert!(d.warnings.is_empty(), "{statement}");
        // The clock does not change the symmetry of the scheme. But a sum over time and a counter of steps are not
        // restored by a step back.
        let returns = ![behind, counted].iter().any(|x| statement.contains(x));
        assert_eq!(d.reversible, returns, "{statement}");
    }
    // A clock on which the Lagrangian does not depend.
    let idle = format!("{point} lagrangian = a*dot(d, d)/(2*h) - h*b*dot(w, X);");
    assert_eq!(reason(&idle), None);
}
