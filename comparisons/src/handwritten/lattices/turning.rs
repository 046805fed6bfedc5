//! Rotates many bodies by the principal solution of the discrete Moser-Veselov equation, several together if a single pass finds
//! each root. Takes unit quaternions and spatial edge momenta; updates the quaternions.

use super::columns::{Columns, LANES, lane, put_lane};
use crate::handwritten::Unsolvable;
use crate::handwritten::attitude::{
    Matrix, Quaternion, Vector, add_scaled, cross, dot, product, scaled,
};
use crate::handwritten::principal_axes::PrincipalAxes;
use crate::handwritten::principal_root::{self, Quartic};
use std::ops::Range;

/// A body and the step size.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    moments: Vector,
    gyration: Vector,
    quartic: Quartic,
    axes: PrincipalAxes,
    half_step: f64,
}

impl Body {
    fn new(poinsot: &Matrix, h: f64) -> Result<Body, Unsolvable> {
        let axes = PrincipalAxes::new(poinsot)?;
        let i = axes.moments;
        Ok(Body {
            moments: i,
            gyration: [i[1] - i[2], i[2] - i[0], i[0] - i[1]],
            quartic: Quartic::new(&i),
            axes,
            half_step: 0.5 * h,
        })
    }

    /// h/2 times the body momentum of the edge, R^T m.
    #[inline(always)]
    fn seen(&self, q: &Quaternion, momentum: &Vector) -> Vector {
        let [w, x, y, z] = q.0;
        let m = scaled(self.half_step, momentum);
        let v = [x, y, z];
        let across = scaled(2.0, &cross(&v, &m));
        add_scaled(&add_scaled(&m, -w, &across), 1.0, &cross(&v, &across))
    }

    /// The unnormalised rotation for u in principal axes and kappa.
    #[inline(always)]
    fn turn(&self, u: &Vector, squares: &Vector, a: f64, kappa: f64) -> Quaternion {
        principal_root::turn(&self.moments, &self.gyration, u, squares, a, kappa)
    }

    /// The attitude of the principal axes at the end of the edge, and whether a single pass found the root.
    #[inline(always)]
    fn turned_at_once(&self, q: &Quaternion, momentum: &Vector) -> (Quaternion, bool) {
        let u = self.seen(q, momentum);
        let squares = [u[0] * u[0], u[1] * u[1], u[2] * u[2]];
        let a = (squares[0] + squares[1]) + squares[2];
        let (kappa, found) = self.quartic.root_at_once(&squares, a);
        let turn = self.turn(&u, &squares, a, kappa);
        (q.times(&turn).normalised(), found)
    }

    /// The attitude at the end of the edge, for any axes; `axes` is `None` if they are the principal axes.
    fn turned(
        &self,
        axes: Option<&PrincipalAxes>,
        q: &Quaternion,
        momentum: &Vector,
    ) -> Result<Quaternion, Unsolvable> {
        let seen = self.seen(q, momentum);
        let u = axes.map_or(seen, |axes| axes.enter(&seen));
        let squares = u.map(|c| c * c);
        let a = (squares[0] + squares[1]) + squares[2];
        let kappa = self.quartic.principal_root(&squares, a)?;
        let turn = self.turn(&u, &squares, a, kappa);
        let [w, x, y, z] = turn.0;
        let [x, y, z] = axes.map_or([x, y, z], |axes| axes.leave(&[x, y, z]));
        Ok(q.times(&Quaternion([w, x, y, z])).normalised())
    }
}

/// The bodies of a chain.
#[derive(Clone, Debug)]
pub enum Bodies {
    /// Identical bodies; stored attitudes are those of their principal axes.
    Alike(Box<Body>),
    /// One body per site; stored attitudes are those of the given axes.
    Each(Vec<Body>),
}

