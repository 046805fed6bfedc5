//! An independent check of the steps of a model. This crate judges a step by the derivative of the action *as stated*.
//! It evaluates the syntax tree on dual numbers, before any rewriting, and keeps a running bound on the rounding of
//! each number. It shares only the text and its parser with derivation, emission and execution of the model.
//!
//! For the step from node k to node k+1, the crate checks with the stored elements and momenta of both nodes:
//!
//! - `p_k = -D1 L` and `p_{k+1} = D2 L`, along variations `R exp(hat xi)` for a body velocity and `exp(hat xi) R` for a
//!   spatial velocity;
//! - advected quantities follow their constraints;
//! - other constraints are zero.
//!
//! The same derivative gives the momenta of initial velocities: [`Legendre`] evaluates `-D1 L` for steps that begin
//! with these velocities.

mod calls;
mod carlson;
mod constraint_projection;
mod displacement;
mod evaluate;
mod expression;
mod functions;
mod group;
mod holds;
mod judge;
mod lagrangian;
mod legendre;
mod lets;
mod matrix;
mod number;
mod records;
mod run;
mod scene;
mod setup;
mod sites;
mod small_step_limit;
mod stated;
mod statements;
mod terms;
mod two_frames;
mod undefined;
mod value;
mod varied;
mod words;

pub use constraint_projection::{ProjectedStart, onto_constraints};
pub use displacement::{Frame, Velocity};
pub use functions::named as function;
pub use judge::{Judge, Judged, Part};
pub use legendre::{Legendre, Momentum, NoMomentum, Velocities};
pub use number::{Number, Slope, UNIT};
pub use run::{Chosen, StepSelection, Verdict};
pub use setup::{Field, Setup};
pub use stated::Stated;
pub use undefined::Undefined;
