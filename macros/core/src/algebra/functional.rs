//! Functionals in normal forms: one opaque letter for each functional, arguments and derivatives. Derivatives are
//! linear in directions and seeds and symmetric in their directions, and `<s, D f(x)[u]>` equals `<(D f(x))^T[s],
//! u>`. Nothing else is known. At random points they have random derivatives.

mod sites;
#[cfg(test)]
mod tests;

use super::exact::{Matrix, Point, add, mix, mul, negate};
use super::factor::{Factor, Source, Word};
use super::monomial::{self, Atom, Monomial};
use super::poly::{Poly, Term};
use super::rational::Rational;
use super::{Algebra, KeyRelation};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::{self, Applied, Expr, FunctionalId, Kind, Node, Reach};
use crate::work;

/// The largest number of entries of a value whose derivatives are expressed by derivatives of its entries.
const LARGEST: u32 = 16;

/// The largest number of products for the value of one derivative at a point.
const MOST: usize = 20_000;

/// Identifies an opaque value: two values are the same if their arguments agree in normal form, and their sorted
/// directions agree.
#[derive(PartialEq)]
pub(super) struct Opened {
    functional: FunctionalId,
    arguments: Vec<Poly>,
    along: Vec<(u8, Poly)>,
    back: Option<(u8, Poly)>,
}

/// Directions and the seed: one term of each, or each of them unchanged.
#[derive(Clone)]
struct Slots {
    coefficient: Rational,
    monomial: Monomial,
    along: Vec<(u8, Poly)>,
    seed: Option<Poly>,
}

