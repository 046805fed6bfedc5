//! Grid functionals against independent formulas: deposit, smoothers, their forces, and particle-mesh shallow water with a
//! hand-written step.

mod common;
mod depth;
mod forces;
mod printed;
mod reflection;
mod released;
mod smoothers;
mod symmetries;
mod verlet;
mod waves;
