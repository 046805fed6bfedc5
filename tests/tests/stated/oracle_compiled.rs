//! Emitted code against the variation of the unreduced action: residuals, steps and momenta.
//! Takes both models of the gallery and five random Lagrangians typed as macro invocations; gives
//! agreement of the residual to 1e-10, and stationarity of the action of two emitted steps to rounding.

// The letters of random models are drawn from two alphabets on purpose.

use super::oracle_typed::*;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation, SpatialMomentum};
use clebsch_models::free_body::{
    FreeBody, FreeBodyConfiguration, FreeBodyInitial, FreeBodyParameters,
};
use clebsch_models::heavy_top::{
    HeavyTop, HeavyTopConfiguration, HeavyTopInitial, HeavyTopParameters,
};
use clebsch_oracle::oracle::action::bodies::{self, Stated};
use clebsch_oracle::oracle::action::{
    DiscreteAction, momentum_in, momentum_out, rotations, sensitivity, stationarity,
};
use clebsch_oracle::oracle::points::{Given, Source};
use clebsch_oracle::oracle::random::RandomLagrangian;
use clebsch_oracle::oracle::random::sample::Sample;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// Random points and random states for every model.
const POINTS: usize = 1000;
/// Agreement of residuals, relative to the sum of the sizes of the summands.
const AGREEMENT: f64 = 1e-10;
/// What rounding leaves of a solved equation: a thousand roundings of 1e-16, magnified by the sensitivity
/// of the equation to the entries of the group elements.
const ROUNDING: f64 = 1e-13;

type Node = [Square<f64, 3>; 1];

/// Three nodes that emitted code made, and the momenta it gives at the first two.
struct Trajectory {
    nodes: [Node; 3],
    momenta: [[f64; 3]; 2],
}

/// A compiled model in the data of the oracle.
trait Compiled: Sized {
    /// The model with the parameters given.
    fn with(given: &[Given]) -> Self;
    /// The residual at the three nodes given.
    fn residual(&self, h: f64, given: &[Given]) -> Vec<f64>;
    /// Two steps from a state; None if one is refused.
    fn two_steps(&self, h: f64, given: &[Given], momentum: [f64; 3]) -> Option<Trajectory>;
}

fn values<'a>(given: &'a [Given], name: &str, shift: i8) -> &'a [f64] {
    given
        .iter()
        .find(|value| value.name == name && value.shift == shift)
        .map_or_else(|| panic!("{name} is not given"), |value| &value.data)
}

/// A value in the type that a field asks for.
trait Typed {
    fn typed(values: &[f64]) -> Self;
}

impl Typed for f64 {
    fn typed(values: &[f64]) -> Self {
        values[0]
    }
}

impl Typed for Vector3<f64> {
    fn typed(values: &[f64]) -> Self {
        Self::from_column_slice(values)
    }
}

impl Typed for Matrix3<f64> {
    fn typed(values: &[f64]) -> Self {
        Self::from_row_slice(values)
    }
}

impl Typed for Rotation<f64> {
    fn typed(values: &[f64]) -> Self {
        Self::from_matrix(&Matrix3::from_row_slice(values)).expect("a rotation")
    }
}

fn typed<V: Typed>(given: &[Given], name: &str, shift: i8) -> V {
    V::typed(values(given, name, shift))
}

fn square(rotation: &Rotation<f64>) -> Square<f64, 3> {
    let matrix = rotation.matrix();
    Square::from_entries(|i, j| matrix[(i, j)])
}

/// Implements `Compiled`: names of the group, of its momentum, of parameters, and of advected quantities
/// without a definition.
macro_rules! compiled {
    (
        $model:ident, $parameters:ident, $configuration:ident, $initial:ident,
        $group:ident, $momentum:ident: $kind:ident,
        [$($parameter:ident),*], [$($kept:ident),*]
    ) => {
        impl Compiled for $model<f64> {
            fn with(given: &[Given]) -> Self {
                Self::new($parameters {
                    $($parameter: typed(given, stringify!($parameter), 0),)*
                })
                .expect("admissible parameters")
            }

            fn residual(&self, h: f64, given: &[Given]) -> Vec<f64> {
                let [before, here, after] = [-1, 0, 1].map(|shift| $configuration {
                    $group: typed(given, stringify!($group), shift),
                    $($kept: typed(given, stringify!($kept), shift),)*
                });
                self.balance(h, &before, &here, &after).as_slice().to_vec()
            }

            fn two_steps(&self, h: f64, given: &[Given], momentum: [f64; 3]) -> Option<Trajectory> {
                let initial = $initial {
                    $group: typed(given, stringify!($group), 0),
                    $momentum: $kind(Vector3::from(momentum)),
                    $($kept: typed(given, stringify!($kept), 0),)*
                };
                let (mut state, mut workspace) = self.start(initial, h).ok()?;
                let mut nodes = [[square(&state.$group())]; 3];
                let mut momenta = [momentum; 2];
                self.step(&mut state, &mut workspace).ok()?;
                nodes[1] = [square(&state.$group())];
                momenta[1] = state.$momentum().0.into();
                self.step(&mut state, &mut workspace).ok()?;
                nodes[2] = [square(&state.$group())];
                Some(Trajectory { nodes, momenta })
            }
        }
    };
}

