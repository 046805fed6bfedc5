//! The language of `model!`. The reference, the [tutorial] and the [limits] are also files of the repository, in `docs/`.
//!
//! [tutorial]: crate::language::tutorial
//! [limits]: crate::language::limits
//!
#![cfg_attr(doc, doc = include_str!("../../docs/language.md"))]

/// The language by five models, from a free rigid body to a fluid of particles.
///
/// [reference]: crate::language
/// [limits]: crate::language::limits
///
#[cfg_attr(doc, doc = include_str!("../../docs/tutorial.md"))]
pub mod tutorial {}

/// Unsupported features, the largest sizes, and the output of a run.
///
/// [reference]: crate::language
///
#[cfg_attr(doc, doc = include_str!("../../docs/limits.md"))]
pub mod limits {}
