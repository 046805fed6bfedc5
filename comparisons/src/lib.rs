//! Other ways to compute the motions of the gallery, as yardsticks: steppers written by hand, methods
//! from the literature, closed forms, Runge-Kutta references. Takes plain numbers; gives attitudes and
//! momenta. Nothing here uses the runtime or emitted code, so that agreement is worth something.

pub mod body;
pub mod continuous;
pub mod elliptic;
pub mod gallery;
pub mod handwritten;
pub mod runge_kutta;
pub mod shallow_water;
