//! Shared by the test binaries: an oracle that varies unreduced actions, hand-written steppers, reference states, and measurements
//! of physical laws. It uses nothing of the engine or of emitted code.

pub use clebsch_comparisons::handwritten;
pub mod oracle;
pub mod physics;
pub mod printed;
pub mod reference;
pub mod sizes;
