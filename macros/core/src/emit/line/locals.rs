//! The locals at the start of a kernel: the parameters and positions in its expressions.

use super::Lines;
use crate::derive::Outline;
use crate::emit::expression::{Bindings, program};
use crate::emit::names::variable;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Map, Node};
use crate::schedule;
use proc_macro2::TokenStream;
use quote::quote;

/// A letter as stated: its quantity, and the number of sites after the kernel's own.
pub(super) struct StatedLetter {
    pub letter: Letter,
    pub of: String,
    pub on: Option<usize>,
    pub stands: QuaternionUse,
}

/// How expressions use a unit quaternion.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct QuaternionUse {
    /// As a matrix of four rows.
    pub alone: bool,
    /// Through the rotation that it covers.
    pub turned: bool,
    /// Through its real and imaginary parts, or those of its relative quaternion to another.
    pub parted: bool,
}

impl QuaternionUse {
    /// How `list` uses a letter.
    pub(super) fn of(s: &Symbols, letter: Letter, list: &[Expr]) -> QuaternionUse {
        let mut out = QuaternionUse::default();
        list.iter().for_each(|e| out.look(s, letter, e));
        out
    }

    fn look(&mut self, s: &Symbols, letter: Letter, e: &Expr) {
        let is_own = |e: &Expr| matches!(e.node(), Node::Letter(l) if *l == letter);
        match e.node() {
            Node::Letter(_) => self.alone |= is_own(e),
            Node::Map(Map::Rotation, a) if is_own(a) => self.turned = true,
            Node::Map(Map::Real | Map::Imaginary, a) if is_own(a) => self.parted = true,
            Node::Map(Map::Real | Map::Imaginary, a) if is_between(s, a) => {
                self.parted |= expr::contains(a, letter);
            }
            _ => e.children().iter().for_each(|c| self.look(s, letter, c)),
        }
    }
}

/// Whether the expression is the relative quaternion `q^T p` of two configurations.
pub(super) fn is_between(s: &Symbols, e: &Expr) -> bool {
    let Node::Product(two) = e.node() else {
        return false;
    };
    let [a, b] = two.as_slice() else {
        return false;
    };
    let Node::Transpose(a) = a.node() else {
        return false;
    };
    let moves = |e: &Expr| match e.node() {
        Node::Letter(l) => {
            let symbol = s.get(l.symbol);
            symbol.structure == Structure::UnitQuaternion && symbol.role == Role::Element
        }
        _ => false,
    };
    moves(a) && moves(b) && a != b
}

/// The lists of positions at the node and at the next node.
pub(super) struct Places {
    pub here: TokenStream,
    pub next: TokenStream,
}

impl Places {
    /// The positions of one node, in the argument `at` of a kernel.
    pub(super) fn of_node() -> Places {
        let (here, next) = (quote!(at), quote!(at));
        Places { here, next }
    }
}

impl Lines<'_> {
    /// Expressions of values at one node: the statements before them, and their values.
    pub(super) fn computed(
        &self,
        s: &Symbols,
        letters: &[StatedLetter],
        values: &[Expr],
    ) -> (TokenStream, Vec<TokenStream>) {
        let (locals, bindings) = self.locals(s, letters, &Places::of_node(), &quote!(site));
        let (lets, values) = self.program(s, values, &bindings);
        (quote!(#locals #lets), values)
    }

    /// Expressions whose letters are bound: the statements of their temporaries, and their values.
    pub(super) fn program(
        &self,
        s: &Symbols,
        values: &[Expr],
        bindings: &Bindings,
    ) -> (TokenStream, Vec<TokenStream>) {
        program(&schedule::program(s, values, &self.temporary), bindings)
    }

    /// `let` statements for letters, and their bindings. `site` is the index of the kernel.
    pub(super) fn locals(
        &self,
        s: &Symbols,
        letters: &[StatedLetter],
        places: &Places,
        site: &TokenStream,
    ) -> (TokenStream, Bindings) {
        let read = self.read(s, letters);
        let mut out = read.lets;
        for one in &read.arguments {
            let (name, value) = (&one.name, one.value(places, site));
            out.extend(quote!(let #name = #value;));
        }
        (out, read.bindings)
    }

    /// The letters of expressions of one site.
    pub(super) fn of_site(&self, d: &Outline, list: &[Expr]) -> Vec<StatedLetter> {
        let s = &d.letters.symbols;
        let letters = crate::emit::items::letters_of(list);
        let known = letters.into_iter().map(|letter| {
            let of = s.get(letter.symbol).name.clone();
            let on = self.line.lattice.find(&of).map(|_| 0);
            let stands = QuaternionUse::of(s, letter, list);
            StatedLetter {
                letter,
                of,
                on,
                stands,
            }
        });
        known.collect()
    }
}

/// The step size as a local.
pub(super) fn step(d: &Outline) -> proc_macro2::Ident {
    variable(&d.letters.symbols, d.spec.step)
}
