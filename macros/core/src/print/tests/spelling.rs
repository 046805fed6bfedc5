//! Exact output in plain text and LaTeX, and conditions on all LaTeX output.

use super::sample::{Sample, THREE};
use crate::algebra::Rational;
use crate::expr::{self, Expr};
use crate::print::formula::{Formula, Relation};
use crate::print::{Format, Style, expression, formula};

fn text(s: &Sample, e: &Expr) -> String {
    expression(e, &s.symbols, &Style::default(), Format::Text)
}

fn latex(s: &Sample, f: &Formula) -> String {
    formula(f, &s.symbols, &Style::default(), Format::Latex)
}

#[test]
fn the_heavy_top_reads_as_on_paper() {
    let s = Sample::new();
    let e = s.heavy_top();
    assert_eq!(text(&s, &e), "-tr(J Ω_k)/h - h gU·Γ_k");
    assert_eq!(
        latex(&s, &e.into()),
        "-\\frac{\\operatorname{tr}(J\\,\\Omega_{k})}{h} - h\\,\\mathit{gU} \\cdot \\Gamma_{k}"
    );
}

#[test]
fn brackets_are_minimal_in_text() {
    let s = Sample::new();
    let wanted = [
        "-7/3",
        "½",
        "0",
        "2 π c",
        "(1.380649 × 10⁻²³) (0.123456789)",
        "0",
        "E₃",
        "-tr(J Ω_k)/h - h gU·Γ_k",
        "-(c + x_{ref})/h",
        "(c + x_{ref}) J",
        "(3/7) c gU",
        "½ c gU",
        "3 c/(2 h x_{ref})",
        "c x_{ref}/(2 h)",
        "2 gU·Γ_k/h",
        "-2/h",
        "-2/h",
        "((c + x_{ref})/h) A",
        "(c + x_{ref})/(c h)",
        "c/h²",
        "(c + x_{ref})²",
        "√(c + x_{ref})",
        "√c",
        "(√c)²",
        "c^{-3/2}",
        "tr(A)⁻²",
        "√(⅔)",
        "Λ_kᵀ z",
        "gUᵀ Q_kᵀ Aᵀ",
        "Λ_{1,k+1}",
        "Λ_{1,k-1}ᵀ",
        "Q_k⁻¹",
        "Q_k⁻ᵀ",
        "Q_k⁻ᵀ",
        "(A + J)⁻¹",
        "(A + J)⁻ᵀ",
        "tr(C₀ (Ω_k - Id))",
        "det(Q_k)",
        "adj(A)",
        "((Ω_k - Id) d₁)·(A (Ω_k - Id) d₁)",
        "c (gU·z) Γ_k·z",
        "c (gU × (J Γ_k))",
        "(gU × Γ_k) × z",
        "z·(gU × Γ_k)",
        "-gU × Γ_k",
        "-(A + J) A",
        "(gU × Γ_k)ᵀ",
        "hat(Γ_k)",
        "hat(gU)",
        "hat(Λ_kᵀ z)",
        "vee(A J)",
        "sym(A J)",
        "skew(A)",
        "diag(A)",
        "exp(c + x_{ref})",
        "log(det(Q_k))",
        "exp(c + x_{ref}) + log(c + x_{ref}) + sin(c + x_{ref}) + cos(c + x_{ref}) \
         + sinh(c + x_{ref}) + cosh(c + x_{ref}) + tanh(c + x_{ref}) + |c + x_{ref}| \
         + sign(c + x_{ref})",
        "|c|",
        "diag(gU)",
        "gU·E₂",
        "(A E₁)·E₃",
        "(q_k G_k E₄)·E₂",
        "(G_k [z; 0])·E₄",
        "h (zᵀ gU) A",
        "h zᵀ gU",
        "zᵀ A gU zᵀ gU",
        "z zᵀ gU zᵀ",
        "Q_kᵀ C₀ Q_k",
        "h² - 1",
        "re(q_k)",
        "im(q_k quat(z))",
        "rot(q_k)ᵀ",
        "J rot(G_k)",
        "rot(G_k)ᵀ rot(G_k)ᵀ",
        "pos(G_k)",
        "-pos(G_k)ᵀ rot(G_k)",
        "twist((0, z))",
        "R(Γ_k)",
        "(DR(Γ_k))ᵀ[z]",
    ];
    let printed: Vec<String> = s.expressions().iter().map(|e| text(&s, e)).collect();
    assert_eq!(printed, wanted);
}

