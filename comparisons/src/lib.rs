//! Other ways to compute the motions of the gallery, as yardsticks: steppers written by hand. Takes
//! plain numbers; gives attitudes and momenta. Nothing here uses the runtime or emitted code, so that
//! an agreement with them is worth something.

pub mod handwritten;
