//! Conserved totals of a chain: sums over sites of one density, the same at every site that no end condition
//! prescribes. The density may contain prescribed positions. clebsch finds totals on the expanded chain.

use super::site::BASE;
use super::{FunctionalForce, Refused, RepresentativeChain, SiteModel};
use crate::algebra::Algebra;
use crate::derive::Derivation;
use crate::derive::invariants::{Family, Invariant};
use crate::document::default_choice;
use crate::expr::shape::Shape;
use crate::expr::symbol::{Role, Symbols};
use crate::expr::{self, Expr, Letter, Node, Shift};
use crate::lattice::{
    ChainConfig, ExpandedModel, FunctionalKind, Lattice, Mesh, Sites, Source, holds_sums,
};
use crate::pipeline;
use crate::print::{Format, Style, expression};
use crate::syntax::ast::Model;
use std::collections::{BTreeMap, BTreeSet};

/// A density, summed over the sites of one kind.
#[derive(Clone, Debug)]
pub struct Density {
    /// The label of the sites.
    pub label: usize,
    /// The kind of its sites.
    pub sites: Sites,
    /// The number of sites that end conditions prescribe, at the first and at the last end. The sum omits them.
    pub left_out: [usize; 2],
    /// The summand, with its letters at the base of the representative.
    pub value: Expr,
}

/// A conserved total.
#[derive(Clone, Debug)]
pub struct Total {
    /// Its name.
    pub name: String,
    /// Why it is conserved.
    pub reason: String,
    /// The chains on which it is conserved.
    pub on: String,
    /// The densities.
    pub densities: Vec<Density>,
    /// The letters that an end condition prescribes, each with whether it is the last end.
    pub places: Vec<(Letter, bool)>,
    /// The alternatives at the first and at the last end that prescribe the same configurations as in the search.
    pub ends: [Vec<usize>; 2],
}

impl Total {
    /// The shape of the sum.
    pub fn shape(&self) -> Shape {
        let first = self.densities.first();
        first.map_or(Shape::SCALAR, |d| d.value.shape())
    }

    /// The densities as text, which identifies equal totals of different chains; letters belong to `part`.
    pub fn text(&self, part: &RepresentativeChain) -> String {
        let style = Style::new(&part.d.spec.time_index);
        let each = self.densities.iter().map(|density| {
            let (label, sites, e) = (density.label, density.sites, &density.value);
            let [first, last] = density.left_out;
            // With names that are equal on every chain of the model.
            let mut s = part.d.letters.symbols.clone();
            let place = |l: &Letter| self.places.iter().find(|(own, _)| own == l);
            let name = |l: &Letter| match (part.sited(l.symbol), place(l)) {
                (Some(at), Some((_, false))) => format!("{} at the first end", at.of),
                (Some(at), Some((_, true))) => format!("{} at the last end", at.of),
                (Some(at), None) => format!("{} at {}", at.of, at.site),
                (None, _) => part.d.letters.symbols.get(l.symbol).name.clone(),
            };
            let letters = expr::letters(e).into_iter();
            let mut letters: Vec<(String, Letter)> = letters.map(|l| (name(&l), l)).collect();
            letters.sort_by(|a, b| a.0.cmp(&b.0));
            let renamed: Vec<(Letter, Expr)> = letters
                .into_iter()
                .map(|(name, l)| {
                    let own = s.get(l.symbol).clone();
                    let role = match place(&l) {
                        Some(_) => Role::Parameter,
                        None => own.role,
                    };
                    let id = s.add(&name, own.shape, own.structure, role);
                    (l, expr::letter(&s, id, l.shift))
                })
                .collect();
            let e = expr::substitute(&s, e, &renamed);
            let density = expression(&e, &s, &style, Format::Text);
            format!("{label} {sites:?} {first} {last} {density}")
        });
        each.collect::<Vec<_>>().join("; ")
    }
}

