//! Expressions and programs as Rust: one rule for each kind of node, numbers exact. Matrices are nalgebra's, passed by value.

use super::names::variable;
use super::sizes::size;
use crate::algebra::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Constant, Expr, Function, Letter, Map, Node, Part};
use crate::schedule::{self, Program};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// Which local holds each letter.
#[derive(Clone, Default)]
pub struct Bindings {
    list: Vec<(Letter, Ident)>,
    rotations: Vec<(Letter, Ident)>,
    quaternions: Vec<(Letter, Ident)>,
}

impl Bindings {
    /// None yet.
    pub fn new() -> Bindings {
        Bindings::default()
    }

    /// Adds or replaces a binding.
    pub fn bind(&mut self, letter: Letter, local: Ident) {
        self.list.retain(|(l, _)| *l != letter);
        self.list.push((letter, local));
    }

    /// Where the rotation is found that a unit quaternion covers.
    pub fn bind_rotation(&mut self, letter: Letter, local: Ident) {
        self.rotations.retain(|(l, _)| *l != letter);
        self.rotations.push((letter, local));
    }

    /// The same, if it is.
    pub fn rotation(&self, letter: Letter) -> Option<&Ident> {
        let found = self.rotations.iter().find(|(l, _)| *l == letter);
        found.map(|(_, local)| local)
    }

    /// Where a unit quaternion is found as four numbers, by its real and its imaginary part.
    pub fn bind_quaternion(&mut self, letter: Letter, local: Ident) {
        self.quaternions.retain(|(l, _)| *l != letter);
        self.quaternions.push((letter, local));
    }

    /// The same, if it is.
    pub fn quaternion(&self, letter: Letter) -> Option<&Ident> {
        let found = self.quaternions.iter().find(|(l, _)| *l == letter);
        found.map(|(_, local)| local)
    }

    /// The local that holds a letter.
    pub fn local(&self, symbols: &Symbols, letter: Letter) -> Ident {
        let found = self.list.iter().find(|(l, _)| *l == letter);
        found.map_or_else(
            || variable(symbols, letter.symbol),
            |(_, local)| local.clone(),
        )
    }
}

/// Rows and columns as tokens: numbers, or const parameters.
pub fn dims(s: &Symbols, shape: Shape) -> (TokenStream, TokenStream) {
    (size(s, shape.rows), size(s, shape.cols))
}

