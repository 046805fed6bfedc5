//! The stepper of a model with labels, for every number of sites. Takes a [`Line`]; gives Rust items: kernels of one
//! site and of one neighbour term. The runtime (`clebsch::line`) provides loops, threads and errors that name a site.

mod arguments;
mod conserved;
mod constraint_kernels;
mod constraints;
mod coupled_velocities;
mod domain;
mod ends;
mod energy;
mod force_kernels;
mod forms;
mod impulses;
mod inertia;
mod input_checks;
mod items;
mod lanes;
mod locals;
mod meshes;
mod neighbour_forces;
mod reactions;
mod reflection;
mod responses;
mod ring_copies;
mod rows;
mod signs;
mod state;
mod step;
mod totals;
mod unique;
mod velocities;
mod velocity_kernels;

use crate::derive::{Derivation, Outline};
use crate::groups::ElementStorage;
use crate::lattice::{Kind, Sites};
use crate::line::{Line, SiteModel, SiteSolve, SiteUnknown};
use meshes::Emitted as OfMeshes;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeSet;

/// A chain, with the names that the emitted code uses.
struct Lines<'a> {
    line: &'a Line,
    source: &'a str,
    /// The prefixes of the names of temporaries and of relative rotations.
    temporary: String,
    relative: String,
    /// Every name that the model states.
    stated: BTreeSet<String>,
}

/// The items of a model with labels; `source` is its text.
pub fn emit_line(line: &Line, source: &str) -> TokenStream {
    let l = Lines::new(line, source);
    let name = l.item("");
    let module = format_ident!("{}", super::names::module(&line.model.name.text));
    let visibility = line.model.public.then(|| quote!(pub));
    let of_meshes = meshes::meshes(&l);
    let of_meshes = of_meshes.as_ref();
    let walls = reflection::reflection_code(&l);
    let paths = super::functional::paths(&line.representative.d.letters.symbols);
    let items = [
        paths,
        items::parameters(&l),
        items::sites(&l),
        items::model(&l),
        state::state(&l, of_meshes),
        step::step(&l, of_meshes, walls.as_ref().map(|w| &w.call)),
        neighbour_forces::pulls(&l),
        velocity_kernels::solved(&l),
        coupled_velocities::tied(&l),
        force_kernels::all_kernels(&l),
        constraint_kernels::held(&l),
        constraints::residual_functions(&l),
        energy::energy(&l, of_meshes),
        impulses::not_less_than_impulses(&l).unwrap_or_default(),
        of_meshes.map(|m| m.items.clone()).unwrap_or_default(),
        walls.map(|w| w.items).unwrap_or_default(),
    ];
    let about =
        format!(" The model [`{name}`](struct@{name}) with its parameters, states and steps.");
    quote! {
        #[doc = #about]
        #[allow(non_snake_case, non_camel_case_types, uncommon_codepoints, mixed_script_confusables, confusable_idents, clippy::all)]
        #visibility mod #module {
            use ::clebsch::emitted::*;
            #(#items)*
        }
        #[allow(unused_imports)]
        #visibility use #module::*;
    }
}

/// The reason why clebsch emits no stepper with loops over sites, if any.
pub fn refusal_of_line(line: &Line) -> Option<String> {
    let names = unique::refusal(line);
    names
        .or_else(|| domain::refusal(line))
        .or_else(|| reflection::refusal(line))
}

/// A configuration, with the derivation of its site.
#[derive(Clone, Copy)]
struct Moving<'a> {
    lone: &'a SiteModel,
    mover: &'a SiteUnknown,
}

