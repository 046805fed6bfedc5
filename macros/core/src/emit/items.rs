//! Items that hold data, which are the parameters and the validated model, and the locals at the beginning of every
//! emitted function.

use super::expression::{Bindings, Writer, ty};
use super::names::{Names, field, item, own, tagged, variable};
use super::sizes::Generics;
use crate::check::spec::{Advected, Assumption};
use crate::derive::Derivation;
use crate::derive::advection_rule::AdvectionRule;
use crate::derive::select_solver::{Method, StepEquation};
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::print::{Format, Style, expression};
use crate::syntax::ast::Comparison;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

/// An expression as text for documentation and messages.
pub fn text(d: &Derivation, e: &Expr) -> String {
    let style = Style::new(&d.spec.time_index);
    expression(e, &d.letters.symbols, &style, Format::Text)
}

/// The Moser-Veselov factor if the stepper solves that equation; the factor in the body frame if that is the constant
/// one.
pub fn factor(d: &Derivation) -> Option<&Expr> {
    match (&d.solve.method, d.solve.riccati.first()) {
        (Method::FreeMoserVeselov | Method::ForcedMoserVeselov, Some(StepEquation::Exact(mv))) => {
            Some(mv.in_body.as_ref().unwrap_or(&mv.factor))
        }
        (Method::UnitQuaternions, Some(StepEquation::Quaternionic(q))) => q.edge.in_body.as_ref(),
        (Method::LeftFactor, Some(StepEquation::Exact(mv))) if d.solve.turned.is_none() => {
            Some(&mv.factor)
        }
        _ => None,
    }
}

/// The real number in the equation on SU(2). It depends on parameters only.
fn real(d: &Derivation) -> Option<&Expr> {
    match (&d.solve.method, d.solve.riccati.first()) {
        (Method::UnitQuaternions, Some(StepEquation::Quaternionic(q))) => Some(&q.real),
        _ => None,
    }
}

