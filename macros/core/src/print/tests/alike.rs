//! Model letters that would print like letters of the engine. In models with a parameter of such a name, every letter
//! of the derivation must stay distinct in print.

use crate::document::printed;
use crate::expr::spelling::seen;
use crate::pipeline::derive_source;
use crate::print::Format;
use std::collections::BTreeSet;

/// Heavy tops whose parameter has this name, and models on other groups with the same letters.
fn models(name: &str) -> [String; 4] {
    [
        format!(
            "model M {{ param J: Sym<3>; param {name}, z0: Vec<3>; group G: SO<3> velocity W; \
             advected q: Vec<3> = G^T*z0; constraint next(G) = G*W; constraint next(q) = W^T*q; \
             lagrangian = -tr(J*W)/h - h*dot({name}, q); }}"
        ),
        format!(
            "model M {{ param J: Sym<3>; param {name}: Vec<3>; group G1: SO<3> velocity W1; \
             group G2: SO<3> velocity W2; constraint next(G1) = G1*W1; constraint next(G2) = G2*W2; \
             lagrangian = -tr(J*W1)/h - tr(J*W2)/h - h*dot({name}, G1*G2^T*{name}); }}"
        ),
        format!(
            "model M {{ param J: Sym<3>; param {name}: Real; group G: SE<3> velocity W; \
             constraint next(G) = G*W; let u = (pos(W) - pos(W^-1))/2; \
             lagrangian = -tr(J*rot(W))/h + {name}*dot(u, u)/(2*h); }}"
        ),
        format!(
            "model M {{ param {name}: Sym<4>; group G: SO<4> velocity W; \
             constraint next(G) = G*W; lagrangian = -tr({name}*W)/h; }}"
        ),
    ]
}

/// How often a letter occurs in a text without a script or another letter that makes it a different name.
fn occurrences(text: &str, letter: &str) -> usize {
    text.match_indices(letter)
        .filter(|(at, _)| {
            let before = text[..*at].chars().next_back();
            let after = text[at + letter.len()..].chars().next();
            let other = |c: char| c.is_alphanumeric();
            let script = |c: char| c == '_' || ('₀'..='₉').contains(&c) || c.is_ascii_digit();
            !before.is_some_and(char::is_alphabetic)
                && !after.is_some_and(|c| other(c) || script(c))
        })
        .count()
}

#[test]
fn every_letter_of_a_derivation_prints_as_no_other() {
    let own = [
        "mu", "xi", "zeta", "eta", "Theta", "lambda", "iota", "M", "Mu", "P", "m", "mu1", "xi_1",
        "V_q", "V", "M_k", "P_k1", "mu_k", "m_k", "dq", "L", "K", "C", "N", "U_1", "A", "B", "g",
        "v", "a", "ℒ", "dzeta", "dζ",
    ];
    for name in own {
        for model in models(name) {
            let d = derive_source(&model).unwrap_or_else(|e| panic!("{e}\n{model}"));
            let mut names = BTreeSet::new();
            for id in d.letters.symbols.ids() {
                let symbol = &d.letters.symbols.get(id).name;
                assert!(names.insert(seen(symbol, "k")), "{symbol} twice in {model}");
            }
        }
    }
}

#[test]
fn a_parameter_stands_in_the_document_where_it_stands_by_another_name() {
    for (name, letter) in [
        ("mu", "μ"),
        ("xi", "ξ"),
        ("zeta", "ζ"),
        ("eta", "η"),
        ("Theta", "Θ"),
        ("lambda", "λ"),
        ("iota", "ι"),
    ] {
        // The count for a letter that the engine never uses shows how often the parameter occurs.
        for (model, plain) in models(name).iter().zip(models("psi")) {
            let text = |model: &str| {
                let d = derive_source(model).unwrap_or_else(|e| panic!("{e}\n{model}"));
                printed(&d, Format::Text)
            };
            let (named, plain) = (text(model), text(&plain));
            assert_eq!(
                occurrences(&named, letter),
                occurrences(&plain, "ψ"),
                "{letter} stands for something else too:\n{named}"
            );
        }
    }
}

