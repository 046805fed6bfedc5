//! Tests on maps and energies with known answers.

mod bodies;
mod central;
mod continuation;
mod eigen;
mod equilibrium;
mod fit;
mod fit_on_sphere;
mod linear;
mod lyapunov;
mod orbit;
mod refusals;
mod rigid_body;
mod section;
mod shapes;
mod systems;
