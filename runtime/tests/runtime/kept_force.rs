//! The workspace stores the force on a field at a node for the next step. A step equals the step with a new workspace bit for bit,
//! whatever states were stepped before. Parameter factors are inverted once.

use clebsch::integrate::{Model, Stepper};
use clebsch::nalgebra::Matrix3;
use clebsch::{Additive, FieldMomentum};

clebsch::model! {
    /// A body of Mooney and Rivlin by its placement.
    model Body {
        /// metric of space, second moments
        param C0, I0: Sym<3>;
        /// stiffness
        param a, b, c, d: Real;
        /// placement
        field Q: Mat<3>;
        let V = next(Q) - Q;
        let C = Q^T*C0*Q;
        let W = a*I1(C) + b*I2(C) + c*det(C) - (d/2)*log(det(C));
        lagrangian = tr(C0*V*I0*V^T)/(2*h) - h*W;
    }
}

const METRIC: [f64; 9] = [1.2, 0.1, 0.0, 0.1, 0.9, -0.2, 0.0, -0.2, 1.1];

fn body(moments: Matrix3<f64>) -> Body {
    let [a, b, c, d] = [0.1, 10.0, 10.0, 60.2];
    let parameters = BodyParameters {
        C0: Matrix3::from_row_slice(&METRIC),
        I0: moments,
        a,
        b,
        c,
        d,
    };
    Body::new(parameters).expect("parameters")
}

fn initial(stretch: f64) -> BodyInitial {
    let place = Matrix3::new(stretch, 0.1, 0.0, 0.0, 1.0, 0.2, -0.1, 0.0, 1.0 / stretch);
    let momentum = Matrix3::new(0.6, -0.15, -0.3, 0.15, 0.15, 0.15, -0.3, 0.45, 0.0);
    BodyInitial {
        Q: Additive::new(place),
        momentum: FieldMomentum(momentum),
    }
}

#[test]
fn a_step_is_that_of_a_workspace_made_anew() {
    let (model, h) = (body(Matrix3::from_diagonal_element(0.8)), 0.01);
    let (mut first, mut work) = model.start(initial(1.1), h).expect("starts");
    let (mut second, _) = model.start(initial(0.9), h).expect("starts");
    for k in 0..60 {
        // Two steps of one state, then two of the other.
        let state = if k % 4 < 2 { &mut first } else { &mut second };
        let mut other = *state;
        let mut anew = model.prepare(&other, h, ()).expect("made");
        model.advance(&mut other, &mut anew).expect("steps");
        model.advance(state, &mut work).expect("steps");
        assert_eq!(*state, other, "step {k}");
    }
    assert_ne!(first, second);
}

#[test]
fn a_factor_without_an_inverse_is_named() {
    let model = body(Matrix3::from_diagonal(&[1.0, 0.0, 1.0].into()));
    let refused = model.start(initial(1.1), 0.01).err().map(|e| e.to_string());
    let text = refused.expect("no velocity is determined");
    assert!(text.contains("I₀"), "{text}");
}
