//! Splits displayed equations into parts under one number: equations between vectors of the Lie algebra into the
//! angular and the linear part, equations between homogeneous coordinates into the last entry and the others.
//! Matrices are printed by blocks.

use super::Motions;
use super::names::{Kind, Names};
use super::rigid_motion_patterns::{Blocks, written_in_points, written_in_twists};
use crate::expr::shape::Shape;
use crate::expr::{self, Expr};
use crate::print::formula::{Formula, Relation};

/// If the two blocks of a matrix have at least this many expression nodes, they are defined in separate equations.
const WIDE: u32 = 14;

/// A page during printing.
pub struct Display {
    /// Its letters.
    pub names: Names,
    /// Matrix blocks that have letters, and these letters.
    blocks: Vec<([Expr; 2], [Expr; 2])>,
}

impl Display {
    /// A page with these letters.
    pub fn new(names: Names) -> Display {
        Display {
            names,
            blocks: Vec::new(),
        }
    }

    /// A formula within a sentence.
    pub fn inline(&mut self, f: &Formula) -> Formula {
        f.mapped(&mut |e| self.tidy(e))
    }

    /// An expression in the letters of parts, with like terms collected.
    pub fn tidy(&mut self, e: &Expr) -> Expr {
        if self.names.motions == Motions::Whole {
            return self.with_names(e);
        }
        if written_in_twists(e)
            && let Some(parts) = self.names.twist(e)
        {
            let [angular, linear] = parts.map(|part| self.collected(&part));
            return expr::stacked(angular, linear);
        }
        let out = self.names.rewritten(e);
        match out == *e {
            true => self.with_names(e),
            false => self.names.named(&out),
        }
    }

    /// Substitutes the names of the model; an expression without such names is returned as derived.
    fn with_names(&self, e: &Expr) -> Expr {
        let named = self.names.named(e);
        match named == expr::shown(&self.names.symbols, e) {
            true => e.clone(),
            false => named,
        }
    }

    /// A displayed formula.
    pub fn displayed(&mut self, f: &Formula) -> Formula {
        if self.names.motions == Motions::Whole {
            return self.inline(f);
        }
        match f {
            Formula::Continuous(inner) => match self.displayed(inner) {
                Formula::Rows(rows) => {
                    Formula::Rows(rows.into_iter().map(Formula::continuous).collect())
                }
                other => Formula::continuous(other),
            },
            // `a = b for G`
            Formula::Sequence(parts) if parts.len() > 1 => {
                if let Some((Formula::Relation(members, relation), rest)) = parts.split_first()
                    && let Some(Formula::Rows(mut rows)) = self.relation(members, *relation)
                    && let Some(last) = rows.pop()
                {
                    let rest = rest.iter().map(|f| self.inline(f));
                    let last = Formula::Sequence([last].into_iter().chain(rest).collect());
                    rows.push(last);
                    return Formula::Rows(rows);
                }
                self.inline(f)
            }
            Formula::Relation(members, relation) => {
                let parted = self.relation(members, *relation);
                parted.unwrap_or_else(|| self.inline(f))
            }
            _ => self.inline(f),
        }
    }

    fn relation(&mut self, members: &[Formula], relation: Relation) -> Option<Formula> {
        if members.iter().any(in_twists) {
            let rows = self.halves(members, relation, Kind::Twist)?;
            return Some(Formula::Rows(rows));
        }
        if members.iter().any(|f| self.in_points(f)) {
            let halves = self.halves(members, relation, Kind::Point);
            let columns = |page: &mut Self| {
                let each = members.iter().map(|f| page.column(f));
                Formula::Relation(each.collect(), relation)
            };
            return Some(halves.map_or_else(|| columns(self), Formula::Rows));
        }
        let mut rows = self.by_blocks(members, relation)?;
        match rows.len() {
            1 => rows.pop(),
            _ => Some(Formula::Rows(rows)),
        }
    }

    /// A vector of homogeneous coordinates as a column of its parts, if it is written by parts.
    fn column(&mut self, f: &Formula) -> Formula {
        let parts = match self.in_points(f) {
            true => self.half(f, Kind::Point),
            false => None,
        };
        match parts {
            Some(parts) => Formula::Matrix(parts.map(|part| vec![part]).into()),
            None => self.inline(f),
        }
    }

    /// Whether a member of an equation is built from inclusions into homogeneous coordinates.
    fn in_points(&self, f: &Formula) -> bool {
        match f {
            Formula::Expr(e) => self.names.is_of_points(e.shape()) && written_in_points(e),
            Formula::Sum(terms) => terms.iter().any(|f| self.in_points(f)),
            Formula::Neg(a) => self.in_points(a),
            _ => false,
        }
    }

    /// Splits one equation into two. If a member is a name without parts, an equation that defines the name precedes
    /// them.
    fn halves(
        &mut self,
        members: &[Formula],
        relation: Relation,
        kind: Kind,
    ) -> Option<Vec<Formula>> {
        let (left, others) = members.split_first()?;
        let own = self.half(left, kind)?;
        let mut named = vec![left.clone()];
        let mut parts: [Vec<Formula>; 2] = own.map(|f| vec![f]);
        for member in others {
            match self.half(member, kind) {
                Some(halves) => {
                    for (list, half) in parts.iter_mut().zip(halves) {
                        list.push(half);
                    }
                }
                None => named.push(self.inline(member)),
            }
        }
        if parts[0].len() < 2 {
            return None;
        }
        let mut rows = Vec::new();
        if named.len() > 1 {
            rows.push(Formula::Relation(named, relation));
        }
        rows.extend(parts.map(|list| Formula::Relation(list, relation)));
        Some(rows)
    }

