//! A thousand bodies in parallel: how often an asymmetric free body that spins about its middle axis flips, by the size of the
//! initial perturbation.
//!
//! `cargo run --release --example ensemble`

use clebsch::prelude::*;

clebsch::model! {
    /// Free rigid body.
    pub model Body {
        param J: Sym<3>;
        group R: SO<3> velocity W;
        constraint next(R) = R*W;
        lagrangian = -tr(J*W)/h;
    }
}

/// For moments of inertia 1, 2 and 2.5. The second moments of mass are half their trace minus each moment.
fn bodies() -> impl Iterator<Item = (BodyParameters, BodyInitial)> {
    (0..1000).map(|i| {
        let parameters = BodyParameters {
            J: Matrix3::from_diagonal(&Vector3::new(1.75, 0.75, 0.25)),
        };
        let disturbance = 1e-6 * 10_f64.powf(f64::from(i) / 250.0);
        let initial = BodyInitial {
            R: Rotation::identity(),
            body_momentum: BodyMomentum(Vector3::new(disturbance, 2.0, 0.0)),
        };
        (parameters, initial)
    })
}

fn main() -> Result<(), Error> {
    let mut ensemble = Ensemble::<Body>::start(bodies(), 0.05)?;
    let mut overturned = vec![0; 1000];
    let mut up = vec![true; 1000];
    for _ in 0..400 {
        ensemble.run(5)?; // or run_parallel, on all cores, with the feature `rayon`
        let spins = ensemble.observe(|_, state| state.body_momentum().0[1]);
        for ((turned, up), spin) in overturned.iter_mut().zip(&mut up).zip(spins) {
            if (spin > 0.0) != *up {
                *turned += 1;
                *up = !*up;
            }
        }
    }
    for i in (0..1000).step_by(125) {
        println!(
            "disturbance {:8.1e}: turned over {} times until t = 100",
            1e-6 * 10_f64.powf(i as f64 / 250.0),
            overturned[i]
        );
    }
    assert!(overturned[999] > overturned[0]);
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
