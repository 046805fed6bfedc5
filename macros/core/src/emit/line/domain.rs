//! Domains that a step along a chain must not leave: the domains of functions, at every site and in every neighbour term.

use super::locals::{StatedLetter, step};
use super::neighbour_forces::{range_of, stated_letters};
use super::{Lines, number};
use crate::derive::{Derivation, Outline};
use crate::emit::domain::{Tested, tested};
use crate::emit::expression::Bindings;
use crate::expr::Expr;
use crate::line::{CoordinateKind, EndTerm, Line, SiteModel};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The guards on the terms of one loop.
struct LoopGuards {
    tests: Vec<Tested>,
    /// `let (first, last)`.
    range: TokenStream,
    /// The quantity in the error message.
    quantity: String,
    /// The locals and values of the arguments.
    body: (TokenStream, Vec<TokenStream>),
}

/// The reason why no loop over sites can test the domains of a model, if any.
pub(in crate::emit) fn refusal(line: &Line) -> Option<String> {
    let lone = line
        .lone
        .iter()
        .map(|x| asked_of(&x.outline, &lone_terms(x)));
    let part = &line.representative.d;
    let pulls = line
        .pulls
        .iter()
        .map(|p| asked_of(part, std::slice::from_ref(&p.terms)));
    let mut all = lone.chain(pulls);
    if all.any(|found| found.is_none()) {
        return Some("a function of velocities is not defined everywhere".to_owned());
    }
    let tied = |terms: &Expr| {
        let asked = asked_of(part, std::slice::from_ref(terms));
        asked.is_none_or(|list| list.iter().any(|t| !t.constant))
    };
    if line.ties.iter().any(|t| tied(&t.terms)) {
        return Some(
            "a term with velocities of neighbours contains a function that is not defined everywhere".to_owned(),
        );
    }
    let at_end = |e: &EndTerm| {
        let terms = std::slice::from_ref(&e.terms);
        let asked = tested(&e.symbols, &part.spec.time_index, terms);
        asked.is_none_or(|list| list.iter().any(|t| !t.constant))
    };
    let refused = line.ends.iter().any(at_end);
    refused
        .then(|| "a term of an end contains a function that is not defined everywhere".to_owned())
}

fn lone_terms(lone: &SiteModel) -> Vec<Expr> {
    let d: &Derivation = &lone.d;
    let definitions = d.spec.advected.iter().filter_map(|a| a.definition.clone());
    let terms = [d.action.edge.clone(), d.action.nodal.clone()];
    terms
        .into_iter()
        .chain(definitions)
        .map(|e| lone.outline.defined(&e))
        .collect()
}

fn asked_of(d: &Outline, list: &[Expr]) -> Option<Vec<Tested>> {
    tested(&d.letters.symbols, &d.spec.time_index, list)
}

