//! Shared by the tests: a small deterministic random source, bodies, and the residual of the Moser-Veselov equation without the
//! formulas of the solver.

use clebsch::linalg::{axial_of_difference, hat};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{DoubleDouble, Poinsot, Real, Rotation};

/// SplitMix64 (Steele, Lea, Flood 2014).
pub struct Random(pub u64);

impl Random {
    pub fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    /// Uniform in (-1, 1).
    pub fn symmetric(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Uniform in (0, 1).
    pub fn unit(&mut self) -> f64 {
        0.5 * (self.symmetric() + 1.0)
    }

    pub fn vector(&mut self) -> Vector3<f64> {
        Vector3::new(self.symmetric(), self.symmetric(), self.symmetric())
    }

    pub fn rotation(&mut self) -> Rotation {
        Rotation::exp(&(self.vector() * 3.0))
    }

    /// A random Poinsot matrix: diagonal in even cases, flat (singular) in every eighth.
    pub fn poinsot(&mut self, case: u64) -> Matrix3<f64> {
        let mut j = Vector3::new(self.unit(), self.unit(), self.unit()) * 2.0;
        if case.is_multiple_of(8) {
            j[(case / 8 % 3) as usize] = 0.0;
        }
        if case % 2 == 1 {
            let turn = self.rotation().matrix();
            turn * Matrix3::from_diagonal(&j) * turn.transpose()
        } else {
            Matrix3::from_diagonal(&j)
        }
    }
}

/// The body with these principal moments of inertia, with axes rotated by the rotation vector.
pub fn body(moments: [f64; 3], turned: Vector3<f64>) -> Poinsot {
    let half_trace = moments.iter().sum::<f64>() / 2.0;
    let j = Matrix3::from_diagonal(&Vector3::from(moments.map(|i| half_trace - i)));
    if turned == Vector3::zeros() {
        return Poinsot::new(j).expect("valid moments");
    }
    let turn = Rotation::exp(&turned).matrix();
    Poinsot::new(turn * j * turn.transpose()).expect("valid moments")
}

/// Largest component of `vee(Omega J - J Omega^T) - h N`.
pub fn residual<T: Real>(j: &Matrix3<T>, omega: &Rotation<T>, h_n: &Vector3<T>) -> f64 {
    let a = omega.matrix() * *j;
    largest(&(axial_of_difference(&a) - *h_n))
}

/// Largest absolute entry, including derivatives and lanes.
pub fn largest<T: Real>(v: &Vector3<T>) -> f64 {
    v.iter()
        .map(|x| x.magnitude())
        .fold(0.0, clebsch::scalar::larger)
}

pub fn lift<T: Real>(v: &Vector3<f64>) -> Vector3<T> {
    v.map(T::from_f64)
}

pub fn lift_matrix<T: Real>(m: &Matrix3<f64>) -> Matrix3<T> {
    m.map(T::from_f64)
}

/// An independent solver for the tests: Newton's method on the quaternion form `q0 I Q + Q x I Q = h N / 2`,
/// `q0 = sqrt(1 - |Q|^2)`.
pub fn quaternion_newton(j: &Matrix3<f64>, h_n: &Vector3<f64>) -> Vector3<f64> {
    let inertia = Matrix3::from_diagonal_element(j.trace()) - j;
    let mut q = inertia.lu().solve(&(h_n * 0.5)).expect("regular inertia");
    for _ in 0..60 {
        let q0 = (1.0 - q.norm_squared()).sqrt();
        let b = inertia * q;
        let f = b * q0 + q.cross(&b) - h_n * 0.5;
        let jacobian = inertia * q0 - b * q.transpose() / q0 - hat(&b) + hat(&q) * inertia;
        q -= jacobian.lu().solve(&f).expect("regular tangent");
    }
    q
}

pub fn dd(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}
