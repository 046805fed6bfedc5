//! Vectors and unit quaternions of the hand-written steppers, as plain arrays of three and four numbers. A quaternion (w, x, y, z)
//! represents the rotation body -> space; body rotations compose on the right. The order of operations gives short dependency
//! chains, because latency limits the speed of a step.

/// Components along three axes.
pub type Vector = [f64; 3];

/// Row-major 3 x 3 matrix.
pub type Matrix = [[f64; 3]; 3];

/// Dot product.
#[inline(always)]
pub fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Cross product a x b.
#[inline(always)]
pub fn cross(a: &Vector, b: &Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// a + s b.
#[inline(always)]
pub fn add_scaled(a: &Vector, s: f64, b: &Vector) -> Vector {
    [a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]]
}

/// Quaternion (w, x, y, z); a rotation if its norm is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion(pub [f64; 4]);

impl Quaternion {
    /// The identity rotation.
    pub const IDENTITY: Quaternion = Quaternion([1.0, 0.0, 0.0, 0.0]);

    /// Product: first `self`, then the rotation `other` in the frame rotated by `self`.
    #[inline(always)]
    pub fn times(&self, other: &Quaternion) -> Quaternion {
        let [a, b, c, d] = self.0;
        let [w, x, y, z] = other.0;
        Quaternion([
            (a * w - b * x) - (c * y + d * z),
            (a * x + b * w) + (c * z - d * y),
            (a * y + c * w) + (d * x - b * z),
            (a * z + d * w) + (b * y - c * x),
        ])
    }

    /// The inverse rotation.
    #[inline(always)]
    pub fn conjugate(&self) -> Quaternion {
        let [w, x, y, z] = self.0;
        Quaternion([w, -x, -y, -z])
    }

    /// Square of the norm.
    #[inline(always)]
    pub fn norm_squared(&self) -> f64 {
        let [w, x, y, z] = self.0;
        (w * w + x * x) + (y * y + z * z)
    }

    /// Every component multiplied by `s`.
    #[inline(always)]
    pub fn scaled(&self, s: f64) -> Quaternion {
        Quaternion(self.0.map(|c| c * s))
    }

    /// The same direction with norm one.
    #[inline(always)]
    pub fn normalised(&self) -> Quaternion {
        self.scaled(1.0 / self.norm_squared().sqrt())
    }

    /// E such that Id + (2/|q|^2) E is the rotation matrix of q / |q|; a rotation can start before |q| is known.
    #[inline(always)]
    pub fn deviation(&self) -> Matrix {
        let [w, x, y, z] = self.0;
        let (xx, yy, zz) = (x * x, y * y, z * z);
        let (xy, xz, yz) = (x * y, x * z, y * z);
        let (wx, wy, wz) = (w * x, w * y, w * z);
        [
            [-(yy + zz), xy - wz, xz + wy],
            [xy + wz, -(xx + zz), yz - wx],
            [xz - wy, yz + wx, -(xx + yy)],
        ]
    }

    /// The rotation matrix of a unit quaternion.
    #[inline(always)]
    pub fn matrix(&self) -> Matrix {
        let e = self.deviation();
        [
            [1.0 + 2.0 * e[0][0], 2.0 * e[0][1], 2.0 * e[0][2]],
            [2.0 * e[1][0], 1.0 + 2.0 * e[1][1], 2.0 * e[1][2]],
            [2.0 * e[2][0], 2.0 * e[2][1], 1.0 + 2.0 * e[2][2]],
        ]
    }

    /// A unit quaternion of an orthogonal matrix with determinant one (sign of the quaternion unspecified).
    pub fn from_matrix(m: &Matrix) -> Quaternion {
        // The largest of 4w^2, 4x^2, 4y^2, 4z^2 is at least one, so that no division is by a small number.
        let trace = m[0][0] + m[1][1] + m[2][2];
        let squares = [
            1.0 + trace,
            1.0 + 2.0 * m[0][0] - trace,
            1.0 + 2.0 * m[1][1] - trace,
            1.0 + 2.0 * m[2][2] - trace,
        ];
        let skew = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]];
        let sums = [m[2][1] + m[1][2], m[0][2] + m[2][0], m[1][0] + m[0][1]];
        let largest = squares.iter().copied().fold(f64::MIN, f64::max);
        let column = if squares[0] == largest {
            [squares[0], skew[0], skew[1], skew[2]]
        } else if squares[1] == largest {
            [skew[0], squares[1], sums[2], sums[1]]
        } else if squares[2] == largest {
            [skew[1], sums[2], squares[2], sums[0]]
        } else {
            [skew[2], sums[1], sums[0], squares[3]]
        };
        Quaternion(column).normalised()
    }
}

