//! Rewrites expressions in the letters of parts: a factor that takes a part of a Lie algebra vector becomes the
//! letter of that part, and dot products become sums over the parts. Every function returns an expression equal to
//! its argument.

use super::names::{Kind, Names};
use super::rigid_motion_patterns::{
    Inclusion, factors, inclusion, is_last, is_unit, letter, taken, twist_rows, written_in_points,
    written_in_twists,
};
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::{self, Expr, Map, Node};

const ONE: Dim = Dim::Fixed(1);

impl Names {
    /// An expression in the letters of parts.
    pub fn rewritten(&mut self, e: &Expr) -> Expr {
        let found = match e.node() {
            Node::Map(Map::Rotation | Map::Translation, inner) => self.of_motion(e, inner),
            Node::Product(list) => self.product(list),
            Node::Dot(a, b) => self.dot(a, b),
            _ => None,
        };
        match found {
            Some(e) => e,
            None => {
                let children = e
                    .children()
                    .into_iter()
                    .map(|x| self.rewritten(x))
                    .collect();
                expr::with_children(&self.symbols, e, children)
            }
        }
    }

    pub(super) fn turned(&self, e: Expr) -> Expr {
        expr::transpose(&self.symbols, e)
    }

    pub(super) fn motion(&mut self, e: &Expr) -> Option<[Expr; 2]> {
        let at = letter(e)?;
        let rigid = self.symbols.get(at.symbol).structure == Structure::RigidMotion;
        rigid.then(|| self.parts(Kind::Motion, at))
    }

    fn of_motion(&mut self, e: &Expr, inner: &Expr) -> Option<Expr> {
        let [turn, shift] = self.motion(inner)?;
        Some(match e.node() {
            Node::Map(Map::Rotation, _) => turn,
            _ => shift,
        })
    }

    /// A product that takes parts of its factors.
    fn product(&mut self, list: &[Expr]) -> Option<Expr> {
        if let Some(e) = self.row(list) {
            return Some(e);
        }
        let at = list.iter().position(|f| taken(f).is_some())?;
        let (before, rest) = list.split_at_checked(at)?;
        let (head, rest) = rest.split_first()?;
        if rest.is_empty() {
            return None;
        }
        let (part, used) = match taken(head)? {
            Inclusion::Twist(which) => {
                // If a column is included into a matrix, split only the factors of the column.
                let (parts, used) = (1..=rest.len()).rev().find_map(|n| {
                    let column = expr::product(rest.get(..n)?.iter().cloned());
                    Some((self.twist(&column)?, n))
                })?;
                (parts.get(which)?.clone(), used)
            }
            Inclusion::Point => self.of_points(rest)?,
        };
        let before = self.each(before);
        // The remaining factors may take parts too.
        let behind = match rest.get(used..)? {
            [] => None,
            list => Some(self.rewritten(&expr::product(list.iter().cloned()))),
        };
        Some(expr::product(
            before.into_iter().chain([part]).chain(behind),
        ))
    }

    /// A product that takes a part of a row, `ξᵀ ι`.
    fn row(&mut self, list: &[Expr]) -> Option<Expr> {
        let (at, which, whole) = list.windows(2).enumerate().find_map(|(at, pair)| {
            let [row, puts] = pair else { return None };
            match (row.node(), inclusion(puts)) {
                (Node::Transpose(whole), Some(Inclusion::Twist(which))) => {
                    Some((at, which, whole.clone()))
                }
                _ => None,
            }
        })?;
        let part = self.twist(&whole)?.get(which)?.clone();
        let part = self.turned(part);
        let before = list.get(..at)?.iter().cloned();
        let behind = list.get(at + 2..)?.iter().cloned();
        let all: Vec<Expr> = before.chain([part]).chain(behind).collect();
        Some(self.rewritten(&expr::product(all)))
    }

    pub(super) fn each(&mut self, list: &[Expr]) -> Vec<Expr> {
        list.iter().map(|e| self.rewritten(e)).collect()
    }

    /// A part times scalar factors.
    pub(super) fn times(&mut self, scalars: &[Expr], part: Expr) -> Expr {
        let scalars = self.each(scalars);
        expr::product(scalars.into_iter().chain([part]))
    }