/// The type of the prepared factor, and its constructor applied to the factor.
fn prepared(d: &Derivation, e: &Expr) -> (TokenStream, TokenStream) {
    match (real(d), &d.solve.method) {
        (Some(real), _) => body_of_quaternions(d, e, real),
        (None, Method::LeftFactor) => super::left_factor::prepared(d, 0, e),
        (None, _) => {
            let (value, label) = (written(d, e), text(d, e));
            (
                quote!(Poinsot<T>),
                quote!(Poinsot::new(#value).map_err(|e| e.in_field(#label))),
            )
        }
    }
}

/// An expression in parameters, as Rust code.
fn written(d: &Derivation, e: &Expr) -> TokenStream {
    let none = Bindings::new();
    let writer = Writer {
        symbols: &d.letters.symbols,
        bindings: &none,
    };
    writer.write(e)
}

/// The type of the body for the equation in unit quaternions, and its constructor applied to `A` and `β`.
fn body_of_quaternions(d: &Derivation, a: &Expr, real: &Expr) -> (TokenStream, TokenStream) {
    let label = text(d, if a.is_zero() { real } else { a });
    let (a, real) = (written(d, a), written(d, real));
    (
        quote!(QuaternionBody<T>),
        quote!(QuaternionBody::new(#label, #a, #real)),
    )
}

/// The type of the factor that the solver takes.
pub fn factor_type(d: &Derivation) -> TokenStream {
    match real(d) {
        Some(_) => quote!(QuaternionBody<T>),
        None => quote!(Poinsot<T>),
    }
}

/// The quantities whose reference values determine the factor. If there are any, the factor belongs to a trajectory,
/// otherwise to the model.
pub fn factor_references(d: &Derivation) -> Vec<SymbolId> {
    let letters = factor(d).map(expr::letters).unwrap_or_default();
    let list = kept(d).into_iter();
    list.filter(|id| letters.iter().any(|l| l.symbol == *id))
        .collect()
}

/// The function `factor` of the state, if the factor belongs to a trajectory.
pub fn factor_of_state(d: &Derivation) -> TokenStream {
    let references = factor_references(d);
    let (Some(e), false) = (factor(d), references.is_empty()) else {
        return TokenStream::new();
    };
    let s = &d.letters.symbols;
    let state = item(d, "State");
    let (kind, made) = prepared(d, e);
    let needed = letters_of([e].into_iter().chain(real(d)));
    let parameters = parameter_locals(d, quote!(self.parameters), &needed);
    let locals = references.iter().map(|id| {
        let (own, local) = (own(d, *id), variable(s, *id));
        quote!(let #local = state.#own;)
    });
    let used = Generics::of(d).used();
    quote! {
        /// The factor of the equation at a state, prepared for the solver.
        #[inline(never)]
        fn factor(&self, state: &#state #used) -> Result<#kind, ParameterError> {
            #parameters
            #(#locals)*
            #made
        }
    }
}

/// The quantities that the state stores besides elements and momenta.
pub fn kept(d: &Derivation) -> Vec<SymbolId> {
    let all = d.spec.advected.iter().zip(&d.transports);
    all.filter(|(_, t)| !matches!(t, AdvectionRule::Defined(_)))
        .map(|(a, _)| a.quantity)
        .collect()
}

/// The structure of a parameter as text.
pub fn structure_text(structure: Structure) -> &'static str {
    match structure {
        Structure::General | Structure::Invertible => "",
        Structure::Symmetric => ", symmetric",
        Structure::Skew => ", skew",
        Structure::Diagonal => ", diagonal",
        Structure::Orthogonal => ", a rotation",
        Structure::UnitQuaternion => ", left multiplication by a unit quaternion",
        Structure::RigidMotion => ", the homogeneous matrix of a rigid motion",
    }
}

/// The parameters as plain data.
pub fn parameters(d: &Derivation) -> TokenStream {
    let s = &d.letters.symbols;
    let name = item(d, "Parameters");
    let doc = format!(" The parameters of [`{0}`](struct@{0}).", d.spec.name);
    let fields = d.spec.parameters.iter().map(|p| {
        let symbol = s.get(*p);
        let (field, t) = (own(d, *p), ty(s, symbol.shape));
        let shape = format!("{}{}", shape_text(d, *p), structure_text(symbol.structure));
        let doc = match symbol.doc() {
            said if said.is_empty() => format!(" `{}`: {shape}.", symbol.name),
            said => format!(" `{}`: {said}; {shape}.", symbol.name),
        };
        quote!(#[doc = #doc] pub #field: #t)
    });
    let phantom = d.spec.parameters.is_empty().then(|| {
        quote! {
            #[doc = " The model has no parameters; this field fixes the scalar type."]
            pub scalar: ::core::marker::PhantomData<T>
        }
    });
    let declared = Generics::of(d).declared();
    quote! {
        #[doc = #doc]
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #name #declared { #(#fields,)* #phantom }
    }
}

/// The shape of a symbol as text.
pub fn shape_text(d: &Derivation, id: SymbolId) -> String {
    let s = &d.letters.symbols;
    let shape = s.get(id).shape;
    let (rows, cols) = (s.dim_text(shape.rows), s.dim_text(shape.cols));
    if shape.is_scalar() {
        "a number".to_owned()
    } else if shape.is_vector() {
        format!("a vector of {rows} components")
    } else {
        format!("a matrix of size {rows} x {cols}")
    }
}

/// `let Parameters { a, b, .. } = self.parameters;` for the parameters in `needed`.
pub fn parameter_locals(d: &Derivation, source: TokenStream, needed: &[Letter]) -> TokenStream {
    let used: Vec<_> = d
        .spec
        .parameters
        .iter()
        .filter(|p| needed.iter().any(|l| l.symbol == **p))
        .map(|p| field(d, *p))
        .collect();
    if used.is_empty() {
        return TokenStream::new();
    }
    let name = item(d, "Parameters");
    quote!(let #name { #(#used,)* .. } = #source;)
}

/// The letters of several expressions, sorted.
pub fn letters_of<'a>(list: impl IntoIterator<Item = &'a Expr>) -> Vec<Letter> {
    let mut all: Vec<Letter> = list.into_iter().flat_map(expr::letters).collect();
    all.sort();
    all.dedup();
    all
}

/// `needed` and the letters of the expressions that define its advected quantities at this level.
pub fn with_transports(d: &Derivation, needed: &[Letter], level: i8) -> Vec<Letter> {
    let mut all = needed.to_vec();
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        let here = needed
            .iter()
            .any(|l| l.symbol == a.quantity && l.shift.time == level);
        if !here {
            continue;
        }
        match t {
            AdvectionRule::Defined(e) | AdvectionRule::Carried { value: e, .. } => {
                all.extend(expr::letters(&expr::shift_time(
                    &d.letters.symbols,
                    e,
                    level,
                )));
            }
            AdvectionRule::Advanced => {}
        }
    }
    all.sort();
    all.dedup();
    all
}

/// The quantities without a constant reference value. Their constraint advances them from the values at the node and
/// the velocity.
pub fn advanced(d: &Derivation) -> impl Iterator<Item = &Advected> {
    let pairs = d.spec.advected.iter().zip(&d.transports);
    pairs
        .filter(|(_, t)| matches!(t, AdvectionRule::Advanced))
        .map(|(a, _)| a)
}

/// The clocks whose increment depends only on parameters and the step size. Each comes with its increment and with
/// the field of the state for the low-order part of its value, since a clock is stored in two numbers.
pub fn ticks(d: &Derivation, names: &Names) -> Vec<(SymbolId, Expr, Ident)> {
    let s = &d.letters.symbols;
    let own_amount = |a: &Advected| {
        let amount = expr::sub(a.update.clone(), expr::here(s, a.quantity));
        let role = |l: Letter| s.get(l.symbol).role;
        let still = |l: Letter| matches!(role(l), Role::Parameter | Role::Step);
        let ticks = !amount.is_zero() && expr::letters(&amount).into_iter().all(still);
        ticks.then_some(amount)
    };
    let all = advanced(d).filter_map(|a| Some((a.quantity, own_amount(a)?)));
    all.map(|(q, amount)| (q, amount, tagged(d, names, q, "rest")))
        .collect()
}

/// Locals for the values at one node: matrices of elements, and the advected quantities in `needed`. `element(i)`
/// gives the matrix of an element, `reference(id)` the reference value of a quantity.
pub fn node_locals(
    d: &Derivation,
    names: &Names,
    level: i8,
    needed: &[Letter],
    element: &dyn Fn(usize) -> TokenStream,
    reference: &dyn Fn(SymbolId) -> TokenStream,
    bindings: &mut Bindings,
) -> TokenStream {
    let s = &d.letters.symbols;
    let shift = Shift {
        time: level,
        label: [0, 0],
    };
    let local = |id: SymbolId| match level {
        0 => variable(s, id),
        1 => tagged(d, names, id, "next"),
        _ => tagged(d, names, id, "before"),
    };
    let needed = with_transports(d, needed, level);
    let mut out = TokenStream::new();
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let letter = Letter {
            symbol: c.element,
            shift,
        };
        if needed.contains(&letter) && bindings.rotation(letter).is_none() {
            let (name, value) = (local(c.element), element(i));
            out.extend(quote!(let #name = #value;));
            bindings.bind(letter, name);
        }
    }
    for (a, t) in d.spec.advected.iter().zip(&d.transports) {
        let letter = Letter {
            symbol: a.quantity,
            shift,
        };
        if !needed.contains(&letter) {
            continue;
        }
        let name = local(a.quantity);
        let (found, value) = advected_value(d, names, a, t, level, reference, bindings);
        out.extend(found);
        out.extend(quote!(let #name = #value;));
        bindings.bind(letter, name);
    }
    out
}

/// The statements before an advected quantity at a node, and its value. `bindings` must bind all letters of its
/// definition.
pub fn advected_value(
    d: &Derivation,
    names: &Names,
    a: &Advected,
    transport: &AdvectionRule,
    level: i8,
    reference: &dyn Fn(SymbolId) -> TokenStream,
    bindings: &Bindings,
) -> (TokenStream, TokenStream) {
    let s = &d.letters.symbols;
    let written = |e: &Expr, bindings: &Bindings| {
        let writer = Writer {
            symbols: s,
            bindings,
        };
        writer.write(e)
    };
    let value = match transport {
        AdvectionRule::Defined(e) => written(&expr::shift_time(s, e, level), bindings),
        AdvectionRule::Carried { value, .. } => {
            let start = tagged(d, names, a.quantity, "reference");
            let source = reference(a.quantity);
            let shift = Shift {
                time: level,
                label: [0, 0],
            };
            let letter = Letter {
                symbol: a.quantity,
                shift,
            };
            let mut inner = bindings.clone();
            inner.bind(letter, start.clone());
            let value = written(&expr::shift_time(s, value, level), &inner);
            return (quote!(let #start = #source;), value);
        }
        AdvectionRule::Advanced if level == 1 => written(&a.update, bindings),
        AdvectionRule::Advanced => reference(a.quantity),
    };
    (TokenStream::new(), value)
}

fn assumption(d: &Derivation, a: &Assumption) -> TokenStream {
    let none = Bindings::new();
    holds(&d.letters.symbols, &d.spec.time_index, a, &none)
}

/// The test of an assumption whose letters are bound.
pub(super) fn holds(
    s: &Symbols,
    time_index: &str,
    a: &Assumption,
    bindings: &Bindings,
) -> TokenStream {
    let text = |e: &Expr| expression(e, s, &Style::new(time_index), Format::Text);
    let w = Writer {
        symbols: s,
        bindings,
    };
    let difference = w.operand(&expr::sub(a.left.clone(), a.right.clone()));
    let (sign, shown) = match a.relation {
        Comparison::Equal => ("=", None),
        Comparison::Greater => (">", Some(quote!(#difference.least() > 0.0))),
        Comparison::AtLeast => ("≥", Some(quote!(#difference.least() >= 0.0))),
        Comparison::Less => ("<", Some(quote!(#difference.greatest() < 0.0))),
        Comparison::AtMost => ("≤", Some(quote!(#difference.greatest() <= 0.0))),
    };
    let holds = shown.unwrap_or_else(|| {
        // Equality up to the rounding of a few operations on numbers as large as the terms, because large terms may
        // cancel.
        let bound = w.operand(&expr::magnitude(
            s,
            &expr::sub(a.left.clone(), a.right.clone()),
        ));
        let gap = if a.left.shape().is_scalar() {
            quote!(#difference.magnitude())
        } else {
            quote!(length(&#difference).magnitude())
        };
        quote!(#gap <= 64.0 * T::EPSILON * #bound.magnitude())
    });
    let message = format!("{} {sign} {}", text(&a.left), text(&a.right));
    quote!(validate::assumption(#holds, #message)?;)
}

/// The tests of a value given for a quantity of this shape and structure; `label` is its name in errors.
pub(super) fn admitted(
    label: &str,
    shape: Shape,
    structure: Structure,
    value: &TokenStream,
) -> TokenStream {
    let finite = if shape.is_scalar() {
        quote!(validate::finite(#label, &[#value])?;)
    } else if shape.is_vector() {
        quote!(validate::finite(#label, #value.as_slice())?;)
    } else {
        quote!(validate::finite_entries(#label, &#value)?;)
    };
    let structure = match structure {
        Structure::Symmetric => quote!(validate::symmetric(#label, &#value)?;),
        Structure::Skew => quote!(validate::skew(#label, &#value)?;),
        Structure::Diagonal => quote!(validate::diagonal(#label, &#value)?;),
        Structure::Orthogonal => quote!(validate::orthogonal(#label, &#value)?;),
        Structure::Invertible => quote!(validate::invertible(#label, &#value)?;),
        Structure::UnitQuaternion => quote!(validate::unit_quaternion(#label, &#value)?;),
        Structure::RigidMotion => quote!(validate::rigid_motion(#label, &#value)?;),
        Structure::General => TokenStream::new(),
    };
    quote!(#finite #structure)
}

/// The model: validated parameters, and the factor of its Moser-Veselov equation.
pub fn model(d: &Derivation, documented: bool) -> TokenStream {
    let s = &d.letters.symbols;
    let (name, data) = (item(d, ""), item(d, "Parameters"));
    let checks = d.spec.parameters.iter().map(|p| {
        let symbol = s.get(*p);
        let (field, label) = (own(d, *p), &symbol.name);
        admitted(
            label,
            symbol.shape,
            symbol.structure,
            &quote!(parameters.#field),
        )
    });
    let constant = factor(d).filter(|_| factor_references(d).is_empty());
    let assumed: Vec<&Expr> = d
        .spec
        .assumptions
        .iter()
        .flat_map(|a| [&a.left, &a.right])
        .collect();
    let numbers = constant.and_then(|_| real(d));
    let inverses = super::blocks::kept_inverses(d);
    let in_blocks = super::blocks::factors(d);
    let in_blocks = in_blocks.iter().flat_map(|f| f.made_of());
    let mut needed = letters_of(
        constant
            .into_iter()
            .chain(numbers)
            .chain(assumed)
            .chain(in_blocks)
            .chain(inverses.iter().map(|inverse| &inverse.of)),
    );
    let (arguments, inside) = super::domain::of_parameters(d);
    needed.extend(arguments);
    let locals = parameter_locals(d, quote!(parameters), &needed);
    let assumptions = d.spec.assumptions.iter().map(|a| assumption(d, a));
    let mut kept: Vec<(Ident, TokenStream, TokenStream)> = Vec::new();
    if let Some(e) = constant {
        let (kind, made) = prepared(d, e);
        kept.push((format_ident!("factor"), kind, quote!(#made?)));
    }
    for f in super::blocks::factors(d) {
        let (kind, made) = match f.real {
            Some(real) => body_of_quaternions(d, f.value, real),
            None => super::left_factor::prepared(d, f.configuration, f.value),
        };
        kept.push((f.name, kind, quote!(#made?)));
    }
    for inverse in inverses {
        let (kind, none) = (ty(&d.letters.symbols, inverse.of.shape()), Bindings::new());
        let writer = Writer {
            symbols: &d.letters.symbols,
            bindings: &none,
        };
        let value = writer.write(&inverse.of);
        kept.push((inverse.name, kind, quote!(inverse_or_nan(&(#value)))));
    }
    let field: TokenStream = kept
        .iter()
        .map(|(name, kind, _)| quote!(#name: #kind,))
        .collect();
    let build: TokenStream = kept
        .iter()
        .map(|(name, _, made)| quote!(let #name = #made;))
        .collect();
    let init: TokenStream = kept.iter().map(|(name, _, _)| quote!(#name,)).collect();
    let (solver_field, solver_init) = super::left_factor::of_model(d);
    let docs = crate::document::rustdoc(d, documented);
    let source = crate::document::source(d);
    let fingerprint = crate::document::fingerprint(d);
    let g = Generics::of(d);
    let (declared, bound, used) = (g.declared(), g.bound(), g.used());
    let sizes = sizes(d);
    let admitted = (!sizes.is_empty()).then(|| quote!(let () = Self::ADMITTED;));
    quote! {
        #(#[doc = #docs])*
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #name #declared { parameters: #data #used, #field #solver_field }

        impl #bound #name #used {
            #sizes
            /// The text of the model.
            pub const SOURCE: &'static str = #source;
            /// A hash of the model and the version of clebsch.
            pub const FINGERPRINT: u64 = #fingerprint;

            /// Checks the parameters.
            ///
            /// # Errors
            /// If a parameter is not finite, lacks its declared symmetry, violates an assumption or
            /// is not an admissible factor of the equation of a step. The error names the parameter.
            pub fn new(parameters: #data #used) -> Result<Self, ParameterError> {
                #admitted
                #(#checks)*
                #locals
                #(#assumptions)*
                #inside
                #build
                Ok(Self { parameters, #init #solver_init })
            }
        }
    }
}

/// The test of the const parameters: a size outside its range is a compile-time error.
fn sizes(d: &Derivation) -> TokenStream {
    let names = super::sizes::constants(&d.letters.symbols);
    let tests: Vec<TokenStream> = d
        .spec
        .dimensions
        .iter()
        .zip(&names)
        .map(|(n, name)| {
            let from = Literal::u64_unsuffixed(n.from);
            let to = Literal::u64_unsuffixed(n.to);
            let text = format!(
                "`{}` ranges from {} to {} in this model",
                n.name, n.from, n.to
            );
            quote!(::core::assert!(#from <= #name && #name <= #to, #text);)
        })
        .collect();
    if tests.is_empty() {
        return TokenStream::new();
    }
    quote! {
        /// Sizes that the model does not admit do not compile.
        const ADMITTED: () = { #(#tests)* };
    }
}
