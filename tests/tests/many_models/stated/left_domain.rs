//! Steps that leave the domain of their model: maps of GL(n) that become singular, and functions outside their domain. Each is an
//! error with the contact time, leaves the state unchanged, and suggests a step size that works.

use super::carried_momentum::ELASTIC_IN_SPACE;
use super::text_model::{Given, Motion, TextModel, cause, given};
use clebsch::card::OpenError;
use clebsch::domain::Function;
use clebsch::nalgebra::{Matrix2, Matrix3, Vector2, Vector3};
use clebsch::{Contact, Linear, Met, StepCause, StepError};

/// An ellipsoid in space: free for a = 0.
const ELLIPSOID: &str = "model Ellipsoid {
    param C0: Sym<3>;
    param a: Real;
    group Q: GL<3> velocity V;
    advected I: Sym<3>;
    constraint next(Q) = V*Q;
    constraint next(I) = V*I*V^T;
    lagrangian = tr((V - Id)*I*(V - Id)^T)/(2*h) - h*a/2*tr(C0*I);
}";

/// The free ellipsoid in the reference frame.
const ELLIPSOID_IN_BODY: &str = "model EllipsoidInBody {
    param I: Sym<3>;
    group Q: GL<3> velocity V;
    advected C: Sym<3>;
    constraint next(Q) = Q*V;
    constraint next(C) = V^T*C*V;
    lagrangian = tr(C*(V - Id)*I*(V - Id)^T)/(2*h);
}";

/// A pressure that pulls inwards.
const COLLAPSING: &str = "model Collapsing {
    param w: Real;
    group Q: GL<3> velocity V;
    advected I: Sym<3>;
    constraint next(Q) = V*Q;
    constraint next(I) = V*I*V^T;
    lagrangian = tr((V - Id)*I*(V - Id)^T)/(2*h) - h*w*log(det(I));
}";

/// A top with a logarithm of its height.
const LOG_TOP: &str = "model LogTop {
    param J: Sym<3>;
    param chi, z: Vec<3>;
    param w, c: Real;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h - h*w*log(dot(chi, Γ) + c);
}";

/// A top with a pole, and a root of a parameter.
const POLE_TOP: &str = "model PoleTop {
    param J: Sym<3>;
    param chi, z: Vec<3>;
    param w, c: Real;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h - h*w/(dot(chi, Γ) + c) - h*w*sqrt(c)*dot(chi, Γ);
}";

/// A top with a root of its height, a power and the inverse of a matrix.
const ROOT_TOP: &str = "model RootTop {
    param J, K: Sym<3>;
    param chi, z: Vec<3>;
    param w, u, c: Real;
    group Λ: SO<3> velocity Ω;
    advected Γ: Vec<3> = Λ^T*z;
    constraint next(Λ) = Λ*Ω;
    constraint next(Γ) = Ω^T*Γ;
    lagrangian = -tr(J*Ω)/h - h*w*(dot(chi, Γ) + c)^(3/2) - h*u*dot(chi, inv(K + dot(chi, Γ)*Id)*chi);
}";

/// A kinetic energy with a pole in the velocity.
const EDGE_POLE: &str = "model EdgePole {
    param J: Sym<3>;
    param b: Vec<3>;
    param w: Real;
    group Λ: SO<3> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(J*Ω)/h + w/(h*(dot(b, Ω*b) - 1));
}";

/// A matrix that is inverted, and a number in a root.
const INVERTED: &str = "model Inverted {
    param m, k, b: Real;
    field A: Mat<2>;
    field u: Real;
    let d = next(A) - A;
    let v = next(u) - u;
    lagrangian = m*tr(d*d^T)/(2*h) + m*v^2/(2*h) - h*k*tr(inv(A))/2 + h*b*sqrt(u);
}";

/// A matrix in the logarithm of the determinant of its square, a number in an inverse square.
const SQUARED: &str = "model Squared {
    param m, k: Real;
    field A: Mat<2>;
    field u: Real;
    let d = next(A) - A;
    let v = next(u) - u;
    let C = A^T*A;
    lagrangian = m*tr(d*d^T)/(2*h) + m*v^2/(2*h) + h*k*log(det(C))/2 - h*k/(2*u^2);
}";

fn contact(cause: StepCause) -> Contact {
    match cause {
        StepCause::Contact(contact) => contact,
        _ => panic!("{cause}"),
    }
}

