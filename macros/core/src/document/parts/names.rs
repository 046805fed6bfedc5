//! Chooses the letters of parts of vectors, points and motions so that they differ from every other letter of the
//! document.

use super::Motions;
use super::document_scan::DocumentScan;
use super::lets::Lets;
use super::letter_definitions::LetterDefinitions;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::spelling::{self, Parsed};
use crate::expr::symbol::{Role, SymbolId, Symbols};
use crate::expr::{self, Expr, Letter};
use crate::print::document::Document;
use std::collections::BTreeMap;

/// How a letter is split.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Kind {
    /// The angular and the linear part of a vector of the Lie algebra or its dual.
    Twist,
    /// Homogeneous coordinates without the last entry, and the last entry.
    Point,
    /// The rotation and the translation of a rigid motion.
    Motion,
    /// The upper left block, and the last column without its last entry.
    Matrix,
}

/// A bar and an arrow over a letter.
const BAR: char = '\u{304}';
const ARROW: char = '\u{20d7}';

/// Letters of an angular and a linear part, by the letter of the whole; the first free pair is used.
const TWISTS: [(&str, &[(&str, &str)]); 11] = [
    ("μ", MOMENTA),
    ("ν", MOMENTA),
    ("ϖ", MOMENTA),
    ("M", EDGES),
    ("Π", EDGES),
    ("ξ", VARIATIONS),
    ("χ", VARIATIONS),
    ("η", DIRECTIONS),
    ("θ", DIRECTIONS),
    ("ζ", RATES),
    ("υ", RATES),
];
const MOMENTA: &[(&str, &str)] = &[("π", "p"), ("π", "f"), ("π", "n"), ("κ", "ν")];
const EDGES: &[(&str, &str)] = &[("Π", "Q"), ("Σ", "T"), ("Φ", "Ψ")];
const VARIATIONS: &[(&str, &str)] = &[("φ", "ψ"), ("θ", "χ"), ("ε", "δ")];
const DIRECTIONS: &[(&str, &str)] = &[("α", "β"), ("ρ", "σ"), ("ϕ", "ϖ")];
const RATES: &[(&str, &str)] = &[("ω", "v"), ("ω", "w"), ("ϖ", "u")];

/// Letters of a rotation and a translation, for configurations and for velocities.
const MOTIONS: [&[(&str, &str)]; 2] = [
    &[("R", "x"), ("S", "s"), ("Q", "q"), ("T", "t"), ("B", "b")],
    &[
        ("F", "y"),
        ("F", "f"),
        ("Y", "z"),
        ("W", "w"),
        ("Z", "f"),
        ("U", "u"),
    ],
];

/// Letters of a block and a column.
const BLOCKS: [(&str, &str); 6] = [
    ("C", "c"),
    ("D", "d"),
    ("N", "n"),
    ("A", "a"),
    ("B", "b"),
    ("H", "g"),
];

/// The letters of a page, including those of parts.
pub struct Names {
    /// All symbols.
    pub symbols: Symbols,
    /// The parts of each letter that has been split.
    known: BTreeMap<(Kind, SymbolId), [SymbolId; 2]>,
    /// Pairs of letters of parts, by the letter of the whole.
    pairs: BTreeMap<(Kind, String), (String, String)>,
    /// The result of the scan of the document.
    found: DocumentScan,
    /// The letter that each part belongs to.
    pub(super) wholes: BTreeMap<SymbolId, (Kind, SymbolId)>,
    /// The names of the model.
    pub(super) lets: Lets,
    /// The letters that have been defined.
    pub(super) said: LetterDefinitions,
    /// How rigid motions are printed.
    pub(super) motions: Motions,
}

impl Names {
    /// The letters of a document with these symbols and the model's names `lets`.
    pub fn new(
        symbols: &Symbols,
        doc: &Document,
        lets: &[(String, Expr)],
        motions: Motions,
        sites: bool,
    ) -> Names {
        let mut found = DocumentScan::in_document(doc);
        // The names of the model are reserved, printed or not.
        let own = lets.iter().map(|(name, _)| spelling::parse(name).base);
        found.names.extend(own);
        let mut names = Names {
            symbols: symbols.clone(),
            known: BTreeMap::new(),
            pairs: BTreeMap::new(),
            found,
            wholes: BTreeMap::new(),
            lets: Lets::default(),
            said: LetterDefinitions::of(motions, sites),
            motions,
        };
        for (name, value) in lets {
            let value = match motions {
                Motions::InParts => names.rewritten(value),
                Motions::Whole => value.clone(),
            };
            names.lets.name(&mut names.symbols, name, &value);
        }
        names
    }

