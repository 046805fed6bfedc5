//! What the physics of rigid bodies demands of any stepper, as measurements that tests compare with bounds.
//! Takes motions (generated, hand-written or deliberately wrong ones); gives deviations, drifts, orders, trends.

pub mod against_reference;
pub mod cases;
pub mod draws;
pub mod faults;
pub mod measure;
pub mod motion;
pub mod order;
pub mod symplectic;
pub mod systems;
pub mod trend;
pub mod truth;
