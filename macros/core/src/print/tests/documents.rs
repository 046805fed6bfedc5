//! Whole documents in every format: structure, numbering, wrapping, escaping.

use super::mathml::check;
use super::sample::Sample;
use crate::expr::shape::Shape;
use crate::expr::{self, Expr};
use crate::print::document::{Document, Inline, Work};
use crate::print::formula::{Formula, Operator, Relation};
use crate::print::{Format, Style, render, standalone};

/// A sum too long for a line.
fn long(s: &Sample) -> Expr {
    let word = |i: i64| {
        let w = expr::product([s.v("A"), s.at("Λ1", 1), s.v("C0"), s.t(s.v("Ω"))]);
        let t = expr::product([expr::integer(i), s.v("c"), expr::trace(w)]);
        if i % 2 == 0 { expr::neg(t) } else { t }
    };
    expr::sum((1..=7).map(word), Shape::SCALAR)
}

/// A section on the heavy top with characters that need escapes.
fn sample(s: &Sample) -> Document {
    let (k, k1) = (|n: &str| s.v(n), |n: &str| s.at(n, -1));
    let gradient = || Formula::gradient("ℓ", s.letter("Γ", 0));
    let mut d = Document::titled("Heavy top: 100 % of Λ & co");
    let lagrangian = d.section("Lagrangian");
    lagrangian
        .paragraph([
            "The action of *one* step, a function of ".into(),
            Inline::Math(k("Ω").into()),
            " and ".into(),
            Inline::Math(k("Γ").into()),
            ", with the sign of physics [a_b] and the words that are needed to make this sentence \
             longer than one line of a terminal; 1 < 2 and $ and ~ and ^ and \\. "
                .into(),
            Inline::Math(Formula::text(
                "a*b_c [d] <e> `f` ~g~ \\h 'i' \"j\" -- k & l.",
            )),
        ])
        .equation(Formula::equal(Formula::name("ℓ"), s.heavy_top()))
        .noted("J is the matrix of second moments.")
        .equation(Formula::equal(Formula::name("L_long"), long(s)))
        .equation(Formula::equal(
            Formula::name("L_q"),
            expr::neg(expr::quotient(long(s), s.v("h"))),
        ))
        .equation(long(s));
    let equations = d.section("Equations");
    equations
        .cited(
            Formula::Relation(
                vec![
                    k("M").into(),
                    Formula::Sum(vec![
                        Formula::ad_star(k1("Ω"), k1("M")),
                        Formula::diamond(gradient(), k("Γ")),
                    ]),
                    Formula::operator(
                        Operator::Skew,
                        Formula::Product(vec![
                            Formula::gradient("ℓ", s.letter("Ω", 0)),
                            s.t(k("Ω")).into(),
                        ]),
                    ),
                ],
                Relation::Equal,
            ),
            "thesis (2.155)",
        )
        .list(vec![
            vec!["reconstruction ".into(), {
                let next = expr::mul(k("Λ"), k("Ω"));
                Inline::Math(Formula::Relation(
                    vec![s.at("Λ", 1).into(), next.into()],
                    Relation::Defined,
                ))
            }],
            vec!["- not a list".into()],
            vec!["[not an argument]".into()],
        ])
        .code("fn step() {\n    let Λ = \"```\";\n}");
    d
}

fn print(format: Format) -> String {
    let s = Sample::new();
    render(&sample(&s), &s.symbols, &Style::default(), format)
}

#[test]
fn text_is_wrapped_and_aligned() {
    let text = print(Format::Text);
    assert!(text.lines().all(|l| l.chars().count() <= 100), "{text}");
    assert!(text.contains("\n  (1)   ℓ = -tr(J Ω_k)/h - h gU·Γ_k\n"));
    let after_sign = "\n                   + 3 c tr(A Λ_{1,k+1} C₀ Ω_kᵀ) - 4 c";
    assert!(text.contains("\n  (2)   L_{long} = c tr(") && text.contains(after_sign));
    let wanted = "\n  (5)   M_k = Ad*_{Ω_{k-1}} M_{k-1} + ∇_{Γ_k} ℓ ◇ Γ_k = skew((∇_{Ω_k} ℓ) Ω_kᵀ)\n        \
                  [thesis (2.155)]\n";
    assert!(text.contains(wanted), "{text}");
}

#[test]
fn narrow_text_breaks_at_relations_first() {
    let s = Sample::new();
    let style = Style {
        columns: 60,
        ..Style::default()
    };
    let text = render(&sample(&s), &s.symbols, &style, Format::Text);
    let wanted = "\n  (5)   M_k = Ad*_{Ω_{k-1}} M_{k-1} + ∇_{Γ_k} ℓ ◇ Γ_k\n            \
                  = skew((∇_{Ω_k} ℓ) Ω_kᵀ)\n";
    assert!(text.contains(wanted), "{text}");
}