/// The totals on the default chain of a case, a ring if `periodic` is the only choice, else with the first end
/// conditions; then the totals on chains whose ends prescribe other configurations.
pub(super) fn totals(
    model: &Model,
    lattice: &Lattice,
    part: &RepresentativeChain,
) -> Result<Vec<Total>, Refused> {
    let written = |choice: ChainConfig| -> Result<Vec<Total>, Refused> {
        let (unfolded, d) = pipeline::derive_lattice(model, lattice, &choice)?;
        let whole = RepresentativeChain {
            choice,
            unfolded,
            d: d.outline(),
        };
        Ok(of_part(lattice, &whole, &d.invariants, part))
    };
    let on = |choice: ChainConfig| -> Result<Vec<Total>, Refused> {
        let own = written(choice.clone())?;
        // A constraint on a sum may introduce the number of sites into a total, which then differs on a longer chain.
        match lattice
            .line
            .filter(|_| holds_sums(model) && !own.is_empty())
        {
            None => Ok(own),
            Some(line) => {
                let there = written(longer(choice, line))?;
                let texts: BTreeSet<String> = there.iter().map(|t| t.text(part)).collect();
                Ok(own
                    .into_iter()
                    .filter(|t| texts.contains(&t.text(part)))
                    .collect())
            }
        }
    };
    let choice = default_choice(lattice, part.choice.clone());
    let mut all = on(choice.clone())?;
    for other in holding_others(lattice, &choice) {
        // Errors of other end conditions are reported if a case selects these.
        for total in on(other).unwrap_or_default() {
            let text = total.text(part);
            let mut alike = all.iter().filter(|t| t.name == total.name);
            // Each name has one function.
            if alike.all(|t| t.shape() == total.shape() && t.text(part) != text) {
                all.push(total);
            }
        }
    }
    Ok(all)
}

/// These end conditions with more sites; the number of sites of a ring stays odd.
fn longer(mut choice: ChainConfig, line: usize) -> ChainConfig {
    if let Some(count) = choice.counts.get_mut(line) {
        *count += if choice.periodic { 2 } else { 1 };
    }
    choice
}

/// For each other set of prescribed configurations, the choice of ends that adds the fewest terms.
fn holding_others(lattice: &Lattice, choice: &ChainConfig) -> Vec<ChainConfig> {
    if choice.periodic {
        return Vec::new();
    }
    let kinds = |last: bool| -> Vec<(BTreeSet<&str>, usize)> {
        let own = choice.ends[usize::from(last)];
        let list = &lattice.ends[usize::from(last)];
        let mut out: BTreeMap<BTreeSet<&str>, usize> = BTreeMap::new();
        let terms = |i: usize| list.get(i).map_or(0, |a| a.terms.len());
        for (i, a) in list.iter().enumerate() {
            let given = a.given.iter().map(|n| n.text.as_str()).collect();
            let known = out.entry(given).or_insert(i);
            if i == own || *known != own && terms(i) < terms(*known) {
                *known = i;
            }
        }
        match out.is_empty() {
            true => vec![(BTreeSet::new(), own)],
            false => out.into_iter().collect(),
        }
    };
    let lasts = kinds(true);
    let each = kinds(false).into_iter().flat_map(|(held_first, first)| {
        let each = lasts.iter().filter_map(move |(held_last, last)| {
            let ends = [first, *last];
            let none = held_first.is_empty() && held_last.is_empty();
            (!none && ends != choice.ends).then(|| ChainConfig {
                ends,
                ..choice.clone()
            })
        });
        each.collect::<Vec<_>>()
    });
    each.collect()
}

/// The end conditions that prescribe the same configurations as the chosen ones.
fn holding_alike(lattice: &Lattice, choice: &ChainConfig) -> [Vec<usize>; 2] {
    [0, 1].map(|end| {
        let given = |i: usize| -> BTreeSet<&str> {
            let own = lattice.ends[end].get(i).into_iter();
            own.flat_map(|a| a.given.iter().map(|n| n.text.as_str()))
                .collect()
        };
        let all = 0..lattice.ends[end].len();
        all.filter(|i| given(*i) == given(choice.ends[end]))
            .collect()
    })
}

