//! Gradient, divergence and curl of values at particles, on the Voronoi diagram. One set is consistent with the exact
//! change of areas; the other uses averages on faces. Takes and gives values at all sites. Use these operators to
//! analyse a flow; the forces of a model are derivatives of its potential.

use super::cells::Face;
use super::mesh::{Plane, Voronoi, dot, left};
use crate::Real;
use crate::mesh::MeshError;
use nalgebra::SVector;

impl<T: Real> Voronoi<T> {
    /// `(1/A_a) sum_b (q_b - q_a) (l/R) (c - X_a)`, exact for linear functions on every mesh (Serrano and Espanol,
    /// 2001).
    ///
    /// # Errors
    /// [`MeshError::Count`] where there are not as many values as sites.
    pub fn gradient(&self, q: &[T], out: &mut [SVector<T, 2>]) -> Result<(), MeshError> {
        self.per_area(q, out, |face, add| {
            let [a, b] = face.sites;
            let flow = (q[b] - q[a]) * face.ratio;
            add(a, face.middle * flow);
            add(b, (face.edge - face.middle) * flow);
        })
    }

    /// The relative rate of change of areas, `(1/A_a) dA_a/dt`, for particles with velocities `u`.
    /// [`Voronoi::gradient`] is its negative adjoint in the area-weighted product.
    ///
    /// # Errors
    /// [`MeshError::Count`] where there are not as many values as sites.
    pub fn divergence(&self, u: &[SVector<T, 2>], out: &mut [T]) -> Result<(), MeshError> {
        self.per_area(u, out, |face, add| {
            let [a, b] = face.sites;
            let seen = face.middle - face.edge;
            let flow = (dot(face.middle, u[a]) - dot(seen, u[b])) * face.ratio;
            add(a, flow);
            add(b, -flow);
        })
    }

    /// The curl `d_1 u_2 - d_2 u_1` with [`Voronoi::gradient`]. It is exact for linear velocities, but its integral
    /// does not vanish.
    ///
    /// # Errors
    /// [`MeshError::Count`] where there are not as many values as sites.
    pub fn curl(&self, u: &[SVector<T, 2>], out: &mut [T]) -> Result<(), MeshError> {
        self.per_area(u, out, |face, add| {
            let [a, b] = face.sites;
            let shear = left(u[a] - u[b]) * face.ratio;
            add(a, dot(face.middle, shear));
            add(b, dot(face.edge - face.middle, shear));
        })
    }

    /// `(1/A_a) sum_b (q_a + q_b)/2 l n`, with averages at the midpoints of edges instead of faces. For linear
    /// functions it is exact only on lattices; on other meshes its error does not decrease with the particle distance.
    /// With `q = m h` and divided by `-m` it has been used for the acceleration of shallow water.
    ///
    /// # Errors
    /// [`MeshError::Count`] where there are not as many values as sites.
    pub fn gradient_of_means(&self, q: &[T], out: &mut [SVector<T, 2>]) -> Result<(), MeshError> {
        let half = T::from_f64(0.5);
        self.per_area(q, out, |face, add| {
            let [a, b] = face.sites;
            let flow = face.edge * ((q[a] + q[b]) * face.ratio * half);
            add(a, flow);
            add(b, -flow);
        })
    }

    /// `(1/A_a) sum_b (u_a + u_b)/2 . l n`, the negative adjoint of [`Voronoi::gradient_of_means`].
    ///
    /// # Errors
    /// [`MeshError::Count`] where there are not as many values as sites.
    pub fn divergence_of_means(&self, u: &[SVector<T, 2>], out: &mut [T]) -> Result<(), MeshError> {
        let half = T::from_f64(0.5);
        self.per_area(u, out, |face, add| {
            let [a, b] = face.sites;
            let flow = dot(face.edge, u[a] + u[b]) * face.ratio * half;
            add(a, flow);
            add(b, -flow);
        })
    }

