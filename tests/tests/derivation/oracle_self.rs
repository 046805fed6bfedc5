//! Tests the oracle without the engine. At random points, compares its systems with differences of the action, with closed-form
//! discrete Euler-Lagrange equations of the free body and the heavy top, and with conservation laws.

use clebsch_oracle::oracle::action::bodies::{FreeBody, HeavyTop, Stated, TwoVectors};
use clebsch_oracle::oracle::action::coupled::CoupledBodies;
use clebsch_oracle::oracle::action::elastic::{EllipsoidConvective, entries};
use clebsch_oracle::oracle::action::spatial::{FreeBodySpatial, HeavyTopSpatial};
use clebsch_oracle::oracle::action::{
    DiscreteAction, Side, momentum_in, momentum_out, rotations, stationarity,
};
use clebsch_oracle::oracle::dual::{Dual, Number};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{Square, cross, dot, vee};
use clebsch_oracle::oracle::wide::grid::Grid;
use clebsch_oracle::oracle::wide::point::Node;
use clebsch_oracle::oracle::wide::{Model, Point};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::sizes::{DIFFERENTIATED, WRITTEN};
use std::array::from_fn;

/// The rounding error of a few hundred operations with relative error 1e-16, on the natural scale.
const ROUNDING: f64 = 1e-13;

/// Two differences over 1e-3 and 2e-3 that deviate by more than this, relative to the scale, indicate a kink.
const KINK: f64 = 1e-5;

fn expected(value: &[f64], reference: &[f64], scale: f64, tolerance: f64, what: &str) {
    assert_eq!(value.len(), reference.len(), "{what}");
    for (i, (a, b)) in value.iter().zip(reference).enumerate() {
        // Written so that NaN fails.
        assert!(
            (a - b).abs() <= tolerance * scale,
            "{what}, component {i}: {a:e} and {b:e} on the scale {scale:e}"
        );
    }
}

fn nodes<const N: usize, const G: usize, S: Stated<N, G>>(
    source: &mut Source,
) -> [[Square<f64, N>; G]; 3] {
    from_fn(|_| S::node(source))
}

/// `Σ x^n/n!` of a small matrix; 20 terms reach rounding for entries below 1.
fn exponential<const N: usize>(matrix: Square<f64, N>) -> Square<f64, N> {
    let mut sum = Square::identity();
    let mut power = Square::identity();
    for n in 1..20 {
        power = (power * matrix).scaled(1.0 / f64::from(n));
        sum = sum + power;
    }
    sum
}

/// The residual by Richardson-extrapolated central differences along the exponential.
fn differences<const N: usize, const G: usize>(
    action: &impl DiscreteAction<N, G>,
    nodes: &[[Square<f64, N>; G]; 3],
    basis: &[Square<f64, N>],
) -> Vec<f64> {
    let total = |here: &[Square<f64, N>; G]| -> f64 {
        let before: f64 = action.edge(&nodes[0], here).iter().sum();
        before + action.edge(here, &nodes[2]).iter().sum::<f64>()
    };
    let mut derivative = Vec::new();
    for group in 0..G {
        for direction in basis {
            let at = |epsilon: f64| {
                let mut here = nodes[1];
                let turn = exponential(direction.scaled(epsilon));
                here[group] = match action.side() {
                    Side::Body => here[group] * turn,
                    Side::Space => turn * here[group],
                };
                total(&here)
            };
            let slope = |epsilon: f64| (at(epsilon) - at(-epsilon)) / (2.0 * epsilon);
            let (coarse, fine) = (slope(2e-3), slope(1e-3));
            derivative.push((4.0 * fine - coarse) / 3.0);
        }
    }
    derivative
}

