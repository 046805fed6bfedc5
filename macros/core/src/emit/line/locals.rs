//! The locals with which a kernel begins: what its expressions read of parameters and places.

use super::{Lines, number};
use crate::derive::Outline;
use crate::emit::expression::{Bindings, program, ty};
use crate::emit::names::{local_name, variable};
use crate::expr::shape::Structure;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Map, Node};
use crate::lattice::Kind;
use crate::schedule;
use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

/// A letter as stated: the quantity, and how many sites on from the site of the kernel.
pub(super) struct Known {
    pub letter: Letter,
    pub of: String,
    pub on: Option<usize>,
    pub stands: Stands,
}

/// How a unit quaternion stands in expressions.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct Stands {
    /// By itself, as a matrix of four rows.
    pub alone: bool,
    /// By the rotation that it covers.
    pub turned: bool,
    /// By its parts, or by those of the quaternion from it to another.
    pub parted: bool,
}

impl Stands {
    /// How a letter stands in these.
    pub(super) fn of(s: &Symbols, letter: Letter, list: &[Expr]) -> Stands {
        let mut out = Stands::default();
        list.iter().for_each(|e| out.look(s, letter, e));
        out
    }

    fn look(&mut self, s: &Symbols, letter: Letter, e: &Expr) {
        let is_own = |e: &Expr| matches!(e.node(), Node::Letter(l) if *l == letter);
        match e.node() {
            Node::Letter(_) => self.alone |= is_own(e),
            Node::Map(Map::Rotation, a) if is_own(a) => self.turned = true,
            Node::Map(Map::Real | Map::Imaginary, a) if is_own(a) => self.parted = true,
            Node::Map(Map::Real | Map::Imaginary, a) if is_between(s, a) => {
                self.parted |= expr::contains(a, letter);
            }
            _ => e.children().iter().for_each(|c| self.look(s, letter, c)),
        }
    }
}

/// Whether it is the quaternion from one that moves to another, `q^T p`.
pub(super) fn is_between(s: &Symbols, e: &Expr) -> bool {
    let Node::Product(two) = e.node() else {
        return false;
    };
    let [a, b] = two.as_slice() else {
        return false;
    };
    let Node::Transpose(a) = a.node() else {
        return false;
    };
    let moves = |e: &Expr| match e.node() {
        Node::Letter(l) => {
            let symbol = s.get(l.symbol);
            symbol.structure == Structure::UnitQuaternion && symbol.role == Role::Element
        }
        _ => false,
    };
    moves(a) && moves(b) && a != b
}

/// What letters stand for in a kernel.
#[derive(Default)]
pub(super) struct Read {
    /// Parameters of the whole line.
    pub lets: TokenStream,
    /// What stands at sites.
    pub arguments: Vec<Argument>,
    pub bindings: Bindings,
}

/// What a kernel reads at a site.
#[derive(Clone)]
pub(super) struct Argument {
    pub name: Ident,
    field: Ident,
    list: List,
    /// How many sites on from that of the kernel.
    pub on: usize,
    /// Whether at the next node in time.
    next: bool,
    ty: TokenStream,
    /// What is read of the value.
    part: TokenStream,
}

/// The list that an argument is read from.
#[derive(Clone, Copy, PartialEq)]
enum List {
    /// Parameters of sites.
    Given,
    /// Places of fields.
    Field,
    /// Attitudes.
    Turning,
}

impl Argument {
    /// A place that is read as a whole, of what turns its matrix.
    pub(super) fn place(m: &super::Moving, name: Ident) -> Argument {
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
        let (window, part, index) = (self.window(), &self.part, self.index(&quote!(site)));
        quote!(#window.at(#index) #part)
    }

    /// The name of the window of its list.
    pub(super) fn window(&self) -> Ident {
        format_ident!("at_{}", self.field)
    }

    /// Its list, as the stage of a loop finds it.
    pub(super) fn list(&self) -> TokenStream {
        let field = &self.field;
        match self.list {
            List::Given => quote!(model.parameters.#field),
            _ => quote!(at.#field),
        }
    }
}

/// Where places at the node and at the next one are found.
pub(super) struct Places {
    pub here: TokenStream,
    pub next: TokenStream,
}

impl Places {
    /// Those of one node, in the argument `at` of a kernel.
    pub(super) fn of_node() -> Places {
        let (here, next) = (quote!(at), quote!(at));
        Places { here, next }
    }
}

impl Lines<'_> {
    /// Expressions of what stands at one node: what comes before them, and their values.
    pub(super) fn computed(
        &self,
        s: &Symbols,
        letters: &[Known],
        values: &[Expr],
    ) -> (TokenStream, Vec<TokenStream>) {
        let (locals, bindings) = self.locals(s, letters, &Places::of_node(), &quote!(site));
        let (lets, values) = self.program(s, values, &bindings);
        (quote!(#locals #lets), values)
    }

    /// Expressions whose letters are bound, with their temporaries.
    pub(super) fn program(
        &self,
        s: &Symbols,
        values: &[Expr],
        bindings: &Bindings,
    ) -> (TokenStream, Vec<TokenStream>) {
        program(&schedule::program(s, values, &self.temporary), bindings)
    }

    /// Lets for letters, and their bindings. `site` is the index of the kernel.
    pub(super) fn locals(
        &self,
        s: &Symbols,
        letters: &[Known],
        places: &Places,
        site: &TokenStream,
    ) -> (TokenStream, Bindings) {
        let read = self.read(s, letters);
        let mut out = read.lets;
        for one in &read.arguments {
            let (name, value) = (&one.name, one.value(places, site));
            out.extend(quote!(let #name = #value;));
        }
        (out, read.bindings)
    }

    /// What letters stand for: parameters of the whole line in lets, what stands at sites as arguments.
    pub(super) fn read(&self, s: &Symbols, letters: &[Known]) -> Read {
        let mut read = Read::default();
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

    /// The letters of expressions of one site.
    pub(super) fn of_site(&self, d: &Outline, list: &[Expr]) -> Vec<Known> {
        let s = &d.letters.symbols;
        let letters = crate::emit::items::letters_of(list);
        let known = letters.into_iter().map(|letter| {
            let of = s.get(letter.symbol).name.clone();
            let on = self.line.lattice.find(&of).map(|_| 0);
            let stands = Stands::of(s, letter, list);
            Known {
                letter,
                of,
                on,
                stands,
            }
        });
        known.collect()
    }
}

/// The name of the step as a local.
pub(super) fn step(d: &Outline) -> proc_macro2::Ident {
    variable(&d.letters.symbols, d.spec.step)
}
