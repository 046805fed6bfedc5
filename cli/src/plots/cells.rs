//! Cells of a fluid as polygons: the cells of its Voronoi mesh, and the cells around the nodes of a grid.
//! Takes a run and a sample; gives corners and values.

use super::particles::Snapshot;
use crate::case_file::space::Space;
use crate::output::Finished;
use crate::output::vtk::fluid::cells;
use clebsch::record::Record;

/// The cells at two samples with one of their values. `None` if the fluid has no cells or lacks this value.
pub(super) fn cells_of(
    run: &Finished<'_>,
    record: &Record,
    picked: &[usize; 2],
    value: &str,
) -> Option<[Snapshot; 2]> {
    let mut cells = cells(run.card, run.plan)?;
    let mut shots = picked.iter().map(|sample| {
        let row = record.observables.rows().nth(*sample)?;
        let data = cells.polygons(row);
        let own = data.cell_data.iter().find(|v| v.name == value)?;
        let corner = |at: &u64| {
            let at = usize::try_from(*at).ok()?;
            data.points.get(at).map(|[x, y, _]| [*x, *y])
        };
        let each = data.polygons.iter().zip(&own.numbers);
        let each = each.map(|(polygon, x)| (polygon.iter().filter_map(corner).collect(), *x));
        Some(Snapshot {
            time: record.times.get(*sample).copied()?,
            marks: Vec::new(),
            cells: each.collect(),
            dots: Vec::new(),
            radius: 0.0,
        })
    });
    Some([shots.next()??, shots.next()??])
}

/// The cell around a node of a grid, within walls.
#[allow(clippy::cast_precision_loss)]
pub(super) fn around(space: &Space, node: &[f64]) -> Option<Vec<[f64; 2]>> {
    let cells = space.cells.as_ref()?;
    let side = |d: usize| -> Option<[f64; 2]> {
        let (length, x) = (*space.lengths.get(d)?, *node.get(d)?);
        let half = 0.5 * length / *cells.get(d)? as f64;
        Some(match space.walls.get(d) {
            Some(true) => [(x - half).max(0.0), (x + half).min(length)],
            _ => [x - half, x + half],
        })
    };
    let ([left, right], [down, up]) = (side(0)?, side(1)?);
    Some(vec![[left, down], [right, down], [right, up], [left, up]])
}

/// The range that contains all but one in a hundred values, with equal parts excluded at both ends.
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss
)]
pub(super) fn most_of(mut values: Vec<f64>) -> (f64, f64) {
    values.retain(|v| v.is_finite());
    values.sort_by(f64::total_cmp);
    let left_out = (0.005 * values.len() as f64) as usize;
    let low = values.get(left_out).copied();
    let high = values.len().checked_sub(1 + left_out);
    let high = high.and_then(|at| values.get(at).copied());
    (low.unwrap_or(-0.5), high.unwrap_or(0.5))
}

/// A convex polygon clipped to the unit square, one side after the other (Sutherland and Hodgman, 1974).
pub(super) fn clipped(mut corners: Vec<[f64; 2]>) -> Vec<[f64; 2]> {
    for (d, upper) in [(0, false), (0, true), (1, false), (1, true)] {
        let depth = |c: &[f64; 2]| if upper { 1.0 - c[d] } else { c[d] };
        let mut kept = Vec::with_capacity(corners.len() + 1);
        for (i, to) in corners.iter().enumerate() {
            let before = if i == 0 { corners.len() } else { i } - 1;
            let Some(from) = corners.get(before) else {
                continue;
            };
            let (a, b) = (depth(from), depth(to));
            if (a < 0.0) != (b < 0.0) {
                let part = a / (a - b);
                let between = |k: usize| from[k] + part * (to[k] - from[k]);
                kept.push([between(0), between(1)]);
            }
            if b >= 0.0 {
                kept.push(*to);
            }
        }
        corners = kept;
    }
    corners
}

/// The area of a polygon with its corners counterclockwise.
pub(super) fn area(corners: &[[f64; 2]]) -> f64 {
    let next = corners.iter().cycle().skip(1);
    let twice: f64 = corners
        .iter()
        .zip(next)
        .map(|([x, y], [u, v])| x * v - u * y)
        .sum();
    twice / 2.0
}

#[cfg(test)]
mod tests {
    use super::{area, clipped, most_of};

    #[test]
    fn polygons_are_cut_at_the_sides_of_the_square() {
        let whole = vec![[0.2, 0.2], [0.8, 0.2], [0.5, 0.8]];
        assert_eq!(clipped(whole.clone()), whole);
        let corner = clipped(vec![[0.5, 0.5], [1.5, 0.5], [1.5, 1.5], [0.5, 1.5]]);
        assert!((area(&corner) - 0.25).abs() < 1e-15, "{corner:?}");
        assert_eq!(
            area(&clipped(vec![[1.1, 0.0], [2.0, 0.0], [2.0, 1.0]])),
            0.0
        );
    }

    #[test]
    fn one_value_in_a_hundred_is_beyond_the_range_of_most() {
        let values: Vec<f64> = (0..1000).map(f64::from).collect();
        assert_eq!(most_of(values), (5.0, 994.0));
        assert_eq!(most_of(vec![f64::NAN, 3.0]), (3.0, 3.0));
    }
}
