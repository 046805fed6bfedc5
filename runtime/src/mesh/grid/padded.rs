//! A grid with a margin around its nodes, so that splines near an end need no special case. Each point of the margin is
//! the image of a node, around a period or behind a wall. Folding adds the sums of the margin to the nodes, and the
//! transposed map copies the nodes to the margin. Walls need no image particles.

use super::nodes::Nodes;
use crate::Real;

/// Values at the nodes of a grid and in a margin around them; rows along the last direction are contiguous.
#[derive(Clone, Debug)]
pub(super) struct Padded<T, const D: usize> {
    places: Vec<T>,
    /// The node that belongs to each padded point along a direction.
    images: [Vec<usize>; D],
    /// Nodes along each direction.
    nodes: [usize; D],
    margin: usize,
    /// Reciprocal weights of nodes.
    inverse: Vec<T>,
}

impl<T: Real, const D: usize> Padded<T, D> {
    /// Room for splines of support `K` on every interval.
    pub fn new<const K: usize>(nodes: &Nodes<D>) -> Self {
        let margin = K / 2 - 1;
        let images = nodes.axes().map(|axis| {
            let places = axis.intervals() - 1 + K;
            (0..places).map(|p| axis.image(p, margin)).collect()
        });
        let count = images.iter().map(|along: &Vec<usize>| along.len());
        let inverse = nodes.weights::<T>().into_iter().map(|w| T::one() / w);
        Self {
            places: vec![T::zero(); count.product()],
            images,
            nodes: nodes.axes().map(|axis| axis.nodes()),
            margin,
            inverse: inverse.collect(),
        }
    }

    /// Length of a row; 1 in one dimension.
    #[inline(always)]
    pub fn width(&self) -> usize {
        match D {
            1 => 1,
            _ => self.images[D - 1].len(),
        }
    }

    /// All values, row by row.
    #[inline(always)]
    pub fn places(&self) -> &[T] {
        &self.places
    }

    /// All values, set to zero as the start of sums.
    pub fn cleared(&mut self) -> &mut [T] {
        self.places.fill(T::zero());
        &mut self.places
    }

    /// The points of the margin along a direction, each with its node.
    fn ghosts(&self, d: usize) -> impl Iterator<Item = (usize, usize)> + use<'_, T, D> {
        let inside = self.margin..self.margin + self.nodes[d];
        let all = self.images[d].iter().enumerate();
        let outside = all.filter(move |(place, _)| !inside.contains(place));
        outside.map(|(place, image)| (place, self.margin + image))
    }

    /// Adds the values of the margin to the nodes; returns the sum at each node divided by its weight.
    pub fn fold(&mut self, out: &mut [T]) {
        let (width, margin) = (self.width(), self.margin);
        let mut places = core::mem::take(&mut self.places);
        for (from, to) in self.ghosts(0) {
            for column in 0..width {
                let more = places[from * width + column];
                places[to * width + column] += more;
            }
        }
        let rows = places.chunks_exact_mut(width).skip(margin);
        if D == 1 {
            let all = rows.zip(out).zip(&self.inverse);
            all.for_each(|((row, out), inverse)| *out = row[0] * *inverse);
        } else {
            let ghosts: Vec<_> = self.ghosts(D - 1).collect();
            let count = self.nodes[D - 1];
            let nodes = out
                .chunks_exact_mut(count)
                .zip(self.inverse.chunks_exact(count));
            for (row, (out, inverse)) in rows.zip(nodes) {
                for (from, to) in &ghosts {
                    let more = row[*from];
                    row[*to] += more;
                }
                let all = row.iter().skip(margin).zip(out).zip(inverse);
                all.for_each(|((sum, out), inverse)| *out = *sum * *inverse);
            }
        }
        self.places = places;
    }

    /// The transpose of [`Padded::fold`]: `seed` at nodes, each divided by its weight, with copies in the margin.
    pub fn extend(&mut self, seed: &[T]) {
        let (width, margin) = (self.width(), self.margin);
        let mut places = core::mem::take(&mut self.places);
        let rows = places.chunks_exact_mut(width).skip(margin);
        if D == 1 {
            let all = rows.zip(seed).zip(&self.inverse);
            all.for_each(|((row, seed), inverse)| row[0] = *seed * *inverse);
        } else {
            let ghosts: Vec<_> = self.ghosts(D - 1).collect();
            let count = self.nodes[D - 1];
            let nodes = seed
                .chunks_exact(count)
                .zip(self.inverse.chunks_exact(count));
            for (row, (seed, inverse)) in rows.zip(nodes) {
                let all = row.iter_mut().skip(margin).zip(seed).zip(inverse);
                all.for_each(|((place, seed), inverse)| *place = *seed * *inverse);
                for (to, from) in &ghosts {
                    row[*to] = row[*from];
                }
            }
        }
        for (to, from) in self.ghosts(0) {
            places.copy_within(from * width..(from + 1) * width, to * width);
        }
        self.places = places;
    }
}
