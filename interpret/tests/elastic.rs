//! Elastic bodies that run from their texts, against sums typed by hand that share no code with the engine.

#![allow(missing_docs, mixed_script_confusables)]

#[path = "elastic/against_hand.rs"]
mod against_hand;
#[path = "elastic/beam.rs"]
mod beam;
#[path = "elastic/crossing.rs"]
mod crossing;
#[path = "elastic/energy.rs"]
mod energy;
#[path = "elastic/fluid.rs"]
mod fluid;
#[path = "elastic/hyperelastic.rs"]
mod hyperelastic;
#[path = "elastic/poisson.rs"]
mod poisson;
