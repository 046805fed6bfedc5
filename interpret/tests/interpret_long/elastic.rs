//! Elastic bodies that run from their texts, against sums typed by hand that share no code with the engine.

mod against_hand;
mod beam;
mod crossing;
mod energy;
mod fluid;
mod hyperelastic;
mod poisson;
