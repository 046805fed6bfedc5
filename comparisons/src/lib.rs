//! Other methods for the motions of the gallery, as references: hand-written steppers, methods from the literature, closed forms,
//! and Runge-Kutta methods. They take plain numbers and give attitudes and momenta. They share no code with the runtime or the
//! emitted steppers, so that an agreement is independent evidence.

pub mod body;
pub mod continuous;
pub mod elliptic;
pub mod gallery;
pub mod handwritten;
pub mod runge_kutta;
pub mod shallow_water;