impl Algebra<'_> {
    /// The normal form of a value or a pull-back.
    pub(super) fn functional(&self, e: &Expr, a: &Applied, back: Option<(u8, &Expr)>) -> Poly {
        // Arguments contain functionals in turn, and each is lowered once.
        let key = (e.clone(), self.blocks.get());
        if let Some(known) = self.given.borrow().get(&key) {
            return known.clone();
        }
        let lowered = self.functional_anew(e, a, back);
        self.given.borrow_mut().insert(key, lowered.clone());
        lowered
    }

    fn functional_anew(&self, e: &Expr, a: &Applied, back: Option<(u8, &Expr)>) -> Poly {
        let f = self.symbols.functional(a.functional);
        if f.reach == Reach::Point
            && (back.is_some() || !a.along.is_empty())
            && let Some(written) = self.by_entries(a, back, f.value)
        {
            return self.lower(&written);
        }
        let mut out = Poly::zero(e.shape());
        for slots in self.slots(f.reach, a, back.map(|(_, seed)| seed)) {
            let which = back.map(|(i, _)| i);
            let letter = self.opaque(a, slots.along, which.zip(slots.seed), e.shape());
            for (t, c) in &letter.terms {
                match (
                    monomial::times(&slots.monomial, &t.monomial),
                    c.times(slots.coefficient),
                ) {
                    (Some(m), Some(c)) => self.push_reduced(&mut out, c, &m, t.word.clone()),
                    _ => self.exhaust(),
                }
            }
            if self.exhausted() {
                break;
            }
        }
        out
    }

    /// The expression in gradients of the entries of the value. These are pull-backs of unit seeds, which also
    /// replace the transposed derivative. None if the expression already has this form.
    fn by_entries(&self, a: &Applied, back: Option<(u8, &Expr)>, value: Kind) -> Option<Expr> {
        let s = self.symbols;
        let basis = basis(s, value)?;
        let unit = |x: &Expr| basis.iter().any(|(_, own)| own == x);
        if value.shape.is_scalar() || back.is_some_and(|(_, seed)| unit(seed)) {
            return None;
        }
        // The choice does not depend on the order of the directions.
        let last = match back {
            Some(_) => None,
            None => {
                let key = |(_, (i, x)): &(usize, &(u8, Expr))| (*i, self.lower(x));
                Some(a.along.iter().enumerate().max_by_key(key)?.0)
            }
        };
        let terms = basis.iter().map(|(entry, own)| match (back, last) {
            (Some((which, seed)), _) => {
                let gradient = expr::pull_back(s, a.clone(), which, own.clone());
                expr::mul(expr::pairing(s, entry.clone(), seed.clone()), gradient)
            }
            (None, place) => {
                let place = place.unwrap_or_default();
                let (which, amount) = &a.along[place];
                let gradient = expr::pull_back(s, a.less_one(place), *which, own.clone());
                expr::mul(expr::pairing(s, gradient, amount.clone()), entry.clone())
            }
        });
        let shape = match back {
            Some((which, _)) => a.arguments[usize::from(which)].shape(),
            None => value.shape,
        };
        Some(expr::sum(terms.collect::<Vec<_>>(), shape))
    }

    /// Directions and the seed, term by term.
    fn slots(&self, reach: Reach, a: &Applied, seed: Option<&Expr>) -> Vec<Slots> {
        let mut all = vec![Slots {
            coefficient: Rational::ONE,
            monomial: Monomial::new(),
            along: Vec::new(),
            seed: None,
        }];
        let directions = a.along.iter().map(|(i, x)| (Some(*i), x));
        for (which, x) in directions.chain(seed.map(|x| (None, x))) {
            let terms = self.lower(x).terms;
            let mut next = Vec::new();
            for slots in &all {
                for (t, c) in &terms {
                    let mut slots = slots.clone();
                    let (out, kept) = match reach {
                        Reach::Point => (t.monomial.clone(), Monomial::new()),
                        Reach::Sites => (Monomial::new(), t.monomial.clone()),
                    };
                    let (Some(m), Some(c)) = (
                        monomial::times(&slots.monomial, &out),
                        slots.coefficient.times(*c),
                    ) else {
                        self.exhaust();
                        return Vec::new();
                    };
                    (slots.monomial, slots.coefficient) = (m, c);
                    let term = Term {
                        monomial: kept,
                        word: t.word.clone(),
                    };
                    let own = Poly::term(x.shape(), Rational::ONE, term);
                    match which {
                        Some(i) => slots.along.push((i, own)),
                        None => slots.seed = Some(own),
                    }
                    next.push(slots);
                }
            }
            if !self.spend(next.len()) {
                return Vec::new();
            }
            all = next;
        }
        all
    }

    /// The letter of one opaque value.
    fn opaque(
        &self,
        a: &Applied,
        mut along: Vec<(u8, Poly)>,
        back: Option<(u8, Poly)>,
        shape: Shape,
    ) -> Poly {
        along.sort();
        let arguments: Vec<Poly> = a.arguments.iter().map(|x| self.lower(x)).collect();
        // Letters that cancel in the arguments must not reappear.
        let shorter = |own: &Expr, key: &Poly| {
            let raised = self.raise(key);
            let (left, all) = (expr::letters(&raised), expr::letters(own));
            match left.len() < all.len() && left.iter().all(|l| all.contains(l)) {
                true => raised,
                false => own.clone(),
            }
        };
        let meant = Applied {
            functional: a.functional,
            arguments: a
                .arguments
                .iter()
                .zip(&arguments)
                .map(|(x, k)| shorter(x, k))
                .collect(),
            along: along.iter().map(|(i, p)| (*i, self.raise(p))).collect(),
        };
        let meaning = match &back {
            Some((i, seed)) => expr::pull_back(self.symbols, meant, *i, self.raise(seed)),
            None => expr::derived(self.symbols, meant),
        };
        let kind = expr::kind(self.symbols, meaning.node());
        let opened = Opened {
            functional: a.functional,
            arguments,
            along,
            back,
        };
        let found = self.opened.borrow().iter().position(|o| *o == opened);
        let i = found.unwrap_or_else(|| {
            let mut table = self.opened.borrow_mut();
            table.push(opened);
            table.len() - 1
        });
        let sense = KeyRelation::Given(i as u32);
        let mut key = Poly::zero(shape);
        key.symmetric =
            kind.is_some_and(|k| matches!(k.structure, Structure::Symmetric | Structure::Diagonal));
        let (monomial, word) = match shape.is_scalar() {
            true => {
                let id = self.intern(&self.numbers, key, sense, || meaning);
                (vec![(Atom::Given(id), Rational::ONE)], Word::new())
            }
            false => {
                let id = self.intern(&self.matrices, key, sense, || meaning);
                let letter = Factor::Letter {
                    source: Source::Opaque(id),
                    transposed: false,
                    inverted: false,
                };
                (Monomial::new(), vec![letter])
            }
        };
        Poly::term(shape, Rational::ONE, Term { monomial, word })
    }
}

/// The matrix units of a shape, each with the unit that has the same gradient. `None` if the shape is too large or
/// has a named size.
fn basis(s: &expr::symbol::Symbols, value: Kind) -> Option<Vec<(Expr, Expr)>> {
    let Shape { rows, cols } = value.shape;
    let (Dim::Fixed(n), Dim::Fixed(m)) = (rows, cols) else {
        return None;
    };
    if n.checked_mul(m).is_none_or(|all| all > LARGEST) {
        return None;
    }
    let unit = |i: u32, j: u32| {
        let axis = |dim, k: u32| expr::unit(dim, k as u8);
        match (n, m) {
            (1, 1) => expr::integer(1),
            (_, 1) => axis(rows, i),
            (1, _) => expr::transpose(s, axis(cols, j)),
            _ => expr::mul(axis(rows, i), expr::transpose(s, axis(cols, j))),
        }
    };
    let places = (0..n).flat_map(|i| (0..m).map(move |j| (i, j)));
    let units = places.map(|(i, j)| match value.structure {
        Structure::Symmetric => (unit(i, j), unit(i.min(j), i.max(j))),
        _ => (unit(i, j), unit(i, j)),
    });
    Some(units.collect())
}

