//! Steps that leave the domain of their model: maps of GL(n) that become singular, and functions outside their domain. Each is an
//! error with the contact time, leaves the state unchanged, and suggests a step size that works.

use clebsch::domain::Function;
use clebsch::nalgebra::{Matrix2, Matrix3, Vector1, Vector2, Vector3};
use clebsch::{
    Additive, BodyMomentum, BodyMomentumMatrix, Contact, FieldMomentum, Linear, Met, Rotation,
    SpatialMomentumMatrix, StartError, StepCause, StepError,
};

clebsch::model! {
    /// An ellipsoid in space: free for a = 0.
    model Ellipsoid {
        param C0: Sym<3>;
        param a: Real;
        group Q: GL<3> velocity V;
        advected I: Sym<3>;
        constraint next(Q) = V*Q;
        constraint next(I) = V*I*V^T;
        lagrangian = tr((V - Id)*I*(V - Id)^T)/(2*h) - h*a/2*tr(C0*I);
    }
}

clebsch::model! {
    /// The free ellipsoid in the reference frame.
    model EllipsoidInBody {
        param I: Sym<3>;
        group Q: GL<3> velocity V;
        advected C: Sym<3>;
        constraint next(Q) = Q*V;
        constraint next(C) = V^T*C*V;
        lagrangian = tr(C*(V - Id)*I*(V - Id)^T)/(2*h);
    }
}

clebsch::model! {
    /// A pressure that pulls inwards.
    model Collapsing {
        param w: Real;
        group Q: GL<3> velocity V;
        advected I: Sym<3>;
        constraint next(Q) = V*Q;
        constraint next(I) = V*I*V^T;
        lagrangian = tr((V - Id)*I*(V - Id)^T)/(2*h) - h*w*log(det(I));
    }
}

clebsch::model! {
    /// A top with a logarithm of its height.
    model LogTop {
        param J: Sym<3>;
        param chi, z: Vec<3>;
        param w, c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*w*log(dot(chi, Γ) + c);
    }
}

clebsch::model! {
    /// A top with a pole, and a root of a parameter.
    model PoleTop {
        param J: Sym<3>;
        param chi, z: Vec<3>;
        param w, c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*w/(dot(chi, Γ) + c) - h*w*sqrt(c)*dot(chi, Γ);
    }
}

clebsch::model! {
    /// A top with a root of its height, a power and the inverse of a matrix.
    model RootTop {
        param J, K: Sym<3>;
        param chi, z: Vec<3>;
        param w, u, c: Real;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*w*(dot(chi, Γ) + c)^(3/2) - h*u*dot(chi, inv(K + dot(chi, Γ)*Id)*chi);
    }
}

clebsch::model! {
    /// A kinetic energy with a pole in the velocity.
    model EdgePole {
        param J: Sym<3>;
        param b: Vec<3>;
        param w: Real;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h + w/(h*(dot(b, Ω*b) - 1));
    }
}

clebsch::model! {
    /// A matrix that is inverted, and a number in a root.
    model Inverted {
        param m, k, b: Real;
        field A: Mat<2>;
        field u: Real;
        let d = next(A) - A;
        let v = next(u) - u;
        lagrangian = m*tr(d*d^T)/(2*h) + m*v^2/(2*h) - h*k*tr(inv(A))/2 + h*b*sqrt(u);
    }
}

clebsch::model! {
    /// A matrix in the logarithm of the determinant of its square, a number in an inverse square.
    model Squared {
        param m, k: Real;
        field A: Mat<2>;
        field u: Real;
        let d = next(A) - A;
        let v = next(u) - u;
        let C = A^T*A;
        lagrangian = m*tr(d*d^T)/(2*h) + m*v^2/(2*h) + h*k*log(det(C))/2 - h*k/(2*u^2);
    }
}

fn contact(error: &StepError) -> Contact {
    match error.cause {
        StepCause::Contact(contact) => contact,
        _ => panic!("{error}"),
    }
}

/// Steps until a step fails, at most `most` times; returns the error and checks that the state is unchanged.
fn refused<S: Copy + PartialEq + std::fmt::Debug>(
    state: &mut S,
    most: u32,
    mut step: impl FnMut(&mut S) -> Result<(), StepError>,
) -> StepError {
    for _ in 0..most {
        let before = *state;
        if let Err(error) = step(state) {
            assert_eq!(before, *state);
            return error;
        }
    }
    panic!("{most} steps were made");
}

/// The velocity of the straight line along which the first axis vanishes at time 1.
fn inwards() -> Matrix3<f64> {
    -Matrix3::from_diagonal(&Vector3::new(1.0, 0.2, 0.1))
}