impl Moving<'_> {
    fn d(&self) -> &Derivation {
        &self.lone.d
    }

    fn outline(&self) -> &Outline {
        &self.lone.outline
    }

    fn name(&self) -> Ident {
        format_ident!("{}", self.mover.name)
    }

    /// Whether it is a rotation or a unit quaternion.
    fn is_rotation(&self) -> bool {
        let c = &self.d().spec.configurations[self.mover.index];
        matches!(
            c.group.kept(),
            ElementStorage::Rotation | ElementStorage::Quaternion
        )
    }

    /// Whether it is a unit quaternion.
    fn is_quaternion(&self) -> bool {
        matches!(self.mover.how, SiteSolve::Rotation { real: Some(_), .. })
    }

    /// Rows and columns of a field; for a rotation, the rows and columns of its momentum.
    fn dims(&self) -> (TokenStream, TokenStream) {
        let c = &self.d().spec.configurations[self.mover.index];
        match c.group.kept() {
            ElementStorage::Field(shape) => {
                super::expression::dims(&self.d().letters.symbols, shape)
            }
            _ => (quote!(3), quote!(1)),
        }
    }

    /// The type of its momentum and of forces on it.
    fn covector(&self) -> TokenStream {
        let (rows, cols) = self.dims();
        quote!(SMatrix<T, #rows, #cols>)
    }

    /// The type of the value of a field in initial data.
    fn value(&self) -> TokenStream {
        match self.is_number() {
            true => quote!(T),
            false => self.covector(),
        }
    }

    /// The type of the list of its positions.
    fn places(&self) -> TokenStream {
        match self.is_rotation() {
            true => quote!(line::Attitudes<T>),
            false => {
                let covector = self.covector();
                quote!(Vec<#covector>)
            }
        }
    }

    /// The type of the list of its edge momenta.
    fn edges(&self) -> TokenStream {
        match self.is_rotation() {
            true => quote!(line::Edges<T>),
            false => self.places(),
        }
    }

    /// A mutable part of such a list.
    fn part(&self, list: &TokenStream) -> TokenStream {
        match self.is_rotation() {
            true => quote!(#list.part(first..last)),
            false => quote!(&mut #list[first..last]),
        }
    }

    /// The element of such a list at a site.
    fn at(&self, list: &TokenStream, site: &TokenStream) -> TokenStream {
        match self.is_rotation() {
            true => quote!(#list.at(#site)),
            false => quote!(#list[#site]),
        }
    }

    /// The type of a rotation or unit quaternion in initial data.
    fn element(&self) -> TokenStream {
        match self.is_quaternion() {
            true => quote!(UnitQuaternion<T>),
            false => quote!(Rotation<T>),
        }
    }

    /// Whether it is a scalar field.
    fn is_number(&self) -> bool {
        let c = &self.d().spec.configurations[self.mover.index];
        c.group.shape().is_scalar()
    }

    /// A value of its shape, as an array.
    fn array(&self, value: TokenStream) -> TokenStream {
        match self.is_number() {
            true => quote!(SMatrix::<T, 1, 1>::new(#value)),
            false => value,
        }
    }

    /// The block of velocities or components that contains it, if they are solved together.
    fn system(&self) -> Option<&[usize]> {
        self.mover.how.added()?;
        let mut blocks = self.lone.blocks.iter();
        let own = blocks.find(|b| b.contains(&self.mover.index))?;
        Some(own.as_slice())
    }
}

impl<'a> Lines<'a> {
    /// The item `NameSuffix`.
    fn item(&self, suffix: &str) -> Ident {
        format_ident!("{}{}", self.line.model.name.text, suffix)
    }

    /// All configurations.
    fn moving(&self) -> impl Iterator<Item = Moving<'a>> + use<'a> {
        let line = self.line;
        line.lone
            .iter()
            .flat_map(|lone| lone.movers.iter().map(move |mover| Moving { lone, mover }))
    }

    /// The field with the number of segments or sites of a label.
    fn count_field(&self, label: usize) -> Ident {
        let label = self.line.lattice.labels.get(label);
        format_ident!("{}", label.map_or("", |l| l.count.text.as_str()))
    }

    /// The number of sites of a kind, in the model `of`.
    fn count_in(&self, of: TokenStream, label: usize, sites: Sites) -> TokenStream {
        let field = self.count_field(label);
        if self.line.lattice.is_grid(label) {
            return quote!(#of.setting().nodes());
        }
        match self.line.lattice.line == Some(label) && sites == Sites::Nodes {
            true => quote!(#of.nodes()),
            false => quote!(#of.sites.#field),
        }
    }

    /// The number of sites of a kind.
    fn count(&self, label: usize, sites: Sites) -> TokenStream {
        self.count_in(quote!(self), label, sites)
    }

    fn count_of(&self, name: &str) -> TokenStream {
        match self.line.lattice.find(name) {
            Some(q) => self.count(q.label, q.sites),
            None => quote!(0),
        }
    }

    /// The name of the number of segments of the chain.
    fn segments(&self) -> Option<Ident> {
        let label = self.line.lattice.line_label()?;
        Some(format_ident!("{}", label.count.text))
    }

    /// Whether a quantity is a parameter of sites.
    fn is_site_parameter(&self, name: &str) -> bool {
        let found = self.line.lattice.find(name);
        found.is_some_and(|q| q.kind == Kind::Parameter)
    }
}

fn number(n: usize) -> Literal {
    Literal::usize_unsuffixed(n)
}
