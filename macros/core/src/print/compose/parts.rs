//! Prints zero-padding inclusions by their blocks. A vector of the Lie algebra of rigid motions is printed as its
//! angular and linear part, `(a, b)`; `ang` and `lin` extract one of them. Entries of homogeneous coordinates and
//! matrices are `x[1:3]` and `A[1:3, 4]`, as subscripts in typeset formats; `[v; 0]` and `[A, 0; 0, 0]` are block
//! matrices.

use super::Composer;
use crate::expr::shape::{Dim, Shape};
use crate::expr::{self, Expr, Node};
use crate::print::formula::Formula;
use crate::print::layout::{Fence, Layout, Strength};
use crate::print::level::RankedLayout;
use crate::print::name;

/// The role of an inclusion in a product.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Inclusion {
    /// Dimension of the longer vectors.
    rows: u32,
    /// Dimension of the shorter vectors.
    cols: u32,
    /// The row at which the shorter vector begins.
    at: u8,
    /// Whether it extracts a part, that is, whether it is transposed.
    takes: bool,
}

impl Inclusion {
    /// Whether it maps into homogeneous coordinates.
    fn is_of_points(self) -> bool {
        self.at == 0 && self.rows == self.cols + 1
    }

    /// Whether the part is the linear part of a Lie algebra vector.
    fn is_linear(self) -> bool {
        self.at > 0
    }
}

/// Reads a factor as an inclusion.
fn inclusion(factor: &Expr) -> Option<Inclusion> {
    let (node, takes) = match factor.node() {
        Node::Transpose(inner) => (inner.node(), true),
        node => (node, false),
    };
    match node {
        Node::Inclusion(
            Shape {
                rows: Dim::Fixed(rows),
                cols: Dim::Fixed(cols),
            },
            at,
        ) => Some(Inclusion {
            rows: *rows,
            cols: *cols,
            at: *at,
            takes,
        }),
        _ => None,
    }
}

/// Whether a factor is the last unit vector of homogeneous coordinates, or its transpose.
fn is_last(factor: &Expr, transposed: bool) -> bool {
    let node = match (factor.node(), transposed) {
        (Node::Transpose(inner), true) => inner.node(),
        (node, false) => node,
        _ => return false,
    };
    matches!(node, Node::Unit(n, axis) if *axis == expr::last_axis(*n))
}

/// The angular and the linear part of a vector, if inclusions build every term of it.
pub(in crate::print) fn in_parts(e: &Expr) -> Option<[Expr; 2]> {
    let [(_, angles), (_, lengths)] = expr::rows_in_parts(e)?;
    let terms = match e.node() {
        Node::Sum(terms) => terms.as_slice(),
        _ => std::slice::from_ref(e),
    };
    let (mut angular, mut linear) = (Vec::new(), Vec::new());
    for term in terms {
        match put(term)? {
            (true, part) => linear.push(part),
            (false, part) => angular.push(part),
        }
    }
    let sum = |terms, count| expr::sum(terms, Shape::vector(count));
    Some([sum(angular, angles), sum(linear, lengths)])
}

/// Whether a term belongs to the linear part, and the term without its inclusion.
fn put(term: &Expr) -> Option<(bool, Expr)> {
    match term.node() {
        Node::Neg(inner) => put(inner).map(|(linear, part)| (linear, expr::neg(part))),
        Node::Quotient(top, bottom) => {
            put(top).map(|(linear, part)| (linear, expr::quotient(part, bottom.clone())))
        }
        Node::Product(factors) => {
            let first = factors.iter().position(|f| !f.shape().is_scalar())?;
            let (before, after) = factors.split_at_checked(first)?;
            let (head, rest) = after.split_first()?;
            // The angle of a planar motion is a scalar, so that it is included by a unit vector.
            if let (Node::Unit(_, 0), []) = (head.node(), rest) {
                return Some((false, expr::product(before.iter().cloned())));
            }
            let found = inclusion(head).filter(|i| !i.is_of_points() && !i.takes)?;
            if rest.is_empty() {
                return None;
            }
            let factors = before.iter().chain(rest).cloned();
            Some((found.is_linear(), expr::product(factors)))
        }
        _ => None,
    }
}

