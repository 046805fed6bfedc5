//! Fields whose discrete Lagrangian is convex in their velocities. The velocity of a step then minimises a strictly
//! convex function, so the root of its balance is unique. Takes the terms of the edge and the fields that are solved
//! together; gives the coefficients whose signs decide, or None if the terms are not of this kind.

use super::action::{Action, summands};
use super::variation::at;
use crate::algebra::{Algebra, Atom, Poly, Rational};
use crate::check::spec::Spec;
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Function, Letter, Node, Shift};

/// The conditions that make the terms strictly convex, each multiplied by the step size. If the Lagrangian is
/// convex for `h`, it is concave for `-h`, and its root is unique in both cases.
#[derive(Clone, Debug)]
pub struct Convexity {
    /// Coefficients that must be positive: one per field, of the square of its velocity.
    pub positive: Vec<Expr>,
    /// Coefficients that must not be negative: coefficients of other convex functions.
    pub not_negative: Vec<Expr>,
}

impl Convexity {
    /// All coefficients, first the coefficients that must be positive.
    pub fn all(&self) -> impl Iterator<Item = &Expr> {
        self.positive.iter().chain(&self.not_negative)
    }
}

/// The conditions under which the fields have a unique root, if there are such conditions. All configurations of the
/// model are solved together; a block is passed as a model of its own.
pub fn convexity(spec: &Spec, s: &Symbols, action: &Action) -> Option<Convexity> {
    // With multipliers among the unknowns, the solution is a stationary point and not a minimum.
    if !spec.has_only_fields() || !spec.holds.is_empty() {
        return None;
    }
    let configurations = spec.configurations.iter();
    let here = |symbol| at(symbol, Shift::HERE);
    let velocities: Vec<Letter> = configurations.clone().map(|c| here(c.velocity)).collect();
    let places: Vec<Letter> = configurations.map(|c| here(c.element)).collect();
    let algebra = Algebra::new(s);
    let edge = expr::substitute(s, &action.edge, &spec.end_of_edge());
    let (algebra, step) = (&algebra, here(spec.step));
    let terms = Terms {
        s,
        algebra,
        step,
        velocities,
    };
    let mut squares: Vec<Option<Expr>> = vec![None; places.len()];
    let mut not_negative = Vec::new();
    for term in summands(s, &edge).iter().filter(|t| terms.moves(t)) {
        // A term that contains both fields and velocities affects both, so no convexity is reported.
        if places.iter().any(|x| expr::contains(term, *x)) {
            return None;
        }
        if terms.is_affine(term) {
            continue;
        }
        let (weight, core) = terms.weighted(term)?;
        let weight = expr::mul(expr::here(s, spec.step), weight);
        let weight = of_its_sign(algebra, weight, step);
        match terms.square_of(&core) {
            Some(i) if squares[i].is_none() => squares[i] = Some(weight),
            _ => {
                terms.is_convex(&core).then_some(())?;
                not_negative.push(weight);
            }
        }
    }
    let positive: Option<Vec<Expr>> = squares.into_iter().collect();
    let positive = positive?;
    let constant = |l: &Letter| s.get(l.symbol).role == Role::Parameter || l.symbol == spec.step;
    let found = Convexity {
        positive,
        not_negative,
    };
    let known = found.all().flat_map(expr::letters).all(|l| constant(&l));
    known.then_some(found)
}

/// A scalar of the same sign, without positive factors and even powers of the step size.
fn of_its_sign(algebra: &Algebra, weight: Expr, step: Letter) -> Expr {
    let mut lowered = algebra.lower(&weight);
    if let [(term, coefficient)] = lowered.terms.iter().collect::<Vec<_>>().as_slice() {
        let mut bare = (*term).clone();
        let even = |e: &Rational| e.as_integer().is_some_and(|n| n % 2 == 0);
        bare.monomial
            .retain(|(atom, e)| *atom != Atom::Letter(step) || !even(e));
        let sign = match coefficient.is_negative() {
            true => Rational::MINUS_ONE,
            false => Rational::ONE,
        };
        lowered = Poly::term(Shape::SCALAR, sign, bare);
    }
    algebra.raise(&lowered)
}

/// The velocities as variables of the terms.
struct Terms<'a> {
    s: &'a Symbols,
    algebra: &'a Algebra<'a>,
    step: Letter,
    velocities: Vec<Letter>,
}