    /// A dot product by parts.
    fn dot(&mut self, a: &Expr, b: &Expr) -> Option<Expr> {
        if is_unit(a) || is_unit(b) {
            let (unit, other) = if is_unit(a) { (a, b) } else { (b, a) };
            return self.entry(unit, other);
        }
        // A dot product of two letters stays as it is.
        if letter(a).is_some() && letter(b).is_some() {
            return None;
        }
        let parts = match (self.twist_if_written(a), self.twist_if_written(b)) {
            (None, None) => {
                if !(written_in_points(a) || written_in_points(b)) {
                    return None;
                }
                let (x, y) = (self.top(a)?, self.top(b)?);
                let (s, t) = (self.last(a)?, self.last(b)?);
                [[x, y], [s, t]]
            }
            _ => {
                let ([x, y], [s, t]) = (self.twist(a)?, self.twist(b)?);
                [[x, s], [y, t]]
            }
        };
        let terms = parts.map(|[x, y]| expr::dot(x, y));
        Some(expr::sum(terms, Shape::SCALAR))
    }

    /// One entry of a vector that has letters for its parts.
    fn entry(&mut self, unit: &Expr, other: &Expr) -> Option<Expr> {
        let Node::Unit(rows, axis) = unit.node() else {
            return None;
        };
        if let Some(at) = letter(other)
            && self.knows(Kind::Twist, at.symbol)
        {
            let parts = self.parts(Kind::Twist, at);
            let (which, (from, count)) = (twist_rows(*rows)?.into_iter().enumerate())
                .rfind(|(_, (from, _))| from <= axis)?;
            let part = parts.get(which)?.clone();
            return Some(match count {
                ONE => part,
                _ => expr::dot(expr::unit(count, axis - from), part),
            });
        }
        let at = letter(other)?;
        if !self.knows(Kind::Point, at.symbol) {
            return None;
        }
        let [top, last] = self.parts(Kind::Point, at);
        Some(match is_last(unit) {
            true => last,
            false => expr::dot(expr::unit(expr::within(*rows), *axis), top),
        })
    }

    fn twist_if_written(&mut self, e: &Expr) -> Option<[Expr; 2]> {
        let known = letter(e).is_some_and(|at| self.knows(Kind::Twist, at.symbol));
        match known || written_in_twists(e) {
            true => self.twist(e),
            false => None,
        }
    }

    /// The angular and the linear part of a vector of the Lie algebra or its dual.
    pub fn twist(&mut self, e: &Expr) -> Option<[Expr; 2]> {
        let rows = twist_rows(e.shape().rows).filter(|_| e.shape().cols == ONE)?;
        let shapes = rows.map(|(_, count)| Shape::vector(count));
        let zeros = || shapes.map(expr::zero);
        let at = |which: usize, part: Expr| {
            let mut parts = zeros();
            if let Some(place) = parts.get_mut(which) {
                *place = part;
            }
            parts
        };
        Some(match e.node() {
            Node::Letter(letter) => self.parts(Kind::Twist, *letter),
            Node::Zero(_) => zeros(),
            Node::Unit(_, axis) => {
                let which = usize::from(*axis >= rows[1].0);
                let (from, count) = *rows.get(which)?;
                let one = match count {
                    ONE => expr::integer(1),
                    _ => expr::unit(count, axis - from),
                };
                at(which, one)
            }
            Node::Neg(a) => self.twist(a)?.map(expr::neg),
            Node::Quotient(a, b) => {
                let b = self.rewritten(b);
                self.twist(a)?.map(|part| expr::quotient(part, b.clone()))
            }
            Node::Sum(terms) => {
                let terms: Vec<[Expr; 2]> =
                    terms.iter().map(|t| self.twist(t)).collect::<Option<_>>()?;
                let all = |which: usize| {
                    let each = terms.iter().filter_map(|t| t.get(which).cloned());
                    expr::sum(each.collect::<Vec<_>>(), shapes[which])
                };
                [all(0), all(1)]
            }
            Node::Product(list) => {
                let (scalars, others) = factors(list);
                let (head, rest) = others.split_first()?;
                let inner = match (inclusion(head), rest.is_empty()) {
                    (Some(Inclusion::Twist(which)), false) => {
                        let part = self.rewritten(&expr::product(rest.iter().cloned()));
                        at(which, part)
                    }
                    (_, true) => self.twist(head)?,
                    _ => return None,
                };
                inner.map(|part| self.times(&scalars, part))
            }
            _ => return None,
        })
    }
}
