//! Constraints on sums over sites, `hold p: sum(m*φ) = X;`, which have one multiplier in the expanded model. Expands
//! both sides into sums over the existing sites. If the constraint is linear in its sums, it also returns the
//! summands.

use super::{LARGEST, Writer};
use crate::diagnostic::{Diagnostic, Place};
use crate::lattice::declared::{Lattice, Sites};
use crate::lattice::parts::{LINEAR, has_sum, names, parts, summand, with_parts};
use crate::lattice::range::{Range, Reach, reach};
use crate::syntax::ast::{Expression, Kind, Name, Statement};

/// A declared constraint on sums over sites.
#[derive(Clone, Debug)]
pub struct StatedTotal {
    /// The name of its multiplier.
    pub name: String,
    /// The summed terms, left side minus right side; `None` if the constraint is not linear in its sums.
    pub summed: Option<Vec<Summed>>,
    /// The terms outside the sums, left side minus right side.
    pub rest: Expression,
}

/// A summand and the sites of its sum.
#[derive(Clone, Debug)]
pub struct Summed {
    /// The summand at the displayed site.
    pub shown: Expression,
    /// The displayed site.
    pub site: usize,
    /// The sites that it is summed over.
    pub range: Range,
    /// Kind of sites and offset of its letters, relative to its index.
    pub letters: Vec<(Sites, isize)>,
}

/// The offsets of the letters of a sum, and the sites that it names.
fn over(lattice: &Lattice, call: &Expression) -> Result<Reach, Diagnostic> {
    match &call.kind {
        Kind::Call(_, arguments) => match arguments.as_slice() {
            [inner] => reach(lattice, inner),
            _ => reach(lattice, call),
        },
        _ => reach(lattice, call),
    }
}

/// A sum of signed terms; zero if there are none.
fn sum_of(terms: Vec<(bool, Expression)>, place: Place) -> Expression {
    let kind = match terms.is_empty() {
        true => Kind::Number(crate::algebra::Rational::ZERO),
        false => Kind::Sum(terms),
    };
    Expression { kind, place }
}

/// Signed terms with at most one sum each; `None` if the expression is not linear in its sums.
fn terms(e: &Expression) -> Option<Vec<(bool, Expression)>> {
    if summand(e).is_some() || !has_sum(e) {
        return Some(vec![(false, e.clone())]);
    }
    let signed = |terms: Vec<(bool, Expression)>, minus: bool| {
        terms.into_iter().map(move |(m, t)| (m != minus, t))
    };
    match &e.kind {
        Kind::Sum(list) => {
            let each = list
                .iter()
                .map(|(minus, t)| Some(signed(terms(t)?, *minus)));
            let each = each.collect::<Option<Vec<_>>>()?;
            return Some(each.into_iter().flatten().collect());
        }
        Kind::Neg(a) => return Some(signed(terms(a)?, true).collect()),
        Kind::Quotient(_, b) if has_sum(b) => return None,
        Kind::Power(..) => return None,
        Kind::Call(f, _) if !LINEAR.contains(&f.text.as_str()) => return None,
        _ => {}
    }
    let all = parts(e);
    let mut with_sums = (0..all.len()).filter(|i| has_sum(all[*i]));
    let (Some(at), None) = (with_sums.next(), with_sums.next()) else {
        return None;
    };
    let own = terms(all[at])?.into_iter().map(|(minus, term)| {
        let new = all.iter().enumerate();
        let new = new.map(|(i, p)| if i == at { term.clone() } else { (*p).clone() });
        (minus, with_parts(e, new))
    });
    Some(own.collect())
}

/// Replaces the sum in a term with one sum by its summand; also returns the call of `sum`.
fn opened(term: &Expression) -> (Expression, Option<&Expression>) {
    if let Some(inner) = summand(term) {
        return (inner.clone(), Some(term));
    }
    let mut call = None;
    let new: Vec<Expression> = parts(term)
        .into_iter()
        .map(|p| {
            let (new, found) = opened(p);
            call = call.or(found);
            new
        })
        .collect();
    (with_parts(term, new.into_iter()), call)
}

