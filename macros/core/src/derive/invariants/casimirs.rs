//! Casimirs of the bracket: candidates whose differential the bracket annihilates and that the step preserves,
//! independent of one another, until their number equals the corank. Takes the bracket and exact steps; gives
//! quantities that are conserved for every Lagrangian.

use super::independence::tangents;
use super::random_step::RandomStep;
use super::{Family, Inputs, Invariant, Kind, casimir_candidates, here, is_conserved};
use crate::algebra::assumed::{self, Independent, rank};
use crate::algebra::exact::{ATTEMPTS, Matrix, Point, add, mul, negate, paired};
use crate::derive::bracket::{Element, Numbers, Space};
use crate::expr::shape::Dim;
use crate::expr::{self, Expr, Letter};

/// The number of Casimirs at one size of the model.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Count {
    /// The size, if it is named.
    pub size: Option<usize>,
    /// The dimension of the reduced space.
    pub dimension: usize,
    /// The rank of its bracket at a general point.
    pub rank: usize,
    /// The number of independent Casimirs among those found.
    pub found: usize,
    /// The number of these that have the same value in every state, which are not listed.
    pub same: usize,
}

impl Count {
    /// Their total number.
    pub fn all(&self) -> usize {
        self.dimension - self.rank
    }
}

/// The result of the search.
#[derive(Default)]
pub(super) struct Casimirs {
    pub(super) list: Vec<Invariant>,
    /// One entry per size; a single entry if no size is named.
    pub(super) counts: Vec<Count>,
}

/// Points at which a Casimir is tested.
const POINTS: usize = 2;

/// A general point of the reduced space with the matrix of the bracket.
struct General<'a> {
    point: Point<'a>,
    matrix: Vec<Vec<u64>>,
}

/// The Casimirs.
pub(super) fn casimirs(x: &Inputs, equations: &[Expr], passages: &[RandomStep]) -> Casimirs {
    // Odd attempts use the largest size of a named dimension.
    let attempts = (0..ATTEMPTS).filter(|a| a % 2 == 1);
    let found = attempts.filter_map(|attempt| general(x, equations, attempt));
    let points: Vec<General> = found.take(POINTS).collect();
    let mut out = Casimirs::default();
    let Some(first) = points.first() else {
        return out;
    };
    let (dimension, size) = (first.matrix.len(), rank(&first.matrix));
    let mut differentials = Independent::default();
    for c in casimir_candidates::candidates(x, passages) {
        if differentials.len() == dimension - size {
            break;
        }
        debug_assert!(casimir_candidates::is_reduced(x, &c.value));
        // The cheapest test first, because most candidates fail it.
        if !passages.first().is_some_and(|p| p.keeps(&c.value)) {
            continue;
        }
        let Some(own) = differential(x, &first.point, &c.value) else {
            continue;
        };
        let annihilated = |g: &General, d: &[u64]| {
            let rows = g.matrix.iter();
            rows.into_iter()
                .all(|r| r.iter().zip(d).fold(0, |t, (a, b)| add(t, mul(*a, *b))) == 0)
        };
        let Some(fresh) = differentials.reduced(&own) else {
            continue;
        };
        let kept = annihilated(first, &own)
            && is_conserved(passages, &c.value)
            && points
                .iter()
                .skip(1)
                .all(|g| differential(x, &g.point, &c.value).is_some_and(|d| annihilated(g, &d)));
        if !kept {
            continue;
        }
        differentials.push(fresh);
        out.list.push(Invariant {
            reason: reason(x, &c.value).to_owned(),
            name: c.name,
            kind: Kind::Value,
            family: Family::Casimir,
            scale: Some(expr::magnitude(&x.letters.symbols, &c.value)),
            value: Some(c.value),
            exact: true,
        });
    }
    out.counts = match x.spec.dimensions.as_slice() {
        [] => vec![Count {
            size: None,
            dimension,
            rank: size,
            found: out.list.len(),
            same: 0,
        }],
        [one] => {
            let (from, to) = x.letters.symbols.sizes(Dim::Named(0));
            debug_assert!(from as u64 == one.from);
            let sizes = from..=to;
            sizes.filter_map(|n| count(x, equations, n, &out)).collect()
        }
        // Sizes that vary independently do not give a single list.
        _ => Vec::new(),
    };
    out
}

