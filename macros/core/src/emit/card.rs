//! The model as data: fields of its parameters, initial values, observables and invariants, and a
//! way to run it without knowing its type. What the command line and the generic tests use.

use super::element::{self, Family, family};
use super::formula::formula;
use super::invariants::{Form, scale};
use super::items::kept;
use super::names::{Names, item, kebab, own};
use super::sizes::{Generics, size};
use crate::check::spec::Side;
use crate::derive::Derivation;
use crate::derive::invariants::Kind;
use crate::derive::kinetic::{self, Kinetic};
use crate::derive::recognise::Method;
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Symbol, SymbolId, Symbols};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

struct FieldOf {
    name: String,
    shape: Shape,
    kind: &'static str,
    doc: String,
}

impl FieldOf {
    fn tokens(&self, s: &Symbols) -> TokenStream {
        let (name, doc) = (&self.name, &self.doc);
        let ascii = crate::expr::symbol::ascii(name);
        let (rows, cols) = super::expression::dims(s, self.shape);
        let kind = format_ident!("{}", self.kind);
        quote! {
            Field { name: #name, ascii: #ascii, rows: #rows, cols: #cols, kind: Kind::#kind, doc: #doc }
        }
    }
}

fn of_symbol(d: &Derivation, id: SymbolId, when: &str) -> FieldOf {
    let symbol = d.letters.symbols.get(id);
    let kind = if symbol.shape.is_scalar() {
        "Scalar"
    } else if symbol.shape.is_vector() {
        "Vector"
    } else {
        let moments =
            |form: &Kinetic| kinetic::is_second_moment(&d.spec, &d.letters, &form.energy, id);
        match symbol.structure {
            Structure::Symmetric if d.kinetic.as_ref().is_some_and(moments) => "SecondMoments",
            Structure::Symmetric => "Symmetric",
            Structure::Skew => "Skew",
            Structure::Diagonal => "Diagonal",
            Structure::General
            | Structure::Orthogonal
            | Structure::Invertible
            | Structure::UnitQuaternion
            | Structure::RigidMotion => "Matrix",
        }
    };
    FieldOf {
        name: symbol.name.clone(),
        shape: symbol.shape,
        kind,
        doc: said(symbol, when),
    }
}

/// What the model says of a symbol, else what its place says.
fn said(symbol: &Symbol, else_words: &str) -> String {
    match symbol.doc() {
        doc if doc.is_empty() => else_words.to_owned(),
        doc => doc,
    }
}

fn element_field(d: &Derivation, i: usize) -> FieldOf {
    let c = &d.spec.configurations[i];
    let (kind, doc) = match family(c) {
        Family::Rotation | Family::Orthogonal(_) => ("Rotation", "attitude, body to space"),
        Family::Quaternion => ("UnitQuaternion", "attitude (w, x, y, z), body to space"),
        Family::Coordinates(names) => (names.kind, names.words),
        Family::Linear(_) => ("Matrix", "configuration, reference to space"),
        Family::Field(shape) => match (shape.is_scalar(), shape.is_vector()) {
            (true, _) => ("Scalar", "field"),
            (false, true) => ("Vector", "field"),
            (false, false) => ("Matrix", "field"),
        },
    };
    FieldOf {
        name: d
            .letters
            .symbols
            .get(d.spec.configurations[i].element)
            .name
            .clone(),
        shape: match family(c) {
            // Four components say the same as the matrix.
            Family::Quaternion => Shape::vector(c.group.size()),
            _ => c.group.shape(),
        },
        kind,
        doc: said(d.letters.symbols.get(c.element), doc),
    }
}

fn momentum_field(d: &Derivation, i: usize, side: Side) -> FieldOf {
    let c = &d.spec.configurations[i];
    let (kind, doc) = match side {
        _ if c.group.is_additive() => {
            let name = &d.letters.symbols.get(c.element).name;
            ("FieldMomentum", format!("momentum of {name}"))
        }
        Side::Body => ("BodyMomentum", "momentum, body frame".to_owned()),
        Side::Spatial => ("SpatialMomentum", "momentum, space frame".to_owned()),
    };
    FieldOf {
        name: element::momentum_field(d, i, side).to_string(),
        shape: d.letters.symbols.get(d.letters.node_momentum[i]).shape,
        kind,
        doc,
    }
}

/// `CARD` and the trajectory behind it.
pub fn card(d: &Derivation, names: &Names) -> TokenStream {
    let (name, state, work) = (item(d, ""), item(d, "State"), item(d, "Workspace"));
    let preprocessed = super::stepper::preprocessed(d);
    let trajectory = item(d, "Trajectory");
    let count = d.spec.configurations.len();
    let parameters: Vec<FieldOf> = d
        .spec
        .parameters
        .iter()
        .map(|p| of_symbol(d, *p, ""))
        .collect();
    let mut initial = Vec::new();
    let mut observables = Vec::new();
    let mut observed = Vec::new();
    for i in 0..count {
        let c = &d.spec.configurations[i];
        initial.push(element_field(d, i));
        initial.push(momentum_field(d, i, c.side));
        observables.push(element_field(d, i));
        let element = own(d, c.element);
        let (b, s) = (
            element::momentum_field(d, i, Side::Body),
            element::momentum_field(d, i, Side::Spatial),
        );
        if c.group.is_additive() {
            observables.push(momentum_field(d, i, c.side));
            observed.push(quote! {
                let out = put(out, rows(state.#element().matrix()));
                let out = put(out, rows(state.#s().0));
            });
            continue;
        }
        observables.push(momentum_field(d, i, Side::Body));
        observables.push(momentum_field(d, i, Side::Spatial));
        let numbers = match family(c) {
            Family::Quaternion => quote!(state.#element().components()),
            _ => quote!(rows(state.#element().matrix())),
        };
        observed.push(quote! {
            let out = put(out, #numbers);
            let out = put(out, rows(state.#b().0));
            let out = put(out, rows(state.#s().0));
        });
    }
    for id in kept(d) {
        initial.push(of_symbol(d, id, "value at node 0"));
    }
    for a in &d.spec.advected {
        observables.push(of_symbol(d, a.quantity, ""));
        let method = own(d, a.quantity);
        let scalar = d.letters.symbols.get(a.quantity).shape.is_scalar();
        observed.push(if scalar {
            quote!(let out = put(out, [self.model.#method(state)]);)
        } else {
            quote!(let out = put(out, rows(self.model.#method(state)));)
        });
    }
    let mut values = TokenStream::new();
    let mut scales = TokenStream::new();
    let invariants: Vec<TokenStream> = d
        .invariants
        .iter()
        .map(|v| {
            let (label, text) = (&v.name, formula(d, v));
            let rows = super::invariants::rows(d, v);
            let conserved = format_ident!("{}", if v.exact { "Exactly" } else { "Boundedly" });
            let method = format_ident!("{}", v.name);
            values.extend(match &v.kind {
                Kind::SpatialMomentum(i) => {
                    let m = element::momentum_field(d, *i, Side::Spatial);
                    let element = own(d, d.spec.configurations[*i].element);
                    // The state keeps the spatial momentum; what shows a drift is the momentum that
                    // the solver iterates in the body, seen from space.
                    match d.solve.method {
                        Method::FreeMoserVeselov => quote! {
                            let momentum = self.work.solver.body_momentum().to_space(&state.#element());
                            let out = put(out, rows(momentum.0));
                        },
                        Method::ForcedMoserVeselov
                        | Method::UnitQuaternions
                        | Method::LeftFactor
                        | Method::Davenport
                        | Method::Linear
                        | Method::Newton
                        | Method::Blocks => {
                            match family(&d.spec.configurations[*i]) {
                                Family::Rotation
                                | Family::Linear(_)
                                | Family::Quaternion
                                | Family::Field(_)
                                | Family::Coordinates(_) => {
                                    quote!(let out = put(out, rows(state.#m().0));)
                                }
                                Family::Orthogonal(_) => {
                                    quote!(let out = put(out, skew_coordinates(&state.#m().0));)
                                }
                            }
                        }
                    }
                }
                Kind::Value | Kind::Energy | Kind::TotalMomentum(_) | Kind::Spectrum => {
                    let value = quote!(self.model.#method(state));
                    match super::invariants::form(d, v) {
                        Form::Number => quote!(let out = put(out, [#value]);),
                        Form::Entries => quote!(let out = put(out, rows(#value));),
                        Form::Skew => quote!(let out = put(out, skew_coordinates(&#value));),
                        Form::Spectrum => quote!(let out = put(out, spectrum(#value));),
                    }
                }
            });
            if matches!(v.kind, Kind::Spectrum) {
                let sizes = super::invariants::spectrum_scales(d, names);
                scales.extend(quote!(let out = put(out, #sizes);));
            } else {
                let sizes = scale(d, names, v);
                scales.extend(quote!(let out = put(out, #sizes);));
            }
            quote! {
                Invariant { name: #label, formula: #text, rows: #rows, conserved: Conserved::#conserved }
            }
        })
        .collect();
    let constructor = constructor(d);
    let (kebab_name, model_name) = (kebab(&d.spec.name), &d.spec.name);
    let doc = d
        .spec
        .docs
        .iter()
        .map(|l| l.trim())
        .collect::<Vec<_>>()
        .join(" ");
    let summary = crate::document::summary(d);
    let solver = format!(
        "{}: {}",
        match d.solve.method {
            Method::FreeMoserVeselov
            | Method::ForcedMoserVeselov
            | Method::LeftFactor
            | Method::Davenport => "Moser-Veselov",
            Method::UnitQuaternions => "Unit quaternions",
            Method::Newton => "Newton",
            Method::Blocks if d.solve.blocks.len() == 1 => "Explicit",
            Method::Linear => "Explicit",
            Method::Blocks => "Blocks",
        },
        d.how_solved()
    );
    // A symmetric one-step action gives an even order; one-sided nodal terms leave order one.
    let order: u32 = if d.reversible { 2 } else { 1 };
    let reversible = d.reversible;
    let discrete_energy = discrete_energy(d);
    let fields = |list: &[FieldOf]| -> Vec<TokenStream> {
        list.iter().map(|f| f.tokens(&d.letters.symbols)).collect()
    };
    let (p, i, o) = (fields(&parameters), fields(&initial), fields(&observables));
    let g = Generics::of(d);
    let (bound, used, plain) = (g.sizes_bound(), g.sizes_used(), g.plain());
    let solvers = super::left_factor::offered(d);
    let choose = match super::left_factor::default_solver(d).is_some() {
        true => quote! {
            let model = match chosen_solver(settings, Self::CARD.solvers)? {
                Some(method) => model.with_solver(method),
                None => model,
            };
        },
        false => quote!(chosen_solver(settings, Self::CARD.solvers)?;),
    };
    let turbofish = (!used.is_empty()).then(|| quote!(:: #used));
    let (dimensions, sized) = (dimensions(d), sized(d));
    let kinetic_warning = super::kinetic::kinetic_warning(d, names);
    // Judged before the first step is tried: it may be why that is refused.
    let [judge, told] = match kinetic_warning.is_empty() {
        true => [quote!(let kinetic = None;), quote!()],
        false => [
            quote!(let kinetic = model.kinetic_warning(&state);),
            quote!(.map_err(|e| OpenError::from(e).beside(kinetic))),
        ],
    };
    let orders = match (preprocessed, d.reversible) {
        (true, _) => quote!(&[2, 4, 6, 8, 10]),
        (false, true) => quote!(&[2, 4, 6, 8]),
        (false, false) => quote!(&[1]),
    };
    let (work, h, step, begin) = if preprocessed {
        (
            quote!(work: #work #plain),
            quote!(self.work.h),
            quote!(self.model.step(&mut self.state, &mut self.work)),
            quote! {
                let order = preprocessing_order(settings, Self::CARD.orders)?;
                let state = model.at_node_0(initial)?;
                #judge
                let (state, work) = model.start_of_order(initial, settings.h, order)#told?;
                let work = if settings.compensated { work.compensated() } else { work };
                let plain = order == Order::Two;
                Ok(Box::new(#trajectory #turbofish { model, state, work, before: state, plain, kinetic }))
            },
        )
    } else {
        let of_order = match d.reversible {
            true => quote!(of_order),
            false => quote!(plain),
        };
        (
            quote!(steps: Steps<#name #plain>, h: f64),
            quote!(self.h),
            quote!(self.steps.step(&self.model, &mut self.state)),
            quote! {
                let state = model.at_node_0(initial)?;
                #judge
                let steps = Steps::#of_order(&model, &state, settings, Self::CARD.orders)#told?;
                let plain = matches!(steps, Steps::Plain(_));
                Ok(Box::new(#trajectory #turbofish { model, state, steps, h: settings.h, before: state, plain, kinetic }))
            },
        )
    };
    quote! {
        /// One trajectory of the model, its type hidden.
        struct #trajectory #bound {
            model: #name #plain,
            state: #state #plain,
            #work,
            /// The state before the last step.
            before: #state #plain,
            /// Whether a step is one of the derivation, not composed and without modified moments.
            plain: bool,
            kinetic: Option<KineticWarning>,
        }

        impl #bound Trajectory for #trajectory #used {
            fn node(&self) -> u64 { self.state.node() }
            fn time(&self) -> f64 { #h * self.state.node() as f64 }
            fn step(&mut self) -> Result<(), StepError> {
                let before = self.state;
                #step?;
                self.before = before;
                Ok(())
            }
            fn card(&self) -> &'static Card { &#name::#plain::CARD }
            fn kinetic_warning(&self) -> Option<KineticWarning> { self.kinetic }
            fn residual(&self) -> Option<f64> {
                let moved = self.before.node() != self.state.node();
                (self.plain && moved).then(|| {
                    Residual::largest(&self.model.residual(&self.before, &self.state, #h))
                })
            }
            fn observe(&self, out: &mut [f64]) {
                let state = &self.state;
                #(#observed)*
                let _ = out;
            }
            fn invariants(&self, out: &mut [f64]) {
                let state = &self.state;
                #values
                let _ = out;
            }
            fn scales(&self, out: &mut [f64]) {
                let state = &self.state;
                #scales
                let _ = out;
            }
        }

        impl #bound #name #plain {
            /// The model as data.
            pub const CARD: Card = Card {
                name: #model_name,
                kebab: #kebab_name,
                doc: #doc,
                source: Self::SOURCE,
                fingerprint: Self::FINGERPRINT,
                summary: #summary,
                solver: #solver,
                order: #order,
                orders: #orders,
                preprocessed: #preprocessed,
                reversible: #reversible,
                parameters: &[#(#p),*],
                initial: &[#(#i),*],
                observables: &[#(#o),*],
                invariants: &[#(#invariants),*],
                discrete_energy: #discrete_energy,
                open: Self::open,
                solvers: #solvers,
                dimensions: &[#(#dimensions),*],
                sized: Self::sized,
            };

            #kinetic_warning

            #sized

            fn open(parameters: &[Vec<f64>], initial: &[Vec<f64>], settings: Settings) -> Result<Box<dyn Trajectory>, OpenError> {
                #constructor
                #choose
                #begin
            }
        }
    }
}

/// The discrete energy as data.
fn discrete_energy(d: &Derivation) -> TokenStream {
    let energy = &d.integrability.discrete_energy;
    let formula = super::items::text(d, &energy.value);
    let conserved = format_ident!("{}", if energy.exact { "Exactly" } else { "Boundedly" });
    quote! {
        Invariant {
            name: "discrete_energy",
            formula: #formula,
            rows: 1,
            conserved: Conserved::#conserved,
        }
    }
}

/// From lists of numbers to parameters and initial data.
fn constructor(d: &Derivation) -> TokenStream {
    let s = &d.letters.symbols;
    let (name, data, start) = (item(d, ""), item(d, "Parameters"), item(d, "Initial"));
    let read = |id: SymbolId, source: TokenStream, index: usize| {
        let (field, label) = (own(d, id), &s.get(id).name);
        if s.get(id).shape.is_scalar() {
            quote!(#field: number_of(#label, #source.get(#index))?)
        } else {
            quote!(#field: matrix_of(#label, #source.get(#index))?)
        }
    };
    let mut parameters: Vec<TokenStream> = d
        .spec
        .parameters
        .iter()
        .enumerate()
        .map(|(i, p)| read(*p, quote!(parameters), i))
        .collect();
    if parameters.is_empty() {
        parameters.push(quote!(scalar: ::core::marker::PhantomData));
    }
    let mut initial = Vec::new();
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let (element, label) = (own(d, c.element), &s.get(c.element).name);
        let index = 2 * i;
        let read = match family(c) {
            Family::Rotation => quote!(rotation_of),
            Family::Orthogonal(_) => quote!(orthogonal_of),
            Family::Linear(_) => quote!(linear_of),
            Family::Quaternion => quote!(quaternion_of),
            Family::Coordinates(names) => {
                let reader = format_ident!("{}", names.reader);
                quote!(#reader)
            }
            Family::Field(_) => quote!(additive_of),
        };
        initial.push(quote!(#element: #read(#label, initial.get(#index))?));
        let field = element::momentum_field(d, i, c.side);
        let label = field.to_string();
        let kind = element::momentum_name(d, i, c.side);
        let index = index + 1;
        initial.push(quote!(#field: #kind(matrix_of(#label, initial.get(#index))?)));
    }
    for (i, id) in kept(d).into_iter().enumerate() {
        initial.push(read(
            id,
            quote!(initial),
            2 * d.spec.configurations.len() + i,
        ));
    }
    let (np, ni) = (d.spec.parameters.len(), initial.len());
    quote! {
        for (field, expected, found) in [
            ("parameters", #np, parameters.len()),
            ("initial values", #ni, initial.len()),
        ] {
            if expected != found {
                return Err(OpenError::Count { field, expected, found });
            }
        }
        let model = #name::new(#data { #(#parameters),* })?;
        let initial = #start { #(#initial),* };
    }
}

/// The named sizes of the model, with the value of this card.
fn dimensions(d: &Derivation) -> Vec<TokenStream> {
    let s = &d.letters.symbols;
    let list = d.spec.dimensions.iter().zip(0u16..);
    list.map(|(n, i)| {
        let (name, value) = (&n.name, size(s, crate::expr::shape::Dim::Named(i)));
        let (from, to) = (
            Literal::u64_unsuffixed(n.from),
            Literal::u64_unsuffixed(n.to),
        );
        quote!(Dimension { name: #name, from: #from, to: #to, value: #value })
    })
    .collect()
}

/// The card at other sizes: one arm for each of them.
fn sized(d: &Derivation) -> TokenStream {
    let name = item(d, "");
    let mut all: Vec<Vec<u64>> = vec![Vec::new()];
    for n in &d.spec.dimensions {
        all = all
            .into_iter()
            .flat_map(|sizes| {
                (n.from..=n.to).map(move |value| {
                    let mut sizes = sizes.clone();
                    sizes.push(value);
                    sizes
                })
            })
            .collect();
    }
    let arms = all.iter().map(|sizes| {
        let sizes: Vec<Literal> = sizes.iter().map(|n| Literal::u64_unsuffixed(*n)).collect();
        quote!([#(#sizes),*] => Some(#name::<#(#sizes,)* f64>::CARD),)
    });
    quote! {
        /// The card of the model at the given sizes, in the order of their declaration.
        fn sized(sizes: &[usize]) -> Option<Card> {
            match sizes {
                #(#arms)*
                _ => None,
            }
        }
    }
}
