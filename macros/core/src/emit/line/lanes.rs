//! What a loop over sites computes of several sites together: the windows of lists that its kernel reads, as wide as its
//! neighbours are far, and the value of one site.

use super::arguments::Argument;
use super::number;
use crate::expr::{Expr, Function, Node};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

/// Whether values of several sites are computed together. What calls a function of the library of mathematics is computed one
/// after the other anyway, and wide registers would have to be put away around each call.
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
    /// Those of what a kernel reads.
    pub(super) fn of(arguments: &[Argument]) -> Windows {
        let mut windows = Windows::default();
        for one in arguments {
            windows.add(one.window(), one.list(), one.on);
        }
        windows
    }

    /// A list, read so many sites on from that of the kernel.
    pub(super) fn add(&mut self, name: Ident, list: TokenStream, on: usize) {
        match self.all.iter_mut().find(|(known, ..)| *known == name) {
            Some((.., farthest)) => *farthest = on.max(*farthest),
            None => self.all.push((name, list, on)),
        }
    }

    /// As the runtime's `in_lanes!` takes them: how many sites each is read beyond those that are computed.
    pub(super) fn stated(&self) -> TokenStream {
        let each = self.all.iter().map(|(name, list, on)| {
            let on = number(*on);
            quote!(#name: #on = #list)
        });
        quote!({ #(#each),* })
    }
}
