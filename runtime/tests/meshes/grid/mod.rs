//! Functionals on a grid against formulas of these tests' own: deposit, smoothers, the forces that follow from them, and
//! particle-mesh shallow water stepped by hand.

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
