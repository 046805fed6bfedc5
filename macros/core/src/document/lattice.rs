//! Lays out a model with labels as a section of a paper: its sites, the terms of its Lagrangian with their ranges,
//! the equations of an interior site and of each end condition, and the invariants of each choice.

mod card;
mod ends;
mod functionals;
mod holds;
mod invariants;
mod sites;
mod sums;
mod unlabelled_equations;

use super::compose::without_remarks;
use super::indexed_notation::{IndexOrigin, IndexedNotation, Part};
use crate::derive::warnings::Warning;
use crate::diagnostic::Errors;
use crate::expr::{self, Expr, Node, Shift};
use crate::lattice::{ChainConfig, Lattice, Range, Sites};
use crate::pipeline;
use crate::print::document::{Document, Inline, Section};
use crate::print::formula::Formula;
use crate::print::{Format, Style, expression};
use crate::syntax::ast::Model;

pub use card::{CardWords, InvariantWords, card_words};

/// A printed derivation on a lattice.
pub struct Printed {
    /// The text.
    pub text: String,
    /// Warnings about models that derive but are probably not what you meant.
    pub warnings: Vec<Warning>,
}

/// Prints the derivation of a model with labels in a format; `stated` is its text.
///
/// # Errors
/// If a statement is invalid, or the model cannot be derived.
pub fn printed_lattice(
    model: &Model,
    stated: &str,
    format: Format,
    columns: usize,
) -> Result<Printed, Errors> {
    let lattice = Lattice::read(model)?;
    let parts = parts(model, &lattice)?;
    let Some(first) = parts.first() else {
        return Ok(Printed {
            text: String::new(),
            warnings: Vec::new(),
        });
    };
    let mut folded = IndexedNotation::new(&lattice, first);
    let mut doc = Document::titled(format!("{}: discrete equations of motion", model.name.text));
    statement(model, stated, &mut doc);
    let warnings = warnings(&parts, &mut doc);
    sites(&lattice, &mut doc);
    terms(&mut folded, first, &mut doc);
    constraints(&mut folded, first, &mut doc);
    functionals::functionals(&mut folded, first, &mut doc);
    interior(&mut folded, first, &mut doc);
    ends::ends(&mut folded, &parts, &mut doc);
    holds::held(&mut folded, first, &mut doc);
    invariants::invariants(&mut folded, model, &parts, &mut doc);
    certificate(&lattice, &parts, &mut doc);
    let style = Style {
        columns,
        ..Style::new(&first.d.spec.time_index)
    };
    Ok(Printed {
        text: super::paged(doc, &folded.symbols, None, &style, format),
        warnings,
    })
}

/// Completes the choice of a case that sets no ends: a ring if the model declares `periodic` and no end conditions,
/// otherwise the first alternative of each end.
pub fn default_choice(lattice: &Lattice, choice: ChainConfig) -> ChainConfig {
    let ends = lattice.ends.iter().any(|e| !e.is_empty());
    match lattice.periodic.is_some() && !ends {
        true => choice.as_ring(lattice),
        false => choice,
    }
}

/// The default choice first, then the other topology (open or ring), then each other end condition.
fn parts(model: &Model, lattice: &Lattice) -> Result<Vec<Part>, Errors> {
    let open = pipeline::representative(model, lattice)?;
    let mut choices = vec![default_choice(lattice, open.clone())];
    if lattice.periodic.is_some() {
        choices.push(match choices.iter().any(|c| c.periodic) {
            true => open.clone(),
            false => open.clone().as_ring(lattice),
        });
    }
    for last in [false, true] {
        for name in lattice.alternatives(last).iter().skip(1) {
            choices.extend(open.clone().with_end(lattice, last, name));
        }
    }
    choices
        .into_iter()
        .map(|choice| {
            let mut longer = choice.clone();
            let of_set = lattice.labels.len() == 1 && lattice.meshes.is_empty();
            let summed = lattice.line.or(of_set.then_some(0));
            if let Some(count) = summed.and_then(|i| longer.counts.get_mut(i)) {
                // Two more sites keep the parity of the number of sites of a ring.
                *count += if choice.periodic { 2 } else { 1 };
            }
            let mut part = written_out(model, lattice, choice)?;
            if longer.counts != part.choice.counts {
                part.longer = Some(Box::new(written_out(model, lattice, longer)?));
            }
            Ok(part)
        })
        .collect()
}

