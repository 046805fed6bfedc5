//! Conservation along chains: the symplectic form by the tangent map, momenta, bounded energy, and reversibility.

use super::action::{momenta, off_constraints, without_reactions};
use super::models::{self, Linked, Quartic, Random, Wide};
use clebsch::nalgebra::SMatrix;

/// The change of `dq ^ dp` under the tangent map of a chain with six coordinates, relative to the square of its largest entry.
fn change_of_the_form(moved: impl Fn(Vec<Wide>, Vec<Wide>) -> [Vec<Wide>; 2]) -> f64 {
    let mut r = Random::new(5);
    let mut list = |from: usize| -> Vec<Wide> {
        (0..6)
            .map(|i| Wide::variable(r.number(), from + i))
            .collect()
    };
    let [q, p] = moved(list(0), list(6));
    let all: Vec<Wide> = q.into_iter().chain(p).collect();
    assert_eq!(all.len(), 12);
    let map = SMatrix::<f64, 12, 12>::from_fn(|i, j| all[i].dual[j]);
    let form = SMatrix::<f64, 12, 12>::from_fn(|i, j| match (i + 6 == j, j + 6 == i) {
        (true, _) => 1.0,
        (_, true) => -1.0,
        _ => 0.0,
    });
    (map.transpose() * form * map - form).amax() / map.amax().powi(2)
}

#[test]
fn sites_that_newtons_method_solves_keep_the_symplectic_form() {
    for (n, ends) in [(6, 0), (5, 1)] {
        let (linked, quartic) = (Linked { n, ends }, Quartic { n, ends });
        // Sums of about twenty products.
        let off = change_of_the_form(|q, p| linked.moved(q, p));
        assert!(off < 1e-14, "linked, ends {ends}: {off:e}");
        let off = change_of_the_form(|q, p| quartic.moved(q, p));
        assert!(off < 1e-14, "quartic, ends {ends}: {off:e}");
    }
}

#[test]
fn given_momenta_are_those_of_the_action() {
    for n in [1, 2, 5, 12] {
        for line in models::all(n) {
            let [a, b, _] = line.three(2);
            let (derived, given) = (momenta(line.as_ref(), [&a, &b]), line.given(2));
            let scale = given.iter().fold(1e-300_f64, |m, p| m.max(p.abs()));
            if !line.constraints(&a.lifted()).is_empty() {
                // The momentum after the step includes the constraint forces of its node.
                let off: Vec<f64> = derived.iter().zip(&given).map(|(p, q)| p - q).collect();
                let left = without_reactions(line.as_ref(), &a, &off);
                let off = clebsch::scalar::largest(left.into_iter().map(f64::abs));
                assert!(off < 1e-11 * scale.max(1.0), "{}: {off:e}", line.name());
                continue;
            }
            for (at, (p, q)) in derived.iter().zip(&given).enumerate() {
                if !line.held(at) {
                    let off = (p - q).abs() / scale;
                    // Differences of positions of order one, divided by the step size.
                    assert!(off < 1e-11, "{}: {p} for {q} at {at}", line.name());
                }
            }
        }
    }
}

#[test]
fn what_is_held_is_held_to_rounding() {
    for n in [1, 2, 3, 5, 12, 50] {
        for line in models::all(n) {
            let [a, b, c] = line.three(3);
            for after in [&b, &c] {
                let off = off_constraints(line.as_ref(), &a, after);
                // Thirty-two rounding errors of terms up to the length of the chain.
                assert!(off < 1e-12, "{}: {off:e}", line.name());
            }
        }
    }
}

#[test]
fn the_way_back_is_the_way() {
    for line in models::all(5) {
        let off = line.there_and_back(200);
        // Two hundred steps forward and back, each with a few rounding errors.
        assert!(off < 1e-11, "{}: {off:e}", line.name());
    }
}

/// Slow: every chain takes up to 20000 steps.
#[test]
fn energies_stay_within_a_bound_and_totals_to_rounding() {
    for line in models::all(12) {
        let steps = if line.is_smooth() { 20_000 } else { 500 };
        let [energy, total] = line.kept(steps);
        assert!(
            energy < line.energy_bound() || !line.is_smooth(),
            "{}: energy {energy:e}",
            line.name()
        );
        // A random walk of 2e4 rounding errors of 1e-16.
        assert!(total < 2e-13, "{}: total {total:e}", line.name());
    }
}

#[test]
fn bounds_of_the_energy_fall_with_the_square_of_the_step() {
    for line in models::all(5).iter().filter(|l| l.is_smooth()) {
        let ratio = line.energy_ratio();
        assert!((3.2..5.0).contains(&ratio), "{}: {ratio}", line.name());
    }
}
