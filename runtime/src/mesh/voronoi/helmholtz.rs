//! The depths of a layer of fluid, smoothed over a length, that models name:
//! `mesh phi: Real at a = helmholtz_depth(X, m, alpha);` and its neighbours. Takes places on a torus, masses and the length; gives
//! depths and exact derivatives. Each leaves a lake of even depth at rest on any mesh.

use super::laplacian::Cotangents;
use super::smoothed::Smoothed;
use super::within::Within;

/// The solution of `(A + alpha^2 K) phi = m` with the areas of the Voronoi cells and the Laplace operator of the Delaunay
/// triangulation. `(g/2) sum m phi` is the potential energy whose waves have
/// `omega^2 = g h k^2 / (1 + alpha^2 k^2)` (regularised shallow water: Dixon and Reich, 2004).
#[allow(non_camel_case_types)] // Models name it.
pub type helmholtz_depth<T> = Smoothed<T, Cotangents<T>, 1>;

/// The same, smoothed twice: `(A + alpha^2 K) A^-1 (A + alpha^2 K) phi = m`. Waves have
/// `omega^2 = g h k^2 / (1 + alpha^2 k^2)^2`. Long waves are as slow as with [`helmholtz_depth`] and a length greater
/// by `sqrt(2)`. Differences between neighbouring particles are damped by the square of the factor of
/// [`helmholtz_depth`].
#[allow(non_camel_case_types)] // Models name it.
pub type helmholtz_twice<T> = Smoothed<T, Cotangents<T>, 2>;

/// The solution of `(A + alpha^2 G) phi = m`, where `G` couples all pairs of particles nearer than 2.5 of their mean
/// distance by a smooth function of their distance: no derivative jumps where neighbours change.
#[allow(non_camel_case_types)] // Models name it.
pub type kernel_depth<T> = Smoothed<T, Within<T>, 1>;
