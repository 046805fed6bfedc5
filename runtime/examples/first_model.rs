//! A first model: states and steps the heavy top, and monitors its energy and Casimir.
//!
//! `cargo run --release --example first_model`

use clebsch::prelude::*;

clebsch::model! {
    /// Heavy top, body representation.
    pub model Top {
        param J: Sym<3>;                     // second moments of mass (Poinsot matrix)
        param gU: Vec<3>;                    // weight times the vector from support to centre of mass, body frame
        param z: Vec<3>;                     // vertical (up), space frame
        group Λ: SO<3> velocity Ω;           // attitude and its discrete velocity
        advected Γ: Vec<3> = Λ^T * z;        // vertical, body frame
        constraint next(Λ) = Λ * Ω;
        constraint next(Γ) = Ω^T * Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ);
    }
}

fn main() -> Result<(), Error> {
    let top = Top::new(TopParameters {
        J: Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5)),
        gU: Vector3::z(),
        z: Vector3::z(),
    })?;
    let initial = TopInitial {
        Λ: Rotation::exp(&Vector3::new(0.0, 0.6, 0.0)),
        body_momentum: BodyMomentum(Vector3::new(0.1, 0.0, 1.0)),
    };
    let (mut state, mut work) = top.start(initial, 0.1)?;
    let (energy, casimir) = (top.energy(&state), top.momentum_Gamma(&state));
    for step in 1..=1000 {
        top.step(&mut state, &mut work)?;
        if step % 200 == 0 {
            println!(
                "t = {:5.1}   change of energy {:+.2e}, of μ·Γ {:+.2e}",
                0.1 * f64::from(step),
                top.energy(&state) - energy,
                top.momentum_Gamma(&state) - casimir
            );
        }
    }
    assert!((top.momentum_Gamma(&state) - casimir).abs() < 1e-13);
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
