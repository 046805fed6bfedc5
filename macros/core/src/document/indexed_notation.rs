//! Maps the letters of an expanded chain back to indexed notation: `q_3` and `q_4` become `q_{i}` and `q_{i+1}`, and
//! `q_{N-1}` and `q_{N}` at an end. All parts of a document share one symbol table.

use crate::check;
use crate::derive::Derivation;
use crate::expr::shape::{Shape, Structure};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter, Shift};
use crate::lattice::{ChainConfig, ExpandedModel, Lattice};
use crate::print::formula::Formula;
use std::collections::BTreeMap;

/// One choice of sites and end conditions, expanded and derived.
pub(super) struct Part {
    pub choice: ChainConfig,
    pub unfolded: ExpandedModel,
    pub d: Derivation,
    /// This choice with more sites. Comparing the two shows which formulas hold for every number of sites.
    pub longer: Option<Box<Part>>,
}

/// The origin that site indices are relative to.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum IndexOrigin {
    /// Relative to this site: `i`, `i+1`.
    Site(usize),
    /// Relative to the first site: `0`, `1`.
    First,
    /// Relative to the last node: `N`, `N-1`.
    Last,
    /// Relative to this site, except that parameters and prescribed values of an end are indexed `0` or `N`.
    End(usize),
}

/// The symbols of a document on a lattice.
pub(super) struct IndexedNotation<'a> {
    pub lattice: &'a Lattice,
    pub symbols: Symbols,
    known: BTreeMap<String, SymbolId>,
}

/// The declared name behind a letter of a part, and its site.
struct Origin {
    name: String,
    label: usize,
    site: usize,
}

