//! Measurements of physical laws that hold for any stepper of a rigid body; tests compare them with bounds. Motions may be
//! generated, hand-written or deliberately wrong. Results are deviations, drifts, orders and trends.

pub mod against_reference;
pub mod cases;
pub mod drift_detection;
pub mod faulty_steppers;
pub mod measure;
pub mod motion;
pub mod order;
pub mod random_states;
pub mod symplectic;
pub mod systems;
pub mod taylor_reference;
