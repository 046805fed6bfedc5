//! The Delaunay triangulation of sites on a torus. Insertion builds it; edge flips update it as the sites move (Lawson,
//! 1977; on flat surfaces Indermitte, Liebling, Troyanov and Clemencon, 2001). If a triangle has turned over, the
//! triangulation is rebuilt. Takes positions; gives half-edges. The torus is never cut or copied, and a single site
//! needs no special case.

use super::half_edges::{HalfEdges, next, previous};
use super::predicates::{in_circle, turn};
use super::torus::{Grains, Torus};
use crate::line::Threads;
use crate::mesh::MeshError;

/// If a site is at least this many periods from its reference position, its whole periods are recomputed.
const FAR: f64 = 2.0;

/// The smallest height of a triangle, in grains. Below it, angles are accurate to less than three digits.
const THINNEST: f64 = 2048.0;

/// The largest offset that can be updated; beyond it, the triangulation is rebuilt.
const LARGEST_OFFSET: f64 = 4096.0;

/// A Delaunay triangulation that follows its sites.
#[derive(Clone, Debug)]
pub(super) struct Delaunay {
    pub torus: Torus,
    /// The half-edges; empty before the first update.
    pub edges: HalfEdges,
    /// The whole periods subtracted from each site.
    pub turns: Vec<[f64; 2]>,
    pub(super) places: Vec<Grains>,
    pub(super) suspects: Vec<u32>,
    /// The numbers of flips and rebuilds since the first update.
    pub counted: Counted,
    /// The number of threads that look for suspect edges.
    pub threads: Threads,
}

/// The work done to follow the motion of the sites.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counted {
    /// The number of edge flips.
    pub flips: u64,
    /// The number of rebuilds, including the first construction.
    pub rebuilds: u64,
}

impl Delaunay {
    /// An empty triangulation for this number of sites.
    pub fn new(torus: Torus, sites: usize) -> Self {
        Self {
            torus,
            edges: HalfEdges::default(),
            turns: vec![[0.0; 2]; sites],
            places: vec![[0.0; 2]; sites],
            suspects: Vec::new(),
            counted: Counted::default(),
            threads: Threads::ONE,
        }
    }

    /// The number of sites.
    pub fn sites(&self) -> usize {
        self.places.len()
    }

    /// The vector of a half-edge, in grains.
    #[inline(always)]
    pub(super) fn edge(&self, e: usize) -> Grains {
        let from = self.places[self.edges.origin[e] as usize];
        let to = self.places[self.edges.target(e)];
        self.torus.between(from, to, self.edges.offset[e])
    }

    /// Updates the triangulation to new positions, which need not be wrapped.
    pub fn follow(&mut self, at: impl Fn(usize) -> [f64; 2]) -> Result<(), MeshError> {
        let kept = !self.edges.origin.is_empty() && self.place(&at)? && self.find_suspects();
        if kept {
            return self.repair();
        }
        let made = self.begin(&at).and_then(|()| self.insert_all());
        if made.is_err() {
            // Discards the unfinished update.
            self.edges = HalfEdges::default();
        }
        made
    }

    /// Moves the sites to their new positions; returns whether the edges are still valid.
    fn place(&mut self, at: &impl Fn(usize) -> [f64; 2]) -> Result<bool, MeshError> {
        let lengths = self.torus.lengths;
        let mut far = false;
        for (site, (place, turns)) in self.places.iter_mut().zip(&self.turns).enumerate() {
            let local: [f64; 2] = {
                let x = at(site);
                core::array::from_fn(|k| x[k] - turns[k] * lengths[k])
            };
            if !(local[0].is_finite() && local[1].is_finite()) {
                return Err(MeshError::NotFinite { site });
            }
            far |= (0..2).any(|k| local[k].abs() >= FAR * lengths[k]);
            *place = self.torus.place(local);
        }
        Ok(!far || self.count_anew(at))
    }

