//! Finds the position of a body whose attitude is a separate configuration. Takes the text of a model; gives
//! for each attitude the position vector of the same body.
//!
//! A model writes a point of a body as a sum, `x + A*a`: the position of the body, plus an arm that rotates with it.
//! A sum with opposite signs, `X - A*p`, compares two points; the second point belongs to a body about the origin. If
//! no sum decides, names with the same number or mark belong together, such as `x1` and `A1`. Otherwise the order of
//! declaration decides, if there are as many positions as attitudes. Names decide nothing if some body is about the
//! origin, since a position may then belong to a point mass.

use super::value::Stated;
use clebsch_core::syntax::ast::{Expression, Kind, Statement};
use std::collections::{HashMap, HashSet};

/// The position of the body of an attitude.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Tied {
    /// At the position vector with this name.
    To(String),
    /// About the origin.
    Origin,
}

/// Attitudes with the positions of their bodies.
#[derive(Default)]
pub(super) struct Ties(HashMap<String, Tied>);

/// The evidence that a position and an attitude belong to one body.
#[derive(Default)]
struct Evidence {
    for_pair: HashMap<(String, String), usize>,
    apart: HashSet<String>,
}

/// The weight of a side of an equation; a sum within a function has weight one.
const SIDE: usize = 1000;

impl Ties {
    /// Pairs the attitudes and the positions of a model, both in the order of their declarations.
    pub(super) fn of(stated: &Stated<'_>, attitudes: &[&str], places: &[&str]) -> Self {
        let mut evidence = Evidence::default();
        for statement in &stated.model.statements {
            match statement {
                Statement::Hold { left, right, .. } => {
                    for side in [left, right] {
                        evidence.side(stated, side, (attitudes, places));
                        side.each(&mut |e| evidence.sum(stated, e, (attitudes, places)));
                    }
                }
                Statement::Lagrangian(value) | Statement::Let { value, .. } => {
                    value.each(&mut |e| evidence.sum(stated, e, (attitudes, places)));
                }
                _ => {}
            }
        }
        let mut ties = HashMap::new();
        let mut free: Vec<&str> = places.to_vec();
        let mut left: Vec<&str> = attitudes.to_vec();
        let mut said: Vec<((String, String), usize)> = evidence.for_pair.into_iter().collect();
        // Strongest evidence first, then by name, so that every run gives the same page.
        said.sort_by(|(a, n), (b, m)| m.cmp(n).then_with(|| a.cmp(b)));
        for ((attitude, place), _) in said {
            if left.contains(&attitude.as_str()) && free.contains(&place.as_str()) {
                left.retain(|a| *a != attitude);
                free.retain(|p| *p != place);
                ties.insert(attitude, Tied::To(place));
            }
        }
        left.retain(|attitude| {
            let alone = evidence.apart.contains(*attitude);
            if alone {
                ties.insert((*attitude).to_owned(), Tied::Origin);
            }
            !alone
        });
        let mut unmarked = Vec::new();
        for attitude in left {
            let own = mark(attitude);
            let alike = free.iter().position(|p| !own.is_empty() && mark(p) == own);
            match alike {
                Some(at) => {
                    let place = free.remove(at).to_owned();
                    ties.insert(attitude.to_owned(), Tied::To(place));
                }
                None => unmarked.push(attitude),
            }
        }
        let fixed = ties.values().any(|tied| *tied == Tied::Origin);
        if !fixed && unmarked.len() == free.len() {
            for (attitude, place) in unmarked.into_iter().zip(free) {
                ties.insert(attitude.to_owned(), Tied::To(place.to_owned()));
            }
        }
        Self(ties)
    }

    /// The position of the body with this attitude, if it is known.
    pub(super) fn place(&self, attitude: &str) -> Option<&Tied> {
        self.0.get(attitude)
    }

    /// Whether an expression names this position, or the attitude of the body at this position.
    pub(super) fn joins(&self, stated: &Stated<'_>, e: &Expression, place: &str) -> bool {
        stated.names(e, &|name| {
            name == place || matches!(self.0.get(name), Some(Tied::To(own)) if own == place)
        })
    }
}