/// M v.
#[inline(always)]
pub fn apply(m: &Matrix, v: &Vector) -> Vector {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v)]
}

/// M^T v.
#[inline(always)]
pub fn apply_transposed(m: &Matrix, v: &Vector) -> Vector {
    [
        m[0][0] * v[0] + m[1][0] * v[1] + m[2][0] * v[2],
        m[0][1] * v[0] + m[1][1] * v[1] + m[2][1] * v[2],
        m[0][2] * v[0] + m[1][2] * v[1] + m[2][2] * v[2],
    ]
}

// Written out: the compiler unrolls loops over rows and columns too late, and then keeps matrices in memory.

/// s v.
#[inline(always)]
pub fn scaled(s: f64, v: &Vector) -> Vector {
    [s * v[0], s * v[1], s * v[2]]
}

/// Row vector times matrix.
#[inline(always)]
fn row_times(r: &Vector, m: &Matrix) -> Vector {
    [
        r[0] * m[0][0] + r[1] * m[1][0] + r[2] * m[2][0],
        r[0] * m[0][1] + r[1] * m[1][1] + r[2] * m[2][1],
        r[0] * m[0][2] + r[1] * m[1][2] + r[2] * m[2][2],
    ]
}

/// A B.
#[inline(always)]
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    [
        row_times(&a[0], b),
        row_times(&a[1], b),
        row_times(&a[2], b),
    ]
}

/// A^T B.
#[inline(always)]
pub fn transposed_product(a: &Matrix, b: &Matrix) -> Matrix {
    product(&transposed(a), b)
}

/// A^T.
#[inline(always)]
pub fn transposed(a: &Matrix) -> Matrix {
    [
        [a[0][0], a[1][0], a[2][0]],
        [a[0][1], a[1][1], a[2][1]],
        [a[0][2], a[1][2], a[2][2]],
    ]
}

/// A + s B.
#[inline(always)]
pub fn sum(a: &Matrix, s: f64, b: &Matrix) -> Matrix {
    [
        add_scaled(&a[0], s, &b[0]),
        add_scaled(&a[1], s, &b[1]),
        add_scaled(&a[2], s, &b[2]),
    ]
}

/// The matrix of v -> d x v.
#[inline(always)]
pub fn hat(d: &Vector) -> Matrix {
    [[0.0, -d[2], d[1]], [d[2], 0.0, -d[0]], [-d[1], d[0], 0.0]]
}

/// hat(d) M.
#[inline(always)]
pub fn crossed(d: &Vector, m: &Matrix) -> Matrix {
    [
        add_scaled(&scaled(d[1], &m[2]), -d[2], &m[1]),
        add_scaled(&scaled(d[2], &m[0]), -d[0], &m[2]),
        add_scaled(&scaled(d[0], &m[1]), -d[1], &m[0]),
    ]
}

/// M + a b^T.
#[inline(always)]
pub fn add_outer(m: &Matrix, a: &Vector, b: &Vector) -> Matrix {
    [
        add_scaled(&m[0], a[0], b),
        add_scaled(&m[1], a[1], b),
        add_scaled(&m[2], a[2], b),
    ]
}

/// s M.
#[inline(always)]
pub fn scaled_matrix(s: f64, m: &Matrix) -> Matrix {
    [scaled(s, &m[0]), scaled(s, &m[1]), scaled(s, &m[2])]
}

/// Inverse by cofactors; not finite if the matrix is singular.
#[inline(always)]
pub fn inverse(m: &Matrix) -> Matrix {
    let columns = [
        cross(&m[1], &m[2]),
        cross(&m[2], &m[0]),
        cross(&m[0], &m[1]),
    ];
    scaled_matrix(1.0 / dot(&m[0], &columns[0]), &transposed(&columns))
}

/// Largest absolute component; NaN if a component is NaN, which `max` alone would ignore.
#[inline(always)]
pub fn largest(v: &Vector) -> f64 {
    v[0].abs().max(v[1].abs()).max(v[2].abs()) + 0.0 * (v[0] + v[1] + v[2])
}