/// The type of a quantity over the scalar `T`.
pub fn ty(s: &Symbols, shape: Shape) -> TokenStream {
    let (rows, cols) = dims(s, shape);
    if shape.is_scalar() {
        quote!(T)
    } else if shape.is_vector() {
        quote!(SVector<T, #rows>)
    } else {
        quote!(SMatrix<T, #rows, #cols>)
    }
}

/// An exact number.
pub fn rational(q: Rational) -> TokenStream {
    let (num, den) = (q.numerator(), q.denominator());
    let exact = den.count_ones() == 1 && num.unsigned_abs() < 1 << 53 && den < 1 << 53;
    if let (false, Ok(n), Ok(d)) = (exact, i64::try_from(num), i64::try_from(den)) {
        let (n, d) = (Literal::i64_unsuffixed(n), Literal::i64_unsuffixed(d));
        return quote!(T::from_ratio(#n, #d));
    }
    let value = Literal::f64_unsuffixed(q.value());
    quote!(T::from_f64(#value))
}

/// A number that is kept as a double.
fn constant(c: Constant) -> TokenStream {
    if c == Constant::PI {
        return quote!(T::from_f64(::core::f64::consts::PI));
    }
    let value = Literal::f64_unsuffixed(c.value());
    quote!(T::from_f64(#value))
}

/// Emits expressions over one set of bindings.
pub struct Writer<'a> {
    /// The symbols.
    pub symbols: &'a Symbols,
    /// Where letters are found.
    pub bindings: &'a Bindings,
}

impl Writer<'_> {
    /// The expression as a Rust expression that can stand as an operand.
    pub fn operand(&self, e: &Expr) -> TokenStream {
        let tokens = self.write(e);
        let atomic = match e.node() {
            Node::Sum(terms) => {
                let list: Vec<&Expr> = terms.iter().collect();
                terms.len() == 2 && matches!(self.difference(&list), Some((false, ..)))
            }
            Node::Neg(_) | Node::Product(_) | Node::Quotient(..) => false,
            Node::Power(_, q) => *q != Rational::integer(2),
            Node::Number(_)
            | Node::Constant(_)
            | Node::Letter(_)
            | Node::Identity(_)
            | Node::Zero(_)
            | Node::Unit(..)
            | Node::Inclusion(..)
            | Node::Transpose(_)
            | Node::Inverse(_)
            | Node::Trace(_)
            | Node::Det(_)
            | Node::Adjugate(_)
            | Node::Dot(..)
            | Node::Cross(..)
            | Node::Hat(_)
            | Node::Vee(_)
            | Node::Part(..)
            | Node::Call(..)
            | Node::Map(..)
            | Node::Given(_)
            | Node::PullBack(..) => true,
        };
        if atomic { tokens } else { quote!((#tokens)) }
    }

    /// The expression.
    pub fn write(&self, e: &Expr) -> TokenStream {
        let go = |x: &Expr| self.operand(x);
        let (rows, cols) = dims(self.symbols, e.shape());
        match e.node() {
            Node::Number(q) => rational(*q),
            Node::Constant(c) => constant(*c),
            Node::Letter(l) => {
                let local = self.bindings.local(self.symbols, *l);
                quote!(#local)
            }
            Node::Identity(_) => quote!(SMatrix::<T, #rows, #cols>::identity()),
            Node::Zero(_) => quote!(SMatrix::<T, #rows, #cols>::zeros()),
            Node::Unit(_, axis) => {
                let axis = Literal::usize_unsuffixed(*axis as usize);
                quote!(unit::<T, #rows>(#axis))
            }
            Node::Inclusion(_, at) => {
                let at = Literal::usize_unsuffixed(*at as usize);
                quote!(inclusion::<T, #rows, #cols>(#at))
            }
            Node::Sum(terms) => self.sum(terms),
            Node::Neg(a) => {
                let a = go(a);
                quote!(-#a)
            }
            Node::Product(factors) => self.product(factors),
            Node::Quotient(a, b) => {
                let (a, b) = (go(a), go(b));
                quote!(#a / #b)
            }
            Node::Power(a, q) => self.power(a, *q),
            Node::Transpose(a) => {
                let a = go(a);
                quote!(#a.transpose())
            }
            Node::Inverse(a) => {
                let a = self.write(a);
                quote!(inverse_or_nan(&(#a)))
            }
            Node::Trace(a) => {
                let a = go(a);
                quote!(#a.trace())
            }
            Node::Det(a) => {
                let a = self.write(a);
                quote!(determinant(&(#a)))
            }
            Node::Adjugate(a) => {
                let a = self.write(a);
                quote!(adjugate(&(#a)))
            }
            Node::Dot(a, b) => match b.node() {
                Node::Unit(_, axis) => {
                    let row = Literal::usize_unsuffixed(*axis as usize);
                    // One entry, not a column of which one entry is taken.
                    if let Node::Product(factors) = a.node()
                        && let [matrix, last] = factors.as_slice()
                        && !matrix.shape().is_scalar()
                        && let Node::Unit(_, axis) = last.node()
                    {
                        let (matrix, col) = (go(matrix), Literal::usize_unsuffixed(*axis as usize));
                        return quote!(#matrix[(#row, #col)]);
                    }
                    let a = go(a);
                    quote!(#a[#row])
                }
                _ => self.method(a, "dot", b),
            },
            Node::Cross(a, b) => self.method(a, "cross", b),
            Node::Hat(a) => self.function("hat", a),
            Node::Vee(a) => self.function("vee", a),
            Node::Part(which, a) => {
                let name = match which {
                    Part::Symmetric => "symmetric_part",
                    Part::Skew => "skew_part",
                    Part::Diagonal => "diagonal_part",
                };
                self.function(name, a)
            }
            Node::Call(function, a) => {
                let a = go(a);
                let method = format_ident!(
                    "{}",
                    match function {
                        Function::Log => "ln",
                        _ => function.word(),
                    }
                );
                quote!(#a.#method())
            }
            Node::Map(Map::Rotation, a) if self.turn(a).is_some() => {
                let local = self.turn(a);
                quote!(#local)
            }
            Node::Map(Map::Real, a) if self.unit(a).is_some() => {
                let unit = self.unit(a);
                quote!(#unit.real())
            }
            Node::Map(Map::Imaginary, a) if self.unit(a).is_some() => {
                let unit = self.unit(a);
                quote!(#unit.imaginary())
            }
            Node::Map(map, a) => self.function(
                match map {
                    Map::Rotation if expr::is_motion(self.symbols, a) => "motion_rotation",
                    Map::Translation => "motion_translation",
                    Map::Twist => "twist",
                    Map::Diagonal => "diagonal",
                    Map::DiagonalOf => "diagonal_of",
                    Map::Real => "quaternion_real",
                    Map::Imaginary => "quaternion_imaginary",
                    Map::Pure => "pure_quaternion",
                    Map::Rotation => "quaternion_rotation",
                },
                a,
            ),
            Node::Given(a) => self.functional(a, None),
            Node::PullBack(a, which, seed) => self.functional(a, Some((*which, seed))),
        }
    }

    /// A unit quaternion as four numbers, or the one from such a quaternion to another.
    pub(super) fn unit(&self, a: &Expr) -> Option<TokenStream> {
        let bound = |e: &Expr| match e.node() {
            Node::Letter(l) => self.bindings.quaternion(*l),
            _ => None,
        };
        if let Some(local) = bound(a) {
            return Some(quote!(#local));
        }
        let Node::Product(two) = a.node() else {
            return None;
        };
        match two.as_slice() {
            [from, to] => match from.node() {
                Node::Transpose(from) => {
                    let (from, to) = (bound(from)?, bound(to)?);
                    Some(quote!(line::between(&#from, &#to)))
                }
                _ => None,
            },
            _ => None,
        }
    }

    fn turn(&self, a: &Expr) -> Option<&Ident> {
        match a.node() {
            Node::Letter(l) => self.bindings.rotation(*l),
            _ => None,
        }
    }

    pub(super) fn by_reference(&self, e: &Expr) -> TokenStream {
        let tokens = self.operand(e);
        quote!(&#tokens)
    }

    pub(super) fn function(&self, name: &str, a: &Expr) -> TokenStream {
        let name = format_ident!("{name}");
        let a = self.by_reference(a);
        quote!(#name(#a))
    }

    fn method(&self, a: &Expr, name: &str, b: &Expr) -> TokenStream {
        let name = format_ident!("{name}");
        let (a, b) = (self.operand(a), self.by_reference(b));
        quote!(#a.#name(#b))
    }

    /// Whether this is a diagonal matrix by its declaration.
    pub(super) fn is_diagonal(&self, e: &Expr) -> bool {
        match e.node() {
            Node::Letter(at) => self.symbols.get(at.symbol).structure == Structure::Diagonal,
            _ => false,
        }
    }

    /// `tr(A) Id - A` in three dimensions.
    fn complement(&self, terms: &[Expr]) -> Option<TokenStream> {
        let [trace, subtracted] = terms else {
            return None;
        };
        let (Node::Product(factors), Node::Neg(a)) = (trace.node(), subtracted.node()) else {
            return None;
        };
        let [number, identity] = factors.as_slice() else {
            return None;
        };
        let (Node::Trace(x), Node::Identity(Dim::Fixed(3))) = (number.node(), identity.node())
        else {
            return None;
        };
        // The trace of the transpose is the same.
        (a == x || *a == expr::transpose(self.symbols, x.clone()))
            .then(|| self.function("trace_complement", a))
    }

    /// `Ω - Id` or `Id - Ω` among the terms of a sum, for what keeps lengths, and `re(W) - 1`: whether
    /// it is subtracted, where the two terms are, and the difference.
    fn difference(&self, terms: &[&Expr]) -> Option<(bool, (usize, usize), TokenStream)> {
        let plain = |e: &Expr| match e.node() {
            Node::Neg(a) => (true, a.clone()),
            _ => (false, e.clone()),
        };
        terms.iter().enumerate().find_map(|(i, t)| {
            let (minus, moving) = plain(t);
            let rest = schedule::at_rest(self.symbols, &moving)?;
            let opposite = match minus {
                true => rest,
                false => expr::neg(rest),
            };
            let j = terms.iter().position(|t| **t == opposite)?;
            let tokens = match moving.node() {
                Node::Map(Map::Real, a) => {
                    let moved = self.function("less_identity", a);
                    quote!(quaternion_real(&#moved))
                }
                _ => self.function("less_identity", &moving),
            };
            Some((minus, (i, j), tokens))
        })
    }

    fn sum(&self, terms: &[Expr]) -> TokenStream {
        if let Some(complement) = self.complement(terms) {
            return complement;
        }
        // A leading minus sign costs an operation and reads badly: start with a positive term.
        let first = terms
            .iter()
            .position(|t| !matches!(t.node(), Node::Neg(_)))
            .unwrap_or(0);
        let mut order: Vec<&Expr> = vec![&terms[first]];
        order.extend(
            terms
                .iter()
                .enumerate()
                .filter(|(i, _)| *i != first)
                .map(|(_, t)| t),
        );
        let mut out = TokenStream::new();
        // Differences from rest, which keep their digits only together.
        let mut started = false;
        while let Some((minus, at, difference)) = self.difference(&order) {
            out.extend(match (minus, started) {
                (true, _) => quote!(- #difference),
                (false, true) => quote!(+ #difference),
                (false, false) => difference,
            });
            started = true;
            let (a, b) = at;
            order.remove(a.max(b));
            order.remove(a.min(b));
        }
        for (i, t) in order.into_iter().enumerate() {
            let i = i + usize::from(started);
            match t.node() {
                Node::Neg(a) if i > 0 => {
                    let a = self.term(a);
                    out.extend(quote!(- #a));
                }
                _ => {
                    let a = self.term(t);
                    out.extend(if i > 0 { quote!(+ #a) } else { a });
                }
            }
        }
        out
    }

    /// Products and quotients need no parentheses inside a sum.
    fn term(&self, e: &Expr) -> TokenStream {
        match e.node() {
            Node::Product(_) | Node::Quotient(..) | Node::Power(..) => self.write(e),
            _ => self.operand(e),
        }
    }

    fn power(&self, a: &Expr, q: Rational) -> TokenStream {
        let base = self.operand(a);
        if q == Rational::integer(2) {
            return quote!(#base * #base);
        }
        if q == Rational::HALF {
            return quote!(#base.sqrt());
        }
        if let Some(n) = q.as_integer() {
            let n = Literal::i32_unsuffixed(n);
            return quote!(#base.powi(#n));
        }
        let num = Literal::i64_unsuffixed(i64::try_from(q.numerator()).unwrap_or(0));
        let den = Literal::i64_unsuffixed(i64::try_from(q.denominator()).unwrap_or(0));
        quote!(#base.powr(#num, #den))
    }
}

/// The statements of a program and the expressions of its results.
pub fn program(p: &Program, bindings: &Bindings) -> (TokenStream, Vec<TokenStream>) {
    let writer = Writer {
        symbols: &p.symbols,
        bindings,
    };
    let mut lets = TokenStream::new();
    for (id, e) in &p.temporaries {
        let name = variable(&p.symbols, *id);
        let value = writer.write(e);
        lets.extend(quote!(let #name = #value;));
    }
    (lets, p.results.iter().map(|r| writer.write(r)).collect())
}
