//! Functions that the runtime's protocol adds to a model, to be executed: the functions that change a value of the
//! model, the steps of a forced body, and the observers. Takes the emitted call of `stepper!`; gives functions by type
//! and name. The interpreter implements the rest of the protocol.

use crate::program::type_name;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use std::collections::BTreeMap;
use syn::parse::{Parse, ParseStream};
use syn::punctuated::Punctuated;
use syn::{Ident, LitStr, Token, braced, bracketed, parenthesized};

/// Fields and types of structs by their names.
type Structs = BTreeMap<String, Vec<(String, syn::Type)>>;

/// A type and the names of its fields.
struct Type {
    name: Ident,
    fields: Vec<Ident>,
}

impl Parse for Type {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let name = input.parse()?;
        let fields;
        braced!(fields in input);
        let fields = Punctuated::<Ident, Token![,]>::parse_terminated(&fields)?;
        Ok(Type {
            name,
            fields: fields.into_iter().collect(),
        })
    }
}

/// The functions of a body with external forces.
#[derive(Default)]
struct Forced {
    /// The fields that determine the factor of a trajectory.
    of: Vec<Ident>,
    /// The function that tests a start.
    tests: Option<Ident>,
}

impl Parse for Forced {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let _solved: LitStr = input.parse()?;
        let mut forced = Forced::default();
        while input.parse::<Option<Token![,]>>()?.is_some() {
            let word: Ident = input.parse()?;
            match word == "of" {
                true => {
                    let all = Punctuated::<Ident, Token![&]>::parse_separated_nonempty(input)?;
                    forced.of = all.into_iter().collect();
                }
                false => forced.tests = Some(input.parse()?),
            }
        }
        Ok(forced)
    }
}

/// An observable: its path and its shape.
struct ObservableShape {
    path: Vec<Ident>,
    shape: Option<Ident>,
}

impl Parse for ObservableShape {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let path = Punctuated::<Ident, Token![.]>::parse_separated_nonempty(input)?;
        let shape = match input.parse::<Option<Token![as]>>()? {
            Some(_) => Some(input.parse()?),
            None => None,
        };
        Ok(ObservableShape {
            path: path.into_iter().collect(),
            shape,
        })
    }
}