/// Totals that functionals of all sites do not change: totals of single sites in which every momentum that
/// functionals change has a constant factor. A functional that is invariant under equal shifts of all positions
/// adds nothing to such a sum; the step combines the steps of single sites with these contributions.
pub(super) fn beside_functionals(
    lattice: &Lattice,
    part: &RepresentativeChain,
    lone: &[SiteModel],
    meshed: &FunctionalForce,
) -> Vec<Total> {
    let mut out = Vec::new();
    for one in lone {
        let s = &one.d.letters.symbols;
        for v in one.d.invariants.iter().filter(|v| v.exact) {
            let Some(value) = &v.value else { continue };
            let kept = one.movers.iter().all(|m| {
                let momentum = Letter {
                    symbol: one.d.letters.node_momentum[m.index],
                    shift: Shift::HERE,
                };
                let changed = meshed.forces.iter().any(|f| f.on == m.name);
                !expr::contains(value, momentum)
                    || !changed
                    || (is_pushed_evenly(lattice, part, meshed, &m.name)
                        && has_constant_factor(s, value, momentum))
            });
            let moved = kept.then(|| part.of_site(one, value, 0)).flatten();
            let Some(density) = moved else { continue };
            out.push(Total {
                name: v.name.clone(),
                reason: v.reason.clone(),
                on: "always".to_owned(),
                densities: vec![Density {
                    label: one.label,
                    sites: one.sites,
                    left_out: [0, 0],
                    value: density,
                }],
                places: Vec::new(),
                ends: Default::default(),
            });
        }
    }
    out
}

/// Gives totals of equal names different names, by the labels of their sites.
pub(super) fn name_apart(lattice: &Lattice, totals: &mut [Total]) {
    for i in 1..totals.len() {
        let (before, rest) = totals.split_at_mut(i);
        let Some(own) = rest.first_mut() else { break };
        // This total applies to chains with other prescribed ends.
        let is_other = |t: &Total| t.name == own.name && t.ends == own.ends;
        if !before.iter().any(is_other) {
            continue;
        }
        let label = own
            .densities
            .first()
            .and_then(|d| lattice.labels.get(d.label));
        let label = label.map_or_else(String::new, |l| crate::expr::symbol::ascii(&l.index.text));
        let mut name = format!("{}_{label}", own.name);
        while before.iter().any(|t| t.name == name) {
            name.push('_');
        }
        own.name = name;
    }
}

/// Whether the forces of functionals on this field sum to zero: these functionals are invariant under equal shifts,
/// and no term contains a position itself.
fn is_pushed_evenly(
    lattice: &Lattice,
    part: &RepresentativeChain,
    meshed: &FunctionalForce,
    field: &str,
) -> bool {
    let of_field = |m: &Mesh| m.of == Source::Field(field.to_owned());
    let even = lattice
        .meshes
        .iter()
        .filter(|m| of_field(m))
        .all(|m| m.kind == FunctionalKind::Cells);
    let through = |e: &Expr| {
        let mut all = Vec::new();
        outside(&part.d.letters.symbols, e, &mut all);
        all
    };
    let place = part.copy(field, 0);
    let named = |l: &Letter| Some(l.symbol) == place;
    even && !meshed
        .terms
        .iter()
        .any(|(_, e)| through(e).iter().any(named))
}

/// The letters of an expression outside functionals of all sites.
fn outside(s: &Symbols, e: &Expr, out: &mut Vec<Letter>) {
    match e.node() {
        Node::Letter(l) => out.push(*l),
        Node::Given(a) | Node::PullBack(a, ..)
            if s.functional(a.functional).reach == expr::Reach::Sites => {}
        _ => e.children().into_iter().for_each(|x| outside(s, x, out)),
    }
}

/// Whether the derivative of a value with respect to a momentum contains no letter.
fn has_constant_factor(s: &Symbols, value: &Expr, momentum: Letter) -> bool {
    let shape = expr::letter(s, momentum.symbol, momentum.shift).shape();
    let by = |u: &Expr| expr::directional(s, value, &[(momentum, u.clone())]);
    expr::axes(shape).is_some_and(|all| all.iter().all(|u| expr::letters(&by(u)).is_empty()))
}

/// The totals of one chain in the letters of another.
fn of_part(
    lattice: &Lattice,
    part: &RepresentativeChain,
    invariants: &[Invariant],
    base: &RepresentativeChain,
) -> Vec<Total> {
    let on = match part.choice.periodic {
        true => "along a ring".to_owned(),
        false if lattice.line.is_none() => "always".to_owned(),
        false => part.choice.held(lattice),
    };
    // Constraints are reported for all sites together.
    let exact = invariants.iter();
    let exact = exact.filter(|v| v.exact && v.family != Family::Held);
    let ends = holding_alike(lattice, &part.choice);
    let each = summed(part, exact.collect())
        .into_iter()
        .filter_map(|(v, value)| {
            let mut densities = densities(lattice, part, &value)?;
            let mut places: Vec<(Letter, bool)> = Vec::new();
            for density in &mut densities {
                let own = expr::letters(&density.value).into_iter();
                let own: Vec<Letter> = own.filter(|l| is_held(part, l)).collect();
                for l in own {
                    let last = part.sited(l.symbol)?.site > 0;
                    let there = part.in_letters_of(
                        base,
                        &expr::letter(&part.d.letters.symbols, l.symbol, l.shift),
                    )?;
                    places.extend(expr::letters(&there).into_iter().map(|l| (l, last)));
                }
                density.value = part.in_letters_of(base, &density.value)?;
            }
            Some(Total {
                name: part.unfolded.plain(&v.name).replace(' ', "_"),
                reason: v.reason.clone(),
                on: on.clone(),
                densities,
                places,
                ends: ends.clone(),
            })
        });
    each.collect()
}

