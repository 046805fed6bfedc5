//! Point masses at a fixed distance: second moments of rank one, so that there is no inertia about the line to the
//! origin. The derivation reports this, and promises neither a step nor a bounded energy.

use super::Topic::DegenerateKineticEnergy;
use crate::derive::Derivation;
use crate::document::printed;
use crate::pipeline::derive_source;
use crate::print::Format;

fn derived(body: &str) -> Derivation {
    match derive_source(&format!("model M {{ {body} }}")) {
        Ok(d) => d,
        Err(e) => panic!("{body}\n{e}"),
    }
}

/// The text of a derivation, on one line.
fn text(d: &Derivation) -> String {
    let all = printed(d, Format::Text);
    all.split_whitespace().collect::<Vec<_>>().join(" ")
}

const REFUSED: &str = "every choice of the parameters is rejected at the start";

/// Stated by second moments, by positions in the body and in space, with spatial velocities, in four dimensions with
/// two masses, forced and free.
const STATED: [&str; 6] = [
    "param m, g: Real; param a: Vec<3>; group Λ: SO<3> velocity Ω; advected Γ: Vec<3>; \
     constraint next(Λ) = Λ*Ω; constraint next(Γ) = Ω^T*Γ; \
     lagrangian = -m*tr(a*a^T*Ω)/h - h*m*g*dot(a, Γ);",
    "param m: Real; param a: Vec<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω; \
     lagrangian = m*dot(Ω*a - a, Ω*a - a)/(2*h);",
    "param m, g: Real; param a, z: Vec<3>; group Λ: SO<3> velocity Ω; \
     constraint next(Λ) = Λ*Ω; let x = Λ*a; \
     lagrangian = m*dot(next(x) - x, next(x) - x)/(2*h) - h*m*g*dot(x, z);",
    "param m: Real; param z: Vec<3>; group Λ: SO<3> velocity ω; advected χ: Vec<3>; \
     constraint next(Λ) = ω*Λ; constraint next(χ) = ω*χ; \
     lagrangian = -m*tr(ω*χ*χ^T)/h - h*m*dot(χ, z);",
    "param a, b: Vec<4>; group Λ: SO<4> velocity Ω; constraint next(Λ) = Λ*Ω; \
     lagrangian = -tr((a*a^T + b*b^T)*Ω)/h;",
    "param m: Real; param a, b: Vec<3>; group Λ: SO<3> velocity Ω; \
     constraint next(Λ) = Λ*Ω; assume b == 2*a; \
     lagrangian = -m*tr((a*a^T + b*b^T)*Ω)/h;",
];

#[test]
fn what_no_parameters_can_step_is_said() {
    for body in STATED {
        let d = derived(body);
        let list = d.warnings.iter();
        let warning = list.clone().find(|w| w.topic == DegenerateKineticEnergy);
        let said = warning.map(|w| w.diagnostic.text()).unwrap_or_default();
        for words in [REFUSED, "`m*a*a^T + S`"] {
            assert!(said.contains(words), "{body}\n{words}\n{said}");
        }
        let text = text(&d);
        for words in ["The stepper makes no step", "is not known to be bounded"] {
            let constant = words.starts_with("is not") && text.contains("is constant:");
            assert!(constant || text.contains(words), "{body}\n{words}\n{text}");
        }
        for words in [
            "You can choose another solver",
            "still determines",
            "The velocity that tends to the identity",
            "is bounded",
        ] {
            assert!(!text.contains(words), "{body}\n{words}\n{text}");
        }
    }
}

#[test]
fn what_is_emitted_says_so_too() {
    let emitted = |body: &str| crate::emit::emit(&derived(body), false).to_string();
    for body in STATED {
        let code = emitted(body);
        assert!(
            code.contains("every choice of the parameters is rejected at the start"),
            "{code}"
        );
        assert!(!code.contains(": bounded, since"), "{code}");
    }
}

#[test]
fn the_way_out_is_one() {
    for (body, without, with) in [
        (STATED[0], "a*a^T*Ω", "(a*a^T + S)*Ω"),
        (STATED[1], "m*dot(", "-tr(S*Ω)/h + m*dot("),
    ] {
        let body = format!("param S: Sym<3>; {}", body.replace(without, with));
        let d = derived(&body);
        assert!(d.warnings.is_empty(), "{body}\n{:?}", d.warnings);
        let text = text(&d);
        assert!(
            text.contains("The stepper is explicit up to the root"),
            "{text}"
        );
        assert!(!text.contains("makes no step"), "{text}");
    }
    // Two masses on different lines form a flat body.
    let flat = "param a, b: Vec<3>; group Λ: SO<3> velocity Ω; constraint next(Λ) = Λ*Ω; \
                lagrangian = -tr((a*a^T + b*b^T)*Ω)/h;";
    let d = derived(flat);
    assert!(d.warnings.is_empty(), "{:?}", d.warnings);
    assert!(text(&d).contains("itself is solved for"));
}

#[test]
fn other_methods_are_not_said_to_refuse_all() {
    let pendulums = "param m: Real; param a, b: Vec<3>; group A: SO<3> velocity V; \
         group B: SO<3> velocity W; constraint next(A) = A*V; constraint next(B) = B*W; \
         let x = A*a; let y = A*a + B*b; \
         lagrangian = (dot(next(x) - x, next(x) - x) + m*dot(next(y) - y, next(y) - y))/(2*h);";
    let d = derived(pendulums);
    let said: String = d.warnings.iter().map(|w| w.diagnostic.text()).collect();
    assert!(
        said.contains("rank 4 of 6") && !said.contains(REFUSED),
        "{said}"
    );
    let text = text(&d);
    for words in [
        "Newton's method on the group",
        "But the kinetic energy has rank 4 of 6 in the velocities for all parameters",
        "is not known to be bounded",
    ] {
        assert!(text.contains(words), "{words}\n{text}");
    }
}
