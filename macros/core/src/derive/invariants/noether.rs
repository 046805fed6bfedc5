//! Noether momenta: combinations of the momenta of all configurations, in space and in the bodies, that no step
//! changes, or that change by a total difference. Their number at fixed parameters is a linear problem. The search
//! then uses the directions of the parameters and of the basis, and each result is proved to be conserved.

use super::columns::{Column, Columns};
use super::difference;
use super::draws::Roots;
use super::kernel::{Kernel, Samples};
use super::momentum_components::{MomentumComponent, momentum_components};
use super::motions::{Motion, Sort, Way, motions};
use super::noether_description::{name, reason};
use super::random_step::RandomStep;
use super::{Family, Inputs, Invariant, Kind, is_conserved, length};
use crate::algebra::exact::Matrix;
use crate::derive::action::summands;
use crate::expr::shape::Shape;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr};
use std::collections::{BTreeMap, BTreeSet};

/// The largest number of single scalars that are combined.
const NUMBERS: usize = 48;

/// The limit for this model: an expanded chain has a larger one.
fn numbers() -> usize {
    NUMBERS.saturating_mul(usize::try_from(crate::work::times()).unwrap_or(1))
}

/// Sets of configurations that the action or a constraint couples, in order of declaration.
pub(super) fn components(x: &Inputs) -> Vec<Vec<usize>> {
    let count = x.spec.configurations.len();
    let mut of: Vec<usize> = (0..count).collect();
    let touched = touched(x);
    // A constraint force couples all configurations in its constraint, in whatever terms they occur.
    let held = x.spec.holds.iter().map(|h| h.value.clone());
    for term in summands(&x.letters.symbols, &x.action.total)
        .into_iter()
        .chain(held)
    {
        let letters = expr::letters(&term);
        let met: BTreeSet<usize> = letters
            .iter()
            .filter_map(|l| touched.get(&l.symbol))
            .flatten()
            .copied()
            .collect();
        if let Some(first) = met.first().map(|i| of[*i]) {
            let joined: BTreeSet<usize> = met.iter().map(|i| of[*i]).collect();
            if joined.len() > 1 {
                let touched = of.iter_mut().filter(|o| joined.contains(o));
                touched.for_each(|o| *o = first);
            }
        }
    }
    let mut out: Vec<Vec<usize>> = Vec::new();
    for i in 0..count {
        match out.iter_mut().find(|set| of[set[0]] == of[i]) {
            Some(set) => set.push(i),
            None => out.push(vec![i]),
        }
    }
    out
}

/// For each symbol, the configurations that move it: its own configuration, or the configurations in its constraint.
fn touched(x: &Inputs) -> BTreeMap<SymbolId, Vec<usize>> {
    let mut out: BTreeMap<SymbolId, Vec<usize>> = BTreeMap::new();
    for (i, c) in x.spec.configurations.iter().enumerate() {
        out.insert(c.element, vec![i]);
        out.insert(c.velocity, vec![i]);
    }
    let advected = x.spec.advected.iter().map(|a| {
        let letters = expr::letters(&a.update);
        let moved = letters.iter().filter_map(|l| out.get(&l.symbol));
        (a.quantity, moved.flatten().copied().collect())
    });
    let advected: Vec<(SymbolId, Vec<usize>)> = advected.collect();
    out.extend(advected);
    out
}

/// Noether momenta.
#[derive(Default)]
pub(super) struct Momenta {
    /// The invariants of single sites of a chain, and of single bodies without constraint forces.
    pub(super) of_sites: Vec<Invariant>,
    /// The invariants in space.
    pub(super) space: Vec<Invariant>,
    /// The invariants that involve the body frame.
    pub(super) body: Vec<Invariant>,
}

/// All that are found.
pub(super) fn momenta(x: &Inputs, roots: &Roots, passages: &[RandomStep]) -> Momenta {
    if passages.is_empty() {
        return Momenta::default();
    }
    let motions = motions(x);
    let columns = Columns::new(x, &motions, passages);
    let kernels = kernels(x, roots, &columns);
    if !kernels.is_empty() && kernels.iter().all(|k| k.dimension == 0) {
        return Momenta::default();
    }
    let readings = momentum_components(x, &columns.sorts());
    let mut search = Search {
        x,
        passages,
        columns: &columns,
        readings: &readings,
        spanned: vec![0; kernels.len()],
        kernels: &kernels,
        found: Vec::new(),
        of_sites: 0,
        wholes: Vec::new(),
    };
    let mut steps = Samples::of_steps(x, roots, passages);
    search.of_every_site();
    search.of_one_reading(&mut steps);
    if !kernels.is_empty() && !search.is_complete() {
        let mut samples = Samples::of_differences(x, roots);
        search.of_one_reading(&mut samples);
        search.of_several_readings(&mut samples);
        search.prune();
    }
    let only = |list: Vec<(bool, Invariant)>| list.into_iter().map(|(_, v)| v).collect();
    let rest = search.found.split_off(search.of_sites);
    let (space, body) = rest.into_iter().partition(|(space, _)| *space);
    Momenta {
        of_sites: only(search.found),
        space: only(space),
        body: only(body),
    }
}