fn started(text: &str, h: f64, given: &Given) -> Motion {
    TextModel::read(text).start(h, given).unwrap()
}

/// Steps until a step fails, at most `most` times; returns the error and checks that the state is unchanged.
fn refused(motion: &mut Motion, most: u32) -> StepError {
    for _ in 0..most {
        let before = motion.observed();
        if let Err(error) = motion.step() {
            assert_eq!(before, motion.observed());
            return error;
        }
    }
    panic!("{most} steps were made");
}

/// The velocity of the straight line along which the first axis vanishes at time 1.
fn inwards() -> Matrix3<f64> {
    -Matrix3::from_diagonal(&Vector3::new(1.0, 0.2, 0.1))
}

/// An ellipsoid at rest length that moves with this part of the velocity inwards.
fn ellipsoid(a: f64, share: f64) -> Given {
    let one = Matrix3::<f64>::identity();
    given! { C0: one, a: a, Q: one, spatial_momentum: inwards() * share, I: one }
}

#[test]
fn a_straight_line_through_zero_ends_at_the_contact() {
    for h in [0.05, 0.03, 0.3, 0.7] {
        let mut motion = started(ELLIPSOID, h, &ellipsoid(0.0, 1.0));
        let error = refused(&mut motion, 100);
        let time = error.contact_time().expect("known");
        // Rounding error of a straight line with at most forty steps.
        assert!((time - 1.0).abs() < 1e-13, "h = {h}: {time}");
        assert_eq!(error.node, ((1.0 - 1e-9) / h).floor() as u64, "h = {h}");
        assert!(
            error.to_string().contains("`Q` becomes singular"),
            "{error}"
        );
        // The suggested step size was tried and works.
        let works = contact(error.cause).works().expect("found");
        assert!(works < h && motion.again(works).is_ok());
    }
}

#[test]
fn the_first_step_is_tested_too_and_two_crossings_in_one() {
    // Beyond the zero of the first axis, of the second, and of all three: det is negative, positive, negative.
    for h in [2.5, 7.0, 15.0] {
        let started = TextModel::read(ELLIPSOID).start(h, &ellipsoid(0.0, 1.0));
        let met = contact(cause(&started.expect_err("refused")));
        assert_eq!(met.met, Met::Singular { configuration: "Q" });
        let after = met.after_node().expect("known");
        assert!((after - 1.0).abs() < 1e-13, "h = {h}: {after}");
    }
}

#[test]
fn the_body_side_ends_there_too() {
    let one = Matrix3::<f64>::identity();
    let given = given! { I: one, Q: one, body_momentum: inwards(), C: one };
    let error = refused(&mut started(ELLIPSOID_IN_BODY, 0.05, &given), 100);
    let time = error.contact_time().expect("known");
    assert!((time - 1.0).abs() < 1e-13, "{time}");
}

#[test]
fn a_motion_that_turns_back_before_it_is_not_stopped() {
    // A spring of frequency 1 with its rest position at zero passes through zero; a spring about the identity does not.
    let one = Matrix3::<f64>::identity();
    let given = given! { s: 1.0, Q: one, spatial_momentum: inwards() * 0.9, I: one, B: one };
    started(ELASTIC_IN_SPACE, 0.05, &given).steps(2000);
    let error = refused(&mut started(ELLIPSOID, 0.05, &ellipsoid(1.0, 0.1)), 100);
    let time = error.contact_time().expect("known");
    // cos t = sin t / 10, to second order.
    assert!((time - 10.0f64.atan()).abs() < 1e-3, "{time}");
}

#[test]
fn a_collapse_is_an_error_before_its_energy_is_no_number() {
    let one = Matrix3::<f64>::identity();
    let given = given! { w: 0.1, Q: one, spatial_momentum: inwards(), I: one };
    let mut motion = started(COLLAPSING, 0.02, &given);
    let error = (0..1000).find_map(|_| {
        let done = motion.step();
        assert!(motion.energy().is_finite());
        done.err()
    });
    let error = error.expect("a collapse");
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

/// A top whose vertical is the axis of its weight, with parameters of its own.
fn top(own: Given) -> Given {
    let mut all = own;
    all.extend(given! {
        J: Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.5, 0.2, 0.0, 0.2, 2.0),
        chi: Vector3::z(),
        z: Vector3::z(),
        Λ: Matrix3::<f64>::identity(),
        body_momentum: [2.0, 0.3, 1.0],
    });
    all
}