compiled!(
    FreeBody, FreeBodyParameters, FreeBodyConfiguration, FreeBodyInitial,
    Λ, body_momentum: BodyMomentum, [J], []
);
compiled!(
    HeavyTop, HeavyTopParameters, HeavyTopConfiguration, HeavyTopInitial,
    Λ, body_momentum: BodyMomentum, [J, gU, z], []
);
compiled!(
    Random23, Random23Parameters, Random23Configuration, Random23Initial,
    Λ, body_momentum: BodyMomentum, [J, L, κ, U], [c, χ]
);
compiled!(
    Random26, Random26Parameters, Random26Configuration, Random26Initial,
    Λ, body_momentum: BodyMomentum, [J, K_a], []
);
compiled!(
    Random34, Random34Parameters, Random34Configuration, Random34Initial,
    Lambda, body_momentum: BodyMomentum, [J, α, L, lever], []
);
compiled!(
    Random117, Random117Parameters, Random117Configuration, Random117Initial,
    Q, spatial_momentum: SpatialMomentum, [J, α], [c, Γ]
);
compiled!(
    Random217, Random217Parameters, Random217Configuration, Random217Initial,
    Lambda, body_momentum: BodyMomentum, [J, mass, C], [ξ]
);

/// One random system: its action, its step, and what is given at three nodes.
trait System: DiscreteAction<3, 1> {
    fn step(&self) -> f64;
    fn given(&self, nodes: &[Node; 3]) -> Vec<Given>;
}

impl System for bodies::FreeBody {
    fn step(&self) -> f64 {
        Stated::step(self)
    }
    fn given(&self, nodes: &[Node; 3]) -> Vec<Given> {
        Stated::given(self, nodes)
    }
}

impl System for bodies::HeavyTop<0> {
    fn step(&self) -> f64 {
        Stated::step(self)
    }
    fn given(&self, nodes: &[Node; 3]) -> Vec<Given> {
        Stated::given(self, nodes)
    }
}

impl System for Sample<'_> {
    fn step(&self) -> f64 {
        self.step
    }
    fn given(&self, nodes: &[Node; 3]) -> Vec<Given> {
        Sample::given(self, nodes)
    }
}

fn residuals_agree<M: Compiled, S: System>(draw: impl Fn(&mut Source) -> S) {
    let mut source = Source::seeded(4);
    let mut worst: f64 = 0.0;
    for point in 0..POINTS {
        let system = draw(&mut source);
        let nodes: [Node; 3] = from_fn(|_| [source.orthogonal()]);
        let given = system.given(&nodes);
        let oracle = stationarity(&system, &nodes, &rotations());
        let emitted = M::with(&given).residual(system.step(), &given);
        assert_eq!(emitted.len(), oracle.derivative.len());
        for (expected, found) in oracle.derivative.iter().zip(&emitted) {
            let difference = (expected - found).abs() / oracle.scale;
            assert!(
                difference <= AGREEMENT,
                "point {point}: off by {difference:e} of {:e}\noracle {:?}\nemitted {emitted:?}",
                oracle.scale,
                oracle.derivative
            );
            worst = worse(worst, difference);
        }
    }
    println!("worst residual {worst:e}");
}

/// Compares with what rounding explains; returns the ratio.
fn rounded(what: &str, expected: &[f64], found: &[f64], allowance: f64) -> f64 {
    let worst = expected
        .iter()
        .zip(found)
        .map(|(a, b)| (a - b).abs() / allowance)
        .fold(0.0, worse);
    assert!(
        worst <= ROUNDING,
        "{what}: {worst:e} of {allowance:e}\noracle {expected:?}\nemitted {found:?}"
    );
    worst
}

