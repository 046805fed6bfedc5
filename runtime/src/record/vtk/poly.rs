//! Points in space with vertices, lines and polygons on them, as `.vtp`. Takes points, the corner indices of each
//! cell and values; writes one file.

use super::{HEAD, Values, array, data, unfit};
use std::io::{self, Write};

/// Points, and cells on them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolyData {
    /// The positions of the points.
    pub points: Vec<[f64; 3]>,
    /// Points that are drawn as such, by their numbers.
    pub vertices: Vec<u64>,
    /// Polylines, each given by the indices of its points.
    pub lines: Vec<Vec<u64>>,
    /// Polygons by their corners.
    pub polygons: Vec<Vec<u64>>,
    /// Values at points.
    pub point_data: Vec<Values>,
    /// Values of cells: of vertices, then of lines, then of polygons.
    pub cell_data: Vec<Values>,
}

impl PolyData {
    /// Every point drawn as such.
    #[must_use]
    pub fn of_points(points: Vec<[f64; 3]>) -> Self {
        Self {
            vertices: (0..points.len() as u64).collect(),
            points,
            ..Self::default()
        }
    }

    /// Writes a file of them.
    ///
    /// # Errors
    /// The errors of `file`. `InvalidInput` if the number of values differs from the number of points or cells, or if a
    /// cell has a corner beyond the last point.
    pub fn write(&self, file: &mut dyn Write) -> io::Result<()> {
        let count = self.points.len();
        let cells = [self.vertices.len(), self.lines.len(), self.polygons.len()];
        let of_lines = self.lines.iter().chain(&self.polygons).flatten();
        let mut corners = self.vertices.iter().chain(of_lines);
        if let Some(wrong) = corners.find(|corner| **corner >= count as u64) {
            return Err(unfit(&format!(
                "a cell has the corner {wrong}, but there are {count} points"
            )));
        }
        let [vertices, lines, polygons] = cells;
        writeln!(
            file,
            "{HEAD}\"PolyData\">\n<PolyData>\n<Piece NumberOfPoints=\"{count}\" NumberOfVerts=\"{vertices}\" \
             NumberOfLines=\"{lines}\" NumberOfStrips=\"0\" NumberOfPolys=\"{polygons}\">"
        )?;
        data(file, "PointData", &self.point_data, count)?;
        data(file, "CellData", &self.cell_data, cells.iter().sum())?;
        writeln!(file, "<Points>")?;
        Values::vectors("Points", &self.points).write(file)?;
        writeln!(file, "</Points>")?;
        let single: Vec<Vec<u64>> = self.vertices.iter().map(|v| vec![*v]).collect();
        for (element, cells) in [
            ("Verts", &single),
            ("Lines", &self.lines),
            ("Polys", &self.polygons),
        ] {
            connected(file, element, cells)?;
        }
        writeln!(file, "</Piece>\n</PolyData>\n</VTKFile>")
    }
}

/// Cells by their corner indices, and by the offset of the end of each cell.
fn connected(file: &mut dyn Write, element: &str, cells: &[Vec<u64>]) -> io::Result<()> {
    let corners: Vec<[u8; 8]> = cells.iter().flatten().map(|c| c.to_le_bytes()).collect();
    let ends = cells.iter().scan(0, |end, cell| {
        *end += cell.len() as u64;
        Some(end.to_le_bytes())
    });
    let ends: Vec<[u8; 8]> = ends.collect();
    writeln!(file, "<{element}>")?;
    array(file, "Int64", "connectivity", 1, corners.into_iter())?;
    array(file, "Int64", "offsets", 1, ends.into_iter())?;
    writeln!(file, "</{element}>")
}
