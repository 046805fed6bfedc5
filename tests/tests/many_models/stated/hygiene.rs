//! The surroundings of a model, and permitted names of its quantities. Covers models next to items that shadow the prelude, in
//! functions, side by side, and with names that emitted code uses itself. Each gives the same motion as with plain names, without a
//! warning. This file represents a strict crate: it denies every warning that emitted code could cause.
#![deny(warnings, missing_docs, missing_debug_implementations)]
// One model is of first order; the macro warns about it with this lint.
#![allow(deprecated)]
#![deny(unreachable_pub, unused_qualifications, single_use_lifetimes)]

use super::text_model::{Numbers, TextModel, card, given};
use clebsch::nalgebra::{Matrix3, Matrix3x2, Vector3, Vector6};
use clebsch::{BodyImpulse, BodyMomentum, RigidMotion, Rotation, SpatialMomentum};

clebsch::model! {
    /// A documented model that the crate exports.
    pub model Exported {
        param J: Sym<3>;
        param g, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
    }
}

clebsch::model! {
    pub model WithoutDocumentation {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

clebsch::model! {
    model Private {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

// The modules of these models would be called `loop`, `core`, `std` and `clebsch`. It suffices that they compile.
clebsch::model! {
    model Loop {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}
clebsch::model! {
    model Core {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}
clebsch::model! {
    model Std {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}
clebsch::model! {
    model Clebsch {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

/// Lints that a crate might change.
#[allow(
    dead_code,
    non_camel_case_types,
    non_snake_case,
    non_upper_case_globals
)]
mod shadowed {
    #[allow(unused_macros)]
    macro_rules! compile_error {
        () => {};
    }
    mod core {}
    mod std {}
    mod alloc {}
    mod clebsch {}
    mod nalgebra {}
    struct Result;
    enum Option {}
    struct Vec;
    struct Box;
    struct String;
    struct f64;
    struct u64;
    struct usize;
    struct bool;
    struct str;
    trait Default {}
    trait Clone {}
    trait Copy {}
    trait PartialEq {}
    trait Debug {}
    trait Iterator {}
    trait Into {}
    trait Real {}
    fn Some() {}
    fn None() {}
    fn Ok() {}
    fn Err() {}
    fn drop() {}
    struct Rotation;
    struct Card;
    const T: i32 = 0;
    const h: i32 = 0;
    const J: i32 = 0;

    ::clebsch::model! {
        pub model Shadowed {
            param J: Sym<3>;
            param g, z: Vec<3>;
            group Λ: SO<3> velocity Ω;
            advected Γ: Vec<3> = Λ^T*z;
            constraint next(Λ) = Λ*Ω;
            constraint next(Γ) = Ω^T*Γ;
            lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
        }
    }
}

/// Passes names that emitted code uses itself: its functions, types and locals, and names of the Rust prelude.
macro_rules! awkward_names {
    ($then:ident! $($rest:tt)*) => {
        $then! {
            [
                // Functions and types.
                all_finite axial_of_difference basis determinant diagonal diagonal_of
                diagonal_part forced
                inverse_or_nan largest_step length matrix_of number_of put reach rotation_of rows
                skew_part solve solve_or_nan symmetric_part unit BodyMomentum SpatialMomentum
                Rotation Poinsot QuaternionBody KineticWarning Edge Moving Free newton validate emitted
                // Locals and parameters of functions.
                after axis before body e edge found guess here i inertia initial j kinetic
                matrix model momenta momentum momentum_next n node out parameters parts potential
                residual scratch solved solver state tangent total trial value velocity work x
                field expected t1 t2 t3 momenta_six configurations
                // Fields, methods and associated constants.
                balance body_momentum edge_momentum energies energy kinetic_warning refused
                spatial_momentum start
                step factor own_parameters CARD SOURCE
                // Names of the prelude and of primitive types.
                Box Clone Copy Debug Default Err None Ok Option Real Result Some String Vec alloc
                bool clebsch core drop f64 nalgebra std str u64 usize
                // Keywords of the language, and contextual keywords of Rust.
                advected assume auto constraint default dim given group k label lagrangian macro_rules
                param raw safe scale time union
                // Names that the derivation gives to its own symbols, and their suffixes.
                M P V_Γ η μ ξ m C N A S Γ_next Γ_before Γ_reference Λ_next Λ_moved Ω_matrix Ω_before
            ]
            $($rest)*
        }
    };
}

macro_rules! awkward_model {
    ([$($name:ident)*] $model:ident { $($statement:tt)* }) => {
        clebsch::model! {
            model $model {
                $(param $name: Real;)*
                let weight = log(0 $(+ $name)*);
                $($statement)*
            }
        }
    };
}

/// The parameters of a model, with the same value for every added parameter.
macro_rules! filled {
    ([$($name:ident)*] $parameters:ident, $each:ident, { $($field:tt)* }) => {
        $parameters { $($name: $each,)* $($field)* }
    };
}

macro_rules! count {
    ([$($name:ident)*]) => { [$(stringify!($name)),*].len() };
}

/// One statement with awkward names, and its text with a single parameter in their place.
macro_rules! twice {
    ($awkward:ident $plain:ident { $($statement:tt)* }) => {
        awkward_names! { awkward_model! $awkward { $($statement)* } }
        const $plain: &str = concat!(
            "model Plain { param weight: Real; ",
            stringify!($($statement)*),
            "}"
        );
    };
}

twice! { AwkwardFree PLAIN_FREE {
    param J: Sym<3>;
    group R: SO<3> velocity edge_velocity;
    constraint next(R) = R*edge_velocity;
    assume weight > 0;
    lagrangian = -tr(weight*J*edge_velocity)/h;
} }
twice! { AwkwardForced PLAIN_FORCED {
    param J: Sym<3>;
    param lever, vertical: Vec<3>;
    group R: SO<3> velocity solved2;
    advected above: Vec<3> = R^T*vertical;
    advected carried: Vec<3>;
    constraint next(R) = R*solved2;
    constraint next(above) = solved2^T*above;
    constraint next(carried) = solved2^T*carried;
    lagrangian = -tr(J*solved2)/h - h*weight*(dot(lever, above) + dot(lever, carried));
} }
twice! { AwkwardNewton PLAIN_NEWTON {
    time n_ step tau;
    param J: Sym<3>;
    param lever, vertical: Vec<3>;
    group R1: SO<3> velocity w1;
    group R2: SO<3> velocity w2;
    advected carried: Vec<3>;
    constraint next(R1) = R1*w1;
    constraint next(R2) = R2*w2;
    constraint next(carried) = w2^T*carried;
    lagrangian = -(tr(J*w1) + tr(J*w2))/tau - tau*weight*dot(lever, carried) - tau*dot(R1*lever, R2*vertical);
} }
twice! { AwkwardSpatial PLAIN_SPATIAL {
    time i_ step state2;
    param vertical: Vec<3>;
    group R: SO<3> velocity w;
    advected J: Sym<3>;
    advected carried: Vec<3>;
    constraint next(R) = w*R;
    constraint next(J) = w*J*w^T;
    constraint next(carried) = w*carried;
    lagrangian = -tr(w*J)/state2 - state2*weight*dot(carried, vertical);
} }

twice! { AwkwardMotion PLAIN_MOTION {
    param J, mass: Sym<3>;
    group G: SE<3> velocity V;
    group K: SE<3> velocity W;
    constraint next(G) = G*V;
    constraint next(K) = K*W;
    lagrangian = -tr(J*rot(V))/h - tr(J*rot(W))/h + weight*dot(pos(V), mass*pos(V))/h
        + dot(pos(W), mass*pos(W))/h;
} }

// The time index, the step size, the velocity and the configuration may have such names, too.
clebsch::model! {
    model AwkwardStep {
        time j step work;
        param J: Sym<3>;
        param lever: Vec<3>;
        group matrix: SO<3> velocity state;
        advected initial: Vec<3>;
        advected value: Real;
        constraint next(matrix) = matrix*state;
        constraint next(initial) = state^T*initial;
        constraint next(value) = value;
        lagrangian = -tr(J*state)/work - work*value*dot(lever, initial);
    }
}
clebsch::model! {
    model AwkwardAtHand {
        time k step trial;
        param h, parameters: Real;
        param solver: Diag<3>;
        param factor: Skew<3>;
        param residual: Mat<3, 2>;
        param guess: SO<3>;
        group length: SO<3> velocity forced;
        advected basis: Sym<3> = length^T*solver*length;
        constraint next(length) = length*forced;
        constraint next(basis) = forced^T*basis*forced;
        lagrangian = -tr((solver + h*Id)*forced)/trial - trial*parameters*tr(basis*guess*factor)
            - trial*tr(basis*residual*residual^T);
    }
}

fn inertia() -> Matrix3<f64> {
    Matrix3::new(0.9, 0.1, -0.05, 0.1, 1.2, 0.15, -0.05, 0.15, 0.7)
}

fn attitude() -> Rotation<f64> {
    Rotation::exp(&Vector3::new(0.3, -0.7, 0.2))
}

fn body_momentum() -> BodyMomentum<f64> {
    BodyMomentum(Vector3::new(0.1, -0.2, 0.8))
}

/// The value of each parameter with an awkward name: the sum is exact, and its logarithm positive.
const EACH: f64 = 1.0 / 64.0;

fn weight() -> f64 {
    (awkward_names!(count!) as f64 * EACH).ln()
}

const STEPS: usize = 20;

/// Runs both statements, the plain one from its text, and compares them to rounding. They are not bitwise equal, because the number
/// of Newton corrections depends on rounding bounds of the expressions.
macro_rules! same_motion {
    (
        [$awkward:ident $plain:ident] [$parameters:ident] [$initial:ident]
        { $($parameter:tt)* } { $($value:tt)* } $($element:ident)*
    ) => {{
        let each = EACH;
        let model = $awkward::new(awkward_names!(filled! $parameters, each, { $($parameter)* }));
        let model = model.unwrap();
        let (mut state, mut work) = model.start($initial { $($value)* }, 0.1).unwrap();
        let given = given! { weight: weight(), $($parameter)*, $($value)* };
        let mut plain = TextModel::read($plain).start(0.1, &given).unwrap();
        for _ in 0..STEPS {
            model.step(&mut state, &mut work).unwrap();
            plain.steps(1);
            $(close(&state.$element().numbers(), &plain.numbers(stringify!($element)));)*
        }
    }};
}

fn close(one: &[f64], other: &[f64]) {
    assert_eq!(one.len(), other.len());
    for (x, y) in one.iter().zip(other) {
        // About ten rounding errors per step.
        assert!((x - y).abs() < 1e-13, "{x} {y}");
    }
}

#[test]
fn names_that_emitted_code_uses_change_nothing() {
    let (up, arm) = (Vector3::new(0.0, 0.6, 0.8), Vector3::new(0.3, -0.2, 0.9));
    let moved = Vector3::new(-0.4, 0.1, 0.5);
    same_motion!(
        [AwkwardFree PLAIN_FREE] [AwkwardFreeParameters] [AwkwardFreeInitial]
        { J: inertia() } { R: attitude(), body_momentum: body_momentum() } R
    );
    same_motion!(
        [AwkwardForced PLAIN_FORCED] [AwkwardForcedParameters] [AwkwardForcedInitial]
        { J: inertia(), lever: arm, vertical: up }
        { R: attitude(), body_momentum: body_momentum(), carried: moved } R
    );
    same_motion!(
        [AwkwardNewton PLAIN_NEWTON] [AwkwardNewtonParameters] [AwkwardNewtonInitial]
        { J: inertia(), lever: arm, vertical: up }
        {
            R1: attitude(), body_momentum_R1: body_momentum(),
            R2: attitude(), body_momentum_R2: body_momentum(), carried: moved
        } R1 R2
    );
    let impulse = BodyImpulse(Vector6::new(0.1, -0.2, 0.8, 0.3, 0.2, -0.1));
    same_motion!(
        [AwkwardMotion PLAIN_MOTION] [AwkwardMotionParameters] [AwkwardMotionInitial]
        { J: inertia(), mass: inertia() }
        {
            G: RigidMotion::identity(), body_momentum_G: impulse,
            K: RigidMotion::identity(), body_momentum_K: impulse
        } G K
    );
    same_motion!(
        [AwkwardSpatial PLAIN_SPATIAL] [AwkwardSpatialParameters] [AwkwardSpatialInitial]
        { vertical: up }
        {
            R: attitude(), spatial_momentum: SpatialMomentum(body_momentum().0),
            J: inertia(), carried: moved
        } R
    );
}

#[test]
fn what_moves_may_bear_such_names() {
    let model = AwkwardStep::new(AwkwardStepParameters {
        J: inertia(),
        lever: Vector3::x(),
    })
    .unwrap();
    let start = AwkwardStepInitial {
        matrix: attitude(),
        body_momentum: body_momentum(),
        initial: Vector3::y(),
        value: 0.5,
    };
    let (mut state, mut workspace) = model.start(start, 0.1).unwrap();
    model.step(&mut state, &mut workspace).unwrap();
    assert_eq!(model.value(&state), 0.5);
    assert!((model.initial(&state).norm() - 1.0).abs() < 1e-15);

    let model = AwkwardAtHand::new(AwkwardAtHandParameters {
        h: 1.0,
        parameters: 0.3,
        solver: Matrix3::from_diagonal(&Vector3::new(0.9, 1.2, 0.7)),
        factor: Matrix3::new(0.0, 0.1, 0.2, -0.1, 0.0, 0.3, -0.2, -0.3, 0.0),
        residual: Matrix3x2::new(0.1, 0.2, 0.3, 0.4, 0.5, 0.6),
        guess: attitude().matrix(),
    })
    .unwrap();
    let start = AwkwardAtHandInitial {
        length: attitude(),
        body_momentum: body_momentum(),
    };
    let (mut state, mut workspace) = model.start(start, 0.1).unwrap();
    model.step(&mut state, &mut workspace).unwrap();
    assert_eq!(state.node(), 1);
}

#[test]
fn shadowed_items_are_not_met() {
    let parameters = shadowed::ShadowedParameters {
        J: inertia(),
        g: Vector3::x(),
        z: Vector3::z(),
    };
    let model = shadowed::Shadowed::new(parameters).unwrap();
    let start = shadowed::ShadowedInitial {
        Λ: attitude(),
        body_momentum: body_momentum(),
    };
    let (mut state, mut work) = model.start(start, 0.1).unwrap();
    model.step(&mut state, &mut work).unwrap();
    assert_eq!(state.node(), 1);
}

#[test]
fn models_stand_in_functions_and_next_to_each_other() {
    clebsch::model! {
        model Local {
            param J: Sym<3>;
            group Λ: SO<3> velocity Ω;
            constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(J*Ω)/h;
        }
    }
    // A name that also exists outside: the model refers to its own.
    clebsch::model! {
        model Private {
            param J: Sym<3>;
            param weight: Real;
            group Λ: SO<3> velocity Ω;
            constraint next(Λ) = Λ*Ω;
            lagrangian = -tr(J*Ω)*weight/h;
        }
    }
    let initial = LocalInitial {
        Λ: attitude(),
        body_momentum: body_momentum(),
    };
    let local = Local::new(LocalParameters { J: inertia() }).unwrap();
    assert!(local.start(initial, 0.1).is_ok());
    assert!(
        Private::new(PrivateParameters {
            J: inertia(),
            weight: 2.0
        })
        .is_ok()
    );
    assert_eq!(card(Exported::<f64>::SOURCE).kebab, "exported");
    let kebab = card(WithoutDocumentation::<f64>::SOURCE).kebab;
    assert_eq!(kebab, "without-documentation");
}

#[test]
fn words_of_rust_are_refused_with_a_reason() {
    let words = "as async await break const continue crate do dyn else enum extern false final fn for gen if impl in \
        let loop macro match mod move mut override priv pub ref return self Self static struct super trait true try \
        type typeof unsafe unsized use virtual where while yield abstract become box _";
    for word in words.split_whitespace() {
        for text in [
            format!("model M {{ param {word}: Real; }}"),
            format!("model M {{ param J: Sym<3>; group {word}: SO<3> velocity Ω; }}"),
            format!("model M {{ param J: Sym<3>; group Λ: SO<3> velocity {word}; }}"),
            format!("model M {{ param J: Sym<3>; advected {word}: Vec<3>; }}"),
            format!("model M {{ time k step {word}; }}"),
            format!("model {word} {{ param J: Sym<3>; }}"),
        ] {
            let errors = clebsch_core::derive_source(&text)
                .expect_err(&text)
                .to_string();
            let said = format!("`{word}` is a Rust keyword");
            assert!(errors.contains(&said), "{text}: {errors}");
        }
    }
}
