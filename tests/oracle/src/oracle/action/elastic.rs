//! Hand-written unreduced actions of affinely deforming ellipsoids on GL(n), with random parameters, as functions of Q at both
//! ends. Convective: stored energy of the stretch `C = Qᵀ C0 Q`; spatial: the free ellipsoid.

use super::super::dual::Number;
use super::super::points::{NamedValue, Source};
use super::super::square::Square;
use super::bodies::{Stated, attitudes};
use super::{DiscreteAction, NodeRule, Side};

/// `tr(C0 (Q_{k+1} - Q_k) I0 (Q_{k+1} - Q_k)ᵀ)/(2h)`: the kinetic energy, in space.
fn kinetic<T: Number, const N: usize>(
    metric: &Square<f64, N>,
    second_moment: &Square<f64, N>,
    tail: &Square<T, N>,
    head: &Square<T, N>,
    h: f64,
) -> T {
    let change = *head - *tail;
    let product =
        Square::constant(metric) * change * Square::constant(second_moment) * change.transpose();
    product.trace() / T::constant(2.0 * h)
}

/// All matrices `E_ij` with a single entry, row-major: the basis of the Lie algebra of GL(n).
#[must_use]
pub fn entries<const N: usize>() -> Vec<Square<f64, N>> {
    (0..N * N)
        .map(|entry| Square::from_entries(|i, j| if N * i + j == entry { 1.0 } else { 0.0 }))
        .collect()
}

/// The hyperelastic ellipsoid in the convective representation.
#[derive(Clone, Debug)]
pub struct EllipsoidConvective<const N: usize> {
    /// The step size.
    pub h: f64,
    /// The metric C0 of space.
    pub metric: Square<f64, N>,
    /// The second-moment matrix I0 of the reference body.
    pub second_moment: Square<f64, N>,
    /// The constants a, b, c, d of the stored energy.
    pub energy: [f64; 4],
}

impl<const N: usize> DiscreteAction<N, 1> for EllipsoidConvective<N> {
    fn edge<T: Number>(&self, tail: &[Square<T, N>; 1], head: &[Square<T, N>; 1]) -> Vec<T> {
        let stored = |placement: &Square<T, N>| {
            let stretch = placement.transpose() * Square::constant(&self.metric) * *placement;
            let [a, b, c, d] = self.energy.map(T::constant);
            let volume = stretch.determinant();
            let terms = [
                a * stretch.trace(),
                b * stretch.second_invariant(),
                c * volume,
                -(d * T::constant(0.5)) * volume.ln(),
            ];
            terms.map(|term| -T::constant(self.h) * term)
        };
        let (at_tail, at_head) = (stored(&tail[0]), stored(&head[0]));
        let mut summands = vec![kinetic(
            &self.metric,
            &self.second_moment,
            &tail[0],
            &head[0],
            self.h,
        )];
        for (tail, head) in at_tail.into_iter().zip(at_head) {
            summands.push(NodeRule::Symmetric.split(tail, head));
        }
        summands
    }
}

impl<const N: usize> Stated<N, 1> for EllipsoidConvective<N> {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            metric: source.positive(),
            second_moment: source.positive(),
            energy: source.vector(),
        }
    }
    fn text() -> String {
        format!(
            "model EllipsoidConvective {{
            param C0, I0: Sym<{N}>;  param a, b, c, d: Real;
            group Q: GL<{N}> velocity G;   advected C: Sym<{N}> = Q^T*C0*Q;
            constraint next(Q) = Q*G;    constraint next(C) = G^T*C*G;
            let W = a*I1(C) + b*I2(C) + c*det(C) - (d/2)*log(det(C));
            lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W;
        }}"
        )
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, N>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = attitudes("Q", nodes);
        given.push(NamedValue::square("C0", 0, &self.metric));
        given.push(NamedValue::square("I0", 0, &self.second_moment));
        for (name, value) in ["a", "b", "c", "d"].iter().zip(self.energy) {
            given.push(NamedValue::scalar(name, value));
        }
        given
    }
    fn node(source: &mut Source) -> [Square<f64, N>; 1] {
        [source.invertible()]
    }
}

/// The free ellipsoid in the spatial representation.
#[derive(Clone, Debug)]
pub struct EllipsoidSpatial {
    /// The step size.
    pub h: f64,
    /// The metric C0 of space.
    pub metric: Square<f64, 3>,
    /// The second-moment matrix I0 of the reference body.
    pub second_moment: Square<f64, 3>,
}

impl DiscreteAction<3, 1> for EllipsoidSpatial {
    fn side(&self) -> Side {
        Side::Space
    }
    fn edge<T: Number>(&self, tail: &[Square<T, 3>; 1], head: &[Square<T, 3>; 1]) -> Vec<T> {
        vec![kinetic(
            &self.metric,
            &self.second_moment,
            &tail[0],
            &head[0],
            self.h,
        )]
    }
}

impl Stated<3, 1> for EllipsoidSpatial {
    fn random(source: &mut Source) -> Self {
        Self {
            h: source.between(0.1, 1.0),
            metric: source.positive(),
            second_moment: source.positive(),
        }
    }
    fn text() -> String {
        "model EllipsoidSpatial {
            param C0, I0: Sym<3>;
            group Q: GL<3> velocity γ; advected S: Sym<3> = Q*I0*Q^T;
            constraint next(Q) = γ*Q; constraint next(S) = γ*S*γ^T;
            lagrangian = tr(C0*(γ - Id)*S*(γ - Id)^T)/(2*h);
        }"
        .to_owned()
    }
    fn step(&self) -> f64 {
        self.h
    }
    fn given(&self, nodes: &[[Square<f64, 3>; 1]; 3]) -> Vec<NamedValue> {
        let mut given = attitudes("Q", nodes);
        given.push(NamedValue::square("C0", 0, &self.metric));
        given.push(NamedValue::square("I0", 0, &self.second_moment));
        given
    }
    fn node(source: &mut Source) -> [Square<f64, 3>; 1] {
        [source.invertible()]
    }
}
