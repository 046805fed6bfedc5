//! Named sizes of matrices (`dim n in 3..=8`) as const parameters of the emitted items. Takes the model's dimensions;
//! gives the generic parameters of every item, and sizes as tokens.

use crate::derive::Derivation;
use crate::expr::shape::Dim;
use crate::expr::symbol::Symbols;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The const parameter of a named dimension: its name in capitals (`n` becomes `N`), made distinct from the type
/// parameter `T` and from the parameters of earlier dimensions.
pub fn constant(s: &Symbols, index: u16) -> Ident {
    let mut taken = vec!["T".to_owned(), "Self".to_owned()];
    for i in 0..=index {
        let text = crate::expr::symbol::ascii(&s.dim_text(Dim::Named(i))).to_uppercase();
        let mut name = text;
        while taken.contains(&name) {
            name.push('_');
        }
        taken.push(name);
    }
    format_ident!("{}", taken.pop().unwrap_or_default())
}

/// The const parameters of all named dimensions, in order.
pub fn constants(s: &Symbols) -> Vec<Ident> {
    (0..s.dim_count()).map(|i| constant(s, i)).collect()
}

/// A size as tokens: a number, or a const parameter.
pub fn size(s: &Symbols, d: Dim) -> TokenStream {
    match d {
        Dim::Fixed(n) => {
            let n = Literal::usize_unsuffixed(n as usize);
            quote!(#n)
        }
        Dim::Named(i) => {
            let name = constant(s, i);
            quote!(#name)
        }
    }
}

/// The generic parameters of the emitted items.
pub struct Generics {
    constants: Vec<Ident>,
}

impl Generics {
    /// The parameters of a model.
    pub fn of(d: &Derivation) -> Generics {
        Generics {
            constants: constants(&d.letters.symbols),
        }
    }

    /// In the declaration of a struct: `<const N: usize, T = f64>`.
    pub fn declared(&self) -> TokenStream {
        let list = &self.constants;
        quote!(<#(const #list: usize,)* T = f64>)
    }

    /// In an `impl`: `<const N: usize, T: Real>`.
    pub fn bound(&self) -> TokenStream {
        let list = &self.constants;
        quote!(<#(const #list: usize,)* T: Real>)
    }

    /// As arguments of a type: `<N, T>`.
    pub fn used(&self) -> TokenStream {
        let list = &self.constants;
        quote!(<#(#list,)* T>)
    }

    /// As arguments of a type over another scalar: `<N, U>`.
    pub fn used_over_tokens(&self, scalar: &TokenStream) -> TokenStream {
        let list = &self.constants;
        quote!(<#(#list,)* #scalar>)
    }

    /// In an `impl` over `f64`: `<const N: usize>`, or empty.
    pub fn sizes_bound(&self) -> TokenStream {
        let list = &self.constants;
        match list.is_empty() {
            true => TokenStream::new(),
            false => quote!(<#(const #list: usize),*>),
        }
    }

    /// As arguments of a type over `f64`: `<N, f64>`.
    pub fn plain(&self) -> TokenStream {
        let list = &self.constants;
        quote!(<#(#list,)* f64>)
    }
}
