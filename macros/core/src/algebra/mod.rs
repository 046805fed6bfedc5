//! Normal forms: exact decisions about noncommutative matrix expressions. An [`Algebra`] lowers expressions to
//! polynomials in words of letters ([`Poly`]), in which equal expressions are identical. There is no search, and the
//! work is bounded; clebsch reports an exceeded bound and never guesses.

pub(crate) mod assumed;
mod bracket;
mod diagonal;
pub(crate) mod exact;
mod factor;
mod functional;
mod lower;
mod monomial;
mod normal_form_cache;
mod poly;
mod prime;
mod quaternion;
mod raise;
mod rational;
mod reduce;
mod rigid;
#[cfg(test)]
mod tests;

pub use factor::{Factor, Source, Word};
pub use monomial::{Atom, Monomial};
pub use poly::{Poly, Term};
pub use rational::Rational;
pub(crate) use rigid::{inclusion_of_space, last_unit};

use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Hashed};
use std::cell::{Cell, RefCell};
use std::collections::HashMap;

/// The work limit for one model, in products of terms. A model of the gallery needs a few thousand; the limit keeps
/// any input of 10 kB below two seconds.
const WORK_LIMIT: u64 = 1_000_000;

/// The work limit for this model: an expanded chain has a larger one.
fn work_limit() -> u64 {
    WORK_LIMIT.saturating_mul(crate::work::times())
}

/// The limit on nodes evaluated at exact points for one model. Beyond it, only normal forms decide.
const EVALUATION_LIMIT: u64 = 300_000;

/// The largest number of terms in a normal form; a larger normal form also exceeds the work limit.
const TERM_LIMIT: usize = 4_000;

fn evaluation_limit() -> u64 {
    EVALUATION_LIMIT.saturating_mul(crate::work::times())
}

fn term_limit() -> usize {
    TERM_LIMIT.saturating_mul(usize::try_from(crate::work::times()).unwrap_or(1))
}

/// The length of the longest word.
const WORD_LIMIT: usize = 64;

/// Why a normal form was not computed.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Excess {
    /// The number of terms.
    Terms(usize),
    /// A word with this number of factors.
    Word(usize),
    /// A coefficient or an exponent that overflows exact fractions.
    Coefficient,
    /// The number of nodes to be evaluated at points.
    Evaluated(u64),
    /// A normal form whose value at a random point differs from that of the expression.
    Contradiction,
}

/// The normal-form engine of one model: its symbols, the opaque quantities so far (inverses of sums, roots of sums,
/// ...) and the work spent.
pub struct Algebra<'a> {
    symbols: &'a Symbols,
    matrices: RefCell<Vec<Opaque>>,
    numbers: RefCell<Vec<Opaque>>,
    /// The keys of the opaque values of functionals.
    opened: RefCell<Vec<functional::Opened>>,
    /// Their normal forms, with and without blocks. Looked up, never iterated.
    given: RefCell<HashMap<(Expr, bool), Poly>>,
    /// Normal forms, without blocks and with blocks. Looked up, never iterated.
    lowered: [RefCell<Hashed<normal_form_cache::Lowered>>; 2],
    work: Cell<u64>,
    evaluated: Cell<u64>,
    excess: Cell<Option<Excess>>,
    /// Whether rigid motions are expressed by their rotations and translations.
    blocks: Cell<bool>,
}

/// How an identity was decided.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Decision {
    /// Both sides have the same normal form.
    NormalForm,
    /// The normal forms differ, but both sides agree at random points in exact arithmetic modulo a prime of 61 bits,
    /// as identities of three dimensions do.
    ExactEvaluation,
}

/// A sub-expression that the normal form treats as one letter.
struct Opaque {
    key: Poly,
    meaning: Expr,
    /// Its relation to the key.
    sense: KeyRelation,
}

/// The relation of an opaque quantity to its key.
#[derive(Clone, Copy, PartialEq, Eq)]
enum KeyRelation {
    /// The key itself.
    Value,
    /// The diagonal of a matrix, or the matrix with that diagonal.
    Diagonal,
    /// The diagonal of a matrix, as a vector.
    DiagonalVector,
    /// No relation: the value of a functional, by its number.
    Given(u32),
}

impl<'a> Algebra<'a> {
    /// An engine for the symbols of one model.
    pub fn new(symbols: &'a Symbols) -> Self {
        Algebra {
            symbols,
            matrices: RefCell::default(),
            numbers: RefCell::default(),
            opened: RefCell::default(),
            given: RefCell::default(),
            lowered: Default::default(),
            work: Cell::new(0),
            evaluated: Cell::new(0),
            excess: Cell::new(None),
            blocks: Cell::new(false),
        }
    }