/// The totals of an expanded chain, by name, with the text of their densities. A total includes every site.
pub fn totals_on(
    lattice: &Lattice,
    choice: &ChainConfig,
    unfolded: &ExpandedModel,
    d: &Derivation,
) -> Vec<(String, String)> {
    let part = RepresentativeChain {
        choice: choice.clone(),
        unfolded: unfolded.clone(),
        d: d.outline(),
    };
    let all = of_part(lattice, &part, &d.invariants, &part);
    all.iter()
        .map(|t| (t.name.clone(), t.text(&part)))
        .collect()
}

/// The values of invariants. Invariants of single sites are added to one total.
fn summed<'v>(
    part: &RepresentativeChain,
    invariants: Vec<&'v Invariant>,
) -> Vec<(&'v Invariant, Expr)> {
    let site = |v: &Invariant| {
        let letters = expr::letters(v.value.as_ref()?).into_iter();
        let mut sites = letters
            .filter_map(|l| part.sited(l.symbol))
            .map(|at| at.site);
        let first = sites.next()?;
        sites.all(|s| s == first).then_some(first)
    };
    let mut out: Vec<(&Invariant, Expr, Vec<usize>)> = Vec::new();
    for v in invariants {
        let Some(value) = v.value.clone() else {
            continue;
        };
        let own = site(v);
        let name = part.unfolded.plain(&v.name);
        let alike = |(first, sum, sites): &&mut (&Invariant, Expr, Vec<usize>)| {
            let same = sum.shape() == value.shape() && first.reason == v.reason;
            let another = own.is_some_and(|own| !sites.is_empty() && !sites.contains(&own));
            same && another && part.unfolded.plain(&first.name) == name
        };
        match (out.iter_mut().find(alike), own) {
            (Some((_, sum, sites)), Some(own)) => {
                *sum = expr::add(sum.clone(), value);
                sites.push(own);
            }
            _ => out.push((v, value, own.into_iter().collect())),
        }
    }
    out.into_iter().map(|(v, e, _)| (v, e)).collect()
}

/// The densities of a sum over all sites of each kind that no end condition prescribes, at the base.
fn densities(lattice: &Lattice, part: &RepresentativeChain, e: &Expr) -> Option<Vec<Density>> {
    let mut by_site: BTreeMap<(usize, Sites), BTreeMap<usize, Vec<Expr>>> = BTreeMap::new();
    for term in terms(part, e) {
        let (kind, site) = only_site(lattice, part, &term)?;
        by_site
            .entry(kind)
            .or_default()
            .entry(site)
            .or_default()
            .push(term);
    }
    let algebra = Algebra::new(&part.d.letters.symbols);
    let mut out = Vec::new();
    for ((label, sites), all) in by_site {
        let count = part.choice.sites(lattice, label, sites);
        let absent: Vec<usize> = (0..count).filter(|i| !all.contains_key(i)).collect();
        let is_end = |i: &usize| *i == 0 || i + 1 == count;
        if !absent
            .iter()
            .all(|i| is_end(i) && holds(lattice, part, (label, sites), *i))
        {
            return None;
        }
        let left_out = [0, count.checked_sub(1)?].map(|i| usize::from(absent.contains(&i)));
        let mut density: Option<Expr> = None;
        for (site, terms) in all {
            let sum = expr::sum(terms, e.shape());
            let at_base = at_base(part, &sum, site)?;
            match &density {
                None => density = Some(at_base),
                Some(d) if algebra.is_zero(&expr::sub(d.clone(), at_base)) => {}
                Some(_) => return None,
            }
        }
        out.push(Density {
            label,
            sites,
            left_out,
            value: density?,
        });
    }
    (!out.is_empty()).then_some(out)
}

