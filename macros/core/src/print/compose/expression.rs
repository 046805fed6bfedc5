//! Layouts of expressions, with one match arm for each kind of node.

use super::{Composer, transposition};
use crate::algebra::Rational;
use crate::expr::{self, Expr, Function, Map, Node, Part};
use crate::print::layout::{Fence, Layout, Sign};
use crate::print::level::{Level, RankedLayout};
use crate::print::width::{Size, width};

/// From this width in tenths of a point, a numerator is written next to its denominator, `1/h (...)`, so that it can
/// break across lines: half a line.
const WIDEST_NUMERATOR: usize = 1600;

impl Composer<'_> {
    /// An expression with its sign.
    pub fn expression(&self, e: &Expr) -> RankedLayout {
        self.sum(self.terms(e))
    }

    /// The terms of an expression; `true` marks one that is subtracted.
    pub fn terms(&self, e: &Expr) -> Vec<(bool, RankedLayout)> {
        if let Some(parts) = self.parts(e) {
            return vec![(false, parts)];
        }
        match e.node() {
            Node::Sum(terms) => terms.iter().map(|t| self.signed(t)).collect(),
            _ => vec![self.signed(e)],
        }
    }

    /// Splits off the sign, including the sign of a leading number.
    fn signed(&self, e: &Expr) -> (bool, RankedLayout) {
        if let Node::Neg(inner) = e.node() {
            let (minus, laid) = self.signed(inner);
            return (!minus, laid);
        }
        match e.node() {
            Node::Number(q) if q.is_negative() => (true, self.number(q.negated())),
            Node::Quotient(a, b) => {
                let mut divisors = vec![b];
                let top = numerator(a, &mut divisors);
                match top.node() {
                    Node::Number(q) if q.is_negative() => {
                        (true, self.quotient(q.negated(), &[], &divisors))
                    }
                    // Expression constructors distribute a minus over the terms; here it is factored out again.
                    Node::Sum(terms) if terms.iter().all(is_negative) => {
                        let positive = [expr::neg(top.clone())];
                        (true, self.quotient(Rational::ONE, &positive, &divisors))
                    }
                    _ => (false, self.unsigned(e)),
                }
            }
            _ => (false, self.unsigned(e)),
        }
    }

    fn unsigned(&self, e: &Expr) -> RankedLayout {
        match e.node() {
            Node::Number(q) => self.number(*q),
            Node::Constant(c) => self.constant(*c),
            Node::Letter(at) => {
                let letter = self.letter(*at);
                // A name of several letters gets brackets under a superscript.
                match &letter {
                    Layout::Typeset(_, shown) if matches!(**shown, Layout::Row(_)) => {
                        RankedLayout::new(letter, Level::Prefix)
                    }
                    _ => RankedLayout::atom(letter),
                }
            }
            Node::Identity(_) => RankedLayout::atom(Layout::Word("Id".to_owned())),
            Node::Zero(_) => RankedLayout::atom(Layout::Number("0".to_owned())),
            Node::Unit(_, axis) => {
                let axis = (u32::from(*axis) + 1).to_string();
                RankedLayout::atom(self.name("E", Some(&axis), None))
            }
            Node::Inclusion(shape, at) => {
                let rows = self.symbols.dim_text(shape.rows);
                let script = format!("{rows}{}", u32::from(*at) + 1);
                let name = self.symbols.fresh_name("ι");
                RankedLayout::atom(self.name(&name, Some(&script), None))
            }
            Node::Sum(_) | Node::Neg(_) => self.expression(e),
            Node::Product(factors) => {
                let (q, rest) = split(factors).unwrap_or((Rational::ONE, factors));
                if rest.iter().any(|f| reciprocal(f).is_some()) {
                    self.quotient(q, rest, &[])
                } else {
                    self.product(q, rest)
                }
            }
            Node::Quotient(a, b) => {
                let mut divisors = vec![b];
                let top = numerator(a, &mut divisors);
                match top.node() {
                    Node::Number(q) => self.quotient(*q, &[], &divisors),
                    Node::Product(factors) => {
                        let (q, rest) = split(factors).unwrap_or((Rational::ONE, factors));
                        self.quotient(q, rest, &divisors)
                    }
                    _ => self.quotient(Rational::ONE, std::slice::from_ref(top), &divisors),
                }
            }
            Node::Power(a, q) => match expr::power_of_length(e) {
                Some((of, n)) => self.power(self.length(of), n),
                None => self.power(self.expression(a), *q),
            },
            Node::Transpose(a) => match a.node() {
                Node::Inverse(inner) => self.expression(inner).raised(transposition(true)),
                _ => self.expression(a).raised(transposition(false)),
            },
            Node::Inverse(a) => self.inverted(a),
            Node::Trace(a) => self.call("tr", self.sized(a)),
            Node::Det(a) => self.call("det", self.sized(a)),
            Node::Adjugate(a) => self.call("adj", self.expression(a)),
            Node::Dot(a, b) => self.infix(
                self.expression(a),
                Sign::Dot,
                self.expression(b),
                Level::Dot,
            ),
            Node::Cross(a, b) => {
                let (a, b) = (self.expression(a), self.expression(b));
                self.infix(a, Sign::Cross, b, Level::Infix)
            }
            Node::Hat(a) => self.hat(self.expression(a)),
            Node::Vee(a) => self.call("vee", self.expression(a)),
            Node::Part(which, a) => {
                let word = match which {
                    Part::Symmetric => "sym",
                    Part::Skew => "skew",
                    Part::Diagonal => "diag",
                };
                self.call(word, self.expression(a))
            }
            Node::Call(Function::Abs, a) => self.length(a),
            Node::Call(function, a) => self.call(function.word(), self.expression(a)),
            Node::Map(map, a) => {
                let word = match map {
                    Map::Real => "re",
                    Map::Imaginary => "im",
                    Map::Pure => "quat",
                    Map::Rotation => "rot",
                    Map::Translation => "pos",
                    Map::Twist => "twist",
                    Map::Diagonal => "diag",
                    Map::DiagonalOf => "diagonal",
                };
                self.call(word, self.expression(a))
            }
            Node::Given(a) => self.functional(a, None),
            Node::PullBack(a, which, seed) => self.functional(a, Some((*which, seed))),
        }
    }

    /// The norm of a vector, or the absolute value of a number.
    fn length(&self, of: &Expr) -> RankedLayout {
        RankedLayout::atom(Layout::fenced(Fence::Bars, self.expression(of).layout))
    }

    /// The inverse of an expression; the inverse of a transpose gets a single superscript, `-T`.
    pub fn inverted(&self, a: &Expr) -> RankedLayout {
        match a.node() {
            Node::Transpose(inner) => self.expression(inner).raised(transposition(true)),
            _ => self.power(self.expression(a), Rational::MINUS_ONE),
        }
    }

    /// Under a trace, only this subscript shows the size of the identity.
    fn sized(&self, e: &Expr) -> RankedLayout {
        match e.node() {
            Node::Identity(n) => {
                let size = self.symbols.dim_text(*n);
                let id = Layout::Word("Id".to_owned());
                RankedLayout::atom(id.subscript(super::name::script(&size)))
            }
            _ => self.expression(e),
        }
    }

    /// A number times factors, as one product.
    fn product(&self, q: Rational, factors: &[Expr]) -> RankedLayout {
        let mut parts = Vec::new();
        let numbered = !q.is_one() || factors.is_empty();
        if numbered && !q.is_negative() {
            parts.push(self.number(q));
        } else if numbered {
            parts.push(self.sum(vec![(true, self.number(q.negated()))]));
        }
        let mut rest = factors;
        while let Some(first) = rest.first() {
            if let Some((laid, used)) = self.included(rest) {
                parts.push(laid);
                rest = rest.get(used..).unwrap_or_default();
                continue;
            }
            let letter = matches!(first.node(), Node::Letter(_));
            let same = rest.iter().take_while(|f| letter && *f == first).count();
            let base = self.expression(first);
            match i64::try_from(same) {
                Ok(n) if n > 1 => parts.push(self.power(base, Rational::integer(n))),
                _ => parts.push(base),
            }
            rest = rest.get(same.max(1)..).unwrap_or_default();
        }
        let last = parts.len().saturating_sub(1);
        if last == 0
            && let Some(only) = parts.pop()
        {
            return only;
        }
        let beside = parts.into_iter().enumerate().map(|(i, part)| {
            // Digits after another factor would read as part of that factor.
            let digits = match &part.layout {
                Layout::Script { base, .. } => matches!(**base, Layout::Number(_)),
                layout => matches!(layout, Layout::Number(_)),
            };
            if i > 0 && digits {
                RankedLayout::new(part.layout, Level::Sum).factor(false)
            } else {
                part.factor(i == last)
            }
        });
        self.beside(beside.collect())
    }

    /// A number times factors, over divisors. The denominator of the number and negative powers of scalars join the
    /// divisors.
    fn quotient(&self, q: Rational, factors: &[Expr], divisors: &[&Expr]) -> RankedLayout {
        let whole = |n: i128| Rational::new(n, 1).unwrap_or(Rational::ONE);
        let mut below = whole(q.denominator());
        let mut under: Vec<Expr> = factors.iter().filter_map(reciprocal).collect();
        let over: Vec<Expr> = factors
            .iter()
            .filter(|f| reciprocal(f).is_none())
            .cloned()
            .collect();
        for divisor in divisors {
            let Node::Product(inner) = divisor.node() else {
                under.push((*divisor).clone());
                continue;
            };
            match split(inner).and_then(|(n, rest)| Some((below.times(n)?, rest))) {
                Some((total, rest)) => {
                    below = total;
                    under.extend_from_slice(rest);
                }
                None => under.extend_from_slice(inner),
            }
        }
        let bottom = self.product(below, &under);
        let above = whole(q.numerator());
        let top = self.product(above, &over);
        if !self.stacked || width(&top.layout, Size::Text) <= WIDEST_NUMERATOR {
            return self.fraction(top, bottom);
        }
        let front = self.fraction(self.number(above), bottom);
        let rest = self.product(Rational::ONE, &over);
        self.beside(vec![front.factor(false), rest.factor(true)])
    }
}

/// The innermost numerator of nested quotients; adds their divisors to the list.
fn numerator<'e>(mut top: &'e Expr, divisors: &mut Vec<&'e Expr>) -> &'e Expr {
    while let Node::Quotient(a, b) = top.node() {
        divisors.push(b);
        top = a;
    }
    top
}

fn is_negative(term: &Expr) -> bool {
    match term.node() {
        Node::Neg(_) => true,
        Node::Number(q) => q.is_negative(),
        _ => false,
    }
}

/// The denominator that corresponds to a negative power of a number.
fn reciprocal(factor: &Expr) -> Option<Expr> {
    match factor.node() {
        Node::Power(a, q) if q.is_negative() => Some(expr::power(a.clone(), q.negated())),
        _ => None,
    }
}

/// The leading number of a product, and the factors after it.
fn split(factors: &[Expr]) -> Option<(Rational, &[Expr])> {
    let (first, rest) = factors.split_first()?;
    match first.node() {
        Node::Number(q) => Some((*q, rest)),
        _ => None,
    }
}