    /// The dimension of the homogeneous coordinates in the document, without the last entry.
    pub(super) fn space(&self) -> Option<Dim> {
        self.found.points.first().map(|n| expr::within(*n))
    }

    /// The parts of a letter, at its offset.
    pub fn parts(&mut self, kind: Kind, at: Letter) -> [Expr; 2] {
        let ids = match self.known.get(&(kind, at.symbol)) {
            Some(ids) => *ids,
            None => self.made(kind, at.symbol),
        };
        ids.map(|id| expr::letter(&self.symbols, id, at.shift))
    }

    /// Whether a letter is known to be split in this way.
    pub fn knows(&self, kind: Kind, symbol: SymbolId) -> bool {
        let key = (kind, symbol);
        self.found.parted.contains(&key) || self.known.contains_key(&key)
    }

    /// Whether a shape is a vector of homogeneous coordinates of the document.
    pub fn is_of_points(&self, shape: Shape) -> bool {
        shape.is_vector() && self.found.points.contains(&shape.rows)
    }

    /// An expression with the names of the model and like terms collected.
    pub fn named(&self, e: &Expr) -> Expr {
        let e = expr::shown(&self.symbols, e);
        let named = self.lets.named(&self.symbols, &e);
        match named == e {
            true => e,
            false => expr::shown(&self.symbols, &named),
        }
    }

    fn made(&mut self, kind: Kind, whole: SymbolId) -> [SymbolId; 2] {
        let symbol = self.symbols.get(whole).clone();
        let parsed = symbol.parsed();
        let space = expr::within(symbol.shape.rows);
        let vector = Shape::vector(space);
        let (shapes, structure) = match kind {
            Kind::Twist if symbol.shape.rows == Dim::Fixed(6) => {
                let three = Shape::vector(Dim::Fixed(3));
                ([three, three], Structure::General)
            }
            Kind::Twist => ([Shape::SCALAR, vector], Structure::General),
            Kind::Point => ([vector, Shape::SCALAR], Structure::General),
            Kind::Motion => ([Shape::square(space), vector], Structure::Orthogonal),
            Kind::Matrix => ([Shape::square(space), vector], Structure::General),
        };
        let names = match kind {
            Kind::Twist | Kind::Motion => {
                let (first, second) = self.pair(kind, &parsed, symbol.role);
                [
                    with_scripts(&first, &parsed),
                    with_scripts(&second, &parsed),
                ]
            }
            Kind::Point => {
                let last = self.symbols.dim_text(symbol.shape.rows);
                let mut component = with_scripts(&parsed.base, &parsed);
                component.push_str(&format!("^{{{last}}}"));
                [
                    with_scripts(&format!("{}{BAR}", parsed.base), &parsed),
                    component,
                ]
            }
            Kind::Matrix => {
                [BAR, ARROW].map(|mark| with_scripts(&format!("{}{mark}", parsed.base), &parsed))
            }
        };
        let [first, second] = names;
        let mut add = |name: &str, shape, structure| {
            let name = self.symbols.fresh_name(name);
            self.symbols.add(&name, shape, structure, symbol.role)
        };
        let ids = [
            add(&first, shapes[0], structure),
            add(&second, shapes[1], Structure::General),
        ];
        if let Some(latex) = symbol
            .typeset
            .filter(|_| matches!(kind, Kind::Point | Kind::Matrix))
        {
            let last = self.symbols.dim_text(symbol.shape.rows);
            let second = match kind {
                Kind::Point => format!("{{{latex}}}^{{{last}}}"),
                _ => format!("\\vec{{{latex}}}"),
            };
            self.symbols
                .describe(ids[0], Some(format!("\\bar{{{latex}}}")), &[]);
            self.symbols.describe(ids[1], Some(second), &[]);
        }
        self.known.insert((kind, whole), ids);
        self.wholes.extend(ids.map(|id| (id, (kind, whole))));
        ids
    }

