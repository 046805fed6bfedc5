//! Splits homogeneous coordinates and matrices into blocks by the rules of block matrices: the last entry and the
//! others, the upper left block and the column to its right.

use super::names::{Kind, Names};
use super::rigid_motion_patterns::{Inclusion, factors, inclusion, is_last};
use crate::expr::shape::{Dim, Shape};
use crate::expr::symbol::Role;
use crate::expr::{self, Expr, Letter, Node};

const TWO: Dim = Dim::Fixed(2);

impl Names {
    /// The upper entries of the factors after an `ι^T`, and the number of factors used.
    pub(super) fn of_points(&mut self, rest: &[Expr]) -> Option<(Expr, usize)> {
        let whole = |list: &[Expr]| expr::product(list.iter().cloned());
        let end = rest
            .iter()
            .position(|f| inclusion(f) == Some(Inclusion::Point) || is_last(f));
        if let Some(end) = end {
            let inner = whole(rest.get(..end)?);
            if end == 0 {
                return None;
            }
            let part = match is_last(rest.get(end)?) {
                true => self.column(&inner)?,
                false => self.block(&inner)?,
            };
            return Some((part, end + 1));
        }
        let inner = whole(rest);
        match inner.shape().is_vector() {
            true => Some((self.top(&inner)?, rest.len())),
            false => None,
        }
    }

    /// The entries of homogeneous coordinates except the last.
    pub fn top(&mut self, e: &Expr) -> Option<Expr> {
        let rows = e.shape().rows;
        let space = expr::within(rows);
        let zero = || expr::zero(Shape::vector(space));
        Some(match e.node() {
            Node::Letter(at) => self.parts(Kind::Point, *at)[0].clone(),
            Node::Zero(_) => zero(),
            Node::Unit(..) if is_last(e) => zero(),
            Node::Unit(_, axis) => expr::unit(space, *axis),
            Node::Neg(a) => expr::neg(self.top(a)?),
            Node::Quotient(a, b) => expr::quotient(self.top(a)?, self.rewritten(b)),
            Node::Sum(terms) => {
                let terms: Vec<Expr> = terms.iter().map(|t| self.top(t)).collect::<Option<_>>()?;
                expr::sum(terms, Shape::vector(space))
            }
            Node::Product(list) => {
                let (scalars, others) = factors(list);
                let (head, rest) = others.split_first()?;
                let behind = expr::product(rest.iter().cloned());
                let inner = if rest.is_empty() {
                    self.top(head)?
                } else if inclusion(head) == Some(Inclusion::Point) {
                    self.rewritten(&behind)
                } else if head.shape().is_vector() {
                    expr::product([self.top(head)?, self.rewritten(&behind)])
                } else {
                    self.top_of(head, &behind)?
                };
                self.times(&scalars, inner)
            }
            _ => return None,
        })
    }

    /// The upper entries of a matrix times a vector.
    fn top_of(&mut self, head: &Expr, behind: &Expr) -> Option<Expr> {
        if let Some([turn, shift]) = self.motion(head) {
            let moved = expr::product([self.last(behind)?, shift]);
            return Some(expr::add(expr::mul(turn, self.top(behind)?), moved));
        }
        match head.node() {
            Node::Transpose(inner) => {
                if let Some([turn, _]) = self.motion(inner) {
                    let back = self.turned(turn);
                    let list = std::slice::from_ref(behind);
                    let top = self
                        .top(behind)
                        .unwrap_or_else(|| self.unnamed(list, false));
                    return Some(expr::mul(back, top));
                }
                let Node::Inverse(inner) = inner.node() else {
                    return None;
                };
                let [turn, _] = self.motion(inner)?;
                Some(expr::mul(turn, self.top(behind)?))
            }
            Node::Inverse(inner) => {
                let [turn, shift] = self.motion(inner)?;
                let moved = expr::product([self.last(behind)?, shift]);
                let from = expr::sub(self.top(behind)?, moved);
                Some(expr::mul(self.turned(turn), from))
            }
            Node::Letter(at) if self.has_blocks(*at) => {
                let last = self.last(behind)?;
                let top = self.top(behind)?;
                let [block, column] = self.parts(Kind::Matrix, *at);
                Some(expr::add(
                    expr::mul(block, top),
                    expr::product([last, column]),
                ))
            }
            _ => None,
        }
    }

    /// Multipliers have letters for their blocks; matrices of the model keep their own letters.
    fn has_blocks(&self, at: Letter) -> bool {
        self.symbols.get(at.symbol).role == Role::Multiplier
    }

    /// The last entry of homogeneous coordinates.
    pub fn last(&mut self, e: &Expr) -> Option<Expr> {
        Some(match e.node() {
            Node::Letter(at) => self.parts(Kind::Point, *at)[1].clone(),
            Node::Zero(_) => expr::integer(0),
            Node::Unit(..) => expr::integer(i64::from(is_last(e))),
            Node::Neg(a) => expr::neg(self.last(a)?),
            Node::Quotient(a, b) => expr::quotient(self.last(a)?, self.rewritten(b)),
            Node::Sum(terms) => {
                let terms: Vec<Expr> = terms.iter().map(|t| self.last(t)).collect::<Option<_>>()?;
                expr::sum(terms, Shape::SCALAR)
            }
            Node::Product(list) => {
                let (scalars, others) = factors(list);
                let (head, rest) = others.split_first()?;
                let behind = expr::product(rest.iter().cloned());
                let inner = if rest.is_empty() {
                    self.last(head)?
                } else if inclusion(head) == Some(Inclusion::Point) {
                    expr::integer(0)
                } else if head.shape().is_vector() {
                    expr::product([self.last(head)?, self.rewritten(&behind)])
                } else {
                    self.last_of(head, &behind)?
                };
                self.times(&scalars, inner)
            }
            _ => return None,
        })
    }