impl Bodies {
    /// Bodies with these second moments of mass, for step size `h`.
    pub fn new(poinsots: &[Matrix], h: f64) -> Result<Bodies, Unsolvable> {
        let [first, rest @ ..] = poinsots else {
            return Ok(Bodies::Each(Vec::new()));
        };
        if rest.iter().all(|other| other == first) {
            return Ok(Bodies::Alike(Box::new(Body::new(first, h)?)));
        }
        let each = poinsots.iter().map(|poinsot| Body::new(poinsot, h));
        Ok(Bodies::Each(each.collect::<Result<_, _>>()?))
    }

    /// The common principal axes, if attitudes are stored in these.
    fn axes(&self) -> Option<&PrincipalAxes> {
        match self {
            Bodies::Alike(body) => Some(&body.axes),
            Bodies::Each(_) => None,
        }
    }

    /// The stored attitude of a given one.
    pub fn enter_attitude(&self, q: &Quaternion) -> Quaternion {
        self.axes().map_or(*q, |axes| axes.enter_attitude(q))
    }

    /// The given attitude of a stored one.
    pub fn leave_attitude(&self, q: &Quaternion) -> Quaternion {
        self.axes().map_or(*q, |axes| axes.leave_attitude(q))
    }

    /// Components in the stored axes of a vector that is the same for all bodies.
    pub fn enter(&self, v: &Vector) -> Vector {
        self.axes().map_or(*v, |axes| axes.enter(v))
    }

    /// The symmetric matrix in the stored axes.
    pub fn enter_matrix(&self, m: &Matrix) -> Matrix {
        let half = m.map(|row| self.enter(&row));
        let columns = [0, 1, 2].map(|j| self.enter(&[half[0][j], half[1][j], half[2][j]]));
        [0, 1, 2].map(|i| [columns[0][i], columns[1][i], columns[2][i]])
    }

    /// Rotates `count` bodies from one end of their edges to the other; after a failure, the remaining bodies are unchanged.
    #[inline(always)]
    pub fn turn(
        &self,
        q: &mut Columns<4>,
        momenta: &Columns<3>,
        count: usize,
    ) -> Result<(), Unsolvable> {
        let body = match self {
            Bodies::Alike(body) => **body,
            Bodies::Each(bodies) => {
                for (site, body) in bodies.iter().enumerate() {
                    let before = Quaternion(q.get(site));
                    let after = body.turned(Some(&body.axes), &before, &momenta.get(site))?;
                    q.set(site, after.0);
                }
                return Ok(());
            }
        };
        let whole = count / LANES * LANES;
        for first in (0..whole).step_by(LANES) {
            if !together(&body, q, momenta, first) {
                singly(&body, q, momenta, first..first + LANES)?;
            }
        }
        singly(&body, q, momenta, whole..count)
    }
}

#[inline(always)]
fn together(body: &Body, q: &mut Columns<4>, momenta: &Columns<3>, first: usize) -> bool {
    let (before, m) = (q.read::<LANES>(first), momenta.read::<LANES>(first));
    let mut after = [[0.0; LANES]; 4];
    let mut all = true;
    for at in 0..LANES {
        let (turned, found) = body.turned_at_once(&Quaternion(lane(&before, at)), &lane(&m, at));
        put_lane(&mut after, at, turned.0);
        all &= found;
    }
    if all {
        q.write(first, &after);
    }
    all
}

#[inline(never)]
fn singly(
    body: &Body,
    q: &mut Columns<4>,
    momenta: &Columns<3>,
    sites: Range<usize>,
) -> Result<(), Unsolvable> {
    for site in sites {
        let after = body.turned(None, &Quaternion(q.get(site)), &momenta.get(site))?;
        q.set(site, after.0);
    }
    Ok(())
}

/// The spatial torque of a bond with second moments `B` between attitudes R and R' on the body at R: the axial vector of `R' B R^T`
/// minus its transpose. The torque on the body at R' is the opposite.
#[inline(always)]
pub fn bond(here: &Matrix, next: &Matrix, moments: &Matrix) -> Vector {
    let m = product(next, moments);
    [
        dot(&m[2], &here[1]) - dot(&m[1], &here[2]),
        dot(&m[0], &here[2]) - dot(&m[2], &here[0]),
        dot(&m[1], &here[0]) - dot(&m[0], &here[1]),
    ]
}