fn written_out(model: &Model, lattice: &Lattice, choice: ChainConfig) -> Result<Part, Errors> {
    let (unfolded, d) = pipeline::derive_lattice(model, lattice, &choice)?;
    Ok(Part {
        choice,
        unfolded,
        d,
        longer: None,
    })
}

fn statement(model: &Model, stated: &str, doc: &mut Document) {
    let section = doc.section("Model");
    let docs: Vec<&str> = model.docs.iter().map(|l| l.trim()).collect();
    let words = docs.join(" ");
    if !words.trim().is_empty() {
        section.text(words.trim());
    }
    section.code(without_remarks(stated));
}

fn warnings(parts: &[Part], doc: &mut Document) -> Vec<Warning> {
    let mut out: Vec<Warning> = Vec::new();
    for w in parts
        .iter()
        .flat_map(|p| p.unfolded.declared_warnings(&p.choice, &p.d.warnings))
    {
        let place = |w: &Warning| format!("{:?}", w.diagnostic.place);
        let known = |o: &Warning| o.topic == w.topic && place(o) == place(&w);
        if !out.iter().any(known) {
            out.push(w);
        }
    }
    if !out.is_empty() {
        doc.remarks = out.iter().map(Warning::remark).collect();
        let items = out.iter().map(|w| {
            let mut words = Inline::marked(&w.diagnostic.message);
            words.push(".".into());
            words
        });
        let items = items.collect();
        doc.section("Warnings").list(items);
    }
    out
}

fn sites(lattice: &Lattice, doc: &mut Document) {
    let section = doc.section("Sites");
    for (i, l) in lattice.labels.iter().enumerate() {
        let (index, count) = (&l.index.text, &l.count.text);
        if l.grid {
            section.text(&format!("The nodes of a grid are indexed by {index}."));
            continue;
        }
        if l.set {
            section.text(&format!(
                "The label {index} indexes a set of {count} sites, {index} = 0, ..., {count}-1, which have no neighbours."
            ));
            continue;
        }
        let spacing = l.step.as_ref();
        let spacing = spacing.map_or_else(String::new, |s| format!("; the spacing is {}", s.text));
        section.text(&format!(
            "The label {index} indexes a chain of {count} segments: nodes {index} = 0, ..., {count} and segments {index} = 0, ..., {count}-1; segment {index} joins the nodes {index} and {index}+1{spacing}."
        ));
        if lattice.periodic.is_some() {
            section.text(&format!(
                "If the chain is closed to a ring, it has {count} nodes and {count} segments, and indices are taken modulo {count}."
            ));
        }
        for q in lattice.quantities.iter().filter(|q| q.label == i) {
            if let Some(offset) = &q.offset {
                section.text(&format!(
                    "Once around the ring {} grows by {}: {}_{{{index}+{count}}} = {}_{{{index}}} + {}.",
                    q.name.text, offset.text, q.name.text, q.name.text, offset.text
                ));
            }
        }
    }
    let listed = |sites: Sites, grid: bool| {
        let all = lattice.quantities.iter();
        let here = all.filter(|q| q.sites == sites && lattice.is_grid(q.label) == grid);
        let names: Vec<&str> = here.map(|q| q.name.text.as_str()).collect();
        names.join(", ")
    };
    let mut words = Vec::new();
    for (sites, grid, name) in [
        (Sites::Nodes, false, "at nodes"),
        (Sites::Segments, false, "at segments"),
        (Sites::Members, false, "at the sites of a set"),
        (Sites::Members, true, "at the nodes of a grid"),
    ] {
        let list = listed(sites, grid);
        if !list.is_empty() {
            words.push(format!("{name}: {list}"));
        }
    }
    section.text(&format!(
        "Quantities that vary from site to site: {}.",
        words.join("; ")
    ));
}

