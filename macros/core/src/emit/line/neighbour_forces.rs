//! Kernels of neighbour terms, and the loop over all terms. One evaluation gives the forces of a term on all its
//! sites.

use super::arguments::Argument;
use super::forms::forms;
use super::lanes::{Windows, are_together};
use super::locals::{Places, QuaternionUse, StatedLetter};
use super::{Lines, number};
use crate::emit::expression::{Bindings, Writer};
use crate::emit::items::letters_of;
use crate::emit::names::variable;
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Letter, Shift};
use crate::line::NeighbourForce;
use crate::print::{Format, Style, expression};
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The field of the force of a term on a site.
pub(super) fn field(on: &str, site: usize) -> Ident {
    format_ident!("{on}_{site}")
}

/// The largest site offset on which a term exerts a force, which is the number of padding entries before the first
/// term.
pub(super) fn front(pull: &NeighbourForce) -> usize {
    pull.forces.iter().map(|f| f.site).max().unwrap_or(0)
}

/// The fields of the neighbour forces, all zero.
pub(super) fn none_yet(l: &Lines) -> Vec<TokenStream> {
    let each = l.line.pulls.iter().enumerate().map(|(n, pull)| {
        let (field, t) = (
            format_ident!("pull_{}", n + 1),
            l.item(&format!("Pull{}", n + 1)),
        );
        let front = number(front(pull));
        let count = l.count_field(pull.label);
        quote!(#field: line::Columns::filled(#t::none(), self.sites.#count + 1 + 2 * #front))
    });
    each.collect()
}

/// The structures and kernels of all terms.
pub(super) fn pulls(l: &Lines) -> TokenStream {
    let name = l.item("");
    let mut structs = TokenStream::new();
    let mut kernels = TokenStream::new();
    let mut loops = TokenStream::new();
    for (n, pull) in l.line.pulls.iter().enumerate() {
        let [one, kernel, over_sites] = of_pull(l, n + 1, pull);
        structs.extend(one);
        kernels.extend(kernel);
        loops.extend(over_sites);
    }
    let all = sweep(l, &loops);
    let ends = super::ends::ends(l);
    quote! {
        #structs
        impl<T: Real> #name<T> {
            #kernels
            #all
            #ends
        }
    }
}

