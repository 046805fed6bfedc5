//! Functionals of all sites in a step: their values at the new positions, the seeds of their pull-backs, and their
//! forces. Each value and each pull-back is an array over its sites. The runtime's functional or a loop over sites
//! fills it.

use super::locals::step;
use super::neighbour_forces::stated_letters;
use super::{Lines, number};
use crate::algebra::Algebra;
use crate::emit::functional::path;
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Node, Reach};
use crate::lattice::{FunctionalKind, Mesh, Sites, Source};
use crate::line::FunctionalForce;
use crate::syntax::ast::Extent;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The array of the values of a functional, or of its pull-back.
struct Array {
    /// The letter for one element.
    symbol: SymbolId,
    /// The expression of one element.
    of: Expr,
    /// The field of the workspace.
    field: Ident,
    /// The index of its functional.
    mesh: usize,
    /// The label of its sites.
    label: usize,
    /// The seed, if the array is a pull-back.
    seed: Option<Expr>,
}

/// The arrays that a step computes for functionals.
struct Plan<'a> {
    l: &'a Lines<'a>,
    symbols: Symbols,
    arrays: Vec<Array>,
}

/// The local of an array. No name of a model starts with `__`.
fn local(field: &Ident) -> Ident {
    format_ident!("__{field}")
}

impl<'a> Lines<'a> {
    /// The field of particle positions with its domain, and the number of dimensions.
    pub(super) fn extent(&self) -> Option<(&Extent, usize)> {
        let q = self.line.lattice.places()?;
        Some((q.domain.as_ref()?, q.shape.components()?))
    }