/// The number or the mark after the letters of a name: `1` of `x1`, `A` of `x_A`.
fn mark(name: &str) -> &str {
    if let Some((_, mark)) = name.split_once('_') {
        return mark;
    }
    let word = name.trim_end_matches(|c: char| c.is_numeric() || c == '\'');
    name.get(word.len()..).unwrap_or_default()
}

/// The position in a term: `x`, `next(x)`, `pos(G)`.
pub(super) fn place_of<'e>(e: &'e Expression, places: &[&str]) -> Option<&'e str> {
    match &e.kind {
        Kind::Name(n) => places.contains(&n.as_str()).then_some(n),
        Kind::Call(f, arguments) if ["next", "prev", "pos"].contains(&f.text.as_str()) => {
            place_of(arguments.first()?, places)
        }
        _ => None,
    }
}

impl Evidence {
    /// If a side of an equation contains one position, the side is a point of its body, for any signs.
    fn side(&mut self, stated: &Stated<'_>, e: &Expression, (attitudes, places): Names<'_>) {
        let terms = stated.terms(e);
        let mut own = terms.iter().filter_map(|(_, t)| place_of(t, places));
        let (Some(place), None) = (own.next(), own.next()) else {
            return;
        };
        for (_, term) in &terms {
            if let Some(attitude) = arm(stated, term, (attitudes, places)) {
                *self.pair(attitude, place) += SIDE;
            }
        }
    }

    fn sum(&mut self, stated: &Stated<'_>, e: &Expression, (attitudes, places): Names<'_>) {
        if !matches!(e.kind, Kind::Sum(_)) {
            return;
        }
        let terms = stated.terms(e);
        let own = |(minus, t): &(bool, Expression)| Some((*minus, place_of(t, places)?.to_owned()));
        let own: Vec<(bool, String)> = terms.iter().filter_map(own).collect();
        for (minus, term) in &terms {
            let Some(attitude) = arm(stated, term, (attitudes, places)) else {
                continue;
            };
            let mut alike = own.iter().filter(|(sign, _)| sign == minus).peekable();
            if alike.peek().is_none() && !own.is_empty() {
                self.apart.insert(attitude.to_owned());
            }
            for (_, place) in alike {
                *self.pair(attitude, place) += 1;
            }
        }
    }

    fn pair(&mut self, attitude: &str, place: &str) -> &mut usize {
        let pair = (attitude.to_owned(), place.to_owned());
        self.for_pair.entry(pair).or_default()
    }
}

/// Attitudes and positions by name.
type Names<'n> = (&'n [&'n str], &'n [&'n str]);

/// The attitude that rotates a term, if the term is an arm: a product with one attitude and without a position.
fn arm<'n>(
    stated: &Stated<'_>,
    term: &Expression,
    (attitudes, places): Names<'n>,
) -> Option<&'n str> {
    let product = match &term.kind {
        Kind::Product(list) => list.len() > 1,
        Kind::Quotient(..) => true,
        _ => false,
    };
    if !product || is_number(term) || stated.names(term, &|n| places.contains(&n)) {
        return None;
    }
    let mut own = attitudes
        .iter()
        .filter(|a| stated.names(term, &|n| n == **a));
    own.next().copied().filter(|_| own.next().is_none())
}

/// Whether a product has a factor that excludes an arm of a body: a scalar function of matrices, or a
/// transpose.
fn is_number(term: &Expression) -> bool {
    let factors: Vec<&Expression> = match &term.kind {
        Kind::Product(list) => list.iter().collect(),
        Kind::Quotient(a, _) => match &a.kind {
            Kind::Product(list) => list.iter().collect(),
            _ => vec![a.as_ref()],
        },
        _ => Vec::new(),
    };
    let scalar = |e: &&Expression| match &e.kind {
        Kind::Call(f, _) => ["tr", "dot", "det", "Tr", "sum"].contains(&f.text.as_str()),
        Kind::Transpose(_) => true,
        _ => false,
    };
    factors.iter().any(scalar)
}
