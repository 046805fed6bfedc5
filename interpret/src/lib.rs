//! Runs a model file without a Rust build. The interpreter reads the emitted program, which a build would compile, as
//! operations over numbered places and executes them. Steps agree with compiled steps bit for bit. Takes the text of a
//! model; gives a [`Card`](clebsch::card::Card) whose trajectories run.

mod at_particles;
pub mod cache;
mod cards;
mod code;
mod composed;
mod constants;
mod derivatives;
mod derived;
mod failure;
mod functional;
mod library;
pub mod lines;
mod listing;
mod lower;
mod map_scalar;
mod newton;
mod opened;
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
pub use cache::Cache;
pub use cards::{MOST_BODY_BY_BODY, card, card_and_warnings, card_body_by_body, card_on_lattice};

use clebsch_core::Errors;
use core::fmt;

/// Why a model file does not run.
#[derive(Debug)]
pub enum Refused {
    /// The text is not a valid model, or the model does not have a stepper.
    Model(Errors),
    /// The model needs a solver that only compiled models have.
    Method {
        /// The name of the model.
        model: String,
        /// The method that solves its steps.
        method: String,
    },
    /// The model does not admit the requested size.
    Size {
        /// The name of the model.
        model: String,
        /// The admitted sizes.
        admitted: String,
    },
    /// A functional of all sites that the runtime does not provide.
    Functional {
        /// Its path.
        path: String,
    },
    /// A Rust function that the runtime does not provide.
    Given {
        /// Its path.
        path: String,
        /// The method that the step calls.
        method: String,
    },
    /// A model with functionals of all sites that cannot run with loops over sites.
    Form {
        /// Why, as a sentence.
        why: String,
    },
    /// More sites than a model without loops over sites supports.
    TooLong {
        /// Why the model cannot run with loops over sites.
        why: String,
        /// The name of the label, and the requested number of sites.
        asked: (String, usize),
        /// The largest number of sites that clebsch expands body by body.
        most: usize,
    },
    /// More sites than any model supports.
    TooManySites {
        /// The name of the label, and the requested number of sites.
        asked: (String, usize),
        /// The largest number of sites.
        most: usize,
    },
    /// An operation that the interpreter does not know.
    Construct(String),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Model(errors) => write!(f, "{errors:?}"),
            Self::Method { model, method } => write!(
                f,
                "a model file cannot use this method yet: {model} is solved as follows: {method}; compile the model with \
                 `model! {{ ... }}` in a crate"
            ),
            Self::Form { why } => write!(
                f,
                "clebsch cannot run the model with loops over sites: {why}"
            ),
            Self::TooLong {
                why,
                asked: (label, asked),
                most,
            } => write!(
                f,
                "`{label} = {asked}` is too large: clebsch cannot run this model with loops over sites, because {why}; change \
                 this, or use at most `{label} = {most}`, for which clebsch expands the model body by body"
            ),
            Self::TooManySites {
                asked: (label, asked),
                most,
            } => write!(
                f,
                "`{label} = {asked}` is too large for a model file: the limit is `{label} = {most}`, about a hundred bytes for \
                 each site"
            ),
            Self::Functional { path } => write!(
                f,
                "the functional `{path}` is your own Rust code: compile the model with `model! {{ ... }}` in a crate"
            ),
            Self::Given { path, method } => write!(
                f,
                "a model file cannot call `{method}` of the function `{path}`: it knows {}; use one of these, give an \
                 expression in quotes, or compile the model with `model! {{ ... }}` in a crate",
                library::functions::KNOWN
            ),
            Self::Size { model, admitted } => {
                write!(f, "{model} does not have this size; it has {admitted}")
            }
            Self::Construct(what) => write!(
                f,
                "a model file cannot use this operation yet: `{what}`; compile the model with `model! {{ ... }}` in a crate"
            ),
        }
    }
}

impl std::error::Error for Refused {}

/// A text that lives as long as the process, because cards and errors borrow the names of fields and
/// parameters. Each text is stored once.
fn text(text: &str) -> &'static str {
    Box::leak(text.to_owned().into_boxed_str())
}
