//! How far an invariant has moved, relative to its natural scale.
//! Takes its value at every step; gives the worst and the last deviation.

/// The drift of one component of one invariant since the run began.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// `max |I_k - I_0| / scale` over every step; NaN once a value was NaN.
    pub worst: f64,
    /// `(I_k - I_0) / scale` at the last step, with its sign.
    pub last: f64,
    /// The natural scale of the component, as the trajectory gives it at node 0.
    pub scale: f64,
}

impl Drift {
    /// No drift yet.
    pub(super) fn at_rest(scale: f64) -> Self {
        Self {
            worst: 0.0,
            last: 0.0,
            scale,
        }
    }

    /// Takes in the deviation `I_k - I_0`.
    #[inline]
    pub(super) fn record(&mut self, deviation: f64) {
        self.last = deviation / self.scale;
        // The comparison is written so that NaN enters and stays.
        let within = self.last.abs() <= self.worst || self.worst.is_nan();
        if !within {
            self.worst = self.last.abs();
        }
    }
}