/// Whether an end condition prescribes a configuration at this site.
fn holds(lattice: &Lattice, part: &RepresentativeChain, kind: (usize, Sites), site: usize) -> bool {
    let mut held = part
        .unfolded
        .given
        .iter()
        .filter_map(|own| part.unfolded.copy(own));
    held.any(|c| {
        let of = lattice.find(&c.of);
        c.site == site && of.is_some_and(|q| (q.label, q.sites) == kind)
    })
}

/// Whether an end condition prescribes a letter, which is then the same for all sites.
fn is_held(part: &RepresentativeChain, l: &Letter) -> bool {
    part.unfolded
        .given
        .contains(&part.d.letters.symbols.get(l.symbol).name)
}

/// A summand of one site at the base; prescribed letters stay unchanged.
fn at_base(part: &RepresentativeChain, e: &Expr, site: usize) -> Option<Expr> {
    let by = isize::try_from(BASE).ok()? - isize::try_from(site).ok()?;
    let s = &part.d.letters.symbols;
    let mut list: Vec<(Letter, Expr)> = Vec::new();
    for l in expr::letters(e) {
        if !is_held(part, &l) {
            let own = expr::letter(s, l.symbol, l.shift);
            list.push((l, part.moved(&own, by)?));
        }
    }
    Some(expr::substitute(s, e, &list))
}

/// Whether an expression contains prescribed configurations, and otherwise letters of a single site.
fn is_from_held(part: &RepresentativeChain, e: &Expr) -> bool {
    let letters = expr::letters(e).into_iter();
    let (held, others): (Vec<Letter>, Vec<Letter>) = letters.partition(|l| is_held(part, l));
    let mut sites = others
        .iter()
        .filter_map(|l| part.sited(l.symbol))
        .map(|at| at.site);
    let first = sites.next();
    !held.is_empty() && first.is_some() && sites.all(|s| Some(s) == first)
}

/// The only site of a term, apart from prescribed sites.
fn only_site(
    lattice: &Lattice,
    part: &RepresentativeChain,
    e: &Expr,
) -> Option<((usize, Sites), usize)> {
    let mut found = None;
    for l in expr::letters(e).iter().filter(|l| !is_held(part, l)) {
        let Some(at) = part.sited(l.symbol) else {
            continue;
        };
        let q = lattice.find(at.plain())?;
        let here = ((q.label, q.sites), at.site);
        match found {
            None => found = Some(here),
            Some(known) if known == here => {}
            Some(_) => return None,
        }
    }
    found
}

/// The terms of a sum, with common factors multiplied in. Distances stay unexpanded, which keeps rounding errors small.
fn terms(part: &RepresentativeChain, e: &Expr) -> Vec<Expr> {
    if is_from_held(part, e) {
        return vec![e.clone()];
    }
    let go = |x: &Expr| terms(part, x);
    let both = |a: &Expr, b: &Expr, with: &dyn Fn(Expr, Expr) -> Expr| {
        let (a, b) = (go(a), go(b));
        let each = a
            .iter()
            .flat_map(|x| b.iter().map(move |y| with(x.clone(), y.clone())));
        each.collect()
    };
    match e.node() {
        Node::Sum(list) => list.iter().flat_map(go).collect(),
        Node::Neg(a) => go(a).into_iter().map(expr::neg).collect(),
        // Linear functions of a matrix.
        Node::Part(which, a) => go(a).into_iter().map(|a| expr::part(*which, a)).collect(),
        Node::Trace(a) => go(a).into_iter().map(expr::trace).collect(),
        Node::Vee(a) => go(a).into_iter().map(expr::vee).collect(),
        Node::Dot(a, b) => both(a, b, &expr::dot),
        Node::Cross(a, b) => both(a, b, &expr::cross),
        Node::Product(factors) => {
            let sited = |x: &Expr| {
                expr::letters(x)
                    .iter()
                    .any(|l| part.sited(l.symbol).is_some())
            };
            let mut summed = factors.iter().enumerate();
            let place = summed.find(|(_, f)| sited(f) && go(f).len() > 1);
            match place {
                Some((i, f)) => {
                    let with = |t: Expr| {
                        let mut list = factors.clone();
                        list[i] = t;
                        expr::product(list)
                    };
                    go(f).into_iter().map(with).collect()
                }
                None => vec![e.clone()],
            }
        }
        _ => vec![e.clone()],
    }
}
