//! Kirchhoff's kinetic analogy: the static rod and Lagrange's top have the same derivation under the dictionary of thesis 3.3
//! (moment and momentum, force and vertical, arc length and time). Compares the gallery's rod with the gallery's top, from the
//! variations on.

use clebsch_core::print::Format;
use clebsch_core::{derive_source, document};

const ROD: &str = include_str!("../../../models/elastic/kirchhoff-static.clebsch");

/// The gallery's heavy top with the symbols of the rod.
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

/// The derivation of a statement, from the variations on.
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

/// A force of the opposite sign, or a section with unequal bending stiffness, is a different system.
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
