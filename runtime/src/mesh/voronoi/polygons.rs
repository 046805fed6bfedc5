//! Cells as polygons, and their intersections with the boxes of a grid. Takes masses of cells; gives masses of boxes
//! with the same total.

use super::half_edges::previous;
use super::mesh::{Plane, Voronoi, left};
use crate::mesh::MeshError;
use nalgebra::SVector;

impl Voronoi<f64> {
    /// Calls `each` with every site and the corners of its cell, counterclockwise and relative to the site.
    pub fn polygons(&self, mut each: impl FnMut(usize, &[SVector<f64, 2>])) {
        let edges = &self.delaunay.edges;
        let mut leaving = vec![None; self.sites()];
        for e in (0..edges.len()).rev() {
            leaving[edges.origin[e] as usize] = Some(e);
        }
        let mut corners = Vec::new();
        for (site, start) in leaving.into_iter().enumerate() {
            let Some(start) = start else { continue };
            corners.clear();
            let mut e = start;
            loop {
                let triangle = self.triangle(e / 3);
                let (d, w) = (triangle.sides[e % 3], triangle.weights[e % 3]);
                corners.push(d * 0.5 + left(d) * w);
                e = edges.twin[previous(e)] as usize;
                if e == start {
                    break;
                }
            }
            each(site, &corners);
        }
    }

    /// Distributes the mass of each cell over the boxes of a grid, in proportion to the area of the cell in each box.
    /// `out[j * columns + i]` is the mass in column `i` and row `j`. The total mass is conserved.
    ///
    /// # Errors
    /// [`MeshError::Count`] unless there is one mass for each cell and one value for each box.
    pub fn rezone(
        &self,
        masses: &[f64],
        [columns, rows]: [usize; 2],
        out: &mut [f64],
    ) -> Result<(), MeshError> {
        MeshError::unless_of_length(masses, self.sites())?;
        MeshError::unless_of_length(out, columns * rows)?;
        let lengths = self.lengths();
        let boxes = Plane::new(lengths[0] / columns as f64, lengths[1] / rows as f64);
        out.fill(0.0);
        let (mut cell, mut strip, mut part, mut kept) =
            <(Vec<_>, Vec<_>, Vec<_>, Vec<_>)>::default();
        let mut shares: Vec<(usize, f64)> = Vec::new();
        self.polygons(|site, corners| {
            // Coordinates in units of boxes.
            let place = self.places()[site];
            cell.clear();
            cell.extend(corners.iter().map(|c| (place + c).component_div(&boxes)));
            shares.clear();
            let mut whole = 0.0;
            for j in span(&cell, 1) {
                between(&cell, 1, j as f64, &mut strip, &mut kept);
                let row = j.rem_euclid(rows as i64) as usize;
                for i in span(&strip, 0) {
                    between(&strip, 0, i as f64, &mut part, &mut kept);
                    let area = area(&part);
                    whole += area;
                    let column = i.rem_euclid(columns as i64) as usize;
                    shares.push((row * columns + column, area));
                }
            }
            for &(place, area) in &shares {
                out[place] += masses[site] * area / whole;
            }
        });
        Ok(())
    }
}

/// The indices of the unit intervals that a polygon overlaps along a coordinate; empty for an empty polygon.
fn span(corners: &[Plane<f64>], along: usize) -> core::ops::RangeInclusive<i64> {
    let mut ends = (f64::INFINITY, f64::NEG_INFINITY);
    for corner in corners {
        ends = (ends.0.min(corner[along]), ends.1.max(corner[along]));
    }
    if ends.0 > ends.1 {
        return core::ops::RangeInclusive::new(1, 0);
    }
    ends.0.floor() as i64..=ends.1.floor() as i64
}

/// The part of a convex polygon whose coordinate is between `low` and `low + 1`.
fn between(
    corners: &[Plane<f64>],
    along: usize,
    low: f64,
    out: &mut Vec<Plane<f64>>,
    kept: &mut Vec<Plane<f64>>,
) {
    clip(corners, along, |x| x - low, kept);
    clip(kept, along, |x| low + 1.0 - x, out);
}

/// The part of a convex polygon on which a function of one coordinate is nonnegative (Sutherland and Hodgman, 1974).
fn clip(
    corners: &[Plane<f64>],
    along: usize,
    inside: impl Fn(f64) -> f64,
    out: &mut Vec<Plane<f64>>,
) {
    out.clear();
    for (k, here) in corners.iter().enumerate() {
        let next = corners[(k + 1) % corners.len()];
        let (own, other) = (inside(here[along]), inside(next[along]));
        if own >= 0.0 {
            out.push(*here);
        }
        if (own > 0.0 && other < 0.0) || (own < 0.0 && other > 0.0) {
            out.push(here + (next - here) * (own / (own - other)));
        }
    }
}

/// The area of a polygon.
fn area(corners: &[Plane<f64>]) -> f64 {
    let Some(first) = corners.first() else {
        return 0.0;
    };
    let twice: f64 = corners
        .windows(2)
        .map(|pair| {
            let (u, v) = (pair[0] - first, pair[1] - first);
            u[0] * v[1] - u[1] * v[0]
        })
        .sum();
    (0.5 * twice).max(0.0)
}
