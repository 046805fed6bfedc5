//! Constraints in a stepper: multipliers in the state, projection of the momentum on arrival, conditions on initial
//! data, and the rates of change of the constraints. Takes the derivation; gives the statements and functions. Empty
//! for a model without constraints.

use super::element::{self, Family, family};
use super::expression::{Bindings, Writer, program, ty};
use super::items::{letters_of, parameter_locals, text, with_transports};
use super::names::{Names, item, own, per_configuration, tagged, variable};
use super::sizes::Generics;
use super::step::{at, here};
use crate::check::spec::{Configuration, Hold};
use crate::derive::{Derivation, holds};
use crate::expr::shape::Shape;
use crate::expr::{self, Expr, Shift};
use crate::schedule;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The field of the state with the multiplier of the step that ended there.
fn multiplier(d: &Derivation, hold: &Hold) -> Ident {
    own(d, hold.multiplier)
}

/// The field with the impulse of the constraint on arrival.
fn arrival(d: &Derivation, hold: &Hold) -> Ident {
    format_ident!("{}_arrival", multiplier(d, hold))
}

fn shape(d: &Derivation, hold: &Hold) -> Shape {
    d.letters.symbols.get(hold.multiplier).shape
}

fn none(d: &Derivation, hold: &Hold) -> TokenStream {
    element::zero(d, shape(d, hold))
}

/// The names of all fields.
pub(super) fn names_of_fields(d: &Derivation) -> Vec<Ident> {
    let each = d.spec.holds.iter();
    each.flat_map(|h| [multiplier(d, h), arrival(d, h)])
        .collect()
}

