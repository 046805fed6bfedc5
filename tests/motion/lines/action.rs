//! The action of two edges and its derivatives by dual numbers. Sums over sites are written by hand and share nothing with the
//! engine.

use super::models::Line;
use clebsch::nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use clebsch::{Dual, Real};

/// A number with one derivative.
pub type D = Dual<1>;

/// Field values and attitudes at one node.
#[derive(Clone, Debug)]
pub struct Configuration<T> {
    /// Fields, component by component.
    pub x: Vec<T>,
    /// Rotations, body to space.
    pub r: Vec<Matrix3<T>>,
    /// Unit quaternions, real part first.
    pub q: Vec<[T; 4]>,
}

/// Hamilton's product.
pub fn hamilton<T: Real>(a: [T; 4], b: [T; 4]) -> [T; 4] {
    [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
        a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
    ]
}

/// The conjugate.
pub fn conjugate<T: Real>([w, x, y, z]: [T; 4]) -> [T; 4] {
    [w, -x, -y, -z]
}

/// The imaginary part.
pub fn imaginary<T: Real>([_, x, y, z]: [T; 4]) -> Vector3<T> {
    Vector3::new(x, y, z)
}

/// `q* v q`: the body components of a spatial vector.
pub fn seen_from_body<T: Real>(q: [T; 4], v: &Vector3<T>) -> Vector3<T> {
    let v = [T::zero(), v[0], v[1], v[2]];
    imaginary(hamilton(hamilton(conjugate(q), v), q))
}

impl Configuration<f64> {
    /// Fields, rotations and unit quaternions of a node.
    pub fn of(x: Vec<f64>, r: Vec<Matrix3<f64>>, q: Vec<[f64; 4]>) -> Self {
        Self { x, r, q }
    }

    /// As constants.
    pub fn lifted(&self) -> Configuration<D> {
        Configuration {
            x: self.x.iter().map(|x| D::constant(*x)).collect(),
            r: self.r.iter().map(|r| r.map(D::constant)).collect(),
            q: self.q.iter().map(|q| q.map(D::constant)).collect(),
        }
    }

    /// With one field component, or one rotation about a body axis, as the variable.
    pub fn varied(&self, at: usize) -> Configuration<D> {
        let mut out = self.lifted();
        if at < self.x.len() {
            out.x[at] = D::variable(self.x[at], 0);
            return out;
        }
        let (i, axis) = ((at - self.x.len()) / 3, (at - self.x.len()) % 3);
        if let Some(i) = i.checked_sub(self.r.len()) {
            // The coordinates of the algebra are angular velocity, which is half a quaternion.
            let mut turn = [1.0, 0.0, 0.0, 0.0].map(D::constant);
            turn[axis + 1] = D::variable(0.0, 0) * D::constant(0.5);
            out.q[i] = hamilton(out.q[i], turn);
            return out;
        }
        let mut v = Vector3::repeat(D::constant(0.0));
        v[axis] = D::variable(0.0, 0);
        let zero = D::constant(0.0);
        let hat = Matrix3::new(zero, -v[2], v[1], v[2], zero, -v[0], -v[1], v[0], zero);
        out.r[i] *= Matrix3::identity() + hat;
        out
    }

    /// The number of derivatives.
    pub fn coordinates(&self) -> usize {
        self.x.len() + 3 * (self.r.len() + self.q.len())
    }
}

/// `tr(A B)`.
pub fn trace<T: Real>(a: &Matrix3<T>, b: &Matrix3<T>) -> T {
    (a * b).trace()
}

/// The largest derivative of the action of two edges at the middle of three configurations, relative to the largest derivative of
/// one edge. Subtracts the velocity error from two rounding errors of positions.
pub fn stationarity(line: &dyn Line, nodes: &[Configuration<f64>; 3]) -> f64 {
    stationarity_weighed(line, &line.weights(), nodes)
}

/// Like `stationarity`, with other weights of the terms.
pub fn stationarity_weighed(
    line: &dyn Line,
    weights: &[f64],
    [a, b, c]: &[Configuration<f64>; 3],
) -> f64 {
    let (before, after) = (a.lifted(), c.lifted());
    let (mut worst, mut scale) = (0.0_f64, 1e-300_f64);
    let mut sums = Vec::new();
    for at in 0..b.coordinates() {
        if line.held(at) {
            sums.push(0.0);
            continue;
        }
        let here = b.varied(at);
        let (into, out) = (
            line.weighed(weights, &before, &here),
            line.weighed(weights, &here, &after),
        );
        sums.push(into.dual[0] + out.dual[0]);
        worst = worst.max((into.dual[0] + out.dual[0]).abs());
        scale = scale.max(into.dual[0].abs()).max(out.dual[0].abs());
    }
    assert!(worst.is_finite() && scale.is_finite());
    if !line.constraints(&before).is_empty() {
        let left = without_reactions(line, b, &sums);
        worst = clebsch::scalar::largest(left.into_iter().map(f64::abs));
    }
    let far = b.x.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
    let rounded = 2.0 * f64::EPSILON * far * line.mass_by_step();
    (worst - rounded).max(0.0) / scale
}

/// A covector minus its projection onto the constraint gradients: the part that constraint forces cannot balance.
pub fn without_reactions(line: &dyn Line, q: &Configuration<f64>, of: &[f64]) -> Vec<f64> {
    let free: Vec<usize> = (0..q.coordinates()).filter(|at| !line.held(*at)).collect();
    let columns = free.iter().map(|at| line.constraints(&q.varied(*at)));
    let columns: Vec<Vec<D>> = columns.collect();
    let count = columns.first().map_or(0, Vec::len);
    let all = DMatrix::from_fn(free.len(), count, |i, j| columns[i][j].dual[0]);
    let mut left = DVector::from_iterator(free.len(), free.iter().map(|at| of[*at]));
    let basis = all.qr().q();
    // A second projection removes the rounding error of the first.
    for _ in 0..2 {
        left -= &basis * (basis.transpose() * &left);
    }
    left.iter().copied().collect()
}

/// The largest difference of a constraint value between two configurations.
pub fn off_constraints(line: &dyn Line, a: &Configuration<f64>, b: &Configuration<f64>) -> f64 {
    let (a, b) = (line.constraints(&a.lifted()), line.constraints(&b.lifted()));
    clebsch::scalar::largest(a.iter().zip(&b).map(|(x, y)| (x.value() - y.value()).abs()))
}

/// The momentum at the first node of an edge: minus the derivative of the action there.
pub fn momenta(line: &dyn Line, [a, b]: [&Configuration<f64>; 2]) -> Vec<f64> {
    let after = b.lifted();
    let weights = line.weights();
    let each = 0..a.coordinates();
    let each = each.map(|at| -line.weighed(&weights, &a.varied(at), &after).dual[0]);
    each.collect()
}
