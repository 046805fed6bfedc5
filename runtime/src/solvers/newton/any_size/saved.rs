//! What a search of any size remembers, written down and made again.

use super::{AnySearch, Certificate, Chart, NodeList, NodeValue};
use crate::saved::{Saved, Words, optional};
use crate::solvers::newton::REMEMBERED;

/// Most values of a node that a tangent asks for.
const MOST_VALUES: usize = 1 << 16;

impl<C: Chart> AnySearch<C> {
    /// As [`Saved::words`], the elements of the group by the function given.
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
            weighed,
            certificate,
            factors,
            unit,
            age,
        } = self;
        let known = words.count(past.len(), REMEMBERED);
        past.resize_with(known, || chart.identity());
        past.iter_mut().for_each(|g| element(g, words));
        next.words(words);
        weights.words(words);
        lengths.words(words);
        weighed.words(words);
        certificate.words(words);
        factors.words(words);
        unit.words(words);
        age.words(words);
    }
}

impl Saved for Certificate {
    fn words(&mut self, words: &mut Words) {
        let Self {
            reach,
            node,
            spread,
            inverse,
            factored,
            bounded,
            stale,
            left,
            misses,
            // Steps are made to go on from there.
            purpose: _,
        } = self;
        let blank = || Some(NodeList { values: Vec::new() });
        reach.words(words);
        optional(node, words, blank);
        spread.words(words);
        inverse.words(words);
        optional(factored, words, blank);
        bounded.words(words);
        stale.words(words);
        left.words(words);
        misses.words(words);
    }
}

impl Saved for NodeList {
    fn words(&mut self, words: &mut Words) {
        let count = words.count(self.values.len(), MOST_VALUES);
        let blank = || NodeValue {
            numbers: Vec::new(),
            turn: false,
        };
        self.values.resize_with(count, blank);
        for NodeValue { numbers, turn } in &mut self.values {
            numbers.words(words);
            turn.words(words);
        }
    }
}
