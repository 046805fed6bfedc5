//! Tests on maps and energies with known answers.

mod continuation;
mod eigen;
mod equilibrium;
mod fit;
mod linear;
mod lyapunov;
mod orbit;
mod refusals;
mod rigid_body;
mod section;
mod systems;
