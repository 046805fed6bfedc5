//! The phase difference between a motion and the closed form in radians, including whole turns. The samples must be close enough to
//! follow the turns.

use clebsch_benches::body::Generated;
use clebsch_comparisons::body::exact::Exact;
use clebsch_comparisons::body::{BodyMotion, Start};
use std::f64::consts::TAU;

/// The phase difference from the closed form.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lag {
    /// The difference of the body momentum along its closed curve: the angle about the axis that it circles, including whole turns.
    pub momentum: f64,
    /// The angle between the computed and the exact attitude, at most pi.
    pub attitude: f64,
}

/// The closed form that accompanies a motion.
pub struct Phase {
    exact: Exact,
    h: f64,
    /// The axes of the plane in which the angle is measured.
    plane: [usize; 2],
    last: f64,
}

impl Phase {
    /// The closed form from this start, in principal axes.
    pub fn start(start: &Start) -> Self {
        let [[x, ..], [_, y, _], [.., z]] = start.poinsot;
        let moments = [y + z, z + x, x + y];
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| moments[*a].total_cmp(&moments[*b]));
        let [small, middle, large] = order;
        // The momentum circles about the axis with the larger value.
        let about = |axis: usize| {
            let m = start.body_momentum[axis];
            m * m * (1.0 - moments[middle] / moments[axis]).abs()
        };
        let plane = match about(small) > about(large) {
            true => [middle, large],
            false => [small, middle],
        };
        Self {
            exact: Exact::start(start).expect("a body"),
            h: start.h,
            plane,
            last: 0.0,
        }
    }

    /// The phase difference at the current node of `body`, which must be within half a turn of the previous call.
    #[allow(clippy::cast_precision_loss)]
    pub fn follow(&mut self, body: &Generated) -> Lag {
        let time = body.state.node() as f64 * self.h;
        let (attitude, mu) = self.exact.at(time);
        let [i, j] = self.plane;
        let angle = |m: [f64; 3]| m[j].atan2(m[i]);
        let difference = angle(body.workspace.solver().body_momentum().0.into()) - angle(mu);
        self.last = difference - TAU * ((difference - self.last) / TAU).round();
        // The angle of the relative rotation, from the quaternion's vector part, which is accurate for small angles.
        let [w, x, y, z] = attitude.conjugate().times(&body.attitude()).0;
        let vector = (x * x + y * y + z * z).sqrt();
        Lag {
            momentum: self.last,
            attitude: 2.0 * vector.atan2(w.abs()),
        }
    }
}
