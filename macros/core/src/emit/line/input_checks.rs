//! Tests of other inputs than parameters and initial data: assumptions, parameters of end conditions, offsets, and
//! whether the chain has all sites that its end conditions use.

use super::Lines;
use super::ends::{end_local, pattern};
use crate::emit::expression::Bindings;
use crate::emit::items::{admitted, holds};
use crate::expr;
use crate::lattice::Sites;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

impl Lines<'_> {
    /// Tests of assumptions on parameters that are equal at all sites.
    pub(super) fn assumptions(&self) -> TokenStream {
        let d = &self.line.representative.d;
        let s = &d.letters.symbols;
        let mut out = TokenStream::new();
        for a in &d.spec.assumptions {
            let mut bindings = Bindings::new();
            let mut lets = TokenStream::new();
            let letters = [&a.left, &a.right].into_iter().flat_map(expr::letters);
            for letter in letters {
                let own = &s.get(letter.symbol).name;
                let (field, local) = (format_ident!("{own}"), format_ident!("__{own}"));
                lets.extend(quote!(let #local = model.parameters.#field;));
                bindings.bind(letter, local);
            }
            let test = holds(s, &d.spec.time_index, a, &bindings);
            out.extend(quote!({ #lets #test }));
        }
        out
    }

    /// Tests of the parameters of end conditions, of offsets, and of the length of the chain.
    pub(super) fn ends_given(&self) -> TokenStream {
        let ends = self.item("Ends");
        let mut out = TokenStream::new();
        for last in [false, true] {
            let Some((ty, alternatives)) = self.alternatives(last) else {
                continue;
            };
            let field = if last { quote!(last) } else { quote!(first) };
            for (which, a) in alternatives.iter().enumerate() {
                let tests = a.parameters.iter().map(|p| {
                    let (name, local) = (p.name.to_string(), end_local(&p.name.to_string()));
                    admitted(&name, p.shape, p.structure, &quote!(#local))
                });
                let tests: Vec<TokenStream> = tests.collect();
                let long = self.long_enough(last, which);
                if tests.is_empty() && long.is_empty() {
                    continue;
                }
                let pattern = pattern(&ty, a);
                out.extend(quote! {
                    if let #ends::Open { #field: #pattern, .. } = model.sites.ends {
                        #(#tests)*
                        #long
                    }
                });
            }
        }
        let offsets = self.offsets();
        if self.line.lattice.periodic.is_some() && !offsets.is_empty() {
            let names: Vec<String> = offsets.iter().map(|(n, _)| n.clone()).collect();
            let pattern = self.ring_pattern(&names);
            let tests = offsets.iter().map(|(name, m)| {
                let local = end_local(name);
                match m.is_number() {
                    true => quote!(validate::finite(#name, &[#local])?;),
                    false => quote!(validate::finite(#name, #local.as_slice())?;),
                }
            });
            out.extend(quote! {
                if let #pattern = model.sites.ends {
                    #(#tests)*
                }
            });
        }
        out
    }

    /// Tests that the chain has all sites that an end condition uses.
    fn long_enough(&self, last: bool, which: usize) -> TokenStream {
        let all = self.line.ends.iter();
        let own = all.filter(|e| e.last == last && e.which == which);
        let letters = own.flat_map(|e| &e.letters);
        let mut out = TokenStream::new();
        for (_, of, site) in letters {
            let label = self.line.lattice.find(of).and_then(|q| {
                let label = self.line.lattice.labels.get(q.label)?;
                Some((label, q.sites))
            });
            let (Some(site @ 1..), Some((label, sites))) = (site, label) else {
                continue;
            };
            let (count, text) = (format_ident!("{}", label.count.text), &label.count.text);
            let least = super::number(site + usize::from(sites != Sites::Nodes));
            out.extend(quote!(line::count_of(#text, model.sites.#count, #least)?;));
        }
        out
    }
}
