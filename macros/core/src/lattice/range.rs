//! The range of a term: the sites at which all its letters exist.

use super::chain_config::ChainConfig;
use super::declared::{Lattice, Sites};
use super::parts::{LINEAR, has_sum, parts};
use crate::diagnostic::{Diagnostic, Place};
use crate::syntax::ast::{Expression, Kind};
use crate::syntax::unknown::{PAIRS, how_to_sum};

/// The offsets of the letters of an expression from its index.
#[derive(Clone, Default, Debug)]
pub(super) struct Reach {
    /// The label, if there is one.
    pub label: Option<usize>,
    /// Kind of sites and offset of every letter, sorted, without repetitions.
    pub letters: Vec<(Sites, isize)>,
    /// The sites that the term is explicitly summed over.
    pub over: Option<Sites>,
}

/// The indices of a term, for every number of sites: from `from` to `N + to`.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Range {
    /// Its label.
    pub label: usize,
    /// The first index.
    pub from: isize,
    /// The last index, relative to the number of segments or sites.
    pub to: isize,
}

impl Range {
    /// The indices for this number of segments or sites.
    pub fn indices(self, count: usize) -> impl Iterator<Item = isize> {
        let count = isize::try_from(count).unwrap_or(isize::MAX);
        self.from..=count.saturating_add(self.to)
    }
}

/// Whether all letters of an expression belong to the same neighbour. As a whole term, the expression would be a term
/// of that site; within a sum it is part of a difference.
pub(super) fn of_one_neighbour(lattice: &Lattice, e: &Expression) -> bool {
    let Ok(found) = reach(lattice, e) else {
        return false;
    };
    match found.letters.first() {
        Some((_, offset)) => *offset != 0 && found.letters.iter().all(|(_, o)| o == offset),
        None => false,
    }
}

/// The offsets of the letters of an expression.
pub(super) fn reach(lattice: &Lattice, e: &Expression) -> Result<Reach, Diagnostic> {
    let mut found = Reach::default();
    walk(lattice, e, 0, &mut found)?;
    found.letters.sort_unstable();
    found.letters.dedup();
    Ok(found)
}

fn walk(lattice: &Lattice, e: &Expression, by: isize, found: &mut Reach) -> Result<(), Diagnostic> {
    match &e.kind {
        Kind::Number(_) | Kind::Constant(_) => Ok(()),
        Kind::Name(n) => match lattice.find(n) {
            None => named(lattice, n, e.place),
            Some(q) => {
                if let Some(other) = found.label.filter(|l| *l != q.label) {
                    return Err(mixed(lattice, other, q.label, e.place));
                }
                found.label = Some(q.label);
                found.letters.push((q.sites, by));
                Ok(())
            }
        },
        Kind::Shaped(a, _) => walk(lattice, a, by, found),
        Kind::Sum(terms) => terms
            .iter()
            .try_for_each(|(_, t)| walk(lattice, t, by, found)),
        Kind::Product(list) => list.iter().try_for_each(|f| walk(lattice, f, by, found)),
        Kind::Quotient(a, b) => {
            walk(lattice, a, by, found)?;
            walk(lattice, b, by, found)
        }
        Kind::Neg(a) | Kind::Transpose(a) | Kind::Power(a, _) | Kind::Component(a, _) => {
            walk(lattice, a, by, found)
        }
        Kind::Call(f, arguments) => match (f.text.as_str(), arguments.as_slice()) {
            ("next" | "prev", [inner, label]) => {
                let step = if f.text == "next" { 1 } else { -1 };
                neighbour(lattice, inner, label, e.place)?;
                walk(lattice, inner, by + step, found)
            }
            ("sum", [inner, sites]) => {
                let over = summed_over(sites)?;
                if found.over.is_some() {
                    return Err(of_pairs("two sums over sites in one term are", e.place));
                }
                found.over = Some(over);
                found.label = found.label.or(lattice.line);
                walk(lattice, inner, by, found)
            }
            ("sum", [_, _, more, ..]) => Err(Diagnostic::new(
                more.place,
                "`sum` takes an expression, and `nodes` or `segments`",
            )
            .help("write `sum(expr)`, or `sum(expr, nodes)`; for several terms, write `sum(a + b)`")),
            ("sum", []) => Err(Diagnostic::new(e.place, "this sum over sites is empty")
                .help("write the summand: `sum(m*x)`, or `sum(m*x, nodes)`")),
            ("sum", [inner]) if is_label(lattice, inner) => Err(how_to_sum(Diagnostic::new(
                e.place,
                "`sum` takes the summand, not a label: a sum includes all sites already",
            ))),
            ("sum", [inner]) if has_sum(inner) => {
                Err(of_pairs("a sum over sites within another one is", e.place))
            }
            ("sum", [_]) => Err(Diagnostic::new(
                e.place,
                "`sum(...)` over all sites is allowed only in a `hold` constraint",
            )
            .help("the Lagrangian is summed over labels already: remove `sum`, or give the sites of a term, `sum(expr, \
                nodes)`; a constraint reads `hold p: sum(m*x) = X;`")),
            _ => arguments
                .iter()
                .try_for_each(|a| walk(lattice, a, by, found)),
        },
    }
}