impl Writer<'_> {
    /// Expands a constraint on sums over sites.
    pub(super) fn total(
        &mut self,
        name: &Name,
        (left, right): (Expression, Expression),
        place: Place,
        docs: &[String],
    ) {
        let both = self
            .summed(&left)
            .and_then(|l| Ok((l, self.summed(&right)?)));
        let (written_left, written_right) = match both {
            Ok(both) => both,
            Err(d) => return self.errors.push(*d),
        };
        let whole = Expression {
            kind: Kind::Sum(vec![(false, left), (true, right)]),
            place,
        };
        let (mut summed, mut rest) = (Some(Vec::new()), Vec::new());
        match terms(&whole) {
            None => summed = None,
            Some(list) => {
                for (minus, term) in list {
                    if !has_sum(&term) {
                        rest.push((minus, term));
                        continue;
                    }
                    let own = self.one_summed(minus, &term);
                    summed = summed.and_then(|mut all: Vec<Summed>| {
                        all.push(own?);
                        Some(all)
                    });
                }
            }
        }
        self.out.totals.push(StatedTotal {
            name: name.text.clone(),
            summed,
            rest: sum_of(rest, place),
        });
        let stated = Statement::Hold {
            name: name.clone(),
            left: written_left,
            right: written_right,
            place,
        };
        self.push(stated, docs);
    }

    /// The summand of a term with one sum, at the middle of its range.
    fn one_summed(&self, minus: bool, term: &Expression) -> Option<Summed> {
        let (open, call) = opened(term);
        let found = over(self.lattice, call?).ok()?;
        let range = found.range(self.lattice, self.choice)?;
        let sites: Vec<isize> = range.indices(self.choice.count(range.label)).collect();
        let site = *sites.get(sites.len() / 2)?;
        let shown = self.substitution(site).substitute(&open).ok()?;
        let by = self.first_counted(&open, &found.letters);
        Some(Summed {
            shown: sum_of(vec![(minus, shown)], term.place),
            site: usize::try_from(site + by).ok()?,
            range: self.counted_from(range, by),
            letters: found.letters.iter().map(|(s, o)| (*s, o - by)).collect(),
        })
    }

    /// An expression with its sums expanded.
    fn summed(&self, e: &Expression) -> Result<Expression, Box<Diagnostic>> {
        let refused = |d: Diagnostic| Err(Box::new(d));
        if let Kind::Name(n) = &e.kind
            && self.lattice.find(n).is_some()
        {
            let message = format!(
                "`{n}` differs between sites, and a term with a sum over sites cannot contain it"
            );
            return refused(Diagnostic::new(e.place, message).help(
                "a constraint on a sum applies to all sites together: move the quantity into the sum, `sum(m*x)`, or write a \
                 constraint at each site, without a sum",
            ));
        }
        let Some(inner) = summand(e) else {
            let new = parts(e).into_iter().map(|p| self.summed(p));
            let new = new.collect::<Result<Vec<_>, _>>()?;
            return Ok(with_parts(e, new.into_iter()));
        };
        if has_sum(inner) {
            let d = Diagnostic::new(e.place, "a sum over sites contains another sum over sites");
            return refused(d.help("write one sum, over nodes or over segments"));
        }
        let found = over(self.lattice, e).map_err(Box::new)?;
        let range = found.range(self.lattice, self.choice);
        // For a name that is not declared, the check gives a better message.
        if found.letters.is_empty()
            && names(inner)
                .iter()
                .any(|n| !self.lattice.declared.contains(*n))
        {
            return Ok(inner.clone());
        }
        let Some(range) = range.filter(|_| !found.letters.is_empty()) else {
            let d = Diagnostic::new(
                e.place,
                "this is the same at every site, so it cannot be summed over sites",
            );
            return refused(d.help("sum quantities declared `at nodes` or `at segments`, `sum(m*x)`; remove `sum` from other \
                terms"));
        };
        let mut all = Vec::new();
        let mut large = 0;
        for site in range.indices(self.choice.count(range.label)) {
            let copy = self.substitution(site).substitute(inner)?;
            large += copy.size();
            if large > LARGEST {
                let words = self.choice.words(self.lattice);
                let message = format!("this model is too large to be expanded: {words}");
                return refused(Diagnostic::new(e.place, message).help(format!(
                    "a constrained sum may have {LARGEST} quantities, numbers and operations: use fewer sites"
                )));
            }
            all.push((false, copy));
        }
        Ok(sum_of(all, e.place))
    }
}
