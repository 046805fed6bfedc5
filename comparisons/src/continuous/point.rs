//! Points in space: Hamilton's equations of a planet about a fixed sun and of a charge in uniform fields. Six equations each, y =
//! (position, momentum).

use super::Motion;
use crate::handwritten::attitude::{Vector, add_scaled, cross, dot, scaled};
use crate::handwritten::charged_particle::Charge;

/// A planet of this mass about a sun with this gravitational parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planet {
    /// Mass.
    pub mass: f64,
    /// Gravitational parameter of the sun.
    pub sun: f64,
}

impl Motion<6> for Planet {
    #[inline(always)]
    fn rate(&self, y: &[f64; 6], out: &mut [f64; 6]) {
        let [a, b, c, d, e, f] = *y;
        let (x, p): (Vector, Vector) = ([a, b, c], [d, e, f]);
        let square = dot(&x, &x);
        let [u, v, w] = scaled(1.0 / self.mass, &p);
        let [r, s, t] = scaled(-self.mass * self.sun / (square * square.sqrt()), &x);
        *out = [u, v, w, r, s, t];
    }
}

impl Motion<6> for Charge {
    #[inline(always)]
    fn rate(&self, y: &[f64; 6], out: &mut [f64; 6]) {
        let [a, b, c, d, e, f] = *y;
        let (x, p): (Vector, Vector) = ([a, b, c], [d, e, f]);
        // p = m v + (q/2) B x X; half of the force q v x B comes from the vector potential.
        let kinetic = add_scaled(&p, -0.5 * self.charge, &cross(&self.magnetic, &x));
        let velocity = scaled(1.0 / self.mass, &kinetic);
        let [u, v, w] = velocity;
        let half = add_scaled(&self.electric, 0.5, &cross(&velocity, &self.magnetic));
        let [r, s, t] = scaled(self.charge, &half);
        *out = [u, v, w, r, s, t];
    }
}
