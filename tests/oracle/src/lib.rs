//! What the test binaries share: an oracle that varies unreduced actions, steppers written by hand, reference states,
//! and measurements of what the physics demands. Takes nothing from the engine or from emitted code.

pub use clebsch_comparisons::handwritten;
pub mod oracle;
pub mod physics;
pub mod printed;
pub mod reference;
pub mod sizes;
