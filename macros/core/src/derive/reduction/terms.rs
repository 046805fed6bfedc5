//! Terms of an unreduced Lagrangian: sums and products keep their form, and scalars in them are reduced in normal
//! form, word by word. Takes expressions in elements and velocities; gives them in velocities and advected
//! quantities, or the word that still contains an element.

use super::cancelled_elements::settled;
use super::element::Open;
use crate::algebra::{Algebra, Atom, Factor, Poly, Rational, Source, Term};
use crate::check::spec::{Configuration, Spec};
use crate::derive::action::summands;
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Node};

/// A quantity that the reduction found.
#[derive(Clone)]
pub(super) struct ReducedQuantity {
    pub(super) quantity: SymbolId,
    /// Its definition as a word, by which it is found again.
    pub(super) word: Vec<Factor>,
    pub(super) definition: Expr,
    pub(super) update: Expr,
}

/// An element of the group remains.
pub(super) struct LeftOver;

pub(super) type Reduced = Result<Expr, LeftOver>;

/// Reduces expressions and collects the advected quantities.
#[derive(Clone)]
pub(super) struct Reducer<'a> {
    pub(super) spec: &'a Spec,
    pub(super) algebra: &'a Algebra<'a>,
    /// The symbols, including the quantities found.
    pub(super) symbols: Symbols,
    pub(super) carried: Vec<ReducedQuantity>,
}

impl<'a> Reducer<'a> {
    /// With no quantities yet.
    pub(super) fn new(spec: &'a Spec, algebra: &'a Algebra<'a>) -> Reducer<'a> {
        Reducer {
            spec,
            algebra,
            symbols: spec.symbols.clone(),
            carried: Vec::new(),
        }
    }
}

impl<'a> Reducer<'a> {
    /// A scalar: parts in which the elements cancel come first, then the rest.
    pub(super) fn reduced(&mut self, e: &Expr) -> Reduced {
        let holds = |e: &Expr| self.holds_element(e);
        let e = settled(self.algebra, &holds, e);
        self.number(&e)
    }

    /// The scalar reduced term by term; a term that no parameter absorbs is unchanged.
    pub(super) fn as_far_as_possible(&mut self, e: &Expr) -> Expr {
        if let Ok(whole) = self.clone().reduced(e) {
            // Once more, with the quantities that were found.
            return self.reduced(e).unwrap_or(whole);
        }
        let terms =
            summands(&self.symbols, e)
                .into_iter()
                .map(|term| match self.clone().reduced(&term) {
                    Ok(_) => self.reduced(&term).unwrap_or(term),
                    Err(_) => term,
                });
        expr::sum(terms.collect::<Vec<_>>(), Shape::SCALAR)
    }

    /// A scalar whose sums and products keep their form.
    pub(super) fn number(&mut self, e: &Expr) -> Reduced {
        if !self.holds_element(e) {
            return Ok(e.clone());
        }
        Ok(match e.node() {
            Node::Sum(list) => {
                let terms: Result<Vec<Expr>, _> = list.iter().map(|t| self.number(t)).collect();
                expr::sum(terms?, Shape::SCALAR)
            }
            Node::Neg(a) => expr::neg(self.number(a)?),
            Node::Quotient(a, b) => {
                let a = self.number(a)?;
                expr::quotient(a, self.number(b)?)
            }
            Node::Product(list) if list.iter().all(|f| f.shape().is_scalar()) => {
                let factors: Result<Vec<Expr>, _> = list.iter().map(|f| self.number(f)).collect();
                expr::product(factors?)
            }
            Node::Power(a, q) => expr::power(self.number(a)?, *q),
            Node::Call(f, a) => expr::call(*f, self.number(a)?),
            Node::Given(_) | Node::PullBack(..) => self.functional(e)?,
            node => {
                if let Some(e) = self.relative(e) {
                    return Ok(e);
                }
                if let Node::Dot(a, b) = node
                    && let Some(e) = self.dot(a, b)
                {
                    return Ok(e);
                }
                self.poly(&self.algebra.lower(e))?
            }
        })
    }

    /// `(Λ1 u) · (Λ2 v) = u · (Λ1^T Λ2) v` if an element precedes every term of each side.
    fn dot(&mut self, a: &Expr, b: &Expr) -> Option<Expr> {
        let (first, u) = self.front(a)?;
        let (second, v) = self.front(b)?;
        let (minus, back) = self.algebra.transposed_factor(&first);
        debug_assert!(!minus);
        let word = self.algebra.cancelled_word(vec![back, second]);
        let middle = match word.as_slice() {
            [] => return Some(expr::dot(u, v)),
            _ => self.word(&word, false).ok()?,
        };
        let [piece] = middle.as_slice() else {
            return None;
        };
        Some(expr::dot(u, expr::mul(piece.clone(), v)))
    }

    /// The element with which every term of a vector starts, and the rest, if it contains no element.
    fn front(&self, e: &Expr) -> Option<(Factor, Expr)> {
        let poly = self.algebra.lower(e);
        let mut rest = Poly::zero(poly.shape);
        let mut front: Option<Factor> = None;
        for (term, c) in &poly.terms {
            let (first, others) = term.word.split_first()?;
            let open = self.open(first)?;
            if open != Open::Left || front.as_ref().is_some_and(|f| f != first) {
                return None;
            }
            front = Some(first.clone());
            let term = Term {
                monomial: term.monomial.clone(),
                word: others.to_vec(),
            };
            if !rest.push(term, *c) {
                return None;
            }
        }
        let rest = self.algebra.raise(&rest);
        (!self.holds_element(&rest)).then_some((front?, rest))
    }