    /// Letters for the blocks of a matrix, whose values get equations of their own.
    pub fn blocks(&mut self, space: Dim) -> [Expr; 2] {
        let free = BLOCKS.iter().find(|(a, b)| {
            let none = spelling::parse("");
            self.is_free(a, &none) && self.is_free(b, &none)
        });
        let (a, b) = free.unwrap_or(&BLOCKS[0]);
        let mut add = |name: &str, shape| {
            let name = self.symbols.fresh_name(name);
            let id = self
                .symbols
                .add(&name, shape, Structure::General, Role::Derived);
            expr::here(&self.symbols, id)
        };
        [add(a, Shape::square(space)), add(b, Shape::vector(space))]
    }

    /// The letters of the two parts, without scripts.
    fn pair(&mut self, kind: Kind, of: &Parsed, role: Role) -> (String, String) {
        let key = (kind, of.base.clone());
        if let Some(pair) = self.pairs.get(&key) {
            return pair.clone();
        }
        let candidates: &[(&str, &str)] = match kind {
            Kind::Motion => MOTIONS[usize::from(role == Role::Velocity)],
            _ => {
                let found = TWISTS.iter().find(|(whole, _)| *whole == of.base);
                found.map_or(&[], |(_, pairs)| *pairs)
            }
        };
        let owned = |(a, b): &(&str, &str)| ((*a).to_owned(), (*b).to_owned());
        let free = candidates
            .iter()
            .find(|(a, b)| self.is_free(a, of) && self.is_free(b, of));
        let marks = match kind {
            Kind::Motion => ("rot", "pos"),
            _ => ("ang", "lin"),
        };
        let marked = |mark: &str| format!("{}^{{{mark}}}", of.base);
        let pair = free.map_or_else(|| (marked(marks.0), marked(marks.1)), owned);
        self.pairs.insert(key, pair.clone());
        pair
    }

    fn is_free(&self, letter: &str, of: &Parsed) -> bool {
        let scripted = with_scripts(letter, of);
        let unused = |name: &str| self.symbols.fresh_name(name) == name;
        let paired = |(a, b): &(String, String)| a == letter || b == letter;
        !self.found.names.contains(letter)
            && unused(letter)
            && unused(&scripted)
            && !self.pairs.values().any(paired)
    }

    /// Replaces the letters of parts in an expression by parts of the whole.
    #[cfg(test)]
    pub fn written_out(&self, e: &Expr) -> Expr {
        let e = &self.lets.written_out(&self.symbols, e);
        let wholes = expr::letters(e).into_iter().filter_map(|at| {
            let (kind, whole) = *self.wholes.get(&at.symbol)?;
            let part = self
                .known
                .get(&(kind, whole))?
                .iter()
                .position(|id| *id == at.symbol)?;
            let of = expr::letter(&self.symbols, whole, at.shift);
            let rows = of.shape().rows;
            let take = |from, count| expr::rows_of(&self.symbols, &of, from, count);
            let put = || expr::inclusion(rows, expr::within(rows), 0);
            let last = || expr::unit(rows, expr::last_axis(rows));
            let taken = |end| expr::product([expr::transposed(put()), of.clone(), end]);
            let three = Dim::Fixed(3);
            Some((
                at,
                match (kind, part) {
                    (Kind::Twist, 0) if rows == Dim::Fixed(6) => take(0, three),
                    (Kind::Twist, _) if rows == Dim::Fixed(6) => take(3, three),
                    (Kind::Twist, 0) => take(0, Dim::Fixed(1)),
                    (Kind::Twist, _) => take(1, Dim::Fixed(2)),
                    (Kind::Point, 0) => take(0, expr::within(rows)),
                    (Kind::Point, _) => expr::dot(last(), of.clone()),
                    (Kind::Motion, 0) => expr::block(&self.symbols, &of),
                    (Kind::Motion, _) => expr::column(&self.symbols, &of),
                    (Kind::Matrix, 0) => taken(put()),
                    (Kind::Matrix, _) => taken(last()),
                },
            ))
        });
        expr::substitute(&self.symbols, e, &wholes.collect::<Vec<_>>())
    }
}

/// A letter with the scripts of the name of the whole.
fn with_scripts(letter: &str, of: &Parsed) -> String {
    let mut name = letter.to_owned();
    for sub in &of.subs {
        name.push_str(&format!("_{{{sub}}}"));
    }
    if let (Some(sup), false) = (&of.sup, letter.contains('^')) {
        name.push_str(&format!("^{{{sup}}}"));
    }
    name
}
