//! The cards of texts. A card borrows its names for as long as the process lives, so clebsch reads each text once and keeps
//! the result.

use crate::Refused;
use crate::lines::{Carded, LineModel, NoLine};
use crate::opened::{Opened, Text};
use crate::signs::Agreement;
use clebsch::card::{Card, Invariant, OpenError, Settings};
use clebsch_core::derive::warnings::Warning;
use clebsch_core::document::{self, InvariantWords};
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Statement};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

/// A card, and the warnings of its text.
type CardWithWarnings = (Card, Vec<Warning>);

/// Cards by their texts and the chosen sizes or sites, and whether the text has warnings.
static KNOWN: RwLock<BTreeMap<String, (Card, bool)>> = RwLock::new(BTreeMap::new());

/// The card of a key, computed once. Places in a text belong to the thread that has read it: if the text has warnings, it is
/// derived again for them.
fn once(
    key: String,
    make: impl FnOnce(Option<Card>) -> Result<CardWithWarnings, Refused>,
) -> Result<CardWithWarnings, Refused> {
    let all = KNOWN.read().unwrap_or_else(PoisonError::into_inner);
    let known = all.get(&key).copied();
    drop(all);
    if let Some((card, false)) = known {
        return Ok((card, Vec::new()));
    }
    let (card, warnings) = make(known.map(|(card, _)| card))?;
    let mut all = KNOWN.write().unwrap_or_else(PoisonError::into_inner);
    // Another thread may have been first.
    let (card, _) = *all.entry(key).or_insert((card, !warnings.is_empty()));
    Ok((card, warnings))
}

/// The largest number of sites of a label.
pub const MOST_SITES: usize = 10_000_000;

/// The largest number of segments or sites of a label for which clebsch expands a chain body by body. The work grows
/// with the square of that number; here it takes a second or two.
pub const MOST_BODY_BY_BODY: usize = 32;

/// The same limit for chains with constraints. It is zero: a step body by body solves for all velocities and
/// multipliers at once. It also proves that the root is principal, which takes a minute for four links.
pub const MOST_HELD_BODY_BY_BODY: usize = 0;

/// The same limit if a term couples velocities of neighbours: a step body by body then also solves for all velocities
/// at once.
pub const MOST_TOGETHER_BODY_BY_BODY: usize = 8;

/// The largest number of sites that clebsch expands body by body.
fn most_body_by_body(model: &Model) -> usize {
    let is_held = model
        .statements
        .iter()
        .any(|s| matches!(s, Statement::Hold { .. }));
    match is_held {
        true => MOST_HELD_BODY_BY_BODY,
        false => MOST_BODY_BY_BODY,
    }
}

/// The card of the model in a text: a bare `model NAME { ... }`, or Rust source with one `model! { ... }`. Each named
/// size is 3 if the model admits it, otherwise the smallest admitted size.
///
/// # Errors
/// [`Refused`], if the text is not a valid model or the model needs a build.
pub fn card(source: &str) -> Result<Card, Refused> {
    card_and_warnings(source).map(|(card, _)| card)
}

/// The card of a text and the warnings about the model.
///
/// # Errors
/// As [`card`].
pub fn card_and_warnings(source: &str) -> Result<(Card, Vec<Warning>), Refused> {
    at_sizes(source, None)
}

/// The card of a model with labels for the chosen numbers of sites and end conditions, and the warnings about the
/// model.
///
/// # Errors
/// As [`card`].
pub fn card_on_lattice(
    source: &str,
    choice: &ChainConfig,
) -> Result<(Card, Vec<Warning>), Refused> {
    once(format!("{choice:?}\n{source}"), |known| {
        on_lattice(source, choice, known)
    })
}

