//! Rewrites an expression of an expanded chain as sums over sites, valid for every number of sites. The ranges begin
//! and end relative to the ends of the chain, and terms at the ends are written separately. The result is `None` if
//! the expression cannot be written so, because it differs on another chain.

use crate::algebra::Rational;
use crate::document::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::expr::{self, Expr, Node};
use crate::print::formula::Formula;
use crate::print::{Format, Style, expression};

#[cfg(test)]
mod tests;

/// A range has at least this many sites, and a single term at most this many: two may be the two ends, and three a
/// site with its neighbours.
const FEWEST: usize = 3;

/// The expression as sums over sites; `None` if it does not hold for every number of sites.
pub(super) fn as_sums(folded: &mut IndexedNotation, part: &Part, e: &Expr) -> Option<Formula> {
    match e.node() {
        Node::Neg(a) => Some(Formula::neg(as_sums(folded, part, a)?)),
        // The scalar or cross product of a total with a vector that does not depend on sites.
        Node::Dot(a, b) if !varies(folded, part, b) => {
            let sum = shortest(folded, part, a, Some(b))?;
            let axis = folded.derived(part, b, IndexOrigin::End(0));
            Some(Formula::Dot(Box::new(sum), Box::new(axis)))
        }
        Node::Dot(a, b) if !varies(folded, part, a) => {
            let sum = shortest(folded, part, b, Some(a))?;
            let axis = folded.derived(part, a, IndexOrigin::End(0));
            Some(Formula::Dot(Box::new(axis), Box::new(sum)))
        }
        Node::Cross(a, b) if !varies(folded, part, a) && matches!(b.node(), Node::Sum(_)) => {
            let sum = shortest(folded, part, b, None)?;
            let axis = folded.derived(part, a, IndexOrigin::End(0));
            Some(Formula::Cross(Box::new(axis), Box::new(sum)))
        }
        Node::Sum(list) => match apart(folded, part, list) {
            Some(sum) => Some(sum),
            None => shortest(folded, part, e, None),
        },
        _ => shortest(folded, part, e, None),
    }
}

/// A sum of components of totals along axes, each rewritten by itself, and other terms.
fn apart(folded: &mut IndexedNotation, part: &Part, list: &[Expr]) -> Option<Formula> {
    let read = |e: &&Expr| match e.node() {
        Node::Dot(a, b) | Node::Cross(a, b) => {
            let fixed = !varies(folded, part, a) || !varies(folded, part, b);
            let sum = |x: &Expr| matches!(x.node(), Node::Sum(_));
            fixed && (sum(a) || sum(b))
        }
        _ => false,
    };
    let (axial, rest): (Vec<&Expr>, Vec<&Expr>) = list.iter().partition(read);
    let shape = list.first()?.shape();
    let mut out = Vec::new();
    for e in &axial {
        out.push(as_sums(folded, part, e)?);
    }
    match (axial.is_empty(), rest.is_empty()) {
        (true, _) => return None,
        (false, true) => {}
        (false, false) => {
            let rest = expr::sum(rest.into_iter().cloned(), shape);
            out.push(shortest(folded, part, &rest, None)?);
        }
    }
    Some(Formula::Sum(out))
}

/// Whether an expression contains a letter of a site.
fn varies(folded: &IndexedNotation, part: &Part, e: &Expr) -> bool {
    let letters = expr::letters(e).into_iter();
    let mut sites = letters.filter_map(|l| folded.site(part, l.symbol));
    sites.next().is_some()
}

/// Rewrites the expression both as it is and with products expanded, and keeps the result with fewer sums. Some terms
/// cancel only after expansion. `axis` is the vector that the sum is multiplied by.
fn shortest(
    folded: &mut IndexedNotation,
    part: &Part,
    e: &Expr,
    axis: Option<&Expr>,
) -> Option<Formula> {
    let ways = [false, true].map(|out| {
        let terms = terms(e, out, axis);
        summed(folded, part, terms)
    });
    let best = ways.into_iter().flatten().min_by_key(Vec::len)?;
    Some(match <[Formula; 1]>::try_from(best) {
        Ok([only]) => only,
        Err(none) if none.is_empty() => Formula::Expr(expr::zero(e.shape())),
        Err(several) => Formula::Sum(several),
    })
}

