//! Unused definitions, Lagrangians per unit time, and Lagrangians of first order.

use super::{BODY, model, topics, words};
use crate::derive::warnings::Topic::*;
use crate::pipeline::derive_source;

#[test]
fn a_definition_that_nothing_uses_is_said() {
    let spring =
        "param m, k: Real; field x: Real; lagrangian = m*(next(x) - x)^2/(2*h) - h*k*x^2/2;";
    assert_eq!(topics(&format!("let f = k*x; {spring}")), [UnusedLet]);
    let text = words(&format!("let f = k*x; {spring}"));
    assert!(
        text.contains("`f` is defined by `let` but never used"),
        "{text}"
    );
    // A force that has a name only.
    let force = words(&format!("let force = -k*x; {spring}"));
    assert!(
        force.contains("forces without a potential are not supported yet"),
        "{force}"
    );
    // Used by another unused definition, and by a used one.
    assert_eq!(
        topics(&format!("let f = k*x; let g = f*x; {spring}")),
        [UnusedLet, UnusedLet]
    );
    let used = "param m, k: Real; field x: Real; let f = k*x; let V = f*x/2; \
                lagrangian = m*(next(x) - x)^2/(2*h) - h*V;";
    assert_eq!(topics(used), []);
    // Used in a constraint, in the definition of an advected quantity, and in an assumption.
    let elsewhere = "param m, k, c: Real; field x: Vec<2>; advected t: Real; let r = dot(x, x); let n = h; let p = k^2; \
                     assume p > c; constraint next(t) = t + n; hold l: r = k^2; \
                     lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*c*t*x[1];";
    match derive_source(&model(elsewhere)) {
        Ok(d) => assert!(d.warnings.iter().all(|w| w.topic != UnusedLet)),
        Err(e) => assert!(!e.to_string().contains("never used"), "{e}"),
    }
}

#[test]
fn a_lagrangian_of_first_order_is_no_forgotten_factor() {
    let vortices = |kinetic: &str| {
        format!(
            "param a, b: Real; field x, y: Vec<2>; let d = x - y; \
             lagrangian = {kinetic} - h*a*b*log(dot(d, d))/(4*pi);"
        )
    };
    let linear = "(a*dot(perp(x), next(x) - x) + b*dot(perp(y), next(y) - y))/2";
    assert_eq!(topics(&vortices(linear)), []);
    // Use mean values instead.
    let mean =
        "(a*dot(perp((x + next(x))/2), next(x) - x) + b*dot(perp((y + next(y))/2), next(y) - y))/2";
    assert_eq!(topics(&vortices(mean)), []);
    // Canonical variables.
    let canonical = "param k: Real; field q, p: Real; \
                     lagrangian = (p + next(p))/2*(next(q) - q) - h*(p^2 + k*q^2)/2;";
    assert_eq!(topics(canonical), []);
    // A velocity without a linear term of its own, a total difference, and a kinetic term without its divisor.
    for (kinetic, why) in [
        (
            "a*dot(perp(x), next(x) - x) + b*dot(y, next(y) - y)",
            "of one only",
        ),
        (
            "a*dot(next(x) - x, next(x) - x) + b*dot(next(y) - y, next(y) - y)",
            "squares",
        ),
        (
            "a*dot(next(x) - x, next(x) - x)/2 + b*(dot(perp(x), next(x) - x) + dot(perp(y), next(y) - y))",
            "both",
        ),
    ] {
        let found = topics(&vortices(kinetic));
        assert!(found.contains(&DegenerateKineticEnergy), "{why}: {found:?}");
    }
}

#[test]
fn a_lagrangian_per_unit_time_is_told_to_be_multiplied_by_the_step() {
    let pendulum = "param m, l, g: Real; field q: Real; let v = (next(q) - q)/h; ";
    let rate = format!("{pendulum} lagrangian = m*l^2*v^2/2 + m*g*l*cos(q);");
    assert_eq!(topics(&rate), [NoLimit]);
    assert!(
        words(&rate).contains("`lagrangian = h*(...);`"),
        "{}",
        words(&rate)
    );
    let step = format!("{pendulum} lagrangian = h*(m*l^2*v^2/2 + m*g*l*cos(q));");
    assert_eq!(topics(&step), []);
    // Only one of the two.
    let kinetic = format!("{pendulum} lagrangian = m*l^2*v^2/2 + h*m*g*l*cos(q);");
    assert!(
        !words(&kinetic).contains("per unit time"),
        "{}",
        words(&kinetic)
    );
    let potential = format!("{pendulum} lagrangian = h*m*l^2*v^2/2 + m*g*l*cos(q);");
    assert!(
        !words(&potential).contains("per unit time"),
        "{}",
        words(&potential)
    );
    let body = format!("{BODY} lagrangian = -tr(J*Ω)/h^2;");
    assert!(words(&body).contains("per unit time"), "{}", words(&body));
}
