//! The arguments of a kernel: the values at sites in its expressions. Each argument names its list, which a loop over
//! single sites indexes, and a loop over several sites reads through a window.

use super::locals::{Places, StatedLetter};
use super::{Lines, Moving, number};
use crate::emit::expression::{Bindings, ty};
use crate::emit::names::local_name;
use crate::expr::symbol::{Role, Symbols};
use crate::lattice::Kind;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// The values of letters in a kernel.
#[derive(Default)]
pub(super) struct LetterValues {
    /// Parameters of the whole chain.
    pub lets: TokenStream,
    /// Values at sites.
    pub arguments: Vec<Argument>,
    pub bindings: Bindings,
}

/// A value at a site that a kernel reads.
#[derive(Clone)]
pub(super) struct Argument {
    pub name: Ident,
    field: Ident,
    list: List,
    /// The number of sites after the kernel's own.
    pub on: usize,
    /// Whether it is the value at the next node in time.
    next: bool,
    ty: TokenStream,
    /// The part of the value that the kernel uses.
    part: TokenStream,
}

/// The list that contains an argument.
#[derive(Clone, Copy, PartialEq)]
enum List {
    /// Parameters of sites.
    Given,
    /// Positions of fields.
    Field,
    /// Attitudes.
    Turning,
}

impl Argument {
    /// A whole position; for rotations, its matrix.
    pub(super) fn place(m: &Moving, name: Ident) -> Argument {
        let (list, ty, part) = match m.is_rotation() {
            true => (List::Turning, quote!(SMatrix<T, 3, 3>), quote!(.matrix())),
            false => (List::Field, m.covector(), TokenStream::new()),
        };
        let field = m.name();
        Argument {
            name,
            field,
            list,
            on: 0,
            next: false,
            ty,
            part,
        }
    }

    /// `name: Type`.
    pub(super) fn declared(&self) -> TokenStream {
        let (name, ty) = (&self.name, &self.ty);
        quote!(#name: #ty)
    }

    fn index(&self, site: &TokenStream) -> TokenStream {
        match self.on {
            0 => site.clone(),
            n => {
                let n = number(n);
                quote!(#site + #n)
            }
        }
    }

    /// Its value at a site.
    pub(super) fn value(&self, places: &Places, site: &TokenStream) -> TokenStream {
        let (field, part, index) = (&self.field, &self.part, self.index(site));
        let at = if self.next {
            &places.next
        } else {
            &places.here
        };
        match self.list {
            List::Given => quote!(self.parameters.#field[#index]),
            List::Field => quote!(#at.#field[#index] #part),
            List::Turning => quote!(#at.#field.at(#index) #part),
        }
    }

    /// Its value in the window of its list.
    pub(super) fn seen(&self) -> TokenStream {
        let (at, part) = (seen_at(&self.window(), self.on), &self.part);
        quote!(#at #part)
    }

    /// The name of the window of its list.
    pub(super) fn window(&self) -> Ident {
        format_ident!("at_{}", self.field)
    }

    /// Its list, as named in a loop over several sites.
    pub(super) fn list(&self) -> TokenStream {
        let field = &self.field;
        match self.list {
            List::Given => quote!(model.parameters.#field),
            _ => quote!(at.#field),
        }
    }
}

/// The value in a window, `on` sites after the kernel's own.
pub(super) fn seen_at(window: &Ident, on: usize) -> TokenStream {
    match on {
        0 => quote!(#window.at(site)),
        n => {
            let n = number(n);
            quote!(#window.ahead::<#n>(site))
        }
    }
}

impl Lines<'_> {
    /// The values of letters: parameters of the whole chain as `let` statements, values at sites as arguments.
    pub(super) fn read(&self, s: &Symbols, letters: &[StatedLetter]) -> LetterValues {
        let mut read = LetterValues::default();
        let mut used = Vec::new();
        for known in letters {
            let symbol = s.get(known.letter.symbol);
            if symbol.role == Role::Step || symbol.role == Role::Velocity {
                continue;
            }
            let next = known.letter.shift.time != 0;
            let base = local_name(s, &known.of).to_string();
            let base = match (known.on, next) {
                (None | Some(0), false) => base,
                (None | Some(0), true) => format!("{base}_next"),
                (Some(n), false) => format!("{base}_{n}"),
                (Some(n), true) => format!("{base}_{n}_next"),
            };
            let name = self.unique(&known.of, &base, &mut used);
            let field = format_ident!("{}", known.of);
            let stated = self.line.lattice.find(&known.of).map(|q| q.kind);
            let (Some(kind), Some(on)) = (stated, known.on) else {
                read.lets
                    .extend(quote!(let #name = self.parameters.#field;));
                read.bindings.bind(known.letter, name);
                continue;
            };
            let argument = |name: Ident, list: List, ty: TokenStream, part: TokenStream| Argument {
                name,
                field: field.clone(),
                list,
                on,
                next,
                ty,
                part,
            };
            if kind != Kind::Configuration {
                let ty = ty(s, symbol.shape);
                let one = argument(name.clone(), List::Given, ty, TokenStream::new());
                read.arguments.push(one);
                read.bindings.bind(known.letter, name);
                continue;
            }
            let own = self.moving().find(|m| m.mover.name == known.of);
            let quaternion = own.is_some_and(|m| m.is_quaternion());
            if quaternion && known.stands.turned {
                let turn = self.unique(&known.of, &format!("{base}_turn"), &mut used);
                let (ty, part) = (quote!(SMatrix<T, 3, 3>), quote!(.matrix()));
                read.arguments
                    .push(argument(turn.clone(), List::Turning, ty, part));
                read.bindings.bind_rotation(known.letter, turn);
            }
            if quaternion && known.stands.parted {
                let unit = self.unique(&known.of, &format!("{base}_unit"), &mut used);
                let (ty, part) = (quote!(UnitQuaternion<T>), quote!(.unit_quaternion()));
                read.arguments
                    .push(argument(unit.clone(), List::Turning, ty, part));
                read.bindings.bind_quaternion(known.letter, unit);
            }
            if quaternion && !known.stands.alone {
                continue;
            }
            let rotation = own.is_some_and(|m| m.is_rotation());
            let (list, ty, part) = match (rotation, symbol.shape.is_scalar()) {
                _ if quaternion => {
                    let part = quote!(.unit_quaternion().matrix());
                    (List::Turning, quote!(SMatrix<T, 4, 4>), part)
                }
                (true, _) => (List::Turning, quote!(SMatrix<T, 3, 3>), quote!(.matrix())),
                (_, true) => (List::Field, quote!(T), quote!([0])),
                _ => (List::Field, ty(s, symbol.shape), TokenStream::new()),
            };
            read.arguments.push(argument(name.clone(), list, ty, part));
            read.bindings.bind(known.letter, name);
        }
        read
    }
}