/// The contact time, where the argument `x + c` of a top vanishes: from the error, and by interpolation between its own nodes.
fn assert_met(error: &StepError, function: Function, before: f64) {
    let contact = contact(error.cause);
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
    let c = 0.3;
    for (text, w, function) in [
        (LOG_TOP, -1e-3, Function::Log),
        (POLE_TOP, -1e-5, Function::Quotient),
    ] {
        let mut motion = started(text, 0.05, &top(given! { w: w, c: c }));
        let error = refused(&mut motion, 10_000);
        assert_met(&error, function, motion.vector::<3>("Γ").z + c);
    }
}

#[test]
fn a_power_and_an_inverse_are_left_with_an_error() {
    let start = |w: f64, u: f64, c: f64, k: f64| {
        let given = top(given! { K: Matrix3::identity() * k, w: w, u: u, c: c });
        refused(&mut started(ROOT_TOP, 0.05, &given), 10_000)
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
    let refusal = |text: &str, h: f64, given: &Given| {
        let found = TextModel::read(text).start(h, given);
        found.expect_err("outside")
    };
    let error = refusal(POLE_TOP, 0.05, &top(given! { w: 1.0, c: -0.3 }));
    let told = error.to_string();
    assert!(
        matches!(error, OpenError::Parameter(_))
            && told.contains("argument of sqrt must be zero or positive"),
        "{told}"
    );
    let told = refusal(LOG_TOP, 0.05, &top(given! { w: 1.0, c: -1.5 })).to_string();
    assert!(
        told.contains("it is -0.5, and the argument of log must be positive"),
        "{told}"
    );
    // b·Ωb - 1 is positive at first; the first step makes it negative.
    let one = Matrix3::<f64>::identity();
    let j = Matrix3::new(1.0, 0.1, 0.0, 0.1, 1.5, 0.2, 0.0, 0.2, 2.0);
    let given =
        given! { J: j, b: [1.1, 0.0, 0.0], w: 1e-9, Λ: one, body_momentum: [0.0, 0.0, 2.0] };
    assert!(TextModel::read(EDGE_POLE).start(0.05, &given).is_ok());
    let told = refusal(EDGE_POLE, 1.0, &given).to_string();
    assert!(told.contains("domain of a quotient"), "{told}");
}

fn inverted(momentum: Matrix2<f64>, of_u: f64) -> Given {
    given! {
        m: 1.0, k: 1e-3, b: 0.3,
        A: Matrix2::<f64>::identity(), momentum_A: momentum, u: 0.1, momentum_u: of_u,
    }
}

/// The contact, at the first step or later, and its time.
fn met(momentum: Matrix2<f64>, of_u: f64, h: f64) -> (Contact, f64) {
    match TextModel::read(INVERTED).start(h, &inverted(momentum, of_u)) {
        Ok(mut motion) => {
            let error = refused(&mut motion, 1000);
            (contact(error.cause), error.contact_time().expect("known"))
        }
        Err(error) => {
            let contact = contact(cause(&error));
            (contact, contact.share.expect("known") * h)
        }
    }
}

#[test]
fn a_matrix_field_that_is_inverted_meets_a_determinant_of_zero_twice_in_one_step() {
    // Both entries change sign in one step, so the determinant is positive at either end.
    let momentum = -Matrix2::from_diagonal(&Vector2::new(80.0, 81.0));
    let (contact, time) = met(momentum, 0.0, 0.05);
    assert_eq!(contact.met, Met::Singular { configuration: "A" });
    assert!((time - 1.0 / 81.0).abs() < 1e-4, "{time}");
    started(INVERTED, 0.05, &inverted(Matrix2::zeros(), 0.0));
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
    // One entry decreases to zero at time 1, and the barrier is too weak to stop it.
    let start = |a: f64, u: f64| {
        let given = given! {
            m: 1.0, k: 1e-6,
            A: Matrix2::<f64>::identity(), momentum_A: -Matrix2::new(a, 0.0, 0.0, 0.2 * a),
            u: 1.0, momentum_u: -u,
        };
        let error = refused(&mut started(SQUARED, 0.03, &given), 1000);
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