/// The symmetries at fixed parameters; with assumptions, at several points, whose branches alternate.
fn kernels<'a>(x: &Inputs<'a>, roots: &Roots, columns: &Columns) -> Vec<Kernel<'a>> {
    let wanted = if x.assumed.is_empty() { 1 } else { 3 };
    // Even attempts use the smallest size of a named dimension.
    let attempts = (0..20).map(|turn| 2 * turn);
    let found = attempts.filter_map(|attempt| Kernel::new(x, roots, columns, attempt));
    found.take(wanted).collect()
}

/// A component of the momentum of a motion, with an integer coefficient.
#[derive(Clone, Copy)]
pub(super) struct Term<'s> {
    pub(super) reading: &'s MomentumComponent,
    pub(super) motion: &'s Motion,
    pub(super) times: i64,
}

struct Search<'a, 's> {
    x: &'s Inputs<'a>,
    passages: &'s [RandomStep<'a>],
    columns: &'s Columns<'s>,
    readings: &'s [MomentumComponent],
    kernels: &'s [Kernel<'a>],
    /// Each invariant, with whether it involves space only.
    found: Vec<(bool, Invariant)>,
    /// The number of independent ones at the parameters of each kernel.
    spanned: Vec<usize>,
    /// The number of invariants of single sites or bodies, which come first.
    of_sites: usize,
    /// Motions whose whole momentum has been found.
    wholes: Vec<(usize, Way, Sort)>,
}

impl<'a, 's> Search<'a, 's> {
    /// Whether the whole momentum is known to be conserved, so that its parts are. If all symmetries are counted, the
    /// count decides this.
    fn is_covered(&self, column: &[&Motion]) -> bool {
        let whole = |m: &Motion| {
            self.wholes.iter().any(|(i, way, sort)| {
                let same = *sort == m.sort || matches!(sort, Sort::Rigid(_));
                (*i, *way) == (m.configuration, m.way) && same
            })
        };
        self.kernels.is_empty() && column.iter().all(|m| whole(m))
    }

    fn is_complete(&self) -> bool {
        let all = self.kernels.iter().zip(&self.spanned);
        !self.kernels.is_empty() && all.into_iter().all(|(k, n)| *n >= k.dimension)
    }

