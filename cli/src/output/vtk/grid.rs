//! The nodes of a fluid's grid as an image. In a periodic direction the first node is repeated at the end.
//! Takes a domain and the columns of values at nodes; gives the data of a sample.

use super::columns::Columns;
use super::{Data, Part};
use crate::case_file::space::Space;
use clebsch::record::vtk::{ImageData, Values};

/// A grid with the values at its nodes.
pub(super) struct Grid {
    origin: [f64; 3],
    spacing: [f64; 3],
    nodes: [usize; 3],
    /// For each node of the image, the node of the model.
    order: Vec<usize>,
    columns: Vec<Columns>,
}

/// The grid of a domain with the columns of values at its nodes.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss
)]
pub(super) fn grid(space: &Space, columns: Vec<Columns>) -> Option<Grid> {
    let cells = space.cells.as_ref()?;
    let (places, _) = space.nodes().ok()?;
    let mut spacing = [1.0; 3];
    let mut nodes = [1; 3];
    for (d, (length, n)) in space.lengths.iter().zip(cells).enumerate() {
        *spacing.get_mut(d)? = length / *n as f64;
        // A periodic direction repeats its first node at the seam; a direction with walls has a node on each
        // wall.
        *nodes.get_mut(d)? = n + 1;
    }
    let mut order = vec![None; nodes.iter().product()];
    for (number, place) in places.iter().enumerate() {
        let each = place.iter().zip(&spacing).zip(&space.walls).zip(&nodes);
        let each = each.map(|(((x, by), wall), n)| {
            let at = (x / by).round() as usize;
            match !wall && at == 0 {
                true => vec![0, n - 1],
                false => vec![at],
            }
        });
        let mut each = each.collect::<Vec<_>>().into_iter();
        let (first, second) = (each.next()?, each.next().unwrap_or_else(|| vec![0]));
        for j in &second {
            for i in &first {
                *order.get_mut(j * nodes[0] + i)? = Some(number);
            }
        }
    }
    Some(Grid {
        origin: [0.0; 3],
        spacing,
        nodes,
        order: order.into_iter().collect::<Option<_>>()?,
        columns,
    })
}

impl Part for Grid {
    fn ending(&self) -> &'static str {
        "vti"
    }

    fn data(&mut self, row: &[f64]) -> Data {
        let reordered = |values: Values| {
            let n = values.components;
            let at = |node: &usize| values.numbers.get(node * n..(node + 1) * n);
            let numbers = self.order.iter().filter_map(at).flatten().copied();
            Values {
                numbers: numbers.collect(),
                ..values
            }
        };
        let values = self.columns.iter().flat_map(|c| c.values(row));
        Data::Image(ImageData {
            origin: self.origin,
            spacing: self.spacing,
            nodes: self.nodes,
            point_data: values.map(reordered).collect(),
        })
    }
}
