//! The terms of a Lagrangian: the sites over which each is summed, and whether it belongs to the edge or to one time
//! level. Takes an expression with substituted definitions; gives its terms.

use crate::expression::{Expression, Kind};
use crate::stated::{Role, Sites, Stated};
use crate::words::{flat, of_kind, quotient, with_sign, without_sign, words};

/// The time level of a term.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TermTime {
    /// No quantity in it moves.
    Nowhere,
    /// At one node, this number of steps after the first node of the edge.
    Node(i32),
    /// On the edge.
    Edge,
}

/// A quantity along a label: its sites, and its distance from the index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Letter {
    /// Its sites.
    pub sites: Sites,
    /// Its distance from the index.
    pub offset: i64,
}

/// A term, with its own sign and factors.
#[derive(Clone, Debug)]
pub struct Term {
    /// The term.
    pub value: Expression,
    /// Its time level.
    pub lives: TermTime,
    /// The label along which it is summed.
    pub label: Option<usize>,
    /// Its quantities along that label, including the quantities of the term that it was split from.
    pub letters: Vec<Letter>,
    /// The sites that the statement sums over.
    pub over: Option<Sites>,
    /// Whether it contains a moving quantity without a site.
    pub global: bool,
}

/// Splits expressions.
pub struct Terms<'a>(&'a Stated);

/// The result of a walk through an expression.
#[derive(Default)]
struct TermScan {
    label: Option<usize>,
    letters: Vec<Letter>,
    over: Option<Sites>,
    global: bool,
    times: Vec<i32>,
    velocity: bool,
}

impl<'a> Terms<'a> {
    /// Splits expressions of this model.
    #[must_use]
    pub fn of(stated: &'a Stated) -> Self {
        Self(stated)
    }

    /// The terms of a Lagrangian.
    ///
    /// # Errors
    /// A term cannot be judged.
    pub fn of_lagrangian(&self, value: &Expression) -> Result<Vec<Term>, String> {
        let mut out = Vec::new();
        let parts = match self.0.labels.is_empty() {
            true => vec![value.clone()],
            false => self.by_sites(value, true),
        };
        for part in parts {
            let range = self.whole(part.clone())?;
            for value in self.in_time(&part) {
                let own = self.whole(value)?;
                out.push(Term {
                    label: range.label,
                    letters: range.letters.clone(),
                    over: range.over,
                    ..own
                });
            }
        }
        Ok(out)
    }

    /// The terms of an end condition, which are not summed.
    ///
    /// # Errors
    /// A term cannot be judged.
    pub fn of_end(&self, value: &Expression) -> Result<Vec<Term>, String> {
        self.in_time(value)
            .into_iter()
            .map(|e| self.whole(e))
            .collect()
    }

    /// An expression as one term.
    ///
    /// # Errors
    /// It cannot be judged.
    pub fn whole(&self, value: Expression) -> Result<Term, String> {
        let mut found = TermScan::default();
        self.walk(&value, 0, 0, &mut found)?;
        found.letters.sort_unstable();
        found.letters.dedup();
        let first = found.times.first().copied();
        let lives = match (found.velocity, first) {
            (true, _) => TermTime::Edge,
            (false, None) => TermTime::Nowhere,
            (false, Some(t)) if found.times.iter().all(|o| *o == t) => TermTime::Node(t),
            (false, Some(_)) => TermTime::Edge,
        };
        Ok(Term {
            value,
            lives,
            label: found.label,
            letters: found.letters,
            over: found.over,
            global: found.global,
        })
    }

    fn walk(&self, e: &Expression, time: i32, by: i64, found: &mut TermScan) -> Result<(), String> {
        match &e.kind {
            Kind::Name(n) => self.name(n, time, by, found),
            Kind::Call(f, arguments) => match (f.as_str(), arguments.as_slice()) {
                ("next", [inner]) => self.walk(inner, time + 1, by, found),
                ("prev", [inner]) => self.walk(inner, time - 1, by, found),
                ("next", [inner, _]) => self.walk(inner, time, by + 1, found),
                ("prev", [inner, _]) => self.walk(inner, time, by - 1, found),
                ("sum", [inner, rest @ ..]) => {
                    found.label = found.label.or(self.0.line);
                    found.over = rest.first().map(|s| match &s.kind {
                        Kind::Name(n) if n == "segments" => Sites::Segments,
                        _ => Sites::Nodes,
                    });
                    self.walk(inner, time, by, found)
                }
                _ => arguments
                    .iter()
                    .try_for_each(|a| self.walk(a, time, by, found)),
            },
            _ => e
                .parts()
                .into_iter()
                .try_for_each(|p| self.walk(p, time, by, found)),
        }
    }

