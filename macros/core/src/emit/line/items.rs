//! The inputs of a model: parameters, numbers of sites and end conditions, and the constructor that validates them.

use super::{Lines, Moving, number};
use crate::check::parameter_shape;
use crate::emit::expression::{Bindings, Writer, ty};
use crate::emit::items::admitted;
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, Symbol};
use crate::lattice::{Kind, Sites};
use crate::line::SiteSolve;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// A parameter: its name, its symbol, and its sites.
pub(super) struct LineParameter<'a> {
    pub name: String,
    pub symbol: &'a Symbol,
    pub at: Option<(usize, Sites)>,
}

impl Lines<'_> {
    /// The parameters in the order of declaration, without the parameters of end conditions and offsets.
    pub(super) fn given(&self) -> Vec<LineParameter<'_>> {
        let part = &self.line.representative;
        let s = &part.d.letters.symbols;
        let of_end = |name: &str| {
            part.unfolded
                .end_parameters
                .iter()
                .any(|(own, ..)| own == name)
        };
        let offset = |name: &str| {
            let mut all = self.line.lattice.quantities.iter();
            all.any(|q| q.offset.as_ref().is_some_and(|o| o.text == name))
        };
        let mut out: Vec<LineParameter> = Vec::new();
        for id in &part.d.spec.parameters {
            let symbol = s.get(*id);
            let (name, at) = match part.sited(*id) {
                Some(sited) => {
                    let q = self.line.lattice.find(&sited.of);
                    if q.is_none_or(|q| q.kind != Kind::Parameter) {
                        continue;
                    }
                    (sited.of, q.map(|q| (q.label, q.sites)))
                }
                None => (symbol.name.clone(), None),
            };
            let known = out.iter().any(|g| g.name == name);
            if known || of_end(&symbol.name) || offset(&symbol.name) {
                continue;
            }
            out.push(LineParameter { name, symbol, at });
        }
        out
    }

    /// The alternatives for one end: the name of their type, and each alternative with its parameters.
    pub(super) fn alternatives(&self, last: bool) -> Option<(Ident, Vec<End>)> {
        let list = &self.line.lattice.ends[usize::from(last)];
        if list.is_empty() {
            return None;
        }
        let s = &self.line.representative.d.letters.symbols;
        let ends = list.iter().map(|a| {
            let names = a.params.iter();
            let names = names.flat_map(|(names, shape)| names.iter().map(move |n| (n, shape)));
            let parameters = names.filter_map(|(name, declared)| {
                let (shape, structure) = parameter_shape(s, declared)?;
                let name = format_ident!("{}", name.text);
                Some(Parameter {
                    name,
                    shape,
                    structure,
                })
            });
            End {
                variant: variant(&a.name.text),
                given: a.given.iter().map(|n| n.text.clone()).collect(),
                parameters: parameters.collect(),
            }
        });
        let suffix = if last { "Last" } else { "First" };
        Some((self.item(suffix), ends.collect()))
    }
}

/// An end condition.
pub(super) struct End {
    pub variant: Ident,
    pub given: Vec<String>,
    pub parameters: Vec<Parameter>,
}

/// A parameter of an end condition.
pub(super) struct Parameter {
    pub name: Ident,
    pub shape: Shape,
    pub structure: Structure,
}

/// The name of an end condition as the name of a variant (`clamped` becomes `Clamped`).
fn variant(name: &str) -> Ident {
    let words = name.split('_').map(|w| {
        let mut letters = w.chars();
        let first = letters.next().map(|c| c.to_uppercase().to_string());
        first.unwrap_or_default() + letters.as_str()
    });
    format_ident!("{}", words.collect::<String>())
}

