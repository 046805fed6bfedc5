//! The forces of end conditions. They are added to the neighbour forces of the sites at the ends.

use super::items::End;
use super::locals::{Places, QuaternionUse, StatedLetter};
use super::neighbour_forces::{computed, field, front};
use super::{Lines, number};
use crate::algebra::Algebra;
use crate::emit::expression::Bindings;
use crate::emit::items::letters_of;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter};
use crate::line::EndTerm;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// Calls `body` for every end condition with a force, and selects its result if that condition applies.
fn each_end(
    l: &Lines,
    body: &mut dyn FnMut(&EndTerm) -> Option<TokenStream>,
) -> Option<TokenStream> {
    let ends = l.item("Ends");
    let mut out = TokenStream::new();
    for last in [false, true] {
        let Some((ty, alternatives)) = l.alternatives(last) else {
            continue;
        };
        for end in l.line.ends.iter().filter(|e| e.last == last) {
            let pattern = pattern(&ty, alternatives.get(end.which)?);
            let body = body(end)?;
            let field = if last { quote!(last) } else { quote!(first) };
            out.extend(quote! {
                if let #ends::Open { #field: #pattern, .. } = self.sites.ends {
                    #body
                }
            });
        }
    }
    Some(out)
}

/// The pattern of an end condition, which binds its parameters to locals.
pub(super) fn pattern(ty: &Ident, end: &End) -> TokenStream {
    let variant = &end.variant;
    let fields = end.parameters.iter().map(|p| {
        let (name, local) = (&p.name, end_local(&p.name.to_string()));
        quote!(#name: #local)
    });
    match end.parameters.is_empty() {
        true => quote!(#ty::#variant),
        false => quote!(#ty::#variant { #(#fields),* }),
    }
}

/// The local of a parameter of an end condition. No name of a model starts with `__`.
pub(super) fn end_local(name: &str) -> Ident {
    format_ident!("__end_{name}")
}

/// The function that adds the forces of end conditions.
pub(super) fn ends(l: &Lines) -> TokenStream {
    let (places, pulls) = (l.item("Places"), l.item("Pulls"));
    let step = super::locals::step(&l.line.representative.d);
    let out = each_end(l, &mut |end| Some(added(l, end))).unwrap_or_default();
    quote! {
        /// The contributions of the end conditions at these positions.
        #[inline]
        fn ended(&self, #step: T, at: &#places<T>, pulls: &mut #pulls<T>) {
            let _ = (#step, at, &pulls);
            #out
        }
    }
}

/// The function of the potential energy of end conditions. None if an energy depends on the step size.
pub(super) fn energies(l: &Lines) -> Option<TokenStream> {
    let places = l.item("Places");
    let out = each_end(l, &mut |end| {
        let s = &end.symbols;
        let step = s.ids().find(|id| s.get(*id).role == Role::Step)?;
        let h = expr::here(s, step);
        let energy = expr::neg(expr::quotient(end.terms.clone(), h.clone()));
        let algebra = Algebra::new(s);
        let energy = super::energy::without_step(&algebra, &energy, &h)?;
        let (lets, values) = values(l, end, &[energy]);
        Some(quote! {
            #lets
            energy += #(#values)*;
        })
    })?;
    Some(quote! {
        /// The potential energy of the end conditions.
        #[allow(unused_mut)]
        fn potential_of_ends(&self, at: &#places<T>) -> T {
            let _ = at;
            let mut energy = T::zero();
            #out
            energy
        }
    })
}

/// The index of a site, counted from an end.
pub(super) fn place(l: &Lines, last: bool, of: &str, from_end: usize) -> TokenStream {
    let n = number(from_end);
    match last {
        false => quote!(#n),
        true => {
            let count = l.count_of(of);
            quote!((#count - 1 - #n))
        }
    }
}

/// Expressions of an end condition: the statements before them, and their values.
fn values(l: &Lines, end: &EndTerm, values: &[Expr]) -> (TokenStream, Vec<TokenStream>) {
    let s = &end.symbols;
    let values: Vec<Expr> = values
        .iter()
        .map(|e| expr::quaternion_components(s, e))
        .collect();
    let values = values.as_slice();
    let mut locals = TokenStream::new();
    let mut bindings = Bindings::new();
    for letter in &letters_of(values) {
        let symbol = s.get(letter.symbol);
        if symbol.role == Role::Step {
            continue;
        }
        match end.letters.iter().find(|(known, ..)| known == letter) {
            // A parameter of the end condition, which the pattern binds.
            Some((_, of, None)) => bindings.bind(*letter, end_local(of)),
            Some((_, of, Some(site))) => {
                let at = place(l, end.last, of, *site);
                let stands = QuaternionUse::of(s, *letter, values);
                let one = (*letter, of.as_str(), stands);
                locals.extend(held_at(l, s, one, &at, &site.to_string(), &mut bindings));
            }
            None => {
                let own = &symbol.name;
                let (field, local) = (format_ident!("{own}"), format_ident!("__{own}"));
                locals.extend(quote!(let #local = self.parameters.#field;));
                bindings.bind(*letter, local);
            }
        }
    }
    let (lets, results) = computed(l, s, values, &bindings);
    (quote!(#locals #lets), results)
}

/// Locals for the values at one site of the chain; their names end in `name`.
pub(super) fn held_at(
    l: &Lines,
    s: &Symbols,
    (letter, of, stands): (Letter, &str, QuaternionUse),
    at: &TokenStream,
    name: &str,
    bindings: &mut Bindings,
) -> TokenStream {
    let mut locals = TokenStream::new();
    let bound = |stands: QuaternionUse| {
        let one = [StatedLetter {
            letter,
            of: of.to_owned(),
            on: Some(0),
            stands,
        }];
        l.locals(s, &one, &Places::of_node(), at)
    };
    let alone = stands.alone || stands.parted;
    let (lets, inner) = bound(QuaternionUse {
        turned: stands.turned,
        ..QuaternionUse::default()
    });
    if let Some(turn) = inner.rotation(letter) {
        let local = format_ident!("__{of}_{name}_turn");
        locals.extend(quote!(let #local = { #lets #turn };));
        bindings.bind_rotation(letter, local);
        if !alone {
            return locals;
        }
    }
    let (lets, inner) = bound(QuaternionUse {
        alone: true,
        ..QuaternionUse::default()
    });
    let (local, own) = (format_ident!("__{of}_{name}"), inner.local(s, letter));
    locals.extend(quote!(let #local = { #lets #own };));
    bindings.bind(letter, local);
    locals
}

fn added(l: &Lines, end: &EndTerm) -> TokenStream {
    let forces: Vec<Expr> = end.forces.iter().map(|f| f.value.clone()).collect();
    let (lets, results) = values(l, end, &forces);
    let moving: Vec<_> = l.moving().collect();
    let added = end.forces.iter().zip(results).map(|(f, value)| {
        let m = moving.iter().find(|m| m.mover.name == f.on);
        let value = m.map_or(value.clone(), |m| m.array(value));
        let slots = l.line.pulls.iter().enumerate();
        let mut slots = slots.filter_map(|(n, p)| {
            let own = p.forces.iter().find(|x| x.on == f.on)?;
            Some((
                format_ident!("pull_{}", n + 1),
                front(p) - own.site,
                own.site,
            ))
        });
        let Some((array, before, site)) = slots.next() else {
            return TokenStream::new();
        };
        let index = place(l, end.last, &f.on, f.site);
        let (before, name) = (number(before), field(&f.on, site));
        quote! {{
            let mut pull = pulls.#array.at(#index + #before);
            pull.#name += #value;
            pulls.#array.set(#index + #before, pull);
        }}
    });
    quote! {
        #lets
        #(#added)*
    }
}
