//! Loops that process several sites together: the windows of the lists that a kernel reads, which extend to the
//! farthest neighbour, and the value of one site.

use super::arguments::Argument;
use super::number;
use crate::expr::{Expr, Function, Node};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// Whether the values of several sites are computed together. Calls of a mathematical library are made one after the
/// other, and vector registers would have to be saved around each call.
pub(super) fn are_together(values: &[Expr]) -> bool {
    values.iter().all(is_free_of_calls)
}

fn is_free_of_calls(e: &Expr) -> bool {
    let own = match e.node() {
        Node::Call(function, _) => matches!(function, Function::Abs | Function::Sign),
        Node::Power(_, exponent) => matches!(exponent.denominator(), 1 | 2),
        _ => true,
    };
    own && e.children().into_iter().all(is_free_of_calls)
}

/// Windows of lists.
#[derive(Default)]
pub(super) struct Windows {
    all: Vec<(Ident, TokenStream, usize)>,
}

impl Windows {
    /// The windows of the arguments of a kernel.
    pub(super) fn of(arguments: &[Argument]) -> Windows {
        let mut windows = Windows::default();
        for one in arguments {
            windows.add(one.window(), one.list(), one.on);
        }
        windows
    }

    /// Adds a list that is read up to `on` sites after the kernel's own.
    pub(super) fn add(&mut self, name: Ident, list: TokenStream, on: usize) {
        match self.all.iter_mut().find(|(known, ..)| *known == name) {
            Some((.., farthest)) => *farthest = on.max(*farthest),
            None => self.all.push((name, list, on)),
        }
    }

    /// The windows in the syntax of the runtime's `in_lanes!`: each with the number of sites beyond the computed
    /// ones.
    pub(super) fn stated(&self) -> TokenStream {
        let each = self.all.iter().map(|(name, list, on)| {
            let on = number(*on);
            quote!(#name: #on = #list)
        });
        quote!({ #(#each),* })
    }
}