    /// `(1/A_a) sum_b (u_a + u_b)/2 . l t`, with `t` along the face. Its integral vanishes.
    ///
    /// # Errors
    /// [`MeshError::Count`] where there are not as many values as sites.
    pub fn curl_of_means(&self, u: &[SVector<T, 2>], out: &mut [T]) -> Result<(), MeshError> {
        let half = T::from_f64(0.5);
        self.per_area(u, out, |face, add| {
            let [a, b] = face.sites;
            let flow = dot(left(face.edge), u[a] + u[b]) * face.ratio * half;
            add(a, flow);
            add(b, -flow);
        })
    }

    /// Potential vorticity `(zeta + f)/h` with [`Voronoi::curl`], for given Coriolis parameter `f` and depth `h` at
    /// each particle.
    ///
    /// # Errors
    /// [`MeshError::Count`] where there are not as many values as sites.
    pub fn potential_vorticity(
        &self,
        u: &[SVector<T, 2>],
        f: &[T],
        depth: &[T],
        out: &mut [T],
    ) -> Result<(), MeshError> {
        MeshError::unless_of_length(f, self.sites())?;
        MeshError::unless_of_length(depth, self.sites())?;
        self.curl(u, out)?;
        for ((q, f), h) in out.iter_mut().zip(f).zip(depth) {
            *q = (*q + *f) / *h;
        }
        Ok(())
    }

    /// Sums the contributions of faces and divides by the areas.
    fn per_area<V, S: Summand<T>>(
        &self,
        values: &[V],
        out: &mut [S],
        each: impl Fn(&Face<T>, &mut dyn FnMut(usize, S)),
    ) -> Result<(), MeshError> {
        MeshError::unless_of_length(values, self.sites())?;
        MeshError::unless_of_length(out, self.sites())?;
        let mut areas = vec![T::zero(); self.sites()];
        self.sum_areas(&mut areas);
        out.fill(S::nothing());
        for face in self.faces() {
            each(&face, &mut |site, part| out[site].add(part));
        }
        for (out, area) in out.iter_mut().zip(&areas) {
            out.divide(*area);
        }
        Ok(())
    }

    /// The circulation around every triangle, `sum (u_i + u_j)/2 . (X_j - X_i)`, in the order of
    /// [`Voronoi::triangles`]. All circulations add up to zero. While the corners of a triangle remain neighbours, its
    /// circulation changes at the rate that the same sum gives for the accelerations, because the terms from the
    /// velocities cancel around the triangle.
    ///
    /// # Errors
    /// [`MeshError::Count`] unless there is one velocity for each site and two values for each site, one for each
    /// triangle.
    pub fn circulations(&self, u: &[SVector<T, 2>], out: &mut [T]) -> Result<(), MeshError> {
        MeshError::unless_of_length(u, self.sites())?;
        MeshError::unless_of_length(out, 2 * self.sites())?;
        let half = T::from_f64(0.5);
        for (out, triangle) in out.iter_mut().zip(self.triangles()) {
            let [a, b, c] = triangle.sites.map(|site| u[site]);
            let [ab, bc, ca] = triangle.sides;
            *out = (dot(a + b, ab) + dot(b + c, bc) + dot(c + a, ca)) * half;
        }
        Ok(())
    }
}

/// A number or a vector.
trait Summand<T>: Copy {
    fn nothing() -> Self;
    fn add(&mut self, part: Self);
    fn divide(&mut self, by: T);
}

impl<T: Real> Summand<T> for T {
    fn nothing() -> Self {
        T::zero()
    }

    fn add(&mut self, part: Self) {
        *self += part;
    }

    fn divide(&mut self, by: T) {
        *self /= by;
    }
}

impl<T: Real> Summand<T> for Plane<T> {
    fn nothing() -> Self {
        Plane::zeros()
    }

    fn add(&mut self, part: Self) {
        *self += part;
    }

    fn divide(&mut self, by: T) {
        *self /= by;
    }
}
