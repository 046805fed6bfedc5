//! Saves and restores the memory of a search.

use super::{Search, Summary};
use crate::groups::Group;
use crate::saved::{Saved, Words};

impl<G: Group<f64> + Saved, const D: usize, W, const E: usize> Saved for Search<f64, G, D, W, E> {
    fn words(&mut self, words: &mut Words) {
        let Self {
            past,
            newest,
            known,
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
            last,
        } = self;
        past.words(words);
        *newest = words.count(*newest, super::REMEMBERED);
        *known = words.count(*known, super::REMEMBERED);
        next.words(words);
        weights.words(words);
        lengths.words(words);
        shortest.words(words);
        weighed.words(words);
        whole.words(words);
        units.words(words);
        noise.words(words);
        open.words(words);
        measured.words(words);
        factors.words(words);
        unit.words(words);
        age.words(words);
        last.words(words);
    }
}

impl Saved for Summary {
    fn words(&mut self, words: &mut Words) {
        let Self {
            tangents,
            corrections,
            residual,
        } = self;
        tangents.words(words);
        corrections.words(words);
        residual.words(words);
    }
}
