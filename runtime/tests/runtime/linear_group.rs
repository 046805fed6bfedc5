//! If the equations of a step are linear in the velocity, folds do not occur. On GL(n), however close to singular the configuration
//! is, a step succeeds or leaves the group.

// The fields of the models are Greek letters, as in the papers.
#![allow(non_snake_case)]

use super::common::Random;
use clebsch::nalgebra::Matrix2;
use clebsch::{BodyMomentumMatrix, Linear, StartError, StepCause};

clebsch::model! {
    /// A homogeneously deforming body in a nonlinear field.
    model Deforming {
        param I0: Sym<2>;
        param k, e: Real;
        group Q: GL<2> velocity G;
        constraint next(Q) = Q*G;
        let D = next(Q) - Q;
        lagrangian = tr(D^T*D*I0)/(2*h) - h*k/2*tr(Q^T*Q) - h*e/4*tr(Q^T*Q)^2 + h*k*log(det(Q));
    }
}
use deforming::{Deforming, DeformingInitial, DeformingParameters};

/// A random matrix with entries in (-1, 1).
fn matrix(random: &mut Random) -> Matrix2<f64> {
    Matrix2::from_fn(|_, _| random.symmetric())
}

#[test]
fn equations_without_a_fold_are_solved_or_lead_out_of_the_group() {
    let mut random = Random(11);
    let (mut made, mut left) = (0, 0);
    while made + left < 400 {
        let Q = matrix(&mut random);
        if Q.determinant() < 1e-3 {
            continue;
        }
        let model = Deforming::new(DeformingParameters {
            I0: Matrix2::new(1.0, 0.2, 0.2, 0.6),
            k: random.unit(),
            e: random.unit(),
        })
        .expect("inertia");
        let momentum = matrix(&mut random);
        let h = 10.0_f64.powf(-2.0 * random.unit());
        let initial = DeformingInitial {
            Q: Linear::from_matrix(&Q).expect("regular"),
            body_momentum: BodyMomentumMatrix(Q.transpose() * momentum),
        };
        match model.start(initial, h) {
            Ok((mut state, mut work)) => {
                model.step(&mut state, &mut work).expect("as at the start");
                made += 1;
            }
            Err(e) => {
                let refused = match e {
                    StartError::Refused(cause) => cause,
                    other => panic!("{other}"),
                };
                assert!(
                    matches!(refused, StepCause::Contact(_)),
                    "{refused} {Q} h = {h}"
                );
                left += 1;
            }
        }
    }
    assert!(made > 200 && left > 10, "{made} made, {left} lead out");
}