#[test]
fn latex_is_a_section_with_numbered_equations() {
    let tex = print(Format::Latex);
    assert!(tex.is_ascii());
    assert!(tex.contains("\\section{Heavy top: 100 \\% of $\\Lambda$ \\& co}\n"));
    for environment in ["equation", "aligned", "itemize", "flushleft"] {
        let count = |edge: &str| tex.matches(&format!("\\{edge}{{{environment}}}")).count();
        assert_eq!(count("begin"), count("end"));
        assert!(count("begin") > 0, "{environment}");
    }
    assert_eq!(tex.matches("\\label{eq:heavy-top:").count(), 5);
    assert!(tex.contains("\n&\\quad {} + 3\\,c"), "{tex}");
    // A bracket whose partner is on another line has a fixed size.
    assert!(tex.contains("\\bigl(") && tex.contains("\\bigr)"));
    assert!(tex.contains("\\item{} [not an argument]"));
    assert!(!tex.contains("\n\n\\begin{equation}"));
}

/// A work that equations are cited from.
const WORK: Work = Work {
    named: "thesis",
    key: "top2007",
    entry: "@phdthesis{top2007, title = {Tops}}",
    item: "\\emph{Tops}, 2007.",
};

/// In a bare document, consecutive equations form one group, and their sources are a footnote of the preceding
/// sentence.
#[test]
fn equations_in_a_row_share_a_number() {
    let s = Sample::new();
    let mut doc = Document::titled("Top: equations");
    doc.work = Some(WORK);
    let section = doc.section("Motion");
    section.text("It moves in SO(3) by");
    section.cited(
        Formula::equal(Formula::name("a"), Formula::name("b")),
        "thesis (2.1)",
    );
    section.labelled("first");
    section.cited(
        Formula::equal(Formula::name("c"), Formula::name("d")),
        "thesis (2.2) times $-1/h$, corrected: there $e Ωᵀ$ for $2 skew$",
    );
    section.noted("Variation of c.");
    section.paragraph(["By ".into(), Inline::reference("first"), ".".into()]);
    doc.section("Certificate").appendix = true;
    let tex = render(&doc, &s.symbols, &Style::default(), Format::Latex);
    let wanted = "It moves in $\\mathrm{SO}(3)$ by\\footnote{\\eqref{eq:top:first}: \\cite[(2.1)]{top2007}; \
         \\eqref{eq:top:motion-2}: \\cite[(2.2)]{top2007} times $-1/h$, corrected: there $e\\,\\Omega{}^{\\mathsf{T}}$ for $2\\,\\operatorname{skew}$.}\n\
         \\begin{subequations}\n\\begin{gather}\n\
         a = b \\label{eq:top:first} \\\\\nc = d \\label{eq:top:motion-2}\n\
         \\end{gather}\n\\end{subequations}\n\
         \\noindent \\eqref{eq:top:motion-2}: variation of c.\n\nBy \\eqref{eq:top:first}.\n\n\
         \\subsection*{Appendix: certificate}\n";
    assert!(tex.ends_with(wanted), "{tex}\n{wanted}");
    assert!(
        tex.contains("% @phdthesis{top2007, title = {Tops}}\n"),
        "{tex}"
    );
    let alone = standalone(&tex, doc.work.as_ref());
    assert!(
        alone.contains("\\bibitem{top2007} \\emph{Tops}, 2007.\n"),
        "{alone}"
    );
    // A source outside the work of the document is plain text.
    doc.work = None;
    let plain = render(&doc, &s.symbols, &Style::default(), Format::Latex);
    assert!(
        plain.contains("thesis (2.1);") && !plain.contains("cite"),
        "{plain}"
    );
}

/// A sum with this many terms.
fn sum_of(terms: usize) -> Formula {
    let letter = |i: usize| Formula::name(&format!("a_{i}"));
    Formula::Sum((0..terms).map(letter).collect())
}

#[test]
fn long_formulas_of_a_sentence_stand_alone_and_go_over_pages() {
    let s = Sample::new();
    let mut doc = Document::titled("Top: Euler-Poincaré equations");
    let section = doc.section("Momentum of Poincaré");
    let sentence = |terms| ["The sum ".into(), sum_of(terms).into(), ", is long.".into()];
    section
        .paragraph(sentence(3))
        .paragraph(sentence(12))
        .paragraph(sentence(150));
    section
        .equation(sum_of(150))
        .text("is")
        .equation(sum_of(4))
        .equation(sum_of(150));
    let tex = render(&doc, &s.symbols, &Style::default(), Format::Latex);
    let count = |part: &str| tex.matches(part).count();
    assert!(
        tex.contains("The sum $a_{0} + a_{1} + a_{2}$, is long."),
        "{tex}"
    );
    assert!(tex.contains("The sum\n\\[\na_{0} + "), "{tex}");
    assert!(tex.contains(" + a_{11},\n\\]\n is long."), "{tex}");
    assert!(
        tex.contains(" + a_{149},\n\\end{align*}}\n is long."),
        "{tex}"
    );
    // Further lines of an equation that breaks across pages do not get a number.
    assert_eq!((count("\\begin{align}"), count("\\label")), (2, 3), "{tex}");
    assert!(count("\\notag \\\\") > 20, "{tex}");
    assert_eq!(count("\\label{eq:top:momentum-of-poincare-2}"), 1, "{tex}");
}