/// Steps from random states solve the equations of the unreduced action. `draw` gives a system with a
/// small step, `largest` bounds the momentum.
fn steps_are_stationary<M: Compiled, S: System>(largest: f64, draw: impl Fn(&mut Source) -> S) {
    let mut source = Source::seeded(5);
    let basis = rotations();
    let (mut done, mut refused) = (0, 0);
    let mut worst = [0.0f64; 3];
    while done < POINTS {
        let system = draw(&mut source);
        let start: Node = [source.orthogonal()];
        let momentum = source.vector::<3>().map(|component| largest * component);
        let given = system.given(&[start; 3]);
        let Some(trajectory) = M::with(&given).two_steps(system.step(), &given, momentum) else {
            refused += 1;
            assert!(
                refused * 20 <= POINTS,
                "{refused} of {done} states are refused"
            );
            continue;
        };
        done += 1;
        let Trajectory { nodes, momenta } = trajectory;
        let residual = stationarity(&system, &nodes, &basis);
        let sensitive = sensitivity(&nodes, &basis, |nodes| {
            stationarity(&system, nodes, &basis).derivative
        });
        let allowance = residual.scale + sensitive;
        let zero = [0.0; 3];
        worst[0] = worse(
            worst[0],
            rounded("stationarity", &residual.derivative, &zero, allowance),
        );
        let edge = [nodes[0], nodes[1]];
        let out = momentum_out(&system, &edge[0], &edge[1], &basis);
        let sensitive = sensitivity(&edge, &basis, |[tail, head]| {
            momentum_out(&system, tail, head, &basis).derivative
        });
        let allowance = out.scale + sensitive;
        worst[1] = worse(
            worst[1],
            rounded("momentum out", &out.derivative, &momenta[0], allowance),
        );
        let into = momentum_in(&system, &edge[0], &edge[1], &basis);
        let sensitive = sensitivity(&edge, &basis, |[tail, head]| {
            momentum_in(&system, tail, head, &basis).derivative
        });
        let allowance = into.scale + sensitive;
        worst[2] = worse(
            worst[2],
            rounded("momentum in", &into.derivative, &momenta[1], allowance),
        );
    }
    let [stationary, out, into] = worst;
    println!("worst {stationary:e}, momentum out {out:e}, momentum in {into:e}; {refused} refused");
}

#[test]
fn residual_of_the_free_body() {
    residuals_agree::<FreeBody, _>(bodies::FreeBody::random);
}

#[test]
fn residual_of_the_heavy_top() {
    residuals_agree::<HeavyTop, _>(bodies::HeavyTop::<0>::random);
}

#[test]
fn steps_of_the_free_body() {
    steps_are_stationary::<FreeBody, _>(0.8, |source| bodies::FreeBody {
        h: source.between(0.05, 0.4),
        ..bodies::FreeBody::random(source)
    });
}

#[test]
fn steps_of_the_heavy_top() {
    steps_are_stationary::<HeavyTop, _>(0.8, |source| bodies::HeavyTop::<0> {
        h: source.between(0.05, 0.4),
        ..bodies::HeavyTop::random(source)
    });
}

fn random<M: Compiled>(seed: u64) {
    let lagrangian = RandomLagrangian::of_seed(seed);
    residuals_agree::<M, _>(|source| Sample::draw(&lagrangian, source));
    // Small steps: the kinetic summand dominates and the equation has the solution near the identity.
    steps_are_stationary::<M, _>(0.8, |source| {
        let sample = Sample::draw(&lagrangian, source);
        Sample::with(&lagrangian, source.between(0.01, 0.05), sample.constants)
    });
}

#[test]
fn random_lagrangian_23() {
    random::<Random23>(23);
}

#[test]
fn random_lagrangian_26() {
    random::<Random26>(26);
}

#[test]
fn random_lagrangian_117() {
    random::<Random117>(117);
}

#[test]
fn random_lagrangian_34() {
    random::<Random34>(34);
}

#[test]
fn random_lagrangian_217() {
    random::<Random217>(217);
}

#[test]
fn typed_models_are_those_of_the_generator() {
    let stale = super::oracle_typed::stale();
    assert!(
        stale.is_empty(),
        "not typed in oracle_typed:\n{}",
        stale.join("\n")
    );
}
