//! Saves and restores the trajectory of a free body.

use super::Free;
use crate::Rotation;
use crate::saved::{Saved, Words, optional};

impl Saved for Free<f64> {
    fn words(&mut self, words: &mut Words) {
        let Self {
            axes,
            orbit,
            pencil,
            body,
            frame,
            turned,
            until_projection,
            projects,
            compensation,
            corrected,
            attitude,
            momentum,
            h,
            // These are options.
            order: _,
            method: _,
            given,
            square,
            per_square,
            energy,
            per_scale,
            phase,
        } = self;
        axes.words(words);
        orbit.words(words);
        pencil.words(words);
        body.words(words);
        frame.words(words);
        turned.words(words);
        until_projection.words(words);
        projects.words(words);
        optional(compensation, words, || Some((Rotation::identity(), 0)));
        corrected.words(words);
        attitude.words(words);
        momentum.words(words);
        h.words(words);
        given.words(words);
        [square, per_square, energy, per_scale]
            .into_iter()
            .for_each(|x| x.words(words));
        phase.words(words);
    }
}
