//! Removes rounding errors from a free motion: projects the momentum on its two quadrics, and aligns
//! the attitude with the spatial momentum. Takes the trajectory and its attitude; gives both
//! corrected, and by how much.

use super::{DEGENERATE, Free};
use crate::solvers::moser_veselov::cayley::{cross, dot};
use crate::{Real, Rotation};
use nalgebra::Vector3;

impl<T: Real> Free<T> {
    /// Removes the rounding errors of the momentum and the attitude.
    pub(super) fn project(&mut self, attitude: &mut Rotation<T>) {
        if !self.projects {
            return;
        }
        let (u, before) = (self.on_quadrics(self.u()), self.u());
        let (aligned, half) = self.aligned(*attitude, u);
        self.corrected = [
            self.relative_change(before, u),
            dot(half, half) * T::from_f64(4.0),
        ];
        for (axis, x) in self.axes.iter_mut().zip(u) {
            axis.body = x;
        }
        *attitude = aligned;
    }

    /// The square of a change of `u`, over the square of its length.
    #[inline(always)]
    pub(super) fn relative_change(&self, before: [T; 3], after: [T; 3]) -> T {
        let change = [0, 1, 2].map(|i| after[i] - before[i]);
        dot(change, change) * self.per_square
    }

    /// One Newton step for `|u|^2 = square`, `u . v = energy` with `v = adj(I) u`, along the two
    /// gradients `u` and `v`; along `u` alone if they are parallel.
    #[inline(always)]
    pub(super) fn on_quadrics(&self, u: [T; 3]) -> [T; 3] {
        let (one, half) = (T::one(), T::from_f64(0.5));
        let v = self.energy_gradient(u);
        let (uu, uv, vv) = (dot(u, u), dot(u, v), dot(v, v));
        let (f, g) = (half * (self.square - uu), half * (self.energy - uv));
        let gram = uu * vv - uv * uv;
        let both = (gram - T::from_f64(DEGENERATE) * (uu * vv)).where_positive(one);
        let gram = both * gram + (one - both);
        let y = both * ((uu * g - uv * f) / gram);
        let x = (f - uv * y) * self.per_square;
        [
            u[0] + (x * u[0] + y * v[0]),
            u[1] + (x * u[1] + y * v[1]),
            u[2] + (x * u[2] + y * v[2]),
        ]
    }

    /// Rotates the attitude from the left by the small angle that maps the body momentum, transformed to space, to
    /// the conserved spatial momentum. Returns it with half the angle as a vector. For a body at rest, only
    /// normalises the attitude.
    pub(super) fn aligned(&self, attitude: Rotation<T>, u: [T; 3]) -> (Rotation<T>, [T; 3]) {
        let attitude = attitude.renormalised();
        let [[a, b, c]] = attitude.rotate(&(self.frame * Vector3::from(u))).data.0;
        let half = T::from_f64(0.5) * self.per_square;
        let turn = cross([a, b, c], self.axes.map(|axis| axis.space)).map(|x| x * half);
        let [p, q, r] = turn;
        let aligned = Rotation::from_unit([T::one(), p, q, r])
            .compose_raw(&attitude)
            .renormalised();
        (aligned, turn)
    }
}