/// One entry of a value or an argument, by the entry that represents it: its number in the list of differentiated
/// quantities, its row and its column.
type Entry = (u8, usize, usize);

/// The representative of this entry, and whether it has the opposite sign. None if the entry is zero.
fn standing(structure: Structure, i: usize, j: usize) -> Option<(bool, usize, usize)> {
    match structure {
        Structure::Symmetric => Some((false, i.min(j), i.max(j))),
        Structure::Skew => (i != j).then_some((i > j, i.min(j), i.max(j))),
        Structure::Diagonal => (i == j).then_some((false, i, j)),
        Structure::General
        | Structure::Orthogonal
        | Structure::Invertible
        | Structure::UnitQuaternion
        | Structure::RigidMotion => Some((false, i, j)),
    }
}

/// The nonzero entries of a matrix.
fn entries(a: &Matrix) -> Vec<(usize, usize, u64)> {
    let places = (0..a.rows).flat_map(|i| (0..a.cols).map(move |j| (i, j)));
    let all = places.map(|(i, j)| (i, j, a.at(i, j)));
    all.filter(|(.., x)| *x != 0).collect()
}

impl Point<'_> {
    /// The value of a functional or of its pull-back. It depends on the arguments only, and linearly on directions
    /// and seed. `None` for a functional of all sites, since a point contains no other sites.
    pub(super) fn functional(&self, e: &Expr) -> Option<Matrix> {
        let (a, back) = match e.node() {
            Node::Given(a) => (a, None),
            Node::PullBack(a, which, seed) => (a, Some((*which, seed))),
            _ => return None,
        };
        let f = self.symbols().functional(a.functional);
        if f.reach == Reach::Sites {
            return None;
        }
        let mut key = mix(self.seed ^ mix(0x6669_656c ^ u64::from(a.functional.0)));
        for x in &a.arguments {
            let x = self.value(x)?;
            key = x.data.iter().fold(key, |key, x| mix(key ^ mix(*x)));
        }
        let mut along = Vec::new();
        for (i, x) in &a.along {
            along.push((*i, entries(&self.value(x)?)));
        }
        let size = |shape: Shape| (self.dim(shape.rows), self.dim(shape.cols));
        let (rows, cols) = size(e.shape());
        let whole = [(0, 0, 1)].to_vec();
        let (seed, open) = match back {
            Some((which, seed)) => (entries(&self.value(seed)?), Some(which)),
            None => (whole, None),
        };
        let directions = along.iter().map(|(_, x)| x.len());
        let products = directions.fold(rows * cols * seed.len(), usize::saturating_mul);
        if products > MOST || !work::take(products) {
            return None;
        }
        let structure = |i: u8| {
            let kind = f.arguments.get(usize::from(i));
            kind.map_or(Structure::General, |k| k.structure)
        };
        let entry = |i: usize, j: usize| {
            let mut total = 0;
            for (k, l, weight) in &seed {
                // The entry of the value, and the entry of the argument for its pull-back.
                let (own, other) = match open {
                    Some(which) => (standing(f.value.structure, *k, *l), Some((which, i, j))),
                    None => (standing(f.value.structure, i, j), None),
                };
                let Some((minus, k, l)) = own else { continue };
                let mut found: Vec<(u64, Vec<Entry>)> = vec![(signed(*weight, minus), Vec::new())];
                let fixed = other.map(|(which, i, j)| (which, vec![(i, j, 1)]));
                for (which, list) in along.iter().chain(&fixed) {
                    found = more(&found, *which, structure(*which), list);
                }
                for (x, mut slots) in found {
                    slots.sort_unstable();
                    total = add(total, mul(x, at(key, k, l, &slots)));
                }
            }
            total
        };
        Some(Matrix::from_fn(rows, cols, entry))
    }
}

fn signed(x: u64, minus: bool) -> u64 {
    if minus { negate(x) } else { x }
}

/// Multiplies each product so far by every entry of another direction.
fn more(
    found: &[(u64, Vec<Entry>)],
    which: u8,
    structure: Structure,
    list: &[(usize, usize, u64)],
) -> Vec<(u64, Vec<Entry>)> {
    let mut all = Vec::new();
    for (x, slots) in found {
        for (i, j, y) in list {
            if let Some((minus, i, j)) = standing(structure, *i, *j) {
                let mut slots = slots.clone();
                slots.push((which, i, j));
                all.push((mul(*x, signed(*y, minus)), slots));
            }
        }
    }
    all
}

/// The derivative of one entry of the value along these entries of arguments.
fn at(key: u64, k: usize, l: usize, slots: &[Entry]) -> u64 {
    let start = mix(key ^ mix((k * 64 + l) as u64));
    slots.iter().fold(start, |key, (which, i, j)| {
        mix(key ^ mix(u64::from(*which) << 32 | (1 + i * 64 + j) as u64))
    })
}