/// Terms of one form and their common factor.
struct Form {
    text: String,
    times: Rational,
    /// The first term.
    term: Expr,
    /// The sites that the terms are indexed from; empty if no letter has a site.
    sites: Vec<usize>,
}

/// Sums of the terms; `None` if some terms do not fill a range.
fn summed(
    folded: &mut IndexedNotation,
    part: &Part,
    terms: Vec<(Rational, Expr)>,
) -> Option<Vec<Formula>> {
    let forms = forms(folded, part, terms)?;
    let line = folded.summed()?;
    let label = folded.lattice.labels.get(line)?;
    let (index, count) = (label.index.text.clone(), label.count.text.clone());
    let many = part.choice.count(line);
    // A set does not have ends: a sum runs over all of its sites.
    let fewest = if label.set { many } else { FEWEST };
    let set = label.set;
    let mut out = Vec::new();
    for form in forms {
        let magnitude = match form.times.is_negative() {
            true => form.times.negated(),
            false => form.times,
        };
        let term = expr::scale(magnitude, form.term);
        let whole = form.sites.windows(2).all(|w| w[0] + 1 == w[1]);
        let of = match (form.sites.as_slice(), form.sites.first(), form.sites.last()) {
            (list, Some(a), Some(b)) if list.len() >= fewest && whole => {
                let by = isize::try_from(*b).ok()? - isize::try_from(many).ok()?;
                Formula::SumOver {
                    index: index.clone(),
                    from: Some(a.to_string()),
                    to: Some(super::beyond(&count, by)),
                    of: Box::new(folded.derived(part, &term, IndexOrigin::End(*a))),
                }
            }
            ([only], ..) if !set && (*only <= 1 || *only + 1 >= many) => {
                let from = if 2 * only > many {
                    IndexOrigin::Last
                } else {
                    IndexOrigin::First
                };
                folded.derived(part, &term, from)
            }
            ([], ..) => folded.derived(part, &term, IndexOrigin::End(0)),
            _ => return None,
        };
        out.push(match form.times.is_negative() {
            true => Formula::neg(of),
            false => of,
        });
    }
    Some(out)
}

/// Collects terms of equal form, and drops terms that cancel.
fn forms(
    folded: &mut IndexedNotation,
    part: &Part,
    terms: Vec<(Rational, Expr)>,
) -> Option<Vec<Form>> {
    let style = Style::new(&part.d.spec.time_index);
    // Index each term from its own site, and add equal terms.
    let mut single: Vec<(String, Option<usize>, Rational, Expr)> = Vec::new();
    for (times, term) in terms {
        let site = base(folded, part, &term)?;
        let seen = folded.expression(part, &term, IndexOrigin::End(site.unwrap_or(0)));
        let text = expression(&seen, &folded.symbols, &style, Format::Text);
        match single
            .iter_mut()
            .find(|(t, at, ..)| *t == text && *at == site)
        {
            Some((.., known, _)) => *known = known.plus(times)?,
            None => single.push((text, site, times, term)),
        }
    }
    let mut out: Vec<Form> = Vec::new();
    for (text, site, times, term) in single {
        if times == Rational::ZERO {
            continue;
        }
        let alike = |f: &&mut Form| f.text == text && f.times == times && site.is_some();
        match out.iter_mut().find(alike) {
            Some(form) => form.sites.extend(site),
            None => out.push(Form {
                text,
                times,
                term,
                sites: site.into_iter().collect(),
            }),
        }
    }
    for form in &mut out {
        form.sites.sort_unstable();
    }
    Some(out)
}