/// The parameters as plain data.
pub(super) fn parameters(l: &Lines) -> TokenStream {
    let s = &l.line.representative.d.letters.symbols;
    let name = l.item("Parameters");
    let model = l.item("");
    let doc = format!(" The parameters of [`{model}`](struct@{model}).");
    let fields = l.given().into_iter().map(|g| {
        let field = format_ident!("{}", g.name);
        let t = ty(s, g.symbol.shape);
        let said = g.symbol.doc();
        let said = if said.is_empty() {
            String::new()
        } else {
            format!(": {said}")
        };
        let (doc, t) = match g.at {
            None => (format!(" `{}`{said}.", g.name), t),
            Some((_, sites)) => (
                format!(" `{}`{said}; one for each of the {}.", g.name, words(sites)),
                quote!(Vec<#t>),
            ),
        };
        quote!(#[doc = #doc] pub #field: #t)
    });
    let fields: Vec<TokenStream> = fields.collect();
    let phantom = fields.is_empty().then(|| {
        quote! {
            #[doc = " The model has no parameters; this field fixes the scalar type."]
            pub scalar: ::core::marker::PhantomData<T>
        }
    });
    quote! {
        #[doc = #doc]
        #[derive(Clone, Debug, PartialEq)]
        pub struct #name<T = f64> { #(#fields,)* #phantom }
    }
}

/// The kind of sites in words.
pub(super) fn words(sites: Sites) -> &'static str {
    match sites {
        Sites::Nodes => "nodes",
        Sites::Segments => "segments",
        Sites::Members => "sites",
    }
}

/// The numbers of sites, and the end conditions.
pub(super) fn sites(l: &Lines) -> TokenStream {
    let (name, ends) = (l.item("Sites"), l.item("Ends"));
    let s = &l.line.representative.d.letters.symbols;
    let lattice = &l.line.lattice;
    let counts = lattice.labels.iter().map(|label| {
        let (field, index) = (format_ident!("{}", label.count.text), &label.index.text);
        if label.grid {
            let d = number(l.extent().map_or(1, |(_, d)| d));
            return quote!(#[doc = " The number of grid cells in each direction."] pub #field: [usize; #d]);
        }
        let doc = match label.set {
            true => format!(" The number of sites of `{index}`."),
            false => {
                format!(" The number of segments of `{index}`; on a ring, also the number of nodes.")
            }
        };
        quote!(#[doc = #doc] pub #field: usize)
    });
    if lattice.line.is_none() {
        let extent = l.extent_fields();
        return quote! {
            /// The numbers of sites.
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct #name<T = f64> { #(#counts,)* #extent #[doc(hidden)] pub scalar: ::core::marker::PhantomData<T> }
        };
    }
    let mut types = TokenStream::new();
    let mut fields = TokenStream::new();
    for last in [false, true] {
        let Some((kind, alternatives)) = l.alternatives(last) else {
            continue;
        };
        let variants = alternatives.iter().map(|a| {
            let (v, given) = (&a.variant, &a.given);
            let held = match given.as_slice() {
                [] => String::new(),
                list => format!("; {} prescribed at the initial value", list.join(", ")),
            };
            let doc = format!(" `{v}`{held}.");
            let list = a.parameters.iter().map(|p| {
                let (n, t) = (&p.name, ty(s, p.shape));
                let doc = format!(" `{n}` of this end.");
                quote!(#[doc = #doc] #n: #t)
            });
            match a.parameters.is_empty() {
                true => quote!(#[doc = #doc] #v),
                false => quote!(#[doc = #doc] #v { #(#list),* }),
            }
        });
        let doc = match last {
            false => " The condition at the first end.",
            true => " The condition at the last end.",
        };
        // A marker variant that uses the scalar type if no alternative does.
        let none = alternatives.iter().all(|a| a.parameters.is_empty());
        let marker = none.then(|| quote!(#[doc(hidden)] Scalar(::core::marker::PhantomData<T>),));
        types.extend(quote! {
            #[doc = #doc]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub enum #kind<T = f64> { #(#variants,)* #marker }
        });
        let field = if last { quote!(last) } else { quote!(first) };
        fields.extend(quote!(#[doc = #doc] #field: #kind<T>,));
    }
    let open = match fields.is_empty() {
        true => quote!(
            #[doc = " Both ends free."]
            Open
        ),
        false => quote!(#[doc = " Two ends."] Open { #fields }),
    };
    let ring = lattice.periodic.is_some().then(|| {
        let offsets = l.offsets().into_iter().map(|(name, m)| {
            let doc = format!(" The increment of `{}` once around the ring.", m.mover.name);
            let field = format_ident!("{name}");
            let t = m.value();
            quote!(#[doc = #doc] #field: #t)
        });
        let offsets: Vec<TokenStream> = offsets.collect();
        match offsets.is_empty() {
            true => quote!(
                #[doc = " Closed to a ring."]
                Ring,
            ),
            false => quote!(#[doc = " Closed to a ring."] Ring { #(#offsets),* },),
        }
    });
    quote! {
        #types
        /// The end conditions of the chain.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub enum #ends<T = f64> { #open, #ring #[doc(hidden)] Scalar(::core::marker::PhantomData<T>) }

        /// The numbers of sites, and the end conditions.
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct #name<T = f64> {
            #(#counts,)*
            /// The end conditions.
            pub ends: #ends<T>,
        }
    }
}

impl Lines<'_> {
    /// The offsets of a ring without repetition, each with a field that uses it.
    pub(super) fn offsets(&self) -> Vec<(String, Moving<'_>)> {
        let mut out: Vec<(String, Moving)> = Vec::new();
        for m in self.moving() {
            let q = self.line.lattice.find(&m.mover.name);
            if let Some(o) = q.and_then(|q| q.offset.as_ref())
                && !out.iter().any(|(known, _)| *known == o.text)
            {
                out.push((o.text.clone(), m));
            }
        }
        out
    }

    /// The pattern of a ring that binds the given offsets.
    pub(super) fn ring_pattern(&self, offsets: &[String]) -> TokenStream {
        let ends = self.item("Ends");
        match (self.offsets().is_empty(), offsets) {
            (true, _) => quote!(#ends::Ring),
            (_, list) => {
                let fields = list.iter().map(|n| {
                    let (name, local) = (format_ident!("{n}"), super::ends::end_local(n));
                    quote!(#name: #local)
                });
                quote!(#ends::Ring { #(#fields,)* .. })
            }
        }
    }
}

/// The model: validated parameters, factors of the equations, sites.
pub(super) fn model(l: &Lines) -> TokenStream {
    let (name, data, sites) = (l.item(""), l.item("Parameters"), l.item("Sites"));
    let line = l.line;
    let source = l.source;
    let beyond = number(line.beyond());
    let docs = line.model.docs.iter();
    let ring = match line.lattice.periodic {
        Some(_) => {
            let pattern = l.ring_pattern(&[]);
            quote!(matches!(self.sites.ends, #pattern))
        }
        None => quote!(false),
    };
    let mut checks = TokenStream::new();
    for g in l.given() {
        let (field, label) = (format_ident!("{}", g.name), &g.name);
        let (shape, structure) = (g.symbol.shape, g.symbol.structure);
        checks.extend(match g.at {
            None => admitted(label, shape, structure, &quote!(model.parameters.#field)),
            Some((at, kind)) => {
                let words = words(kind);
                let test = admitted(label, shape, structure, &quote!(value));
                let t = ty(&line.representative.d.letters.symbols, shape);
                let expected = l.count_in(quote!(model), at, kind);
                quote! {
                    line::length_of(#label, &model.parameters.#field, #expected, #words)?;
                    line::each(#label, &model.parameters.#field, |&value: &#t| -> Result<(), ParameterError> { #test Ok(()) })?;
                    model.parameters.#field = line::repeated(&model.parameters.#field, #beyond, ring);
                }
            }
        });
    }
    let counts = line.lattice.labels.iter().map(|label| {
        let (field, text) = (format_ident!("{}", label.count.text), &label.count.text);
        if label.grid {
            return quote!(for cells in sites.#field { line::count_of(#text, cells, 1)?; });
        }
        quote! {
            line::count_of(#text, sites.#field, 1)?;
        }
    });
    let (mut fields, mut init, mut made) = Default::default();
    factors(l, &mut fields, &mut init, &mut made);
    let nodes = l.segments().map(|n| {
        quote! {
            /// The number of nodes of the chain.
            pub fn nodes(&self) -> usize {
                self.sites.#n + usize::from(!self.is_ring())
            }
            /// Whether the chain is closed to a ring.
            pub fn is_ring(&self) -> bool {
                #ring
            }
        }
    });
    checks.extend(super::domain::of_parameters(l));
    checks.extend(l.assumptions());
    checks.extend(l.ends_given());
    let functionals = line.meshed.is_some().then(|| quote!(model.meshes()?;));
    let is_ring = match line.lattice.line {
        Some(_) => quote!(model.is_ring()),
        None => quote!(false),
    };
    quote! {
        #(#[doc = #docs])*
        #[derive(Clone, Debug)]
        pub struct #name<T = f64> {
            parameters: #data<T>,
            sites: #sites<T>,
            threads: line::Threads,
            stamp: line::Stamp,
            #fields
        }

        impl<T: Real> #name<T> {
            /// The text of the model.
            pub const SOURCE: &'static str = #source;

            /// Checks the parameters, at every site.
            ///
            /// # Errors
            /// If a value is not admissible or a list has the wrong length. The error names the parameter and the site.
            pub fn new(parameters: #data<T>, sites: #sites<T>) -> Result<Self, LineError> {
                #(#counts)*
                let mut model = Self {
                    parameters,
                    sites,
                    threads: line::Threads::ONE,
                    stamp: line::Stamp::fresh(),
                    #init
                };
                let ring = #is_ring;
                let _ = ring;
                #checks
                #made
                #functionals
                Ok(model)
            }

            /// Distributes the loops over sites to `threads` threads. Results are identical for any number of threads.
            #[must_use]
            pub fn with_threads(self, threads: usize) -> Self {
                Self { threads: line::Threads(threads), ..self }
            }

            /// The numbers of sites, and the end conditions.
            pub fn sites(&self) -> &#sites<T> {
                &self.sites
            }

            #nodes
        }
    }
}

/// The factors of rotations and unit quaternions: one factor, or one per site if it depends on a parameter of sites.
fn factors(l: &Lines, fields: &mut TokenStream, init: &mut TokenStream, made: &mut TokenStream) {
    for m in l.moving() {
        let SiteSolve::Rotation { factor, real, .. } = &m.mover.how else {
            continue;
        };
        let d = m.d();
        let s = &d.letters.symbols;
        let name = format_ident!("factor_{}", m.mover.name);
        let kind = match real {
            Some(_) => quote!(QuaternionBody<T>),
            None => quote!(Poinsot<T>),
        };
        fields.extend(quote!(#name: Vec<#kind>,));
        init.extend(quote!(#name: Vec::new(),));
        let letters = crate::emit::items::letters_of([factor].into_iter().chain(real));
        let varies = letters
            .iter()
            .any(|x| l.is_site_parameter(&s.get(x.symbol).name));
        let told = real.as_ref().filter(|_| factor.is_zero());
        let label = crate::emit::items::text(d, told.unwrap_or(factor));
        let mut bindings = Bindings::new();
        let mut used = Vec::new();
        let locals = letters.iter().map(|x| {
            let own = &s.get(x.symbol).name;
            let base = crate::emit::names::variable(s, x.symbol).to_string();
            let (field, local) = (format_ident!("{own}"), l.unique(own, &base, &mut used));
            bindings.bind(*x, local.clone());
            match (s.get(x.symbol).role, l.is_site_parameter(own)) {
                (Role::Parameter, true) => quote!(let #local = model.parameters.#field[site];),
                (Role::Parameter, false) => quote!(let #local = model.parameters.#field;),
                _ => TokenStream::new(),
            }
        });
        let locals: Vec<TokenStream> = locals.collect();
        let writer = Writer {
            symbols: s,
            bindings: &bindings,
        };
        let value = writer.write(factor);
        let body = match real.as_ref().map(|e| writer.write(e)) {
            Some(real) => quote!(QuaternionBody::new(#label, #value, #real)),
            None => quote!(Poinsot::new(#value).map_err(|e| e.in_field(#label))),
        };
        let count = match varies {
            true => l.count_in(quote!(model), m.lone.label, m.lone.sites),
            false => quote!(1),
        };
        let quantity = &m.mover.name;
        let alike = varies.then(|| quote!(line::once(&mut model.#name);));
        made.extend(quote! {
            for site in 0..#count {
                #(#locals)*
                let made = #body;
                model.#name.push(made.map_err(|error| match #count {
                    1 => LineError::Parameter(error),
                    _ => LineError::Site { at: line::Place { quantity: #quantity, site }, error },
                })?);
            }
            #alike
        });
    }
}
