//! Noether momenta: combinations of the momenta of all configurations, from space and from the bodies,
//! that no step changes, or that change by a total difference. How many there are at fixed parameters
//! is a linear problem; they are then sought by what the parameters and the basis single out. That
//! each one is conserved is proved itself.

use super::difference;
use super::draws::Roots;
use super::kernel::{Kernel, Samples};
use super::motions::{Motion, Sort, Way, motions};
use super::passage::Passage;
use super::readings::{Reading, readings};
use super::told::{name, reason};
use super::{Family, Inputs, Invariant, Kind, is_conserved, length};
use crate::algebra::exact::Matrix;
use crate::derive::action::summands;
use crate::expr::shape::Shape;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr};
use std::collections::{BTreeMap, BTreeSet};

/// Most configurations whose momenta are combined one by one; of more, all that the action couples.
const FEW: usize = 4;

/// Most single numbers that are combined.
const NUMBERS: usize = 48;

/// The same of the model at hand: a lattice that is written out has more.
fn numbers() -> usize {
    NUMBERS.saturating_mul(usize::try_from(crate::work::times()).unwrap_or(1))
}

/// Sets of configurations that the action couples, in order of declaration.
pub(super) fn components(x: &Inputs) -> Vec<Vec<usize>> {
    let count = x.spec.configurations.len();
    let mut of: Vec<usize> = (0..count).collect();
    let touched = touched(x);
    for term in summands(&x.action.total) {
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

/// For each symbol the configurations that move it: its own, or those that its constraint names.
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

/// Momenta as seen from space, then those that bodies have a part in.
pub(super) fn momenta(
    x: &Inputs,
    roots: &Roots,
    passages: &[Passage],
) -> (Vec<Invariant>, Vec<Invariant>) {
    if passages.is_empty() {
        return (Vec::new(), Vec::new());
    }
    let motions = motions(x);
    let kernels = kernels(x, roots, &motions);
    if !kernels.is_empty() && kernels.iter().all(|k| k.dimension == 0) {
        return (Vec::new(), Vec::new());
    }
    let mut sorts: Vec<Sort> = Vec::new();
    for m in &motions {
        if !sorts.contains(&m.sort) {
            sorts.push(m.sort);
        }
    }
    let readings = readings(x, &sorts);
    let mut search = Search {
        x,
        passages,
        motions: &motions,
        readings: &readings,
        spanned: vec![0; kernels.len()],
        kernels: &kernels,
        found: Vec::new(),
        sets: match x.spec.configurations.len() > FEW {
            true => components(x),
            false => Vec::new(),
        },
        wholes: Vec::new(),
    };
    search.of_one_reading(&mut Samples::of_steps(x, roots, passages));
    if !kernels.is_empty() && !search.is_complete() {
        let mut samples = Samples::of_differences(x, roots);
        search.of_one_reading(&mut samples);
        search.of_several_readings(&mut samples);
        search.prune();
    }
    let (space, others): (Vec<_>, Vec<_>) = search.found.into_iter().partition(|(space, _)| *space);
    let only = |list: Vec<(bool, Invariant)>| list.into_iter().map(|(_, v)| v).collect();
    (only(space), only(others))
}

/// The symmetries at fixed parameters; with assumptions at several, whose branches take turns.
fn kernels<'a>(x: &Inputs<'a>, roots: &Roots, motions: &[Motion]) -> Vec<Kernel<'a>> {
    let wanted = if x.assumed.is_empty() { 1 } else { 3 };
    // Even attempts take the smallest size where it has only a name.
    let attempts = (0..20).map(|turn| 2 * turn);
    let found = attempts.filter_map(|attempt| Kernel::new(x, roots, motions, attempt));
    found.take(wanted).collect()
}

/// What a reading gives of a motion, so many times.
#[derive(Clone, Copy)]
pub(super) struct Term<'s> {
    pub(super) reading: &'s Reading,
    pub(super) motion: &'s Motion,
    pub(super) times: i64,
}

struct Search<'a, 's> {
    x: &'s Inputs<'a>,
    passages: &'s [Passage<'a>],
    motions: &'s [Motion],
    readings: &'s [Reading],
    kernels: &'s [Kernel<'a>],
    /// Each with whether it is one of space alone.
    found: Vec<(bool, Invariant)>,
    /// How many are independent at the parameters of each kernel.
    spanned: Vec<usize>,
    /// Sets of configurations that the action couples, where there are many.
    sets: Vec<Vec<usize>>,
    /// Motions whose whole momentum has been found.
    wholes: Vec<(usize, Way, Sort)>,
}

impl<'a, 's> Search<'a, 's> {
    /// Whether the whole of it is known to be conserved, so that its parts are: with a count of all
    /// that there are, that says it.
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