/// The error for a term of the Lagrangian that is not linear in its sum over declared sites. Such a sum only selects
/// the sites of the term; it is not a number of the whole chain.
pub(super) fn beside_sum(lattice: &Lattice, e: &Expression) -> Option<Diagnostic> {
    let refused = |at: &Expression, what: &str| {
        let message = format!(
            "{what} couples every site to all others, which a Lagrangian cannot do yet: `sum(expr, nodes)` only gives the \
             sites of a term"
        );
        let d = Diagnostic::new(at.place, message);
        Some(d.help("move everything into the sum, as in `sum(x^2, nodes)`; only a `hold` constraint may contain a function of \
            sums, as in `hold p: dot(sum(x), sum(x)) = a^2;`"))
    };
    let differs = |e: &Expression| reach(lattice, e).is_ok_and(|r| !r.letters.is_empty());
    if !has_sum(e) || matches!(&e.kind, Kind::Call(f, _) if f.text == "sum") {
        return None;
    }
    match &e.kind {
        Kind::Neg(a) | Kind::Shaped(a, _) | Kind::Transpose(a) | Kind::Component(a, _) => {
            beside_sum(lattice, a)
        }
        Kind::Sum(terms) => terms.iter().find_map(|(_, t)| match has_sum(t) {
            true => beside_sum(lattice, t),
            false => differs(t)
                .then(|| refused(t, "a quantity of one site added to a sum over sites"))
                .flatten(),
        }),
        Kind::Quotient(_, b) if has_sum(b) => refused(e, "a quotient by a sum over sites"),
        Kind::Power(..) => refused(e, "a power of a sum over sites"),
        Kind::Call(f, _) if !LINEAR.contains(&f.text.as_str()) => {
            refused(e, "a function of a sum over sites")
        }
        _ => {
            let all = parts(e);
            let with_sum: Vec<&&Expression> = all.iter().filter(|p| has_sum(p)).collect();
            match with_sum.as_slice() {
                [only] => match all.iter().find(|p| !has_sum(p) && differs(p)) {
                    Some(other) => refused(other, "a quantity of a site times a sum over sites"),
                    None => beside_sum(lattice, only),
                },
                _ => refused(e, "a product of sums over sites"),
            }
        }
    }
}

/// An error if a name is an index or a count, which is not a quantity.
fn named(lattice: &Lattice, name: &str, place: Place) -> Result<(), Diagnostic> {
    let is = |l: &&super::Label| l.index.text == name || l.count.text == name;
    match lattice.labels.iter().find(is) {
        None => Ok(()),
        Some(l) => Err(Diagnostic::new(
            place,
            format!("`{name}` counts sites and is not a quantity of the model"),
        )
        .help(format!(
            "for a quantity that differs between sites, declare a parameter, `param a: Real at nodes;`, and in the case write \
             `a = \"1 + {}/{}\"`",
            l.index.text, l.count.text
        ))),
    }
}

/// Whether an expression is the index of a label, as in `sum(i)`.
fn is_label(lattice: &Lattice, e: &Expression) -> bool {
    let mut labels = lattice.labels.iter();
    matches!(&e.kind, Kind::Name(n) if labels.any(|l| l.index.text == *n))
}