    /// The fields of the domain, next to the numbers of sites.
    pub(super) fn extent_fields(&self) -> TokenStream {
        let Some((extent, directions)) = self.extent() else {
            return TokenStream::new();
        };
        let d = number(directions);
        match extent {
            Extent::Torus(lengths) => {
                let name = format_ident!("{}", lengths.text);
                quote!(#[doc = " The lengths of the torus."] pub #name: [f64; #d],)
            }
            Extent::Box(_) => {
                quote!(#[doc = " The box, with its walls."] pub domain: mesh::Domain<#d>,)
            }
        }
    }

    /// The function that gives the domain, the grid and the number of particles.
    pub(super) fn setting(&self) -> TokenStream {
        let Some((extent, directions)) = self.extent() else {
            return TokenStream::new();
        };
        let d = number(directions);
        let domain = match extent {
            Extent::Torus(lengths) => {
                let name = format_ident!("{}", lengths.text);
                quote!(mesh::Domain::torus(self.sites.#name))
            }
            Extent::Box(_) => quote!(self.sites.domain),
        };
        let labels = &self.line.lattice.labels;
        let grid = self.line.lattice.grid().map(|l| {
            let name = format_ident!("{}", l.index.text);
            quote!(Some(self.sites.#name))
        });
        let grid = grid.unwrap_or_else(|| quote!(None));
        let particles = labels.iter().find(|l| !l.grid).map(|l| {
            let name = format_ident!("{}", l.count.text);
            quote!(self.sites.#name)
        });
        quote! {
            /// The domain of the particles, the grid and the number of particles.
            pub fn setting(&self) -> mesh::Setting<#d> {
                mesh::Setting { domain: #domain, grid: #grid, particles: #particles }
            }
        }
    }
}

impl Plan<'_> {
    fn mesh_of(&self, e: &expr::Applied) -> Option<usize> {
        let f = self.symbols.functional(e.functional);
        let meshes = &self.l.line.lattice.meshes;
        let at = meshes.iter().position(|m| m.name.text == f.name)?;
        (f.reach == Reach::Sites).then_some(at)
    }

    /// The label of the sites of a functional, and the label of its argument.
    fn labels(&self, mesh: &Mesh) -> Option<[usize; 2]> {
        let lattice = &self.l.line.lattice;
        let own = lattice.find(&mesh.name.text)?.label;
        let of = match &mesh.of {
            Source::Field(name) => lattice.find(name)?.label,
            Source::Functional(i) => lattice.find(&lattice.meshes.get(*i)?.name.text)?.label,
        };
        Some([own, of])
    }

    /// The expression in which a letter replaces each value and each pull-back.
    fn placed(&mut self, e: &Expr) -> Expr {
        let (applied, seed) = match e.node() {
            Node::Given(a) => (a, None),
            Node::PullBack(a, 0, seed) => (a, Some(seed.clone())),
            _ => {
                let mut children = Vec::new();
                for child in e.children() {
                    children.push(self.placed(child));
                }
                return expr::with_children(&self.symbols, e, children);
            }
        };
        let Some(mesh) = self.mesh_of(applied) else {
            return e.clone();
        };
        if let Some(known) = self.arrays.iter().find(|a| a.of == *e) {
            return expr::here(&self.symbols, known.symbol);
        }
        // The argument of the functional is computed first.
        if let Some(first) = applied.arguments.first() {
            self.placed(first);
        }
        if seed.is_some() {
            let value = expr::given(&self.symbols, applied.functional, applied.arguments.clone());
            self.placed(&value);
        }
        let seed = seed.map(|s| self.placed(&s));
        let lattice = &self.l.line.lattice;
        let Some(labels) = lattice.meshes.get(mesh).and_then(|m| self.labels(m)) else {
            return e.clone();
        };
        let back = seed.is_some();
        let n = self
            .arrays
            .iter()
            .filter(|a| a.seed.is_some() == back)
            .count()
            + 1;
        let (word, label) = match back {
            true => ("back", labels[1]),
            false => ("value", labels[0]),
        };
        let name = self.symbols.fresh_name(&format!("__{word}_{n}"));
        let symbol = self
            .symbols
            .add(&name, e.shape(), Structure::General, Role::Derived);
        self.arrays.push(Array {
            symbol,
            of: e.clone(),
            field: format_ident!("{word}_{n}"),
            mesh,
            label,
            seed,
        });
        expr::here(&self.symbols, symbol)
    }

    /// An expression at one site: the statements before it, and its value.
    fn computed(&self, e: &Expr) -> (TokenStream, TokenStream) {
        let values = std::slice::from_ref(e);
        let is_array = |id: SymbolId| self.arrays.iter().find(|a| a.symbol == id);
        let letters = known_letters(self.l, values, &|id| is_array(id).is_some());
        let s = &self.symbols;
        let (locals, mut bindings) = self.l.locals(
            s,
            &letters,
            &super::locals::Places::of_node(),
            &quote!(site),
        );
        let mut lets = TokenStream::new();
        for letter in crate::emit::items::letters_of(values) {
            let Some(array) = is_array(letter.symbol) else {
                continue;
            };
            let name = format_ident!("{}_here", local(&array.field));
            let all = local(&array.field);
            lets.extend(quote!(let #name = #all[site];));
            bindings.bind(letter, name);
        }
        let (more, results) = self.l.program(s, values, &bindings);
        let value = results.into_iter().next().unwrap_or_default();
        (quote!(#locals #lets #more), value)
    }

    /// The argument of a functional as an array: positions at this node, or the values of another functional.
    fn argument(&self, mesh: &Mesh) -> TokenStream {
        match &mesh.of {
            Source::Field(name) => {
                let (field, count) = (format_ident!("{name}"), self.l.count_of(name));
                if self.numbers().contains(name) {
                    let all = local(&format_ident!("numbers_{name}"));
                    return quote!(&#all[..]);
                }
                quote!(&at.#field[..#count])
            }
            Source::Functional(i) => {
                let value = self
                    .arrays
                    .iter()
                    .find(|a| a.mesh == *i && a.seed.is_none());
                let all = value.map(|a| local(&a.field));
                quote!(&#all[..])
            }
        }
    }
}

/// The letters of sites, without the letters of arrays.
fn known_letters(
    l: &Lines,
    values: &[Expr],
    is_array: &dyn Fn(SymbolId) -> bool,
) -> Vec<super::locals::StatedLetter> {
    let part = &l.line.representative;
    let own: Vec<Expr> = values
        .iter()
        .flat_map(expr::letters)
        .filter(|x| !is_array(x.symbol))
        .map(|x| expr::letter(&part.d.letters.symbols, x.symbol, x.shift))
        .collect();
    stated_letters(l, &own)
}

/// The emitted code of functionals.
pub(super) struct Emitted {
    /// The structure of functionals and arrays, and the functions of the model.
    pub items: TokenStream,
    /// The declarations of the fields for the forces of functionals.
    pub fields: TokenStream,
    /// The values of those fields without forces.
    pub zeros: TokenStream,
    /// The terms as energies: kernels and sums.
    pub energy: Option<(TokenStream, Vec<TokenStream>)>,
}

/// The field of the forces of functionals on a configuration.
pub(super) fn collected(on: &str) -> Ident {
    format_ident!("mesh_{on}")
}

/// The emitted code of the functionals of a chain, if it has any.
pub(super) fn meshes(l: &Lines) -> Option<Emitted> {
    let meshed = l.line.meshed.as_ref()?;
    let part = &l.line.representative;
    let mut plan = Plan {
        l,
        symbols: part.d.letters.symbols.clone(),
        arrays: Vec::new(),
    };
    let s = &part.d.letters.symbols;
    let algebra = Algebra::new(s);
    let h = expr::here(s, part.d.spec.step);
    let energies: Option<Vec<(usize, Expr)>> = meshed
        .terms
        .iter()
        .map(|(label, e)| {
            let energy = expr::neg(expr::quotient(e.clone(), h.clone()));
            Some((*label, super::energy::without_step(&algebra, &energy, &h)?))
        })
        .collect();
    // Values first, in the order of their declaration.
    for (_, e) in &meshed.terms {
        plan.placed(e);
    }
    let energies: Option<Vec<(usize, Expr)>> = energies.map(|list| {
        let each = list.into_iter();
        each.map(|(label, e)| (label, plan.placed(&e))).collect()
    });
    let forces: Vec<Expr> = meshed
        .forces
        .iter()
        .map(|f| plan.placed(&f.value))
        .collect();
    Some(written(&plan, meshed, &forces, energies))
}

fn written(
    plan: &Plan,
    meshed: &FunctionalForce,
    forces: &[Expr],
    energies: Option<Vec<(usize, Expr)>>,
) -> Emitted {
    let l = plan.l;
    let part = &l.line.representative;
    let [model, meshes, places, pulls] = ["", "Meshes", "Places", "Pulls"].map(|x| l.item(x));
    let step = step(&part.d);
    let directions = number(l.extent().map_or(1, |(_, d)| d));
    let declared = &l.line.lattice.meshes;
    let used: Vec<(usize, &Mesh)> = declared
        .iter()
        .enumerate()
        .filter(|(i, _)| plan.arrays.iter().any(|a| a.mesh == *i))
        .collect();
    let mut fields = TokenStream::new();
    let mut made = TokenStream::new();
    let mut inits = TokenStream::new();
    for (_, mesh) in &used {
        let field = format_ident!("functional_{}", mesh.name.text);
        let ty = type_of(mesh, &directions);
        let data = mesh.arguments.iter().skip(1).map(|a| {
            let name = format_ident!("{}", a.text);
            match l.line.lattice.find(&a.text) {
                Some(_) => {
                    let count = l.count_of(&a.text);
                    quote!(&self.parameters.#name[..#count])
                }
                None => quote!(self.parameters.#name),
            }
        });
        fields.extend(quote!(#field: #ty,));
        made.extend(quote! {
            let mut #field = <#ty as mesh::Functional<T, #directions>>::new(&setting, (#(#data,)*))?;
            #field.share(self.threads);
        });
        inits.extend(quote!(#field,));
    }
    for a in &plan.arrays {
        let field = &a.field;
        let count = l.count(a.label, Sites::Members);
        let element = plan.element(a);
        fields.extend(quote!(#field: Vec<#element>,));
        let zero = plan.zero(a);
        inits.extend(quote!(#field: ::std::vec![#zero; #count],));
        if a.seed.is_some() {
            let seed = format_ident!("seed_{}", a.field);
            let own = plan.labels(&declared[a.mesh]).map_or(a.label, |x| x[0]);
            let count = l.count(own, Sites::Members);
            fields.extend(quote!(#seed: Vec<T>,));
            inits.extend(quote!(#seed: ::std::vec![T::zero(); #count],));
        }
    }
    let open = plan.arrays.iter().map(|a| {
        let (field, local) = (&a.field, local(&a.field));
        quote!(#field: #local)
    });
    let open: Vec<TokenStream> = open.collect();
    let functionals = used
        .iter()
        .map(|(_, m)| format_ident!("functional_{}", m.name.text));
    let functionals: Vec<Ident> = functionals.collect();
    let seeds: Vec<TokenStream> = plan
        .arrays
        .iter()
        .filter(|a| a.seed.is_some())
        .map(|a| {
            let seed = format_ident!("seed_{}", a.field);
            let own = local(&seed);
            quote!(#seed: #own)
        })
        .collect();
    let values = plan.arrays.iter().filter(|a| a.seed.is_none()).map(|a| {
        let mesh = &declared[a.mesh];
        let (f, all) = (
            format_ident!("functional_{}", mesh.name.text),
            local(&a.field),
        );
        let (argument, name) = (plan.argument(mesh), &mesh.name.text);
        quote!(#f.value(#argument, #all).map_err(|e| (#name, e))?;)
    });
    let values: Vec<TokenStream> = values.collect();
    let numbers = plan.numbers();
    let mut opened = TokenStream::new();
    let mut filled = TokenStream::new();
    for name in &numbers {
        let (field, place) = (format_ident!("numbers_{name}"), format_ident!("{name}"));
        let (own, count) = (local(&field), l.count_of(name));
        fields.extend(quote!(#field: Vec<T>,));
        inits.extend(quote!(#field: ::std::vec![T::zero(); #count],));
        opened.extend(quote!(#field: #own,));
        filled.extend(quote!(line::fill(self.threads, &mut #own[..], |site| at.#place[site][0]);));
    }
    let backs = plan.arrays.iter().filter_map(|a| {
        let mesh = &declared[a.mesh];
        let (f, all) = (
            format_ident!("functional_{}", mesh.name.text),
            local(&a.field),
        );
        let seed = local(&format_ident!("seed_{}", a.field));
        let (lets, value) = plan.computed(a.seed.as_ref()?);
        let (argument, name) = (plan.argument(mesh), &mesh.name.text);
        Some(quote! {
            line::fill(self.threads, &mut #seed[..], |site| { #lets #value });
            #f.pull_back(#argument, #seed, #all).map_err(|e| (#name, e))?;
        })
    });
    let backs: Vec<TokenStream> = backs.collect();
    let mut sums = TokenStream::new();
    let mut collect = TokenStream::new();
    let mut zeros = TokenStream::new();
    for (f, e) in meshed.forces.iter().zip(forces) {
        let Some(m) = l.moving().find(|m| m.mover.name == f.on) else {
            continue;
        };
        let (field, t) = (collected(&f.on), m.covector());
        let count = l.count_of(&f.on);
        let (lets, value) = plan.computed(e);
        let value = m.array(value);
        sums.extend(
            quote!(line::fill(self.threads, &mut pulls.#field[..], |site| { #lets #value });),
        );
        collect.extend(quote!(#field: Vec<#t>,));
        zeros.extend(quote!(#field: ::std::vec![SMatrix::zeros(); #count],));
    }
    let setting = l.setting();
    let asked = plan.asked();
    let text = meshes.to_string();
    let items = quote! {
        /// Functionals of all sites: their values, the seeds of their pull-backs, and the pull-backs.
        #[derive(Clone)]
        struct #meshes<T: Real> { #fields }

        impl<T: Real> ::core::fmt::Debug for #meshes<T> {
            fn fmt(&self, f: &mut ::core::fmt::Formatter<'_>) -> ::core::fmt::Result {
                f.debug_struct(#text).finish_non_exhaustive()
            }
        }

        impl<T: Real> #model<T> {
            #setting

            #asked

            /// The functionals before their first evaluation.
            fn meshes(&self) -> Result<#meshes<T>, LineError> {
                let setting = self.setting();
                #made
                Ok(#meshes { #inits })
            }

            /// The values of functionals at these positions.
            #[allow(unused_variables)]
            fn valued(&self, at: &#places<T>, meshes: &mut #meshes<T>) -> Result<(), (&'static str, mesh::MeshError)> {
                let #meshes { #(#functionals,)* #(#open,)* #opened .. } = meshes;
                #filled
                #(#values)*
                Ok(())
            }

            /// The contributions of functionals to the momenta of all sites at these positions, taken at one node.
            #[allow(unused_variables)]
            fn meshed(&self, #step: T, at: &#places<T>, meshes: &mut #meshes<T>, pulls: &mut #pulls<T>) -> Result<(), (&'static str, mesh::MeshError)> {
                let _ = #step;
                self.valued(at, meshes)?;
                let #meshes { #(#functionals,)* #(#open,)* #(#seeds,)* #opened } = meshes;
                #(#backs)*
                #sums
                Ok(())
            }
        }
    };
    let energy = energies.map(|list| plan.energy(&list, &open));
    Emitted {
        items,
        fields: collect,
        zeros,
        energy,
    }
}

/// The type that computes a functional.
fn type_of(mesh: &Mesh, directions: &proc_macro2::Literal) -> TokenStream {
    let path = path(&mesh.path).unwrap_or_default();
    match mesh.kind {
        FunctionalKind::Grid => quote!(#path<T, #directions>),
        FunctionalKind::Cells | FunctionalKind::Path => quote!(#path<T>),
    }
}

impl Plan<'_> {
    /// Scalar fields that are arguments of functionals. Positions are stored as arrays of length one, but functionals
    /// take numbers.
    fn numbers(&self) -> Vec<String> {
        let mut out: Vec<String> = Vec::new();
        for a in &self.arrays {
            let Source::Field(name) = &self.l.line.lattice.meshes[a.mesh].of else {
                continue;
            };
            let is_number = |m: super::Moving| m.mover.name == *name && m.is_number();
            if self.l.moving().any(is_number) && !out.contains(name) {
                out.push(name.clone());
            }
        }
        out
    }

    /// The type of one element of an array.
    fn element(&self, a: &Array) -> TokenStream {
        let mesh = &self.l.line.lattice.meshes[a.mesh];
        match (&a.seed, &mesh.of) {
            (Some(_), Source::Field(name)) => {
                let m = self.l.moving().find(|m| m.mover.name == *name);
                m.map_or_else(|| quote!(T), |m| m.value())
            }
            _ => quote!(T),
        }
    }

    fn zero(&self, a: &Array) -> TokenStream {
        let mesh = &self.l.line.lattice.meshes[a.mesh];
        match (&a.seed, &mesh.of) {
            (Some(_), Source::Field(name)) if !self.numbers().contains(name) => {
                quote!(SMatrix::zeros())
            }
            _ => quote!(T::zero()),
        }
    }

    /// Functions of a state that return the values of each functional.
    fn asked(&self) -> TokenStream {
        let state = self.l.item("State");
        let each = self.arrays.iter().filter(|a| a.seed.is_none()).map(|a| {
            let name = &self.l.line.lattice.meshes[a.mesh].name.text;
            let (function, field) = (format_ident!("values_{name}"), &a.field);
            let doc = format!(" The values of `{name}` at the positions of a state, one value per site.");
            quote! {
                #[doc = #doc]
                ///
                /// # Errors
                /// If a functional has no value at these positions. The error names the functional and the reason.
                pub fn #function(&self, state: &#state<T>) -> Result<Vec<T>, LineError> {
                    let mut meshes = self.meshes()?;
                    if let Err((quantity, cause)) = self.valued(&state.places, &mut meshes) {
                        return Err(LineError::Functional { node: state.node, quantity, cause, works: None });
                    }
                    Ok(meshes.#field)
                }
            }
        });
        each.collect()
    }

    /// The terms as energies: the values of the functionals at the positions of a state, then sums over sites.
    fn energy(
        &self,
        list: &[(usize, Expr)],
        open: &[TokenStream],
    ) -> (TokenStream, Vec<TokenStream>) {
        let l = self.l;
        let [meshes, places] = ["Meshes", "Places"].map(|x| l.item(x));
        let terms = list.iter().map(|(label, e)| {
            let count = l.count(*label, Sites::Members);
            let (lets, value) = self.computed(e);
            quote!(line::sum(#count, |site| { #lets #value }))
        });
        let terms: Vec<TokenStream> = terms.collect();
        let kernel = quote! {
            /// The potential energy of terms with functionals; NaN if a functional has no value.
            #[allow(unused_variables)]
            fn potential_of_meshes(&self, at: &#places<T>) -> T {
                let Ok(mut meshes) = self.meshes() else {
                    return T::from_f64(f64::NAN);
                };
                if self.valued(at, &mut meshes).is_err() {
                    return T::from_f64(f64::NAN);
                }
                let #meshes { #(#open,)* .. } = &meshes;
                #(#terms)+*
            }
        };
        (kernel, vec![quote!(self.potential_of_meshes(at))])
    }
}
