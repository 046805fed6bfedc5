//! The pseudo-rigid body Q = Rᵀ D S in the discretisation of the thesis (3.55), with the signs of (3.62) corrected, and the
//! variables of the bipolar form for any motion of a placement. With J = D (2 - wᵀ) D and K = D (2 - Ωᵀ) D, a step solves
//! `2 skew(Ωᵀ J) = -h hat(m)`, `2 skew(wᵀ K) = -h hat(n)` by Newton's method with hand-written derivatives. The stretches then
//! follow explicitly. Takes rotations, stretches and their momenta; gives these after one step.

use super::Unsolvable;
use super::attitude::{
    Matrix, Vector, apply, hat, product, scaled, scaled_matrix, sum, transposed, transposed_product,
};

/// The constants a, b, c, d of the stored energy a I1(D²) + b I2(D²) + c det(D)² - d log det(D).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PseudoRigid {
    /// a, b, c, d.
    pub energy: [f64; 4],
}

/// The state: rotations, stretches, and their momenta, which are spatial for the rotations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bipolar {
    /// R.
    pub r: Matrix,
    /// S.
    pub s: Matrix,
    /// The diagonal of D.
    pub d: Vector,
    /// m, n and the momentum of the stretches.
    pub momenta: [Vector; 3],
}

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The vector v of `2 skew(A) = A - Aᵀ = hat(v)`.
fn twice_skew(a: &Matrix) -> Vector {
    [a[2][1] - a[1][2], a[0][2] - a[2][0], a[1][0] - a[0][1]]
}

fn diagonal(d: &Vector) -> Matrix {
    [[d[0], 0.0, 0.0], [0.0, d[1], 0.0], [0.0, 0.0, d[2]]]
}

/// The rotation of a rotation vector, by Rodrigues' formula.
fn turn(v: &Vector) -> Matrix {
    let angle = v.iter().map(|x| x * x).sum::<f64>().sqrt();
    let (a, b) = match angle < 1e-4 {
        true => (1.0 - angle * angle / 6.0, 0.5 - angle * angle / 24.0),
        false => (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle)),
    };
    let own = hat(v);
    sum(&sum(&IDENTITY, a, &own), b, &product(&own, &own))
}

/// Solves six linear equations by elimination with pivoting; not finite if the matrix is singular.
fn solved(mut a: [[f64; 7]; 6]) -> [f64; 6] {
    for k in 0..6 {
        let pivot = (k..6).fold(k, |p, r| if a[r][k].abs() > a[p][k].abs() { r } else { p });
        a.swap(k, pivot);
        let head = a[k];
        for (r, row) in a.iter_mut().enumerate() {
            let factor = row[k] / head[k];
            if r != k {
                for (x, y) in row.iter_mut().zip(head) {
                    *x -= factor * y;
                }
            }
        }
    }
    std::array::from_fn(|k| a[k][6] / a[k][k])
}

impl PseudoRigid {
    /// The derivative of the stored energy with respect to the stretches.
    fn slope(&self, d: &Vector) -> Vector {
        let [a, b, c, e] = self.energy;
        let square = d.map(|x| x * x);
        let first: f64 = square.iter().sum();
        let volume: f64 = square.iter().product();
        std::array::from_fn(|i| {
            2.0 * d[i] * (a + b * (first - square[i])) + (2.0 * c * volume - e) / d[i]
        })
    }

