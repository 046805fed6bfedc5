//! Expressions and programs as Rust code, printed from their kernels: the locals of letters, types and numbers.

use super::kernel::{Level, Printer};
use super::names::variable;
use super::sizes::size;
use crate::algebra::Rational;
use crate::expr::shape::Shape;
use crate::expr::symbol::Symbols;
use crate::expr::{Expr, Letter};
use crate::lower::{self, Inputs, Quaternion};
use crate::schedule::Program;
use clebsch_program::Number;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The locals of letters.
#[derive(Clone, Default)]
pub struct Bindings {
    list: Vec<(Letter, Ident)>,
    rotations: Vec<(Letter, Ident)>,
    quaternions: Vec<(Letter, Ident)>,
}

impl Bindings {
    /// Empty bindings.
    pub fn new() -> Bindings {
        Bindings::default()
    }

    /// Adds or replaces a binding.
    pub fn bind(&mut self, letter: Letter, local: Ident) {
        self.list.retain(|(l, _)| *l != letter);
        self.list.push((letter, local));
    }

    /// Binds a local to the rotation that a unit quaternion covers.
    pub fn bind_rotation(&mut self, letter: Letter, local: Ident) {
        self.rotations.retain(|(l, _)| *l != letter);
        self.rotations.push((letter, local));
    }

    /// The local of that rotation, if bound.
    pub fn rotation(&self, letter: Letter) -> Option<&Ident> {
        let found = self.rotations.iter().find(|(l, _)| *l == letter);
        found.map(|(_, local)| local)
    }

    /// Binds a local to a unit quaternion as four numbers, its real and its imaginary part.
    pub fn bind_quaternion(&mut self, letter: Letter, local: Ident) {
        self.quaternions.retain(|(l, _)| *l != letter);
        self.quaternions.push((letter, local));
    }

    /// The local of the four numbers, if bound.
    pub fn quaternion(&self, letter: Letter) -> Option<&Ident> {
        let found = self.quaternions.iter().find(|(l, _)| *l == letter);
        found.map(|(_, local)| local)
    }

    /// The local of a letter.
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

/// A constant.
pub(super) fn number(n: Number) -> TokenStream {
    match n {
        Number::Ratio(num, den) => {
            let (num, den) = (Literal::i64_unsuffixed(num), Literal::i64_unsuffixed(den));
            quote!(T::from_ratio(#num, #den))
        }
        Number::Double(value) => {
            let value = Literal::f64_unsuffixed(value);
            quote!(T::from_f64(#value))
        }
        Number::Pi => quote!(T::from_f64(::core::f64::consts::PI)),
    }
}

/// An exact number.
pub fn rational(q: Rational) -> TokenStream {
    number(lower::number(q))
}

impl Inputs for Bindings {
    fn letter(&self, symbols: &Symbols, letter: Letter) -> String {
        self.local(symbols, letter).to_string()
    }

    fn rotation(&self, letter: Letter) -> Option<String> {
        self.rotation(letter).map(ToString::to_string)
    }

    fn quaternion(&self, letter: Letter) -> Option<String> {
        self.quaternion(letter).map(ToString::to_string)
    }
}

/// Prints expressions with one set of bindings.
pub struct Writer<'a> {
    /// The symbols.
    pub symbols: &'a Symbols,
    /// The locals of letters.
    pub bindings: &'a Bindings,
}

impl Writer<'_> {
    /// The expression as Rust code, with parentheses if an operand needs them.
    pub fn operand(&self, e: &Expr) -> TokenStream {
        self.at(e, Level::Atom)
    }

    /// The expression as Rust code.
    pub fn write(&self, e: &Expr) -> TokenStream {
        self.at(e, Level::Sum)
    }

    fn at(&self, e: &Expr, level: Level) -> TokenStream {
        let kernel = lower::expression(self.symbols, e, self.bindings).kernel;
        let printer = Printer {
            symbols: self.symbols,
            kernel: &kernel,
        };
        let outputs = kernel.outputs.iter();
        outputs.map(|v| printer.at(*v, level)).collect()
    }

    /// A unit quaternion as four numbers, or the quaternion that leads from one such quaternion to another.
    pub(super) fn unit(&self, a: &Expr) -> Option<TokenStream> {
        let named = |l: Letter| Inputs::quaternion(self.bindings, l);
        let local = |(_, name): (Letter, String)| format_ident!("{name}");
        Some(match lower::quaternion(a, &named)? {
            Quaternion::Own(l, name) => {
                let local = local((l, name));
                quote!(#local)
            }
            Quaternion::Between(from, to) => {
                let (from, to) = (local(from), local(to));
                quote!(line::between(&#from, &#to))
            }
        })
    }
}

/// The statements of a program and the expressions of its results.
pub fn program(p: &Program, bindings: &Bindings) -> (TokenStream, Vec<TokenStream>) {
    let name = |id| variable(&p.symbols, id).to_string();
    let kernel = lower::program(p, bindings, &name).kernel;
    let printer = Printer {
        symbols: &p.symbols,
        kernel: &kernel,
    };
    let results = kernel.outputs.iter();
    let results = results.map(|v| printer.at(*v, Level::Sum)).collect();
    (printer.lets(), results)
}