    /// An engine for more symbols that starts with the work spent so far.
    pub(crate) fn over<'b>(&self, symbols: &'b Symbols) -> Algebra<'b> {
        let other = Algebra::new(symbols);
        other.work.set(self.work.get());
        other.evaluated.set(self.evaluated.get());
        other
    }

    /// Adds the work of another engine since [`Algebra::over`] created it.
    pub(crate) fn charge(&self, other: &Algebra) {
        self.work.set(other.work.get());
        self.evaluated.set(other.evaluated.get());
        self.excess.set(self.excess.get().or(other.excess.get()));
    }

    /// The symbols.
    pub fn symbols(&self) -> &'a Symbols {
        self.symbols
    }

    /// The products of terms computed so far.
    pub(crate) fn spent(&self) -> u64 {
        self.work.get()
    }

    /// Whether an expression was too large to normalise; all later answers are void.
    pub fn exhausted(&self) -> bool {
        self.work.get() > work_limit() || crate::work::exhausted()
    }

    /// How the expression is proved to vanish identically. None if it does not vanish, or if the work limit was
    /// reached.
    pub fn zero(&self, e: &Expr) -> Option<Decision> {
        if self.exhausted() {
            return None;
        }
        let normal = self.lower(e);
        if self.exhausted() {
            return None;
        }
        if normal.is_zero() {
            return self.unless_contradicted(e);
        }
        let summed = self.by_parts(&normal);
        if !self.exhausted() && summed.is_some_and(|p| p.is_zero()) {
            return self.unless_contradicted(e);
        }
        let in_blocks = self.lower_in_blocks(e);
        if !self.exhausted() && in_blocks.is_some_and(|p| p.is_zero()) {
            return self.unless_contradicted(e);
        }
        self.vanishes_at_points(e)
            .then_some(Decision::ExactEvaluation)
    }

    /// `NormalForm`, unless exact evaluation at a random point contradicts the normal form.
    fn unless_contradicted(&self, e: &Expr) -> Option<Decision> {
        if exact::differs_from_zero(self.symbols, e) {
            self.contradicted();
            return None;
        }
        Some(Decision::NormalForm)
    }

    /// Ends the derivation: a normal form is wrong, so no conclusion from normal forms can be trusted.
    pub(crate) fn contradicted(&self) {
        self.note(Excess::Contradiction);
        self.work.set(u64::MAX);
    }

    fn vanishes_at_points(&self, e: &Expr) -> bool {
        let spent = self.evaluated.get().saturating_add(u64::from(e.size()));
        self.evaluated.set(spent);
        if spent > evaluation_limit() {
            self.note(Excess::Evaluated(spent));
        }
        spent <= evaluation_limit() && exact::vanishes(self.symbols, e)
    }

    /// Whether the expression vanishes identically.
    pub fn is_zero(&self, e: &Expr) -> bool {
        self.zero(e).is_some()
    }

    /// Whether two expressions of equal shape agree at exact random points. This is cheaper than [`Algebra::equal`]
    /// if most pairs differ.
    pub fn agree(&self, a: &Expr, b: &Expr) -> bool {
        self.vanishes_at_points(&crate::expr::sub(a.clone(), b.clone()))
    }

    /// Whether two expressions of equal shape are identically equal.
    pub fn equal(&self, a: &Expr, b: &Expr) -> bool {
        self.is_zero(&crate::expr::sub(a.clone(), b.clone()))
    }

    /// Charges work; `false` if the limit is reached.
    fn spend(&self, units: usize) -> bool {
        self.work.set(self.work.get().saturating_add(units as u64));
        !self.exhausted()
    }

    /// Marks the work limit of this model as exceeded.
    fn exhaust(&self) {
        self.note(Excess::Coefficient);
        self.work.set(u64::MAX);
    }

    fn note(&self, excess: Excess) {
        self.excess.set(self.excess.get().or(Some(excess)));
    }

    /// The limit that was exceeded, with the number found. None if everything was decided.
    pub(crate) fn excess(&self) -> Option<String> {
        if let Some(text) = crate::work::excess() {
            return Some(text);
        }
        let spent = self.work.get();
        Some(match self.excess.get() {
            Some(Excess::Terms(n)) => {
                format!(
                    "a normal form has {n} terms, and the limit is {}",
                    term_limit()
                )
            }
            Some(Excess::Word(n)) => format!(
                "a product in its normal form has {n} factors, and the limit is {WORD_LIMIT}"
            ),
            Some(Excess::Coefficient) => {
                "a coefficient of its normal form is not a fraction of whole numbers below 2^127"
                    .to_owned()
            }
            Some(Excess::Contradiction) => {
                "a normal form differs from its expression, which is an error of clebsch: please report this model"
                    .to_owned()
            }
            _ if spent > work_limit() => format!(
                "its normal forms need {spent} products of terms, and the limit is {}",
                work_limit()
            ),
            Some(Excess::Evaluated(n)) => format!(
                "its identities have {n} nodes to evaluate, and the limit is {}",
                evaluation_limit()
            ),
            None => return None,
        })
    }

    fn intern(
        &self,
        table: &RefCell<Vec<Opaque>>,
        key: Poly,
        sense: KeyRelation,
        meaning: impl FnOnce() -> Expr,
    ) -> u32 {
        let same = |o: &Opaque| o.sense == sense && o.key == key;
        let found = table.borrow().iter().position(same);
        if let Some(i) = found {
            return i as u32;
        }
        let mut meaning = meaning();
        // Letters that cancel in the key must not reappear through its expression: `V V^T` of a rotation is defined
        // even if no velocity is known.
        if sense == KeyRelation::Value {
            let shorter = self.raise(&key);
            let (left, all) = (expr::letters(&shorter), expr::letters(&meaning));
            if left.len() < all.len() && left.iter().all(|l| all.contains(l)) {
                meaning = shorter;
            }
        }
        let mut table = table.borrow_mut();
        table.push(Opaque {
            key,
            meaning,
            sense,
        });
        (table.len() - 1) as u32
    }
}