impl Composer<'_> {
    /// A vector of the Lie algebra by its parts, `(a, b)`.
    pub(super) fn parts(&self, e: &Expr) -> Option<RankedLayout> {
        let parts = in_parts(e)?;
        Some(self.list(parts.iter().map(|p| self.expression(p).layout).collect()))
    }

    fn list(&self, parts: Vec<Layout>) -> RankedLayout {
        RankedLayout::atom(Layout::fenced(Fence::Round, self.commas(parts)))
    }

    /// A matrix or a column by its blocks, `[A, v; 0, 0]`.
    fn blocks(&self, [top, bottom]: [Vec<Layout>; 2]) -> RankedLayout {
        if self.stacked {
            return RankedLayout::atom(Layout::Grid(vec![top, bottom]));
        }
        let rows = vec![
            self.commas(top),
            Layout::Word("; ".to_owned()),
            Layout::Break(Strength::Term),
            self.commas(bottom),
        ];
        RankedLayout::atom(Layout::fenced(Fence::Square, Layout::Row(rows)))
    }

    /// Applies the inclusion at the front of these factors to the factors behind it; returns the layout and the
    /// number of factors it covers. `None` if the inclusion is printed as it is.
    pub(super) fn included(&self, factors: &[Expr]) -> Option<(RankedLayout, usize)> {
        let (head, rest) = factors.split_first()?;
        let Some(found) = inclusion(head) else {
            return self.row_included(factors);
        };
        let zero = || Layout::Number("0".to_owned());
        let is = |wanted: Inclusion| move |f: &Expr| inclusion(f) == Some(wanted);
        let identity = if found.takes { found.rows } else { found.cols };
        let inner = |count: usize| -> Option<Expr> {
            let inner = rest.get(..count)?;
            Some(match inner.is_empty() {
                true => expr::identity(Dim::Fixed(identity)),
                false => expr::product(inner.iter().cloned()),
            })
        };
        let whole = || inner(rest.len()).filter(|e| !rest.is_empty() && e.shape().is_vector());
        match (found.is_of_points(), found.takes) {
            (false, true) => {
                let of = whole()?;
                let part = usize::from(found.is_linear());
                let laid = match in_parts(&of) {
                    Some(parts) => self.expression(parts.get(part)?),
                    None => self.call(["ang", "lin"].get(part)?, self.expression(&of)),
                };
                Some((laid, factors.len()))
            }
            (false, false) => {
                let part = self.expression(&whole()?).layout;
                let parts = match found.is_linear() {
                    true => vec![zero(), part],
                    false => vec![part, zero()],
                };
                Some((self.list(parts), factors.len()))
            }
            (true, true) => {
                let closes = is(Inclusion {
                    takes: false,
                    ..found
                });
                let end = rest.iter().position(|f| closes(f) || is_last(f, false));
                let (space, last) = (found.cols, found.rows);
                let (of, entries, used) = match end {
                    Some(end) if is_last(rest.get(end)?, false) => {
                        (inner(end)?, format!("1:{space}, {last}"), end + 2)
                    }
                    Some(end) => (inner(end)?, format!("1:{space}, 1:{space}"), end + 2),
                    None => (whole()?, format!("1:{space}"), factors.len()),
                };
                Some((self.entries(&of, &entries), used))
            }
            (true, false) => {
                let closes = is(Inclusion {
                    takes: true,
                    ..found
                });
                let end = rest.iter().position(|f| closes(f) || is_last(f, true));
                let Some(end) = end else {
                    let part = self.expression(&whole()?).layout;
                    return Some((self.blocks([vec![part], vec![zero()]]), factors.len()));
                };
                let block = self.expression(&inner(end)?).layout;
                let top = match is_last(rest.get(end)?, true) {
                    true => vec![zero(), block],
                    false => vec![block, zero()],
                };
                Some((self.blocks([top, vec![zero(), zero()]]), end + 2))
            }
        }
    }

    /// `A[1:3, 4]`; the entries are a subscript in typeset formats.
    fn entries(&self, of: &Expr, entries: &str) -> RankedLayout {
        let base = self.expression(of).base();
        if self.stacked {
            let base = match base {
                scripted @ Layout::Script { .. } => Layout::fenced(Fence::Round, scripted),
                plain => plain,
            };
            return RankedLayout::atom(base.subscript(name::script(entries)));
        }
        let entries = Layout::fenced(Fence::Square, Layout::Word(entries.to_owned()));
        RankedLayout::atom(Layout::Row(vec![base, entries]))
    }
}

impl Composer<'_> {
    /// The same for a row at the front: `lin(x)ᵀ` for a part of a six-component row, `[vᵀ, 0]` for a lengthened
    /// three-component row.
    fn row_included(&self, factors: &[Expr]) -> Option<(RankedLayout, usize)> {
        let head = factors.first()?;
        let Node::Transpose(column) = head.node() else {
            return None;
        };
        let next = |at: usize| factors.get(at).and_then(inclusion);
        let (row, used) = match next(1) {
            Some(i) if !i.is_of_points() && !i.takes && head.shape().rows == Dim::Fixed(1) => {
                let word = if i.is_linear() { "lin" } else { "ang" };
                let part = self.call(word, self.expression(column));
                (part.raised(super::transposition(false)), 2)
            }
            _ => (self.expression(head), 1),
        };
        let longer = next(used).is_some_and(|i| i.is_of_points() && i.takes);
        if longer && head.shape().rows == Dim::Fixed(1) {
            let zero = Layout::Number("0".to_owned());
            let row = self.commas(vec![row.layout, zero]);
            return Some((
                RankedLayout::atom(Layout::fenced(Fence::Square, row)),
                used + 1,
            ));
        }
        (used > 1).then_some((row, used))
    }
}

/// Splits a displayed equation between vectors of the Lie algebra, for plain text, into the equations of the angular
/// and of the linear parts.
pub(in crate::print) fn equations(f: &Formula) -> Option<[Formula; 2]> {
    match f {
        Formula::Continuous(inner) => {
            Some(equations(inner)?.map(|f| Formula::Continuous(Box::new(f))))
        }
        Formula::Relation(members, relation) => {
            let parts: Vec<Option<[Expr; 2]>> = members
                .iter()
                .map(|member| match member {
                    Formula::Expr(e) => in_parts(e),
                    _ => None,
                })
                .collect();
            if parts.iter().all(Option::is_none) {
                return None;
            }
            let of = |part: usize, word: &str| {
                let member = |(member, parts): (&Formula, &Option<[Expr; 2]>)| match parts
                    .as_ref()
                    .and_then(|parts| parts.get(part))
                {
                    Some(e) => Formula::Expr(e.clone()),
                    None => Formula::apply(Formula::name(word), vec![member.clone()]),
                };
                let members = members.iter().zip(&parts).map(member).collect();
                Formula::Relation(members, *relation)
            };
            Some([of(0, "ang"), of(1, "lin")])
        }
        _ => None,
    }
}