fn mixed(lattice: &Lattice, a: usize, b: usize, place: Place) -> Diagnostic {
    let name = |i: usize| lattice.labels.get(i).map_or("", |l| l.index.text.as_str());
    let message = format!(
        "this term contains sites of `{}` and of `{}`, so the sites to combine are ambiguous",
        name(a),
        name(b)
    );
    Diagnostic::new(place, message)
        .help("terms of different labels are summed separately: write two terms")
}

/// `next(x, i)` needs a quantity at the sites of a chain.
fn neighbour(
    lattice: &Lattice,
    inner: &Expression,
    label: &Expression,
    place: Place,
) -> Result<(), Diagnostic> {
    let line = lattice.line_label();
    let line_name = line.map_or("", |l| l.index.text.as_str());
    let Kind::Name(name) = &label.kind else {
        let d = Diagnostic::new(
            label.place,
            "the second argument must be the label of a chain",
        );
        return Err(d.help(format!("write `next(x, {line_name})`")));
    };
    if name != line_name || line.is_none() {
        let own = lattice.labels.iter().find(|l| l.index.text == *name);
        let message = match own {
            Some(_) => format!("`{name}` is a set of sites, and its sites have no neighbours"),
            None => format!("`{name}` is not a label"),
        };
        let d = Diagnostic::new(label.place, message);
        return Err(match line {
            Some(l) => d.help(format!("the label of the chain is `{}`", l.index.text)),
            None => d.help(
                "declare a chain, `label i in 0..N;`, and quantities `at nodes` or `at segments`",
            ),
        });
    }
    let held = reach(lattice, inner)?;
    if held.letters.is_empty() {
        let d = Diagnostic::new(
            place,
            "this is the same at every site, so it has no neighbour",
        );
        return Err(d.help(format!(
            "declare quantities that differ between sites `at nodes` or `at segments`, or remove `, {line_name}`"
        )));
    }
    Ok(())
}

/// A sum over pairs of sites.
fn of_pairs(what: &str, place: Place) -> Diagnostic {
    let message = format!("{what} a sum over pairs of sites, which is not supported yet");
    Diagnostic::new(place, message).help(PAIRS)
}

/// `sum(expr, nodes)`.
fn summed_over(sites: &Expression) -> Result<Sites, Diagnostic> {
    match &sites.kind {
        Kind::Name(n) if n == "nodes" => Ok(Sites::Nodes),
        Kind::Name(n) if n == "segments" => Ok(Sites::Segments),
        Kind::Name(n) if n == "pairs" => Err(of_pairs("this is", sites.place)),
        _ => Err(
            Diagnostic::new(sites.place, "a sum runs over `nodes` or over `segments`")
                .help("write `sum(expr, segments)`; the Lagrangian is summed over labels already"),
        ),
    }
}

impl Reach {
    /// The range of a term on this chain; `None` if the term is not summed.
    pub(super) fn range(&self, lattice: &Lattice, choice: &ChainConfig) -> Option<Range> {
        let label = self.label?;
        let whole = Range {
            label,
            from: 0,
            to: -1,
        };
        if lattice.line != Some(label) || choice.periodic {
            return Some(whole);
        }
        let last = |sites: Sites| match sites {
            Sites::Nodes => 0,
            Sites::Segments | Sites::Members => -1,
        };
        let has_nodes = self.letters.iter().any(|(s, _)| *s == Sites::Nodes);
        let own = self.over.unwrap_or(match has_nodes {
            true => Sites::Nodes,
            false => Sites::Segments,
        });
        let mut range = Range {
            label,
            from: 0,
            to: last(own),
        };
        for (sites, offset) in &self.letters {
            range.from = range.from.max(-offset);
            range.to = range.to.min(last(*sites) - offset);
        }
        Some(range)
    }

    /// The largest distance between its letters, in sites.
    pub(super) fn width(&self) -> usize {
        let offsets = || self.letters.iter().map(|(_, o)| *o);
        match (offsets().min(), offsets().max()) {
            (Some(a), Some(b)) => usize::try_from(b - a).unwrap_or(0),
            _ => 0,
        }
    }
}