fn agrees_with_differences<const N: usize, const G: usize, S: Stated<N, G>>(
    basis: &[Square<f64, N>],
    seed: u64,
) {
    let mut source = Source::seeded(seed);
    for _ in 0..20 {
        let system = S::random(&mut source);
        let nodes = nodes::<N, G, S>(&mut source);
        let exact = stationarity(&system, &nodes, basis);
        let approximate = differences(&system, &nodes, basis);
        // Extrapolated differences with step 1e-3: rounding error 1e-16/1e-3, truncation error (1e-3)^4.
        expected(
            &exact.derivative,
            &approximate,
            exact.scale.max(1.0),
            1e-9,
            &S::text(),
        );
    }
}

#[test]
fn hand_typed_variations_are_derivatives_of_the_action() {
    agrees_with_differences::<3, 1, HeavyTop<0>>(&rotations(), 1);
    agrees_with_differences::<3, 1, TwoVectors>(&rotations(), 2);
    agrees_with_differences::<3, 2, CoupledBodies<true>>(&rotations(), 3);
    agrees_with_differences::<3, 1, HeavyTopSpatial>(&rotations(), 4);
    agrees_with_differences::<3, 1, EllipsoidConvective<3>>(&entries(), 5);
}

/// Differences of a random model's action along straight lines, and the deviation between the two difference steps. The action is a
/// function of matrices, on or off the group.
fn differences_of(point: &Point<'_>, nodes: &[Node; 3]) -> Vec<[f64; 2]> {
    let total = |here: &Node| -> f64 {
        let before: f64 = point.edge(&nodes[0], here).iter().sum();
        before + point.edge(here, &nodes[2]).iter().sum::<f64>()
    };
    let along = |(body, tangent): &(usize, Grid<f64>)| {
        let at = |epsilon: f64| {
            let mut here = nodes[1].clone();
            here[*body] = here[*body].plus(&tangent.scaled(epsilon));
            total(&here)
        };
        let slope = |epsilon: f64| (at(epsilon) - at(-epsilon)) / (2.0 * epsilon);
        let (coarse, fine) = (slope(2e-3), slope(1e-3));
        [(4.0 * fine - coarse) / 3.0, (fine - coarse).abs()]
    };
    point.directions(&nodes[1]).iter().map(along).collect()
}

#[test]
fn random_variations_are_derivatives_of_the_action() {
    let (mut worst, mut kinks): (f64, usize) = (0.0, 0);
    for seed in 0..DIFFERENTIATED {
        let model = Model::of_seed(seed);
        let mut source = Source::seeded(seed + 1_000_000);
        for _ in 0..3 {
            let step = source.between(0.2, 1.0);
            let point = Point::draw(&model, &mut source, step);
            let nodes: [Node; 3] = from_fn(|_| point.node(&mut source));
            let exact = point.stationarity(&nodes);
            assert!(exact.scale.is_finite(), "{}", model.text());
            let action: f64 = [(0, 1), (1, 2)]
                .iter()
                .flat_map(|&(a, b)| point.edge(&nodes[a], &nodes[b]))
                .map(|summand: f64| summand.abs())
                .sum();
            // Differences have a rounding error of 1e-16/1e-3 of the action and a truncation error of (1e-3)^4 of its fifth
            // derivative. For products of many factors, the fifth derivative reaches 1e4 times the first.
            let scale = exact.scale + action;
            let text = model.text();
            let bent = text.contains("abs(") || text.contains("sign(");
            for (a, [b, apart]) in exact.derivative.iter().zip(differences_of(&point, &nodes)) {
                // A kink of `abs` or `sign` lies between the sample points; for a smooth action the deviation is (1e-3)^2 of its
                // third derivative.
                if bent && apart > KINK * scale {
                    kinks += 1;
                    continue;
                }
                expected(&[*a], &[b], scale, 1e-7, &text);
                worst = worse(worst, (a - b).abs() / scale);
            }
        }
    }
    println!("worst disagreement with differences: {worst:e}, {kinks} kinks");
    assert!(kinks < 10, "{kinks}");
}

