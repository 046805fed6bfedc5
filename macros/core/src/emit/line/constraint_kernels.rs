//! Kernels of the constraints: the residual of one constraint and its derivatives, and the effect of impulses on a
//! configuration.

use super::locals::Places;
use super::neighbour_forces::{range_of, stated_letters};
use super::{Lines, Moving, number, responses, rows, totals};
use crate::emit::expression::Bindings;
use crate::expr::symbol::Role;
use crate::expr::{Expr, Letter};
use crate::line::{ChainConstraint, ConstraintResponse, Matrix, Reach};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// Configurations of a site whose velocities are found together.
pub(super) struct Bodies<'a> {
    pub members: Vec<Moving<'a>>,
    pub unit: &'a ConstraintResponse,
    /// The number of components of their velocities.
    pub n: usize,
    /// Whether their response to an impulse is a scalar multiple of it.
    pub scalar: bool,
}

impl Bodies<'_> {
    /// The field of their data, and the suffix of the names of their kernels.
    pub(super) fn field(&self) -> Ident {
        self.members
            .first()
            .map_or_else(|| format_ident!("none"), Moving::name)
    }

    /// The first member.
    pub(super) fn first(&self) -> Option<&Moving<'_>> {
        self.members.first()
    }

    /// The type of the response to an impulse.
    pub(super) fn response(&self) -> TokenStream {
        let n = number(self.n);
        match self.scalar {
            true => quote!(T),
            false => quote!(SMatrix<T, #n, #n>),
        }
    }

    /// A response of zero.
    pub(super) fn none(&self) -> TokenStream {
        let n = number(self.n);
        match self.scalar {
            true => quote!(T::zero()),
            false => quote!(SMatrix::<T, #n, #n>::zeros()),
        }
    }

    /// Whether the response in a step depends on velocities.
    pub(super) fn takes_velocities(&self) -> bool {
        self.members.iter().any(|m| m.system().is_some())
    }

    /// Whether the response, in a step or at a node, depends on parameters and the step size only.
    pub(super) fn is_steady(&self, at_node: bool) -> bool {
        let Some(m) = self.first() else { return false };
        let s = &m.outline().letters.symbols;
        let of = match (at_node, &self.unit.of_edge) {
            (true, _) => &self.unit.of_node,
            (false, Some(list)) => list,
            (false, None) => return false,
        };
        let parameter = |l: &Letter| matches!(s.get(l.symbol).role, Role::Parameter | Role::Step);
        of.iter().flat_map(Matrix::expressions).all(|e| {
            crate::expr::letters(&m.outline().defined(e))
                .iter()
                .all(parameter)
        })
    }

    /// The first row of a member's velocity, and its number of rows.
    pub(super) fn rows(&self, on: &str) -> Option<[usize; 2]> {
        let mut row = 0;
        for m in &self.members {
            if m.mover.name == on {
                return Some([row, m.components()]);
            }
            row += m.components();
        }
        None
    }
}

impl Lines<'_> {
    /// Whether the model has constraints.
    pub(super) fn is_held(&self) -> bool {
        !self.line.holds.is_empty()
    }

    /// The bodies of all sites on which constraints may act.
    pub(super) fn bodies(&self) -> Vec<Bodies<'_>> {
        let mut out = Vec::new();
        for (lone, units) in self.line.lone.iter().zip(&self.line.units) {
            for unit in units {
                let own = |i: &usize| {
                    let mover = lone.movers.iter().find(|m| m.index == *i)?;
                    Some(Moving { lone, mover })
                };
                let members: Vec<Moving> = unit.members.iter().filter_map(own).collect();
                let multiple = |list: &[Matrix]| matches!(list, [Matrix::Multiple(_)]);
                let of_edge = unit.of_edge.as_ref().is_some_and(|list| multiple(list));
                out.push(Bodies {
                    n: members.iter().map(Moving::components).sum(),
                    scalar: of_edge && multiple(&unit.of_node),
                    members,
                    unit,
                });
            }
        }
        out
    }

    /// The body that contains a configuration, if any.
    pub(super) fn body_of(&self, name: &str) -> Option<Bodies<'_>> {
        let mut all = self.bodies().into_iter();
        all.find(|b| b.members.iter().any(|m| m.mover.name == name))
    }

    /// Whether a constraint acts on a configuration.
    pub(super) fn is_reached(&self, name: &str) -> bool {
        let mut all = self.line.holds.iter().flat_map(|h| &h.reaches);
        all.any(|r| r.on == name)
    }

    /// The number of multipliers per site.
    pub(super) fn held_components(&self) -> usize {
        self.line.holds.iter().map(|h| h.components).sum()
    }

    /// The row of the first multiplier of a constraint.
    pub(super) fn held_row(&self, held: &ChainConstraint) -> usize {
        let before = self.line.holds.iter().take_while(|h| h.name != held.name);
        before.map(|h| h.components).sum()
    }

    /// The constraints with their numbers, starting at 1.
    pub(super) fn holds(&self) -> impl Iterator<Item = (usize, &ChainConstraint)> {
        (1..).zip(&self.line.holds)
    }
}

