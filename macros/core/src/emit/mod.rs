//! From a derivation to Rust: parameters, state, workspace, `start`, `step`, the residual, the invariants and the
//! description of the model. Emission makes no decisions and cannot fail. [`refusal`] rejects models without a
//! stepper beforehand.

mod between;
mod blocks;
mod card;
mod constant_factors;
mod discrete_energy;
mod domain;
mod element;
mod energy;
mod equations;
mod expression;
mod force_at_node;
mod forced;
mod formula;
mod functional;
mod holds;
mod impulses;
mod invariants;
mod items;
mod kernel;
mod kinetic;
mod left_factor;
mod line;
mod momentum_update;
mod names;
mod newton;
mod notes;
mod precomputed_values;
mod principal;
mod quaternionic;
mod residual;
mod single_body;
mod sizes;
mod start;
mod state;
mod step;
mod stepper;
#[cfg(test)]
mod tests;
mod workspace;

pub(crate) use notes::notes;

use crate::derive::Derivation;
use crate::derive::select_solver::Method;
use crate::diagnostic::{Diagnostic, Errors};
pub use formula::formula;
pub use line::{emit_line, refusal_of_line};
use names::Names;
use proc_macro2::{Ident, TokenStream, TokenTree};
use quote::{format_ident, quote};

/// The largest number of coordinates of the Lie algebra of a group other than a field, attained by SO(8).
const MOST_COORDINATES: u64 = 28;

/// Limits on the unknowns that a stepper solves together.
struct UnknownLimits {
    /// The number of coordinates, since their tangent is a dense array.
    coordinates: u64,
    /// The number of configurations, if their groups differ.
    different: usize,
    /// The verb for the stepper in the error message.
    made: &'static str,
}

/// The limits of a compiled stepper, which stores these arrays on the stack and represents products of groups as
/// types.
const BUILT: UnknownLimits = UnknownLimits {
    coordinates: MOST_COORDINATES,
    different: 6,
    made: "emits",
};

/// The limits of an interpreted stepper, whose step costs the cube of the number of coordinates.
const READ: UnknownLimits = UnknownLimits {
    coordinates: 256,
    different: 256,
    made: "runs",
};

/// The largest number of sizes for which a model is compiled and described.
const MOST_SIZES: u64 = 32;

/// The reason why clebsch emits no stepper for this model, if any.
pub fn refusal(d: &Derivation) -> Option<Diagnostic> {
    refused(d, &BUILT)
}

/// The reason why a model file cannot be run, if any.
pub fn refusal_of_read(d: &Derivation) -> Option<Diagnostic> {
    refused(d, &READ)
}

fn refused(d: &Derivation, most: &UnknownLimits) -> Option<Diagnostic> {
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let admitted = match element::family(c) {
            element::Family::Field(_) => most.coordinates,
            _ => MOST_COORDINATES,
        };
        if element::most_coordinates(d, i) > admitted {
            return Some(
                Diagnostic::new(
                    c.group_place,
                    "this version has steppers up to SO<8> and GL<5>",
                )
                .help("use a smaller size; `clebsch derive` prints the equations for any size"),
            );
        }
    }
    let sizes = d.spec.dimensions.iter();
    let combined = sizes.fold(1u64, |n, x| {
        n.saturating_mul(x.to.saturating_sub(x.from).saturating_add(1))
    });
    if combined > MOST_SIZES {
        return Some(
            Diagnostic::new(
                d.spec.name_place,
                format!(
                    "the model needs {combined} combinations of sizes, and at most {MOST_SIZES} can be compiled"
                ),
            )
            .help("narrow the ranges of `dim`, or write numbers instead"),
        );
    }
    if let Some(refused) = too_many_together(d, most) {
        return Some(refused);
    }
    names::refusal(d)
}

/// Rejects a block that is too large for a dense tangent, or that has more configurations than a product of groups
/// can have.
fn too_many_together(d: &Derivation, most: &UnknownLimits) -> Option<Diagnostic> {
    let UnknownLimits {
        coordinates: admitted,
        different,
        made,
    } = *most;
    // Multipliers follow the velocities.
    let bodies = d.spec.configurations.len();
    let held: Vec<usize> = (0..d.spec.holds.len()).collect();
    let d = &d.with_multipliers(&held);
    let together: Vec<Vec<usize>> = match d.solve.method {
        Method::Newton => vec![(0..d.spec.configurations.len()).collect()],
        Method::Blocks => {
            let newton = d.solve.blocks.iter().filter(|b| b.is_newton());
            newton
                .map(|b| {
                    let multipliers = b.holds.iter().map(|j| bodies + j);
                    b.members.iter().copied().chain(multipliers).collect()
                })
                .collect()
        }
        _ => Vec::new(),
    };
    let families = |members: &[usize]| {
        let list = members
            .iter()
            .map(|i| element::family(&d.spec.configurations[*i]));
        let list: Vec<_> = list.collect();
        list.windows(2).all(|w| w[0] == w[1])
    };
    let coordinates = |members: &[usize]| -> u64 {
        members
            .iter()
            .map(|i| element::most_coordinates(d, *i))
            .sum()
    };
    let refused = together.iter().find(|members| {
        coordinates(members) > admitted || members.len() > different && !families(members)
    })?;
    let name = |i: &usize| {
        let velocity = d.spec.configurations[*i].velocity;
        d.letters.symbols.get(velocity).name.clone()
    };
    let names: Vec<String> = refused.iter().map(name).collect();
    let message = format!(
        "{} depend on one another, so their equations must be solved together: this version {made} steppers for at most \
         {different} such bodies of different groups, and for at most {admitted} coordinates",
        names.join(", ")
    );
    Some(
        Diagnostic::new(d.spec.name_place, message)
            .help("`clebsch derive` prints the equations for any number of bodies; bodies whose forces depend on \
                configurations but not on velocities are solved one by one"),
    )
}

