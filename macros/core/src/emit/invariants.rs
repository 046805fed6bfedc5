//! The derived invariants as functions of the state, with their scales.

use super::element::{self, Family};
use super::expression::{Bindings, Writer, dims, program, ty};
use super::formula::formula;
use super::items::{letters_of, with_transports};
use super::names::{Names, item, variable};
use super::sizes::{Generics, size};
use super::step::{at, seen};
use crate::derive::Derivation;
use crate::derive::invariants::{Invariant, Kind};
use crate::expr::{Expr, Letter, Shift};
use crate::schedule;
use proc_macro2::{TokenStream, TokenTree};
use quote::{format_ident, quote};

/// Locals for the node momenta in `needed`.
fn momenta(d: &Derivation, needed: &[Letter], bindings: &mut Bindings) -> TokenStream {
    let mut out = TokenStream::new();
    for (i, (c, id)) in d
        .spec
        .configurations
        .iter()
        .zip(&d.letters.node_momentum)
        .enumerate()
    {
        let letter = at(*id, Shift::HERE);
        if !needed.contains(&letter) {
            continue;
        }
        let name = variable(&d.letters.symbols, *id);
        let method = element::momentum_field(d, i, c.side);
        let value = element::value(c, quote!(state.#method().0));
        out.extend(quote!(let #name = #value;));
        bindings.bind(letter, name);
    }
    out
}

/// The layout of the components of an invariant in the result of its function.
pub enum Form {
    /// A single number.
    Number,
    /// The entries of a vector or matrix.
    Entries,
    /// The coordinates of a skew matrix.
    Skew,
    /// The coefficients of a matrix pencil that do not vanish identically.
    Spectrum,
}

/// The layout of an invariant.
pub fn form(d: &Derivation, v: &Invariant) -> Form {
    let skew = |i: usize| {
        let family = element::family(&d.spec.configurations[i]);
        matches!(family, Family::Orthogonal(_))
    };
    let number = |i: usize| {
        let family = element::family(&d.spec.configurations[i]);
        matches!(family, Family::Field(shape) if shape.is_scalar())
    };
    match (&v.kind, &v.value) {
        (Kind::Spectrum, _) => Form::Spectrum,
        (Kind::TotalMomentum(set), _) if set.first().is_some_and(|i| skew(*i)) => Form::Skew,
        (Kind::TotalMomentum(set), _) if set.first().is_some_and(|i| number(*i)) => Form::Number,
        (Kind::TotalMomentum(_) | Kind::SpatialMomentum(_), _) => Form::Entries,
        (Kind::Value, Some(e)) if !e.shape().is_scalar() => Form::Entries,
        (Kind::ConstraintRate(j), _) if !super::holds::is_number(d, *j) => Form::Entries,
        (Kind::Value | Kind::Energy | Kind::ConstraintRate(_), _) => Form::Number,
    }
}

/// The number of components of an invariant, as tokens.
pub fn rows(d: &Derivation, v: &Invariant) -> TokenStream {
    let s = &d.letters.symbols;
    match (&v.kind, &v.value) {
        (Kind::SpatialMomentum(i), _) => momentum_rows(d, *i),
        (Kind::TotalMomentum(set), _) => momentum_rows(d, set.first().copied().unwrap_or(0)),
        (Kind::Value, Some(value)) if !value.shape().is_scalar() => {
            let (rows, cols) = dims(s, value.shape());
            quote!(#rows * #cols)
        }
        (Kind::Spectrum, _) => {
            let n = spectrum_size(d);
            quote!(even_count(#n))
        }
        (Kind::ConstraintRate(j), _) => super::holds::rows(d, *j),
        (Kind::Value | Kind::Energy, _) => quote!(1usize),
    }
}

/// The size of the matrices of the Lax pencil.
fn spectrum_size(d: &Derivation) -> TokenStream {
    let group = d.spec.configurations.first().map(|c| c.group.size());
    group.map_or_else(|| quote!(0), |n| size(&d.letters.symbols, n))
}

/// The momentum and the squared factor of a Lax form, with the locals that they need.
fn lax_parts(d: &Derivation, names: &Names) -> [TokenStream; 3] {
    let (Some(lax), Some(c)) = (&d.integrability.lax, d.spec.configurations.first()) else {
        return Default::default();
    };
    let needed = letters_of([&lax.factor]);
    let mut bindings = Bindings::new();
    let locals = seen(d, names, &needed, &mut bindings);
    let writer = Writer {
        symbols: &d.letters.symbols,
        bindings: &bindings,
    };
    let factor = writer.operand(&lax.factor);
    let momentum = element::momentum_field(d, 0, c.side);
    [
        locals,
        quote!(state.#momentum().0),
        quote!(#factor * #factor),
    ]
}

/// The coefficients as one matrix. Their number depends on the size of the group, which may be a named size.
fn spectrum(d: &Derivation, names: &Names, v: &Invariant) -> TokenStream {
    let state = item(d, "State");
    let used = Generics::of(d).used();
    let n = spectrum_size(d);
    let method = format_ident!("{}", v.name);
    let [locals, momentum, square] = lax_parts(d, names);
    let doc = format!(
        " {}: entry `(j - 1, i)` is the coefficient of `ν^i` and of degree `j` in the momentum.",
        v.reason
    );
    quote! {
        #[doc = #doc]
        pub fn #method(&self, state: &#state #used) -> SMatrix<T, #n, #n> {
            #locals
            pencil_coefficients(&#momentum, &(#square))
        }
    }
}

/// The scales of the spectral coefficients.
pub fn spectrum_scales(d: &Derivation, names: &Names) -> TokenStream {
    let n = spectrum_size(d);
    let [locals, momentum, square] = lax_parts(d, names);
    quote!({
        type T = f64;
        #locals
        spectrum_scales::<#n>(length(&#momentum), length::<T, #n, #n>(&(#square)))
    })
}

fn momentum_rows(d: &Derivation, i: usize) -> TokenStream {
    match element::family(&d.spec.configurations[i]) {
        Family::Rotation | Family::Quaternion => quote!(3usize),
        Family::Coordinates(names) => {
            let n = proc_macro2::Literal::usize_suffixed(names.coordinates as usize);
            quote!(#n)
        }
        Family::Orthogonal(_) | Family::Linear(_) | Family::Field(_) => element::coordinates(d, i),
    }
}

/// Whether an invariant depends on the step size.
pub fn holds_step(d: &Derivation, v: &Invariant) -> bool {
    match (&v.kind, &v.value) {
        (Kind::Value | Kind::ConstraintRate(_), Some(value)) => {
            let all = with_transports(d, &letters_of([value]), 0);
            all.contains(&at(d.spec.step, Shift::HERE))
        }
        _ => false,
    }
}

/// Whether steps of different sizes may be composed: the action must be reversible, and no invariant may depend on
/// the step size.
pub fn composes(d: &Derivation) -> bool {
    d.reversible && !d.invariants.iter().any(|v| holds_step(d, v))
}

/// One function for every invariant.
pub fn invariants(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let used = Generics::of(d).used();
    let mut functions = TokenStream::new();
    for v in &d.invariants {
        let method = format_ident!("{}", v.name);
        let doc = format!(" `{}`: {}.", formula(d, v), v.reason);
        match (&v.kind, &v.value, d.limit.as_ref()) {
            (Kind::SpatialMomentum(_), _, _) => {}
            (Kind::Spectrum, _, _) => functions.extend(spectrum(d, names, v)),
            (Kind::TotalMomentum(set), _, _) => {
                let parts = set.iter().map(|i| {
                    let momentum = element::spatial_momentum_field(d, *i);
                    element::value(&d.spec.configurations[*i], quote!(state.#momentum().0))
                });
                let t = element::covector(d, set.first().copied().unwrap_or(0));
                functions.extend(quote! {
                    #[doc = #doc]
                    pub fn #method(&self, state: &#state #used) -> #t {
                        #(#parts)+*
                    }
                });
            }
            (Kind::Energy, _, Ok(limit)) => {
                functions.extend(super::energy::energy(d, names, limit))
            }
            (_, Some(value), _) => {
                let needed = letters_of([value]);
                let mut bindings = Bindings::new();
                let locals = seen(d, names, &needed, &mut bindings);
                let mu = momenta(d, &needed, &mut bindings);
                let p = schedule::program(s, std::slice::from_ref(value), "t");
                let (lets, values) = program(&p, &bindings);
                let (value, t) = (&values[0], ty(s, value.shape()));
                let step = holds_step(d, v).then(|| quote!(h: T,));
                functions.extend(quote! {
                    #[doc = #doc]
                    pub fn #method(&self, #step state: &#state #used) -> #t {
                        #locals
                        #mu
                        #lets
                        #value
                    }
                });
            }
            (Kind::Value | Kind::Energy | Kind::ConstraintRate(_), None, _) => {}
        }
    }
    functions
}

/// The scales of all components of all invariants, written to `out` in order.
pub fn scales(d: &Derivation, names: &Names) -> TokenStream {
    let s = &d.letters.symbols;
    let list: Vec<Expr> = d
        .invariants
        .iter()
        .filter(|v| !matches!(v.kind, Kind::Spectrum))
        .filter_map(|v| v.scale.clone())
        .collect();
    let impulses = super::impulses::impulses(d);
    let mut needed = letters_of(&list);
    let mut bindings = Bindings::new();
    let mu = momenta(d, &needed, &mut bindings);
    needed.extend(letters_of(impulses.iter().map(|i| &i.size)));
    let locals = seen(d, names, &needed, &mut bindings);
    let enlarged = super::impulses::not_less_than_impulses(d, names, &impulses, &bindings);
    let p = schedule::program(s, &list, "t");
    let (lets, values) = program(&p, &bindings);
    let mut values = list.iter().zip(values);
    let mut sizes: Vec<Sizes> = Vec::new();
    let [plain, size] = ["energies", "energy"].map(|name| names.local(name));
    let (mut energies, mut measured) = (TokenStream::new(), TokenStream::new());
    for v in &d.invariants {
        let rows = rows(d, v);
        let alike = |value: TokenStream| match form(d, v) {
            Form::Number => Sizes::Number(value),
            // Stable Rust does not allow an array length that is computed from a named size.
            _ if d.spec.dimensions.is_empty() => Sizes::Several(quote!([#value; #rows])),
            _ => Sizes::Several(quote!(::core::iter::repeat_n(#value, #rows))),
        };
        sizes.push(match (&v.kind, &v.scale) {
            (Kind::Spectrum, _) => Sizes::Several(spectrum_scales(d, names)),
            (Kind::ConstraintRate(j), _) => alike(super::holds::rate_scale(d, *j)),
            (_, None) if impulses.is_empty() => alike(quote!(sum_of_sizes(self.energies(state)))),
            (_, None) => {
                energies = quote!(let #plain = self.energies(state););
                measured = quote!(let #size = size_of_energy(#plain, self.energies(state)););
                alike(quote!(#size))
            }
            (_, Some(_)) => match values.next() {
                Some((e, value)) if e.shape().is_scalar() => alike(value),
                Some((_, value)) => Sizes::Several(quote!(rows(#value))),
                None => continue,
            },
        });
    }
    let together = sizes.chunk_by(|a, b| matches!((a, b), (Sizes::Number(_), Sizes::Number(_))));
    let together: Vec<TokenStream> = together
        .map(|list| match list {
            [Sizes::Several(all)] => all.clone(),
            list => {
                let numbers = list.iter().map(|(Sizes::Number(x) | Sizes::Several(x))| x);
                quote!([#(#numbers),*])
            }
        })
        .collect();
    let written = together.split_last().map(|(last, first)| {
        quote! {
            #(let out = put(out, #first);)*
            put(out, #last);
        }
    });
    // Scales are computed in `f64`.
    let body = quote!(#locals #energies #enlarged #measured #mu #lets #written);
    let scalar = names_scalar(&body).then(|| {
        quote!(
            type T = f64;
        )
    });
    quote!(#scalar #body)
}

/// The scales of one invariant.
enum Sizes {
    /// The scale of a scalar invariant.
    Number(TokenStream),
    /// The scales of an invariant with several components.
    Several(TokenStream),
}

/// Whether the scalar type `T` occurs in the tokens.
fn names_scalar(tokens: &TokenStream) -> bool {
    tokens.clone().into_iter().any(|tree| match tree {
        TokenTree::Ident(name) => name == "T",
        TokenTree::Group(group) => names_scalar(&group.stream()),
        _ => false,
    })
}