    fn name(&self, n: &str, time: i32, by: i64, found: &mut TermScan) -> Result<(), String> {
        let of = self.0.velocities.get(n);
        let Some(q) = self.0.quantities.get(of.map_or(n, String::as_str)) else {
            return Ok(());
        };
        let moves = !matches!(q.role, Role::Parameter);
        found.velocity |= of.is_some();
        if moves && of.is_none() {
            found.times.push(time);
        }
        let Some((label, sites)) = q.at else {
            found.global |= moves;
            return Ok(());
        };
        if found.label.is_some_and(|l| l != label) {
            return Err("a term combines two labels".to_owned());
        }
        found.label = Some(label);
        found.letters.push(Letter { sites, offset: by });
        Ok(())
    }

    /// Splits an expression into parts that are summed over sites separately. Numbers before a bracket are multiplied
    /// in. Below the top level, a bracket with a term of one neighbour is not split. Differences in time are not
    /// split either.
    fn by_sites(&self, e: &Expression, top: bool) -> Vec<Expression> {
        match &e.kind {
            Kind::Sum(terms) => {
                if !top && terms.iter().any(|(_, t)| self.of_one_neighbour(t)) {
                    return vec![e.clone()];
                }
                let signed = terms.iter().map(|(minus, t)| {
                    let parts = self.by_sites(t, false);
                    (*minus, t, parts)
                });
                let mut out = Vec::new();
                for (minus, t, parts) in signed {
                    let whole = !top && self.is_in_a_difference(t, minus, terms);
                    let parts = if whole { vec![t.clone()] } else { parts };
                    out.extend(parts.into_iter().map(|p| with_sign(p, minus)));
                }
                match top {
                    true => out,
                    false => self.joined(out),
                }
            }
            Kind::Neg(a) => self
                .by_sites(a, top)
                .into_iter()
                .map(|p| with_sign(p, true))
                .collect(),
            Kind::Quotient(a, b) => {
                let parts = self.by_sites(a, false).into_iter();
                parts.map(|p| quotient(p, b)).collect()
            }
            Kind::Product(list) if list.iter().all(|f| self.is_number(f)) => {
                let split: Vec<_> = list.iter().map(|f| self.by_sites(f, false)).collect();
                self.multiplied(e, list, &split)
            }
            _ => vec![e.clone()],
        }
    }

    fn is_in_a_difference(&self, t: &Expression, minus: bool, all: &[(bool, Expression)]) -> bool {
        let opposite = |(other, o): &(bool, Expression)| {
            *other != minus
                && self.steps(t).is_some_and(|(level, words)| {
                    self.steps(o).is_some_and(|(l, w)| l != level && w == words)
                })
        };
        all.iter().any(opposite)
    }

    fn of_one_neighbour(&self, e: &Expression) -> bool {
        let Ok(term) = self.whole(e.clone()) else {
            return false;
        };
        let first = term.letters.first().map(|l| l.offset);
        first.is_some_and(|o| o != 0 && term.letters.iter().all(|l| l.offset == o))
    }

    /// The summands, each of which belongs to the edge or to one node: a common factor or divisor is multiplied in.
    fn in_time(&self, e: &Expression) -> Vec<Expression> {
        match &e.kind {
            Kind::Sum(terms) => {
                let each = terms.iter().flat_map(|(minus, t)| {
                    let parts = self.in_time(t).into_iter();
                    parts.map(|p| with_sign(p, *minus))
                });
                each.collect()
            }
            Kind::Neg(a) => self
                .in_time(a)
                .into_iter()
                .map(|p| with_sign(p, true))
                .collect(),
            Kind::Call(f, list) if f == "sum" => {
                list.first().map_or(Vec::new(), |a| self.in_time(a))
            }
            Kind::Shaped(a, shape, _) if shape == "Real" => self.in_time(a),
            Kind::Quotient(a, b) => {
                let parts = self.joined(self.in_time(a)).into_iter();
                parts.map(|p| quotient(p, b)).collect()
            }
            Kind::Product(list) if list.iter().all(|f| self.is_number(f)) => {
                let list = flat(list);
                let split = list.iter().map(|f| match f.kind {
                    Kind::Product(_) => vec![f.clone()],
                    _ => self.joined(self.in_time(f)),
                });
                let split: Vec<_> = split.collect();
                self.multiplied(e, &list, &split)
            }
            _ => vec![e.clone()],
        }
    }

