//! Scales of the momenta of rigid motions: the lever arm occurs in the angular part only.

use super::derive;
use crate::derive::Derivation;
use crate::derive::invariants::Invariant;
use crate::expr::{self, Shift};
use crate::print::{Format, Style, expression};

/// A rigid body with this potential.
fn body(potential: &str) -> Derivation {
    derive(&format!(
        "model Body {{
            param J: Sym<3>; param m: Real; param n: Vec<3>;
            group G: SE<3> velocity V; constraint next(G) = G*V;
            lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h){potential};
        }}"
    ))
}

fn of<'a>(d: &'a Derivation, name: &str) -> &'a Invariant {
    let found = d.invariants.iter().find(|v| v.name == name);
    let all = || d.invariants.iter().map(|v| &v.name).collect::<Vec<_>>();
    found.unwrap_or_else(|| panic!("{name} in {:?}", all()))
}

/// Whether the scale contains the configuration.
fn has_place(d: &Derivation, scale: &expr::Expr) -> bool {
    let element = d.spec.configurations[0].element;
    let here = |l: &expr::Letter| l.symbol == element && l.shift == Shift::HERE;
    expr::letters(scale).iter().any(here)
}

#[test]
fn the_whole_momentum_has_a_scale_for_each_of_its_parts() {
    let d = body("");
    let whole = of(&d, "spatial_momentum");
    let scale = whole.scale.as_ref().expect("a scale");
    let value = whole.value.as_ref().expect("a value");
    assert_eq!(scale.shape(), value.shape());
    let text = expression(scale, &d.letters.symbols, &Style::new("k"), Format::Text);
    // The momentum as a pair of angular and linear parts.
    let linear = "|lin(μ_k)|";
    let angular = format!("(|ang(μ_k)| + |pos(G_k)| {linear})");
    let ones = "(E₁ + E₂ + E₃)";
    assert_eq!(text, format!("({angular} {ones}, {linear} {ones})"));
}

#[test]
fn parts_of_it_have_their_own() {
    // Free fall along the axis n conserves the angular momentum about n and the linear momentum across n.
    let d = body(" - h*dot(n, pos(G))");
    for (name, lever) in [
        ("spatial_momentum_angular_n", true),
        ("spatial_momentum_linear_across_n", false),
    ] {
        let scale = of(&d, name).scale.as_ref().expect("a scale");
        assert!(scale.shape().is_scalar(), "{name}");
        assert_eq!(has_place(&d, scale), lever, "{name}");
    }
}