/// How the derivative of a constraint is stored.
pub(super) enum DerivativeStorage {
    /// A constant, written where it is used.
    Fixed(TokenStream),
    /// A number per site.
    Number,
    /// A matrix per site.
    Matrix,
}

/// The field of a derivative.
pub(super) fn field(r: &Reach) -> Ident {
    format_ident!("{}_{}", r.on, r.site)
}

pub(super) fn kept(l: &Lines, r: &Reach) -> DerivativeStorage {
    match &r.columns {
        Matrix::Columns(_) => DerivativeStorage::Matrix,
        // The derivative of a sum vanishes beyond the ends of the chain, so it is stored.
        Matrix::Multiple(e) if crate::expr::letters(e).is_empty() && !r.in_sum => {
            let s = &l.line.representative.d.letters.symbols;
            let (_, value) = l.program(s, std::slice::from_ref(e), &Bindings::new());
            DerivativeStorage::Fixed(value.into_iter().next().unwrap_or_default())
        }
        Matrix::Multiple(_) => DerivativeStorage::Number,
    }
}

/// The size of a derivative at a site, read from the list of its constraint.
pub(super) fn size_of(l: &Lines, r: &Reach, list: &Ident) -> TokenStream {
    let own = field(r);
    let number = match kept(l, r) {
        DerivativeStorage::Matrix => return quote!(length(&reached.#list[site + 1].#own)),
        DerivativeStorage::Fixed(c) => quote!((#c)),
        DerivativeStorage::Number => quote!(reached.#list[site + 1].#own),
    };
    quote!((#number * #number).sqrt())
}

/// A matrix from its computed columns; all other entries are zero.
pub(super) fn filled(
    (rows, cols): (usize, usize),
    columns: &[(usize, usize, usize, TokenStream)],
) -> TokenStream {
    let (r, c) = (number(rows), number(cols));
    let each = columns.iter().map(|(row, count, column, value)| {
        let (row, count, column) = (number(*row), number(*count), number(*column));
        quote!(a.fixed_view_mut::<#count, 1>(#row, #column).copy_from(&(#value));)
    });
    quote!({
        let mut a = SMatrix::<T, #r, #c>::zeros();
        #(#each)*
        a
    })
}

/// The structures and kernels of all constraints.
pub(super) fn held(l: &Lines) -> TokenStream {
    if !l.is_held() {
        return TokenStream::new();
    }
    let name = l.item("");
    let [reached, responses, velocities] =
        ["Reached", "Responses", "Velocities"].map(|x| l.item(x));
    let (mut structs, mut kernels) = (TokenStream::new(), TokenStream::new());
    for (k, h) in l.holds() {
        let (structure, kernel) = of_hold(l, k, h);
        structs.extend(structure);
        kernels.extend(kernel);
    }
    let lists = l.holds().map(|(k, _)| {
        let (field, ty) = (format_ident!("held_{k}"), l.item(&format!("Held{k}")));
        quote!(#field: Vec<#ty<T>>)
    });
    let bodies = l.bodies();
    let of_bodies = bodies.iter().map(|b| {
        let (field, ty) = (b.field(), b.response());
        quote!(#field: Vec<#ty>)
    });
    let of_velocities = bodies.iter().map(|b| {
        let (field, n) = (b.field(), number(b.n));
        quote!(#field: Vec<SVector<T, #n>>)
    });
    let each: Vec<TokenStream> = bodies.iter().map(|b| responses::kernels(l, b)).collect();
    let reacted: Vec<TokenStream> = l
        .moving()
        .filter(|m| l.is_reached(&m.mover.name))
        .map(|m| reacted(l, &m))
        .collect();
    let rows = match l.holds_sums() {
        true => totals::kernels(l, &bodies),
        false => rows::rows(l, &bodies),
    };
    let all = sweep(l);
    quote! {
        #structs

        /// The constrained quantities at all sites, with one more site before the first and two after the last.
        #[derive(Clone, Debug)]
        struct #reached<T> { #(#lists),* }

        /// The derivatives of positions and velocities with respect to impulses.
        #[derive(Clone, Debug)]
        struct #responses<T> { #(#of_bodies),* }

        /// Velocities in the limit of small steps.
        #[derive(Clone, Debug)]
        struct #velocities<T> { #(#of_velocities),* }

        impl<T: Real> #name<T> {
            #kernels
            #(#each)*
            #(#reacted)*
            #rows
            #all
        }
    }
}

/// The structure and the kernel of one constraint: its residual and its derivatives at one site.
fn of_hold(l: &Lines, k: usize, h: &ChainConstraint) -> (TokenStream, TokenStream) {
    let part = &l.line.representative;
    let s = &part.d.letters.symbols;
    let (ty, places) = (l.item(&format!("Held{k}")), l.item("Places"));
    let r = number(h.components);
    let (mut fields, mut zeros) = (TokenStream::new(), TokenStream::new());
    let mut values: Vec<Expr> = vec![h.value.clone(), h.scale.clone()];
    for reach in &h.reaches {
        let name = field(reach);
        match kept(l, reach) {
            DerivativeStorage::Fixed(_) => continue,
            DerivativeStorage::Number => {
                fields.extend(quote!(#name: T,));
                zeros.extend(quote!(#name: T::zero(),));
            }
            DerivativeStorage::Matrix => {
                let c = number(components(l, &reach.on));
                fields.extend(quote!(#name: SMatrix<T, #c, #r>,));
                zeros.extend(quote!(#name: SMatrix::<T, #c, #r>::zeros(),));
            }
        }
        values.extend(reach.columns.expressions().iter().cloned());
    }
    let letters = stated_letters(l, &values);
    let (locals, bindings) = l.locals(s, &letters, &Places::of_node(), &quote!(site));
    let (lets, results) = l.program(s, &values, &bindings);
    let mut results = results.into_iter();
    let value = array(h, results.next().unwrap_or_default());
    let size = results.next().unwrap_or_default();
    let mut made = TokenStream::new();
    for reach in &h.reaches {
        let (name, c) = (field(reach), components(l, &reach.on));
        match (kept(l, reach), &reach.columns) {
            (DerivativeStorage::Fixed(_), _) => {}
            (DerivativeStorage::Number, _) => {
                let value = results.next().unwrap_or_default();
                made.extend(quote!(#name: #value,));
            }
            (DerivativeStorage::Matrix, of) => {
                let is_number = is_number(l, &reach.on);
                let columns = of.expressions().iter().enumerate().filter_map(|(j, e)| {
                    let value = results.next().unwrap_or_default();
                    let value = match is_number {
                        true => quote!(SMatrix::<T, 1, 1>::new(#value)),
                        false => value,
                    };
                    (!e.is_zero()).then_some((0, c, j, value))
                });
                let value = filled((c, h.components), &columns.collect::<Vec<_>>());
                made.extend(quote!(#name: #value,));
            }
        }
    }
    let kernel = format_ident!("held_{k}");
    let doc = format!(
        " The residual of the constraint of `{}`, the size of its terms, and the contribution of the multiplier to each momentum.",
        h.name
    );
    let structure = quote! {
        #[doc = #doc]
        #[derive(Clone, Copy, Debug)]
        struct #ty<T> { value: SMatrix<T, #r, 1>, size: T, #fields }
        impl<T: Real> #ty<T> {
            /// The zero contribution.
            fn none() -> Self { Self { value: SMatrix::<T, #r, 1>::zeros(), size: T::zero(), #zeros } }
        }
    };
    let kernel = quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, site: usize, at: &#places<T>) -> #ty<T> {
            let _ = (site, at);
            #locals
            #lets
            #ty { value: #value, size: #size, #made }
        }
    };
    (structure, kernel)
}

/// The residual as an array.
fn array(h: &ChainConstraint, value: TokenStream) -> TokenStream {
    match h.value.shape().is_scalar() {
        true => quote!(SMatrix::<T, 1, 1>::new(#value)),
        false => value,
    }
}

fn is_number(l: &Lines, on: &str) -> bool {
    l.moving().any(|m| m.mover.name == on && m.is_number())
}

fn components(l: &Lines, on: &str) -> usize {
    let own = l.moving().find(|m| m.mover.name == on);
    own.map_or(0, |m| m.components())
}

/// The kernel of the constraint forces on one configuration: the contribution to its momentum of the impulses around
/// a site.
fn reacted(l: &Lines, m: &Moving) -> TokenStream {
    let name = &m.mover.name;
    let (kernel, t, reached) = (
        format_ident!("reacted_{name}"),
        m.covector(),
        l.item("Reached"),
    );
    let size = number(l.held_components());
    let mut terms = Vec::new();
    for (k, h) in l.holds() {
        let list = format_ident!("held_{k}");
        let (row, r) = (number(l.held_row(h)), number(h.components));
        for reach in h.reaches.iter().filter(|r| r.on == *name) {
            let (own, by) = (field(reach), number(1 - reach.site));
            let at = match reach.in_sum {
                true => quote!(1),
                false => quote!(site + #by),
            };
            let impulse = quote!(impulses[#at].fixed_rows::<#r>(#row).into_owned());
            terms.push(match kept(l, reach) {
                DerivativeStorage::Fixed(c) => quote!(#impulse * (#c)),
                DerivativeStorage::Number => quote!(#impulse * reached.#list[site + #by].#own),
                DerivativeStorage::Matrix => quote!(reached.#list[site + #by].#own * #impulse),
            });
        }
    }
    let doc = format!(" The contribution of the constraint impulses to the momentum of `{name}`.");
    quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, site: usize, reached: &#reached<T>, impulses: &[SVector<T, #size>]) -> #t {
            let _ = reached;
            #(#terms)+*
        }
    }
}

/// The function that evaluates all constraints, with the periodic copies of a ring.
fn sweep(l: &Lines) -> TokenStream {
    let (places, reached) = (l.item("Places"), l.item("Reached"));
    let each = l.holds().map(|(k, h)| {
        let list = format_ident!("held_{k}");
        let range = range_of(l, h.label, 0, h.to);
        let count = l.count_field(h.label);
        let closed = l.line.lattice.line == Some(h.label) && l.line.lattice.periodic.is_some();
        let around = closed.then(|| {
            quote! {
                if self.is_ring() {
                    reached.#list[0] = reached.#list[self.sites.#count];
                    reached.#list[self.sites.#count + 1] = reached.#list[1];
                }
            }
        });
        quote! {
            {
                #range
                line::fill(self.threads, &mut reached.#list[first + 1..last + 1], |i| {
                    self.#list(first + i, at)
                });
                #around
            }
        }
    });
    let each: Vec<TokenStream> = each.collect();
    quote! {
        /// The constrained quantities at these positions, and their derivatives.
        #[inline]
        fn reached(&self, at: &#places<T>, reached: &mut #reached<T>) {
            #(#each)*
        }
    }
}
