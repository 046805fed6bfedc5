//! The independent oracle: variations of unreduced discrete actions at points that solve nothing.
//! Takes actions typed by hand, or random Lagrangians as expression trees; gives residuals and momenta
//! exact to rounding. It shares no code with the engine that it judges.

// Loops over the indices of small arrays read as the formulas they were typed from.
#![allow(clippy::needless_range_loop)]

pub mod action;
pub mod dual;
pub mod pair;
pub mod points;
pub mod sides;
pub mod square;
pub mod step;
pub mod wide;
