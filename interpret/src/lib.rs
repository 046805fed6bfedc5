//! Runs a model file without a Rust build. The interpreter reads the emitted program, which a build would compile, as
//! operations over numbered places and executes them. Steps agree with compiled steps bit for bit. Takes the text of a
//! model; gives a [`Card`](clebsch::card::Card) whose trajectories run.

mod at_particles;
mod cards;
mod code;
mod composed;
mod constants;
mod failure;
mod functional;
mod library;
pub mod lines;
mod lower;
mod newton;
mod opened;
mod over;
mod packed;
mod program;
mod protocol;
mod recorded;
mod running;
mod saved;
mod signs;
mod sites;
mod value;

pub use at_particles::{AtParticles, Placed, Unvalued, at_particles};
pub use cards::{MOST_BODY_BY_BODY, card, card_and_warnings, card_body_by_body, card_on_lattice};

use clebsch_core::Errors;
use core::fmt;

/// Why a model file is not run.
#[derive(Debug)]
pub enum Refused {
    /// The text is not a valid model, or the model does not have a stepper.
    Model(Errors),
    /// The model is solved by a method that only built models have.
    Method {
        /// The name of the model.
        model: String,
        /// How it is solved.
        method: String,
    },
    /// The model does not admit the requested size.
    Size {
        /// The name of the model.
        model: String,
        /// Which sizes it has.
        admitted: String,
    },
    /// A functional of all sites that the runtime does not supply.
    Functional {
        /// Its path.
        path: String,
    },
    /// A model with functionals of all sites that no loops over sites take.
    Form {
        /// Why, in words.
        why: String,
    },
    /// More sites than a model without loops over sites is run with.
    TooLong {
        /// Why the model cannot run with loops over sites.
        why: String,
        /// The name of the label, and the requested number of sites.
        asked: (String, usize),
        /// The largest number of sites that clebsch expands body by body.
        most: usize,
    },
    /// More sites than any model is run with.
    TooManySites {
        /// The name of the label, and the requested number of sites.
        asked: (String, usize),
        /// The largest number of sites.
        most: usize,
    },
    /// An operation that is not known here.
    Construct(String),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(errors) => write!(f, "{errors:?}"),
            Self::Method { model, method } => write!(
                f,
                "a model file with this method is not run yet: {model} is solved so: {method}; put the \
                 model into a crate by `model! {{ ... }}`, which builds it"
            ),
            Self::Form { why } => write!(f, "the model is not run with loops over sites: {why}"),
            Self::TooLong {
                why,
                asked: (label, asked),
                most,
            } => write!(
                f,
                "`{label} = {asked}` is too many: loops over sites, which run any number of them, do not take this model, because {why}; \
                 state the model without that, or take at most `{label} = {most}`, which is written out body by body"
            ),
            Self::TooManySites {
                asked: (label, asked),
                most,
            } => write!(
                f,
                "`{label} = {asked}` is more than a model file is run with: at most `{label} = {most}`, some hundred bytes \
                 for each site"
            ),
            Self::Functional { path } => write!(
                f,
                "the functional `{path}` is Rust code of its own, which needs a build: put the model into a \
                 crate by `model! {{ ... }}`"
            ),
            Self::Size { model, admitted } => {
                write!(f, "{model} has no such size; it has {admitted}")
            }
            Self::Construct(what) => write!(
                f,
                "a model file with this operation is not run yet: `{what}`; put the model into a \
                 crate by `model! {{ ... }}`, which builds it"
            ),
        }
    }
}

impl std::error::Error for Refused {}

/// A text for as long as the process: cards and errors name fields and parameters without owning them.
/// A text is read once.
fn text(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}
