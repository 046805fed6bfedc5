//! Functions that the search for the principal root calls: residual and tangent of one step as functions of the
//! values at its node, over any scalar. Takes the equations; gives the functions.

use super::element::{self, Bundle};
use super::equations::{EquationCode, TURNED};
use super::expression::{Bindings, ty};
use super::items::parameter_locals;
use super::names::{item, variable};
use super::sizes::Generics;
use crate::derive::Derivation;
use crate::expr::{Letter, Shift};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// The context of the functions.
pub(super) struct Principal<'a> {
    /// The model.
    pub d: &'a Derivation,
    /// The locals of the values at the node.
    pub bindings: &'a Bindings,
    /// The equations.
    pub equations: &'a EquationCode,
    /// The local of the node momenta.
    pub momenta: &'a Ident,
    /// The local of the trial.
    pub trial: &'a Ident,
    /// The name of the residual.
    pub residual_at: &'a Ident,
    /// The name of the tangent.
    pub tangent_at: &'a Ident,
    /// The name of the function that bounds the rounding errors.
    pub rounding: &'a Ident,
    /// The name of the search for the principal root.
    pub principal: &'a Ident,
    /// The name of the function that completes a partial trial.
    pub completed_at: &'a Ident,
}

impl Principal<'_> {
    /// Values at the node as nested pairs.
    pub fn packed(&self, letters: &[Letter]) -> TokenStream {
        let s = &self.d.letters.symbols;
        letters.iter().rev().fold(quote!([]), |rest, l| {
            let local = self.bindings.local(s, *l);
            let value = match s.get(l.symbol).shape.is_scalar() {
                true => quote!(SMatrix::<T, 1, 1>::repeat(#local)),
                false => quote!(#local),
            };
            quote!((#value, #rest))
        })
    }

    /// The type of those pairs.
    pub fn packed_type(d: &Derivation, letters: &[Letter]) -> TokenStream {
        let s = &d.letters.symbols;
        letters.iter().rev().fold(quote!([T; 0]), |rest, l| {
            let shape = s.get(l.symbol).shape;
            let own = match shape.is_scalar() {
                true => quote!(SMatrix<T, 1, 1>),
                false => ty(s, shape),
            };
            quote!((#own, #rest))
        })
    }

    /// `let` statements that unpack them.
    fn unpacked(&self, source: &Ident, letters: &[Letter]) -> TokenStream {
        let s = &self.d.letters.symbols;
        let mut at = quote!(#source);
        let mut out = TokenStream::new();
        for l in letters {
            let local = self.bindings.local(s, *l);
            let value = match s.get(l.symbol).shape.is_scalar() {
                true => quote!(#at.0[0]),
                false => quote!(#at.0),
            };
            out.extend(quote!(let #local = #value;));
            at = quote!(#at.1);
        }
        out
    }

    /// The functions.
    pub fn functions(&self) -> TokenStream {
        let Self {
            d,
            equations,
            trial,
            momenta,
            residual_at,
            tangent_at,
            rounding,
            principal,
            completed_at,
            ..
        } = *self;
        let s = &d.letters.symbols;
        let name = item(d, "");
        let g = Generics::of(d);
        let bundle = Bundle::of(d);
        let bodies = d.spec.configurations.len();
        let step = variable(s, d.spec.step);
        let dimension = element::total(d);
        let types: Vec<TokenStream> = (0..bodies).map(|i| element::ty(d, i)).collect();
        let elements = bundle.ty(&types);
        let plain = quote!(f64);
        let over = |scalar: &TokenStream| {
            let types: Vec<TokenStream> = (0..bodies)
                .map(|i| element::ty_over(d, i, scalar))
                .collect();
            bundle.ty(&types)
        };
        let changed = |element: TokenStream| {
            let parts: Vec<TokenStream> = (0..bodies)
                .map(|i| {
                    let part = bundle.part(element.clone(), i);
                    quote!(#part.over(change))
                })
                .collect();
            bundle.value(&parts)
        };
        let given_type = Self::packed_type(d, &equations.alone.given);
        let given = format_ident!("given");
        let open_given = self.unpacked(&given, &equations.alone.given);
        let parameters = {
            let all: Vec<Letter> = d
                .spec
                .parameters
                .iter()
                .map(|p| Letter {
                    symbol: *p,
                    shift: Shift::HERE,
                })
                .collect();
            parameter_locals(d, quote!(*parameters), &all)
        };
        let momenta_type = &equations.momenta;
        let momenta_over = &equations.momenta_over;
        let at_trial = &equations.at_trial;
        let (residual, tangent) = (&equations.alone.residual, &equations.alone.tangent);
        let (given_parameters, used) = (item(d, "Parameters"), g.used());
        let own = |scalar: &TokenStream| {
            let used = g.used_over_tokens(scalar);
            quote!(#name::#used)
        };
        let rounded = quote!(newton::Rounded);
        let plain_elements = over(&plain);
        let (model_rounded, model_plain) = (own(&rounded), own(&plain));
        let trial_over = changed(quote!(#trial));
        let found_over = changed(quote!(found));
        let put = (0..bodies).map(|i| {
            let (to, from) = (bundle.part(quote!(all), i), bundle.part(quote!(root), i));
            quote!(#to = #to.over(&mut newton::Numbers::of(&#from).put(lane));)
        });
        let part = equations.part.as_ref();
        // The completion of a partial trial has rounding errors too.
        let completed = part.map(|part| {
            let (turned, body, count) = (format_ident!("{TURNED}"), &part.alone, part.rows.len() / 3);
            let count = Literal::usize_unsuffixed(count);
            quote! {
                /// The trial with these rotations and the translations that follow from them.
                #[cold]
                #[inline(never)]
                #[allow(unused_variables)]
                fn #completed_at(parameters: &#given_parameters #used, #step: T, #given: &#given_type, #momenta: &#momenta_type, #turned: &[Rotation<T>; #count]) -> #elements {
                    #parameters
                    #open_given
                    #body
                }
            }
        });
        let completing = part.map(|_| {
            let within = quote!(newton::Found::within(&#trial));
            quote!(let #trial = #model_rounded::#completed_at(&parameters, step, &given, &momenta, &#within);)
        });
        let rounded_rows = |all: TokenStream| match part {
            Some(part) => {
                let rows = part.rows.iter().map(|i| Literal::usize_unsuffixed(*i));
                quote!({ let all = #all; SVector::from([#(all[#rows]),*]) })
            }
            None => all,
        };
        let all_rows = quote!(#model_rounded::#residual_at(&parameters, step, &given, &momenta, &trial).map(|x| x.error()));
        let rows = part.map_or(dimension.clone(), |part| {
            Literal::usize_unsuffixed(part.rows.len())
        });
        let rounded_rows = rounded_rows(all_rows);
        quote! {
            #completed

            /// The residual of the equations of a step.
            #[cold]
            #[inline(never)]
            #[allow(unused_variables)]
            fn #residual_at(parameters: &#given_parameters #used, #step: T, #given: &#given_type, #momenta: &#momenta_type, #trial: &#elements) -> SVector<T, #dimension> {
                #parameters
                #open_given
                #at_trial
                #residual
            }

            /// The tangent of the residual.
            #[cold]
            #[inline(never)]
            #[allow(unused_variables)]
            fn #tangent_at(parameters: &#given_parameters #used, #step: T, #given: &#given_type, #trial: &#elements) -> SMatrix<T, #dimension, #dimension> {
                #parameters
                #open_given
                #at_trial
                #tangent
            }

            /// Bounds of the rounding errors of the residual, in one lane.
            #[cold]
            #[inline(never)]
            fn #rounding(&self, #step: T, #given: &#given_type, #momenta: &#momenta_type, #trial: &#elements, lane: usize) -> SVector<f64, #rows> {
                let change = &mut |x: T| newton::Rounded::exactly(x.lane(lane));
                let parameters = self.parameters.over(change);
                let (step, given, momenta) = (#step.over(change), #given.over(change), #momenta_over);
                let change = &mut |x: T| newton::Rounded::once(x.lane(lane));
                let trial = #trial_over;
                #completing
                #rounded_rows
            }

            /// Finds the principal root, or proves that the given solution is the principal root.
            #[cold]
            #[inline(never)]
            fn #principal(
                &self,
                #step: T,
                #given: &#given_type,
                #momenta: &#momenta_type,
                mut verdict: newton::Verdict<#elements, #dimension>,
                solution: Option<&#elements>,
            ) -> Result<Option<newton::Anchor<#elements, #dimension>>, newton::Fold> {
                for lane in 0..T::LANES {
                    let change = &mut |x: T| x.lane(lane);
                    let (parameters, step) = (self.parameters.over(change), #step.over(change));
                    let (given, momenta) = (#given.over(change), #momenta_over);
                    let found = match solution {
                        Some(found) => Some(#found_over),
                        None => None,
                    };
                    let equations = newton::Equations {
                        residual: &|trial: &#plain_elements| #model_plain::#residual_at(&parameters, step, &given, &momenta, trial),
                        tangent: &|trial: &#plain_elements| #model_plain::#tangent_at(&parameters, step, &given, trial),
                    };
                    if let Some(root) = verdict.trace(lane, &equations, found.as_ref())? {
                        let all = verdict.root_mut();
                        #(#put)*
                    }
                }
                Ok(verdict.elsewhere())
            }
        }
    }
}
