//! The independent oracle: variations of unreduced discrete actions at points that solve nothing. Takes hand-written actions, or
//! random Lagrangians as expression trees; gives residuals and momenta exact to rounding. It shares no code with the engine under
//! test.

// Index loops over small arrays keep the shape of the formulas.
#![allow(clippy::needless_range_loop)]

pub mod action;
pub mod dual;
pub mod pair;
pub mod points;
pub mod sides;
pub mod square;
pub mod step;
pub mod wide;