    /// The two parts of a member of an equation.
    fn half(&mut self, f: &Formula, kind: Kind) -> Option<[Formula; 2]> {
        let both = |halves: [Formula; 2], wrap: &dyn Fn(Formula) -> Formula| halves.map(wrap);
        Some(match f {
            Formula::Expr(e) if e.is_zero() => [f.clone(), f.clone()],
            Formula::Expr(e) => {
                let parts = match kind {
                    Kind::Point => [self.names.top(e)?, self.names.last(e)?],
                    _ => self.names.twist(e)?,
                };
                parts.map(|part| Formula::Expr(self.collected(&part)))
            }
            Formula::Rate(a) => both(self.half(a, kind)?, &Formula::rate),
            Formula::Variation(a) => both(self.half(a, kind)?, &Formula::variation),
            Formula::Neg(a) => both(self.half(a, kind)?, &Formula::neg),
            Formula::Diff(a, b) => {
                let ([a, c], [b, d]) = (self.half(a, kind)?, self.half(b, kind)?);
                [Formula::minus(a, b), Formula::minus(c, d)]
            }
            Formula::Sum(terms) => {
                let terms: Vec<[Formula; 2]> = terms
                    .iter()
                    .map(|t| self.half(t, kind))
                    .collect::<Option<_>>()?;
                let (first, second) = terms.into_iter().map(|[a, b]| (a, b)).unzip();
                [self.total(first), self.total(second)]
            }
            // `{a, b}`
            Formula::Sequence(parts) => {
                let [
                    open @ Formula::Text(_),
                    Formula::List(pair),
                    close @ Formula::Text(_),
                ] = parts.as_slice()
                else {
                    return None;
                };
                let (first, rest) = pair.split_first()?;
                let halves = self.half(first, kind)?;
                let rest: Vec<Formula> = rest.iter().map(|f| self.inline(f)).collect();
                halves.map(|half| {
                    let pair = [half].into_iter().chain(rest.iter().cloned()).collect();
                    Formula::Sequence(vec![open.clone(), Formula::List(pair), close.clone()])
                })
            }
            _ => return None,
        })
    }

    fn collected(&mut self, e: &Expr) -> Expr {
        let e = self.names.rewritten(e);
        expr::positive_first(&self.names.named(&e))
    }

    /// Adds terms into one expression with like terms collected, if all of them are expressions.
    fn total(&mut self, terms: Vec<Formula>) -> Formula {
        let whole: Option<Vec<Expr>> = terms
            .iter()
            .map(|t| match t {
                Formula::Expr(e) => Some(e.clone()),
                _ => None,
            })
            .collect();
        match whole {
            Some(list) => {
                let shape = list.first().map_or(Shape::SCALAR, Expr::shape);
                Formula::Expr(self.collected(&expr::sum(list, shape)))
            }
            None => Formula::Sum(terms),
        }
    }

    /// Writes a member that has blocks as a block matrix; long blocks get equations of their own.
    fn by_blocks(&mut self, members: &[Formula], relation: Relation) -> Option<Vec<Formula>> {
        let mut defined = Vec::new();
        let mut found = false;
        let members: Vec<Formula> = members
            .iter()
            .map(|member| match member {
                Formula::Expr(e) => match self.blocks(e, &mut defined) {
                    Some(f) => {
                        found = true;
                        f
                    }
                    None => self.inline(member),
                },
                _ => self.inline(member),
            })
            .collect();
        let first = Formula::Relation(members, relation);
        found.then(|| [first].into_iter().chain(defined).collect())
    }

    fn blocks(&mut self, e: &Expr, defined: &mut Vec<Formula>) -> Option<Formula> {
        let shape = e.shape();
        if !shape.is_square() || shape.is_scalar() {
            return None;
        }
        let Blocks {
            block,
            column,
            rest,
        } = Blocks::of(e);
        if block.is_empty() && column.is_empty() {
            return None;
        }
        let space = expr::within(shape.rows);
        let block = self.collected(&expr::sum(block, Shape::square(space)));
        let column = self.collected(&expr::sum(column, Shape::vector(space)));
        let zero = || Formula::Expr(expr::integer(0));
        let plain = |e: &Expr| match e.is_zero() {
            true => zero(),
            false => Formula::Expr(e.clone()),
        };
        let (block, column) = match block.size() + column.size() > WIDE {
            false => (plain(&block), plain(&column)),
            true => {
                let values = [block, column];
                let known = self.blocks.iter().find(|(known, _)| *known == values);
                let (letters, new) = match known {
                    Some((_, letters)) => (letters.clone(), false),
                    None => (self.names.blocks(space), true),
                };
                let named = |letter: &Expr, value: &Expr| match value.is_zero() {
                    true => zero(),
                    false => Formula::Expr(letter.clone()),
                };
                let [a, b] = &letters;
                let [block, column] = &values;
                let shown = (named(a, block), named(b, column));
                if new {
                    let each = letters
                        .iter()
                        .zip(&values)
                        .filter(|(_, value)| !value.is_zero());
                    defined.extend(each.map(|(letter, value)| {
                        Formula::equal(letter.clone(), Formula::Expr(value.clone()))
                    }));
                    self.blocks.push((values, letters));
                }
                shown
            }
        };
        let matrix = Formula::Matrix(vec![vec![block, column], vec![zero(), zero()]]);
        if rest.is_empty() {
            return Some(matrix);
        }
        let rest = self.tidy(&expr::sum(rest, shape));
        Some(Formula::Sum(vec![matrix, Formula::Expr(rest)]))
    }
}

/// Whether a member of an equation is written by its angular and linear part.
fn in_twists(f: &Formula) -> bool {
    match f {
        Formula::Expr(e) => written_in_twists(e),
        Formula::Sum(terms) => terms.iter().any(in_twists),
        Formula::Neg(a) => in_twists(a),
        _ => false,
    }
}
