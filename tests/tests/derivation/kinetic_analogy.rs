//! Kirchhoff's kinetic analogy: the rod at rest and Lagrange's top have one derivation under the
//! dictionary of thesis 3.3 (moment and momentum, force and vertical, arc length and time). Takes the
//! shipped rod and the statement of the gallery's top; everything from the variations on is compared.

use clebsch_core::print::Format;
use clebsch_core::{derive_source, document};

const ROD: &str = include_str!("../../../models/elastic/kirchhoff-static.clebsch");

/// The gallery's heavy top with its letters replaced by those of the rod.
fn top() -> String {
    let top = clebsch_models::find("heavy-top").expect("in the gallery");
    let mut text = top.card.source.replace('Γ', "ν");
    for (letter, rod) in [
        ("param J: Sym<3>;", "param K1, K3: Real;"),
        ("param gU: Vec<3> as \"m g \\chi\";", "param n: Vec<3>;"),
        ("param z: Vec<3>;", "let B = (K3/2)*Id + (K1 - K3)*E3*E3^T;"),
        ("Λ^T*z", "Λ^T*n"),
        ("gU", "E3"),
        ("J", "B"),
    ] {
        assert!(text.contains(letter), "{letter} is not in\n{text}");
        text = text.replace(letter, rod);
    }
    text
}

/// What is derived from a statement, from the variations on.
fn derived(text: &str) -> String {
    let derivation = derive_source(text).unwrap_or_else(|e| panic!("{text}\n{e}"));
    let printed = document::printed(&derivation, Format::Text);
    let (_, rest) = printed
        .split_once("Constrained variations\n")
        .expect("the variations");
    rest.to_owned()
}

#[test]
fn a_rod_at_rest_is_lagranges_top() {
    let rod = derived(ROD);
    assert_eq!(rod, derived(&top()));
    assert!(rod.contains("momentum E3: μ_k·E₃ (exact: Noether"), "{rod}");
}

/// A force of the other sign, or a section that bends more easily one way, is another system.
#[test]
fn another_rod_is_not() {
    let top = derived(&top());
    for (part, other) in [
        ("- h*dot(ν, E3)", "+ h*dot(ν, E3)"),
        ("(K1 - K3)*E3*E3^T", "(K1 - K3)*E2*E2^T"),
        ("(K3/2)*Id", "K3*Id"),
    ] {
        assert!(ROD.contains(part), "{part}");
        assert_ne!(derived(&ROD.replace(part, other)), top, "{other}");
    }
    let bends = "(K1 - K3)*E3*E3^T";
    let flat = derived(&ROD.replace(bends, "(K1 - K3)*E3*E3^T + K1/5*E1*E1^T"));
    assert!(!flat.contains("momentum E3"), "{flat}");
}
