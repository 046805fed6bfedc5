//! Sentences that define the letters of parts and the names of a model, after the equation where they first occur.

use super::Motions;
use super::names::{Kind, Names};
use super::rigid_motion_patterns::taken_kind;
use crate::expr::shape::{Dim, Shape};
use crate::expr::spelling;
use crate::expr::symbol::SymbolId;
use crate::expr::{self, Expr, Letter, Node};
use crate::print::document::{Block, Inline};
use crate::print::formula::Formula;
use std::collections::BTreeSet;

/// A value with at least this many expression nodes gets an equation of its own.
const LONG: u32 = 20;

/// The letters that have been defined, and those still to define.
#[derive(Default)]
pub struct LetterDefinitions {
    /// Letters whose parts have been defined, or are pending.
    known: BTreeSet<(Kind, String)>,
    /// Whether the letters of one site define those of all sites.
    sites: bool,
    /// The pending letters.
    pending: Vec<(Kind, SymbolId)>,
    /// Names of the model that have been defined, or are pending.
    told: BTreeSet<SymbolId>,
    /// The pending names.
    new: Vec<SymbolId>,
    /// Whether entries such as `x_{1:3}` of expressions without letters for them were printed, and whether they were
    /// explained.
    entries: [bool; 2],
}

impl LetterDefinitions {
    /// Nothing defined yet. With `sites`, the letters of one site define those of all. If motions stay whole, entries
    /// use the notation of the language and need no explanation.
    pub fn of(motions: Motions, sites: bool) -> LetterDefinitions {
        LetterDefinitions {
            sites,
            entries: [false, motions == Motions::Whole],
            ..LetterDefinitions::default()
        }
    }
}

impl Names {
    /// Records which letters of parts a formula contains.
    pub fn printed(&mut self, f: &Formula) {
        f.each_expression(&mut |e| {
            for at in expr::letters(e) {
                if let Some((kind, whole)) = self.wholes.get(&at.symbol).copied() {
                    self.said_next(kind, whole);
                }
                if self.lets.value(at.symbol).is_some() && self.said.told.insert(at.symbol) {
                    self.said.new.push(at.symbol);
                }
            }
            self.said.entries[0] |= takes_entries(e);
        });
    }

    /// Makes a letter pending unless it has been defined. Of several sites, it keeps the letter with the shortest
    /// index.
    fn said_next(&mut self, kind: Kind, whole: SymbolId) {
        let name = |id| &self.symbols.get(id).name;
        let key = |id| match self.said.sites {
            true => spelling::parse(name(id)).base,
            false => name(id).clone(),
        };
        let own = key(whole);
        let alike = |(k, id): &(Kind, SymbolId)| *k == kind && key(*id) == own;
        match self.said.pending.iter().position(alike) {
            Some(i) => {
                if let Some((_, other)) = self.said.pending.get(i)
                    && name(whole).len() < name(*other).len()
                {
                    self.said.pending[i] = (kind, whole);
                }
            }
            None => {
                if self.said.known.insert((kind, own)) {
                    self.said.pending.push((kind, whole));
                }
            }
        }
    }

    /// The sentence that defines pending letters and names, if there are any, and equations for long values.
    pub fn introduced(&mut self) -> Vec<Block> {
        // The definition of a name may contain further names.
        let mut named = Vec::new();
        while !self.said.new.is_empty() {
            for symbol in std::mem::take(&mut self.said.new) {
                if let Some(value) = self.lets.value(symbol).cloned() {
                    let size = value.size();
                    let own = Formula::Expr(expr::here(&self.symbols, symbol));
                    let definition = Formula::defined(own, value);
                    self.printed(&definition);
                    named.insert(0, (size, definition));
                }
            }
        }
        let mut pending = std::mem::take(&mut self.said.pending);
        pending.sort_by_key(|(kind, _)| *kind);
        let mut words: Vec<Inline> = Vec::new();
        for group in pending.chunk_by(|a, b| a.0 == b.0) {
            for (i, (kind, whole)) in group.iter().enumerate() {
                words.push(match (words.is_empty(), i) {
                    (true, _) => "We write ".into(),
                    (false, 0) => "; ".into(),
                    (false, _) if i + 1 == group.len() => " and ".into(),
                    (false, _) => ", ".into(),
                });
                words.push(self.definition(*kind, *whole).into());
            }
            if let Some((kind, whole)) = group.first() {
                words.push(parts_in_words(*kind, self.symbols.get(*whole).shape).into());
            }
        }
        let (long, short): (Vec<_>, Vec<_>) = named.into_iter().partition(|(size, _)| *size > LONG);
        for (_, definition) in short {
            words.push(match words.is_empty() {
                true => "We write ".into(),
                false => "; ".into(),
            });
            words.push(definition.into());
        }
        if self.said.entries == [true, false] {
            self.said.entries[1] = true;
            words.push(match words.is_empty() {
                true => "We write ".into(),
                false => "; ".into(),
            });
            let mut letters = ["Y", "X", "B", "A"].into_iter();
            let letter = letters
                .rfind(|l| self.symbols.fresh_name(l) == *l)
                .unwrap_or("A");
            let n = self
                .space()
                .map_or_else(String::new, |n| self.symbols.dim_text(n));
            words.push(Formula::name(&format!("{letter}_{{1:{n},1:{n}}}")).into());
            words.push(" for the entries in these rows and columns".into());
        }
        let mut blocks = Vec::new();
        if !words.is_empty() {
            words.push(".".into());
            blocks.push(Block::Paragraph(words));
        }
        let mut long: Vec<Formula> = long.into_iter().map(|(_, definition)| definition).collect();
        let formula = match long.len() {
            0 => return blocks,
            1 => long.remove(0),
            _ => Formula::Rows(long),
        };
        blocks.push(Block::Paragraph(vec!["The model names".into()]));
        blocks.push(Block::Equation {
            formula,
            tag: None,
            note: None,
            label: None,
        });
        blocks
    }

    fn definition(&mut self, kind: Kind, whole: SymbolId) -> Formula {
        let at = Letter {
            symbol: whole,
            shift: expr::Shift::HERE,
        };
        let parts = self.parts(kind, at).map(Formula::Expr);
        let own = Formula::Expr(expr::here(&self.symbols, whole));
        match kind {
            Kind::Twist | Kind::Point | Kind::Motion => {
                let pair = Formula::Grouped(Box::new(Formula::List(parts.into())));
                Formula::equal(own, pair)
            }
            Kind::Matrix => {
                let [block, column] = parts;
                let any = || Formula::name("*");
                let rows = vec![vec![block, column], vec![any(), any()]];
                Formula::equal(own, Formula::Matrix(rows))
            }
        }
    }
}

/// Describes the parts in words.
fn parts_in_words(kind: Kind, shape: Shape) -> &'static str {
    match kind {
        Kind::Twist => ", angular and linear part",
        Kind::Point if shape.rows == Dim::Fixed(3) => ", the first two entries and the last",
        Kind::Point => ", the first three entries and the last",
        Kind::Motion => ", rotation and translation",
        Kind::Matrix => " by blocks",
    }
}

/// Whether an expression takes entries of homogeneous coordinates.
fn takes_entries(e: &Expr) -> bool {
    let takes = match e.node() {
        Node::Product(list) => list.iter().any(|f| taken_kind(f) == Some(Kind::Point)),
        _ => false,
    };
    takes || e.children().into_iter().any(takes_entries)
}