    /// Removes columns that vanish or repeat an earlier column, such as a moment about a position, projected on the
    /// axis through it.
    fn distinct(
        &self,
        columns: Vec<Column<'s>>,
        reading: &'s MomentumComponent,
    ) -> Vec<Column<'s>> {
        let placed = |c: &Column| c.iter().any(|m| matches!(m.way, Way::About(_)));
        if !columns.iter().any(placed) {
            return columns;
        }
        let mut known: Vec<Vec<Matrix>> = Vec::new();
        let fresh = |c: &Column<'s>| {
            let value = self.value(reading, c);
            let at = self.passages.iter().map(|p| p.before.value(&value));
            let Some(at) = at.collect::<Option<Vec<Matrix>>>() else {
                return true;
            };
            let new = at.iter().any(|m| !m.vanishes()) && !known.contains(&at);
            known.push(at);
            new
        };
        columns.into_iter().filter(fresh).collect()
    }

    /// Finds the momenta that every single site of a chain conserves, before any sum over sites that is a combination
    /// of these.
    fn of_every_site(&mut self) {
        for reading in self.readings {
            for column in self.columns.of_every_site(reading.sort) {
                let terms = terms_of(reading, column, 1);
                // Total differences are not used here.
                let strict = || is_conserved(self.passages, &sum(self.x, &terms));
                if !self.is_covered(column) && strict() {
                    self.accept(&terms);
                }
            }
        }
        self.of_sites = self.found.len();
    }

    /// Combinations of one component of several motions.
    fn of_one_reading(&mut self, samples: &mut Samples) {
        for reading in self.readings {
            if self.is_complete() {
                return;
            }
            for columns in self.columns.of_sort(reading.sort) {
                let uncovered = columns.iter().filter(|c| !self.is_covered(c));
                self.combine(uncovered.cloned().collect(), reading, samples);
            }
        }
    }

    /// Combinations of one component of these motions.
    fn combine(
        &mut self,
        columns: Vec<Column<'s>>,
        reading: &'s MomentumComponent,
        samples: &mut Samples,
    ) {
        let columns = self.distinct(columns, reading);
        let values: Vec<Expr> = columns.iter().map(|c| self.value(reading, c)).collect();
        let mut combinations = samples.combinations(&values);
        // Among combinations that are equivalent, the one with the fewest motions is reported, and among these the one
        // about the origin.
        combinations.sort_by_key(|v| {
            let taken = columns.iter().zip(v).filter(|(_, times)| **times != 0);
            let motions = taken.flat_map(|(c, _)| c.iter());
            let about = |m: &&&Motion| matches!(m.way, Way::About(_));
            (motions.clone().count(), motions.filter(about).count())
        });
        for v in combinations {
            let terms = columns.iter().zip(&v).filter(|(_, times)| **times != 0);
            let terms = terms.flat_map(|(c, times)| terms_of(reading, c, *times));
            self.accept(&terms.collect::<Vec<_>>());
        }
    }

    /// Combinations of scalars from several components.
    fn of_several_readings(&mut self, samples: &mut Samples) {
        if self.is_complete() {
            return;
        }
        let mut terms: Vec<Vec<Term>> = Vec::new();
        for reading in self.readings.iter().filter(|r| r.is_number()) {
            for column in self.columns.of_sort(reading.sort).iter().flatten() {
                if column.iter().any(|m| m.spanned) || terms.len() >= numbers() {
                    continue;
                }
                terms.push(terms_of(reading, column, 1));
            }
        }
        let values: Vec<Expr> = terms.iter().map(|list| sum(self.x, list)).collect();
        for v in samples.combinations(&values) {
            if self.is_complete() {
                return;
            }
            let list = terms.iter().zip(&v).filter(|(_, times)| **times != 0);
            let list = list.flat_map(|(list, times)| {
                list.iter().map(|t| Term {
                    times: *times,
                    ..*t
                })
            });
            self.accept(&list.collect::<Vec<_>>());
        }
    }

    /// Removes invariants that the others span: a part that was found before the whole.
    fn prune(&mut self) {
        let mut i = self.of_sites;
        while i < self.found.len() {
            let others = |k: &Kernel| {
                let list = self.found.iter().enumerate().filter(|(j, _)| *j != i);
                k.spanned(list.filter_map(|(_, (_, v))| v.value.as_ref()))
            };
            let all = self.kernels.iter().zip(&self.spanned);
            if all.into_iter().all(|(k, n)| others(k) == *n) {
                self.found.remove(i);
            } else {
                i += 1;
            }
        }
    }

    fn value(&self, reading: &'s MomentumComponent, column: &[&'s Motion]) -> Expr {
        sum(self.x, &terms_of(reading, column, 1))
    }

    /// Adds a combination if it is conserved and the previous ones do not span it.
    fn accept(&mut self, terms: &[Term]) {
        let x = self.x;
        let mut value = sum(x, terms);
        let nothing = |p: &RandomStep| p.before.value(&value).is_none_or(|v| v.vanishes());
        if self.passages.iter().all(nothing) {
            return;
        }
        let (mut size, each) = (scale(terms), scales(terms));
        let strict = is_conserved(self.passages, &value);
        if !strict {
            let Some(d) = difference::difference(x, self.passages, terms) else {
                return;
            };
            let parts = summands_of(&d).into_iter().map(|t| length(x, &t));
            size = expr::sum(parts.chain([size]), Shape::SCALAR);
            value = expr::sub(value, d);
            if !is_conserved(self.passages, &value) {
                return;
            }
        }
        if !self.kernels.is_empty() {
            let all = self.kernels.iter().map(|k| {
                let before = self.found.iter().filter_map(|(_, v)| v.value.as_ref());
                k.spanned(before.chain([&value]))
            });
            let spanned: Vec<usize> = all.collect();
            if spanned
                .iter()
                .zip(&self.spanned)
                .all(|(new, old)| new <= old)
            {
                return;
            }
            self.spanned = spanned;
        }
        let kind = if strict { kind(x, terms) } else { Kind::Value };
        let space = terms
            .iter()
            .all(|t| matches!(t.motion.way, Way::Space | Way::About(_)));
        let invariant = Invariant {
            name: name(x, terms),
            kind,
            family: Family::Noether,
            value: Some(value),
            scale: each.filter(|_| strict).or(Some(size)),
            exact: true,
            reason: reason(x, terms, strict),
        };
        if terms.iter().all(|t| t.reading.is_whole()) && is_whole(x, terms) {
            let moved = terms
                .iter()
                .map(|t| (t.motion.configuration, t.motion.way, t.motion.sort));
            self.wholes.extend(moved);
        }
        self.found.push((space, invariant));
    }
}