/// The site that a term is indexed from: the first one it contains, or on a ring the one that its other sites follow.
/// The outer `None` means that the term contains sites of another label.
fn base(folded: &IndexedNotation, part: &Part, term: &Expr) -> Option<Option<usize>> {
    let line = folded.summed()?;
    let mut sites = Vec::new();
    for l in expr::letters(term) {
        match folded.site(part, l.symbol) {
            Some((label, site)) if label == line => sites.push(site),
            Some(_) => return None,
            None => {}
        }
    }
    sites.sort_unstable();
    sites.dedup();
    if sites.len() > FEWEST {
        return None;
    }
    let count = part.choice.count(line).max(1);
    let reach = |origin: &usize| {
        let after = |s: &usize| match part.choice.periodic {
            true => (s + count - origin % count) % count,
            false => s.checked_sub(*origin).unwrap_or(count + 1),
        };
        sites.iter().map(after).max()
    };
    Some(sites.iter().min_by_key(|s| (reach(s), **s)).copied())
}

/// The terms of a sum, each with its factor; if `out` is set, products of sums are expanded.
fn terms(e: &Expr, out: bool, axis: Option<&Expr>) -> Vec<(Rational, Expr)> {
    let all = factors(e, out);
    // The component along an axis of a cross product with that axis vanishes.
    let across = |e: &Expr| match (e.node(), axis) {
        (Node::Cross(a, b), Some(axis)) => out && (a == axis || b == axis),
        _ => false,
    };
    all.into_iter().filter(|(_, e)| !across(e)).collect()
}

fn factors(e: &Expr, out: bool) -> Vec<(Rational, Expr)> {
    let negative = |list: Vec<(Rational, Expr)>| -> Vec<(Rational, Expr)> {
        list.into_iter().map(|(n, e)| (n.negated(), e)).collect()
    };
    let pairs = |a: &Expr, b: &Expr, with: &dyn Fn(Expr, Expr) -> Expr| {
        let (a, b) = (factors(a, true), factors(b, true));
        let mut list = Vec::new();
        for (n, x) in &a {
            for (m, y) in &b {
                match n.times(*m) {
                    Some(product) => list.push((product, with(x.clone(), y.clone()))),
                    None => return None,
                }
            }
        }
        Some(list)
    };
    let own = || vec![(Rational::ONE, e.clone())];
    match e.node() {
        Node::Sum(list) => list.iter().flat_map(|t| factors(t, out)).collect(),
        Node::Neg(a) => negative(factors(a, out)),
        Node::Dot(a, b) if out => pairs(a, b, &expr::dot).unwrap_or_else(own),
        Node::Cross(a, b) if out => {
            let list = pairs(a, b, &expr::cross).unwrap_or_else(own);
            list.into_iter().filter_map(ordered).collect()
        }
        Node::Product(list) if out => {
            let sum = |f: &Expr| matches!(f.node(), Node::Sum(_) | Node::Neg(_) | Node::Cross(..));
            let Some(i) = list.iter().position(sum) else {
                return own();
            };
            let Some(inner) = list.get(i).map(|f| factors(f, true)) else {
                return own();
            };
            let with = |t: Expr| {
                let each = list.iter().enumerate();
                expr::product(each.map(|(j, f)| if i == j { t.clone() } else { f.clone() }))
            };
            inner.into_iter().map(|(n, t)| (n, with(t))).collect()
        }
        _ => own(),
    }
}

/// Orders the factors of a cross product; `None` for the product of a vector with itself.
fn ordered((times, e): (Rational, Expr)) -> Option<(Rational, Expr)> {
    let Node::Cross(a, b) = e.node() else {
        return Some((times, e));
    };
    let key = |e: &Expr| {
        let letters = expr::letters(e).into_iter().map(|l| l.symbol.0);
        (letters.collect::<Vec<_>>(), format!("{e:?}"))
    };
    match key(a).cmp(&key(b)) {
        std::cmp::Ordering::Equal => None,
        std::cmp::Ordering::Less => Some((times, e)),
        std::cmp::Ordering::Greater => Some((times.negated(), expr::cross(b.clone(), a.clone()))),
    }
}
