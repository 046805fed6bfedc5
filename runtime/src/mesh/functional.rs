//! Functions of all sites, as steppers use them: the values at sites, and the transposed derivative applied
//! to a seed. Takes a field of particles or the values of another functional.

use super::{Domain, MeshError};
use crate::line::Threads;
use crate::{ParameterError, Real};

/// The domain, the grid and the number of particles of a functional.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting<const D: usize> {
    /// The domain of the particles.
    pub domain: Domain<D>,
    /// Cells of the grid along each direction; `None` for a model without a grid.
    pub grid: Option<[usize; D]>,
    /// The number of particles.
    pub particles: usize,
}

impl<const D: usize> Setting<D> {
    /// Side lengths of a grid cell along each direction; without a grid, of the mean box per particle.
    pub fn cell(&self) -> [f64; D] {
        let lengths = self.domain.lengths;
        match self.grid {
            Some(cells) => core::array::from_fn(|d| lengths[d] / cells[d].max(1) as f64),
            None => {
                let share = self.domain.measure() / self.particles.max(1) as f64;
                [share.powf(1.0 / D as f64); D]
            }
        }
    }

    /// The number of nodes of the grid: per direction, one more than cells between walls, as many as cells if periodic.
    pub fn nodes(&self) -> usize {
        let grid = self.grid.unwrap_or([0; D]);
        let along = grid.iter().zip(&self.domain.walls);
        along.map(|(n, wall)| wall.nodes(*n)).product()
    }
}

/// A function of the values of one argument at all of its sites, with values at its own sites: an area of each cell
/// of a mesh, a depth on a grid. Its other arguments are constant in time.
///
/// Dot products and sums run in an order that is fixed by the numbers of sites: no result depends on the number of
/// threads.
pub trait Functional<T: Real, const D: usize>: Clone + Send + Sync + Sized {
    /// Value of the argument at one of its sites: for a field of particles `T` if `D = 1`, otherwise
    /// `nalgebra::SVector<T, D>`, not wrapped around the domain; for another functional `T`.
    type Argument: Copy + Send + Sync;
    /// Its other arguments as a tuple, in their order: `&[T]` with one value per site, or `T`; for a single argument
    /// `(T,)`, for none `()`.
    type Data<'a>;

    /// Creates its workspace.
    ///
    /// # Errors
    /// Names the invalid argument.
    fn new(setting: &Setting<D>, data: Self::Data<'_>) -> Result<Self, ParameterError>;

    /// The number of sites of its values.
    fn sites(&self) -> usize;

    /// Its values, one for each of its sites.
    ///
    /// # Errors
    /// [`MeshError`] with the site; the contents of `out` are then meaningless.
    fn value(&mut self, at: &[Self::Argument], out: &mut [T]) -> Result<(), MeshError>;

    /// The transposed derivative at the argument of the last [`Functional::value`], applied to `seed`: with `seed` the
    /// derivatives of a number with respect to the values, `out` receives the derivatives with respect to the
    /// argument.
    ///
    /// # Errors
    /// [`MeshError`] with the site; `out` is of no meaning then.
    fn pull_back(
        &mut self,
        at: &[Self::Argument],
        seed: &[T],
        out: &mut [Self::Argument],
    ) -> Result<(), MeshError>;

    /// Shares its loops between this many threads. Results do not depend on the number, bit for bit.
    fn share(&mut self, threads: Threads) {
        let _ = threads;
    }
}