/// The structure of a term, its kernel, and the loop over all such terms.
fn of_pull(l: &Lines, n: usize, pull: &NeighbourForce) -> [TokenStream; 3] {
    let part = &l.line.representative;
    let s = &part.d.letters.symbols;
    let t = l.item(&format!("Pull{n}"));
    let moving: Vec<_> = l.moving().collect();
    let of = |on: &str| moving.iter().find(|m| m.mover.name == on);
    let mut fields = TokenStream::new();
    let mut zeros = TokenStream::new();
    let mut counts = TokenStream::new();
    for f in &pull.forces {
        let name = field(&f.on, f.site);
        let covector = of(&f.on).map(|m| m.covector());
        fields.extend(quote!(#name: #covector,));
        counts.extend(of(&f.on).map(|m| {
            let (rows, cols) = m.dims();
            quote!(#name: #rows * #cols,)
        }));
        zeros.extend(quote!(#name: SMatrix::zeros(),));
    }
    let values = pull
        .forces
        .iter()
        .map(|f| expr::quaternion_components(s, &f.value));
    let values: Vec<_> = values.collect();
    let letters = stated_letters(l, &values);
    let read = l.read(s, &letters);
    let (locals, arguments) = (&read.lets, read.arguments.iter().map(Argument::declared));
    let (lets, results) = computed(l, s, &values, &read.bindings);
    let made = pull.forces.iter().zip(results).map(|(f, value)| {
        let name = field(&f.on, f.site);
        let value = of(&f.on).map_or(value.clone(), |m| m.array(value));
        quote!(#name: #value)
    });
    let step = super::locals::step(&part.d);
    let kernel = format_ident!("pull_{n}");
    let (term, sites) = (term_text(l, pull), pull.forces.len());
    let doc = format!(
        " The contribution of `{term}` to the momenta of its {sites} sites, taken at one node."
    );
    let together = are_together(&values);
    let over_sites = over_sites(l, n, pull, &read.arguments, together);
    let stage = together.then(|| stage(l, n, &read.arguments));
    let structure = quote! {
        #[doc = #doc]
        #[derive(Clone, Copy, Debug)]
        struct #t<T> { #fields }
        impl<T: Real> #t<T> {
            /// The zero contribution.
            fn none() -> Self { Self { #zeros } }
        }
        ::clebsch::numbered! { #t { #counts } }
        #stage
    };
    let kernel = quote! {
        #[doc = #doc]
        #[inline(always)]
        fn #kernel(&self, #step: T, #(#arguments),*) -> #t<T> {
            #locals
            #lets
            #t { #(#made),* }
        }
    };
    [structure, kernel, over_sites]
}

/// The number of components of the forces of a term.
pub(super) fn numbers(l: &Lines, pull: &NeighbourForce) -> TokenStream {
    let moving: Vec<_> = l.moving().collect();
    let counts = pull.forces.iter().filter_map(|f| {
        let (rows, cols) = moving.iter().find(|m| m.mover.name == f.on)?.dims();
        Some(quote!(#rows * #cols))
    });
    quote!({ #(#counts)+* })
}

/// The kernel for several sites together, as an item of its own.
fn stage(l: &Lines, n: usize, arguments: &[Argument]) -> TokenStream {
    let (model, places) = (l.item(""), l.item("Places"));
    let [name, made] = ["PullsTogether", "Pull"].map(|x| l.item(&format!("{x}{n}")));
    let kernel = format_ident!("pull_{n}");
    let windows = Windows::of(arguments).stated();
    let values = arguments.iter().map(Argument::seen);
    quote! {
        ::clebsch::in_lanes! {
            /// The contributions of a term, for several sites together.
            #name(model: #model<T>, h: T, at: #places<T>) -> #made<T>
            #windows
            |site| (model.#kernel(*h, #(#values),*), true)
        }
    }
}

/// Expressions of neighbours, in the form of [`forms`].
pub(super) fn computed(
    l: &Lines,
    s: &Symbols,
    values: &[Expr],
    bindings: &Bindings,
) -> (TokenStream, Vec<TokenStream>) {
    let forms = forms(s, values, &l.relative);
    let mut lets = TokenStream::new();
    let mut all = bindings.clone();
    for (id, value) in &forms.relative {
        let name = variable(&forms.symbols, *id);
        let writer = Writer {
            symbols: &forms.symbols,
            bindings,
        };
        if let Some(unit) = writer.unit(value) {
            lets.extend(quote!(let #name = #unit;));
            let letter = Letter {
                symbol: *id,
                shift: Shift::HERE,
            };
            all.bind_quaternion(letter, name);
            continue;
        }
        let (_, made) = l.program(&forms.symbols, std::slice::from_ref(value), bindings);
        lets.extend(quote!(let #name = #(#made)*;));
    }
    let (more, results) = l.program(&forms.symbols, &forms.values, &all);
    lets.extend(more);
    (lets, results)
}

/// The terms of a neighbour force as text, with letters relative to their first site.
fn term_text(l: &Lines, pull: &NeighbourForce) -> String {
    let d = &l.line.representative.d;
    let style = Style::new(&d.spec.time_index);
    expression(&pull.terms, &d.letters.symbols, &style, Format::Text)
}

/// The letters of a neighbour term.
pub(super) fn stated_letters(l: &Lines, values: &[Expr]) -> Vec<StatedLetter> {
    let part = &l.line.representative;
    let letters = letters_of(values).into_iter();
    letters
        .map(|letter| match part.sited(letter.symbol) {
            Some(at) => StatedLetter {
                letter,
                of: at.of,
                on: Some(at.site.saturating_sub(crate::line::BASE)),
                stands: QuaternionUse::of(&part.d.letters.symbols, letter, values),
            },
            None => StatedLetter {
                letter,
                of: part.d.letters.symbols.get(letter.symbol).name.clone(),
                on: None,
                stands: QuaternionUse::default(),
            },
        })
        .collect()
}

/// `let (first, last)`: the range of indices of a term, `last` excluded.
pub(super) fn range_of(l: &Lines, label: usize, from: usize, to: isize) -> TokenStream {
    let count = l.count_field(label);
    let last = match (to, to.unsigned_abs()) {
        (-1, _) => quote!(self.sites.#count),
        (..-1, by) => {
            let by = number(by - 1);
            quote!(self.sites.#count.saturating_sub(#by))
        }
        (_, by) => {
            let by = number(by + 1);
            quote!((self.sites.#count + #by))
        }
    };
    let start = number(from);
    // A chain may be too short for any such term.
    let last = match from {
        0 => last,
        _ => quote!(#last.max(#start)),
    };
    let of_line = l.line.lattice.line == Some(label);
    match (of_line, l.line.lattice.periodic.is_some()) {
        (true, true) => quote! {
            let (first, last) = match self.is_ring() {
                true => (0, self.sites.#count),
                false => (#start, #last),
            };
        },
        (true, false) => quote!(let (first, last) = (#start, #last);),
        (false, _) => quote!(let (first, last) = (0, self.sites.#count);),
    }
}

/// The loop over all terms of a kind, with the periodic copies of a ring.
fn over_sites(
    l: &Lines,
    n: usize,
    pull: &NeighbourForce,
    arguments: &[Argument],
    together: bool,
) -> TokenStream {
    let step = super::locals::step(&l.line.representative.d);
    let field = format_ident!("pull_{n}");
    let [t, stage] = ["Pull", "PullsTogether"].map(|x| l.item(&format!("{x}{n}")));
    let front = number(front(pull));
    let count = l.count_field(pull.label);
    let of_line = l.line.lattice.line == Some(pull.label);
    let range = range_of(l, pull.label, pull.from, pull.to);
    let at = Places::of_node();
    let values = arguments.iter().map(|a| a.value(&at, &quote!(site)));
    let (fill, together) = match together {
        true => (
            quote!(line::fill_in_lanes),
            quote!(, &#stage { model: self, h: &#step, at, first }),
        ),
        false => (quote!(line::fill), TokenStream::new()),
    };
    let beside = quote! {
        pulls.#field.part(0..first + #front).fill(#t::none());
        pulls.#field.part(last + #front..pulls.#field.len()).fill(#t::none());
    };
    let around = match of_line && l.line.lattice.periodic.is_some() {
        true => quote! {
            if self.is_ring() {
                for i in (0..#front).rev() {
                    pulls.#field.set(i, pulls.#field.at(i + self.sites.#count));
                }
            } else {
                #beside
            }
        },
        false => beside,
    };
    quote! {
        {
            #range
            #fill(self.threads, pulls.#field.part(first + #front..last + #front), |i| {
                let site = first + i;
                self.#field(#step, #(#values),*)
            } #together);
            #around
        }
    }
}

/// The function that evaluates all terms.
fn sweep(l: &Lines, loops: &TokenStream) -> TokenStream {
    let (places, pulls) = (l.item("Places"), l.item("Pulls"));
    let step = super::locals::step(&l.line.representative.d);
    quote! {
        /// The contributions of neighbours and ends at these positions.
        #[inline]
        fn pulled(&self, #step: T, at: &#places<T>, pulls: &mut #pulls<T>) {
            let _ = (#step, at, &pulls);
            #loops
            self.ended(#step, at, pulls);
        }
    }
}
