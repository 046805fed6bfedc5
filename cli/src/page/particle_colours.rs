//! The values that colour the particles of a fluid on its page. They come from the functional in its picture,
//! at the particles or interpolated between the nodes of a grid. Takes a run; gives a number for each particle
//! of a sample.

use crate::case_file::space::Space;
use crate::output::fluid::Coloured;
use crate::output::sites::AtSites;
use std::collections::HashMap;

/// The colours of particles.
pub(super) struct Tints<'a> {
    own: &'a Coloured<'a>,
    /// The columns of the nodes of a grid, by their numbers along each direction.
    nodes: HashMap<[usize; 2], usize>,
}

impl<'a> Tints<'a> {
    /// The values of a fluid.
    pub(super) fn of(own: &'a Coloured<'a>) -> Self {
        let nodes = match own.shown.index == own.places.index {
            true => HashMap::new(),
            false => numbered(&own.space, own.shown).unwrap_or_default(),
        };
        Tints { own, nodes }
    }

    /// The name of the functional.
    pub(super) fn name(&self) -> &str {
        &self.own.shown.name
    }

    /// Whether the values belong to the particles with these positions.
    pub(super) fn have(&self, places: &AtSites<'_>) -> bool {
        self.own.places.key == places.key
    }

    /// A number for each particle; empty if a grid cannot be read.
    pub(super) fn values(&self, row: &[f64]) -> Vec<f64> {
        let entry = |at: usize| row.get(at).copied().unwrap_or(f64::NAN);
        let (own, shown) = (&self.own.places.members, &self.own.shown.members);
        if self.own.shown.index == self.own.places.index {
            return shown.iter().map(|(_, c)| entry(c.start)).collect();
        }
        if self.nodes.is_empty() {
            return Vec::new();
        }
        let places = own
            .iter()
            .map(|(_, c)| row.get(c.clone()).unwrap_or_default());
        places.map(|place| self.between(place, &entry)).collect()
    }

    /// Interpolates between the nodes of the cell that contains a position.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn between(&self, place: &[f64], entry: &dyn Fn(usize) -> f64) -> f64 {
        let space = &self.own.space;
        let cells = space.cells.as_deref().unwrap_or_default();
        let mut corners = [[(0, 1.0), (0, 0.0)]; 2];
        let each = place
            .iter()
            .zip(&space.lengths)
            .zip(cells)
            .zip(&space.walls);
        for (corner, (((x, length), n), solid)) in corners.iter_mut().zip(each) {
            let count = (*n).max(1);
            let at = match solid {
                true => x.clamp(0.0, *length),
                false => x.rem_euclid(*length),
            };
            let at = at / length * count as f64;
            let below = (at.floor() as usize).min(count - 1);
            let part = at - below as f64;
            let next = match solid {
                true => below + 1,
                false => (below + 1) % count,
            };
            *corner = [(below, 1.0 - part), (next, part)];
        }
        let [across, up] = corners;
        let mut sum = 0.0;
        for (i, a) in across {
            for (j, b) in up {
                let weight = a * b;
                if weight > 0.0 {
                    let node = self.nodes.get(&[i, j]).copied();
                    sum += weight * node.map_or(f64::NAN, entry);
                }
            }
        }
        sum
    }
}

/// The columns of nodes by their numbers along each direction.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn numbered(space: &Space, shown: &AtSites<'_>) -> Option<HashMap<[usize; 2], usize>> {
    let (nodes, _) = space.nodes().ok()?;
    let cells = space.cells.as_ref()?;
    let number = |node: &[f64], d: usize| {
        let (x, length, n) = (node.get(d)?, space.lengths.get(d)?, cells.get(d)?);
        Some((x / length * *n as f64).round() as usize)
    };
    let each = nodes
        .iter()
        .zip(&shown.members)
        .map(|(node, (_, columns))| {
            let second = number(node, 1).unwrap_or(0);
            Some(([number(node, 0)?, second], columns.start))
        });
    each.collect()
}
