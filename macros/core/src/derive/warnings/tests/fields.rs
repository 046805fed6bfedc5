//! Warnings about fields: jumps are not constants, a root that contains the step size is not a missing kinetic
//! energy, and first-order terms.

use super::{topics, words};
use crate::derive::warnings::Topic::*;

const PAIR: &str = "param m, k, c: Real; field X, Y: Real; ";
const FREE: &str = "m*(next(X) - X)^2/(2*h) + m*(next(Y) - Y)^2/(2*h)";

#[test]
fn an_absolute_value_is_no_total_difference() {
    let with = |term: &str| topics(&format!("{PAIR} lagrangian = {FREE} + k*c*{term};"));
    for term in [
        "abs(next(X) - X)",
        "sign(next(X) - X)",
        "h*sign(X)",
        "sign(next(X))*(next(Y) - Y)",
        "abs(next(X) + X)",
        "sqrt(1 + abs(next(X) - X))",
    ] {
        let found = with(term);
        assert!(!found.contains(&ConstantTerm), "{term}: {found:?}");
        assert!(found.contains(&NotSmooth), "{term}: {found:?}");
    }
    // If each jump depends on one end only, their difference is a constant term.
    for term in [
        "(abs(next(X)) - abs(X))",
        "(sign(next(X)) - sign(X))",
        "(next(X)*abs(next(X)) - X*abs(X))",
    ] {
        let found = with(term);
        assert!(found.contains(&ConstantTerm), "{term}: {found:?}");
    }
}

#[test]
fn a_root_of_the_step_is_no_missing_kinetic_energy() {
    let relativistic = |l: &str| {
        words(&format!(
            "param m, c: Real; field X: Vec<3>; let d = next(X) - X; lagrangian = {l};"
        ))
    };
    for inside in [
        "-m*c*sqrt(c*c*h*h - dot(d, d))",
        "-m*c*c*sqrt(h*h - dot(d, d)/(c*c))",
    ] {
        let text = relativistic(inside);
        assert!(!text.contains("no kinetic energy"), "{text}");
        assert!(!text.contains("has no limit"), "{text}");
        assert!(!text.contains("first order"), "{text}");
    }
    let text = relativistic("-m*c*sqrt(c*c*h*h - dot(d, d))");
    assert!(
        text.contains("clebsch cannot find the limit of small steps"),
        "{text}"
    );
    // The suggested form has a kinetic energy.
    assert_eq!(relativistic("-m*c*c*h*sqrt(1 - dot(d, d)/(c*h)^2)"), "");
    // If the root does not contain the step size, the warning about the kinetic energy remains.
    let text = relativistic("-m*c*sqrt(1 + dot(d, d))");
    assert!(text.contains("no kinetic energy"), "{text}");
}

#[test]
fn the_rule_for_nodes_is_not_offered_for_what_holds_both_ends() {
    for rule in ["", "node incoming;", "node outgoing;"] {
        let text = words(&format!(
            "{PAIR} {rule} lagrangian = {FREE} + k*X*(next(Y) - Y) - h*c*X^3;"
        ));
        assert!(
            text.contains("because of the term k X_k (Y_{k+1} - Y_k)"),
            "{text}"
        );
        assert!(text.contains("affect only terms at one node"), "{text}");
        assert!(!text.contains("asked for by"), "{text}");
        let mended = topics(&format!(
            "{PAIR} {rule} lagrangian = {FREE} + k*(X + next(X))/2*(next(Y) - Y) - h*c*X^3;"
        ));
        assert_eq!(mended, []);
    }
}

#[test]
fn what_a_clock_multiplies_is_no_total_difference_while_it_goes_on() {
    let clock = "param w: Real; param F: Vec<3>; field x: Vec<3>; advected t: Real; \
                 constraint next(t) = t + h;";
    let with = |term: &str| {
        topics(&format!(
            "{clock} lagrangian = dot(next(x) - x, next(x) - x)/(2*h) + {term};"
        ))
    };
    for term in [
        "sin(w*t)*dot(F, next(x) - x)",
        "(sin(w*t) + sin(w*next(t)))/2*dot(F, next(x) - x)",
        "cos(w*(t + h/2))*dot(F, next(x) - x)",
        "t*(dot(next(x), next(x)) - dot(x, x))",
        "sin(w*next(t))*dot(F, next(x)) - sin(w*t)*dot(2*F, x)",
    ] {
        let found = with(term);
        assert!(!found.contains(&ConstantTerm), "{term}: {found:?}");
    }
    // A parameter, a periodic function of a clock, and a difference that includes the clock.
    for term in [
        "sin(w)*dot(F, next(x) - x)",
        "(next(t) - t)*dot(F, next(x) - x)",
        "sin(w*next(t))*dot(F, next(x)) - sin(w*t)*dot(F, x)",
    ] {
        let found = with(term);
        assert!(found.contains(&ConstantTerm), "{term}: {found:?}");
    }
    assert_eq!(with("cos(w*(t + h/2))*dot(F, next(x) - x)"), []);
}

#[test]
fn a_term_linear_in_the_velocity_with_a_clock_in_the_middle_is_of_second_order() {
    let found = topics(
        "param q, w: Real; field x: Real; advected t: Real; constraint next(t) = t + h; lagrangian = \
         (next(x) - x)^2/(2*h) + q*cos(w*(t + h/2))*(next(x) - x);",
    );
    assert_eq!(found, []);
}

#[test]
fn a_clock_at_one_end_of_an_edge_makes_a_step_of_first_order() {
    let clock = "param m, k, w: Real; field x: Real; advected t: Real; constraint next(t) = t + h; let v = next(x) - x;";
    let with = |lagrangian: &str| topics(&format!("{clock} lagrangian = {lagrangian};"));
    for lagrangian in [
        "(2 + sin(w*t))*m*v^2/(2*h) - h*k*x^2/2",
        "m*v^2/(2*h) - h*k*sin(w*t)*((x + next(x))/2)^2",
    ] {
        assert_eq!(with(lagrangian), [FirstOrder], "{lagrangian}");
    }
    for lagrangian in [
        "(2 + sin(w*(t + h/2)))*m*v^2/(2*h) - h*k*x^2/2",
        "m*v^2/(2*h) - h*k*sin(w*t)*x^2/2",
        "m*v^2/(2*h) - h*k*sin(w*(t + h/2))*((x + next(x))/2)^2",
    ] {
        assert_eq!(with(lagrangian), [], "{lagrangian}");
    }
}