fn asked(l: &Lines) -> Vec<LoopGuards> {
    let lone = l.line.lone.iter().filter_map(|lone| {
        let d = &lone.outline;
        let count = l.count(lone.label, lone.sites);
        let range = quote!(let (first, last) = (0, #count););
        let quantity = lone.movers.first()?.name.clone();
        let letters = |values: &[Expr]| l.of_site(d, values);
        one(l, d, &lone_terms(lone), range, quantity, &letters)
    });
    let d = &l.line.representative.d;
    let pulls = l.line.pulls.iter().filter_map(|pull| {
        let quantity = pull.forces.first()?.on.clone();
        let terms = std::slice::from_ref(&pull.terms);
        let letters = |values: &[Expr]| stated_letters(l, values);
        one(
            l,
            d,
            terms,
            range_of(l, pull.label, pull.from, pull.to),
            quantity,
            &letters,
        )
    });
    lone.chain(pulls).collect()
}

/// The guards on the terms of one loop at a node; None if there are none.
fn one(
    l: &Lines,
    d: &Outline,
    terms: &[Expr],
    range: TokenStream,
    quantity: String,
    letters: &dyn Fn(&[Expr]) -> Vec<StatedLetter>,
) -> Option<LoopGuards> {
    let mut tests = asked_of(d, terms).unwrap_or_default();
    tests.retain(|t| !t.constant);
    if tests.is_empty() {
        return None;
    }
    let values: Vec<Expr> = tests.iter().map(|t| t.argument.clone()).collect();
    let body = l.computed(&d.letters.symbols, &letters(&values), &values);
    Some(LoopGuards {
        tests,
        range,
        quantity,
        body,
    })
}

/// The kernels of the arguments, and the calls of the tests in a step.
pub(super) fn domain(l: &Lines) -> (TokenStream, TokenStream) {
    let (name, places) = (l.item(""), l.item("Places"));
    let h = step(&l.line.representative.d);
    let mut kernels = TokenStream::new();
    let mut calls = TokenStream::new();
    for (n, a) in asked(l).into_iter().enumerate() {
        let kernel = format_ident!("arguments_{}", n + 1);
        let count = number(a.tests.len());
        let (lets, values) = &a.body;
        kernels.extend(quote! {
            /// The arguments of functions that are not defined everywhere.
            #[inline(always)]
            fn #kernel(&self, #h: T, site: usize, at: &#places<T>) -> [T; #count] {
                let _ = #h;
                #lets
                [#(#values),*]
            }
        });
        let tests = a.tests.iter().enumerate().map(|(i, t)| {
            let (domain, call, i) = (&t.domain, &t.call, number(i));
            quote!(#domain.at_nodes(#call, from[#i], to[#i], h)?;)
        });
        let (range, quantity) = (&a.range, &a.quantity);
        calls.extend(quote! {{
            #range
            let inside = |i: usize| -> Result<(), domain::Contact> {
                let from = self.#kernel(h, i, &state.places);
                let to = self.#kernel(h, i, &work.places);
                #(#tests)*
                Ok(())
            };
            if let Err((site, contact)) = line::try_each(first, last, inside) {
                let at = line::Place { quantity: #quantity, site };
                return Err(self.refused(state, h, at, StepCause::Contact(contact)));
            }
        }});
    }
    for c in &l.line.coordinates {
        if let CoordinateKind::Entries(_) = c.by {
            calls.extend(invertible(l, &c.name));
        }
    }
    let kernels = (!kernels.is_empty()).then(|| quote!(impl<T: Real> #name<T> { #kernels }));
    (kernels.unwrap_or_default(), calls)
}

/// The test that a linear map stays invertible during a step.
fn invertible(l: &Lines, name: &str) -> TokenStream {
    let (field, count) = (format_ident!("{name}"), l.count_of(name));
    quote! {{
        let inside = |i: usize| -> Result<(), domain::Contact> {
            domain::field_invertible(
                #name,
                &Additive::new(state.places.#field[i]),
                &Additive::new(work.places.#field[i]),
                h,
            )
        };
        if let Err((site, contact)) = line::try_each(0, #count, inside) {
            let at = line::Place { quantity: #name, site };
            return Err(self.refused(state, h, at, StepCause::Contact(contact)));
        }
    }}
}

/// Tests of the functions whose arguments depend on parameters only. Parameters of sites are tested site by site.
pub(super) fn of_parameters(l: &Lines) -> TokenStream {
    let mut out = TokenStream::new();
    let mut seen: Vec<String> = Vec::new();
    let part = &l.line.representative.d;
    let mut each = |d: &Outline, list: &[Expr], of_site: bool| {
        for t in asked_of(d, list)
            .unwrap_or_default()
            .iter()
            .filter(|t| t.constant)
        {
            let one = std::slice::from_ref(&t.argument);
            let letters = match of_site {
                true => l.of_site(d, one),
                false => stated_letters(l, one),
            };
            if seen.contains(&t.text) || letters.iter().any(|k| k.on.is_some()) {
                continue;
            }
            seen.push(t.text.clone());
            let s = &d.letters.symbols;
            let mut bindings = Bindings::new();
            let lets = letters.iter().map(|k| {
                let field = format_ident!("{}", k.of);
                let local = format_ident!("__{}", k.of);
                bindings.bind(k.letter, local.clone());
                quote!(let #local = model.parameters.#field;)
            });
            let lets: Vec<TokenStream> = lets.collect();
            let (more, values) = l.program(s, one, &bindings);
            let (domain, function, text) = (&t.domain, &t.function, &t.text);
            out.extend(quote! {{
                #(#lets)*
                #more
                validate::inside(#domain, #function, #text, #(#values)*)?;
            }});
        }
    };
    for lone in &l.line.lone {
        each(&lone.outline, &lone_terms(lone), true);
    }
    for pull in &l.line.pulls {
        each(part, std::slice::from_ref(&pull.terms), false);
    }
    for tie in &l.line.ties {
        each(part, std::slice::from_ref(&tie.terms), false);
    }
    out
}