fn ellipsoid() -> (Ellipsoid, EllipsoidInitial) {
    let model = Ellipsoid::new(EllipsoidParameters {
        C0: Matrix3::identity(),
        a: 0.0,
    });
    let initial = EllipsoidInitial {
        Q: Linear::identity(),
        spatial_momentum: SpatialMomentumMatrix(inwards()),
        I: Matrix3::identity(),
    };
    (model.unwrap(), initial)
}

#[test]
fn a_straight_line_through_zero_ends_at_the_contact() {
    for h in [0.05, 0.03, 0.3, 0.7] {
        let (model, initial) = ellipsoid();
        let (mut state, mut work) = model.start(initial, h).unwrap();
        let error = refused(&mut state, 100, |s| model.step(s, &mut work));
        let time = error.contact_time().expect("known");
        // Rounding error of a straight line with at most forty steps.
        assert!((time - 1.0).abs() < 1e-13, "h = {h}: {time}");
        assert_eq!(error.node, ((1.0 - 1e-9) / h).floor() as u64, "h = {h}");
        assert!(
            error.to_string().contains("`Q` becomes singular"),
            "{error}"
        );
        // The suggested step size was tried and works.
        let works = contact(&error).works().expect("found");
        assert!(works < h && model.workspace(&state, works).is_ok());
    }
}

#[test]
fn the_first_step_is_tested_too_and_two_crossings_in_one() {
    // Beyond the zero of the first axis, of the second, and of all three: det is negative, positive, negative.
    for h in [2.5, 7.0, 15.0] {
        let (model, initial) = ellipsoid();
        let Err(StartError::Refused(StepCause::Contact(met))) = model.start(initial, h) else {
            panic!("h = {h} was taken");
        };
        assert_eq!(met.met, Met::Singular { configuration: "Q" });
        let after = met.after_node().expect("known");
        assert!((after - 1.0).abs() < 1e-13, "h = {h}: {after}");
    }
}

#[test]
fn the_body_side_ends_there_too() {
    let model = EllipsoidInBody::new(EllipsoidInBodyParameters {
        I: Matrix3::identity(),
    })
    .unwrap();
    let initial = EllipsoidInBodyInitial {
        Q: Linear::identity(),
        body_momentum: BodyMomentumMatrix(inwards()),
        C: Matrix3::identity(),
    };
    let (mut state, mut work) = model.start(initial, 0.05).unwrap();
    let error = refused(&mut state, 100, |s| model.step(s, &mut work));
    let time = error.contact_time().expect("known");
    assert!((time - 1.0).abs() < 1e-13, "{time}");
}

#[test]
fn a_motion_that_turns_back_before_it_is_not_stopped() {
    // A spring of frequency 1 with its rest position at zero passes through zero; a spring about the identity does not.
    let model = ElasticAtRest::new(ElasticAtRestParameters { s: 1.0 }).unwrap();
    let initial = ElasticAtRestInitial {
        Q: Linear::identity(),
        spatial_momentum: SpatialMomentumMatrix(inwards() * 0.9),
        I: Matrix3::identity(),
        B: Matrix3::identity(),
    };
    let (mut state, mut work) = model.start(initial, 0.05).unwrap();
    for _ in 0..2000 {
        model.step(&mut state, &mut work).unwrap();
    }
    let model = Ellipsoid::new(EllipsoidParameters {
        C0: Matrix3::identity(),
        a: 1.0,
    })
    .unwrap();
    let initial = EllipsoidInitial {
        Q: Linear::identity(),
        spatial_momentum: SpatialMomentumMatrix(inwards() * 0.1),
        I: Matrix3::identity(),
    };
    let (mut state, mut work) = model.start(initial, 0.05).unwrap();
    let error = refused(&mut state, 100, |s| model.step(s, &mut work));
    let time = error.contact_time().expect("known");
    // cos t = sin t / 10, to second order.
    assert!((time - 10.0f64.atan()).abs() < 1e-3, "{time}");
}

clebsch::model! {
    /// An elastic body with constant volume.
    model ElasticAtRest {
        param s: Real;
        group Q: GL<3> velocity V;
        advected I: Sym<3>;
        advected B: Sym<3>;
        constraint next(Q) = V*Q;
        constraint next(I) = V*I*V^T;
        constraint next(B) = V*B*V^T;
        lagrangian = tr((V - Id)*I*(V - Id)^T)/(2*h) - h*s/2*tr(B) + h*s/2*log(det(B));
    }
}