#[test]
fn formulas_read_as_on_paper() {
    let s = Sample::new();
    let wanted = [
        "-tr(J Ω_k)/h - h gU·Γ_k",
        "J_{k+1}^R",
        "M_k = M_k + P_k = P_k",
        "M_k - (M_k + P_k)",
        "-(M_k + P_k)",
        "(M_k + P_k) (∇_{Ω_k} ℓ) Λ_k",
        "(M_k + P_k)/h",
        "c²",
        "(∇_{Ω_k} ℓ)ᵀ",
        "Q_k⁻ᵀ",
        "(Q_k A)⁻¹",
        "gU·Γ_k",
        "gU × Γ_k",
        "∇_{Γ_k} ℓ ◇ Γ_k",
        "[hat(gU), hat(Γ_k)]",
        "⟨M_k, ξ⟩",
        "Ad_{Λ_k} ξ",
        "Ad*_{Ω_{k-1}} M_{k-1}",
        "Ad*_{Ω_k} (M_k + P_k)",
        "ad*_ξ M_k",
        "dM_k/dt",
        "d/dt (M_k + P_k)",
        "[[A, J], [M_k + P_k, A]]",
        "Ω_{-1}",
        "M",
        "δΛ_k",
        "(δΛ_k)ᵀ",
        "d/dε|_{ε=0} S_d(Λ_k, Ω_k)",
        "skew(A P_k)",
        "tr(A)",
        "det(A)",
        "sym(A)",
        "diag(A)",
        "vee(A)",
        "exp(c)",
        "log(c)",
        "hat(gU)",
        "|Γ_k|",
        "∑_{k=0}^{N-1} ℓ_k",
        "(A)",
        "δΛ_k = A,  M_k = P_k",
        "⟨M_k, ξ⟩ = 0 for all ξ",
        "M_k = P_k ⟹ Γ",
    ];
    let style = Style::default();
    let print = |f: &Formula| formula(f, &s.symbols, &style, Format::Text);
    let printed: Vec<String> = s.formulas().iter().map(print).collect();
    assert_eq!(printed, wanted);
}

#[test]
fn latex_spellings() {
    let s = Sample::new();
    let f = |e: Expr| Formula::Expr(e);
    let cases: [(Formula, &str); 11] = [
        (f(s.t(s.at("Λ1", 1))), "\\Lambda_{1,k+1}^{\\mathsf{T}}"),
        (f(s.v("chi")), "\\chi_{k}"),
        (f(expr::inverse(&s.symbols, s.v("Q"))), "Q_{k}^{-1}"),
        (f(expr::hat(s.v("Γ"))), "\\hat{\\Gamma}_{k}"),
        (
            f(expr::hat(expr::mul(s.v("A"), s.v("gU")))),
            "\\widehat{A\\,\\mathit{gU}}",
        ),
        (
            f(expr::hat(expr::product([
                s.v("h"),
                s.v("A"),
                s.v("A"),
                s.v("J"),
                s.v("Λ"),
                s.v("gU"),
            ]))),
            "(h\\,A^{2}\\,J\\,\\Lambda_{k}\\,\\mathit{gU})^{\\wedge}",
        ),
        (
            Formula::ad_star(s.v("Ω"), s.v("M")),
            "\\operatorname{Ad}_{\\Omega_{k}}^{*}M_{k}",
        ),
        (
            Formula::diamond(Formula::gradient("ℓ", s.letter("Γ", 0)), s.v("Γ")),
            "\\nabla_{\\Gamma_{k}}\\ell \\diamond \\Gamma_{k}",
        ),
        (
            Formula::pairing(s.v("M"), Formula::variation(s.v("Λ"))),
            "\\langle M_{k}, \\delta \\Lambda_{k}\\rangle",
        ),
        (
            Formula::Grouped(Box::new(f(expr::scale(Rational::HALF, s.v("A"))))),
            "\\left(\\frac{1}{2}\\,A\\right)",
        ),
        (
            Formula::Relation(
                vec![Formula::name("Gamma_a"), f(s.v("A"))],
                Relation::Defined,
            ),
            "\\Gamma_{a} := A",
        ),
    ];
    for (formula, wanted) in cases {
        assert_eq!(latex(&s, &formula), wanted);
    }
}