/// One term for each motion of a column, with this component and coefficient.
fn terms_of<'s>(
    reading: &'s MomentumComponent,
    column: &[&'s Motion],
    times: i64,
) -> Vec<Term<'s>> {
    let term = |motion: &&'s Motion| Term {
        reading,
        motion,
        times,
    };
    column.iter().map(term).collect()
}

fn summands_of(e: &Expr) -> Vec<Expr> {
    match e.node() {
        expr::Node::Sum(list) => list.clone(),
        _ => vec![e.clone()],
    }
}

/// The value of a combination.
fn sum(x: &Inputs, terms: &[Term]) -> Expr {
    combined(x, terms, |m| m.value.clone())
}

/// The sum over the terms of their component of `of(motion)`.
pub(super) fn combined(x: &Inputs, terms: &[Term], of: impl Fn(&Motion) -> Expr) -> Expr {
    // The components are linear: values that share a component are summed first, so that common terms occur once.
    let mut groups: Vec<(&MomentumComponent, Vec<(Expr, i64)>)> = Vec::new();
    for t in terms {
        let at = groups
            .iter()
            .position(|(r, _)| core::ptr::eq(*r, t.reading));
        let at = at.unwrap_or_else(|| {
            groups.push((t.reading, Vec::new()));
            groups.len() - 1
        });
        let list = &mut groups[at].1;
        for part in summands_of(&of(t.motion)) {
            match list.iter_mut().find(|(known, _)| *known == part) {
                Some((_, times)) => *times += t.times,
                None => list.push((part, t.times)),
            }
        }
    }
    let parts: Vec<Expr> = groups
        .into_iter()
        .map(|(reading, list)| {
            let shape = list.first().map_or(Shape::SCALAR, |(e, _)| e.shape());
            let left = list.into_iter().filter(|(_, times)| *times != 0);
            let scaled =
                left.map(|(e, times)| expr::scale(crate::algebra::Rational::integer(times), e));
            reading.of(x, &expr::sum(scaled.collect::<Vec<_>>(), shape))
        })
        .collect();
    let shape = parts.first().map_or(Shape::SCALAR, Expr::shape);
    expr::sum(parts, shape)
}

/// Sizes of the terms by components, for whole momenta that have them.
fn scales(terms: &[Term]) -> Option<Expr> {
    let parts = terms.iter().map(|t| {
        let own = t.motion.scales.clone().filter(|_| t.reading.is_whole())?;
        let times = crate::algebra::Rational::integer(t.times.abs());
        Some(expr::scale(times, own))
    });
    let parts: Vec<Expr> = parts.collect::<Option<_>>()?;
    let shape = parts.first()?.shape();
    Some(expr::sum(parts, shape))
}

/// The size of the terms, one for all components.
fn scale(terms: &[Term]) -> Expr {
    let parts = terms.iter().map(|t| {
        let times = crate::algebra::Rational::integer(t.times.abs());
        let size = expr::mul(t.motion.scale.clone(), t.reading.size.clone());
        expr::scale(times, size)
    });
    expr::sum(parts, Shape::SCALAR)
}

/// Whether the terms are whole momenta of their groups.
pub(super) fn is_whole(x: &Inputs, terms: &[Term]) -> bool {
    terms.iter().all(|t| {
        let group = x.spec.configurations[t.motion.configuration].group;
        let natural = match t.motion.sort {
            Sort::Rigid(_) => true,
            Sort::Planes(_) => group.is_orthogonal(),
            Sort::Affine(_) => !group.is_additive(),
            Sort::Entries(_) | Sort::Shifts(_) => group.rigid().is_none(),
            Sort::Angular => group.only_turns(),
            Sort::Linear => group.is_additive(),
            Sort::Mixed => false,
        };
        natural && t.reading.is_whole()
    })
}

pub(super) fn configurations(terms: &[Term]) -> Vec<usize> {
    let mut out: Vec<usize> = terms.iter().map(|t| t.motion.configuration).collect();
    out.sort_unstable();
    out.dedup();
    out
}

fn kind(x: &Inputs, terms: &[Term]) -> Kind {
    let set = configurations(terms);
    let group = |i: usize| x.spec.configurations[i].group;
    let alike = set.windows(2).all(|w| group(w[0]) == group(w[1]));
    let plain = terms
        .iter()
        .all(|t| t.times == 1 && t.motion.way == Way::Space);
    if !alike || !plain || !is_whole(x, terms) || set.len() != terms.len() {
        return Kind::Value;
    }
    match (set.as_slice(), x.spec.configurations.as_slice()) {
        ([only], [_]) => Kind::SpatialMomentum(*only),
        _ => Kind::TotalMomentum(set),
    }
}
