//! Scales of equations that their own terms do not tell: an equation is solved when its residual is rounding
//! beside its scale, and no smaller than what rounding of the velocities leaves of it.
//! Takes the tangent factored last, as absolute values, and scales; raises them.

/// What the equations do with the velocities.
pub(super) struct Tangent<'a> {
    /// The absolute value of the entry of an equation and a coordinate, zero where it is not known.
    pub entry: &'a dyn Fn(usize, usize) -> f64,
    /// The part that a coordinate belongs to.
    pub part_of: &'a dyn Fn(usize) -> usize,
    /// The lengths of the parts of the velocity.
    pub lengths: &'a [f64],
}

impl Tangent<'_> {
    /// Raises what is rounding beside others.
    pub fn raise(&self, scales: &mut [f64]) {
        self.momenta(scales);
        self.constraints(scales);
    }

    /// A momentum and the root of its own entry of the tangent have one unit for all equations, the root of an action. Below
    /// `EPSILON` of the largest so measured, what solving for all velocities together leaves of an equation is larger than what
    /// would be asked of it. Entries that are zero, or not known, measure nothing.
    fn momenta(&self, scales: &mut [f64]) {
        let root = |i: usize| (self.entry)(i, i).sqrt();
        let known = |i: &usize| root(*i) > 0.0 && root(*i).is_finite();
        let most = (0..scales.len())
            .filter(known)
            .fold(0.0, |most: f64, i| most.max(scales[i] / root(i)));
        for i in (0..scales.len()).filter(known) {
            scales[i] = scales[i].max(f64::EPSILON * root(i) * most);
        }
    }

    /// An equation that its own unknown does not enter, as a held constraint, is no better than the velocities: those of a part
    /// are rounded together, to the length of the part and to what the rounding of its momenta leaves of them. Its own terms
    /// say less: where a rotation keeps an axis of the basis, entries that vanish are terms of nothing but rounding.
    fn constraints(&self, scales: &mut [f64]) {
        let size = scales.len();
        let held: Vec<usize> = (0..size).filter(|i| (self.entry)(*i, *i) == 0.0).collect();
        if held.is_empty() {
            return;
        }
        let mut velocities = self.lengths.to_vec();
        for (j, scale) in scales.iter().enumerate() {
            let moved = scale / (self.entry)(j, j);
            if let Some(velocity) = velocities.get_mut((self.part_of)(j)) {
                // Also refuses what is not known.
                if moved > *velocity && moved.is_finite() || velocity.is_nan() {
                    *velocity = moved;
                }
            }
        }
        for i in held {
            let least = (0..size).fold(0.0, |most: f64, j| {
                let velocity = velocities.get((self.part_of)(j)).copied().unwrap_or(0.0);
                let moved = (self.entry)(i, j) * velocity;
                if moved > most && moved.is_finite() {
                    moved
                } else {
                    most
                }
            });
            scales[i] = scales[i].max(least);
        }
    }
}