/// The Rust items of a model. If `documented` is set, the rustdoc of the model contains the whole derivation.
pub fn emit(d: &Derivation, documented: bool) -> TokenStream {
    let names = Names::new(d);
    let module = format_ident!("{}", names.module);
    let visibility = d.spec.public.then(|| quote!(pub));
    let [configuration, balance] = residual::balance(d, &names);
    // Functions of states other than the step.
    let asked = [
        balance,
        kinetic::inertia_at(d, &names),
        invariants::invariants(d, &names),
        discrete_energy::discrete_energy(d, &names),
        stepper::attempt(d),
    ];
    let (name, g) = (names::item(d, ""), sizes::Generics::of(d));
    let (bound, used) = (g.bound(), g.used());
    let asked = quote!(impl #bound #name #used { #(#asked)* });
    let items = [
        items::parameters(d),
        items::model(d, documented),
        state::state(d, &names),
        step::start_and_step(d, &names),
        stepper::protocol(d, &names),
        configuration,
        asked,
        card::card(d, &names),
    ];
    let given = functional::paths(&d.letters.symbols);
    let about = format!(
        " The model [`{}`](struct@{}) with its parameters, states and steps.",
        d.spec.name, d.spec.name
    );
    quote! {
        #[doc = #about]
        #[allow(non_snake_case, uncommon_codepoints, mixed_script_confusables)]
        #[allow(confusable_idents, unused_variables, clippy::all)]
        #visibility mod #module {
            use ::clebsch::emitted::*;
            #given
            #(#items)*
        }
        #[allow(unused_imports)]
        #visibility use #module::*;
    }
}

/// The items that describe a model as data, without its stepper.
pub fn emit_card(d: &Derivation) -> TokenStream {
    let (name, card) = (names::item(d, ""), card::card(d, &Names::new(d)));
    let source = crate::document::source(d);
    let fingerprint = crate::document::fingerprint(d);
    quote! {
        impl #name {
            pub const SOURCE: &'static str = #source;
            pub const FINGERPRINT: u64 = #fingerprint;
        }
        #card
    }
}

/// The compile errors of a rejected model, and placeholder types under the names of its items. The placeholders are
/// erroneous themselves, so that code using the model causes no further errors. The first error is placed inside such
/// a type as a projection with a faulty argument, which is the only form for which stable Rust reports nothing else.
pub fn fallback(tokens: &TokenStream, errors: &Errors) -> TokenStream {
    let mut after_model = false;
    let mut name: Option<Ident> = None;
    for tree in tokens.clone() {
        if let TokenTree::Ident(word) = tree {
            if after_model {
                name = Some(word);
                break;
            }
            after_model = word == "model";
        }
    }
    let mut messages = errors.to_compile_errors().into_iter();
    let name = name.filter(|n| !crate::check::is_rust_word(&n.to_string()));
    let (Some(name), Some(first)) = (name, messages.next()) else {
        return errors.to_compile_errors().into_iter().collect();
    };
    let refused = format_ident!("{name}Refused");
    let suffixes = [
        "Parameters",
        "Initial",
        "State",
        "Workspace",
        "Configuration",
    ];
    let others = suffixes.map(|suffix| format_ident!("{name}{suffix}"));
    quote! {
        #[doc(hidden)]
        #[allow(non_camel_case_types)]
        pub trait #refused<T, const REASON: ::core::primitive::usize> {
            #[doc(hidden)]
            type Model;
        }
        #[doc(hidden)]
        #[allow(dead_code, non_camel_case_types)]
        pub type #name<T = ::core::primitive::f64> = <() as #refused<T, { #first }>>::Model;
        #(
            #[doc(hidden)]
            #[allow(dead_code, non_camel_case_types)]
            pub type #others<T = ::core::primitive::f64> = #name<T>;
        )*
        #(#messages)*
    }
}