#[test]
fn names_that_print_as_another_are_refused() {
    for (names, said) in [
        ("x1, x_1", "look the same in print"),
        ("M, Mu", "look the same in print"),
        ("E_1", "prints like `E1`"),
        ("E4", "prints like `E4`"),
        ("ℓ", "prints like `ℓ`"),
        ("µ, μ", "U+00B5"),
        ("μ, µ", "U+00B5"),
        ("mu, µ", "look the same in print"),
        ("a, а", "U+0430"),
        ("аb, ab", "U+0430"),
        ("\u{2126}, Ω", "U+2126"),
        ("x, 𝑥", "look the same in print"),
        ("é, e\u{301}", "look the same in print"),
        ("һ", "prints like the time step `h`"),
        ("W_k", "look the same in print"),
        ("a, a_k", "is the time index"),
        ("Е1", "prints like `E1`"),
    ] {
        let model = format!(
            "model M {{ param J: Sym<3>; param {names}: Real; group G: SO<3> velocity W; \
             constraint next(G) = G*W; lagrangian = -tr(J*W)/h; }}"
        );
        let message = derive_source(&model).map_or_else(|e| e.to_string(), |_| String::new());
        assert!(message.contains(said), "{names}: {message}");
    }
    // Letters that look different are different names.
    let model = "model M { param J: Sym<3>; param ϵ, ε, ϑ, θ, ϕ, φ, ϖ, π, ϱ, ρ, ς, σ, p, ж: Real; \
                 group G: SO<3> velocity W; constraint next(G) = G*W; \
                 lagrangian = -(ϵ*ε + ϑ*θ + ϕ*φ + ϖ*π + ϱ*ρ + ς*σ + p*ж)*tr(J*W)/h; }";
    let d = derive_source(model).unwrap_or_else(|e| panic!("{e}"));
    let latex = printed(&d, Format::Latex);
    for command in [
        "\\epsilon ",
        "\\varepsilon ",
        "\\vartheta ",
        "\\theta ",
        "\\phi ",
        "\\varphi ",
        "\\varpi ",
        "\\pi ",
        "\\varrho ",
        "\\rho ",
        "\\varsigma ",
        "\\sigma ",
    ] {
        let command = command.trim_end();
        let mut found = latex.match_indices(command);
        let whole = found.any(|(i, _)| {
            !latex[i + command.len()..].starts_with(|c: char| c.is_ascii_alphabetic())
        });
        assert!(whole, "{command}\n{latex}");
    }
    let other = "model M { param J: Sym<3>; param µ: Real; group G: SO<3> velocity W; \
                 constraint next(G) = G*W; lagrangian = -μ*tr(J*W)/h; }";
    let message = derive_source(other).map_or_else(|e| e.to_string(), |_| String::new());
    assert!(message.contains("it looks the same"), "{message}");
}

#[test]
fn names_that_are_typeset_as_another_are_refused() {
    let with = |names: &str| {
        format!(
            "model M {{ param J: Sym<3>; param {names}; group G: SO<3> velocity W; \
             constraint next(G) = G*W; lagrangian = -tr(J*W)/h; }}"
        )
    };
    for (names, said) in [
        (
            r#"a, b: Real as "x", "x""#,
            "`b` and `a` look the same in LaTeX",
        ),
        (
            r#"a, b: Real as "x_{1}", "{x}_1""#,
            "look the same in LaTeX",
        ),
        (
            r#"a, b: Real as "\hat x", "\hat{x}""#,
            "look the same in LaTeX",
        ),
        (r#"a: Real as "J""#, "`a` and `J` look the same in LaTeX"),
        (r#"a: Real as "W""#, "`W` and `a` look the same in LaTeX"),
        (r#"a: Real as "W_k""#, "look the same in LaTeX"),
        (r#"a: Real as "G_{k+1}""#, "look the same in LaTeX"),
        (
            r#"mu, a: Real as "m", "\mu"; param b: Real as "m""#,
            "look the same in LaTeX",
        ),
        (r#"a: Real as "h""#, "the time step `h`"),
        (r#"a: Real as "\ell""#, "prints like `ℓ`"),
        (r#"a: Real as "E_1""#, "prints like `E1`"),
        (r#"a: Real as "\mathrm{Id}""#, "prints like `Id`"),
    ] {
        let message = derive_source(&with(names)).map_or_else(|e| e.to_string(), |_| String::new());
        assert!(message.contains(said), "{names}: {message}");
        assert_eq!(message.matches("help").count(), 1, "{names}: {message}");
    }
    for names in [
        r#"a, b: Real as "x", "y""#,
        r#"a, b: Real as "x", "\mathbf{x}""#,
        r#"a, b: Real as "\phi", "\varphi""#,
        r#"a, b: Real as "b", "a""#,
    ] {
        assert!(derive_source(&with(names)).is_ok(), "{names}");
    }
    // Letters of the engine are renamed.
    let d = derive_source(&with(r#"a: Real as "M_k""#)).unwrap_or_else(|e| panic!("{e}"));
    for id in d
        .letters
        .symbols
        .ids()
        .filter(|id| d.spec.symbols.ids().all(|i| i != *id))
    {
        let name = &d.letters.symbols.get(id).name;
        assert_ne!(seen(name, "k"), seen("M", "k"), "{name}");
    }
}

#[test]
fn letters_keep_clear_of_typeset_names() {
    let model = "model M { param J: Sym<3>; param p, z: Vec<3> as \"\\mu\", \"\\xi\"; \
                 group G: SO<3> velocity W; advected q: Vec<3> = G^T*z; constraint next(G) = G*W; \
                 constraint next(q) = W^T*q; lagrangian = -tr(J*W)/h - h*dot(p, q); }";
    let d = derive_source(model).unwrap_or_else(|e| panic!("{e}"));
    for id in d.letters.symbols.ids() {
        let name = seen(&d.letters.symbols.get(id).name, "k");
        assert!(name != seen("mu", "k") && name != seen("xi", "k"), "{name}");
    }
}
