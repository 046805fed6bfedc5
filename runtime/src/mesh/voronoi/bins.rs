//! Sorts particles into the squares of a grid to find near neighbours. Takes positions on a torus; gives, for each
//! particle, the candidates in its own square and the eight around it, in an order that depends only on the positions.

use crate::mesh::MeshError;

/// A grid of squares that are at least one radius wide.
#[derive(Clone, Debug)]
pub(super) struct Bins {
    lengths: [f64; 2],
    count: [u32; 2],
    /// The first particle of each square, and the end of the last square.
    start: Vec<u32>,
    /// The particles, ordered by square.
    sorted: Vec<u32>,
    /// The square of every particle, and the whole periods subtracted from its position.
    square: Vec<[u32; 2]>,
    turns: Vec<[f64; 2]>,
}

impl Bins {
    /// A grid for a radius of at most half of either period. For small radii, the number of squares stays proportional
    /// to the number of particles.
    pub fn new(lengths: [f64; 2], radius: f64, particles: usize) -> Self {
        let spacing = (lengths[0] * lengths[1] / particles as f64).sqrt();
        let width = radius.max(0.5 * spacing);
        let count = lengths.map(|length| ((length / width).floor() as u32).max(1));
        Self {
            lengths,
            count,
            start: vec![0; count[0] as usize * count[1] as usize + 1],
            sorted: vec![0; particles],
            square: vec![[0; 2]; particles],
            turns: vec![[0.0; 2]; particles],
        }
    }

    /// The number of particles.
    pub fn particles(&self) -> usize {
        self.square.len()
    }

    fn number(&self, [i, j]: [u32; 2]) -> usize {
        j as usize * self.count[0] as usize + i as usize
    }

    /// Sorts the particles.
    pub fn sort(&mut self, at: impl Fn(usize) -> [f64; 2]) -> Result<(), MeshError> {
        self.start.fill(0);
        for site in 0..self.particles() {
            let x = at(site);
            if !(x[0].is_finite() && x[1].is_finite()) {
                return Err(MeshError::NotFinite { site });
            }
            for (k, &x) in x.iter().enumerate() {
                let along = x / self.lengths[k];
                let turns = along.floor();
                let share = along - turns;
                self.turns[site][k] = turns;
                let count = self.count[k];
                self.square[site][k] = ((share * f64::from(count)) as u32).min(count - 1);
            }
            let number = self.number(self.square[site]);
            self.start[number] += 1;
        }
        let mut before = 0;
        for start in &mut self.start {
            before += *start;
            *start = before;
        }
        for site in (0..self.particles()).rev() {
            let number = self.number(self.square[site]);
            self.start[number] -= 1;
            self.sorted[self.start[number] as usize] = site as u32;
        }
        Ok(())
    }

    /// Calls `call` for every other particle in the squares around a particle, with the shift by whole periods, as a
    /// length, that moves it to the nearby copy.
    #[inline]
    pub fn near(
        &self,
        site: usize,
        mut call: impl FnMut(usize, [f64; 2]) -> Result<(), MeshError>,
    ) -> Result<(), MeshError> {
        let own = self.square[site];
        let mut visit = |first: [u32; 2], squares: usize, periods: [f64; 2]| {
            let number = self.number(first);
            let range = self.start[number] as usize..self.start[number + squares] as usize;
            let turns: [f64; 2] = core::array::from_fn(|k| self.turns[site][k] + periods[k]);
            for &other in &self.sorted[range] {
                let other = other as usize;
                if other != site {
                    let shift = |k: usize| (turns[k] - self.turns[other][k]) * self.lengths[k];
                    call(other, [shift(0), shift(1)])?;
                }
            }
            Ok(())
        };
        for j in -1..=1 {
            if own[0] > 0 && own[0] + 1 < self.count[0] {
                // Three consecutive squares of a row are adjacent in the list.
                let (first, periods) = self.neighbour(own, [-1, j]);
                visit(first, 3, periods)?;
            } else {
                for i in -1..=1 {
                    let (square, periods) = self.neighbour(own, [i, j]);
                    visit(square, 1, periods)?;
                }
            }
        }
        Ok(())
    }

    /// The square next to another, and the periods between the two copies. If there are only one or two squares along a
    /// direction, the same square is visited from several sides, as different copies. At most one copy of a particle is
    /// within a radius of half a period.
    fn neighbour(&self, own: [u32; 2], by: [i64; 2]) -> ([u32; 2], [f64; 2]) {
        let mut square = own;
        let mut periods = [0.0; 2];
        for k in 0..2 {
            let count = i64::from(self.count[k]);
            let mut next = i64::from(own[k]) + by[k];
            if next < 0 {
                (next, periods[k]) = (next + count, -1.0);
            } else if next >= count {
                (next, periods[k]) = (next - count, 1.0);
            }
            square[k] = next as u32;
        }
        (square, periods)
    }
}
