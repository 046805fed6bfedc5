//! Saves and restores a mesh and the solutions extrapolated on it. A resumed trajectory has the same edges in the same
//! order, and therefore continues bit for bit. Takes and gives words; rejects edges that are not a triangulation.

use super::delaunay::Delaunay;
use super::half_edges::{HalfEdges, next};
use super::smoothed::Smoothed;
use super::{Voronoi, pair_core, second_moment, voronoi_area};
use crate::saved::{Saved, Words};

impl Saved for HalfEdges {
    fn words(&mut self, words: &mut Words) {
        let count = words.count(self.len(), u32::MAX as usize);
        self.origin.resize(count, 0);
        self.twin.resize(count, 0);
        self.offset.resize(count, [0; 2]);
        let sides = self.origin.iter_mut().zip(&mut self.twin);
        for ((origin, twin), offset) in sides.zip(&mut self.offset) {
            let mut ends = u64::from(*origin) | u64::from(*twin) << 32;
            words.word(&mut ends);
            (*origin, *twin) = (ends as u32, (ends >> 32) as u32);
            let [x, y] = offset.map(|k| u64::from(k as u16));
            let mut periods = x | y << 16;
            words.word(&mut periods);
            *offset = [periods as i16, (periods >> 16) as i16];
        }
    }
}

impl HalfEdges {
    /// Whether these half-edges form a triangulated torus, or are empty.
    fn fit(&self, sites: usize) -> bool {
        let count = self.len();
        if count == 0 {
            return true;
        }
        let mut met = vec![false; sites];
        let good = count == 6 * sites
            && (0..count).all(|e| {
                let twin = self.twin[e] as usize;
                let known = (self.origin[e] as usize) < sites && twin < count;
                if known {
                    met[self.origin[e] as usize] = true;
                }
                known
                    && self.twin[twin] as usize == e
                    && self.origin[twin] == self.origin[next(e)]
                    && (0..2).all(|k| {
                        let around =
                            [e, next(e), next(next(e))].map(|e| i32::from(self.offset[e][k]));
                        let back = i32::from(self.offset[twin][k]);
                        around.iter().sum::<i32>() == 0 && around[0] + back == 0
                    })
            });
        good && met.iter().all(|&met| met)
    }
}

impl Saved for Delaunay {
    fn words(&mut self, words: &mut Words) {
        self.edges.words(words);
        self.turns.iter_mut().for_each(|turns| turns.words(words));
        self.counted.flips.words(words);
        self.counted.rebuilds.words(words);
        if words.are_given() && !self.edges.fit(self.sites()) {
            self.edges = HalfEdges::default();
            words.refuse();
        }
    }
}

impl Saved for Voronoi<f64> {
    fn words(&mut self, words: &mut Words) {
        self.delaunay.words(words);
    }
}

impl Saved for voronoi_area<f64> {
    fn words(&mut self, words: &mut Words) {
        self.mesh.words(words);
    }
}

impl Saved for second_moment<f64> {
    fn words(&mut self, words: &mut Words) {
        self.mesh.words(words);
    }
}

impl<O, const TIMES: usize> Saved for Smoothed<f64, O, TIMES> {
    fn words(&mut self, words: &mut Words) {
        self.mesh.words(words);
        self.at.iter_mut().for_each(|at| at.words(words));
        for depth in &mut self.depths {
            for solution in &mut depth.solutions {
                solution.iter_mut().for_each(|x| x.words(words));
            }
            depth.solved = words.count(depth.solved, depth.solutions.len());
        }
        if words.are_given() {
            self.ready = false;
        }
    }
}

/// Nothing is stored between evaluations.
impl Saved for pair_core<f64> {
    fn words(&mut self, _: &mut Words) {}
}
