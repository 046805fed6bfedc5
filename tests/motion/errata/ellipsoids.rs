//! Errata of chapter 3, ellipsoids on GL(n). At random points, gives the printed and the correct form to `judge`.

use super::{Matrix, ad_star, id, inner, judge, size};
use clebsch_oracle::oracle::action::elastic::entries;
use clebsch_oracle::oracle::action::{DiscreteAction, stationarity};
use clebsch_oracle::oracle::dual::Number;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use std::array::from_fn;

#[test]
fn three_4_is_a_congruence() {
    judge("(3.4)", |s| {
        let (g, c): (Matrix, Matrix) = (s.matrix(), s.positive());
        let asymmetry = |a: Matrix| size(&(a - a.transpose()));
        let printed = asymmetry(g.transpose() * c * g.transpose());
        (printed, asymmetry(g.transpose() * c * g))
    });
}

#[test]
fn three_36_to_three_39_spatial_ellipsoid() {
    judge("(3.38)", |s| {
        // A point on which (3.36) holds: γᵀ ∇ℓ = P Qᵀ + 2 (J + ∇ℓ_I) I.
        let (p, q, j, force): (Matrix, Matrix, Matrix, Matrix) =
            (s.matrix(), s.matrix(), s.symmetric(), s.symmetric());
        let shape = q * q.transpose();
        let wanted = p * q.transpose() + (j + force) * shape.scaled(2.0);
        let printed = p * q.transpose() + (j + force * shape).scaled(2.0);
        let right = p * q.transpose() + ((j + force) * shape).scaled(2.0);
        (size(&(printed - wanted)), size(&(right - wanted)))
    });
    judge("(3.39)", |s| {
        let (c0, shape, g, change): (Matrix, Matrix, Matrix, Matrix) =
            (s.positive(), s.positive(), s.matrix(), s.matrix());
        // l = tr((γ - 1) I (γ - 1)ᵀ C0)/2, quadratic: the central difference is exact.
        let l = |g: Matrix| {
            let moved = g - id();
            0.5 * (moved * shape * moved.transpose() * c0).trace()
        };
        let slope = 0.5 * (l(g + change) - l(g - change));
        let gradient = |m: Matrix| inner(&m, &change);
        let printed = gradient((g - id()) * shape);
        let right = gradient(c0 * (g - id()) * shape);
        ((printed - slope).abs(), (right - slope).abs())
    });
}

#[test]
fn three_36_the_spatial_velocity_carries_the_multiplier() {
    judge("(3.36)", |s| {
        let (p, q, velocity): (Matrix, Matrix, Matrix) =
            (s.matrix(), s.invertible(), s.invertible());
        // <P_k - γᵀ P_{k+1}, δQ> = 0, and Γ = Q⁻¹ γ Q.
        let convective = q.inverse() * velocity * q;
        let off = |next: Matrix| size(&(velocity.transpose() * next - p));
        (
            off(convective.transpose().inverse() * p),
            off(velocity.transpose().inverse() * p),
        )
    });
}

#[test]
fn after_three_20_the_metric_of_space_by_that_of_the_body() {
    judge("C0 by C", |s| {
        let (q, c0): (Matrix, Matrix) = (s.invertible(), s.positive());
        let c = q.transpose() * c0 * q;
        let back = q.inverse();
        let printed = back.transpose() * c * q.transpose();
        let right = back.transpose() * c * back;
        (size(&(printed - c0)), size(&(right - c0)))
    });
}

/// `tr(C0 (Q' - Q) I0 (Q' - Q)ᵀ)/2 - weight tr(K C)` with `C = Qᵀ C0 Q` at the start of the edge, in the scale of the thesis:
/// `weight` contains the square of the step size.
struct Ellipsoid {
    metric: Matrix,
    inertia: Matrix,
    stress: Matrix,
}

impl DiscreteAction<3, 1> for Ellipsoid {
    fn edge<T: Number>(&self, [q]: &[Square<T, 3>; 1], [next]: &[Square<T, 3>; 1]) -> Vec<T> {
        let [c0, i0, k] = [&self.metric, &self.inertia, &self.stress].map(Square::constant);
        let moved = *next - *q;
        vec![
            (c0 * moved * i0 * moved.transpose()).trace() * T::constant(0.5),
            -(k * q.transpose() * c0 * *q).trace(),
        ]
    }
}

/// The distances of the printed and the correct law from the variation of the action.
fn ellipsoid_laws(s: &mut Source, weight: f64) -> (f64, f64) {
    let stress: Matrix = s.symmetric();
    let body = Ellipsoid {
        metric: s.positive(),
        inertia: s.positive(),
        stress: stress.scaled(weight),
    };
    let nodes: [[Matrix; 1]; 3] = from_fn(|_| [s.invertible()]);
    let derivative = stationarity(&body, &nodes, &entries()).derivative;
    let wanted: Matrix = Square::from_entries(|i, j| derivative[3 * i + j]);
    let edges: [(Matrix, Matrix); 2] = from_fn(|k| {
        let [q, next] = [nodes[k][0], nodes[k + 1][0]];
        (q.inverse() * next, q.transpose() * body.metric * q)
    });
    // ∇_Γ ℓ and ∇_C ℓ on an edge.
    let gradients = edges.map(|(g, c)| {
        let moved = g - id();
        let of_c = (moved * body.inertia * moved.transpose()).scaled(0.5) - body.stress;
        (c * moved * body.inertia, of_c)
    });
    let (g, before) = edges[0];
    let here = edges[1].1;
    let [(old, old_c), (new, new_c)] = gradients;
    // (3.27) with M = ∇_Γ ℓ.
    let printed = ad_star(&g, &(old + (before * old_c).scaled(2.0))) - new;
    // M = ∇_Γ ℓ Γᵀ, and the force of the new edge.
    let [old, new] = [old * g.transpose(), new * edges[1].0.transpose()];
    let right = ad_star(&g, &old) + (here * new_c).scaled(2.0) - new;
    (size(&(printed - wanted)), size(&(right - wanted)))
}

#[test]
fn three_27_holds_for_free_motion_alone() {
    // Inverses of random matrices lose two digits.
    super::judge_within(1e-10, "(3.27) with a potential", |s| ellipsoid_laws(s, 1.0));
    for seed in 1..=super::DRAWS {
        let (printed, right) = ellipsoid_laws(&mut Source::seeded(seed), 0.0);
        assert!(printed < 1e-10 && right < 1e-10, "{printed:e} {right:e}");
    }
}