    fn last_of(&mut self, head: &Expr, behind: &Expr) -> Option<Expr> {
        if self.motion(head).is_some() {
            return self.last(behind);
        }
        match head.node() {
            Node::Inverse(inner) => {
                self.motion(inner)?;
                self.last(behind)
            }
            Node::Transpose(inner) => {
                let [_, shift] = self.motion(inner)?;
                let along = expr::dot(shift, self.top(behind)?);
                Some(expr::add(along, self.last(behind)?))
            }
            _ => None,
        }
    }

    /// The last column of a matrix without its last entry.
    fn column(&mut self, e: &Expr) -> Option<Expr> {
        let last = expr::unit(e.shape().cols, expr::last_axis(e.shape().cols));
        match e.node() {
            Node::Letter(_) => self.top_of(e, &last),
            Node::Sum(terms) => {
                let terms: Vec<Expr> = terms
                    .iter()
                    .map(|t| self.column(t))
                    .collect::<Option<_>>()?;
                Some(expr::sum(
                    terms,
                    Shape::vector(expr::within(e.shape().rows)),
                ))
            }
            _ => self.top(&expr::product([e.clone(), last])),
        }
    }

    /// A matrix without its last row and column.
    fn block(&mut self, e: &Expr) -> Option<Expr> {
        let space = expr::within(e.shape().rows);
        if let Some([turn, _]) = self.motion(e) {
            return Some(turn);
        }
        Some(match e.node() {
            Node::Letter(at) if self.has_blocks(*at) => self.parts(Kind::Matrix, *at)[0].clone(),
            Node::Identity(_) => expr::identity(space),
            Node::Zero(_) => expr::zero(Shape::square(space)),
            Node::Transpose(inner) => {
                let block = self.block(inner)?;
                self.turned(block)
            }
            Node::Inverse(inner) => {
                let [turn, _] = self.motion(inner)?;
                self.turned(turn)
            }
            Node::Neg(a) => expr::neg(self.block(a)?),
            Node::Quotient(a, b) => expr::quotient(self.block(a)?, self.rewritten(b)),
            Node::Sum(terms) => {
                let terms: Vec<Expr> =
                    terms.iter().map(|t| self.block(t)).collect::<Option<_>>()?;
                expr::sum(terms, Shape::square(space))
            }
            Node::Product(list) => {
                let (scalars, others) = factors(list);
                let inner = self.block_of(&others)?;
                self.times(&scalars, inner)
            }
            _ => return None,
        })
    }

    /// The block, or the upper entries, of a product that does not have letters for them, written by inclusions.
    fn unnamed(&self, list: &[Expr], block: bool) -> Expr {
        let rows = list.first().map_or(TWO, |f| f.shape().rows);
        let first = expr::inclusion(rows, expr::within(rows), 0);
        let taken = expr::transposed(first.clone());
        let end = block.then_some(first);
        let whole = [taken].into_iter().chain(list.iter().cloned()).chain(end);
        expr::product(whole)
    }

    /// The block of a product of matrices.
    fn block_of(&mut self, list: &[Expr]) -> Option<Expr> {
        let (head, rest) = list.split_first()?;
        if rest.is_empty() {
            return self.block(head);
        }
        let whole = |list: &[Expr]| expr::product(list.iter().cloned());
        // A column times a row.
        if head.shape().is_vector() {
            let row = self.turned(whole(rest));
            let top = self.top(&row)?;
            return Some(expr::mul(self.top(head)?, self.turned(top)));
        }
        // The upper right block of these factors vanishes.
        let upper = match head.node() {
            Node::Transpose(inner) => match inner.node() {
                Node::Inverse(inner) => self.motion(inner).map(|[turn, _]| turn),
                _ => self.motion(inner).map(|[turn, _]| self.turned(turn)),
            },
            _ => None,
        };
        if let Some(upper) = upper {
            let inner = self
                .block_of(rest)
                .unwrap_or_else(|| self.unnamed(rest, true));
            return Some(expr::mul(upper, inner));
        }
        let (end, front) = list.split_last()?;
        if let Some([turn, _]) = self.motion(end) {
            let inner = self
                .block_of(front)
                .unwrap_or_else(|| self.unnamed(front, true));
            return Some(expr::mul(inner, turn));
        }
        match end.node() {
            Node::Inverse(inner) => {
                let [turn, _] = self.motion(inner)?;
                let back = self.turned(turn);
                Some(expr::mul(self.block_of(front)?, back))
            }
            Node::Transpose(inner) => {
                let [turn, shift] = self.motion(inner)?;
                let back = self.turned(turn);
                let moved = expr::mul(self.column(&whole(front))?, self.turned(shift));
                Some(expr::add(expr::mul(self.block_of(front)?, back), moved))
            }
            _ => None,
        }
    }
}