#[test]
fn the_free_body_transports_its_momentum() {
    let mut source = Source::seeded(11);
    for _ in 0..1000 {
        let body = FreeBody::random(&mut source);
        let nodes = nodes::<3, 1, FreeBody>(&mut source);
        let residual = stationarity(&body, &nodes, &rotations());
        let omega = [
            nodes[0][0].transpose() * nodes[1][0],
            nodes[1][0].transpose() * nodes[2][0],
        ];
        // h N = axial vector of Ω J - J Ωᵀ, twice the skew part.
        let momentum = |omega: &Square<f64, 3>| {
            let moved = *omega * body.second_moment;
            vee(&(moved - moved.transpose())).map(|entry| entry / body.h)
        };
        let arriving = omega[0].transpose().apply(&momentum(&omega[0]));
        let leaving = momentum(&omega[1]);
        let expectation: [f64; 3] = from_fn(|i| arriving[i] - leaving[i]);
        expected(
            &residual.derivative,
            &expectation,
            residual.scale,
            ROUNDING,
            "free body",
        );
        let before = momentum_in(&body, &nodes[0], &nodes[1], &rotations());
        expected(
            &before.derivative,
            &arriving,
            before.scale,
            ROUNDING,
            "momentum in",
        );
        let after = momentum_out(&body, &nodes[1], &nodes[2], &rotations());
        expected(
            &after.derivative,
            &leaving,
            after.scale,
            ROUNDING,
            "momentum out",
        );
    }
}

fn heavy_top_law<const RULE: u8>(leaving_share: f64, arriving_share: f64) {
    let mut source = Source::seeded(12);
    for _ in 0..300 {
        let top: HeavyTop<RULE> = HeavyTop::random(&mut source);
        let nodes = nodes::<3, 1, HeavyTop<RULE>>(&mut source);
        let residual = stationarity(&top, &nodes, &rotations());
        let transport = |from: usize, to: usize| {
            let omega = nodes[from][0].transpose() * nodes[to][0];
            let moved = omega * top.second_moment;
            let edge = vee(&(moved - moved.transpose())).map(|entry| entry / top.h);
            (omega.transpose().apply(&edge), edge)
        };
        let (arriving, _) = transport(0, 1);
        let (_, leaving) = transport(1, 2);
        let vertical = nodes[1][0].transpose().apply(&top.vertical);
        // N_{k+1} = Ω_kᵀ N_k + h Γ_k × gU.
        let torque = cross(&vertical, &top.lever).map(|entry| top.h * entry);
        let expectation: [f64; 3] = from_fn(|i| arriving[i] + torque[i] - leaving[i]);
        expected(
            &residual.derivative,
            &expectation,
            residual.scale,
            ROUNDING,
            "heavy top",
        );
        // N = μ + share h Γ × gU out of the node, μ' = Ωᵀ N + share h Γ' × gU into it.
        let out = momentum_out(&top, &nodes[1], &nodes[2], &rotations());
        let node: [f64; 3] = from_fn(|i| leaving[i] - leaving_share * torque[i]);
        expected(&out.derivative, &node, out.scale, ROUNDING, "momentum out");
        let into = momentum_in(&top, &nodes[0], &nodes[1], &rotations());
        let node: [f64; 3] = from_fn(|i| arriving[i] + arriving_share * torque[i]);
        expected(&into.derivative, &node, into.scale, ROUNDING, "momentum in");
    }
}

#[test]
fn the_heavy_top_obeys_its_law_under_every_rule_of_the_nodes() {
    heavy_top_law::<0>(0.5, 0.5);
    heavy_top_law::<1>(0.0, 1.0);
    heavy_top_law::<2>(1.0, 0.0);
}

