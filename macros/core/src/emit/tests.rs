//! Emitted expressions have the value of the original expression, with operators and parentheses as Rust reads them.
//! The tests use random trees of sums, products, quotients, powers and signs. A small parser with Rust's precedence
//! evaluates the emitted tokens. Letters of matrices have numbers as values here, which commute.

use super::expression::{Bindings, Writer};
use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Node};
use proc_macro2::{TokenStream, TokenTree};
use std::collections::BTreeMap;

/// Names and their values.
type Values = BTreeMap<String, f64>;

/// Parses tokens as Rust does. If `grouped` is false, it ignores parentheses.
struct Reader<'a> {
    trees: Vec<TokenTree>,
    at: usize,
    values: &'a Values,
    grouped: bool,
}

impl<'a> Reader<'a> {
    fn value(tokens: &TokenStream, values: &'a Values, grouped: bool) -> f64 {
        let mut trees = Vec::new();
        flatten(tokens.clone(), grouped, &mut trees);
        let mut reader = Reader {
            trees,
            at: 0,
            values,
            grouped,
        };
        let out = reader.sum();
        assert_eq!(reader.at, reader.trees.len(), "{tokens}");
        out
    }

    fn punct(&mut self, wanted: char) -> bool {
        let found =
            matches!(self.trees.get(self.at), Some(TokenTree::Punct(p)) if p.as_char() == wanted);
        self.at += usize::from(found);
        found
    }

    fn sum(&mut self) -> f64 {
        let mut out = self.product();
        loop {
            if self.punct('+') {
                out += self.product();
            } else if self.punct('-') {
                out -= self.product();
            } else {
                return out;
            }
        }
    }

    fn product(&mut self) -> f64 {
        let mut out = self.unary();
        loop {
            if self.punct('*') {
                out *= self.unary();
            } else if self.punct('/') {
                out /= self.unary();
            } else {
                return out;
            }
        }
    }

    fn unary(&mut self) -> f64 {
        match self.punct('-') {
            true => -self.unary(),
            false => self.postfix(),
        }
    }

    fn postfix(&mut self) -> f64 {
        let mut out = self.atom();
        while self.punct('.') {
            let name = self.word();
            let arguments = self.arguments();
            out = match (name.as_str(), arguments.as_slice()) {
                ("sqrt", []) => out.sqrt(),
                ("powi", [n]) => out.powf(*n),
                (name, _) => panic!("no method {name} is known here"),
            };
        }
        out
    }

    fn word(&mut self) -> String {
        let Some(TokenTree::Ident(name)) = self.trees.get(self.at) else {
            panic!("a name is missing");
        };
        self.at += 1;
        name.to_string()
    }

    fn arguments(&mut self) -> Vec<f64> {
        let Some(TokenTree::Group(g)) = self.trees.get(self.at) else {
            panic!("arguments are missing");
        };
        self.at += 1;
        let all: Vec<TokenTree> = g.stream().into_iter().collect();
        let parts = all.split(|t| matches!(t, TokenTree::Punct(p) if p.as_char() == ','));
        let parts = parts.filter(|p| !p.is_empty());
        parts
            .map(|p| Reader::value(&p.iter().cloned().collect(), self.values, self.grouped))
            .collect()
    }

    fn atom(&mut self) -> f64 {
        match self.trees.get(self.at).cloned() {
            Some(TokenTree::Literal(l)) => {
                self.at += 1;
                l.to_string().parse().expect("a number")
            }
            Some(TokenTree::Group(g)) => {
                self.at += 1;
                Reader::value(&g.stream(), self.values, self.grouped)
            }
            Some(TokenTree::Ident(name)) if name == "T" => {
                self.at += 1;
                assert!(self.punct(':') && self.punct(':'));
                let (name, arguments) = (self.word(), self.arguments());
                match (name.as_str(), arguments.as_slice()) {
                    ("one", []) => 1.0,
                    ("from_f64", [x]) => *x,
                    ("from_ratio", [x, y]) => x / y,
                    (name, _) => panic!("no function {name} is known here"),
                }
            }
            Some(TokenTree::Ident(name)) => {
                self.at += 1;
                self.values[&name.to_string()]
            }
            other => panic!("{other:?} is no operand"),
        }
    }
}

