//! Documentation and typeset names of declarations: where they appear, and what is rejected.

use crate::document::{printed, source};
use crate::pipeline::derive_source;
use crate::print::Format;
use crate::{Derivation, Errors};

fn derived(text: &str) -> Derivation {
    match derive_source(text) {
        Ok(d) => d,
        Err(e) => panic!("{e}\n{text}"),
    }
}

const TOP: &str = r#"
/// The top.
model Top {
    /// Poinsot matrix, m₁ dᵢ x⁴
    param J: Sym<3>;
    /// weight times arm,
    /// in the body
    param gU, z: Vec<3> as "m g \chi", r"\hat z";
    /// not a sphere
    assume dot(gU, gU) > 1;
    /// attitude
    group Λ: SO<3> as "R" velocity Ω as "\nu";
    /// the `vertical`
    advected Γ: Vec<3> as "\gamma" = Λ^T*z;
    /// reconstruction
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    /// an abbreviation
    let V = dot(gU, Γ);
    /// kinetic - potential
    lagrangian = -tr(J*Ω)/h - h*V;
}"#;

#[test]
fn typeset_names_reach_formulas() {
    let d = derived(TOP);
    let latex = printed(&d, Format::Latex);
    for part in [
        "{m g \\chi} \\cdot {\\gamma}_{k}",
        "{R}_{k+1} = {R}_{k}\\,{\\nu}_{k}",
        "{\\hat z}",
        "Poinsot matrix, m${}_{1}$ d${}_{i}$ x${}^{4}$",
        "weight times arm, in the body",
        "\\texttt{vertical}",
        "kinetic - potential",
    ] {
        assert!(latex.contains(part), "{part}\n{latex}");
    }
    let markdown = printed(&d, Format::Markdown);
    assert!(
        markdown.contains("{m g \\chi} \\cdot {\\gamma}_{k}"),
        "{markdown}"
    );
    let mathml = printed(&d, Format::MathMl);
    assert!(
        mathml.contains("<mi>χ</mi>") && mathml.contains("<mi>ν</mi>"),
        "{mathml}"
    );
    // Plain text keeps the names of the model.
    let text = printed(&d, Format::Text);
    assert!(
        text.contains("gU·Γ_k") && text.contains("the `vertical`"),
        "{text}"
    );
}

#[test]
fn the_canonical_text_keeps_documentation_and_names() {
    let d = derived(TOP);
    let text = source(&d);
    let again = source(&derived(&text));
    assert_eq!(text, again);
    for part in [
        "    /// Poinsot matrix, m₁ dᵢ x⁴\n    param J: Sym<3>;",
        "    /// weight times arm,\n    /// in the body\n    param gU: Vec<3> as \"m g \\chi\";",
        "param z: Vec<3> as \"\\hat z\";",
        "    /// not a sphere\n    assume dot(gU, gU) > 1;",
        "    /// attitude\n    group Λ: SO<3> as \"R\" velocity Ω as \"\\nu\";",
        "    /// the `vertical`\n    advected Γ: Vec<3> as \"\\gamma\" = Λ^T*z;",
        "    /// reconstruction\n    constraint next(Λ) = Λ*Ω;",
        "    /// kinetic - potential\n    lagrangian",
    ] {
        assert!(text.contains(part), "{part}\n{text}");
    }
}

#[test]
fn a_product_of_letters_is_bracketed_where_it_must_be() {
    let d = derived(
        "model M { param m: Real as \"m_1 m_2\"; param J: Sym<3>; group Λ: SO<3> velocity Ω; \
         constraint next(Λ) = Λ*Ω; lagrangian = -m^3*tr(J*Ω)/h; }",
    );
    let latex = printed(&d, Format::Latex);
    assert!(latex.contains("({m_1 m_2})^{3}"), "{latex}");
}

#[test]
fn wrong_names_are_refused() {
    let with = |name: &str| -> Result<Derivation, Errors> {
        derive_source(&format!(
            "model M {{ param J: Sym<3> as {name}; group Λ: SO<3> velocity Ω; \
             constraint next(Λ) = Λ*Ω; lagrangian = -tr(J*Ω)/h; }}"
        ))
    };
    for (name, why) in [
        ("\"\"", "must have 1 to"),
        ("J", "in quotes"),
        ("\"a$b\"", "it contains `$`"),
        ("\"{a\"", "do not match"),
        ("\"a}{\"", "do not match"),
        ("\"a_\"", "it is incomplete"),
        ("\"a\\\"", "unexpected character"),
        ("\"a\", \"b\"", "expected `;`"),
        ("3", "in quotes"),
        (r#""\\input{x}""#, "`\\input` is not a symbol"),
        (r#""\\end{document}""#, "`\\end` is not a symbol"),
        (r#""\\write18{ls}""#, "`\\write` is not a symbol"),
        (r#""\\def\\x{1}""#, "`\\def` is not a symbol"),
        (r#""^^5cinput""#, "it is incomplete"),
        (r#""x_1_2""#, "two scripts `_`"),
        (r#""x_{1}^{2}^{3}""#, "two scripts `^`"),
        (r#""\\hat""#, "it is incomplete"),
        (r#""\\frac{1}""#, "it is incomplete"),
        (r#""{\\hat}""#, "it is incomplete"),
        (r#""x_{}}""#, "do not match"),
        (r#""\\{x""#, "is neither a symbol nor a space"),
        (r#""\\lamda""#, "did you mean `\\lambda`?"),
        (r#""μ""#, "write `\\mu`"),
        (r#""ж""#, "which LaTeX cannot print"),
        (r#""x\\\\y""#, "is neither a symbol nor a space"),
    ] {
        match with(name) {
            Ok(_) => panic!("{name}"),
            Err(e) => assert!(e.to_string().contains(why), "{name}: {e}"),
        }
    }
    for name in [
        "\"\\xi\"",
        "\"\\upsilon\"",
        "\"\\\\xi\"",
        "r\"\\xi\"",
        "r#\"\\xi\"#",
        "r\"\\hat{\\boldsymbol\\omega}_{\\mathrm{eff}, 1}^2\"",
        "r\"\\tfrac{m}{2} g\\,\\chi'\"",
        "r\"\\mathcal I_0\"",
        "r\"|x|\"",
    ] {
        assert!(with(name).is_ok(), "{name}");
    }
    let short = derive_source("model M { param a, b: Real as \"x\"; }");
    assert!(short.is_err_and(|e| e.to_string().contains("`b`")));
}

#[test]
fn documentation_in_wrong_places_is_refused_with_words() {
    let text = "model M { param J: Sym<3>; #[inline] group Λ: SO<3> velocity Ω; \
                constraint next(Λ) = Λ*Ω; lagrangian = -tr(J*Ω)/h; }";
    match derive_source(text) {
        Ok(_) => panic!("derived"),
        Err(e) => assert!(e.to_string().contains("only documentation"), "{e}"),
    }
    let trailing = "model M { param J: Sym<3>; /// last\n }";
    assert!(derive_source(trailing).is_err());
}

#[test]
fn signs_in_a_row_are_one_formula_and_a_price_is_none() {
    let said = |words: &str| {
        let text = TOP.replace("/// The top.", &format!("/// {words}"));
        printed(&derived(&text), Format::Latex)
    };
    let found = said("With αβ and x⁴² inside.");
    assert!(found.contains("With $\\alpha\\beta$ and"), "{found}");
    let found = said("For 5 $α.");
    assert!(found.contains("For 5 \\$$\\alpha$."), "{found}");
}