impl Terms<'_> {
    fn moves(&self, e: &Expr) -> bool {
        self.velocities.iter().any(|w| expr::contains(e, *w))
    }

    /// Whether the form of the expression shows that it is affine in the velocities.
    fn is_affine(&self, e: &Expr) -> bool {
        if !self.moves(e) {
            return true;
        }
        let one_moves = |factors: &[Expr]| factors.iter().filter(|f| self.moves(f)).count() == 1;
        match e.node() {
            Node::Letter(_) => true,
            Node::Neg(a) | Node::Transpose(a) | Node::Trace(a) | Node::Vee(a) | Node::Hat(a) => {
                self.is_affine(a)
            }
            Node::Part(_, a) => self.is_affine(a),
            Node::Sum(terms) => terms.iter().all(|t| self.is_affine(t)),
            Node::Product(factors) => {
                one_moves(factors) && factors.iter().all(|f| self.is_affine(f))
            }
            Node::Quotient(a, b) => self.is_affine(a) && !self.moves(b),
            Node::Dot(a, b) | Node::Cross(a, b) => {
                self.moves(a) != self.moves(b) && self.is_affine(a) && self.is_affine(b)
            }
            _ => false,
        }
    }

    /// Factors a scalar into a weight free of the velocities and a part that contains them.
    fn weighted(&self, e: &Expr) -> Option<(Expr, Expr)> {
        Some(match e.node() {
            Node::Neg(a) => {
                let (weight, core) = self.weighted(a)?;
                (expr::neg(weight), core)
            }
            Node::Quotient(a, b) if !self.moves(b) => {
                let (weight, core) = self.weighted(a)?;
                (expr::quotient(weight, b.clone()), core)
            }
            Node::Product(factors) if e.shape().is_scalar() => {
                let (moving, still): (Vec<Expr>, Vec<Expr>) =
                    factors.iter().cloned().partition(|f| self.moves(f));
                let [only] = moving.as_slice() else {
                    let first = moving.first()?;
                    let count = i64::try_from(moving.len()).ok()?;
                    let power = expr::power(first.clone(), Rational::integer(count));
                    let equal = moving.iter().all(|f| f == first);
                    return equal.then(|| (expr::product(still), power));
                };
                let (weight, core) = self.weighted(only)?;
                (expr::mul(expr::product(still), weight), core)
            }
            _ => (expr::integer(1), e.clone()),
        })
    }

    /// The vector whose squared length is a scalar, as the sum of the squares of its entries.
    fn root(&self, e: &Expr) -> Option<Expr> {
        match e.node() {
            Node::Dot(a, b) if a == b => Some(a.clone()),
            Node::Power(a, q) if *q == Rational::integer(2) => Some(a.clone()),
            Node::Trace(a) => match a.node() {
                Node::Product(factors) => match factors.as_slice() {
                    [a, b] if expr::transpose(self.s, a.clone()) == *b => Some(a.clone()),
                    _ => None,
                },
                _ => None,
            },
            _ => None,
        }
    }

    /// The velocity whose squared length is this scalar.
    fn square_of(&self, e: &Expr) -> Option<usize> {
        let root = self.root(e)?;
        let letter = match root.node() {
            Node::Letter(l) => *l,
            Node::Neg(a) | Node::Transpose(a) => match a.node() {
                Node::Letter(l) => *l,
                _ => return None,
            },
            _ => return None,
        };
        self.velocities.iter().position(|w| *w == letter)
    }

    /// Whether a scalar is convex in the velocities and nowhere negative.
    fn is_convex(&self, e: &Expr) -> bool {
        if self.root(e).is_some_and(|a| self.is_affine(&a)) {
            return true;
        }
        if let Some((weight, core)) = self.weighted(e).filter(|(_, core)| core != e) {
            let positive = of_its_sign(self.algebra, weight, self.step);
            return positive == expr::integer(1) && self.is_convex(&core);
        }
        match e.node() {
            // Increasing and convex if the base is not negative.
            Node::Power(a, q) if *q >= Rational::ONE => {
                self.is_convex(a)
                    || (q.as_integer().is_some_and(|n| n % 2 == 0) && self.is_affine(a))
            }
            Node::Call(Function::Exp, a) => self.is_affine(a) || self.is_convex(a),
            Node::Call(Function::Cosh, a) => self.is_affine(a),
            _ => false,
        }
    }
}

#[cfg(test)]
mod tests;