/// The tokens; if `grouped` is false, without parentheses except those of calls.
fn flatten(tokens: TokenStream, grouped: bool, out: &mut Vec<TokenTree>) {
    for t in tokens {
        let call = matches!(out.last(), Some(TokenTree::Ident(_)));
        match t {
            TokenTree::Group(g) if !grouped && !call => flatten(g.stream(), grouped, out),
            t => out.push(t),
        }
    }
}

/// The value of a tree, given the values of its letters.
fn meaning(s: &Symbols, e: &Expr, values: &Values) -> f64 {
    let go = |x: &Expr| meaning(s, x, values);
    match e.node() {
        Node::Number(q) => q.value(),
        Node::Letter(l) => values[&s.get(l.symbol).name],
        Node::Sum(terms) => terms.iter().map(go).sum(),
        Node::Neg(a) => -go(a),
        Node::Product(factors) => factors.iter().map(go).product(),
        Node::Quotient(a, b) => go(a) / go(b),
        Node::Power(a, q) => go(a).powf(q.value()),
        other => panic!("{other:?} is not grown here"),
    }
}

/// A stream of small pseudo-random numbers.
struct Draws(u64);

impl Draws {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }
}

/// A random scalar tree, or sums and multiples of matrices.
fn grown(
    s: &Symbols,
    letters: &[Vec<SymbolId>; 2],
    matrix: bool,
    depth: u32,
    d: &mut Draws,
) -> Expr {
    let letter = |d: &mut Draws| {
        let list = &letters[usize::from(matrix)];
        expr::here(s, list[d.below(list.len() as u64) as usize])
    };
    if depth == 0 {
        return match d.below(4) {
            0 if !matrix => expr::number(Rational::integer(2 + d.below(3) as i64)),
            _ => letter(d),
        };
    }
    let go = |matrix: bool, d: &mut Draws| grown(s, letters, matrix, depth - 1, d);
    match d.below(6) {
        0 | 1 => {
            let terms: Vec<Expr> = (0..2 + d.below(2)).map(|_| go(matrix, d)).collect();
            let shape = terms[0].shape();
            expr::sum(terms, shape)
        }
        2 => expr::neg(go(matrix, d)),
        3 => {
            let a = go(false, d);
            expr::product([a, go(matrix, d)])
        }
        4 => {
            let a = go(matrix, d);
            expr::quotient(a, go(false, d))
        }
        _ if matrix => expr::product([go(true, d), go(true, d)]),
        _ => {
            let powers = [2, 3, -1];
            let n = powers[d.below(3) as usize];
            expr::power(go(false, d), Rational::integer(n))
        }
    }
}

