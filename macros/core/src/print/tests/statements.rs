//! Model text: parsing the printed text gives the same expression again.

use super::sample::Sample;
use crate::algebra::Rational;
use crate::expr::shape::Dim;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr};
use crate::print::{Style, statement};

/// The symbols of the sample as model declarations, and two letters for pairings.
const DECLARATIONS: &str = "param c, x_ref: Real; param J, C0: Sym<3>; param A, B: Mat<3>; \
    param gU, z, d1, u: Vec<3>; group Λ: SO<3> velocity Ω; advected Λ1: SO<3>; \
    advected Q: GL<3>; advected Γ: Vec<3>; advected chi: Vec<3>; \
    param H: Mat<4>; advected q: SU<2>; advected G: SE<3>; \
    constraint next(q) = q; constraint next(G) = G; \
    constraint next(Λ) = Λ*Ω; constraint next(Λ1) = Ω^T*Λ1; constraint next(Q) = Ω^T*Q; \
    constraint next(Γ) = Ω^T*Γ; constraint next(chi) = Ω^T*chi;";

/// The Lagrangian of the model with that text, and the symbols.
fn parsed(text: &str) -> (Symbols, Expr) {
    let source = format!("model Test {{ {DECLARATIONS} lagrangian = {text}; }}");
    let model = crate::syntax::tokens(&source).and_then(crate::syntax::parse);
    let model = model.unwrap_or_else(|e| panic!("{text}: {e}"));
    let spec = crate::check::check(&model).unwrap_or_else(|e| panic!("{text}: {e}"));
    (spec.symbols, spec.typed)
}

/// A scalar that contains the expression.
fn number(symbols: &Symbols, e: Expr) -> Expr {
    let here = |name: &str| expr::here(symbols, symbols.find(name).unwrap());
    let shape = e.shape();
    if shape.is_scalar() {
        e
    } else if shape.is_vector() {
        expr::dot(here("u"), e)
    } else if shape.rows == Dim::Fixed(1) {
        expr::dot(expr::transpose(symbols, e), here("u"))
    } else {
        let size = shape.rows;
        let matrix = if size == Dim::Fixed(4) { "H" } else { "B" };
        expr::trace(expr::mul(here(matrix), e))
    }
}

#[test]
fn printed_text_parses_to_the_same_expression() {
    let sample = Sample::new();
    let style = Style::default();
    let (symbols, kinetic) = parsed("-tr(J*Ω)/h");
    let mut tried = 0;
    for original in sample.expressions() {
        // The same letters under the indices of the parsed model.
        let renamed = |l: expr::Letter| {
            let id = symbols.find(&sample.symbols.get(l.symbol).name).unwrap();
            (l, expr::letter(&symbols, id, l.shift))
        };
        let letters = expr::letters(&original);
        // A model may not refer to earlier nodes, and the language does not have a word for the adjugate.
        let adjugate = matches!(original.node(), expr::Node::Adjugate(_));
        // Statements cannot define functionals.
        let functional = matches!(
            original.node(),
            expr::Node::Given(_) | expr::Node::PullBack(..)
        );
        if adjugate || functional || letters.iter().any(|l| l.shift.time < 0) {
            continue;
        }
        let replacements: Vec<_> = letters.into_iter().map(renamed).collect();
        let e = expr::substitute(&symbols, &original, &replacements);
        let whole = expr::add(kinetic.clone(), number(&symbols, e));
        let text = statement(&whole, &symbols, &style);
        // Inclusions occur in derived expressions only.
        if text.contains('ι') {
            continue;
        }
        let (_, again) = parsed(&text);
        assert_eq!(again, whole, "{text}");
        tried += 1;
    }
    assert!(tried > 50);
}

#[test]
fn lone_terms_parse_to_themselves() {
    let (symbols, _) = parsed("-tr(J*Ω)/h");
    let style = Style::default();
    for text in [
        "-tr(J*Ω)/h - h*dot(gU, Γ)",
        "-2*tr(J*Ω)/h",
        "-(2/h)*tr(Ω)",
        "-(c + tr(Ω))*c",
        "-((c + tr(Ω))/h)",
        "-(c + tr(Ω))/h",
        "1/2*tr(Ω)/h",
        "-1/2*tr(Ω)",
        "(1/c)*((c + tr(Ω))/h)",
        "tr(Ω)/(c/h)",
        "(c/h)/(tr(Ω)/h)",
        "c*h*c^(-3/2)*tr(Ω)^-2",
        "dot(Γ, next(chi)) + c^(2/3)*tr(Ω)",
        "h*(z^T*(Ω*gU))*c - 3",
        "tr(z*z^T*Ω*gU*z^T)",
        "-hat(Γ)^T*tr(Ω)*z*c",
    ] {
        let source = if text.starts_with("-hat") {
            format!("dot(u, {text})")
        } else {
            text.to_owned()
        };
        let (_, first) = parsed(&source);
        let printed = statement(&first, &symbols, &style);
        let (_, second) = parsed(&printed);
        assert_eq!(first, second, "{source} was printed as {printed}");
    }
}

#[test]
fn text_is_written_as_a_person_would() {
    let sample = Sample::new();
    let style = Style {
        label_indices: vec!["a".to_owned()],
        ..Style::default()
    };
    let print = |e: &Expr| statement(e, &sample.symbols, &style);
    assert_eq!(print(&sample.heavy_top()), "-tr(J*Ω)/h - h*dot(gU, Γ)");
    assert_eq!(print(&sample.t(sample.at("Λ1", -1))), "prev(Λ1)^T");
    assert_eq!(print(&expr::number(Rational::HALF)), "1/2");
    let shift = expr::Shift {
        time: 1,
        label: [-1, 0],
    };
    let e = expr::letter(&sample.symbols, sample.id("Λ"), shift);
    assert_eq!(print(&e), "prev(next(Λ), a)");
}