    /// A product with a factor of several summands, expanded; if there are several such factors, one of them is not
    /// expanded.
    fn multiplied(
        &self,
        e: &Expression,
        list: &[Expression],
        split: &[Vec<Expression>],
    ) -> Vec<Expression> {
        let mut sums = (0..split.len()).filter(|i| split[*i].len() > 1);
        let (Some(place), None) = (sums.next(), sums.next()) else {
            return vec![e.clone()];
        };
        let mut others = list.iter().enumerate().filter(|(i, _)| *i != place);
        let terms = match others.any(|(_, f)| self.moves(f)) {
            true => self.with_constants(&split[place]),
            false => split[place].clone(),
        };
        if terms.len() < 2 {
            return vec![e.clone()];
        }
        let parts = terms.iter().map(|part| {
            let mut factors = list.to_vec();
            factors[place] = part.clone();
            of_kind(Kind::Product(factors))
        });
        parts.collect()
    }

    /// Whether a quantity in it moves.
    fn moves(&self, e: &Expression) -> bool {
        let term = self.whole(e.clone());
        term.is_ok_and(|term| !matches!(term.lives, TermTime::Nowhere))
    }

    /// Summands, with constant summands added to the first summand that lives on the edge. In `q^2*(3 - tr(O))`, the
    /// constant `3` belongs to the velocity, and `3*q^2` is not a term of a node.
    fn with_constants(&self, terms: &[Expression]) -> Vec<Expression> {
        let on_edge = |t: &Expression| {
            let term = self.whole(t.clone());
            term.is_ok_and(|term| matches!(term.lives, TermTime::Edge))
        };
        if !terms.iter().any(on_edge) {
            return terms.to_vec();
        }
        let (mut moving, constant): (Vec<_>, Vec<_>) =
            terms.iter().cloned().partition(|t| self.moves(t));
        if let Some(edge) = moving.iter_mut().find(|t| on_edge(t)) {
            let all = constant.into_iter().chain([edge.clone()]);
            *edge = of_kind(Kind::Sum(all.map(|t| (false, t)).collect()));
        }
        moving
    }

    /// Combines each summand with the negative summand that equals it one step later.
    fn joined(&self, terms: Vec<Expression>) -> Vec<Expression> {
        let mut left: Vec<Option<Expression>> = terms.into_iter().map(Some).collect();
        let mut out = Vec::new();
        for i in 0..left.len() {
            let Some(term) = left[i].take() else { continue };
            let own = self.steps(&term);
            let partner = left[i + 1..].iter_mut().find(|other| {
                let other = other.as_ref().map(without_sign);
                let (minus, plain) = without_sign(&term);
                other.is_some_and(|(sign, o)| {
                    sign != minus
                        && self
                            .steps(plain)
                            .zip(self.steps(o))
                            .is_some_and(|((a, x), (b, y))| a != b && x == y)
                })
            });
            out.push(
                match partner.and_then(Option::take).filter(|_| own.is_some()) {
                    Some(other) => of_kind(Kind::Sum(vec![(false, term), (false, other)])),
                    None => term,
                },
            );
        }
        out
    }

    /// The time level of an expression at one node, and its words at level zero.
    fn steps(&self, e: &Expression) -> Option<(i32, String)> {
        let term = self.whole(without_sign(e).1.clone()).ok()?;
        match term.lives {
            TermTime::Node(level) => Some((level, words(&term.value))),
            _ => None,
        }
    }

    /// Whether an expression is a number, as its form and the declarations say.
    fn is_number(&self, e: &Expression) -> bool {
        match &e.kind {
            Kind::Number(..) | Kind::Constant(_) | Kind::Component(..) => true,
            Kind::Name(n) => {
                *n == self.0.step || self.0.quantities.get(n).is_some_and(|q| q.is_number)
            }
            Kind::Shaped(_, shape, _) => shape == "Real",
            Kind::Sum(terms) => terms.iter().all(|(_, t)| self.is_number(t)),
            Kind::Product(list) => list.iter().all(|f| self.is_number(f)),
            Kind::Quotient(a, _) | Kind::Neg(a) | Kind::Transpose(a) | Kind::Power(a, ..) => {
                self.is_number(a)
            }
            Kind::Call(f, list) => match f.as_str() {
                "next" | "prev" | "sum" => list.first().is_some_and(|a| self.is_number(a)),
                "inv" | "sym" | "skew" | "diag" | "perp" | "hat" | "vee" | "cross" | "im"
                | "quat" | "rot" | "pos" => false,
                _ => true,
            },
        }
    }
}
