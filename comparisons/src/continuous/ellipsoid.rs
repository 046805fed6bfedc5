//! The placement of an elastic ellipsoid: C0 Q'' I0 = -grad V(Q), as 2 N^2 equations, y = (placement, velocity), both row-major.

use super::Motion;
use super::any_dimension::{matrices, state};
use crate::handwritten::ellipsoid::Prepared;

impl<const N: usize, const SIZE: usize> Motion<SIZE> for Prepared<N> {
    #[inline(always)]
    fn rate(&self, y: &[f64; SIZE], out: &mut [f64; SIZE]) {
        let [q, v] = matrices::<N, SIZE>(y);
        *out = state::<N, SIZE>(&[v, self.acceleration(&q)]);
    }
}
