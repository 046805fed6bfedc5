//! How far a motion is ahead of the closed form, in radians; whole turns are counted.
//! Takes a start and the motion at nodes near enough to each other; gives the angles.

use clebsch_benches::body::Generated;
use clebsch_comparisons::body::exact::Exact;
use clebsch_comparisons::body::{BodyMotion, Start};
use std::f64::consts::TAU;

/// Ahead of the closed form.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lag {
    /// The body momentum on its closed curve: the angle about the axis that it goes round, whole turns included.
    pub momentum: f64,
    /// The rotation from the attitude to the true one: at most pi.
    pub attitude: f64,
}

/// The closed form beside a motion.
pub struct Phase {
    exact: Exact,
    h: f64,
    /// The axes across which the angle is taken.
    plane: [usize; 2],
    last: f64,
}

impl Phase {
    /// The closed form from this start, whose axes are principal ones.
    pub fn start(start: &Start) -> Self {
        let [[x, ..], [_, y, _], [.., z]] = start.poinsot;
        let moments = [y + z, z + x, x + y];
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| moments[*a].total_cmp(&moments[*b]));
        let [small, middle, large] = order;
        // The momentum goes round the axis for which this is larger.
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

    /// The lag at the node where `body` is, less than half a turn from that of the last call.
    #[allow(clippy::cast_precision_loss)]
    pub fn follow(&mut self, body: &Generated) -> Lag {
        let time = body.state.node() as f64 * self.h;
        let (attitude, mu) = self.exact.at(time);
        let [i, j] = self.plane;
        let angle = |m: [f64; 3]| m[j].atan2(m[i]);
        let difference = angle(body.workspace.solver().body_momentum().0.into()) - angle(mu);
        self.last = difference - TAU * ((difference - self.last) / TAU).round();
        // Of the relative rotation, by the quaternion's vector, which does not cancel for small angles.
        let [w, x, y, z] = attitude.conjugate().times(&body.attitude()).0;
        let vector = (x * x + y * y + z * z).sqrt();
        Lag {
            momentum: self.last,
            attitude: 2.0 * vector.atan2(w.abs()),
        }
    }
}
