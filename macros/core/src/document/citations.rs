//! Citations of a model: where a published work has each equation, and remarks on it. They are data that the model
//! supplies; clebsch derives none of them.

pub use crate::print::document::Work;

/// An equation that can be cited. One citation covers an equation of all configurations.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Place<'a> {
    /// The reconstruction of the configuration with this name.
    Reconstruction(&'a str),
    /// The rule by which the advected quantity with this name evolves.
    Rule(&'a str),
    /// The discrete Lagrangian.
    Action,
    /// The Clebsch action.
    ClebschAction,
    /// The Clebsch relation of the variable with this name.
    Relation(&'a str),
    /// The momentum map of the multipliers.
    Lifted,
    /// The momentum of the edge.
    Momentum,
    /// The momentum of the edge as the momentum map at its start.
    AtStart,
    /// The momentum of the edge as the momentum map at its end.
    AtEnd,
    /// The discrete Euler-Poincaré equation.
    Balance,
    /// The Moser-Veselov equation, which a Riccati equation solves.
    Riccati,
    /// The continuous equation of motion.
    Continuous,
}

/// The citations of one model.
#[derive(Clone, Copy, PartialEq, Eq, Debug, Default)]
pub struct Citations {
    /// The cited work.
    pub work: Option<Work>,
    /// A paragraph about the whole model, or an empty string. A name between dollar signs is mathematics.
    pub statement: &'static str,
    /// The number of each equation in the work, and remarks; text between dollar signs is mathematics.
    pub places: &'static [(Place<'static>, &'static str)],
}

impl Citations {
    /// No citations.
    pub const NONE: Citations = Citations {
        work: None,
        statement: "",
        places: &[],
    };

    /// The source of an equation, `thesis (2.85)`.
    pub fn of(&self, place: Place<'_>) -> Option<String> {
        let (work, mut places) = (self.work?, self.places.iter());
        let (_, said) = places.find(|(at, _)| *at == place)?;
        Some(format!("{} {said}", work.named))
    }
}