fn on_lattice(
    source: &str,
    choice: &ChainConfig,
    known: Option<Card>,
) -> Result<CardWithWarnings, Refused> {
    let model = pipeline::parse_source(source).map_err(Refused::Model)?;
    let lattice = Lattice::read(&model).map_err(Refused::Model)?;
    let mut written_out = None;
    let sites = lattice.labels.iter().zip(&choice.counts);
    if let Some((label, n)) = sites.max_by_key(|(_, n)| **n)
        && *n > MOST_SITES
    {
        return Err(Refused::TooManySites {
            asked: (label.index.text.clone(), *n),
            most: MOST_SITES,
        });
    }
    // Functionals of all sites cannot be expanded body by body.
    if !lattice.meshes.is_empty() {
        return match LineModel::read(source) {
            Ok(line) => card_of_line((&model, &lattice), choice, line, source, known),
            Err(NoLine::Form(why)) => Err(Refused::Form { why }),
            Err(NoLine::Refused(refused)) => Err(refused),
        };
    }
    let most = most_body_by_body(&model);
    let beyond = |most: usize| choice.counts.iter().any(|n| *n > most);
    if beyond(most.min(MOST_TOGETHER_BODY_BY_BODY)) {
        match LineModel::read(source) {
            Ok(line) if !beyond(most) && !line.is_solved_together() => {}
            Ok(line) => return card_of_line((&model, &lattice), choice, line, source, known),
            Err(_) if !beyond(most) => {}
            Err(NoLine::Form(why)) => written_out = Some(why),
            // If the interpreter does not support a construct of the program with loops, clebsch expands the chain body
            // by body.
            Err(NoLine::Refused(Refused::Construct(what))) => {
                written_out = Some(format!("`{what}` is not supported there"));
            }
            Err(NoLine::Refused(refused)) => return Err(refused),
        }
    }
    let longest = lattice.labels.iter().zip(&choice.counts);
    let longest = longest.max_by_key(|(_, n)| **n);
    if let (Some(why), Some((label, n))) = (&written_out, longest)
        && *n > MOST_BODY_BY_BODY
    {
        return Err(Refused::TooLong {
            why: why.clone(),
            asked: (label.index.text.clone(), *n),
            most: MOST_BODY_BY_BODY,
        });
    }
    match body_by_body((&model, &lattice), choice, source, written_out, known) {
        // If the chain is too large to expand body by body, use the program with loops over sites.
        Err(Refused::Model(errors)) if errors.are_of_size() => match LineModel::read(source) {
            Ok(line) => card_of_line((&model, &lattice), choice, line, source, known),
            Err(_) => Err(Refused::Model(errors)),
        },
        card => card,
    }
}

/// The card of a model with labels, always expanded body by body. Tests compare loops over sites with it.
///
/// # Errors
/// As [`card`].
pub fn card_body_by_body(
    source: &str,
    choice: &ChainConfig,
) -> Result<(Card, Vec<Warning>), Refused> {
    once(format!("body by body, {choice:?}\n{source}"), |known| {
        let model = pipeline::parse_source(source).map_err(Refused::Model)?;
        let lattice = Lattice::read(&model).map_err(Refused::Model)?;
        body_by_body((&model, &lattice), choice, source, None, known)
    })
}

/// The card of an expanded chain. If loops over sites were wanted, `written_out` says why they are not used.
fn body_by_body(
    (model, lattice): (&Model, &Lattice),
    choice: &ChainConfig,
    source: &str,
    written_out: Option<String>,
    known: Option<Card>,
) -> Result<CardWithWarnings, Refused> {
    let derived = pipeline::derive_lattice(model, lattice, choice);
    let (unfolded, d) = derived.map_err(Refused::Model)?;
    let warnings = unfolded.declared_warnings(choice, &d.warnings);
    if let Some(card) = known {
        return Ok((card, warnings));
    }
    let text = Text::of_derivation(d)?;
    let mut opened = Opened::read(&text, None)?;
    // A model that cannot be read as a chain does not need aligned signs.
    let signs = clebsch_core::line::signs(model, lattice).unwrap_or_default();
    opened.signs = Agreement::of(signs, lattice, choice, &opened.card);
    let card = kept(opened, |_| None);
    let d = &text.derivation;
    let words = document::card_words(lattice, choice, unfolded, d, card.solver);
    let invariants = named(card.invariants, words.invariants);
    let card = Card {
        source: crate::text(source),
        summary: crate::text(&match written_out {
            None => words.summary,
            Some(why) => format!(
                "{}\nprogram              expanded body by body, without loops over sites: {why}",
                words.summary
            ),
        }),
        solver: crate::text(&words.solver),
        invariants: Box::leak(invariants.into_boxed_slice()),
        ..card
    };
    Ok((card, warnings))
}

