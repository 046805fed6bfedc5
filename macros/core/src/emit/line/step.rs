//! `start`, `workspace` and `step` of a chain: the order of its loops. A step computes all positions, then the
//! neighbour forces at the new positions, then all momenta. It changes the state only after all of this has
//! succeeded.

use super::force_kernels::{self, ForceForm};
use super::{Lines, Moving, OfMeshes, coupled_velocities, number, reactions, velocity_kernels};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The functions.
pub(super) fn step(
    l: &Lines,
    of_meshes: Option<&OfMeshes>,
    walls: Option<&TokenStream>,
) -> TokenStream {
    let [name, initial, state, work, places, momenta, edges, pulls] = [
        "",
        "Initial",
        "State",
        "Workspace",
        "Places",
        "Momenta",
        "Edges",
        "Pulls",
    ]
    .map(|suffix| l.item(suffix));
    let moving: Vec<_> = l.moving().collect();
    let names: Vec<_> = moving.iter().map(Moving::name).collect();
    let counts: Vec<_> = moving.iter().map(|m| l.count_of(&m.mover.name)).collect();
    let texts: Vec<&String> = moving.iter().map(|m| &m.mover.name).collect();
    let words: Vec<_> = moving
        .iter()
        .map(|m| super::items::words(m.lone.sites))
        .collect();
    let last_places = moving.iter().zip(&counts).map(|(m, count)| {
        let name = m.name();
        m.at(&quote!(state.places.#name), &quote!(#count - 1))
    });
    let ranges = moving.iter().map(|m| range(l, m));
    let checks = moving.iter().map(|m| check(l, m));
    let beyond = number(l.line.beyond());
    let around = super::ring_copies::around(l, &moving);
    let systems = l.systems();
    let (is_kicked, apart): (Vec<_>, Vec<_>) = moving
        .iter()
        .partition(|m| l.body_of(&m.mover.name).is_some());
    let solves = found(l, &apart, &systems, &format_ident!("edges"));
    let searched = l.is_held().then(|| {
        let solved = found(l, &is_kicked, &systems, &format_ident!("kicked"));
        reactions::search(l, &solved)
    });
    let with_reactions = reactions::edges(l);
    let projected = l.is_held().then(|| reactions::project(l));
    let momenta_swapped = match l.is_held() {
        true => TokenStream::new(),
        false => quote!(::core::mem::swap(&mut state.momenta, &mut work.momenta);),
    };
    let begin_held = l
        .is_held()
        .then(|| quote!(self.reached(&state.places, &mut work.here);));
    let no_multipliers = l.is_held().then(|| {
        let none = reactions::no_multipliers(l);
        quote!(multipliers: #none,)
    });
    let admitted = l.is_held().then(|| {
        let admitted = reactions::admitted(l);
        quote! {
            #admitted
            self.begin(&state, &mut work);
        }
    });
    let once = reactions::once(l);
    let arrivals = moving.iter().map(|m| force_kernels::arrive(l, m));
    let beginnings = moving.iter().map(|m| begin(l, m));
    let count_fields: Vec<_> = moving
        .iter()
        .map(|m| format_ident!("count_{}", m.mover.name))
        .collect();
    let edge_values: Vec<TokenStream> = moving
        .iter()
        .map(|m| {
            let own = m.name();
            match m.is_rotation() {
                true => quote!(line::Columns::filled(SMatrix::<T, 3, 1>::zeros(), state.momenta.#own.len())),
                false => quote!(state.momenta.#own.clone()),
            }
        })
        .collect();
    let pull_values = super::neighbour_forces::none_yet(l);
    let mesh_values = of_meshes.map(|m| &m.zeros);
    let meshes_made = of_meshes.map(|_| quote!(meshes: self.meshes()?,));
    let none_reflected = walls.map(|_| quote!(reflections: 0,));
    let (fallible, done) = match of_meshes {
        Some(_) => (quote!(-> Result<(), LineError>), quote!(Ok(()))),
        None => (TokenStream::new(), TokenStream::new()),
    };
    let tried = of_meshes.map(|_| quote!(?));
    let meshed = of_meshes.map(|_| {
        quote! {
            if let Err((quantity, cause)) = self.meshed(h, &work.places, &mut work.meshes, &mut work.pulls) {
                work.stamp = line::Stamp::none();
                return Err(self.refused_by(state, h, quantity, cause));
            }
        }
    });
    let meshed_at_start = of_meshes.map(|_| {
        quote! {
            if let Err((quantity, cause)) = self.meshed(h, &state.places, &mut work.meshes, &mut work.pulls) {
                return Err(LineError::Functional { node: state.node, quantity, cause, works: None });
            }
        }
    });
    let refused_by = of_meshes.map(|_| {
        quote! {
            /// Reports the functional that fails in a step, and a smaller step size that succeeds.
            #[cold]
            fn refused_by(&self, state: &#state<T>, h: T, quantity: &'static str, cause: mesh::MeshError) -> LineError {
                LineError::Functional { node: state.node, quantity, cause, works: self.shorter(state, h) }
            }
        }
    });
    let no_pulls = (l.line.pulls.is_empty() && of_meshes.is_none())
        .then(|| quote!(scalar: ::core::marker::PhantomData));
    let velocity_values = systems.iter().map(|(field, n, members)| {
        let n = number(*n);
        let own = members.first().map(Moving::name);
        quote!(#field: ::std::vec![SVector::<T, #n>::zeros(); state.momenta.#own.len()])
    });
    let band = coupled_velocities::band_value(l);
    let held = reactions::values(l, &quote!(#edges { #(#names: #edge_values),* }));
    let place_values = moving.iter().map(|m| {
        let own = m.name();
        match m.is_rotation() {
            true if m.is_quaternion() => {
                quote!(initial.#own.iter().map(|x| line::Attitude::of_quaternion(*x)).collect())
            }
            true => quote!(initial.#own.iter().map(|x| line::Attitude::new(*x)).collect()),
            false => quote!(initial.#own),
        }
    });
    let momentum_values = moving.iter().map(|m| {
        let own = m.name();
        match m.is_rotation() {
            true => {
                let body = format_ident!("body_momentum_{}", m.mover.name);
                quote!(initial.#body.iter().zip(&initial.#own).map(|(m, x)| m.to_space(x).0).collect())
            }
            false => {
                let momentum = format_ident!("momentum_{}", m.mover.name);
                quote!(initial.#momentum)
            }
        }
    });
    // Functionals use most of the memory of a trajectory. The first step is therefore tried in the state itself, and
    // its workspace is freed before the lasting one is created.
    let alone = of_meshes.is_some() && !l.is_held();
    let first_alone = alone.then(|| {
        quote! {
            {
                let mut scratch = self.workspace(&state, h)?;
                self.defined(&state, h, &scratch)?;
                self.step(&mut state, &mut scratch)?;
                ::core::mem::swap(&mut state.places, &mut scratch.places);
                ::core::mem::swap(&mut state.momenta, &mut scratch.momenta);
                state.node = 0;
                state.stamp = line::Stamp::fresh();
            }
        }
    });
    let first_beside = (!alone).then(|| {
        quote! {
            self.defined(&state, h, &work)?;
            let (mut trial, mut scratch) = (state.clone(), work.clone());
            self.step(&mut trial, &mut scratch)?;
        }
    });
    let defined = defined(l, &moving);
    let mutable = l.is_held().then(|| quote!(mut));
    let agreed = super::signs::agreed(l);
    let (domains, inside) = super::domain::domain(l);
    quote! {
        impl<T: Real> #name<T> {
            /// Starts a trajectory with step size `h` from data at node 0.
            ///
            /// # Errors
            /// If a value is not admissible or the first step fails. The error names the quantity and the
            /// site.
            pub fn start(&self, initial: #initial<T>, h: T) -> Result<(#state<T>, #work<T>), LineError> {
                validate::positive_step(h)?;
                #(#checks)*
                let mut state = #state {
                    places: #places { #(#names: #place_values),* },
                    momenta: #momenta { #(#names: #momentum_values),* },
                    #no_multipliers
                    node: 0,
                    stamp: line::Stamp::fresh(),
                    #(#count_fields: #counts,)*
                };
                #agreed
                #(
                    let last = #last_places;
                    state.places.#names.resize(#counts + #beyond, last);
                )*
                self.around(&mut state.places);
                #first_alone
                let #mutable work = self.workspace(&state, h)?;
                #admitted
                #first_beside
                Ok((state, work))
            }

            /// A workspace for steps of size `h`, of either sign, from any state.
            ///
            /// # Errors
            /// If `h` is zero or not finite.
            pub fn workspace(&self, state: &#state<T>, h: T) -> Result<#work<T>, LineError> {
                validate::directed_step(h)?;
                #(line::length_of(#texts, &state.momenta.#names, #counts, #words)?;)*
                let mut work = #work {
                    h,
                    model: self.stamp,
                    stamp: line::Stamp::none(),
                    places: state.places.clone(),
                    momenta: state.momenta.clone(),
                    edges: #edges { #(#names: #edge_values),* },
                    pulls: #pulls { #(#pull_values,)* #mesh_values #no_pulls },
                    #meshes_made
                    #none_reflected
                    #(#velocity_values,)*
                    #band
                    #held
                };
                #once
                self.begin(state, &mut work) #tried;
                Ok(work)
            }

            /// One step, in place.
            ///
            /// # Errors
            /// If the step fails. The error names the site, the cause and a smaller step size that succeeds; the
            /// state is unchanged.
            pub fn step(&self, state: &mut #state<T>, work: &mut #work<T>) -> Result<(), LineError> {
                let h = work.h;
                #(line::length_of(#texts, &state.momenta.#names, #counts, #words)?;)*
                if work.model != self.stamp {
                    *work = self.workspace(state, h)?;
                } else if work.stamp != state.stamp {
                    self.begin(state, work) #tried;
                }
                #solves
                #searched
                self.around(&mut work.places);
                #walls
                #inside
                self.pulled(h, &work.places, &mut work.pulls);
                #meshed
                work.stamp = line::Stamp::none();
                #with_reactions
                #(#arrivals)*
                #projected
                ::core::mem::swap(&mut state.places, &mut work.places);
                #momenta_swapped
                state.node += 1;
                state.stamp = state.stamp.after(self.stamp, h.value());
                work.stamp = state.stamp;
                Ok(())
            }

            /// The momenta of the edges that begin at this state.
            #[cold]
            fn begin(&self, state: &#state<T>, work: &mut #work<T>) #fallible {
                let h = work.h;
                self.pulled(h, &state.places, &mut work.pulls);
                #begin_held
                #meshed_at_start
                #(#beginnings)*
                work.stamp = state.stamp;
                #done
            }

            #defined
            #refused_by

            /// Reports the site at which a step fails, and a smaller step size that succeeds.
            #[cold]
            #[inline(never)]
            fn refused(&self, state: &#state<T>, h: T, at: line::Place, cause: StepCause) -> LineError {
                LineError::Step { node: state.node, at, cause, works: self.shorter(state, h) }
            }

            /// The largest of `h/2`, `h/4`, ... with which a step from a state succeeds.
            #[cold]
            #[inline(never)]
            fn shorter(&self, state: &#state<T>, h: T) -> Option<f64> {
                let made = |h: T| {
                    let mut work = self.workspace(state, h).ok()?;
                    self.step(&mut state.clone(), &mut work).ok()
                };
                line::shorter(h, |h| made(h).is_some())
            }

            #around
            #(#ranges)*
        }

        #domains
    }
}

/// The code that computes the positions of `moving` at the next node, from the edge momenta in a field of the
/// workspace.
fn found(
    l: &Lines,
    moving: &[&Moving],
    systems: &[(Ident, usize, Vec<Moving>)],
    edges: &Ident,
) -> TokenStream {
    let is_own = |m: &Moving| moving.iter().any(|o| o.mover.name == m.mover.name);
    let own = systems
        .iter()
        .filter(|(.., members)| members.iter().any(is_own));
    let of_systems = own.map(
        |(field, _, members)| match coupled_velocities::is_tied(l, members) {
            true => coupled_velocities::solve(l, field, members),
            false => solve_system(field, members, edges),
        },
    );
    let solves = moving.iter().map(|m| solve(l, m, edges));
    quote!(#(#of_systems)* #(#solves)*)
}

/// The name of the function that gives the range of moving sites.
pub(super) fn range_name(m: &Moving) -> Ident {
    format_ident!("moving_{}", m.mover.name)
}

/// The range of the sites of a configuration that move: all except those that an end condition prescribes.
fn range(l: &Lines, m: &Moving) -> TokenStream {
    let (name, ends, count) = (range_name(m), l.item("Ends"), l.count_of(&m.mover.name));
    let held = |last: bool| {
        let (ty, alternatives) = l.alternatives(last)?;
        let own = alternatives
            .iter()
            .filter(|a| a.given.contains(&m.mover.name));
        let variants: Vec<TokenStream> = own
            .map(|a| {
                let v = &a.variant;
                match a.parameters.is_empty() {
                    true => quote!(#ty::#v),
                    false => quote!(#ty::#v { .. }),
                }
            })
            .collect();
        let field = if last { quote!(last) } else { quote!(first) };
        (!variants.is_empty()).then(|| {
            quote!(usize::from(
                matches!(self.sites.ends, #ends::Open { #field: #(#variants)|*, .. })
            ))
        })
    };
    let first = held(false).unwrap_or_else(|| quote!(0));
    let last = match held(true) {
        Some(held) => quote!((#count - #held).max(first)),
        None => quote!(#count),
    };
    let doc = format!(
        " The range of sites at which `{}` moves: the first site, and the site after the last.",
        m.mover.name
    );
    quote! {
        #[doc = #doc]
        #[inline]
        fn #name(&self) -> [usize; 2] {
            let first = #first;
            [first, #last]
        }
    }
}

/// Tests of initial data.
fn check(l: &Lines, m: &Moving) -> TokenStream {
    let (name, text, count) = (m.name(), &m.mover.name, l.count_of(&m.mover.name));
    let words = super::items::words(m.lone.sites);
    let momentum = match m.is_rotation() {
        true => format!("body_momentum_{text}"),
        false => format!("momentum_{text}"),
    };
    let field = format_ident!("{momentum}");
    let components = match m.is_quaternion() {
        true => quote!(components),
        false => quote!(quaternion),
    };
    let finite = match m.is_rotation() {
        true => quote! {
            line::each(#text, &initial.#name, |x| validate::finite(#text, &x.#components()))?;
            line::each(#momentum, &initial.#field, |x| validate::finite(#momentum, x.0.as_slice()))?;
        },
        false => quote! {
            line::each(#text, &initial.#name, |x| validate::finite(#text, x.as_slice()))?;
            line::each(#momentum, &initial.#field, |x| validate::finite(#momentum, x.as_slice()))?;
        },
    };
    quote! {
        line::length_of(#text, &initial.#name, #count, #words)?;
        line::length_of(#momentum, &initial.#field, #count, #words)?;
        #finite
    }
}

/// The positions of one configuration at the next node.
fn solve(l: &Lines, m: &Moving, edges: &Ident) -> TokenStream {
    let (name, text, range) = (m.name(), &m.mover.name, range_name(m));
    let count = l.count_of(text);
    let fill = match m.system() {
        None => {
            let loop_over_sites = velocity_kernels::loop_over_sites(l, m);
            quote! {
                let (at, edges) = (&state.places, &work.#edges.#name);
                let made = #loop_over_sites;
                if let Err((i, cause)) = made {
                    return Err(self.refused(state, h, line::Place { quantity: #text, site: first + i }, cause));
                }
            }
        }
        Some(_) => {
            let Some((field, _, members)) = l.system_of(m) else {
                return TokenStream::new();
            };
            let before: usize = members
                .iter()
                .take_while(|o| o.mover.name != *text)
                .map(Moving::components)
                .sum();
            let (rows, row) = (number(m.components()), number(before));
            let moved = match m.is_rotation() {
                true => {
                    quote!(at.#name.at(first + i).moved(&velocity[first + i].fixed_rows::<3>(#row).into_owned()))
                }
                false => {
                    quote!(at.#name[first + i] + velocity[first + i].fixed_rows::<#rows>(#row))
                }
            };
            let part = m.part(&quote!(work.places.#name));
            quote! {
                let (at, velocity) = (&state.places, &work.#field);
                line::fill(self.threads, #part, |i| {
                    #moved
                });
            }
        }
    };
    let kept = match m.is_rotation() {
        true => quote! {
            work.places.#name.keep(0..first, &state.places.#name);
            work.places.#name.keep(last..#count, &state.places.#name);
        },
        false => quote! {
            work.places.#name[..first].copy_from_slice(&state.places.#name[..first]);
            work.places.#name[last..#count].copy_from_slice(&state.places.#name[last..#count]);
        },
    };
    quote! {
        {
            let [first, last] = self.#range();
            #fill
            #kept
        }
    }
}

/// The test of the edges at the start. A step would detect a value that is not finite also at the neighbours, and
/// report the first of those sites.
fn defined(l: &Lines, moving: &[Moving]) -> TokenStream {
    let [state, work] = ["State", "Workspace"].map(|suffix| l.item(suffix));
    let tests = moving.iter().map(|m| {
        let (name, text, range) = (m.name(), &m.mover.name, range_name(m));
        let edge = m.at(&quote!(work.edges.#name), &quote!(i));
        quote! {{
            let [first, last] = self.#range();
            let finite = |i: usize| -> Result<(), StepCause> {
                if all_finite(&#edge) { Ok(()) } else { Err(StepCause::not_finite("momentum")) }
            };
            if let Err((site, cause)) = line::try_each(first, last, finite) {
                return Err(self.refused(state, h, line::Place { quantity: #text, site }, cause));
            }
        }}
    });
    quote! {
        /// Reports the site at which an initial impulse is not finite.
        #[cold]
        fn defined(&self, state: &#state<T>, h: T, work: &#work<T>) -> Result<(), LineError> {
            #(#tests)*
            Ok(())
        }
    }
}

/// The velocities of one block of fields.
fn solve_system(field: &Ident, members: &[Moving], edges: &Ident) -> TokenStream {
    let Some(first) = members.first() else {
        return TokenStream::new();
    };
    let (kernel, range, text) = (
        velocity_kernels::kernel(first),
        range_name(first),
        &first.mover.name,
    );
    quote! {
        {
            let [first, last] = self.#range();
            let (at, edges) = (&state.places, &work.#edges);
            let made = line::try_fill(self.threads, &mut work.#field[first..last], |i| {
                self.#kernel(h, first + i, at, edges)
            });
            if let Err((i, cause)) = made {
                return Err(self.refused(state, h, line::Place { quantity: #text, site: first + i }, cause));
            }
        }
    }
}

/// The edge momenta at the start of a step.
fn begin(l: &Lines, m: &Moving) -> TokenStream {
    let name = m.name();
    let acted = force_kernels::call(l, m, &quote!(state.places));
    let part = m.part(&quote!(work.edges.#name));
    let after = match l.force_form(m) {
        ForceForm::Halves => quote!(acting * T::from_f64(0.5)),
        ForceForm::Both => quote!(acting[1]),
    };
    let edge = match m.is_rotation() {
        true => quote! {
            let turn = state.places.#name.at(site).matrix();
            momentum + turn * after
        },
        false => quote!(momentum + after),
    };
    let range = range_name(m);
    quote! {
        {
            let [first, last] = self.#range();
            let pulls = &work.pulls;
            line::fill(self.threads, #part, |i| {
                let site = first + i;
                let acting = #acted;
                let (momentum, after) = (state.momenta.#name[site], #after);
                #edge
            });
        }
    }
}
