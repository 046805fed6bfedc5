//! An independent verdict on the steps of a model. A step is judged by the derivative of the action *as stated*: the syntax tree is
//! evaluated on dual numbers, before any rewriting, each number with a running bound on its rounding. Derivation, emission and
//! execution of a model share nothing with this crate but the text and its parser.
//!
//! Of the step from node k to node k+1 it is asked, with the stored elements and momenta of both nodes,
//! that `p_k = -D1 L` and `p_{k+1} = D2 L`, along variations `R exp(hat xi)` where the velocity is seen from the body and
//! `exp(hat xi) R` where it is seen from space; that what is carried went on as its constraint says; and that what is held is zero.
//!
//! The same derivative gives the momenta of initial velocities: [`Legendre`] evaluates `-D1 L` for steps that begin with these velocities.

mod calls;
mod carlson;
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
mod moved;
mod number;
mod onto;
mod records;
mod refined;
mod run;
mod scene;
mod setup;
mod sites;
mod stated;
mod statements;
mod terms;
mod undefined;
mod value;
mod varied;
mod words;

pub use functions::named as function;
pub use judge::{Judge, Judged, Part};
pub use legendre::{Legendre, Momentum, NoMomentum, Velocities};
pub use moved::{Frame, Velocity};
pub use number::{Number, Slope, UNIT};
pub use onto::{Moved, onto_constraints};
pub use run::{Chosen, Verdict, Which};
pub use setup::{Field, Setup};
pub use undefined::Undefined;
