//! When a rule is worth applying. Rules hold in both directions; these conditions keep the search from writing the
//! same term in ever longer forms (`x = g g^T x = ...`). They use what is known so far and never decide what is true.

use super::conditions::View;
use super::language::{Facts, Term};
use clebsch_core::algebra::Rational;
use clebsch_core::expr::shape::Shape;
use egg::{EGraph, Id, Subst, Var};

/// A condition on the variables of a rule under which it is worth applying.
#[derive(Clone, Copy, Debug)]
pub enum Worth<V> {
    /// The left-hand side is known to equal this variable.
    Itself(V),
    /// Not known to be a number.
    Unknown(V),
    /// Not both known to be numbers.
    Symbolic(V, V),
    /// Not known to be zero.
    Nonzero(V),
    /// Not known to be multiples of each other.
    Independent(V, V),
    /// The left-hand side is not known to be a multiple of this variable.
    Apart(V),
    /// Not known to be a sum.
    Single(V),
    /// The left-hand side is not known to be a sum.
    Unsplit,
    /// The two joined in this way are not known to be a simple term, as `g g^T = 1` is.
    Composite(Join, V, V),
}

/// How two terms are joined.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Join {
    /// `a + b`.
    Sum,
    /// A scalar times a matrix or a scalar.
    Scale,
    /// A product of matrices.
    Product,
}

impl<V: Copy> Worth<V> {
    /// The condition with renamed variables, or the first error of `f`.
    pub fn renamed<W, E>(&self, f: impl Fn(V) -> Result<W, E>) -> Result<Worth<W>, E> {
        Ok(match *self {
            Worth::Itself(a) => Worth::Itself(f(a)?),
            Worth::Unknown(a) => Worth::Unknown(f(a)?),
            Worth::Symbolic(a, b) => Worth::Symbolic(f(a)?, f(b)?),
            Worth::Nonzero(a) => Worth::Nonzero(f(a)?),
            Worth::Independent(a, b) => Worth::Independent(f(a)?, f(b)?),
            Worth::Apart(a) => Worth::Apart(f(a)?),
            Worth::Single(a) => Worth::Single(f(a)?),
            Worth::Unsplit => Worth::Unsplit,
            Worth::Composite(join, a, b) => Worth::Composite(join, f(a)?, f(b)?),
        })
    }
}

/// A match, as conditions see it.
pub struct Matched<'a> {
    /// The graph of all terms.
    pub graph: &'a EGraph<Term, Facts>,
    /// The bindings of the variables.
    pub found: &'a Subst,
    /// The class of the left-hand side.
    pub root: Id,
}

impl View for Matched<'_> {
    fn shape(&self, v: Var) -> Option<Shape> {
        self.graph[*self.found.get(v)?].data.shape
    }

    fn number(&self, v: Var) -> Option<Rational> {
        self.graph[*self.found.get(v)?].data.number
    }

    fn whole(&self) -> Option<Shape> {
        self.graph[self.root].data.shape
    }
}

impl Matched<'_> {
    fn class(&self, v: Var) -> Option<Id> {
        Some(self.graph.find(*self.found.get(v)?))
    }

    /// Whether all conditions hold for this match.
    pub fn worth(&self, when: &[Worth<Var>]) -> bool {
        when.iter().all(|w| self.holds(*w).unwrap_or(true))
    }

    fn holds(&self, when: Worth<Var>) -> Option<bool> {
        let root = self.graph.find(self.root);
        let number = |v: Var| self.number(v).is_some();
        Some(match when {
            Worth::Itself(v) => self.class(v)? == root,
            Worth::Unknown(v) => !number(v),
            Worth::Symbolic(a, b) => !(number(a) && number(b)),
            Worth::Nonzero(v) => !self.is_zero(self.class(v)?),
            Worth::Independent(a, b) => !self.are_multiples(self.class(a)?, self.class(b)?),
            Worth::Apart(v) => !self.are_multiples(root, self.class(v)?),
            Worth::Single(v) => !self.is_sum(self.class(v)?),
            Worth::Unsplit => !self.is_sum(root),
            Worth::Composite(join, a, b) => {
                !self.is_simple(join, [self.class(a)?, self.class(b)?])?
            }
        })
    }

    fn any(&self, id: Id, test: &dyn Fn(&Term) -> bool) -> bool {
        self.graph[id].nodes.iter().any(test)
    }

    fn is_zero(&self, id: Id) -> bool {
        self.graph[id].data.number.is_some_and(Rational::is_zero)
            || self.any(id, &|node| matches!(node, Term::Zero(_)))
    }

    /// The class itself, and all classes that it is a known multiple of.
    fn lines(&self, id: Id) -> Vec<Id> {
        let scaled = self.graph[id].nodes.iter().filter_map(|node| match node {
            Term::Scale([s, a]) if self.graph[*s].data.number.is_some() => {
                Some(self.graph.find(*a))
            }
            _ => None,
        });
        core::iter::once(id).chain(scaled).collect()
    }

    fn are_multiples(&self, a: Id, b: Id) -> bool {
        let (a, b) = (self.lines(a), self.lines(b));
        a.iter().any(|id| b.contains(id))
    }

    /// Whether the class contains a proper sum; `a + 0` or `a/2 + a/2` does not make `a` a sum.
    fn is_sum(&self, id: Id) -> bool {
        let own = self.lines(id);
        let part = |id: &Id| own.contains(&self.graph.find(*id));
        self.any(id, &|node| match node {
            Term::Sum(parts) => !parts.iter().any(part),
            _ => false,
        })
    }

    /// Whether the two joined are a simple term such as a letter, or one of them contains the whole, as in
    /// `x + (-x + y)`.
    fn is_simple(&self, join: Join, pair: [Id; 2]) -> Option<bool> {
        let joined = self.graph.lookup(match join {
            Join::Sum => Term::Sum(pair),
            Join::Scale => Term::Scale(pair),
            Join::Product => Term::Product(pair),
        })?;
        let leaf = |id: Id| self.any(id, &|node| matches!(node, Term::Leaf(_)));
        let simple = self.any(joined, &|node| match node {
            Term::Leaf(_) | Term::Number(_) | Term::Identity(_) | Term::Zero(_) => true,
            Term::Power(_) => true,
            Term::Transpose(a) | Term::Inverse(a) => leaf(*a),
            _ => false,
        });
        let again = |node: &Term| match (join, node) {
            (Join::Sum, Term::Sum(parts))
            | (Join::Scale, Term::Scale(parts))
            | (Join::Product, Term::Product(parts)) => {
                parts.iter().any(|id| self.graph.find(*id) == joined)
            }
            _ => false,
        };
        Some(simple || pair.iter().any(|id| self.any(*id, &again)))
    }
}
