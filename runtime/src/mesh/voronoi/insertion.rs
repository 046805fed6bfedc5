//! Builds a Delaunay triangulation: inserts the sites one by one into the triangulation of a torus with a single site.
//! Takes positions; gives half-edges, numbered in the order of the sites. The sites are inserted in random rounds of
//! doubling size, and within a round along a space-filling curve (Amenta, Choi and Rote, 2003). The expected work is
//! then proportional to the number of sites. The order depends only on the numbers and positions of the sites.

use super::delaunay::Delaunay;
use super::half_edges::{next, previous};
use super::predicates::turn;
use super::torus::Grains;
use crate::mesh::MeshError;

/// The largest distance in periods. Beyond it, a position has fewer than six digits within one period.
const FARTHEST: f64 = 1e9;

impl Delaunay {
    /// Recomputes the whole periods of every site.
    pub(super) fn begin(&mut self, at: &impl Fn(usize) -> [f64; 2]) -> Result<(), MeshError> {
        let lengths = self.torus.lengths;
        for site in 0..self.sites() {
            let x = at(site);
            let turns: [f64; 2] = core::array::from_fn(|k| (x[k] / lengths[k]).floor());
            let local: [f64; 2] = core::array::from_fn(|k| x[k] - turns[k] * lengths[k]);
            if !(local[0].is_finite() && local[1].is_finite()) {
                return Err(MeshError::NotFinite { site });
            }
            let periods = turns[0].abs().max(turns[1].abs());
            if periods > FARTHEST {
                return Err(MeshError::TooFar { site, periods });
            }
            self.turns[site] = turns;
            self.places[site] = self.torus.place(local);
        }
        Ok(())
    }

    /// Inserts all sites.
    pub(super) fn insert_all(&mut self) -> Result<(), MeshError> {
        self.counted.rebuilds += 1;
        let flips = self.counted.flips;
        let order = self.order();
        let Some(&first) = order.first() else {
            return Ok(());
        };
        self.suspects.clear();
        self.edges.with_one_site(first);
        let triangles = 2 * self.sites();
        self.edges.origin.reserve(3 * triangles);
        self.edges.twin.reserve(3 * triangles);
        self.edges.offset.reserve(3 * triangles);
        let mut near = 0;
        for &site in &order[1..] {
            near = self.insert(site, near)?;
        }
        self.edges.sort_by_sites(self.sites());
        self.counted.flips = flips;
        // No edge needs a flip, but flat triangles must still be found.
        self.find_suspects();
        self.repair()
    }

    /// Inserts a site; the search starts at half-edge `near`. Returns a half-edge close to the site.
    fn insert(&mut self, site: u32, near: usize) -> Result<usize, MeshError> {
        let (e, to_site) = self.locate(site, near)?;
        let corners = [e, next(e), next(next(e))];
        let edges = corners.map(|e| self.edge(e));
        let second = less(to_site, edges[0]);
        let to_site = [to_site, second, less(second, edges[1])];
        let on = [0, 1, 2].map(|k| turn(edges[k], to_site[k]) == 0.0);
        let place = self.places[site as usize];
        let offsets = [0, 1, 2].map(|k| {
            let corner = self.places[self.edges.origin[corners[k]] as usize];
            let apart = less(place, corner);
            self.torus.periods_between(apart, to_site[k])
        });
        if let Some(k) = (0..3).find(|&k| to_site[k] == [0.0; 2]) {
            let other = self.edges.origin[corners[k]] as usize;
            return Err(MeshError::Coincident {
                first: other.min(site as usize),
                second: other.max(site as usize),
            });
        }
        // Reorders the offsets to start at the first half-edge of the triangle.
        let turned = e % 3;
        let rotated = |k: usize| (k + 3 - turned) % 3;
        let offsets = [0, 1, 2].map(|k| offsets[rotated(k)]);
        let on = [0, 1, 2].map(|k| on[rotated(k)]);
        let sides = self.edges.divide(e / 3, site, offsets);
        self.suspects.extend(sides.map(|e| e as u32));
        if let Some(k) = on.iter().position(|&on| on) {
            // The site is on this side, so the new triangle there is flat. One flip divides the adjacent triangle too.
            self.flip(sides[k]);
        }
        // Edges of the new site are tested as well, because other copies of it may be close on a torus.
        while let Some(e) = self.suspects.pop() {
            if self.is_bad(e as usize) {
                self.flip(e as usize);
            }
        }
        Ok(e)
    }

    /// A half-edge of the triangle that contains the site, and the vector from its origin to the site.
    fn locate(&self, site: u32, near: usize) -> Result<(usize, Grains), MeshError> {
        let place = self.places[site as usize];
        let mut e = near;
        let mut to_site = {
            let apart = less(place, self.places[self.edges.origin[e] as usize]);
            let periods = self.torus.periods_between([0.0; 2], apart);
            let [x, y] = self.torus.periods;
            less(
                apart,
                [f64::from(periods[0]) * x, f64::from(periods[1]) * y],
            )
        };
        let mut inside = 0;
        // In a Delaunay triangulation, a walk towards a site visits no triangle twice.
        for _ in 0..4 * self.edges.len() {
            let edge = self.edge(e);
            if turn(edge, to_site) < 0.0 {
                // The vector from the other end of the edge, where its twin starts.
                to_site = less(to_site, edge);
                e = self.edges.twin[e] as usize;
                inside = 1;
            } else {
                inside += 1;
            }
            if inside == 3 {
                return Ok((e, to_site));
            }
            to_site = less(to_site, self.edge(e));
            e = next(e);
        }
        Err(MeshError::Coincident {
            first: self.edges.origin[previous(e)] as usize,
            second: site as usize,
        })
    }

    /// The order of insertion.
    fn order(&self) -> Vec<u32> {
        let [width, height] = self.torus.periods;
        let cells = f64::from(CURVE);
        let mut keyed: Vec<(u64, u32)> = (0..self.sites() as u32)
            .map(|site| {
                let [x, y] = self.places[site as usize];
                let cell = |x: f64, width: f64| (x / width * cells) as u32 & (CURVE - 1);
                let round = u64::from(63 - scrambled(site).trailing_zeros().min(31));
                let along = along_curve(cell(x, width), cell(y, height));
                ((round << 32) | u64::from(along), site)
            })
            .collect();
        keyed.sort_unstable();
        keyed.into_iter().map(|(_, site)| site).collect()
    }
}

/// The number of cells of the curve along each direction.
const CURVE: u32 = 1 << 16;

fn less(a: Grains, b: Grains) -> Grains {
    [a[0] - b[0], a[1] - b[1]]
}

/// Mixes the bits of a number (Steele, Lea and Flood, 2014).
fn scrambled(site: u32) -> u64 {
    let z = u64::from(site).wrapping_add(0x9e37_79b9_7f4a_7c15);
    let z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}

/// The index of a cell along Hilbert's curve.
fn along_curve(mut x: u32, mut y: u32) -> u32 {
    let mut along = 0;
    let mut half = CURVE / 2;
    while half > 0 {
        let (right, up) = (u32::from(x & half != 0), u32::from(y & half != 0));
        along = (along << 2) | ((3 * right) ^ up);
        if up == 0 {
            if right == 1 {
                x = !x;
                y = !y;
            }
            core::mem::swap(&mut x, &mut y);
        }
        half /= 2;
    }
    along
}