#[test]
fn momenta_of_symmetric_actions_are_equal_at_both_ends() {
    let mut source = Source::seeded(13);
    for _ in 0..300 {
        // A free body is invariant under rotations of space: Λ μ is the same at both ends of an edge.
        let body = FreeBody::random(&mut source);
        let [tail, head, _] = nodes::<3, 1, FreeBody>(&mut source);
        let out = momentum_out(&body, &tail, &head, &rotations());
        let into = momentum_in(&body, &tail, &head, &rotations());
        let carry = |node: &[Square<f64, 3>; 1], m: &[f64]| node[0].apply(&from_fn(|i| m[i]));
        expected(
            &carry(&head, &into.derivative),
            &carry(&tail, &out.derivative),
            out.scale,
            ROUNDING,
            "spatial momentum",
        );
        // The spatial side varies Λ in space and gives the same spatial momentum directly.
        let spatial = FreeBodySpatial {
            h: body.h,
            second_moment: body.second_moment,
        };
        let seen = momentum_out(&spatial, &tail, &head, &rotations());
        expected(
            &seen.derivative,
            &carry(&tail, &out.derivative),
            out.scale,
            ROUNDING,
            "both sides",
        );
        // A weight preserves the momentum about the vertical.
        let top = HeavyTop::<0>::random(&mut source);
        let out = momentum_out(&top, &tail, &head, &rotations());
        let into = momentum_in(&top, &tail, &head, &rotations());
        let along = |node: &[Square<f64, 3>; 1], m: &[f64]| dot(&carry(node, m), &top.vertical);
        expected(
            &[along(&head, &into.derivative)],
            &[along(&tail, &out.derivative)],
            out.scale,
            ROUNDING,
            "vertical momentum",
        );
        // For two bodies without external forces, the sum of both spatial momenta is conserved.
        let pair = CoupledBodies::<true>::random(&mut source);
        let [tail, head, _] = nodes::<3, 2, CoupledBodies<true>>(&mut source);
        let out = momentum_out(&pair, &tail, &head, &rotations());
        let into = momentum_in(&pair, &tail, &head, &rotations());
        let total = |node: &[Square<f64, 3>; 2], m: &[f64]| -> [f64; 3] {
            let first = node[0].apply(&from_fn(|i| m[i]));
            let second = node[1].apply(&from_fn(|i| m[i + 3]));
            from_fn(|i| first[i] + second[i])
        };
        expected(
            &total(&head, &into.derivative),
            &total(&tail, &out.derivative),
            out.scale,
            ROUNDING,
            "total momentum",
        );
    }
}

#[test]
fn dual_numbers_differentiate() {
    let x = Dual {
        value: 0.7,
        slope: 1.0,
    };
    let one = Dual::constant(1.0);
    let cases = [
        ((x * x + one).sqrt(), 0.7 / 1.49f64.sqrt()),
        ((x * x).exp(), 1.4 * 0.49f64.exp()),
        (x.ln(), 1.0 / 0.7),
        (one / x, -1.0 / 0.49),
        (x.power(3), 3.0 * 0.49),
        (x.power(-2), -2.0 / 0.343),
        (-x + one, -1.0),
    ];
    for (result, slope) in cases {
        expected(&[result.slope], &[slope], slope.abs(), 1e-15, "slope");
    }
    let mut source = Source::seeded(14);
    let matrix: Square<f64, 4> = source.invertible();
    let product = matrix * matrix.inverse() - Square::identity();
    expected(&product.0.concat(), &[0.0; 16], 1.0, ROUNDING, "inverse");
    let square = (matrix * matrix).determinant();
    expected(
        &[square],
        &[matrix.determinant().powi(2)],
        square,
        ROUNDING,
        "determinant",
    );
}

#[test]
fn random_models_are_varied() {
    let mut count = [0usize; 9];
    for seed in 0..WRITTEN {
        let text = Model::of_seed(seed).text();
        let features = [
            text.contains("= V*g"),
            text.contains("node "),
            text.contains("scale "),
            text.contains("inv(") || text.contains("^-1"),
            text.contains("Sym<") && text.contains("advected"),
            text.contains("exp(") || text.contains("log(") || text.contains("sqrt("),
            text.contains("let "),
            text.contains("next(q"),
            text.contains("det("),
        ];
        for (counter, feature) in count.iter_mut().zip(features) {
            *counter += usize::from(feature);
        }
    }
    println!(
        "spatial, one-sided, scaled, inverses, symmetric, functions, named, ends, determinants: {count:?}"
    );
    assert!(count.iter().all(|&counter| counter >= 10), "{count:?}");
}