    fn holds_element(&self, e: &Expr) -> bool {
        let letters = expr::letters(e);
        letters
            .iter()
            .any(|l| self.configuration(l.symbol).is_some())
    }

    pub(super) fn configuration(&self, symbol: SymbolId) -> Option<&'a Configuration> {
        let mut list = self.spec.configurations.iter();
        list.find(|c| c.element == symbol && !c.group.is_additive())
    }

    /// Whether a factor contains only parameters and the step size.
    pub(super) fn is_constant(&self, f: &Factor) -> bool {
        let term = Term {
            monomial: Vec::new(),
            word: vec![f.clone()],
        };
        let shape = self.algebra.factor_shape(f);
        let e = self.algebra.raise(&Poly::term(shape, Rational::ONE, term));
        expr::letters(&e).iter().all(|l| {
            matches!(
                self.symbols.get(l.symbol).role,
                Role::Parameter | Role::Step
            )
        })
    }

    /// A normal form, term by term.
    fn poly(&mut self, p: &Poly) -> Reduced {
        let mut terms = Vec::new();
        for (t, c) in &p.terms {
            let mut factors = vec![expr::number(*c)];
            for (atom, q) in &t.monomial {
                factors.push(expr::power(self.atom(atom)?, *q));
            }
            if !t.word.is_empty() {
                factors.extend(self.word(&t.word, false)?);
            } else if !p.shape.is_scalar() {
                factors.push(expr::identity(p.shape.rows));
            }
            terms.push(expr::product(factors));
        }
        Ok(expr::sum(terms, p.shape))
    }

    fn atom(&mut self, atom: &Atom) -> Reduced {
        Ok(match atom {
            Atom::Trace(word) => {
                let pieces = self.word(word, true)?;
                expr::trace(expr::product(pieces))
            }
            Atom::Bracket(word) => {
                let mut pieces = self.word(word, false)?.into_iter();
                let row = pieces.next().unwrap_or_else(|| expr::integer(1));
                let row = expr::transpose(&self.symbols, row);
                expr::dot(row, expr::product(pieces.collect::<Vec<_>>()))
            }
            Atom::Det(Source::Letter(l)) if self.configuration(l.symbol).is_some() => {
                self.determinant(*l)
            }
            Atom::OpaqueDet(i) => expr::det(self.opaque_matrix(*i)?),
            Atom::Base(i) | Atom::Given(i) => self.opaque_number(*i)?,
            Atom::Call(function, i) => expr::call(*function, self.opaque_number(*i)?),
            Atom::Letter(_) | Atom::Constant(_) | Atom::Dimension(_) | Atom::Det(_) => {
                let term = Term {
                    monomial: vec![(atom.clone(), Rational::ONE)],
                    word: Vec::new(),
                };
                self.algebra
                    .raise(&Poly::term(Shape::SCALAR, Rational::ONE, term))
            }
        })
    }

    /// A value of a functional: its arguments are reduced, and nothing is factored out.
    fn functional(&mut self, e: &Expr) -> Reduced {
        let mut refused = None;
        let symbols = self.symbols.clone();
        let reduced = expr::rebuild(&symbols, e, &mut |x| {
            let inside = match x.shape().is_scalar() {
                true => self.number(x),
                false if self.holds_element(x) => self.poly(&self.algebra.lower(x)),
                false => return x.clone(),
            };
            inside.unwrap_or_else(|e| {
                refused.get_or_insert(e);
                x.clone()
            })
        });
        match refused {
            Some(e) => Err(e),
            None => Ok(reduced),
        }
    }

    fn opaque_number(&mut self, i: u32) -> Reduced {
        let meaning = self.algebra.opaque_number(i);
        self.number(&meaning)
    }

    pub(super) fn opaque_matrix(&mut self, i: u32) -> Reduced {
        let meaning = self.algebra.opaque_matrix(i);
        if !self.holds_element(&meaning) {
            return Ok(meaning);
        }
        match meaning.node() {
            Node::Given(_) | Node::PullBack(..) => self.functional(&meaning),
            _ => self.poly(&self.algebra.lower(&meaning)),
        }
    }

    /// `det Q` of an element of GL(n), which each step multiplies by the determinant of the velocity.
    fn determinant(&mut self, l: Letter) -> Expr {
        let element = expr::letter(&self.symbols, l.symbol, l.shift);
        let velocity = self.configuration(l.symbol).map(|c| c.velocity);
        let factor = Factor::Letter {
            source: Source::Letter(l),
            transposed: false,
            inverted: false,
        };
        // The word of the element alone identifies its determinant, because no segment is a single element.
        let word = vec![factor];
        if let Some(c) = self.carried.iter().find(|c| c.word == word) {
            return expr::here(&self.symbols, c.quantity);
        }
        let name = format!("det_{}", self.symbols.get(l.symbol).name);
        let name = self.symbols.fresh_name(&name);
        let quantity = self
            .symbols
            .add(&name, Shape::SCALAR, Structure::General, Role::Advected);
        let own = expr::here(&self.symbols, quantity);
        let by = velocity.map_or_else(
            || expr::integer(1),
            |v| expr::det(expr::here(&self.symbols, v)),
        );
        self.carried.push(ReducedQuantity {
            quantity,
            word,
            definition: expr::det(element),
            update: expr::mul(own.clone(), by),
        });
        own
    }
}