/// The number of sites with an offset: `N`, `N-1`.
fn beyond(count: &str, by: isize) -> String {
    match by {
        0 => count.to_owned(),
        n if n > 0 => format!("{count}+{n}"),
        n => format!("{count}{n}"),
    }
}

/// A term with its range of summation.
fn ranged(lattice: &Lattice, range: Option<Range>, of: Formula) -> Formula {
    let label = range.and_then(|r| lattice.labels.get(r.label).map(|l| (r, l)));
    match label {
        None => of,
        Some((_, l)) if l.grid => Formula::SumOver {
            index: l.index.text.clone(),
            from: None,
            to: None,
            of: Box::new(of),
        },
        Some((range, l)) => Formula::SumOver {
            index: l.index.text.clone(),
            from: Some(range.from.to_string()),
            to: Some(beyond(&l.count.text, range.to)),
            of: Box::new(of),
        },
    }
}

fn terms(folded: &mut IndexedNotation, part: &Part, doc: &mut Document) {
    let terms = folded.terms(part);
    let scaled = part.d.spec.scale.is_some();
    let ring = part.choice.periodic;
    let (mut shown, mut without_constants) = (Vec::new(), false);
    for (s, e) in part.unfolded.summands.iter().zip(terms) {
        if s.end.is_some() {
            continue;
        }
        let Some(e) = e else {
            without_constants = true;
            continue;
        };
        let e = expr::shown(&folded.symbols, &e);
        shown.push(match e.node() {
            Node::Neg(inner) => {
                let inner = Formula::Expr(inner.clone());
                Formula::neg(ranged(folded.lattice, s.range, inner))
            }
            _ => ranged(folded.lattice, s.range, Formula::Expr(e.clone())),
        });
    }
    let section = doc.section("Discrete Lagrangian");
    section.text(match (scaled, ring) {
        (true, _) => "The Lagrangian of the step from one node to the next, as stated; each term is summed over the sites where every quantity in it is defined:",
        (false, true) => "The discrete Lagrangian of the step from one node to the next, on a ring:",
        (false, false) => "The discrete Lagrangian of the step from one node to the next; each term is summed over the sites where every quantity in it is defined:",
    });
    let name = format!("ℓ_{}", part.d.spec.time_index);
    let sum = match <[Formula; 1]>::try_from(shown) {
        Ok([only]) => only,
        Err(several) => Formula::Sum(several),
    };
    section.equation(Formula::defined(Formula::name(&name), sum));
    if without_constants {
        section.text("Constants, which do not enter the equations of motion, are omitted.");
    }
    if !part.d.action.nodal.is_zero() {
        section.text("Nodal terms are split evenly between the two adjacent steps.");
    }
    for stated in holds::stated_holds(part) {
        let name = stated.name;
        section.text(&format!(
            "At every site, the action of a step also contains the constraint term of the multiplier {name}. It is the step size times {name}, paired with the left side minus the right side of the constraint at the start of the step."
        ));
    }
    for stated in &part.unfolded.totals {
        let name = &stated.name;
        section.text(&format!(
            "Once for all sites, the action of a step also contains the constraint term of the multiplier {name}. It is the step size times {name}, paired with the left side minus the right side of the constraint at the start of the step."
        ));
    }
}

fn constraints(folded: &mut IndexedNotation, part: &Part, doc: &mut Document) {
    let section = doc.section("Constraints");
    for stated in stated_configurations(part) {
        let c = &part.d.spec.configurations[stated.shown];
        let from = IndexOrigin::Site(stated.site);
        let next = folded.letter(part, c.element, Shift::NEXT, from);
        let update = folded.derived(part, &c.update, from);
        section.equation(Formula::equal(next, update));
    }
    let mut told: Vec<String> = Vec::new();
    for a in &part.d.spec.advected {
        let name = &part.d.letters.symbols.get(a.quantity).name;
        let copy = part.unfolded.copy(name);
        let (of, site) = copy.map_or((name.clone(), 0), |c| (c.of.clone(), c.site));
        let middle = middle(part, folded.lattice, &of);
        if site != middle || told.contains(&of) {
            continue;
        }
        told.push(of);
        let from = IndexOrigin::Site(site);
        let next = folded.letter(part, a.quantity, Shift::NEXT, from);
        let update = folded.derived(part, &a.update, from);
        let mut both = vec![Formula::equal(next, update)];
        if let Some(definition) = &a.definition {
            let here = folded.letter(part, a.quantity, Shift::HERE, from);
            let definition = folded.derived(part, definition, from);
            both.push(Formula::equal(here, definition));
        }
        section.equation(match <[Formula; 1]>::try_from(both) {
            Ok([only]) => only,
            Err(both) => Formula::List(both),
        });
    }
    holds::holds(folded, part, section);
}

