//! Saves and restores the memory of a search of any size.

use super::{AnySearch, Chart};
use crate::linalg::DenseFactors;
use crate::saved::{Saved, Words, optional};
use crate::solvers::newton::REMEMBERED;

impl<C: Chart> AnySearch<C> {
    /// Saves like [`Saved::words`], with a function that saves group elements.
    pub fn words(
        &mut self,
        words: &mut Words,
        chart: &C,
        mut element: impl FnMut(&mut C::Element, &mut Words),
    ) {
        let Self {
            past,
            next,
            weights,
            lengths,
            shortest,
            weighed,
            units,
            noise,
            open,
            measured,
            // Later steps continue from this state.
            tries: _,
            whole,
            factors,
            unit,
            age,
            // Every step overwrites this buffer.
            work: _,
        } = self;
        let known = words.count(past.len(), REMEMBERED);
        past.resize_with(known, || chart.identity());
        past.iter_mut().for_each(|g| element(g, words));
        next.words(words);
        weights.words(words);
        lengths.words(words);
        shortest.words(words);
        weighed.words(words);
        optional(whole, words, || {
            Some((DenseFactors::none(0, true), Vec::new()))
        });
        units.words(words);
        noise.words(words);
        open.words(words);
        measured.words(words);
        factors.words(words);
        unit.words(words);
        age.words(words);
    }
}
