//! One section of Kirchhoff's rod: its rotation over a step, and the response of the end of its third axis to a force on the
//! segment. Takes J per unit length, the length s of the segment and h; gives rotations and 3 x 3 response matrices.

use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_outer, add_scaled, apply, apply_transposed, cross, dot,
    inverse, product, scaled, transposed,
};
use crate::handwritten::principal_axes::PrincipalAxes;
use crate::handwritten::principal_root::{self, Quartic};

/// A section with precomputed data.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    poinsot: Matrix,
    moments: Vector,
    gyration: Vector,
    quartic: Quartic,
    /// Principal axes in section axes; `None` if they coincide.
    frame: Option<Matrix>,
    /// h/(2 s), which scales the momentum for the Moser-Veselov equation.
    scale: f64,
    spacing: f64,
    h: f64,
    /// First two rows of h (s (tr(J) Id - J))^-1: velocities times h.
    rates: [Vector; 2],
}

/// The rotation of a step, as an unnormalised quaternion, and the image of the third axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    quaternion: Quaternion,
    /// 2 over the squared length of the quaternion.
    twice: f64,
    /// Om E3.
    pub axis: Vector,
}

/// M + c Id.
#[inline(always)]
pub(super) fn apart(m: &Matrix, c: f64) -> Matrix {
    let [[a, b, d], [e, f, g], [i, j, k]] = *m;
    [[a + c, b, d], [e, f + c, g], [i, j, k + c]]
}

/// The axial vector of A B - (A B)^T, B symmetric.
#[inline(always)]
pub(super) fn axial_of_product(a: &Matrix, b: &Matrix) -> Vector {
    let entry = |i: usize, j: usize| dot(&a[i], &b[j]);
    [
        entry(2, 1) - entry(1, 2),
        entry(0, 2) - entry(2, 0),
        entry(1, 0) - entry(0, 1),
    ]
}

impl Turn {
    /// The identity rotation.
    pub const NONE: Turn = Turn {
        quaternion: Quaternion::IDENTITY,
        twice: 2.0,
        axis: [0.0, 0.0, 1.0],
    };

    /// Om.
    #[inline(always)]
    fn matrix(&self) -> Matrix {
        let e = self.quaternion.deviation();
        let c = self.twice;
        [
            [1.0 + c * e[0][0], c * e[0][1], c * e[0][2]],
            [c * e[1][0], 1.0 + c * e[1][1], c * e[1][2]],
            [c * e[2][0], c * e[2][1], 1.0 + c * e[2][2]],
        ]
    }

    /// Om^T v.
    #[inline(always)]
    pub fn seen_from_the_end(&self, v: &Vector) -> Vector {
        let e = self.quaternion.deviation();
        add_scaled(v, self.twice, &apply_transposed(&e, v))
    }

    /// The attitude of a section after this rotation.
    #[inline(always)]
    pub fn after(&self, q: &Quaternion) -> Quaternion {
        // Removes the rounding error of |q|^2 = 1, to first order.
        let correction = 1.5 - 0.5 * q.norm_squared();
        let turned = q.times(&self.quaternion);
        turned.scaled(correction * (0.5 * self.twice).sqrt())
    }
}

impl Section {
    pub fn new(poinsot: &Matrix, spacing: f64, h: f64) -> Result<Section, Unsolvable> {
        let axes = PrincipalAxes::new(poinsot)?;
        let i = axes.moments;
        let frame = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let columns = frame.map(|e| axes.leave(&e));
        let trace = poinsot[0][0] + poinsot[1][1] + poinsot[2][2];
        let inertia = apart(&poinsot.map(|row| row.map(|x| -x)), trace);
        let [first, second, _] = inverse(&inertia).map(|row| row.map(|x| x * h / spacing));
        Ok(Section {
            poinsot: *poinsot,
            moments: i,
            gyration: [i[1] - i[2], i[2] - i[0], i[0] - i[1]],
            quartic: Quartic::new(&i),
            frame: (columns != frame).then(|| transposed(&columns)),
            scale: 0.5 * h / spacing,
            spacing,
            h,
            rates: [first, second],
        })
    }

    /// The principal rotation for this momentum.
    #[inline(always)]
    pub fn turn(&self, momentum: &Vector) -> Result<Turn, Unsolvable> {
        let mut u = scaled(self.scale, momentum);
        if let Some(frame) = &self.frame {
            u = apply_transposed(frame, &u);
        }
        let squares = u.map(|c| c * c);
        let a = (squares[0] + squares[1]) + squares[2];
        let kappa = self.quartic.principal_root(&squares, a)?;
        let turn = principal_root::turn(&self.moments, &self.gyration, &u, &squares, a, kappa);
        let [w, x, y, z] = turn.0;
        let mut n = [x, y, z];
        if let Some(frame) = &self.frame {
            n = apply(frame, &n);
        }
        let [x, y, z] = n;
        let quaternion = Quaternion([w, x, y, z]);
        let twice = 2.0 / quaternion.norm_squared();
        Ok(Turn {
            quaternion,
            twice,
            axis: [
                twice * (x * z + w * y),
                twice * (y * z - w * x),
                1.0 - twice * (x * x + y * y),
            ],
        })
    }

    /// The response of minus s times the third axis at the end of the step to an impulse y, which gives the momentum s (Lam^T y) x
    /// E3 at its start: -h s Lam hat(Om E3) (tr(S) Id - S)^-1 hat(E3) Lam^T with S = Om J.
    #[inline(always)]
    pub fn answer(&self, turn: &Turn, r: &Matrix) -> Matrix {
        let s = product(&turn.matrix(), &self.poinsot);
        let trace = s[0][0] + s[1][1] + s[2][2];
        let x = apart(&s.map(|row| scaled(-1.0, &row)), trace);
        // The first two columns of the inverse, times its determinant.
        let (first, second) = (cross(&x[1], &x[2]), cross(&x[2], &x[0]));
        let scale = self.h * self.spacing / dot(&x[0], &first);
        let first = apply(r, &scaled(scale, &cross(&turn.axis, &first)));
        let second = apply(r, &scaled(-scale, &cross(&turn.axis, &second)));
        let column = |k: usize| [r[0][k], r[1][k], r[2][k]];
        let none = [[0.0; 3]; 3];
        add_outer(&add_outer(&none, &second, &column(0)), &first, &column(1))
    }

    /// The response in the limit of small steps.
    #[inline(always)]
    pub fn answer_at_rest(&self, r: &Matrix) -> Matrix {
        let [[a, b, _], [c, d, _]] = self.rates;
        let s = self.spacing * self.spacing;
        let row = |k: usize| {
            let (x, y) = (s * r[k][0], s * r[k][1]);
            let (first, second) = (d * x - b * y, a * y - c * x);
            let of = |j: usize| first * r[j][0] + second * r[j][1];
            [of(0), of(1), of(2)]
        };
        [row(0), row(1), row(2)]
    }

    /// h times the velocity of minus s times the third axis, along the first two axes.
    #[inline(always)]
    pub fn axis_velocity(&self, momentum: &Vector) -> [f64; 2] {
        let [x, y] = self.rates.map(|row| dot(&row, momentum));
        [-self.spacing * y, self.spacing * x]
    }
}
