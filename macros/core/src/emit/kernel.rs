//! Kernels as Rust code: named values become locals, all others are written where they are used. Matrices are those
//! of nalgebra and are passed by value.

use super::expression::number;
use super::names::local_name;
use super::sizes::size;
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::Symbols;
use clebsch_program::{Call, Form, Kernel, Operation, Pair, Single, Value};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The precedence of an expression. An operand of lower precedence gets parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// A sum.
    Sum,
    /// A product.
    Product,
    /// A negation.
    Prefix,
    /// A call, a name or an entry.
    Atom,
}

/// Prints one kernel.
pub struct Printer<'a> {
    /// The model's symbols, for the names of sizes and functionals.
    pub symbols: &'a Symbols,
    /// The kernel.
    pub kernel: &'a Kernel,
}

impl Printer<'_> {
    /// The named values, in order.
    pub fn lets(&self) -> TokenStream {
        let mut lets = TokenStream::new();
        for (at, line) in self.kernel.values() {
            if let Some(name) = &line.name {
                let (name, value) = (format_ident!("{name}"), self.made(at).0);
                lets.extend(quote!(let #name = #value;));
            }
        }
        lets
    }

    /// The value as an expression of at least the precedence `wanted`.
    pub fn at(&self, v: Value, wanted: Level) -> TokenStream {
        let (tokens, level) = match &self.kernel.line(v).name {
            Some(name) => {
                let name = format_ident!("{name}");
                (quote!(#name), Level::Atom)
            }
            None => self.made(v),
        };
        match level < wanted {
            true => quote!((#tokens)),
            false => tokens,
        }
    }

    fn reference(&self, v: Value) -> TokenStream {
        let value = self.at(v, Level::Atom);
        quote!(&#value)
    }

    /// The operation of a value, and its precedence.
    fn made(&self, v: Value) -> (TokenStream, Level) {
        let line = self.kernel.line(v);
        let dims = |shape: Shape| {
            (
                size(self.symbols, shape.rows),
                size(self.symbols, shape.cols),
            )
        };
        let literal = Literal::usize_unsuffixed;
        let tokens = match &line.operation {
            Operation::Input(at) => {
                let name: Ident = format_ident!("{}", self.kernel.inputs()[*at].name);
                quote!(#name)
            }
            Operation::Number(n) => number(*n),
            Operation::Identity(shape) => {
                let (rows, cols) = dims(*shape);
                quote!(SMatrix::<T, #rows, #cols>::identity())
            }
            Operation::Zero(shape) => {
                let (rows, cols) = dims(*shape);
                quote!(SMatrix::<T, #rows, #cols>::zeros())
            }
            Operation::Unit(dim, axis) => {
                let (rows, axis) = (size(self.symbols, *dim), literal(*axis));
                quote!(unit::<T, #rows>(#axis))
            }
            Operation::Inclusion(shape, at) => {
                let ((rows, cols), at) = (dims(*shape), literal(*at));
                quote!(inclusion::<T, #rows, #cols>(#at))
            }
            Operation::One(single, a) => return self.single(*single, *a),
            Operation::Two(pair, a, b) => return self.pair(*pair, *a, *b),
            Operation::Power(a, n) => {
                let (a, n) = (self.at(*a, Level::Atom), Literal::i32_unsuffixed(*n));
                quote!(#a.powi(#n))
            }
            Operation::Root(a, num, den) => {
                let a = self.at(*a, Level::Atom);
                let (num, den) = (Literal::i64_unsuffixed(*num), Literal::i64_unsuffixed(*den));
                quote!(#a.powr(#num, #den))
            }
            Operation::Entry(a, row) => {
                let (a, row) = (self.at(*a, Level::Atom), literal(*row));
                quote!(#a[#row])
            }
            Operation::EntryAt(a, row, col) => {
                let (a, row, col) = (self.at(*a, Level::Atom), literal(*row), literal(*col));
                quote!(#a[(#row, #col)])
            }
            Operation::RowsFrom(a, whole, at) => {
                self.taken("rows_from", *a, *whole, *at, |s| s.cols)
            }
            Operation::IntoRows(a, whole, at) => {
                self.taken("into_rows", *a, *whole, *at, |s| s.cols)
            }
            Operation::ColumnsFrom(a, whole, at) => {
                self.taken("columns_from", *a, *whole, *at, |s| s.rows)
            }
            Operation::IntoColumns(a, whole, at) => {
                self.taken("into_columns", *a, *whole, *at, |s| s.rows)
            }
            Operation::Functional(call) => self.functional(call),
        };
        (tokens, Level::Atom)
    }

    fn single(&self, single: Single, a: Value) -> (TokenStream, Level) {
        match single.form() {
            Form::Prefix => {
                let a = self.at(a, Level::Prefix);
                (quote!(-#a), Level::Prefix)
            }
            Form::Method => {
                let (name, a) = (format_ident!("{}", single.word()), self.at(a, Level::Atom));
                (quote!(#a.#name()), Level::Atom)
            }
            Form::Function => {
                let (name, a) = (format_ident!("{}", single.word()), self.reference(a));
                (quote!(#name(#a)), Level::Atom)
            }
        }
    }

    fn pair(&self, pair: Pair, a: Value, b: Value) -> (TokenStream, Level) {
        let sides = |level, next| (self.at(a, level), self.at(b, next));
        match pair {
            Pair::Add => {
                let (a, b) = sides(Level::Sum, Level::Product);
                (quote!(#a + #b), Level::Sum)
            }
            Pair::Sub => {
                let (a, b) = sides(Level::Sum, Level::Product);
                (quote!(#a - #b), Level::Sum)
            }
            Pair::Mul => {
                let (a, b) = sides(Level::Product, Level::Prefix);
                (quote!(#a * #b), Level::Product)
            }
            Pair::Div => {
                let (a, b) = sides(Level::Product, Level::Prefix);
                (quote!(#a / #b), Level::Product)
            }
            Pair::TransposedMul | Pair::Dot | Pair::Cross => {
                let (a, b) = (self.at(a, Level::Atom), self.reference(b));
                let name = format_ident!("{}", pair.word());
                (quote!(#a.#name(#b)), Level::Atom)
            }
            Pair::Crossed | Pair::Crossing | Pair::DiagonalTimes | Pair::TimesDiagonal => {
                let (a, b) = (self.reference(a), self.reference(b));
                let name = format_ident!("{}", pair.word());
                (quote!(#name(#a, #b)), Level::Atom)
            }
            Pair::Between => {
                let (a, b) = (self.reference(a), self.reference(b));
                (quote!(line::between(#a, #b)), Level::Atom)
            }
        }
    }

    /// Rows or columns that are extracted from a matrix or inserted into a larger one. `own` selects the size of the
    /// part.
    fn taken(
        &self,
        name: &str,
        a: Value,
        whole: Shape,
        at: usize,
        own: impl Fn(Shape) -> Dim,
    ) -> TokenStream {
        let name = format_ident!("{name}");
        let kept = size(self.symbols, own(self.kernel.line(a).kind.shape()));
        let (rows, cols) = (
            size(self.symbols, whole.rows),
            size(self.symbols, whole.cols),
        );
        let (a, at) = (self.reference(a), Literal::usize_unsuffixed(at));
        quote!(#name::<T, #rows, #cols, #kept>(#a, #at))
    }

    /// A functional as a call of a method of its type: `f.value(&x, &y)`, `f.along_1(&x, &y, &u)` and
    /// `f.pull_back_1(&x, &y, &s)`. Arguments are counted from 1. Each derivative has its own method because
    /// directions and seeds have different types.
    fn functional(&self, call: &Call) -> TokenStream {
        let s = self.symbols;
        let f = local_name(s, &s.functionals()[call.functional].name);
        let mut words: Vec<String> = Vec::new();
        if let Some(which) = call.back {
            words.push(format!("pull_back_{}", u32::from(which) + 1));
        }
        let along: Vec<String> = call
            .along
            .iter()
            .map(|a| (u32::from(*a) + 1).to_string())
            .collect();
        if !along.is_empty() {
            words.push(format!("along_{}", along.join("_")));
        }
        let method = match words.is_empty() {
            true => format_ident!("value"),
            false => format_ident!("{}", words.join("_")),
        };
        let all = call.values.iter().map(|v| self.reference(*v));
        quote!(#f.#method(#(#all),*))
    }
}
