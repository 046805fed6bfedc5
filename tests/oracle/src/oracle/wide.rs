//! Random models on every group of the language: products of up to three groups, advected quantities of every shape, every
//! function, reduced and unreduced statements. From a seed, gives the text of a model and, independently, the action as a tree over
//! dual numbers. The tree is not parsed from the text.

pub mod grid;
pub mod grow;
pub mod model;
pub mod point;
pub mod tree;
pub mod unreduced;
pub mod write;

pub use model::Model;
pub use point::Point;
