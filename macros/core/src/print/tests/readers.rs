//! Documents for human readers omit trivial equations, repeated sides and second spellings of a name.

use crate::derive_source;
use crate::document::printed;
use crate::print::Format;

/// A rolling wheel with a constrained coordinate.
const ROLLING: &str = "model Rolling {
    param m, I, r: Real;
    field x: Real;
    field phi: Real;
    field theta_dot: Real;
    hold a: x = r*phi;
    hold b: theta_dot = 0;
    lagrangian = m*(next(x) - x)^2/(2*h) + I*(next(phi) - phi)^2/(2*h)
        + m*(next(theta_dot) - theta_dot)^2/(2*h);
}";

#[test]
fn no_side_of_an_equation_repeats_the_one_before() {
    let free = ROLLING
        .replace("hold a: x = r*phi;", "")
        .replace("hold b: theta_dot = 0;", "");
    for text in [ROLLING, &free] {
        let d = derive_source(text).expect("a model");
        for format in [
            Format::Text,
            Format::Markdown,
            Format::Latex,
            Format::MathMl,
        ] {
            let page = printed(&d, format).replace("& =", "=");
            for never in ["0 = 0", "= a = a", "= b = b"] {
                assert!(!page.contains(never), "{never}\n{page}");
            }
        }
    }
    let d = derive_source(ROLLING).expect("a model");
    let text = printed(&d, Format::Text);
    assert!(text.contains("dp₃/dt = b\n"), "{text}");
    let d = derive_source(&free).expect("a model");
    let text = printed(&d, Format::Text);
    assert!(text.contains("dp₁/dt = 0\n"), "{text}");
}

#[test]
fn names_are_spelt_in_one_way() {
    let d = derive_source(ROLLING).expect("a model");
    let text = printed(&d, Format::Text);
    let (statement, rest) = text.split_once("Constraints\n").expect("two parts");
    assert!(statement.contains("field phi: Real;"), "{text}");
    for never in ["phi", "theta"] {
        assert!(!rest.contains(never), "{never}\n{rest}");
    }
    for said in [
        "Δφ_k = φ_{k+1} - φ_k",
        "Δθ_{dot,k} = θ_{dot,k+1} - θ_{dot,k}",
        "Variation of φ.",
        "Variation of Δθ_dot.",
        "⟨∇ℓ, δΔφ⟩ is the derivative of ℓ along δΔφ.",
    ] {
        assert!(rest.contains(said), "{said}\n{rest}");
    }
    let page = printed(&d, Format::Latex);
    let (_, rest) = page.split_once("Constraints").expect("two parts");
    assert!(rest.contains("\\mathit{\\Delta\\varphi}_{k}"), "{rest}");
    assert!(
        !rest.contains("phi}") || !rest.contains("\\Delta phi"),
        "{rest}"
    );
}
