//! If an end prescribes configurations, the quantities that follow them do not move; quantities that advance by
//! themselves do.

use super::unfold;
use crate::lattice::{ChainConfig, Lattice};
use crate::pipeline::parse_source;

/// The prescribed names on a chain of three nodes whose first end prescribes its configurations, without these
/// configurations.
fn given(statements: &str) -> Vec<String> {
    let source = format!(
        "model Held {{
            label i in 0..N; param c, x_max: Real; param e: Vec<3>;
            group Λ: SO<3> at nodes velocity Ω; field x: Real at nodes; constraint next(Λ) = Λ*Ω;
            {statements}
            lagrangian = tr(Ω)/h + (next(x) - x)^2/(2*h) - h*(next(x, i) - x)^2;
            end i = 0 {{ held {{ Λ = given; x = given; }} }}
        }}"
    );
    let model = parse_source(&source).unwrap();
    let lattice = Lattice::read(&model).unwrap();
    let choice = ChainConfig::representative(&lattice, 1);
    let choice = choice.with_count(&lattice, "i", 2).unwrap();
    let found = unfold(&model, &lattice, &choice).unwrap().given;
    let besides = found.into_iter().filter(|n| n != "Λ_0" && n != "x_0");
    besides.collect()
}

#[test]
fn what_follows_what_is_given_stands_still_and_clocks_go_on() {
    let none: &[&str] = &[];
    for (statements, wanted) in [
        // Advected by a rotation, and by a field.
        (
            "advected v: Vec<3> at nodes; constraint next(v) = Ω^T*v;",
            ["v_0"].as_slice(),
        ),
        (
            "advected S: Sym<3> at nodes; constraint next(S) = Ω^T*S*Ω;",
            &["S_0"],
        ),
        (
            "advected y: Real at nodes; constraint next(y) = y + c*(next(x) - x);",
            &["y_0"],
        ),
        (
            "advected y: Real at nodes; constraint next(y) = y + (next(x) - x)*x_max;",
            &["y_0"],
        ),
        (
            "let d = next(x) - x; advected y: Real at nodes; constraint next(y) = y + d;",
            &["y_0"],
        ),
        // One of the nodes of a segment moves.
        (
            "advected r: Real at segments; constraint next(r) = r + (next(next(x, i)) - next(x)) - (next(x, i) - x);",
            none,
        ),
        // A quantity that follows another motionless one, declared in either order.
        (
            "advected n, v: Vec<3> at nodes; constraint next(n) = n + (v - Ω^T*v); constraint next(v) = Ω^T*v;",
            &["v_0", "n_0"],
        ),
        // Scalar and vector clocks, and quantities that they drive.
        (
            "advected t: Real at nodes; constraint next(t) = t + h;",
            none,
        ),
        (
            "advected t: Real at segments; constraint next(t) = t + h;",
            none,
        ),
        (
            "advected t: Vec<3> at nodes; constraint next(t) = t + h*e;",
            none,
        ),
        ("advected t: Real; constraint next(t) = t + h;", none),
        ("advected g: Real at nodes; constraint next(g) = c*g;", none),
        (
            "advected t, a: Real at nodes; constraint next(t) = t + h; constraint next(a) = a + h*t;",
            none,
        ),
        // Prescribed values enter the update, but the quantity still moves.
        (
            "advected y: Real at nodes; constraint next(y) = y + h*x;",
            none,
        ),
        (
            "advected y: Real at nodes; constraint next(y) = y + (next(x) - x) + h;",
            none,
        ),
        (
            "advected v: Vec<3> at nodes; constraint next(v) = Ω^T*v + h*e;",
            none,
        ),
        (
            "advected v: Vec<3> at nodes; constraint next(v) = Λ^T*v;",
            none,
        ),
    ] {
        assert_eq!(given(statements), wanted, "{statements}");
    }
}