#[test]
fn what_is_emitted_has_the_value_of_the_tree() {
    let mut s = Symbols::default();
    let mut values = Values::new();
    let mut named = |name: &str, shape, value| {
        values.insert(name.to_owned(), value);
        s.add(name, shape, Structure::General, Role::Parameter)
    };
    let square = Shape::square(Dim::Fixed(3));
    let letters = [
        vec![
            named("a", Shape::SCALAR, 1.7),
            named("b", Shape::SCALAR, 0.6),
            named("c", Shape::SCALAR, 2.3),
        ],
        vec![named("A", square, 1.3), named("B", square, 0.7)],
    ];
    let bindings = Bindings::new();
    let writer = Writer {
        symbols: &s,
        bindings: &bindings,
    };
    let mut draws = Draws(7);
    let (mut told_apart, mut tried) = (0, 0);
    for round in 0..4_000 {
        let e = grown(&s, &letters, round % 2 == 0, 1 + round % 4, &mut draws);
        let wanted = meaning(&s, &e, &values);
        if !wanted.is_finite() || wanted.abs() > 1e9 {
            continue;
        }
        let tokens = writer.write(&e);
        let found = Reader::value(&tokens, &values, true);
        let scale = wanted.abs().max(1.0);
        // Nested sums may be evaluated in another order, and cancellation in a divisor amplifies the difference in
        // rounding.
        assert!(
            (found - wanted).abs() < 1e-6 * scale,
            "{tokens} is {found}, not {wanted}"
        );
        tried += 1;
        let bare = Reader::value(&tokens, &values, false);
        told_apart += i32::from((bare - wanted).abs() > 1e-3 * scale);
    }
    // The values would reveal a missing parenthesis: many trees have another value if parentheses are ignored.
    assert!(tried > 3_000 && told_apart > 1_000, "{tried} {told_apart}");
}

#[test]
fn a_sum_of_vectors_keeps_its_parentheses_before_a_number() {
    let mut s = Symbols::default();
    let vector = Shape::vector(Dim::Fixed(3));
    let [u, v] = ["u", "v"].map(|n| s.add(n, vector, Structure::General, Role::Parameter));
    let t = s.add("t", Shape::SCALAR, Structure::General, Role::Parameter);
    let [u, v, t] = [u, v, t].map(|id| expr::here(&s, id));
    let bindings = Bindings::new();
    let writer = Writer {
        symbols: &s,
        bindings: &bindings,
    };
    let e = expr::product([t, expr::add(u, v)]);
    assert_eq!(writer.write(&e).to_string(), "(u + v) * t");
}

#[test]
fn no_model_bears_a_name_that_emitted_code_imports() {
    let imports = include_str!("../../../../runtime/src/emitted.rs");
    let lines = imports.split(';').filter(|s| s.contains("pub use"));
    let words = lines.flat_map(|line| line.split(|c: char| !c.is_alphanumeric() && c != '_'));
    let named = |w: &&str| w.starts_with(char::is_uppercase);
    // Traits that are imported for their methods only.
    let unnamed = ["Model", "OfScalars", "One", "Zero"];
    let mut seen = 0;
    for word in words.filter(named).filter(|w| !unnamed.contains(w)) {
        let known = super::names::is_a_type(word);
        assert!(
            known,
            "a model called `{word}` would hide what emitted code imports"
        );
        seen += 1;
    }
    assert!(seen > 40, "{seen}");
}

#[test]
fn two_bodies_of_different_groups_that_are_solved_together_have_a_stepper() {
    let fields = |count: usize| -> (String, String) {
        let numbers = 0..count;
        let declared = numbers
            .clone()
            .map(|i| format!("field x{i}: Vec<{}>; ", i + 1));
        let first = |i: usize| format!("dot(next(x{i}) - x{i}, E1)");
        let kinetic = numbers.map(|i| {
            let quartic = format!("({0}^2*{1}^2)/(4*h^3)", first(i), first((i + 1) % count));
            format!(" + dot(next(x{i}) - x{i}, next(x{i}) - x{i})/(2*h) + {quartic}")
        });
        (declared.collect(), kinetic.collect())
    };
    let refused = |count: usize| {
        let (declared, kinetic) = fields(count);
        let text = format!("model Joined {{ {declared} lagrangian = 0{kinetic}; }}");
        let text = text
            .replace("Vec<1>", "Real")
            .replace("dot(next(x0) - x0, E1)", "(next(x0) - x0)");
        let text = text.replace("dot(next(x0) - x0, next(x0) - x0)", "(next(x0) - x0)^2");
        let d = crate::pipeline::derive_source(&text).unwrap_or_else(|e| panic!("{text}: {e}"));
        super::refusal(&d).is_some()
    };
    assert!(!refused(2));
    assert!(refused(7));
}
