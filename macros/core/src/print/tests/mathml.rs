//! MathML must be well-formed, with the right number of children, on one line, and without characters that Markdown
//! interprets.

use super::sample::Sample;
use crate::print::formula::Formula;
use crate::print::{Format, Style, expression, formula};

/// An element: its name and its children.
struct Element {
    name: String,
    children: Vec<Element>,
}

/// Parses the subset that the printer writes; panics on anything else.
fn parse(text: &str) -> Element {
    let mut open = vec![Element {
        name: "root".to_owned(),
        children: Vec::new(),
    }];
    let mut rest = text;
    while let Some(start) = rest.find('<') {
        check_text(&rest[..start]);
        let end = start + rest[start..].find('>').expect("a tag ends");
        let tag = &rest[start + 1..end];
        match tag.strip_prefix('/') {
            Some(name) => {
                let done = open.pop().expect("something is open");
                assert_eq!(done.name, name, "{text}");
                open.last_mut()
                    .expect("inside the root")
                    .children
                    .push(done);
            }
            None => {
                let (name, attributes) = tag.split_once(' ').unwrap_or((tag, ""));
                assert!(name.chars().all(|c| c.is_ascii_lowercase()), "{tag}");
                assert_eq!(attributes.matches('"').count() % 2, 0, "{tag}");
                open.push(Element {
                    name: name.to_owned(),
                    children: Vec::new(),
                });
            }
        }
        rest = &rest[end + 1..];
    }
    check_text(rest);
    assert_eq!(open.len(), 1, "all closed: {text}");
    open.remove(0)
}

fn check_text(text: &str) {
    let entity = |c: char| matches!(c, '&' | '#' | ';');
    let plain = |c: char| "()+,/:=;".contains(c);
    let fine = |c: char| !c.is_ascii() || c.is_ascii_alphanumeric() || plain(c);
    for c in text.chars() {
        assert!(fine(c) || c == ' ' || entity(c), "{c:?} in {text:?}");
    }
    for after in text.split('&').skip(1) {
        let code = after.strip_prefix('#').and_then(|a| a.split_once(';'));
        assert!(
            code.is_some_and(|(n, _)| n.parse::<u32>().is_ok()),
            "{text}"
        );
    }
}

fn check_arity(e: &Element) {
    let wanted = match e.name.as_str() {
        "mfrac" | "msub" | "msup" | "mover" | "munder" => Some(2),
        "msubsup" | "munderover" => Some(3),
        "mi" | "mn" | "mo" | "mtext" | "mspace" => Some(0),
        "math" | "msqrt" => Some(1),
        _ => None,
    };
    if let Some(n) = wanted {
        assert_eq!(e.children.len(), n, "{}", e.name);
    }
    e.children.iter().for_each(check_arity);
}

/// Checks that the text is MathML without Markdown characters; panics if not.
pub fn check(text: &str) {
    check_arity(&parse(text));
}

#[test]
fn every_formula_is_well_formed() {
    let s = Sample::new();
    let expressions = s.expressions().into_iter().map(Formula::Expr);
    for f in expressions.chain(s.formulas()) {
        let text = formula(&f, &s.symbols, &Style::default(), Format::MathMl);
        assert!(!text.contains('\n'));
        check(&text);
    }
}

#[test]
fn letters_and_brackets() {
    let s = Sample::new();
    let style = Style::default();
    let print = |e| expression(&e, &s.symbols, &style, Format::MathMl);
    assert_eq!(print(s.v("gU")), "<math><mi>gU</mi></math>");
    assert_eq!(
        print(s.t(s.at("Λ1", 1))),
        "<math><msubsup><mi>Λ</mi><mrow><mn>1</mn><mo>,</mo><mi>k</mi><mo>+</mo>\
         <mn>1</mn></mrow><mi>T</mi></msubsup></math>"
    );
    let hostile = Formula::text("a*b_c [d] <e> `f` ~g~ \\h 'i' \"j\" -- k & l.");
    let text = formula(&hostile, &s.symbols, &style, Format::MathMl);
    check(&text);
}
