//! A chain with chosen ends as data: a chain that is expanded body by body, or the short chain that describes a longer one.

use super::words::{of_words, words};
use super::{Body, Data, json};
use crate::Refused;
use crate::constants::Constants;
use clebsch_core::diagnostic::Report;
use clebsch_core::document::CardWords as Words;
use clebsch_core::lattice::{ChainConfig, ExpandedModel, Lattice};
use clebsch_core::line::{self, Signs, Wall, totals_on};
use clebsch_core::syntax::ast::Model;
use clebsch_core::{Derivation, document, emit, pipeline};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A chain of few sites, expanded body by body.
#[derive(Clone, Debug)]
pub(crate) struct Expanded {
    /// Its program and its warnings.
    pub body: Body,
    /// Its description.
    pub words: Words,
    /// Quantities whose signs must agree along the chain.
    pub signs: Vec<Signs>,
}

/// A short chain, from which the card of a longer chain with the same ends is built.
#[derive(Clone, Debug)]
pub(crate) struct Short {
    /// The name of the model.
    pub name: String,
    /// The emitted card.
    pub card: String,
    /// Its description.
    pub words: Words,
    /// The names of its totals, and the terms that they sum.
    pub totals: Vec<(String, String)>,
    /// Warnings on the text.
    pub warnings: Vec<Report>,
}

impl Expanded {
    /// Derives a chain.
    ///
    /// # Errors
    /// [`Refused`], if the chain cannot be derived or does not have a stepper.
    pub fn derive(model: &Model, lattice: &Lattice, choice: &ChainConfig) -> Result<Self, Refused> {
        let derived = pipeline::derive_lattice(model, lattice, choice);
        let (unfolded, d) = derived.map_err(Refused::Model)?;
        let body = Body::of(&d, reports(&unfolded, choice, &d))?;
        let (_, solver) = card_and_solver(&d)?;
        Ok(Expanded {
            body,
            words: document::card_words(lattice, choice, unfolded, &d, solver),
            // A model that cannot be read as a chain does not need aligned signs.
            signs: line::signs(model, lattice).unwrap_or_default(),
        })
    }
}

impl Short {
    /// Derives a short chain.
    ///
    /// # Errors
    /// [`Refused`], if the chain cannot be derived or does not have a stepper.
    pub fn derive(model: &Model, lattice: &Lattice, choice: &ChainConfig) -> Result<Self, Refused> {
        let derived = pipeline::derive_lattice(model, lattice, choice);
        let (unfolded, d) = derived.map_err(Refused::Model)?;
        if let Some(refused) = emit::refusal_of_read(&d) {
            return Err(Refused::Model(refused.into()));
        }
        let (card, solver) = card_and_solver(&d)?;
        Ok(Short {
            name: d.spec.name.clone(),
            card,
            totals: totals_on(lattice, choice, &unfolded, &d),
            warnings: reports(&unfolded, choice, &d),
            words: document::card_words(lattice, choice, unfolded, &d, solver),
        })
    }
}

fn reports(unfolded: &ExpandedModel, choice: &ChainConfig, d: &Derivation) -> Vec<Report> {
    let warnings = unfolded.declared_warnings(choice, &d.warnings);
    warnings.iter().map(|w| w.diagnostic.report()).collect()
}

/// The emitted card of a derivation, and its words for the solver.
fn card_and_solver(d: &Derivation) -> Result<(String, &'static str), Refused> {
    let card = emit::emit_card(d).to_string();
    let read = super::program(&card)?;
    let none = BTreeMap::new();
    let solver = Constants::new(&read, &d.spec.name, &none).card()?.solver;
    Ok((card, solver))
}

impl Data for Expanded {
    const KIND: &'static str = "expanded";

    fn to_json(&self) -> Value {
        let signs: Vec<Value> = self.signs.iter().map(of_signs).collect();
        json!({ "body": self.body.to_json(), "words": of_words(&self.words), "signs": signs })
    }

    fn from_json(json: &Value) -> Option<Self> {
        Some(Expanded {
            body: Body::from_json(json.get("body")?)?,
            words: words(json.get("words")?)?,
            signs: json::list(json, "signs", signs)?,
        })
    }
}

impl Data for Short {
    const KIND: &'static str = "short";

    fn to_json(&self) -> Value {
        json!({
            "name": self.name,
            "card": self.card,
            "words": of_words(&self.words),
            "totals": self.totals,
            "warnings": json::of_reports(&self.warnings),
        })
    }

    fn from_json(json: &Value) -> Option<Self> {
        Some(Short {
            name: json::text(json, "name")?,
            card: json::text(json, "card")?,
            words: words(json.get("words")?)?,
            totals: json::list(json, "totals", |own| {
                let [name, terms] = own.as_array()?.as_slice() else {
                    return None;
                };
                Some((name.as_str()?.to_owned(), terms.as_str()?.to_owned()))
            })?,
            warnings: json::reports(json, "warnings")?,
        })
    }
}

fn of_signs(signs: &Signs) -> Value {
    let walls = signs.walls.each_ref().map(|walls| {
        let each = walls.iter();
        let each =
            each.map(|w| json!({ "which": w.which, "parameter": w.parameter, "site": w.site }));
        each.collect::<Vec<Value>>()
    });
    json!({ "of": signs.of, "seen": signs.seen, "first": walls[0], "last": walls[1] })
}

fn signs(json: &Value) -> Option<Signs> {
    let walls = |name: &str| {
        json::list(json, name, |own| {
            Some(Wall {
                which: json::count(own, "which")?,
                parameter: json::text(own, "parameter")?,
                site: json::count(own, "site")?,
            })
        })
    };
    Some(Signs {
        of: json::text(json, "of")?,
        seen: json::truth(json, "seen")?,
        walls: [walls("first")?, walls("last")?],
    })
}