    /// Motions of a sort that may be combined, each by itself; of many configurations those that the
    /// action couples, each set for itself and its members added. A turn about a place or about its
    /// own origin is one of the others of the set too, which have no place.
    fn columns(&self, sort: Sort) -> Vec<Vec<Vec<&'s Motion>>> {
        let own = || self.motions.iter().filter(|m| m.sort == sort);
        if self.sets.is_empty() {
            return vec![own().map(|m| vec![m]).collect()];
        }
        let mut out: Vec<Vec<Vec<&Motion>>> = vec![Vec::new(); self.sets.len()];
        for m in own() {
            let set = self.sets.iter().position(|s| s.contains(&m.configuration));
            let Some(columns) = set.and_then(|i| out.get_mut(i)) else {
                continue;
            };
            match columns.iter_mut().find(|list| list[0].way == m.way) {
                Some(list) => list.push(m),
                None => columns.push(vec![m]),
            }
        }
        for (columns, set) in out.iter_mut().zip(&self.sets) {
            let whole: Vec<Vec<&Motion>> = columns
                .iter()
                .filter(|list| matches!(list[0].way, Way::Spin | Way::About(_)))
                .filter_map(|list| {
                    let missing = |m: &&Motion| {
                        m.way == Way::Space
                            && set.contains(&m.configuration)
                            && list.iter().all(|l| l.configuration != m.configuration)
                    };
                    let rest: Vec<&Motion> = own().filter(missing).collect();
                    (!rest.is_empty()).then(|| [list.clone(), rest].concat())
                })
                .collect();
            columns.extend(whole);
        }
        out
    }

    /// Takes out what vanishes and what is the same as one before: a moment about a place, read along
    /// the axis through it.
    fn distinct(
        &self,
        columns: Vec<Vec<&'s Motion>>,
        reading: &'s Reading,
    ) -> Vec<Vec<&'s Motion>> {
        let placed = |c: &Vec<&Motion>| c.iter().any(|m| matches!(m.way, Way::About(_)));
        if !columns.iter().any(placed) {
            return columns;
        }
        let mut known: Vec<Vec<Matrix>> = Vec::new();
        let fresh = |c: &Vec<&'s Motion>| {
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

    /// Combinations of one reading of several motions.
    fn of_one_reading(&mut self, samples: &mut Samples) {
        for reading in self.readings {
            if self.is_complete() {
                return;
            }
            for mut columns in self.columns(reading.sort) {
                columns.retain(|c| !self.is_covered(c));
                let columns = self.distinct(columns, reading);
                let values: Vec<Expr> = columns.iter().map(|c| self.value(reading, c)).collect();
                let mut combinations = samples.combinations(&values);
                // Of those that say the same that of the fewest motions is told.
                combinations.sort_by_key(|v| v.iter().filter(|times| **times != 0).count());
                for v in combinations {
                    let terms = columns.iter().zip(&v).filter(|(_, times)| **times != 0);
                    let terms = terms.flat_map(|(c, times)| {
                        c.iter().map(|motion| Term {
                            reading,
                            motion,
                            times: *times,
                        })
                    });
                    self.accept(&terms.collect::<Vec<_>>());
                }
            }
        }
    }

    /// Combinations of numbers that several readings give.
    fn of_several_readings(&mut self, samples: &mut Samples) {
        if self.is_complete() {
            return;
        }
        let mut terms: Vec<Vec<Term>> = Vec::new();
        for reading in self.readings.iter().filter(|r| r.is_number()) {
            for column in self.columns(reading.sort).into_iter().flatten() {
                if column.iter().any(|m| m.spanned) || terms.len() >= numbers() {
                    continue;
                }
                let term = |motion| Term {
                    reading,
                    motion,
                    times: 1,
                };
                terms.push(column.into_iter().map(term).collect());
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

    /// Takes out what the others span: a part that was found before the whole.
    fn prune(&mut self) {
        let mut i = 0;
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

    fn value(&self, reading: &'s Reading, column: &[&'s Motion]) -> Expr {
        let terms: Vec<Term> = column
            .iter()
            .map(|motion| Term {
                reading,
                motion,
                times: 1,
            })
            .collect();
        sum(self.x, &terms)
    }

    /// Adds an invariant if it is one, and if those before do not span it.
    fn accept(&mut self, terms: &[Term]) {
        let x = self.x;
        let mut value = sum(x, terms);
        let nothing = |p: &Passage| p.before.value(&value).is_none_or(|v| v.vanishes());
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

/// What the readings give of something that each motion has.
pub(super) fn combined(x: &Inputs, terms: &[Term], of: impl Fn(&Motion) -> Expr) -> Expr {
    // Readings are linear: of what one reads, the sum is taken first, terms that motions share once.
    let mut groups: Vec<(&Reading, Vec<(Expr, i64)>)> = Vec::new();
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

/// Sizes of the terms, component by component, of whole momenta that have them.
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