/// A declared configuration and its unknown copies.
pub(super) struct Stated {
    /// Its name.
    pub name: String,
    /// Its label, if it has one.
    pub label: Option<usize>,
    /// Number of the displayed configuration, the copy at the middle site.
    pub shown: usize,
    /// The middle site.
    pub site: usize,
    /// Numbers and sites of the unknown copies, in order.
    pub copies: Vec<(usize, usize)>,
}

/// The middle site of a quantity.
fn middle(part: &Part, lattice: &Lattice, of: &str) -> usize {
    let Some(q) = lattice.find(of) else {
        return 0;
    };
    match q.sites {
        Sites::Members => 0,
        Sites::Nodes | Sites::Segments => part.choice.count(q.label) / 2,
    }
}

/// The declared configurations.
pub(super) fn stated_configurations(part: &Part) -> Vec<Stated> {
    let mut out: Vec<Stated> = Vec::new();
    for (i, c) in part.d.spec.configurations.iter().enumerate() {
        let element = &part.d.letters.symbols.get(c.element).name;
        let copy = part.unfolded.copy(element);
        let (name, site) = copy.map_or((element.clone(), 0), |c| (c.of.clone(), c.site));
        match out.iter_mut().find(|s| s.name == name) {
            Some(s) => s.copies.push((i, site)),
            None => out.push(Stated {
                label: None,
                shown: i,
                site,
                copies: vec![(i, site)],
                name,
            }),
        }
    }
    for s in &mut out {
        let copy = part.unfolded.copies.iter().find(|c| c.of == s.name);
        if copy.is_none() {
            continue;
        }
        let label = part.choice.counts.len().min(1).saturating_sub(1);
        s.label = Some(label);
        let wanted = part.choice.count(label) / 2;
        let nearest = s
            .copies
            .iter()
            .min_by_key(|(_, site)| site.abs_diff(wanted));
        if let Some((i, site)) = nearest {
            (s.shown, s.site) = (*i, *site);
        }
    }
    out
}

/// The two equations of a copy, with indices relative to its site or an end.
pub(super) fn equations(
    folded: &mut IndexedNotation,
    part: &Part,
    i: usize,
    from: IndexOrigin,
) -> Vec<Formula> {
    let (Some(b), Some(mu)) = (
        part.d.balances.get(i),
        part.d.letters.node_momentum.get(i).copied(),
    ) else {
        return Vec::new();
    };
    let here = folded.letter(part, mu, Shift::HERE, from);
    let next = folded.letter(part, mu, Shift::NEXT, from);
    let outgoing = folded.derived(part, &b.outgoing, from);
    let incoming = folded.derived(part, &b.incoming, from);
    vec![
        Formula::equal(here, outgoing),
        Formula::equal(next, incoming),
    ]
}

/// The equations of a copy as text; equal equations give equal text.
pub(super) fn reading(folded: &mut IndexedNotation, part: &Part, i: usize, site: usize) -> String {
    let Some(b) = part.d.balances.get(i) else {
        return String::new();
    };
    let style = Style::new(&part.d.spec.time_index);
    let mut text = |e: &Expr| {
        let e = folded.expression(part, e, IndexOrigin::Site(site));
        let e = expr::shown(&folded.symbols, &e);
        expression(&e, &folded.symbols, &style, Format::Text)
    };
    let (a, b) = (text(&b.outgoing), text(&b.incoming));
    format!("{a} | {b}")
}