/// The fields of the state, and the functions that return them.
pub(super) fn fields(d: &Derivation) -> (Vec<TokenStream>, Vec<TokenStream>) {
    let s = &d.letters.symbols;
    let each = d.spec.holds.iter().map(|hold| {
        let (field, arrived, t) = (
            multiplier(d, hold),
            arrival(d, hold),
            ty(s, shape(d, hold)),
        );
        let doc = format!(
            " The multiplier of `{} = {}` over the step that ended here, zero at the start. The constraint force is the multiplier times the derivative of the left side minus the right side.",
            text(d, &hold.left),
            text(d, &hold.right)
        );
        (
            quote!(#field: #t, #arrived: #t),
            quote! {
                #[doc = #doc]
                pub fn #field(&self) -> #t { self.#field }
            },
        )
    });
    each.unzip()
}

/// Their values at the start.
pub(super) fn at_start(d: &Derivation) -> Vec<TokenStream> {
    let each = d.spec.holds.iter().flat_map(|hold| {
        let zero = none(d, hold);
        [multiplier(d, hold), arrival(d, hold)].map(|field| quote!(#field: #zero))
    });
    each.collect()
}

/// Whether the momentum is projected on arrival. This requires the limit of small steps, which gives the velocities
/// for a momentum.
fn projects(d: &Derivation) -> bool {
    !d.spec.holds.is_empty() && d.limit.is_ok()
}

/// The statements that store the multipliers, after everything else is stored.
pub(super) fn after_step(d: &Derivation, names: &Names) -> TokenStream {
    if d.spec.holds.is_empty() {
        return TokenStream::new();
    }
    let step = variable(&d.letters.symbols, d.spec.step);
    let found = d.spec.holds.iter().map(|hold| {
        let (field, value) = (
            multiplier(d, hold),
            tagged(d, names, hold.multiplier, "matrix"),
        );
        quote!(state.#field = #value;)
    });
    let project = projects(d).then(|| {
        let with_arrival = d.spec.holds.iter().map(|hold| {
            let (field, arrived) = (multiplier(d, hold), arrival(d, hold));
            quote!(state.#field = state.#field + state.#arrived * (T::one() / #step);)
        });
        quote! {
            self.project(state);
            #(#with_arrival)*
        }
    });
    quote!(#(#found)* #project)
}

/// The equations of the projection: the momenta of the velocities and of the impulses, and the rates of change of the
/// constraints.
struct Projection {
    /// The derivation with multipliers as further velocities.
    whole: Derivation,
    /// The rate of change of each constraint.
    rates: Vec<Expr>,
    /// The momentum of each configuration due to the impulses.
    kicks: Vec<Expr>,
}

impl Projection {
    fn of(d: &Derivation) -> Option<Projection> {
        let mut limit = d.limit.clone().ok()?;
        let s = &d.letters.symbols;
        let count = d.spec.holds.len();
        let all: Vec<usize> = (0..count).collect();
        let paired = expr::sum(
            all.iter()
                .map(|j| holds::rate_paired(d, *j))
                .collect::<Vec<_>>(),
            Shape::SCALAR,
        );
        let kicks = d.spec.configurations.iter().zip(&d.letters.variation);
        let kicks = kicks.map(|(c, xi)| {
            let y = expr::gradient(s, &paired, at(*xi, Shift::HERE));
            c.group.of_gradient(s, y)
        });
        let kicks: Vec<Expr> = kicks.collect();
        let rates = d.spec.holds.iter().map(|h| holds::rate(d, h)).collect();
        limit.kinetic = expr::add(limit.kinetic, paired);
        let mut whole = d.with_multipliers(&all);
        whole.limit = Ok(limit);
        Some(Projection {
            whole,
            rates,
            kicks,
        })
    }

    /// The local of an impulse.
    fn impulse(&self, d: &Derivation, j: usize) -> Ident {
        variable(&d.letters.symbols, d.letters.held[j].variation)
    }
}

/// The momenta of the state as covectors, each in the frame of its side.
fn momenta(d: &Derivation) -> Vec<TokenStream> {
    let list = d.spec.configurations.iter().enumerate();
    list.map(|(i, c)| {
        let method = element::momentum_field(d, i, c.side);
        element::value(c, quote!(state.#method().0))
    })
    .collect()
}

/// Some coordinates of a list, as a number or a vector.
fn part(d: &Derivation, shape: Shape, list: TokenStream, offset: &TokenStream) -> TokenStream {
    if shape.is_scalar() {
        return quote!(#list[#offset]);
    }
    let rows = super::sizes::size(&d.letters.symbols, shape.rows);
    quote!(SVector::<T, #rows>::from_fn(|i, _| #list[#offset + i]))
}

/// The projection, and one function per constraint for its rate of change.
pub(super) fn functions(d: &Derivation, names: &Names) -> TokenStream {
    let Some(projection) = Projection::of(d).filter(|_| projects(d)) else {
        return TokenStream::new();
    };
    let project = project(d, names, &projection);
    let rates = rates(d, names, &projection);
    quote!(#project #rates)
}

fn project(d: &Derivation, names: &Names, projection: &Projection) -> TokenStream {
    let s = &d.letters.symbols;
    let Ok(limit) = &projection.whole.limit else {
        return TokenStream::new();
    };
    let bodies = d.spec.configurations.len();
    let (state, used) = (item(d, "State"), Generics::of(d).used());
    let mut needed = letters_of(
        [&limit.kinetic, &limit.linear]
            .into_iter()
            .chain(&projection.kicks),
    );
    for (i, c) in d.spec.configurations.iter().enumerate() {
        if c.side.is_body() && family(c) == Family::Rotation && !projection.kicks[i].is_zero() {
            needed.push(at(c.element, Shift::HERE));
        }
    }
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let mut own_momenta = momenta(d);
    own_momenta.extend(d.spec.holds.iter().map(|hold| none(d, hold)));
    let solved = super::energy::matrices(&projection.whole, &bindings, limit, own_momenta);
    let impulses = d.spec.holds.iter().enumerate().map(|(j, hold)| {
        let name = projection.impulse(d, j);
        let offset = element::offset(&projection.whole, bodies + j);
        let value = part(d, shape(d, hold), quote!(velocity), &offset);
        let arrived = arrival(d, hold);
        quote! {
            let #name = #value;
            state.#arrived = -#name;
        }
    });
    let impulses: TokenStream = impulses.collect();
    let p = schedule::program(s, &projection.kicks, "t");
    let (lets, values) = program(&p, &bindings);
    let updates = (0..bodies)
        .zip(values)
        .filter(|(i, _)| !projection.kicks[*i].is_zero())
        .map(|(i, value)| update(d, names, i, value));
    let updates: TokenStream = updates.collect();
    quote! {
        /// Projects the momentum at a node, so that the velocity is tangent to the constraints.
        fn project(&self, state: &mut #state #used) {
            #parameters
            #locals
            #solved
            #impulses
            #lets
            #updates
        }
    }
}

/// The momentum of configuration `i` minus the covector `value` at the node.
fn update(d: &Derivation, names: &Names, i: usize, value: TokenStream) -> TokenStream {
    let c: &Configuration = &d.spec.configurations[i];
    let (element, field) = (own(d, c.element), per_configuration(d, "momentum", i));
    let kind = element::kept_name(d, i);
    let own_matrix = variable(&d.letters.symbols, c.element);
    let kick = match (c.side.is_body(), family(c)) {
        (_, Family::Field(_)) => element::array(c, value),
        (false, _) => value,
        (true, Family::Rotation) => quote!(#own_matrix * (#value)),
        (true, _) if element::about_body(c) => {
            quote!(state.#element.covector_turned(&(#value)))
        }
        (true, _) => quote!(state.#element.covector_to_space(&(#value))),
    };
    match element::rests(d, i) {
        Some([_, rest]) => {
            let (sum, left) = (
                names.local(&format!("{field}_projected")),
                names.local(&format!("{field}_left")),
            );
            quote! {
                let (#sum, #left) = added(&state.#field.0, &state.#rest, &(-(#kick)));
                state.#field = #kind(#sum);
                state.#rest = #left;
            }
        }
        None => quote!(state.#field = #kind(state.#field.0 - (#kick));),
    }
}

/// One function per constraint: its rate of change at a state.
fn rates(d: &Derivation, names: &Names, projection: &Projection) -> TokenStream {
    let s = &d.letters.symbols;
    let Ok(limit) = &d.limit else {
        return TokenStream::new();
    };
    let (state, used) = (item(d, "State"), Generics::of(d).used());
    let each = d
        .spec
        .holds
        .iter()
        .zip(&projection.rates)
        .map(|(hold, rate)| {
            let method = format_ident!("constraint_rate_{}", s.get(hold.multiplier).ascii);
            let needed = letters_of([&limit.kinetic, &limit.linear, rate]);
            let all = with_transports(d, &needed, 0);
            let parameters = parameter_locals(d, quote!(self.parameters), &all);
            let mut bindings = Bindings::new();
            let locals = here(d, names, &needed, &mut bindings);
            let solved = super::energy::matrices(d, &bindings, limit, momenta(d));
            let (sums, t) = (sums(d, rate, &bindings), ty(s, shape(d, hold)));
            let zero = none(d, hold);
            let doc = format!(
                " The rate of change of `{}` at this state: zero up to rounding.",
                text(d, &hold.value)
            );
            let both = rate_and_scale(d, hold);
            quote! {
                #[doc = #doc]
                pub fn #method(&self, state: &#state #used) -> #t {
                    let (rate, _) = self.#both(state);
                    rate
                }

                /// The rate of change of the constraint, and the size of its terms.
                fn #both(&self, state: &#state #used) -> (#t, T) {
                    #parameters
                    #locals
                    #solved
                    let mut rate: #t = #zero;
                    let mut scale = T::zero();
                    #sums
                    (rate, scale)
                }
            }
        });
    each.collect()
}

/// Adds the contribution of each coordinate of `velocity` to `rate` and `scale`.
fn sums(d: &Derivation, rate: &Expr, bindings: &Bindings) -> TokenStream {
    let s = &d.letters.symbols;
    let writer = Writer {
        symbols: s,
        bindings,
    };
    let value = writer.operand(rate);
    let bodies = 0..d.spec.configurations.len();
    let each = bodies.map(|j| {
        let directions = d.letters.variation.iter().enumerate().map(|(i, xi)| {
            let name = variable(s, *xi);
            let t = ty(s, s.get(*xi).shape);
            let value = match i == j {
                true => element::basis(d, i, quote!(axis)),
                false if s.get(*xi).shape.is_scalar() => quote!(T::zero()),
                false => quote!(SMatrix::zeros()),
            };
            quote!(let #name: #t = #value;)
        });
        let (count, offset) = (element::coordinates(d, j), element::offset(d, j));
        let size = match rate.shape().is_scalar() {
            true => quote!((term * term).sqrt()),
            false => quote!(length(&term)),
        };
        quote! {
            for axis in 0..#count {
                #(#directions)*
                let term = #value * velocity[#offset + axis];
                rate += term;
                scale += #size;
            }
        }
    });
    each.collect()
}

/// The test of a state at node 0: its configuration must satisfy the constraints, and its momentum must be tangent to
/// them.
pub(super) fn admitted(d: &Derivation, names: &Names) -> TokenStream {
    if d.spec.holds.is_empty() {
        return TokenStream::new();
    }
    let s = &d.letters.symbols;
    let mut values: Vec<Expr> = Vec::new();
    for hold in &d.spec.holds {
        values.push(hold.value.clone());
        values.push(holds::scale(s, hold));
    }
    let needed = letters_of(&values);
    let all = with_transports(d, &needed, 0);
    let parameters = parameter_locals(d, quote!(self.parameters), &all);
    let mut bindings = Bindings::new();
    let locals = here(d, names, &needed, &mut bindings);
    let p = schedule::program(s, &values, "t");
    let (lets, values) = program(&p, &bindings);
    let tests = d
        .spec
        .holds
        .iter()
        .zip(values.chunks(2))
        .map(|(hold, pair)| {
            let (label, equation) = (&s.get(hold.multiplier).name, equation(d, hold));
            let value = size_of(&hold.value, pair.first());
            let scale = pair.get(1);
            quote!(validate::on_constraint(#label, #equation, #value, #scale)?;)
        });
    let tests: TokenStream = tests.collect();
    let field = names.local("projected");
    let moving = projects(d).then(|| {
        let tests = d.spec.holds.iter().map(|hold| {
            let (label, equation) = (&s.get(hold.multiplier).name, equation(d, hold));
            let arrived = arrival(d, hold);
            let impulse = match shape(d, hold).is_scalar() {
                true => quote!((-#field.#arrived)),
                false => quote!(length(&#field.#arrived)),
            };
            let lengths = lengths(d, &field);
            quote!(validate::along_constraint(#label, #equation, #impulse, #lengths)?;)
        });
        let tests: TokenStream = tests.collect();
        let back = d.spec.holds.iter().map(|hold| {
            let (arrived, zero) = (arrival(d, hold), none(d, hold));
            quote!(#field.#arrived = #zero;)
        });
        quote! {
            let mut #field = state;
            self.project(&mut #field);
            #tests
            #(#back)*
            let state = #field;
        }
    });
    quote! {
        {
            let state = &state;
            #parameters
            #locals
            #lets
            #tests
        }
        #moving
    }
}

/// The size of the change of the momenta by the projection, and the size of the momenta.
fn lengths(d: &Derivation, projected: &Ident) -> TokenStream {
    let fields = (0..d.spec.configurations.len()).map(|i| per_configuration(d, "momentum", i));
    let fields: Vec<Ident> = fields.collect();
    quote! {
        (T::zero() #(+ length(&(state.#fields.0 - #projected.#fields.0)))*),
        (T::zero() #(+ length(&state.#fields.0))*)
    }
}

/// The size of a number or a vector.
fn size_of(of: &Expr, value: Option<&TokenStream>) -> TokenStream {
    match of.shape().is_scalar() {
        true => quote!((#value)),
        false => quote!(length(&(#value))),
    }
}

/// The equation as text.
fn equation(d: &Derivation, hold: &Hold) -> String {
    format!("{} = {}", text(d, &hold.left), text(d, &hold.right))
}

/// Whether a constraint is scalar.
pub(super) fn is_number(d: &Derivation, j: usize) -> bool {
    shape(d, &d.spec.holds[j]).is_scalar()
}

/// The number of components of a constraint.
pub(super) fn rows(d: &Derivation, j: usize) -> TokenStream {
    match is_number(d, j) {
        true => quote!(1usize),
        false => super::sizes::size(&d.letters.symbols, shape(d, &d.spec.holds[j]).rows),
    }
}

/// The scale of the rate of change of a constraint.
pub(super) fn rate_scale(d: &Derivation, j: usize) -> TokenStream {
    let method = rate_and_scale(d, &d.spec.holds[j]);
    quote!({ let (_, scale) = self.#method(state); scale })
}

/// The function that returns the rate of change and the sum of the sizes of its terms.
fn rate_and_scale(d: &Derivation, hold: &Hold) -> Ident {
    let name = &d.letters.symbols.get(hold.multiplier).ascii;
    format_ident!("constraint_rate_and_scale_{name}")
}