#[test]
fn a_collapse_is_an_error_before_its_energy_is_no_number() {
    let model = Collapsing::new(CollapsingParameters { w: 0.1 }).unwrap();
    let initial = CollapsingInitial {
        Q: Linear::identity(),
        spatial_momentum: SpatialMomentumMatrix(inwards()),
        I: Matrix3::identity(),
    };
    let (mut state, mut work) = model.start(initial, 0.02).unwrap();
    let error = refused(&mut state, 1000, |s| {
        let done = model.step(s, &mut work);
        assert!(model.energy(s).is_finite());
        done
    });
    // It reaches the contact earlier than along the straight line.
    assert!(error.contact_time().is_some_and(|t| t < 1.0), "{error}");
}

#[test]
fn a_map_that_is_nearly_singular_is_no_start() {
    let thin = |x: f64| Linear::from_matrix(&Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, x)));
    assert!(thin(2e-12).is_ok());
    assert!(thin(5e-13).is_err());
    assert!(thin(-0.5).is_ok(), "reflections are invertible");
}

fn turning() -> BodyMomentum {
    BodyMomentum(Vector3::new(2.0, 0.3, 1.0))
}

fn body() -> Matrix3<f64> {
    Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.5, 0.2, 0.0, 0.2, 2.0)
}

/// The contact time, where the argument `x + c` of a top vanishes: from the error, and by interpolation between its own nodes.
fn assert_met(error: &StepError, function: Function, before: f64) {
    let contact = contact(error);
    let Met::Outside {
        call,
        before: from,
        after,
    } = contact.met
    else {
        panic!("{error}");
    };
    assert_eq!(call.function, function, "{error}");
    assert!(call.argument.contains("Γ"), "{error}");
    assert!(
        (from - before).abs() < 1e-14 && from > 0.0 && after < 0.0,
        "{error}"
    );
    let share = contact.share.expect("known");
    assert!((from + share * (after - from)).abs() < 1e-15, "{share}");
    for words in [
        "leaves the domain of",
        &function.to_string(),
        "after the start of a step",
    ] {
        assert!(error.to_string().contains(words), "{error}");
    }
}

#[test]
fn a_logarithm_and_a_pole_are_left_with_an_error() {
    let (chi, z, c) = (Vector3::z(), Vector3::z(), 0.3);
    let model = LogTop::new(LogTopParameters {
        J: body(),
        chi,
        z,
        w: -1e-3,
        c,
    })
    .unwrap();
    let initial = LogTopInitial {
        Λ: Rotation::identity(),
        body_momentum: turning(),
    };
    let (mut state, mut work) = model.start(initial, 0.05).unwrap();
    let error = refused(&mut state, 10_000, |s| model.step(s, &mut work));
    assert_met(&error, Function::Log, model.Γ(&state).z + c);

    let model = PoleTop::new(PoleTopParameters {
        J: body(),
        chi,
        z,
        w: -1e-5,
        c,
    })
    .unwrap();
    let initial = PoleTopInitial {
        Λ: Rotation::identity(),
        body_momentum: turning(),
    };
    let (mut state, mut work) = model.start(initial, 0.05).unwrap();
    let error = refused(&mut state, 10_000, |s| model.step(s, &mut work));
    assert_met(&error, Function::Quotient, model.Γ(&state).z + c);
}

#[test]
fn a_power_and_an_inverse_are_left_with_an_error() {
    let (chi, z) = (Vector3::z(), Vector3::z());
    let start = |w, u, c, k: f64| {
        let parameters = RootTopParameters {
            J: body(),
            K: Matrix3::identity() * k,
            chi,
            z,
            w,
            u,
            c,
        };
        let model = RootTop::new(parameters).unwrap();
        let initial = RootTopInitial {
            Λ: Rotation::identity(),
            body_momentum: turning(),
        };
        let (mut state, mut work) = model.start(initial, 0.05).unwrap();
        refused(&mut state, 10_000, |s| model.step(s, &mut work))
    };
    // First case: the root leaves its domain first; second case: the matrix becomes singular first. Below the root the residual is
    // NaN, so that Newton's method may find no velocity instead.
    let error = start(1e-3, 0.0, 0.3, 2.0);
    match error.cause {
        StepCause::Contact(_) => assert!(error.to_string().contains("a power"), "{error}"),
        _ => assert!(error.to_string().contains("NaN"), "{error}"),
    }
    let error = start(0.0, 1e-6, 2.0, 0.3);
    assert!(
        error.to_string().contains("domain of an inverse"),
        "{error}"
    );
}

