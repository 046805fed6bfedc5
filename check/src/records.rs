//! The quantities and statements of a model, sorted.

use crate::expression::Expression;
use crate::group::Group;
use crate::terms::Term;
use clebsch_core::syntax::ast::NodeRule;
use std::collections::{BTreeMap, BTreeSet};

/// The kind of sites of a quantity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sites {
    /// At nodes of the chain, or at the members of a set.
    Nodes,
    /// At segments.
    Segments,
}

/// The side of an element on which its velocity acts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// `next(R) = R*O`.
    Body,
    /// `next(R) = O*R`.
    Space,
}

/// The role of a quantity.
#[derive(Clone, Debug)]
pub enum Role {
    /// Constant.
    Parameter,
    /// An element of a group, with the side of its velocity.
    Element(Group, Side),
    /// Values that are added.
    Field(Layout),
    /// A quantity that the configurations advect.
    Advected,
}

/// How a field is stored as numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// Entry by entry.
    Entries,
    /// The diagonal of a matrix.
    Diagonal,
    /// The entries on and above the diagonal, by rows.
    Symmetric,
    /// An axial vector, or the entries below the diagonal.
    Skew,
}

/// A quantity of the model.
#[derive(Clone, Debug)]
pub struct Quantity {
    /// Its name.
    pub name: String,
    /// Its role.
    pub role: Role,
    /// The index of its label, and its kind of sites.
    pub at: Option<(usize, Sites)>,
    /// The parameter by which it grows around a ring.
    pub offset: Option<String>,
    /// The update, if the quantity is advected by an update.
    pub update: Option<Expression>,
    /// The definition, if the quantity is advected by definition.
    pub definition: Option<Expression>,
    /// Whether it is a number.
    pub is_number: bool,
    /// Whether it is a quaternion.
    pub is_quaternion: bool,
}

/// An end condition of a chain.
#[derive(Clone, Debug)]
pub struct End {
    /// Its name.
    pub name: String,
    /// Its own parameters, and whether each is a quaternion.
    pub params: Vec<String>,
    /// Prescribed configurations.
    pub given: Vec<String>,
    /// Terms that it adds.
    pub terms: Vec<Term>,
}

/// A constraint: a term that must be zero, and its sites.
#[derive(Clone, Debug)]
pub struct Hold {
    /// The name of its multiplier.
    pub name: String,
    /// Left side minus right side.
    pub value: Term,
    /// Whether it constrains sums over sites.
    pub of_sums: bool,
}

/// A model, sorted.
#[derive(Clone, Debug)]
pub struct Stated {
    /// Quantities by name.
    pub quantities: BTreeMap<String, Quantity>,
    /// The element of each velocity.
    pub velocities: BTreeMap<String, String>,
    /// The name of the step.
    pub step: String,
    /// Sizes by name.
    pub sizes: BTreeMap<String, usize>,
    /// Functions by path of Rust.
    pub functions: BTreeMap<String, String>,
    /// The index of each label.
    pub labels: Vec<String>,
    /// The terms of the Lagrangian.
    pub terms: Vec<Term>,
    /// The divisor of the Lagrangian as stated.
    pub scale: Option<Expression>,
    /// The node rule.
    pub rule: NodeRule,
    /// The constraints.
    pub holds: Vec<Hold>,
    /// End conditions at the first and at the last site.
    pub ends: [Vec<End>; 2],
    /// The index of the label of the chain, if the model has a chain.
    pub line: Option<usize>,
    /// The functionals of all sites, which are not evaluated here.
    pub functionals: BTreeSet<String>,
}
