//! Models that are open in this process. A card starts trajectories by a function without captures, so
//! each open model has a number, and each number a function.

use crate::Refused;
use crate::lines::{Carded, LineModel, NoLine};
use crate::opened::{Opened, Text};
use crate::signs::Agreement;
use clebsch::card::{Card, Invariant, Open, OpenError, Settings, Trajectory};
use clebsch_core::derive::warnings::Warning;
use clebsch_core::document::{self, InvariantWords};
use clebsch_core::lattice::{Choice, Lattice};
use clebsch_core::pipeline;
use clebsch_core::syntax::ast::{Model, Statement};
use std::cell::RefCell;
use std::rc::Rc;
use std::sync::{Arc, PoisonError, RwLock};

/// What is open, by number; each stays for as long as the process, as its card may.
static OPEN: RwLock<Vec<Known>> = RwLock::new(Vec::new());

/// An open model.
#[derive(Clone, Copy)]
enum Known {
    /// One of bodies.
    Bodies(&'static Opened),
    /// A line, found by its key.
    Line(&'static str, &'static Carded),
}

/// Most sites of a label.
pub const MOST_SITES: usize = 10_000_000;

/// Most segments or sites of a label for which a lattice is derived body by body: the work of that grows
/// with the square of their number, a second or two here.
pub const MOST_BODY_BY_BODY: usize = 32;

/// The same where constraints are held: none, since a step body by body solves for all velocities and multipliers at once, and
/// proves that its root is the principal one, which of four links takes a minute.
pub const MOST_HELD_BODY_BY_BODY: usize = 0;

/// The same where velocities of neighbours stand in one term: so does a step for the velocities of all bodies.
pub const MOST_TOGETHER_BODY_BY_BODY: usize = 8;

/// Most sites that are derived body by body.
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

type Sized = fn(&[usize]) -> Option<Card>;

fn opened(number: usize) -> Option<Known> {
    let list = OPEN.read().unwrap_or_else(PoisonError::into_inner);
    list.get(number).copied()
}

fn open_at<const I: usize>(
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    settings: Settings,
) -> Result<Box<dyn Trajectory>, OpenError> {
    match opened(I) {
        Some(Known::Bodies(model)) => model.open(parameters, initial, settings),
        Some(Known::Line(_, line)) => line.open(parameters, initial, settings),
        None => Err(OpenError::Count {
            field: "open models",
            expected: I + 1,
            found: 0,
        }),
    }
}

fn sized_at<const I: usize>(sizes: &[usize]) -> Option<Card> {
    let Known::Bodies(model) = opened(I)? else {
        return None;
    };
    let source = model.source;
    match model.sizes == sizes {
        true => Some(model.card),
        false => at_sizes(source, Some(sizes)).ok(),
    }
}

macro_rules! functions {
    ($($i:literal)*) => {
        [$((open_at::<$i> as Open, sized_at::<$i> as Sized)),*]
    };
}

const FUNCTIONS: [(Open, Sized); 64] = functions!(
    0 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 17 18 19 20 21 22 23 24 25 26 27 28 29 30 31
    32 33 34 35 36 37 38 39 40 41 42 43 44 45 46 47 48 49 50 51 52 53 54 55 56 57 58 59 60 61 62 63
);

/// The card of the model that a text states: a bare `model NAME { ... }`, or Rust source with one
/// `model! { ... }`. Of named sizes each is three where that is admitted, else its smallest.
///
/// # Errors
/// [`Refused`] for what is no model, and for models that need a build.
pub fn card(source: &str) -> Result<Card, Refused> {
    at_sizes(source, None)
}

/// The same, and what derives in the text and is hardly meant.
///
/// # Errors
/// As [`card`].
pub fn card_and_warnings(source: &str) -> Result<(Card, Vec<Warning>), Refused> {
    let text = derived(source)?;
    let card = match known(source, None) {
        Some(card) => card,
        None => opened_now(&text, source, None)?,
    };
    Ok((card, text.derivation.warnings.clone()))
}

/// The card of a model with labels, for so many sites and these ends, and what is hardly meant.
///
/// # Errors
/// As [`card`].
pub fn card_on_lattice(source: &str, choice: &Choice) -> Result<(Card, Vec<Warning>), Refused> {
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
    // Functionals of all sites have no form body by body.
    if !lattice.meshes.is_empty() {
        return match LineModel::read(source) {
            Ok(line) => card_of_line((&model, &lattice), choice, line, source),
            Err(NoLine::Form(why)) => Err(Refused::Form { why }),
            Err(NoLine::Refused(refused)) => Err(refused),
        };
    }
    let most = most_body_by_body(&model);
    let beyond = |most: usize| choice.counts.iter().any(|n| *n > most);
    if beyond(most.min(MOST_TOGETHER_BODY_BY_BODY)) {
        match LineModel::read(source) {
            Ok(line) if !beyond(most) && !line.is_solved_together() => {}
            Ok(line) => return card_of_line((&model, &lattice), choice, line, source),
            Err(_) if !beyond(most) => {}
            Err(NoLine::Form(why)) => written_out = Some(why),
            // What is wrong with a model is said of its bodies too; what is not read of a line is
            // written out.
            Err(NoLine::Refused(Refused::Construct(what))) => {
                written_out = Some(format!("`{what}` is not executed in them"));
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
    match body_by_body((&model, &lattice), choice, source, written_out) {
        // What is too large body by body has one kernel for all sites.
        Err(Refused::Model(errors)) if errors.are_of_size() => match LineModel::read(source) {
            Ok(line) => card_of_line((&model, &lattice), choice, line, source),
            Err(_) => Err(Refused::Model(errors)),
        },
        card => card,
    }
}

/// The card of a model with labels that is written out body by body whatever loops over sites take: what they are compared with.
///
/// # Errors
/// As [`card`].
pub fn card_body_by_body(source: &str, choice: &Choice) -> Result<(Card, Vec<Warning>), Refused> {
    let model = pipeline::parse_source(source).map_err(Refused::Model)?;
    let lattice = Lattice::read(&model).map_err(Refused::Model)?;
    body_by_body((&model, &lattice), choice, source, None)
}

/// The card of a lattice that is written out; `written_out` says why, where loops over sites were asked for.
fn body_by_body(
    (model, lattice): (&Model, &Lattice),
    choice: &Choice,
    source: &str,
    written_out: Option<String>,
) -> Result<(Card, Vec<Warning>), Refused> {
    let derived = pipeline::derive_lattice(model, lattice, choice);
    let (unfolded, d) = derived.map_err(Refused::Model)?;
    // What is open is found by its text; here the choice is part of it.
    let key = format!("{source}\n{choice:?}");
    let text = Text::of_derivation(d)?;
    let card = match known(&key, None) {
        Some(card) => card,
        None => {
            let mut opened = Opened::read(&text, &key, None)?;
            // What is not read of a line has none.
            let signs = clebsch_core::line::signs(model, lattice).unwrap_or_default();
            opened.signs = Agreement::of(signs, lattice, choice, &opened.card);
            kept(opened)?
        }
    };
    let d = &text.derivation;
    let warnings = unfolded.told(choice, &d.warnings);
    let words = document::card_words(lattice, choice, unfolded, d, card.solver);
    let invariants = named(card.invariants, words.invariants);
    let card = Card {
        source: crate::text(source),
        summary: crate::text(&match written_out {
            None => words.summary,
            Some(why) => format!(
                "{}\nprogram              written out body by body, not with loops over sites: {why}",
                words.summary
            ),
        }),
        solver: crate::text(&words.solver),
        invariants: Box::leak(invariants.into_boxed_slice()),
        ..card
    };
    Ok((card, warnings))
}

/// Invariants of a lattice that is written out as they are told: what is alike at several sites is one of more rows.
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

/// The card of a line.
fn card_of_line(
    stated: (&Model, &Lattice),
    choice: &Choice,
    line: Arc<LineModel>,
    source: &str,
) -> Result<(Card, Vec<Warning>), Refused> {
    let key = format!("{source}\n{choice:?}");
    let (mut carded, warnings) = Carded::of(stated, choice, line, source, open_at::<0>)?;
    let mut list = OPEN.write().unwrap_or_else(PoisonError::into_inner);
    let known = list.iter().find_map(|known| match known {
        Known::Line(own, line) if *own == key => Some(line.card),
        _ => None,
    });
    if let Some(card) = known {
        return Ok((card, warnings));
    }
    let most = FUNCTIONS.len();
    let (open, _) = *FUNCTIONS.get(list.len()).ok_or(Refused::TooMany { most })?;
    carded.card.open = open;
    let card = carded.card;
    list.push(Known::Line(crate::text(&key), Box::leak(Box::new(carded))));
    Ok((card, warnings))
}

/// The card at given sizes.
fn at_sizes(source: &str, sizes: Option<&[usize]>) -> Result<Card, Refused> {
    if let Some(card) = known(source, sizes) {
        return Ok(card);
    }
    opened_now(&*derived(source)?, source, sizes)
}

thread_local! {
    /// The texts that this thread has derived: other sizes of a model are of the same program.
    static DERIVED: RefCell<Vec<(String, Rc<Text>)>> = const { RefCell::new(Vec::new()) };
}

/// What is made of a text, once for all sizes.
fn derived(source: &str) -> Result<Rc<Text>, Refused> {
    let known = DERIVED.with_borrow(|all| {
        let found = all.iter().find(|(text, _)| text == source);
        found.map(|(_, made)| made.clone())
    });
    if let Some(known) = known {
        return Ok(known);
    }
    let made = Rc::new(Text::of(source)?);
    DERIVED.with_borrow_mut(|all| {
        all.truncate(FUNCTIONS.len() - 1);
        all.insert(0, (source.to_owned(), made.clone()));
    });
    Ok(made)
}

/// The card of a model that is open.
fn known(source: &str, sizes: Option<&[usize]>) -> Option<Card> {
    let list = OPEN.read().unwrap_or_else(PoisonError::into_inner);
    let same = |m: &&'static Opened| sizes.map_or(m.is_default, |sizes| m.sizes == sizes);
    let mut of_bodies = list.iter().filter_map(|known| match known {
        Known::Bodies(model) => Some(model),
        Known::Line(..) => None,
    });
    let found = of_bodies.find(|m| m.source == source && same(m));
    found.map(|m| m.card)
}

fn opened_now(text: &Text, source: &str, sizes: Option<&[usize]>) -> Result<Card, Refused> {
    kept(Opened::read(text, source, sizes)?)
}

/// The card of a model that is open from now on.
fn kept(mut model: Opened) -> Result<Card, Refused> {
    let mut list = OPEN.write().unwrap_or_else(PoisonError::into_inner);
    let most = FUNCTIONS.len();
    let (open, sized) = *FUNCTIONS.get(list.len()).ok_or(Refused::TooMany { most })?;
    (model.card.open, model.card.sized) = (open, sized);
    let card = model.card;
    list.push(Known::Bodies(Box::leak(Box::new(model))));
    Ok(card)
}