#[test]
fn latex_is_ascii_and_balanced() {
    let s = Sample::new();
    let expressions = s.expressions().into_iter().map(Formula::Expr);
    for f in expressions.chain(s.formulas()) {
        for format in [Format::Latex, Format::Markdown] {
            let tex = formula(&f, &s.symbols, &Style::default(), format);
            assert!(tex.is_ascii(), "{tex}");
            let mut depth = 0i32;
            let mut before = ' ';
            for c in tex.chars() {
                match c {
                    '{' if before != '\\' => depth += 1,
                    '}' if before != '\\' => depth -= 1,
                    _ => {}
                }
                assert!(depth >= 0, "{tex}");
                before = c;
            }
            assert_eq!(depth, 0, "{tex}");
            assert_eq!(
                tex.matches("\\left(").count(),
                tex.matches("\\right)").count(),
                "{tex}"
            );
        }
    }
}

#[test]
fn github_gets_no_operatorname() {
    let s = Sample::new();
    let tex = expression(
        &s.heavy_top(),
        &s.symbols,
        &Style::default(),
        Format::Markdown,
    );
    assert!(tex.starts_with("$`") && tex.ends_with("`$"));
    assert!(!tex.contains("operatorname"));
    assert!(tex.contains("\\mathop{\\mathrm{tr}}"));
}

#[test]
fn long_numerators_stand_beside_their_divisor() {
    let s = Sample::new();
    let term = || {
        expr::trace(expr::product([
            s.v("A"),
            s.v("J"),
            s.v("A"),
            s.v("C0"),
            s.v("A"),
        ]))
    };
    let terms = (1..=5).map(|i| expr::product([expr::integer(i), s.v("c"), term()]));
    let long = expr::quotient(expr::sum(terms, expr::shape::Shape::SCALAR), s.v("h"));
    let tex = latex(&s, &expr::neg(long).into());
    assert!(tex.starts_with("-\\frac{1}{h}\\,(c\\,"), "{tex}");
}

#[test]
fn style_names_the_indices() {
    let s = Sample::new();
    let nameless = Style::new("");
    let print = |e: &Expr, style: &Style| expression(e, &s.symbols, style, Format::Text);
    assert_eq!(print(&s.v("Λ1"), &nameless), "Λ₁");
    assert_eq!(print(&s.at("Ω", 1), &nameless), "Ω_{+1}");
    let mut labelled = Style::new("n");
    labelled.label_indices = vec!["a".to_owned()];
    let at = expr::Shift {
        time: -1,
        label: [1, 0],
    };
    let e = expr::letter(&s.symbols, s.id("Ω"), at);
    assert_eq!(print(&e, &labelled), "Ω_{n-1,a+1}");
    assert_eq!(print(&s.v("J"), &labelled), "J");
    assert_eq!(print(&expr::trace(expr::identity(THREE)), &labelled), "3");
}

#[test]
fn a_sum_of_negative_terms_over_a_divisor_gives_its_sign_up() {
    let s = Sample::new();
    let sum = expr::add(s.v("c"), expr::trace(s.v("A")));
    let e = expr::quotient(expr::neg(sum), s.v("h"));
    assert_eq!(text(&s, &e), "-(c + tr(A))/h");
}

#[test]
fn vanishing_parts_of_a_formula_are_left_out() {
    let s = Sample::new();
    let zero = || Formula::Expr(expr::integer(0));
    let print = |parts| {
        formula(
            &Formula::Sum(parts),
            &s.symbols,
            &Style::default(),
            Format::Text,
        )
    };
    assert_eq!(print(vec![zero(), s.v("c").into(), zero()]), "c");
    assert_eq!(print(vec![zero(), zero()]), "0");
}

#[test]
fn equal_letters_in_a_row_are_a_power() {
    let s = Sample::new();
    let print = |f: Formula| formula(&f, &s.symbols, &Style::default(), Format::Text);
    let name = || Formula::name("S");
    assert_eq!(
        print(Formula::Product(vec![name(), name(), s.v("A").into()])),
        "S² A"
    );
    assert_eq!(
        print(expr::product([s.v("A"), s.v("Γ"), s.v("c"), s.v("c")]).into()),
        "c² A Γ_k"
    );
    assert_eq!(
        print(Formula::Inverse(Box::new(s.t(s.v("A")).into()))),
        "A⁻ᵀ"
    );
}
