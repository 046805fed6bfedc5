//! The cards of texts. A card borrows its names for as long as the process lives, so clebsch reads each text once and keeps
//! the result.

use crate::Refused;
use crate::cache::Cache;
use crate::derivatives::Differentiated;
use crate::derived::{self, Body, Expanded};
use crate::lines::{Carded, LineModel, NoLine};
use crate::opened::{Opened, Text};
use crate::signs::Agreement;
use clebsch::card::{Card, Invariant, OpenError, Settings};
use clebsch_core::diagnostic::Report;
use clebsch_core::document::InvariantWords;
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Statement};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::rc::Rc;
use std::sync::{Arc, OnceLock, PoisonError, RwLock};

/// A card, and the warnings of its text.
type CardWithWarnings = (Card, Vec<Report>);

/// Cards with the warnings of their texts, by the texts and the chosen sizes or sites.
static KNOWN: RwLock<BTreeMap<String, CardWithWarnings>> = RwLock::new(BTreeMap::new());

/// The card of a key, computed once.
fn once(
    key: String,
    make: impl FnOnce() -> Result<CardWithWarnings, Refused>,
) -> Result<CardWithWarnings, Refused> {
    let all = KNOWN.read().unwrap_or_else(PoisonError::into_inner);
    let known = all.get(&key).cloned();
    drop(all);
    if let Some(known) = known {
        return Ok(known);
    }
    let made = make()?;
    let mut all = KNOWN.write().unwrap_or_else(PoisonError::into_inner);
    // Another thread may have been first.
    Ok(all.entry(key).or_insert(made).clone())
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
pub fn card_and_warnings(source: &str) -> Result<(Card, Vec<Report>), Refused> {
    Cache::none().card(source)
}

/// The card of a model with labels for the chosen numbers of sites and end conditions, and the warnings about the
/// model.
///
/// # Errors
/// As [`card`].
pub fn card_on_lattice(source: &str, choice: &ChainConfig) -> Result<(Card, Vec<Report>), Refused> {
    Cache::none().card_on_lattice(source, choice)
}

impl Cache {
    /// The card of a text and the warnings about the model, as [`card_and_warnings`]. The text is derived only if this
    /// cache does not have it.
    ///
    /// # Errors
    /// As [`card`].
    pub fn card(&self, source: &str) -> Result<(Card, Vec<Report>), Refused> {
        at_sizes(source, None, self)
    }

    /// The card of a model with labels for the chosen numbers of sites and end conditions, as [`card_on_lattice`]. The
    /// text is derived only if this cache does not have it.
    ///
    /// # Errors
    /// As [`card`].
    pub fn card_on_lattice(
        &self,
        source: &str,
        choice: &ChainConfig,
    ) -> Result<(Card, Vec<Report>), Refused> {
        once(format!("{choice:?}\n{source}"), || {
            on_lattice(source, choice, self)
        })
    }
}

fn on_lattice(
    source: &str,
    choice: &ChainConfig,
    cache: &Cache,
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
        return match LineModel::read_with(source, cache) {
            Ok(line) => card_of_line((&model, &lattice), choice, line, (source, cache)),
            Err(NoLine::Form(why)) => Err(Refused::Form { why }),
            Err(NoLine::Refused(refused)) => Err(refused),
        };
    }
    let most = most_body_by_body(&model);
    let beyond = |most: usize| choice.counts.iter().any(|n| *n > most);
    if beyond(most.min(MOST_TOGETHER_BODY_BY_BODY)) {
        match LineModel::read_with(source, cache) {
            Ok(line) if !beyond(most) && !line.is_solved_together() => {}
            Ok(line) => return card_of_line((&model, &lattice), choice, line, (source, cache)),
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
    match body_by_body((&model, &lattice), choice, (source, cache), written_out) {
        // If the chain is too large to expand body by body, use the program with loops over sites.
        Err(Refused::Model(errors)) if errors.are_of_size() => {
            match LineModel::read_with(source, cache) {
                Ok(line) => card_of_line((&model, &lattice), choice, line, (source, cache)),
                Err(_) => Err(Refused::Model(errors)),
            }
        }
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
) -> Result<(Card, Vec<Report>), Refused> {
    once(format!("body by body, {choice:?}\n{source}"), || {
        let model = pipeline::parse_source(source).map_err(Refused::Model)?;
        let lattice = Lattice::read(&model).map_err(Refused::Model)?;
        let stated = (source, &Cache::none());
        body_by_body((&model, &lattice), choice, stated, None)
    })
}

/// The card of an expanded chain. If loops over sites were wanted, `written_out` says why they are not used.
fn body_by_body(
    (model, lattice): (&Model, &Lattice),
    choice: &ChainConfig,
    (source, cache): (&str, &Cache),
    written_out: Option<String>,
) -> Result<CardWithWarnings, Refused> {
    let Expanded { body, words, signs } =
        derived::kept(cache, (&format!("{choice:?}"), source), || {
            Expanded::derive(model, lattice, choice)
        })?;
    let text = Text::read(body)?;
    let mut opened = Opened::read(&text, None)?;
    opened.signs = Agreement::of(signs, lattice, choice, &opened.card);
    let card = kept(opened, |_| None);
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
    Ok((card, text.body.warnings))
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
    text: (&str, &Cache),
) -> Result<CardWithWarnings, Refused> {
    let (mut carded, warnings) = Carded::of(stated, choice, line, text)?;
    let place: &'static OnceLock<Carded> = Box::leak(Box::default());
    let open = move |parameters: &[Vec<f64>], initial: &[Vec<f64>], settings: Settings| {
        let line = place.get().ok_or(NOT_OPEN)?;
        line.open(parameters, initial, settings)
    };
    let differentiate = move |parameters: &[Vec<f64>], initial: &[Vec<f64>], settings: Settings| {
        let line = place.get().ok_or(NOT_OPEN)?;
        Differentiated::open(line, parameters, initial, settings)
    };
    carded.card.open = Box::leak(Box::new(open));
    carded.card.differentiate = Some(Box::leak(Box::new(differentiate)));
    Ok((place.get_or_init(|| carded).card, warnings))
}

/// The card at given sizes.
fn at_sizes(
    source: &str,
    sizes: Option<&[usize]>,
    cache: &Cache,
) -> Result<CardWithWarnings, Refused> {
    once(format!("{sizes:?}\n{source}"), || {
        let text = program_of(source, cache)?;
        let (own, cache) = (source.to_owned(), cache.clone());
        let resize = move |sizes: &[usize]| at_sizes(&own, Some(sizes), &cache).ok();
        let card = kept(Opened::read(&text, sizes)?, resize);
        Ok((card, text.body.warnings.clone()))
    })
}

thread_local! {
    /// The text that this thread read last: all sizes of a model share one program.
    static DERIVED: RefCell<Option<(String, Rc<Text>)>> = const { RefCell::new(None) };
}

/// The program of a text, read once for all sizes.
fn program_of(source: &str, cache: &Cache) -> Result<Rc<Text>, Refused> {
    let known = DERIVED.with_borrow(|last| {
        let found = last.as_ref().filter(|(text, _)| text == source);
        found.map(|(_, made)| made.clone())
    });
    if let Some(known) = known {
        return Ok(known);
    }
    let body = derived::kept(cache, ("", source), || Body::derive(source))?;
    let made = Rc::new(Text::read(body)?);
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
    let differentiate = move |parameters: &[Vec<f64>], initial: &[Vec<f64>], settings: Settings| {
        let model = place.get().ok_or(NOT_OPEN)?;
        Differentiated::open(model, parameters, initial, settings)
    };
    model.card.open = Box::leak(Box::new(open));
    model.card.differentiate = Some(Box::leak(Box::new(differentiate)));
    model.card.sized = Box::leak(Box::new(sized));
    place.get_or_init(|| model).card
}