#[test]
fn parameters_states_and_velocities_outside_are_refused_at_the_start() {
    let (chi, z) = (Vector3::z(), Vector3::z());
    let refusal = PoleTop::new(PoleTopParameters {
        J: body(),
        chi,
        z,
        w: 1.0,
        c: -0.3,
    })
    .unwrap_err();
    assert!(
        refusal
            .to_string()
            .contains("argument of sqrt must be zero or positive"),
        "{refusal}"
    );
    let model = LogTop::new(LogTopParameters {
        J: body(),
        chi,
        z,
        w: 1.0,
        c: -1.5,
    })
    .unwrap();
    let initial = LogTopInitial {
        Λ: Rotation::identity(),
        body_momentum: turning(),
    };
    let refusal = model.start(initial, 0.05).unwrap_err().to_string();
    assert!(
        refusal.contains("it is -0.5, and the argument of log must be positive"),
        "{refusal}"
    );
    // b·Ωb - 1 is positive at first; the first step makes it negative.
    let model = EdgePole::new(EdgePoleParameters {
        J: body(),
        b: Vector3::x() * 1.1,
        w: 1e-9,
    })
    .unwrap();
    let initial = EdgePoleInitial {
        Λ: Rotation::identity(),
        body_momentum: BodyMomentum(Vector3::z() * 2.0),
    };
    assert!(model.start(initial, 0.05).is_ok());
    let refusal = model.start(initial, 1.0).unwrap_err().to_string();
    assert!(refusal.contains("domain of a quotient"), "{refusal}");
}

fn inverted(momentum: Matrix2<f64>, of_u: f64) -> (Inverted, InvertedInitial) {
    let parameters = InvertedParameters {
        m: 1.0,
        k: 1e-3,
        b: 0.3,
    };
    let initial = InvertedInitial {
        A: Additive::new(Matrix2::identity()),
        momentum_A: FieldMomentum(momentum),
        u: Additive::new(Vector1::new(0.1)),
        momentum_u: FieldMomentum(Vector1::new(of_u)),
    };
    (Inverted::new(parameters).unwrap(), initial)
}

/// The contact, at the first step or later, and its time.
fn met(momentum: Matrix2<f64>, of_u: f64, h: f64) -> (Contact, f64) {
    let (model, initial) = inverted(momentum, of_u);
    let (mut state, mut work) = match model.start(initial, h) {
        Ok(started) => started,
        Err(StartError::Refused(StepCause::Contact(contact))) => {
            return (contact, contact.share.expect("known") * h);
        }
        Err(error) => panic!("{error}"),
    };
    let error = refused(&mut state, 1000, |s| model.step(s, &mut work));
    (contact(&error), error.contact_time().expect("known"))
}

#[test]
fn a_matrix_field_that_is_inverted_meets_a_determinant_of_zero_twice_in_one_step() {
    // Both entries change sign in one step, so the determinant is positive at either end.
    let momentum = -Matrix2::from_diagonal(&Vector2::new(80.0, 81.0));
    let (contact, time) = met(momentum, 0.0, 0.05);
    assert_eq!(contact.met, Met::Singular { configuration: "A" });
    assert!((time - 1.0 / 81.0).abs() < 1e-4, "{time}");
    let (model, initial) = inverted(Matrix2::zeros(), 0.0);
    assert!(model.start(initial, 0.05).is_ok());
}

#[test]
fn a_root_that_is_left_is_told_before_the_force_that_has_no_value_there() {
    for h in [0.05, 1e-4] {
        let (contact, time) = met(Matrix2::zeros(), -4.0, h);
        let of_root =
            matches!(contact.met, Met::Outside { call, .. } if call.function == Function::Sqrt);
        assert!(of_root, "{contact:?}");
        assert!((time - 0.025).abs() < 1e-3, "{time}");
    }
}

#[test]
fn what_is_squared_is_not_carried_past_zero() {
    let model = Squared::new(SquaredParameters { m: 1.0, k: 1e-6 }).unwrap();
    // One entry decreases to zero at time 1, and the barrier is too weak to stop it.
    let start = |a: f64, u: f64| {
        let initial = SquaredInitial {
            A: Additive::new(Matrix2::identity()),
            u: Additive::new(Vector1::new(1.0)),
            momentum_A: FieldMomentum(-Matrix2::new(a, 0.0, 0.0, 0.2 * a)),
            momentum_u: FieldMomentum(Vector1::new(-u)),
        };
        let (mut state, mut work) = model.start(initial, 0.03).unwrap();
        let error = refused(&mut state, 1000, |s| model.step(s, &mut work));
        // The barrier changes the speed by about 0.1 %.
        let time = error.contact_time().expect("known");
        assert!((time - 1.0).abs() < 2e-3, "{time}");
        error.to_string()
    };
    let told = start(1.0, 0.0);
    assert!(told.contains("`A` becomes singular"), "{told}");
    let told = start(0.0, 1.0);
    assert!(told.contains("domain of a quotient"), "{told}");
}