    /// Recomputes the whole periods of all sites and the offsets of their edges. Returns false if an offset would be
    /// too large.
    fn count_anew(&mut self, at: &impl Fn(usize) -> [f64; 2]) -> bool {
        let lengths = self.torus.lengths;
        let beyond = |offset: &f64| offset.abs() > LARGEST_OFFSET;
        let by: Vec<[f64; 2]> = (0..self.sites())
            .map(|site| {
                let (x, turns) = (at(site), self.turns[site]);
                core::array::from_fn(|k| (x[k] / lengths[k] - turns[k]).floor())
            })
            .collect();
        if by.as_flattened().iter().any(beyond) {
            return false;
        }
        for e in 0..self.edges.len() {
            let (from, to) = (self.edges.origin[e] as usize, self.edges.target(e));
            let old = self.edges.offset[e];
            let new: [f64; 2] =
                core::array::from_fn(|k| f64::from(old[k]) + by[to][k] - by[from][k]);
            if new.iter().any(beyond) {
                return false;
            }
            self.edges.offset[e] = new.map(|offset| offset as i16);
        }
        for (site, by) in by.iter().enumerate() {
            let x = at(site);
            let turns = &mut self.turns[site];
            *turns = [turns[0] + by[0], turns[1] + by[1]];
            let local = core::array::from_fn(|k| x[k] - turns[k] * lengths[k]);
            self.places[site] = self.torus.place(local);
        }
        true
    }

    /// Collects the edges that are not Delaunay; returns whether every triangle is still counterclockwise.
    pub(super) fn find_suspects(&mut self) -> bool {
        let mut suspects = core::mem::take(&mut self.suspects);
        suspects.clear();
        let all = 0..self.edges.len() / 3;
        let left = self
            .threads
            .collect(all, &mut suspects, |triangles, found| {
                triangles.into_iter().all(|t| self.suspect(3 * t, found))
            });
        self.suspects = suspects;
        left
    }

    /// Collects the edges of a triangle that are not Delaunay, and one edge if the triangle is flat. Returns whether it
    /// is counterclockwise.
    #[inline(always)]
    fn suspect(&self, e: usize, found: &mut Vec<u32>) -> bool {
        let (first, second) = (self.edge(e), self.edge(e + 1));
        let twice_area = turn(first, second);
        if twice_area <= 0.0 {
            return false;
        }
        if flat(twice_area, first, second) {
            found.extend([e as u32]);
        }
        let third = [-first[0] - second[0], -first[1] - second[1]];
        let sides = [first, second, third];
        for (k, &side) in sides.iter().enumerate() {
            let twin = self.edges.twin[e + k] as usize;
            let before = sides[(k + 2) % 3];
            if e + k < twin && in_circle(side, [-before[0], -before[1]], self.edge(next(twin))) {
                found.push((e + k) as u32);
            }
        }
        true
    }

    /// Whether the circumcircle of an edge's triangle contains the opposite site of the adjacent triangle.
    pub(super) fn is_bad(&self, e: usize) -> bool {
        let before = self.edge(previous(e));
        let across = self.edge(next(self.edges.twin[e] as usize));
        in_circle(self.edge(e), [-before[0], -before[1]], across)
    }

    /// Flips collected edges and collects the edges around them, until all are Delaunay. This terminates, because each
    /// flip lowers the lifted surface.
    pub(super) fn repair(&mut self) -> Result<(), MeshError> {
        let mut flat = false;
        while let Some(e) = self.suspects.pop() {
            let e = e as usize;
            if self.is_bad(e) {
                self.flip(e);
            } else {
                flat |= self.is_flat(e / 3);
            }
        }
        if !flat {
            return Ok(());
        }
        // A later flip may have removed the flat triangle found above.
        match (0..self.edges.len() / 3).find(|&t| self.is_flat(t)) {
            None => Ok(()),
            Some(t) => {
                let sites = [0, 1, 2].map(|k| self.edges.origin[3 * t + k] as usize);
                Err(MeshError::Flat { sites })
            }
        }
    }

    /// Flips an edge and collects the four edges around it.
    pub(super) fn flip(&mut self, e: usize) {
        self.counted.flips += 1;
        let around = self.edges.flip(e);
        self.suspects.extend(around.map(|e| e as u32));
    }

    /// Whether the shape of a triangle is at rounding level.
    fn is_flat(&self, t: usize) -> bool {
        let (first, second) = (self.edge(3 * t), self.edge(3 * t + 1));
        flat(turn(first, second), first, second)
    }
}

/// Whether a triangle with this doubled area is too thin for its side lengths, each of which is accurate to half a
/// grain.
#[inline(always)]
fn flat(twice_area: f64, first: Grains, second: Grains) -> bool {
    let reach = first[0].abs() + first[1].abs() + second[0].abs() + second[1].abs();
    twice_area <= THINNEST * reach
}