#[test]
fn long_titles_are_ragged_and_statements_fit_on_a_page() {
    let s = Sample::new();
    let title = "AnEllipsoidOfManyWords: discrete equations of motion";
    let mut doc = Document::titled(title);
    let code = format!("lagrangian = {};", vec!["a*b"; 30].join(" + "));
    doc.section("Model").code(&*code);
    let tex = render(&doc, &s.symbols, &Style::default(), Format::Latex);
    assert!(
        tex.contains(&format!("\\section[{title}]{{\\raggedright {title}}}")),
        "{tex}"
    );
    let lines: Vec<&str> = tex.lines().filter(|l| l.starts_with("\\mbox")).collect();
    assert_eq!(lines.len(), 4, "{tex}");
    assert!(lines[1].starts_with("\\mbox{~~~~+~a*b"), "{tex}");
    // Plain text keeps code on one line, so that it can be copied.
    let text = render(&doc, &s.symbols, &Style::default(), Format::Text);
    assert!(text.contains(&code), "{text}");
}

#[test]
fn markdown_fences_and_escapes() {
    let md = print(Format::Markdown);
    assert_eq!(md.matches("```math\n").count(), 5);
    assert!(md.contains("\\tag{5}\n```\n\n\\[thesis (2.155)\\]\n"));
    assert!(md.contains("\n````text\nfn step() {\n"));
    assert!(md.contains("\n- \\- not a list\n"));
    assert!(md.contains("\\*one\\*") && md.contains("\\[a\\_b\\]"));
    assert!(!md.contains("operatorname"));
}

#[test]
fn rustdoc_gets_every_formula_on_one_line() {
    let md = print(Format::MathMl);
    let mut rest = md.as_str();
    let mut formulas = 0;
    while let Some(start) = rest.find("<math") {
        let length = rest[start..].find("</math>").unwrap() + "</math>".len();
        let math = &rest[start..start + length];
        assert!(!math.contains('\n'));
        check(math);
        formulas += 1;
        rest = &rest[start + length..];
    }
    assert_eq!(formulas, 9);
}

#[test]
fn rows_of_rustdoc_begin_with_the_left_side_once() {
    let s = Sample::new();
    let mut d = Document::titled("Rows");
    let equation = Formula::equal(Formula::name("L_long"), long(&s));
    d.section("One").equation(equation);
    let md = render(&d, &s.symbols, &Style::default(), Format::MathMl);
    let rows: Vec<&str> = md.split("<mtr>").skip(1).collect();
    assert!(rows.len() > 1, "{md}");
    let told = |row: &&str| row.contains("<mi>L</mi>");
    assert!(rows.first().is_some_and(told), "{md}");
    assert_eq!(rows.iter().filter(|r| told(r)).count(), 1, "{md}");
}

/// Skips one JSON value; panics if there is none.
fn skip(text: &str) -> &str {
    let text = text.trim_start();
    let list = |open: char, close: char, keyed: bool| {
        let mut rest = text.strip_prefix(open).unwrap().trim_start();
        while !rest.starts_with(close) {
            if keyed {
                rest = skip(rest).trim_start().strip_prefix(':').unwrap();
            }
            rest = skip(rest).trim_start();
            rest = rest.strip_prefix(',').unwrap_or(rest).trim_start();
        }
        rest.strip_prefix(close).unwrap()
    };
    match text.chars().next().unwrap() {
        '{' => list('{', '}', true),
        '[' => list('[', ']', false),
        '"' => {
            let mut escaped = false;
            let end = text[1..].find(|c: char| {
                assert!(c >= ' ');
                let ends = c == '"' && !escaped;
                escaped = c == '\\' && !escaped;
                ends
            });
            &text[end.unwrap() + 2..]
        }
        'n' => text.strip_prefix("null").unwrap(),
        _ => text.trim_start_matches(|c: char| c.is_ascii_digit()),
    }
}

#[test]
fn json_is_well_formed_and_the_same_every_time() {
    let json = print(Format::Json);
    assert_eq!(skip(&json), "\n");
    assert_eq!(json, print(Format::Json));
    assert!(json.contains("\"number\": 5,"));
    assert!(json.contains("\"tag\": \"thesis (2.155)\","));
    assert!(json.contains("\"text\": \"fn step() {\\n    let Λ = \\\"```\\\";\\n}\""));
}

#[test]
fn degenerate_documents_print() {
    let s = Sample::new();
    let mut empty = Document::titled("");
    empty
        .section("")
        .paragraph([])
        .list(Vec::new())
        .code("")
        .equation(Formula::Sum(Vec::new()))
        .equation(Formula::Product(Vec::new()))
        .equation(Formula::Relation(Vec::new(), Relation::Equal))
        .equation(Formula::name(""))
        .equation(Formula::text(""));
    for columns in [0, 1, 100] {
        let style = Style {
            columns,
            points: 6 * columns,
            ..Style::default()
        };
        for document in [&empty, &sample(&s)] {
            for format in [
                Format::Text,
                Format::Latex,
                Format::Markdown,
                Format::MathMl,
                Format::Json,
            ] {
                assert!(!render(document, &s.symbols, &style, format).is_empty());
            }
        }
    }
}