    /// A step of h.
    ///
    /// # Errors
    /// [`Unsolvable`] if Newton's method from zero velocity does not converge.
    pub fn step(&self, at: &Bipolar, h: f64) -> Result<Bipolar, Unsolvable> {
        let d = diagonal(&at.d);
        let [m, n, p] = &at.momenta;
        let (mut o, mut w) = (IDENTITY, IDENTITY);
        let middle = |w: &Matrix| {
            let two = sum(&scaled_matrix(2.0, &IDENTITY), -1.0, &transposed(w));
            product(&product(&d, &two), &d)
        };
        let mut last = f64::INFINITY;
        for _ in 0..40 {
            let (j, k) = (middle(&w), middle(&o));
            let first = twice_skew(&transposed_product(&o, &j));
            let second = twice_skew(&transposed_product(&w, &k));
            let mut system = [[0.0; 7]; 6];
            for c in 0..3 {
                // Ω to exp(η) Ω takes Ωᵀ to Ωᵀ (1 - hat(η)), and K by D Ωᵀ hat(η) D; w likewise.
                let unit = hat(&std::array::from_fn(|i| if i == c { 1.0 } else { 0.0 }));
                let own = |a: &Matrix, b: &Matrix| {
                    let turned = transposed_product(a, &product(&unit, b));
                    scaled(-1.0, &twice_skew(&turned))
                };
                let other = |a: &Matrix, b: &Matrix| {
                    let moved = product(&product(&d, &transposed_product(b, &unit)), &d);
                    twice_skew(&transposed_product(a, &moved))
                };
                let columns = [
                    [own(&o, &j), other(&w, &o)].concat(),
                    [other(&o, &w), own(&w, &k)].concat(),
                ];
                for (block, column) in columns.iter().enumerate() {
                    for (row, x) in system.iter_mut().zip(column) {
                        row[3 * block + c] = *x;
                    }
                }
            }
            for i in 0..3 {
                system[i][6] = -h * m[i] - first[i];
                system[3 + i][6] = -h * n[i] - second[i];
            }
            let x = solved(system);
            o = product(&turn(&[x[0], x[1], x[2]]), &o);
            w = product(&turn(&[x[3], x[4], x[5]]), &w);
            let size = x.iter().map(|x| x * x).sum::<f64>().sqrt();
            if !size.is_finite() {
                return Err(Unsolvable);
            }
            // Convergence is quadratic until rounding.
            if size < 1e-12 && size >= 0.5 * last || size == 0.0 {
                break;
            }
            last = size;
        }
        if last > 1e-10 {
            return Err(Unsolvable);
        }
        let slope = self.slope(&at.d);
        let moved: Vector = std::array::from_fn(|i| {
            let both = |j: usize| at.d[j] * (o[i][j] * w[j][i] + o[j][i] * w[i][j]);
            let turned = 4.0 * at.d[i] * (2.0 - o[i][i] - w[i][i]) - 2.0 * at.d[i];
            h * p[i] + turned + both(0) + both(1) + both(2) - 0.5 * h * h * slope[i]
        });
        let next: Vector = std::array::from_fn(|i| at.d[i] + moved[i]);
        if !next.iter().all(|x| *x > 0.0) {
            return Err(Unsolvable);
        }
        let slope = self.slope(&next);
        Ok(Bipolar {
            r: product(&o, &at.r),
            s: product(&w, &at.s),
            d: next,
            momenta: [
                apply(&o, m),
                apply(&w, n),
                std::array::from_fn(|i| moved[i] / h - 0.5 * h * slope[i]),
            ],
        })
    }
}

impl Bipolar {
    /// The placement Rᵀ D S and its momentum P, defined by `P·δQ = m·ξ + n·ζ + p·δD` for rotations ξ of R and ζ of S. With
    /// `Y = R P Sᵀ`, the momenta are `2 vee(D Yᵀ)`, `-2 vee(Yᵀ D)` and the diagonal of Y. The stretches must be distinct.
    pub fn placed(&self) -> [Matrix; 2] {
        let d = &self.d;
        let [m, n, p] = &self.momenta;
        let mut y = diagonal(p);
        for l in 0..3 {
            let (i, j) = ((l + 1) % 3, (l + 2) % 3);
            let apart = d[j] * d[j] - d[i] * d[i];
            y[i][j] = (d[j] * m[l] + d[i] * n[l]) / apart;
            y[j][i] = (d[i] * m[l] + d[j] * n[l]) / apart;
        }
        let seen = |x: &Matrix| transposed_product(&self.r, &product(x, &self.s));
        [seen(&diagonal(d)), seen(&y)]
    }
}
