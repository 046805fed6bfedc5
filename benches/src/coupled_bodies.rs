//! A row of bodies whose kinetic energy joins neighbours, typed by hand: the method of the compiled line, Newton's from rest
//! with a block-tridiagonal tangent, with what a person would simplify. Takes data of the bodies; steps them.

use clebsch::nalgebra::{Matrix3, Vector3};

/// The row.
pub struct Row {
    /// Second moments of mass.
    pub moments: Matrix3<f64>,
    /// Place of the dragging mass.
    pub place: Vector3<f64>,
    /// Strength of the coupling.
    pub strength: f64,
    /// The step.
    pub h: f64,
    /// Attitudes, real part first.
    pub turns: Vec<[f64; 4]>,
    /// Momenta, space frame.
    pub momenta: Vec<Vector3<f64>>,
    matrices: Vec<Matrix3<f64>>,
    found: Vec<Vector3<f64>>,
    omegas: Vec<Matrix3<f64>>,
    changes: Vec<Vector3<f64>>,
    /// What a change of a velocity does to the change of its mass in space.
    moved: Vec<Matrix3<f64>>,
    onward: Vec<Matrix3<f64>>,
    right: Vec<Vector3<f64>>,
}

fn hat(v: &Vector3<f64>) -> Matrix3<f64> {
    v.cross_matrix()
}

fn axial(m: &Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(m.m32 - m.m23, m.m13 - m.m31, m.m21 - m.m12)
}

/// The rotation `q` turned further by the Cayley transform of `v`.
fn turned(q: [f64; 4], v: &Vector3<f64>) -> [f64; 4] {
    let ([w, x, y, z], [a, b, c]) = (q, [v[0] / 2.0, v[1] / 2.0, v[2] / 2.0]);
    let p = [
        w - x * a - y * b - z * c,
        w * a + x + y * c - z * b,
        w * b + y + z * a - x * c,
        w * c + z + x * b - y * a,
    ];
    let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
    p.map(|x| x / length)
}

fn matrix([w, x, y, z]: &[f64; 4]) -> Matrix3<f64> {
    Matrix3::new(
        1.0 - 2.0 * (y * y + z * z),
        2.0 * (x * y - w * z),
        2.0 * (x * z + w * y),
        2.0 * (x * y + w * z),
        1.0 - 2.0 * (x * x + z * z),
        2.0 * (y * z - w * x),
        2.0 * (x * z - w * y),
        2.0 * (y * z + w * x),
        1.0 - 2.0 * (x * x + y * y),
    )
}

impl Row {
    /// A row at rest in these attitudes with these momenta in space.
    pub fn new(
        (moments, place, strength): (Matrix3<f64>, Vector3<f64>, f64),
        h: f64,
        turns: Vec<[f64; 4]>,
        momenta: Vec<Vector3<f64>>,
    ) -> Self {
        let n = turns.len();
        Self {
            moments,
            place,
            strength,
            h,
            matrices: turns.iter().map(matrix).collect(),
            turns,
            momenta,
            found: vec![Vector3::zeros(); n],
            omegas: vec![Matrix3::identity(); n],
            changes: vec![Vector3::zeros(); n],
            moved: vec![Matrix3::zeros(); n],
            onward: vec![Matrix3::zeros(); n],
            right: vec![Vector3::zeros(); n],
        }
    }

    /// One step.
    pub fn step(&mut self) {
        let n = self.turns.len();
        self.found.fill(Vector3::zeros());
        for _ in 0..20 {
            let largest = self.correct(n);
            if largest < 1e-8 {
                break;
            }
        }
        for i in 0..n {
            let p = matrix(&turned(self.turns[i], &self.found[i]));
            self.changes[i] = (p - self.matrices[i]) * self.place;
        }
        for i in 0..n {
            let around = self.around(i);
            self.momenta[i] -= self.changes[i].cross(&around) * (self.strength / self.h);
            self.turns[i] = turned(self.turns[i], &self.found[i]);
        }
        for i in 0..n {
            self.matrices[i] = matrix(&self.turns[i]);
        }
    }

    /// The changes of the masses of both neighbours.
    fn around(&self, i: usize) -> Vector3<f64> {
        let mut around = Vector3::zeros();
        if i > 0 {
            around += self.changes[i - 1];
        }
        if i + 1 < self.changes.len() {
            around += self.changes[i + 1];
        }
        around
    }

    /// One correction of all velocities: the largest, by the largest velocity.
    fn correct(&mut self, n: usize) -> f64 {
        let (h, drag) = (self.h, self.strength / self.h);
        let arm = hat(&self.place);
        for i in 0..n {
            let v = self.found[i];
            let factor = 1.0 / (1.0 + v.dot(&v) / 4.0);
            let half = hat(&v) / 2.0;
            let change = (hat(&v) + half * hat(&v)) * factor;
            let rate = (Matrix3::identity() - half) * factor;
            self.omegas[i] = Matrix3::identity() + change;
            self.changes[i] = self.matrices[i] * (change * self.place);
            self.moved[i] = -(self.matrices[i] * (self.omegas[i] * (arm * rate)));
            // The derivative of the body's own momentum stands here until it is eliminated.
            let s = self.omegas[i] * self.moments;
            let own = Matrix3::identity() * s.trace() - s;
            self.onward[i] = own * self.omegas[i] * rate / h;
        }
        for i in 0..n {
            let around = self.around(i);
            let s = self.omegas[i] * self.moments;
            let made = axial(&s) / h - self.place.cross(&self.matrices[i].tr_mul(&around)) * drag;
            self.right[i] = self.matrices[i].tr_mul(&self.momenta[i]) - made;
        }
        // By a change of the velocity of body j the momentum of its neighbour i changes so.
        let between =
            |row: &Self, i: usize, j: usize| -(arm * row.matrices[i].tr_mul(&row.moved[j])) * drag;
        for i in 0..n {
            let mut left = self.onward[i];
            if i > 0 {
                let before = between(self, i, i - 1);
                left -= before * self.onward[i - 1];
                let taken = before * self.right[i - 1];
                self.right[i] -= taken;
            }
            let inverse = left.try_inverse().expect("a pivot");
            self.right[i] = inverse * self.right[i];
            if i + 1 < n {
                self.onward[i] = inverse * between(self, i, i + 1);
            }
        }
        for i in (0..n.saturating_sub(1)).rev() {
            let taken = self.onward[i] * self.right[i + 1];
            self.right[i] -= taken;
        }
        let (mut largest, mut size) = (0.0_f64, 0.0_f64);
        for i in 0..n {
            self.found[i] += self.right[i];
            largest = largest.max(self.right[i].amax());
            size = size.max(self.found[i].amax());
        }
        largest / size
    }
}