impl ObservableShape {
    /// The expression for its numbers, from the model, a state, the step and the workspace.
    fn numbers(&self) -> TokenStream {
        let path: Vec<String> = self.path.iter().map(ToString::to_string).collect();
        let path: Vec<&str> = path.iter().map(String::as_str).collect();
        let name = self.path.last();
        let value = match path.as_slice() {
            ["state", _] => quote!(state.#name()),
            ["h", _] => quote!(self.#name(h, state)),
            ["work", _, _] => {
                let element = self.path.get(1);
                let body = quote!(w.solver.body_momentum().to_space(&state.#element()));
                quote!(work.map(|w| #body).unwrap_or(state.#name()))
            }
            _ => quote!(self.#name(state)),
        };
        match self.shape.as_ref().map(ToString::to_string).as_deref() {
            Some("skew") if self.path.len() > 1 => quote!(skew_coordinates(&#value.0)),
            Some("skew") => quote!(skew_coordinates(&#value)),
            Some("spectrum") => quote!(spectrum(#value)),
            _ => quote!(numbers(#value)),
        }
    }
}

/// How the initial value of a configuration is given.
struct Start {
    element: Ident,
    momentum: Ident,
    given: Ident,
    way: Option<Ident>,
}

impl Parse for Start {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let element = input.parse()?;
        input.parse::<Token![,]>()?;
        let momentum = input.parse()?;
        input.parse::<Token![=]>()?;
        let given = input.parse()?;
        let way = match input.parse::<Option<Token![.]>>()? {
            Some(_) => Some(input.parse()?),
            None => None,
        };
        Ok(Start {
            element,
            momentum,
            given,
            way,
        })
    }
}

/// The call.
pub struct Protocol {
    model: Ident,
    initial: Ident,
    state: Type,
    node: Ident,
    work: Ident,
    form: Type,
    forced: Forced,
    choice: Ident,
    coordinates: Option<syn::Expr>,
    start: Option<(Vec<Start>, Vec<Ident>)>,
    observables: Vec<ObservableShape>,
    invariants: Vec<ObservableShape>,
}

impl Parse for Protocol {
    fn parse(input: ParseStream) -> syn::Result<Self> {
        let _sizes;
        bracketed!(_sizes in input);
        let _sizes = _sizes.parse_terminated(Ident::parse, Token![,])?;
        let model = input.parse()?;
        let comma = |input: ParseStream| input.parse::<Token![,]>().map(|_| ());
        comma(input)?;
        let _parameters: Type = input.parse()?;
        comma(input)?;
        let initial: Type = input.parse()?;
        comma(input)?;
        let state = input.parse()?;
        let _at: Ident = input.parse()?;
        let node = input.parse()?;
        comma(input)?;
        let work: Type = input.parse()?;
        comma(input)?;
        let form = input.parse()?;
        let choice = input.parse()?;
        let _orders: Ident = input.parse()?;
        let _judged: Ident = input.parse()?;
        let coordinates = match input.peek(syn::token::Brace) {
            true => {
                let inside;
                braced!(inside in input);
                Some(inside.parse()?)
            }
            false => None,
        };
        let forced = match input.peek(syn::token::Paren) {
            true => {
                let inside;
                parenthesized!(inside in input);
                inside.parse()?
            }
            false => Forced::default(),
        };
        let start = match input.fork().parse::<Ident>()? == "start" {
            true => {
                let _start: Ident = input.parse()?;
                let each;
                braced!(each in input);
                let each = Punctuated::<Start, Token![;]>::parse_terminated(&each)?;
                let rests = match input.peek(syn::token::Brace) {
                    true => {
                        let rests;
                        braced!(rests in input);
                        Punctuated::<Ident, Token![,]>::parse_terminated(&rests)?
                    }
                    false => Punctuated::new(),
                };
                Some((each.into_iter().collect(), rests.into_iter().collect()))
            }
            false => None,
        };
        let shown = |input: ParseStream| {
            let _what: Ident = input.parse()?;
            let inside;
            braced!(inside in input);
            let all = Punctuated::<ObservableShape, Token![,]>::parse_terminated(&inside)?;
            syn::Result::Ok(all.into_iter().collect())
        };
        Ok(Protocol {
            model,
            initial: initial.name,
            state,
            node,
            work: work.name,
            form,
            forced,
            choice,
            coordinates,
            start,
            observables: shown(input)?,
            invariants: shown(input)?,
        })
    }
}

impl Protocol {
    /// The functions, each with its type, of a model with these structs.
    pub fn functions(&self, structs: &Structs) -> Vec<(String, syn::ImplItemFn)> {
        let (model, work) = (self.model.to_string(), self.work.to_string());
        let mut all = Vec::new();
        if self.choice != "nothing" {
            all.push((
                &model,
                syn::parse_quote! {
                    fn with_solver(self, method: Method) -> Self {
                        Self { method, ..self }
                    }
                },
            ));
        }
        if self.form.name == "free" {
            all.push((
                &work,
                syn::parse_quote! {
                    fn compensated(mut self) -> Self {
                        self.solver = self.solver.compensated();
                        self
                    }
                },
            ));
        }
        let step = match self.form.name.to_string().as_str() {
            "forced" => Some(format_ident!("step")),
            "forced_untested" => Some(format_ident!("step_untested")),
            _ => None,
        };
        if let (Some(step), [element, momentum, kept @ ..]) = (step, self.form.fields.as_slice()) {
            all.push((&model, self.prepared()));
            all.push((&model, self.step(&step, element, momentum, kept)));
            all.push((&model, self.refused()));
        }
        if let Some(coordinates) = &self.coordinates {
            let state = &self.state.name;
            all.push((
                &model,
                syn::parse_quote! {
                    fn kinetic_warning(&self, state: &#state) -> Option<KineticWarning> {
                        KineticWarning::of(&self.inertia_at(state), #coordinates)
                    }
                },
            ));
        }
        if let Some((each, rests)) = &self.start {
            all.push((&model, self.begin(each, rests, structs)));
        }
        all.extend([(&model, self.observe()), (&model, self.invariants())]);
        all.into_iter()
            .map(|(ty, function)| (ty.clone(), function))
            .collect()
    }

    fn begin(&self, each: &[Start], rests: &[Ident], structs: &Structs) -> syn::ImplItemFn {
        let (initial, state, node) = (&self.initial, &self.state.name, &self.node);
        let types = structs.get(&initial.to_string());
        let numbers_of = |element: &Ident| {
            let field = types
                .into_iter()
                .flatten()
                .find(|(name, _)| element == name);
            let ty = field.and_then(|(_, ty)| type_name(ty)).unwrap_or_default();
            match ty.as_str() {
                "Rotation" => quote!(&initial.#element.quaternion()),
                "UnitQuaternion" => quote!(&initial.#element.components()),
                _ => quote!(initial.#element.matrix().as_slice()),
            }
        };
        let checks = each.iter().map(|start| {
            let (element, given) = (&start.element, &start.given);
            let (name, momentum, numbers) =
                (element.to_string(), given.to_string(), numbers_of(element));
            quote! {
                validate::finite(#name, #numbers)?;
                validate::finite(#momentum, initial.#given.0.as_slice())?;
            }
        });
        let fields = each.iter().map(|start| {
            let Start {
                element,
                momentum,
                given,
                way,
            } = start;
            let way = way.as_ref().map(|way| quote!(.#way(&initial.#element)));
            quote!(#element: initial.#element, #momentum: initial.#given #way)
        });
        syn::parse_quote! {
            fn begin(&self, initial: #initial) -> Result<#state, StartError> {
                #(#checks)*
                Ok(#state { #(#fields,)* #(#rests: SMatrix::zeros(),)* #node: 0 })
            }
        }
    }

    fn prepared(&self) -> syn::ImplItemFn {
        let (state, work) = (&self.state.name, &self.work);
        let tests = self.forced.tests.iter();
        let factor = (!self.forced.of.is_empty()).then(|| quote!(factor: self.factor(state)?,));
        syn::parse_quote! {
            fn prepared(&self, state: &#state, h: T, choice: Option<Method>) -> Result<#work, StartError> {
                #(self.#tests(state, h)?;)*
                let method = choice.unwrap_or(self.method);
                Ok(#work { h, method, #factor edge: self.edge(state, h), here: *state })
            }
        }
    }

    fn step(
        &self,
        step: &Ident,
        element: &Ident,
        momentum: &Ident,
        kept: &[Ident],
    ) -> syn::ImplItemFn {
        let (state, node, work) = (&self.state.name, &self.node, &self.work);
        let of = &self.forced.of;
        let (factor, another) = match of.is_empty() {
            true => (quote!(&self.factor), None),
            false => {
                let another = quote! {
                    if !(#(same(&work.here.#of, &state.#of))&*) {
                        work.factor = match self.factor(state) {
                            Ok(factor) => factor,
                            Err(_) => return Err(StepCause::not_finite("body").at_node(state.#node)),
                        };
                    }
                };
                (quote!(&work.factor), Some(another))
            }
        };
        let finite = (step == "step").then(|| {
            quote! {
                if !(all_finite(&arrival.momentum.0)) {
                    return Err(StepCause::not_finite("momentum").at_node(state.#node));
                }
            }
        });
        syn::parse_quote! {
            fn #step(&self, state: &mut #state, work: &mut #work) -> Result<(), StepError> {
                let h = work.h;
                if work.here.#element != state.#element
                    || work.here.#momentum != state.#momentum
                    #(|| !(same(&work.here.#kept, &state.#kept)))*
                {
                    #another
                    work.edge = self.edge(state, h);
                    work.here = *state;
                }
                let edge = &work.edge;
                let turned = match work.method {
                    Method::Kappa => edge.turn(#factor, h, &state.#element),
                    method => edge.turn_by(method, #factor, h, &state.#element),
                };
                let turned = match turned {
                    Ok(turned) => turned,
                    Err(e) => return Err(self.refused(*state, #factor, h, e)),
                };
                let arrival = self.arrived(state, edge, h, turned);
                #finite
                (state.#element, work.here.#element) = (arrival.attitude, arrival.attitude);
                (state.#momentum, work.here.#momentum) = (arrival.momentum, arrival.momentum);
                state.#node += 1;
                work.edge = arrival.edge;
                Ok(())
            }
        }
    }

    fn refused(&self) -> syn::ImplItemFn {
        let (state, node) = (&self.state.name, &self.node);
        syn::parse_quote! {
            #[cold]
            fn refused(&self, state: #state, factor: &Poinsot<T>, h: T, e: MoserVeselovError) -> StepError {
                let e = e.with_searched_step(factor, h, |trial| self.edge(&state, trial).body());
                StepCause::from(e).at_node(state.#node)
            }
        }
    }

    fn observe(&self) -> syn::ImplItemFn {
        let (state, shown) = (&self.state.name, &self.observables);
        let shown = shown.iter().map(ObservableShape::numbers);
        syn::parse_quote! {
            fn observe(&self, state: &#state, out: &mut [f64]) {
                #(let out = put(out, #shown);)*
            }
        }
    }

    fn invariants(&self) -> syn::ImplItemFn {
        let (state, work, shown) = (&self.state.name, &self.work, &self.invariants);
        let shown = shown.iter().map(ObservableShape::numbers);
        syn::parse_quote! {
            fn invariants(&self, state: &#state, h: f64, work: Option<&#work>, out: &mut [f64]) {
                #(let out = put(out, #shown);)*
            }
        }
    }
}
