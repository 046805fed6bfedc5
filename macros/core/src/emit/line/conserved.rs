//! Conserved totals of a chain: sums of densities over sites. Takes the totals; gives one function per name. If end
//! conditions prescribe positions, the sum may differ, and the function selects it by the ends.

use super::locals::{Places, QuaternionUse, StatedLetter};
use super::neighbour_forces::stated_letters;
use super::{Lines, Moving, number};
use crate::emit::element;
use crate::line::{Density, Total};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The functions.
pub(super) fn totals(l: &Lines) -> TokenStream {
    let all = &l.line.totals;
    let is_first = |i: usize| !all[..i].iter().any(|t| t.name == all[i].name);
    let firsts = (0..all.len()).filter(|i| is_first(*i));
    firsts
        .map(|i| function(l, &all[i], &all[i + 1..]))
        .collect()
}

/// The function of a total, and of the totals of the same name for other end conditions.
fn function(l: &Lines, t: &Total, rest: &[Total]) -> TokenStream {
    let s = &l.line.representative.d.letters.symbols;
    let (method, state) = (format_ident!("{}", t.name), l.item("State"));
    let output = crate::emit::expression::ty(s, t.shape());
    let mut docs = vec![format!(" Conserved {}: {}.", t.on, t.reason)];
    let mut body = sum(l, t);
    for other in rest.iter().filter(|o| o.name == t.name) {
        let (is_so, own) = (held_as(l, other), sum(l, other));
        docs.push(String::new());
        docs.push(format!(" Conserved {}: {}.", other.on, other.reason));
        body = quote!(if #is_so { #own } else { #body });
    }
    quote! {
        #(#[doc = #docs])*
        pub fn #method(&self, state: &#state<T>) -> #output {
            let (at, momenta) = (&state.places, &state.momenta);
            let _ = at;
            #body
        }
    }
}

/// Tests whether the end conditions agree with those of a total.
fn held_as(l: &Lines, t: &Total) -> TokenStream {
    let ends = l.item("Ends");
    let fields = [false, true].into_iter().filter_map(|last| {
        let (ty, alternatives) = l.alternatives(last)?;
        let own = t.ends[usize::from(last)].iter();
        let variants = own.filter_map(|i| alternatives.get(*i)).map(|a| {
            let variant = &a.variant;
            match a.parameters.is_empty() {
                true => quote!(#ty::#variant),
                false => quote!(#ty::#variant { .. }),
            }
        });
        let field = if last { quote!(last) } else { quote!(first) };
        Some(quote!(#field: #(#variants)|*))
    });
    quote!(matches!(self.sites.ends, #ends::Open { #(#fields),*, .. }))
}

/// The sum of all densities.
fn sum(l: &Lines, t: &Total) -> TokenStream {
    let parts = t.densities.iter().map(|d| over_sites(l, t, d));
    quote!(#(#parts)+*)
}

/// The sum of one density.
fn over_sites(l: &Lines, t: &Total, density: &Density) -> TokenStream {
    let part = &l.line.representative;
    let s = &part.d.letters.symbols;
    let value = part.d.defined(&density.value);
    let values = [value.clone()];
    let (held, letters): (Vec<StatedLetter>, Vec<StatedLetter>) = stated_letters(l, &values)
        .into_iter()
        .partition(|k| t.places.iter().any(|(place, _)| *place == k.letter));
    let (momenta, letters): (Vec<_>, Vec<_>) = letters.into_iter().partition(|k| {
        part.sited(k.letter.symbol)
            .is_some_and(|x| x.momentum_of().is_some())
    });
    let places = Places::of_node();
    let (mut locals, mut bindings) = l.locals(s, &letters, &places, &quote!(site));
    for k in held {
        let place = t.places.iter().find(|(place, _)| *place == k.letter);
        let last = place.is_some_and(|(_, last)| *last);
        let name = if last { "last" } else { "first" };
        let at = super::ends::place(l, last, &k.of, 0);
        let one = (
            k.letter,
            k.of.as_str(),
            QuaternionUse::of(s, k.letter, &values),
        );
        locals.extend(super::ends::held_at(l, s, one, &at, name, &mut bindings));
    }
    let moving: Vec<Moving> = l.moving().collect();
    for k in momenta {
        let Some(of) = part.sited(k.letter.symbol) else {
            continue;
        };
        let Some(m) = moving.iter().find(|m| m.mover.name == of.plain()) else {
            continue;
        };
        let c = &m.d().spec.configurations[m.mover.index];
        let local = format_ident!("momentum_{}", m.mover.name);
        let value = element::value(c, super::energy::momentum(m, &quote!(site)));
        locals.extend(quote!(let #local = #value;));
        bindings.bind(k.letter, local);
    }
    let (lets, results) = l.program(s, &values, &bindings);
    let all = l.count(density.label, density.sites);
    let [first, last] = density.left_out;
    let count = match first + last {
        0 => all,
        out => {
            let out = number(out);
            quote!(#all.saturating_sub(#out))
        }
    };
    let site = match first {
        0 => TokenStream::new(),
        by => {
            let by = number(by);
            quote!(let site = site + #by;)
        }
    };
    let sum = match value.shape().is_scalar() {
        true => quote!(sum),
        false => quote!(total),
    };
    quote!(line::#sum(#count, |site| { #site #locals #lets #(#results)* }))
}
