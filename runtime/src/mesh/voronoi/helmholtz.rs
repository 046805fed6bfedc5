//! Depths of a fluid layer, smoothed over a length, by the names that models use:
//! `mesh phi: Real at a = helmholtz_depth(X, m, alpha);` and its variants. Takes positions on a torus, masses and the
//! length; gives depths and exact derivatives. On any mesh, a layer of uniform depth stays at rest.

use super::laplacian::Cotangents;
use super::smoothed::Smoothed;
use super::within::Within;

/// The solution of `(A + alpha^2 K) phi = m` with the areas of the Voronoi cells and the Laplace operator of the Delaunay
/// triangulation. `(g/2) sum m phi` is the potential energy whose waves have
/// `omega^2 = g h k^2 / (1 + alpha^2 k^2)` (regularised shallow water: Dixon and Reich, 2004).
#[allow(non_camel_case_types)] // Models name it.
pub type helmholtz_depth<T> = Smoothed<T, Cotangents<T>, 1>;

/// Like [`helmholtz_depth`], smoothed twice: `(A + alpha^2 K) A^-1 (A + alpha^2 K) phi = m`. Waves have
/// `omega^2 = g h k^2 / (1 + alpha^2 k^2)^2`. Long waves are as slow as with [`helmholtz_depth`] and a length larger by
/// `sqrt(2)`. Differences between neighbouring particles are damped by the square of the factor of [`helmholtz_depth`].
#[allow(non_camel_case_types)] // Models name it.
pub type helmholtz_twice<T> = Smoothed<T, Cotangents<T>, 2>;

/// The solution of `(A + alpha^2 G) phi = m`. `G` couples all pairs of particles within 2.5 mean particle distances, by
/// a smooth function of their distance, so derivatives are continuous when neighbours change.
#[allow(non_camel_case_types)] // Models name it.
pub type kernel_depth<T> = Smoothed<T, Within<T>, 1>;
