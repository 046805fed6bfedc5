//! The engine's printed output as files for human review: the derivation of every gallery model and of models without a stepper. A
//! test fails if a character differs from `snapshots/`. `generated_fresh` compares the emitted Rust with `generated/`. To accept
//! new output after review: `INSTA_UPDATE=always cargo test --profile quick --test derivation snapshots`.

use clebsch_core::document::{Citations, printed_telling};
use clebsch_core::print::{Format, Style};
use clebsch_core::{Derivation, derive_source};
use insta::assert_snapshot;

/// Statements outside the gallery that the engine derives and prints. Either no stepper is emitted for them, or a gallery model
/// integrates the same motion.
const ENGINE_ONLY: [(&str, &str); 4] = [
    (
        "four-dimensional-body",
        "/// Free rigid body in four dimensions.
        model FourDimensionalBody {
            param C: Mat<4>;
            group Λ: SO<4> velocity Ω;  constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(C^T*Ω)/h;
        }",
    ),
    (
        "body-of-any-dimension",
        "/// Free rigid body in a dimension that is left open.
        model BodyOfAnyDimension {
            dim n in 3..=8;  param J: Sym<n>;
            group Λ: SO<n> velocity Ω;  constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(J*Ω)/h;
        }",
    ),
    (
        "affine-body",
        "/// Affine body of three dimensions, convective representation.
        model AffineBody {
            param C0, I0: Sym<3>;  param a, b, c, d: Real;
            group Q: GL<3> velocity G;  advected C: Sym<3> = Q^T*C0*Q;
            constraint next(Q) = Q*G;  constraint next(C) = G^T*C*G;
            let W = a*I1(C) + b*I2(C) + c*det(C) - (d/2)*log(det(C));
            lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W;
        }",
    ),
    (
        "heavy-top-thesis",
        "/// Heavy top in the normalisation of the thesis: the Lagrangian is -h times the action.
        model HeavyTopThesis {
            param J: Sym<3>;  param gU, z: Vec<3>;
            group Λ: SO<3> velocity Ω;  advected Γ: Vec<3> = Λ^T*z;
            constraint next(Λ) = Λ*Ω;  constraint next(Γ) = Ω^T*Γ;
            scale -h;
            lagrangian = tr(Ω*J) + h^2*dot(gU, Γ);
        }",
    ),
];

fn derive(name: &str, source: &str) -> Derivation {
    derive_source(source).unwrap_or_else(|errors| panic!("{}", errors.render(source, name)))
}

fn text(d: &Derivation, citations: Citations) -> String {
    printed_telling(d, Format::Text, Style::default().columns, citations, None)
}

#[test]
fn models_of_the_gallery_print_as_before() {
    for entry in clebsch_models::gallery() {
        let name = entry.card.kebab;
        let d = derive(name, entry.card.source);
        assert_snapshot!(format!("{name}.derivation"), text(&d, entry.citations));
    }
}

#[test]
fn models_without_a_stepper_print_as_before() {
    for (name, source) in ENGINE_ONLY {
        let d = derive(name, source);
        assert_snapshot!(format!("{name}.derivation"), text(&d, Citations::NONE));
    }
}