/// Groups the invariants of an expanded chain as `words` lists them: like invariants of several sites become one with
/// more rows.
pub(crate) fn named(own: &[Invariant], words: Vec<InvariantWords>) -> Vec<Invariant> {
    let mut own = own.iter();
    let of = |told: InvariantWords| {
        let first = own.next()?;
        let others = own.by_ref().take(told.count.saturating_sub(1));
        Some(Invariant {
            name: crate::text(&told.name),
            formula: crate::text(&told.formula),
            rows: others.map(|i| i.rows).sum::<usize>() + first.rows,
            ..*first
        })
    };
    words.into_iter().filter_map(of).collect()
}

/// The card of a chain that runs with loops over sites.
fn card_of_line(
    stated: (&Model, &Lattice),
    choice: &ChainConfig,
    line: Arc<LineModel>,
    source: &str,
    known: Option<Card>,
) -> Result<CardWithWarnings, Refused> {
    let (mut carded, warnings) = Carded::of(stated, choice, line, source)?;
    if let Some(card) = known {
        return Ok((card, warnings));
    }
    let place: &'static OnceLock<Carded> = Box::leak(Box::default());
    let open = move |parameters: &[Vec<f64>], initial: &[Vec<f64>], settings: Settings| {
        let line = place.get().ok_or(NOT_OPEN)?;
        line.open(parameters, initial, settings)
    };
    carded.card.open = Box::leak(Box::new(open));
    Ok((place.get_or_init(|| carded).card, warnings))
}

/// The card at given sizes.
fn at_sizes(source: &str, sizes: Option<&[usize]>) -> Result<CardWithWarnings, Refused> {
    once(format!("{sizes:?}\n{source}"), |known| {
        let text = derived(source)?;
        let warnings = text.derivation.warnings.clone();
        if let Some(card) = known {
            return Ok((card, warnings));
        }
        let own = source.to_owned();
        let resize = move |sizes: &[usize]| at_sizes(&own, Some(sizes)).ok();
        Ok((kept(Opened::read(&text, sizes)?, resize), warnings))
    })
}

thread_local! {
    /// The text that this thread derived last: all sizes of a model share one program.
    static DERIVED: RefCell<Option<(String, Rc<Text>)>> = const { RefCell::new(None) };
}

/// The derivation of a text and its program, computed once for all sizes.
fn derived(source: &str) -> Result<Rc<Text>, Refused> {
    let known = DERIVED.with_borrow(|last| {
        let found = last.as_ref().filter(|(text, _)| text == source);
        found.map(|(_, made)| made.clone())
    });
    if let Some(known) = known {
        return Ok(known);
    }
    let made = Rc::new(Text::of(source)?);
    DERIVED.set(Some((source.to_owned(), made.clone())));
    Ok(made)
}

/// A card contains the function that opens its model, and the model contains its card, so the model is set last.
const NOT_OPEN: OpenError = OpenError::Solver { offered: &[] };

/// Opens a model and returns its card; `resize` returns its cards of other sizes.
fn kept(
    mut model: Opened,
    resize: impl Fn(&[usize]) -> Option<CardWithWarnings> + Sync + 'static,
) -> Card {
    let place: &'static OnceLock<Opened> = Box::leak(Box::default());
    let open = move |parameters: &[Vec<f64>], initial: &[Vec<f64>], settings: Settings| {
        let model = place.get().ok_or(NOT_OPEN)?;
        model.open(parameters, initial, settings)
    };
    let sized = move |sizes: &[usize]| match place.get() {
        Some(model) if model.sizes == sizes => Some(model.card),
        _ => resize(sizes).map(|(card, _)| card),
    };
    model.card.open = Box::leak(Box::new(open));
    model.card.sized = Box::leak(Box::new(sized));
    place.get_or_init(|| model).card
}