/// The number of Casimirs at one size, and the number of independent ones among those found.
fn count(x: &Inputs, equations: &[Expr], size: usize, found: &Casimirs) -> Option<Count> {
    let general = (0..ATTEMPTS).find_map(|attempt| {
        let point = assumed::point_of_size(&x.letters.symbols, attempt, equations, size)?;
        at_point(x, point)
    })?;
    let rows: Option<Vec<Vec<u64>>> = found
        .list
        .iter()
        .map(|v| differential(x, &general.point, v.value.as_ref()?))
        .collect();
    Some(Count {
        size: Some(size),
        dimension: general.matrix.len(),
        rank: rank(&general.matrix),
        found: rank(&rows?),
        same: 0,
    })
}

fn reason(x: &Inputs, value: &Expr) -> &'static str {
    let letters = expr::letters(value);
    let momentum = letters
        .iter()
        .any(|l| x.letters.node_momentum.contains(&l.symbol));
    let advected = letters
        .iter()
        .any(|l| x.spec.advected.iter().any(|a| a.quantity == l.symbol));
    match (momentum, advected) {
        (true, true) => "Casimir: the Kelvin-Noether quantity of the advected quantities",
        (true, false) => "Casimir: constant on coadjoint orbits",
        (false, _) => "Casimir: invariant under the group action",
    }
}

fn general<'a>(x: &Inputs<'a>, equations: &[Expr], attempt: u64) -> Option<General<'a>> {
    at_point(x, assumed::point(&x.letters.symbols, attempt, equations)?)
}

fn at_point<'a>(x: &Inputs<'a>, mut point: Point<'a>) -> Option<General<'a>> {
    for id in casimir_candidates::letters(x) {
        let value = point.letter(here(id))?;
        point.set(here(id), value);
    }
    let mut exact = Exact {
        point: point.clone(),
    };
    let matrix = x
        .bracket
        .assemble(x.spec, x.letters, Space::Reduced, &mut exact)?;
    Some(General { point, matrix })
}

/// The differential in the coordinates of the bracket.
fn differential(x: &Inputs, point: &Point, value: &Expr) -> Option<Vec<u64>> {
    let s = &x.letters.symbols;
    let mut out = Vec::new();
    for id in casimir_candidates::letters(x) {
        let tangents = tangents(point, here(id), s.get(id).structure)?;
        let gradient = match expr::contains(value, here(id)) {
            true => expr::gradient(s, value, here(id)),
            false => expr::integer(0),
        };
        if gradient.is_zero() {
            out.extend(tangents.iter().map(|_| 0));
            continue;
        }
        let g = point.value(&gradient)?;
        out.extend(tangents.iter().map(|t| g.pairing(t)));
    }
    Some(out)
}

/// Whether a function of the reduced space is independent of the Casimirs found.
pub(super) fn is_new(
    x: &Inputs,
    passages: &[RandomStep],
    found: &[Invariant],
    v: &Invariant,
) -> bool {
    let (Some(p), Some(value)) = (passages.first(), &v.value) else {
        return true;
    };
    let known = found.iter().filter(|f| f.family == Family::Casimir);
    let mut rows: Vec<Vec<u64>> = known
        .filter_map(|f| differential(x, &p.before, f.value.as_ref()?))
        .collect();
    let before = rank(&rows);
    rows.extend(differential(x, &p.before, value));
    rank(&rows) > before
}

/// Numbers of the exact field at a point.
struct Exact<'a> {
    point: Point<'a>,
}

impl Numbers for Exact<'_> {
    type Number = u64;

    fn zero(&self) -> u64 {
        0
    }

    fn opposite(&self, x: u64) -> u64 {
        negate(x)
    }

    fn dim(&self, d: Dim) -> usize {
        self.point.dim(d)
    }

    fn paired(&self, gradient: &[u64], cols: usize, e: &Element) -> u64 {
        paired(gradient, cols, e)
    }

    fn entries(&mut self, e: &Expr, with: &[(Letter, &Element)]) -> Option<Vec<u64>> {
        for (l, entries) in with {
            let shape = self.point.symbols().get(l.symbol).shape;
            let (rows, cols) = (self.dim(shape.rows), self.dim(shape.cols));
            let mut m = Matrix::zeros(rows, cols);
            for (i, j, x) in entries.iter() {
                m.data[i * cols + j] = if *x < 0 { negate(1) } else { 1 };
            }
            self.point.set(*l, m);
        }
        self.point.value(e).map(|m| m.data)
    }
}