/// The first and the last copy whose equations read like those at the middle site.
pub(super) fn like_the_middle(
    folded: &mut IndexedNotation,
    part: &Part,
    s: &Stated,
) -> (usize, usize) {
    let wanted = reading(folded, part, s.shown, s.site);
    let at = s
        .copies
        .iter()
        .position(|(i, _)| *i == s.shown)
        .unwrap_or(0);
    let (mut first, mut last) = (at, at);
    while let Some((i, site)) = first.checked_sub(1).and_then(|f| s.copies.get(f)) {
        if reading(folded, part, *i, *site) != wanted {
            break;
        }
        first -= 1;
    }
    while let Some((i, site)) = s.copies.get(last + 1) {
        if reading(folded, part, *i, *site) != wanted {
            break;
        }
        last += 1;
    }
    (first, last)
}

fn interior(folded: &mut IndexedNotation, part: &Part, doc: &mut Document) {
    let section = doc.section("Equations of a site");
    section.text("If the momentum at the node is known, the first equation is solved for the velocity, and the second gives the momentum at the next node.");
    for s in stated_configurations(part) {
        let c = &part.d.spec.configurations[s.shown];
        let (first, last) = like_the_middle(folded, part, &s);
        let words = format!(": {}", c.group.name(&|n| folded.symbols.dim_text(n)));
        let element = folded.letter(part, c.element, Shift::HERE, IndexOrigin::Site(s.site));
        let mut line: Vec<Inline> = vec![element.into(), words.into()];
        line.extend(range_words(folded.lattice, part, &s, first, last));
        line.push(".".into());
        section.paragraph(line);
        let summed = match s.label {
            None => unlabelled_equations::equations(folded, part, &s),
            Some(_) => None,
        };
        for equation in
            summed.unwrap_or_else(|| equations(folded, part, s.shown, IndexOrigin::Site(s.site)))
        {
            section.equation(equation);
        }
    }
}

/// The range of sites of an equation: `, i = 1, ..., N-1`.
fn range_words(
    lattice: &Lattice,
    part: &Part,
    s: &Stated,
    first: usize,
    last: usize,
) -> Vec<Inline> {
    let Some(q) = lattice.find(&s.name) else {
        return Vec::new();
    };
    let Some(l) = lattice.labels.get(q.label) else {
        return Vec::new();
    };
    let (Some((_, a)), Some((_, b))) = (s.copies.get(first), s.copies.get(last)) else {
        return Vec::new();
    };
    let count = part.choice.count(q.label);
    let by = isize::try_from(*b).unwrap_or(0) - isize::try_from(count).unwrap_or(0);
    let (i, n) = (&l.index.text, &l.count.text);
    let ring = part.choice.periodic && lattice.line == Some(q.label);
    vec![match (ring, l.set) {
        (true, _) => format!(", {i} = 0, ..., {n}-1, indices modulo {n}").into(),
        (_, true) => format!(", {i} = 0, ..., {n}-1").into(),
        _ => format!(", {i} = {a}, ..., {}", beyond(n, by)).into(),
    }]
}

fn certificate(lattice: &Lattice, parts: &[Part], doc: &mut Document) {
    let section = doc.section("Certificate");
    section.text(match lattice.meshes.is_empty() {
        false => "The equations are written for one site of each kind, which represents all sites. clebsch proves each identity of the derivation for this site; two scalars count as equal if their sums over all sites are equal. The transposed derivatives of functionals are tested, not proved.",
        true => "The equations above come from short chains, written out site by site: each site shown has all its neighbours, and each end has its own equations. clebsch proves each identity of the derivation for these chains; a longer chain repeats the equations of the interior.",
    });
    let items = parts.iter().map(|p| {
        let words = format!("{}: {}", p.choice.words(lattice), p.d.certificate.summary());
        vec![words.into()]
    });
    section.list(items.collect());
}

/// Adds a paragraph of plain text.
pub(super) fn say(section: &mut Section, words: String) {
    section.paragraph([words.into()]);
}
