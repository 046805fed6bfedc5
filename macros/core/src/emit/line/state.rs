//! Initial data, positions and momenta at a node, and the values that a step stores for the next one.

use super::items::words;
use super::{Lines, OfMeshes, number};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The items.
pub(super) fn state(l: &Lines, of_meshes: Option<&OfMeshes>) -> TokenStream {
    let [initial, places, momenta, edges, pulls, state, work] = [
        "Initial",
        "Places",
        "Momenta",
        "Edges",
        "Pulls",
        "State",
        "Workspace",
    ]
    .map(|suffix| l.item(suffix));
    let moving: Vec<_> = l.moving().collect();
    let given = moving.iter().map(|m| {
        let (name, sites) = (m.name(), words(m.lone.sites));
        let momentum = format_ident!("momentum_{}", m.mover.name);
        let doc = format!(" `{}` at node 0, at each of the {sites}.", m.mover.name);
        let t = m.covector();
        match m.is_rotation() {
            true => {
                let body = format_ident!("body_momentum_{}", m.mover.name);
                let element = m.element();
                quote! {
                    #[doc = #doc] pub #name: Vec<#element>,
                    /// Its momenta at node 0, in body frames.
                    pub #body: Vec<BodyMomentum<T>>
                }
            }
            false => quote! {
                #[doc = #doc] pub #name: Vec<#t>,
                /// Its momenta at node 0.
                pub #momentum: Vec<#t>
            },
        }
    });
    let names: Vec<_> = moving.iter().map(|m| m.name()).collect();
    let place_lists = moving.iter().map(|m| m.places());
    let momentum_types = moving.iter().map(|m| m.covector());
    let edge_lists = moving.iter().map(|m| m.edges());
    let pull_fields = (1..=l.line.pulls.len()).map(|n| {
        let (field, t) = (format_ident!("pull_{n}"), l.item(&format!("Pull{n}")));
        let count = l
            .line
            .pulls
            .get(n - 1)
            .map(|p| super::neighbour_forces::numbers(l, p));
        quote!(#field: line::Columns<#t<T>, T, #count>)
    });
    let velocities = l.systems().into_iter().map(|(field, n, _)| {
        let n = number(n);
        quote!(#field: Vec<SVector<T, #n>>)
    });
    let access = moving.iter().map(|m| {
        let (name, sites) = (m.name(), words(m.lone.sites));
        let momentum = format_ident!("momentum_{}", m.mover.name);
        let count = format_ident!("count_{}", m.mover.name);
        let t = m.covector();
        let doc = format!(" `{}` at this node, at each of the {sites}.", m.mover.name);
        match m.is_rotation() {
            true => {
                let [spatial, body] = ["spatial_momentum", "body_momentum"]
                    .map(|x| format_ident!("{x}_{}", m.mover.name));
                let element = m.element();
                let told = match m.is_quaternion() {
                    true => quote!(unit_quaternion),
                    false => quote!(rotation),
                };
                quote! {
                    #[doc = #doc]
                    pub fn #name(&self) -> impl ExactSizeIterator<Item = #element> {
                        self.places.#name.iter().take(self.#count).map(|x| x.#told())
                    }
                    /// Its momenta at this node, in the space frame.
                    pub fn #spatial(&self) -> impl ExactSizeIterator<Item = SpatialMomentum<T>> {
                        self.momenta.#name.iter().map(|m| SpatialMomentum(*m))
                    }
                    /// Its momenta at this node, in body frames.
                    pub fn #body(&self) -> impl ExactSizeIterator<Item = BodyMomentum<T>> {
                        let both = self.momenta.#name.iter().zip(self.places.#name.iter());
                        both.map(|(m, x)| BodyMomentum(x.matrix().tr_mul(m)))
                    }
                }
            }
            false => quote! {
                #[doc = #doc]
                pub fn #name(&self) -> &[#t] {
                    &self.places.#name[..self.#count]
                }
                /// Its momenta at this node.
                pub fn #momentum(&self) -> &[#t] {
                    &self.momenta.#name
                }
            },
        }
    });
    let counts = moving.iter().map(|m| {
        let count = format_ident!("count_{}", m.mover.name);
        quote!(#count: usize)
    });
    let (p, v): (Vec<_>, Vec<_>) = (pull_fields.collect(), velocities.collect());
    let band = super::coupled_velocities::band_field(l);
    let held = super::reactions::fields(l);
    let (multipliers, told) = super::reactions::state(l);
    let multiplier_names = super::reactions::names(l);
    let kept_multipliers = l.is_held().then(|| {
        let ty = l.item("Multipliers");
        quote!(multipliers: #ty<T>,)
    });
    let same_multipliers = l
        .is_held()
        .then(|| quote!(&&self.multipliers == other.multipliers));
    let of_functionals = of_meshes.map(|m| &m.fields);
    let meshes = of_meshes.map(|_| {
        let meshes = l.item("Meshes");
        quote!(meshes: #meshes<T>,)
    });
    let boxed = matches!(l.extent(), Some((crate::syntax::ast::Extent::Box(_), _)));
    let reflections = boxed.then(|| quote!(reflections: u64,));
    let counted = boxed.then(|| {
        quote! {
            impl<T: Real> #work<T> {
                /// The number of reflections at walls since the workspace was created.
                pub fn reflections(&self) -> u64 { self.reflections }
            }
        }
    });
    let no_pulls = (p.is_empty() && of_meshes.is_none())
        .then(|| quote!(scalar: ::core::marker::PhantomData<T>));
    quote! {
        /// Initial data.
        #[derive(Clone, Debug, PartialEq)]
        pub struct #initial<T = f64> { #(#given),* }

        /// Positions of all sites, including the sites beyond the last one.
        #[derive(Clone, Debug, PartialEq)]
        struct #places<T> { #(#names: #place_lists),* }

        /// Momenta of all sites; momenta of rotations are in the space frame.
        #[derive(Clone, Debug, PartialEq)]
        struct #momenta<T> { #(#names: Vec<#momentum_types>),* }

        /// Momenta of the edges that begin at a node.
        #[derive(Clone, Debug)]
        struct #edges<T> { #(#names: #edge_lists),* }

        /// The contributions of neighbours at a node.
        #[derive(Clone, Debug)]
        struct #pulls<T> { #(#p,)* #of_functionals #no_pulls }

        #multipliers

        /// The state at one node.
        #[derive(Clone, Debug)]
        pub struct #state<T = f64> {
            places: #places<T>,
            momenta: #momenta<T>,
            #kept_multipliers
            node: u64,
            stamp: line::Stamp,
            #(#counts,)*
        }

        impl<T: Real> #state<T> {
            #(#access)*
            #told
            /// The number of the node.
            pub fn node(&self) -> u64 { self.node }
        }

        ::clebsch::saved_line! { #state { #(#names),* } #(#multiplier_names)* }

        impl<T: Real> PartialEq for #state<T> {
            fn eq(&self, other: &Self) -> bool {
                self.places == other.places && self.momenta == other.momenta && self.node == other.node #same_multipliers
            }
        }

        /// The step size, and the momenta of the edges that begin at the state with the same stamp.
        #[derive(Clone, Debug)]
        pub struct #work<T: Real = f64> {
            h: T,
            model: line::Stamp,
            stamp: line::Stamp,
            places: #places<T>,
            momenta: #momenta<T>,
            edges: #edges<T>,
            pulls: #pulls<T>,
            #meshes
            #reflections
            #(#v,)*
            #band
            #held
        }

        #counted
    }
}
