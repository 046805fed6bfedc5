//! Values at the nodes of a regular grid, as `.vti`. Takes the grid and values; writes one file.

use super::{HEAD, Values, data};
use std::io::{self, Write};

/// A regular grid with values at its nodes, the first direction fastest.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ImageData {
    /// The position of the first node.
    pub origin: [f64; 3],
    /// Distances of nodes.
    pub spacing: [f64; 3],
    /// Nodes along each direction; 1 for a missing direction.
    pub nodes: [usize; 3],
    /// Values at nodes.
    pub point_data: Vec<Values>,
}

impl ImageData {
    /// Writes a file of them.
    ///
    /// # Errors
    /// Errors of `file`; `InvalidInput` if the number of values differs from the number of nodes.
    pub fn write(&self, file: &mut dyn Write) -> io::Result<()> {
        let last = self.nodes.map(|n| n.saturating_sub(1));
        let extent = format!("0 {} 0 {} 0 {}", last[0], last[1], last[2]);
        let three = |v: [f64; 3]| format!("{:?} {:?} {:?}", v[0], v[1], v[2]);
        writeln!(
            file,
            "{HEAD}\"ImageData\">\n<ImageData WholeExtent=\"{extent}\" Origin=\"{}\" Spacing=\"{}\">\n<Piece Extent=\"{extent}\">",
            three(self.origin),
            three(self.spacing)
        )?;
        let count = self.nodes.iter().product();
        data(file, "PointData", &self.point_data, count)?;
        data(file, "CellData", &[], 0)?;
        writeln!(file, "</Piece>\n</ImageData>\n</VTKFile>")
    }
}
