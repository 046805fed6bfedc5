//! Exact derivatives of a model file: of its steps, of its observables and invariants, and of whole runs.
//!
//! A step is recorded once more with exact derivatives: its iterations take one correction more, and the solution of
//! Newton's method is an input that the tape corrects once, which gives the implicit function theorem. Derivatives of the
//! tape are tapes, too. So a derivative costs a small multiple of a step, and it is exact to rounding.

mod body;
mod charts;
mod coordinates;
mod functions;
mod linear;
mod reverse;
mod source;
mod start;
mod trajectory;
mod values;

pub use body::TracedBody;
pub use coordinates::{LocalForm, dimension};
pub use source::{Begun, Coordinates, Source, Stepping, TracedFunctions};
pub use trajectory::Differentiated;
pub use values::{filled, numbers};
