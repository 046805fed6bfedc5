//! Compares the explicit stepper of the body of revolution in unit quaternions with the implicit stepper, the emitted stepper and
//! the derived equation, for random states, any symmetry axis and any member of the family.

use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, UnitQuaternion};
use clebsch_models::cayley_klein::{CayleyKlein, CayleyKleinInitial, CayleyKleinParameters};
use clebsch_oracle::handwritten::attitude::{Quaternion, Vector, dot};
use clebsch_oracle::handwritten::cayley_klein::CayleyKlein as Implicit;
use clebsch_oracle::handwritten::cayley_klein_symmetric::SymmetricCayleyKlein as Explicit;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::physics::measure::worse;

const H: f64 = 0.1;

/// Moments of inertia (two are equal), `c`, unit quaternion, momentum.
fn state(source: &mut Source, axis: usize) -> (Vector, f64, Quaternion, Vector) {
    let a = source.between(1.0, 2.0);
    let mut moments = [a; 3];
    moments[axis] = source.between(0.3, 1.8) * a;
    let q = Quaternion([0; 4].map(|_| source.between(-1.0, 1.0))).normalised();
    let mu = [0; 3].map(|_| source.between(-2.0, 2.0));
    (moments, source.between(-1.0, 1.0), q, mu)
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, worse)
}

#[test]
fn a_step_is_that_of_the_implicit_stepper_and_of_the_emitted_one() {
    let mut source = Source::seeded(31);
    for trial in 0..3000 {
        let (moments, c, q, mu) = state(&mut source, trial % 3);
        let mut explicit = Explicit::start(&moments, c, &q, &mu, H).expect("far from the bound");
        let mut implicit = Implicit::start(&moments, c, &q, &mu, H).expect("far from the bound");
        explicit.step();
        implicit.step().expect("solvable");
        let (x, y) = (explicit.quaternion(), implicit.quaternion());
        assert!(apart(&x.0, &y.0) < 1e-14, "{trial}: {x:?} {y:?}");
        let (m, n) = (explicit.body_momentum(), implicit.body_momentum());
        // The stepper stores momenta times h/2, so their rounding error corresponds to numbers twenty times smaller.
        assert!(apart(&m, &n) < 1e-13, "{trial}: {m:?} {n:?}");
        if trial % 10 == 0 {
            let inertia = Matrix3::from_diagonal(&Vector3::from(moments));
            let model = CayleyKlein::new(CayleyKleinParameters { I: inertia, c }).expect("a body");
            let initial = CayleyKleinInitial {
                q: UnitQuaternion::from_components(q.0).expect("unit"),
                body_momentum: BodyMomentum(Vector3::from(mu)),
            };
            let (mut state, mut work) = model.start(initial, H).expect("solvable");
            model.step(&mut state, &mut work).expect("solvable");
            assert!(apart(&state.q().components(), &x.0) < 1e-13, "{trial}");
        }
    }
}

#[test]
fn invariants_stay_for_a_million_steps() {
    let mu = [-0.5, 0.1, 0.5];
    let start = Quaternion([0.8, 0.0, 0.6, 0.0]);
    for c in [0.0, 1.0] {
        let mut body = Explicit::start(&[1.0, 1.0, 0.5], c, &start, &mu, H).expect("solvable");
        let (energy, spatial) = (body.energy(), body.spatial_momentum());
        for _ in 0..1_000_000 {
            body.step();
        }
        let now = clebsch_oracle::handwritten::attitude::apply(
            &body.quaternion().normalised().matrix(),
            &body.body_momentum(),
        );
        // The rounding error of at most sixty-four steps, without the constant part of the momentum.
        assert!((body.energy() - energy).abs() < 1e-13 * energy, "{c}");
        assert!(apart(&now, &spatial) < 1e-13 * dot(&mu, &mu).sqrt(), "{c}");
    }
}

#[test]
fn other_bodies_and_steps_that_are_too_long_are_refused() {
    let start = Quaternion::IDENTITY;
    assert!(Explicit::start(&[3.5, 2.5, 2.0], 1.0, &start, &[0.1, 0.2, 0.3], H).is_err());
    // For c = 0 the equation about the axis is b sin(theta) cos(theta) = h mu / 2, so a solution requires h mu <= b.
    let about_axis =
        |h_mu: f64| Explicit::start(&[1.0, 1.0, 0.5], 0.0, &start, &[0.0, 0.0, h_mu / H], H);
    assert!(about_axis(0.499).is_ok());
    assert!(about_axis(0.501).is_err());
}