impl<'a> IndexedNotation<'a> {
    /// Starts from the symbols of this part; all parts share its functionals.
    pub(super) fn new(lattice: &'a Lattice, part: &Part) -> IndexedNotation<'a> {
        IndexedNotation {
            lattice,
            symbols: part.d.letters.symbols.clone(),
            known: BTreeMap::new(),
        }
    }

    /// An expression of a part in the shared symbols.
    pub(super) fn expression(&mut self, part: &Part, e: &Expr, from: IndexOrigin) -> Expr {
        let replaced: Vec<(Letter, Expr)> = expr::letters(e)
            .into_iter()
            .map(|l| {
                let id = self.symbol(part, l.symbol, from);
                (l, expr::letter(&self.symbols, id, l.shift))
            })
            .collect();
        let e = self.with_functionals(part, e, from);
        expr::substitute(&self.symbols, &e, &replaced)
    }

    /// A letter of a part at a time offset.
    pub(super) fn letter(
        &mut self,
        part: &Part,
        symbol: SymbolId,
        shift: Shift,
        from: IndexOrigin,
    ) -> Formula {
        let id = self.symbol(part, symbol, from);
        Formula::Expr(expr::letter(&self.symbols, id, shift))
    }

    /// A derived expression in the shared symbols, with a positive term first.
    pub(super) fn derived(&mut self, part: &Part, e: &Expr, from: IndexOrigin) -> Formula {
        let e = self.expression(part, e, from);
        Formula::Expr(expr::positive_first(&expr::shown(&self.symbols, &e)))
    }

    /// Formats the index of a site.
    pub(super) fn index(
        &self,
        part: &Part,
        label: usize,
        site: usize,
        from: IndexOrigin,
    ) -> String {
        let Some(l) = self.lattice.labels.get(label) else {
            return String::new();
        };
        let relative = |name: &str, site: usize, origin: usize| match site.cmp(&origin) {
            std::cmp::Ordering::Equal => name.to_owned(),
            std::cmp::Ordering::Greater => format!("{name}+{}", site - origin),
            std::cmp::Ordering::Less => format!("{name}-{}", origin - site),
        };
        let count = part.choice.count(label);
        // A ring wraps around.
        let around = part.choice.periodic && self.lattice.line == Some(label);
        let site = match from {
            IndexOrigin::End(origin) if around && site < origin => site + count,
            _ => site,
        };
        let relative = |name: &str, origin: usize| relative(name, site, origin);
        match from {
            _ if l.set => relative(&l.index.text, part_site(from)),
            IndexOrigin::Site(origin) | IndexOrigin::End(origin) => relative(&l.index.text, origin),
            IndexOrigin::First => site.to_string(),
            IndexOrigin::Last => relative(&l.count.text, count),
        }
    }

    /// The label whose sites totals are summed over: the chain, or the set if it is the only label and there is no
    /// mesh.
    pub(super) fn summed(&self) -> Option<usize> {
        let lattice = self.lattice;
        let of_set = lattice.labels.len() == 1 && lattice.meshes.is_empty();
        lattice.line.or(of_set.then_some(0))
    }

    /// The label and the site of a letter. `None` for parameters and prescribed values of an end.
    pub(super) fn site(&self, part: &Part, symbol: SymbolId) -> Option<(usize, usize)> {
        match self.end(part, symbol) {
            Some(_) => None,
            None => origin(self.lattice, part, symbol).map(|at| (at.label, at.site)),
        }
    }

    /// The end that owns a letter, as its parameter or prescribed value; `true` for the last end.
    fn end(&self, part: &Part, symbol: SymbolId) -> Option<bool> {
        let name = &part.d.letters.symbols.get(symbol).name;
        let unfolded = &part.unfolded;
        if let Some((.., last)) = unfolded.end_parameters.iter().find(|(own, ..)| own == name) {
            return Some(*last);
        }
        let at = origin(self.lattice, part, symbol)?;
        let given = unfolded.given.contains(name);
        given.then(|| 2 * at.site > part.choice.count(at.label))
    }

    fn symbol(&mut self, part: &Part, symbol: SymbolId, from: IndexOrigin) -> SymbolId {
        let own = part.d.letters.symbols.get(symbol).clone();
        let from = match from {
            IndexOrigin::End(_) => match self.end(part, symbol) {
                Some(true) => IndexOrigin::Last,
                Some(false) => IndexOrigin::First,
                None => from,
            },
            _ => from,
        };
        let (name, typeset) = match origin(self.lattice, part, symbol) {
            None => (beside(part, symbol), own.typeset.clone()),
            Some(at) => {
                let index = self.index(part, at.label, at.site, from);
                let is_number = index.bytes().all(|c| c.is_ascii_digit());
                let index = match own.apart && is_number {
                    true => format!("({index})"),
                    false => index,
                };
                let stated = self.lattice.find(&at.name);
                let latex = stated.and_then(|q| q.name.latex());
                let latex = latex.map(|l| format!("{{{l}}}_{{{index}}}"));
                (format!("{}_{{{index}}}", at.name), latex)
            }
        };
        self.named(
            &name,
            (own.shape, own.structure, own.role),
            typeset,
            &own.docs,
        )
    }

    /// The shared symbol with this name.
    pub(super) fn named(
        &mut self,
        name: &str,
        (shape, structure, role): (Shape, Structure, Role),
        typeset: Option<String>,
        docs: &[String],
    ) -> SymbolId {
        let key = format!("{name} {role:?} {shape:?}");
        if let Some(id) = self.known.get(&key) {
            return *id;
        }
        let id = self.symbols.add(name, shape, structure, role);
        self.symbols.describe(id, typeset, docs);
        self.known.insert(key, id);
        id
    }

    /// The terms of the Lagrangian as displayed; `None` for a constant, which does not affect the motion.
    pub(super) fn terms(&mut self, part: &Part) -> Vec<Option<Expr>> {
        let shown: Vec<_> = part.unfolded.summands.iter().map(|s| &s.shown).collect();
        let elaborated = check::numbers(&part.unfolded.model, &shown);
        let each = part.unfolded.summands.iter().zip(elaborated);
        let symbols = &part.d.letters.symbols;
        let moves = |e: &Expr| {
            let letters = expr::letters(e);
            let is_given =
                |l: &Letter| matches!(symbols.get(l.symbol).role, Role::Parameter | Role::Step);
            !letters.iter().all(is_given)
        };
        each.map(|(s, e)| {
            let e = e.filter(moves);
            let from = match s.end {
                None => IndexOrigin::Site(s.site),
                Some((false, _)) => IndexOrigin::First,
                Some((true, _)) => IndexOrigin::Last,
            };
            e.map(|e| self.checked(part, &e, from))
        })
        .collect()
    }

    /// Converts an expression in the symbols of the checked model. The derivation numbers these symbols first.
    fn checked(&mut self, part: &Part, e: &Expr, from: IndexOrigin) -> Expr {
        self.expression(part, e, from)
    }
}

fn part_site(from: IndexOrigin) -> usize {
    match from {
        IndexOrigin::Site(site) | IndexOrigin::End(site) => site,
        IndexOrigin::First | IndexOrigin::Last => 0,
    }
}

/// Finds the quantity that a letter belongs to: a copy of the quantity, or a letter that the derivation adds to it.
fn origin(lattice: &Lattice, part: &Part, symbol: SymbolId) -> Option<Origin> {
    let d = &part.d;
    let name = &d.letters.symbols.get(symbol).name;
    let of_copy = |name: &str, shown: String| {
        let copy = part.unfolded.copy(name)?;
        // A multiplier is not a declared quantity; constraints between neighbours belong to the chain.
        let declared = lattice.find(&copy.of).map(|q| q.label);
        let label = declared.or(lattice.line).unwrap_or(0);
        Some(Origin {
            name: shown.replace("{}", &copy.of),
            label,
            site: copy.site,
        })
    };
    if let Some(found) = of_copy(name, "{}".to_owned()) {
        return Some(found);
    }
    if let Some((_, stated, last)) = part
        .unfolded
        .end_parameters
        .iter()
        .find(|(own, ..)| own == name)
    {
        let label = lattice.line?;
        let site = if *last { part.choice.count(label) } else { 0 };
        return Some(Origin {
            name: stated.clone(),
            label,
            site,
        });
    }
    for (i, c) in d.spec.configurations.iter().enumerate() {
        let element = &d.letters.symbols.get(c.element).name;
        if c.velocity == symbol {
            return of_copy(element, "Δ{}".to_owned());
        }
        let numbered = [&d.letters.rate, &d.letters.node_momentum];
        if numbered.iter().any(|all| all.get(i) == Some(&symbol)) {
            let letter: String = name.chars().take_while(|c| !c.is_ascii_digit()).collect();
            let copy = part.unfolded.copy(element)?;
            return of_copy(element, format!("{letter}{}", number(part, &copy.of)));
        }
    }
    for (hold, held) in d.spec.holds.iter().zip(&d.letters.held) {
        if held.variation == symbol {
            let multiplier = &d.letters.symbols.get(hold.multiplier).name;
            return of_copy(multiplier, "δ_{}".to_owned());
        }
    }
    None
}

/// The name of a letter that does not belong to a site. Momenta and rates use the number of the declared
/// configuration.
fn beside(part: &Part, symbol: SymbolId) -> String {
    let d = &part.d;
    let name = &d.letters.symbols.get(symbol).name;
    let numbered = [&d.letters.rate, &d.letters.node_momentum];
    for (i, c) in d.spec.configurations.iter().enumerate() {
        if numbered.iter().any(|all| all.get(i) == Some(&symbol)) {
            let letter: String = name.chars().take_while(|c| !c.is_ascii_digit()).collect();
            let element = &d.letters.symbols.get(c.element).name;
            return format!("{letter}{}", number(part, element));
        }
    }
    name.clone()
}

/// The number of the declared configuration, if several use the same letter.
fn number(part: &Part, of: &str) -> String {
    let mut names: Vec<&str> = Vec::new();
    for c in &part.d.spec.configurations {
        let element = &part.d.letters.symbols.get(c.element).name;
        let stated = part
            .unfolded
            .copy(element)
            .map_or(element.as_str(), |c| &c.of);
        if !names.contains(&stated) {
            names.push(stated);
        }
    }
    match names.iter().position(|n| *n == of) {
        Some(i) if names.len() > 1 => (i + 1).to_string(),
        _ => String::new(),
    }
}
