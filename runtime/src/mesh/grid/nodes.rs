//! The nodes of a uniform grid on a domain, in the order of values at nodes: the index of the last direction runs
//! fastest. Takes the setting of a functional; gives the number, the positions and the weights of the nodes.

use super::super::Setting;
use super::axis::Axis;
use crate::{ParameterError, Problem, Real};

/// Nodes of a grid: `grid[d]` of them along a periodic direction, `grid[d] + 1` between two walls.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nodes<const D: usize> {
    axes: [Axis; D],
}

impl<const D: usize> Nodes<D> {
    /// The nodes of the grid of a setting.
    ///
    /// # Errors
    /// If the setting lacks a grid, a direction lacks intervals or a positive length, or the nodes exceed 2^32.
    pub fn new(setting: &Setting<D>) -> Result<Self, ParameterError> {
        let refused = |text, remedy| ParameterError {
            field: "grid",
            problem: Problem::AssumptionFails { text },
            remedy,
        };
        let Some(grid) = setting.grid else {
            return Err(refused(
                "the model has a grid",
                "give the number of intervals along each direction",
            ));
        };
        let domain = &setting.domain;
        let mut axes = [Axis::UNIT; D];
        let mut count = 1.0;
        for (d, axis) in axes.iter_mut().enumerate() {
            *axis = Axis::new(domain.lengths[d], grid[d], domain.walls[d])?;
            count *= axis.nodes() as f64;
        }
        match count <= 4_294_967_296.0 {
            true => Ok(Self { axes }),
            false => Err(refused("nodes <= 2^32", "use a coarser grid")),
        }
    }

    /// How many there are.
    #[must_use]
    pub fn count(&self) -> usize {
        self.axes.iter().map(Axis::nodes).product()
    }

    /// The directions of the grid.
    #[must_use]
    pub fn axes(&self) -> &[Axis; D] {
        &self.axes
    }

    /// The indices of a node along each direction.
    #[must_use]
    pub fn indices(&self, node: usize) -> [usize; D] {
        let mut rest = node;
        let mut indices = [0; D];
        for (index, axis) in indices.iter_mut().zip(&self.axes).rev() {
            *index = rest % axis.nodes();
            rest /= axis.nodes();
        }
        indices
    }

    /// The position of each node.
    #[must_use]
    pub fn places(&self) -> Vec<[f64; D]> {
        let place = |node| {
            let indices = self.indices(node);
            core::array::from_fn(|d| self.axes[d].coordinate(indices[d]))
        };
        (0..self.count()).map(place).collect()
    }

    /// The weight of each node in the trapezoid rule: the product of the spacings, halved for each wall that contains
    /// the node. The sum of all weights is the measure of the domain.
    #[must_use]
    pub fn weights<T: Real>(&self) -> Vec<T> {
        let weight = |node| {
            let indices = self.indices(node);
            let along = |d: usize| self.axes[d].weight::<T>(indices[d]);
            (0..D).fold(T::one(), |product, d| product * along(d))
        };
        (0..self.count()).map(weight).collect()
    }
}
