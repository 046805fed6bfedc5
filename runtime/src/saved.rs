//! Saves a running trajectory as words of 64 bits and restores it bit for bit.
//! Takes any value that changes from step to step. Each type lists its parts once, in one order for both directions,
//! so that every saved part is also restored.

use crate::linalg::Dense;
use nalgebra::SMatrix;

/// No list of numbers is longer: the square of the largest number of coordinates is far smaller.
const LONGEST: usize = 1 << 24;

/// The words of a value: read from it, or written to another value of the same kind.
#[derive(Clone, Debug)]
pub struct Words {
    list: Vec<u64>,
    /// The next word to restore; `None` while words are saved.
    next: Option<usize>,
    fits: bool,
}

impl Words {
    /// An empty list, to save a value.
    #[must_use]
    pub fn gathered() -> Self {
        Self {
            list: Vec::new(),
            next: None,
            fits: true,
        }
    }

    /// A list that was saved earlier, to restore a value.
    #[must_use]
    pub fn given(list: Vec<u64>) -> Self {
        Self {
            list,
            next: Some(0),
            fits: true,
        }
    }

    /// Whether these words restore a value.
    #[must_use]
    pub fn are_given(&self) -> bool {
        self.next.is_some()
    }

    /// Saves one word, or replaces it by the saved one.
    pub fn word(&mut self, word: &mut u64) {
        match &mut self.next {
            None => self.list.push(*word),
            Some(at) => {
                match self.list.get(*at) {
                    Some(known) => *word = *known,
                    None => self.fits = false,
                }
                *at += 1;
            }
        }
    }

    /// A word that must agree between the saved value and the restored one: a length, or a kind.
    pub fn same(&mut self, word: u64) {
        let mut known = word;
        self.word(&mut known);
        self.fits &= known == word;
    }

    /// Saves the number of parts that follow, at most `most`; returns the saved number on restoring.
    pub fn count(&mut self, count: usize, most: usize) -> usize {
        let mut word = count as u64;
        self.word(&mut word);
        match usize::try_from(word) {
            Ok(known) if known <= most => known,
            _ => {
                self.refuse();
                count
            }
        }
    }

    /// Reports that this value cannot be saved, or does not accept the saved words.
    pub fn refuse(&mut self) {
        self.fits = false;
    }

    /// The saved words; `None` if a part could not be saved.
    #[must_use]
    pub fn into_list(self) -> Option<Vec<u64>> {
        self.fits.then_some(self.list)
    }

    /// Whether every word was restored.
    #[must_use]
    pub fn all_put(&self) -> bool {
        self.fits && self.next == Some(self.list.len())
    }
}

/// A value that can be saved and restored. Parts that never change along a trajectory are not saved: you restore
/// into a trajectory that was started from the same data, which already has them.
pub trait Saved {
    /// Saves or restores all parts that change, always in the same order.
    fn words(&mut self, words: &mut Words);
}

/// The memory of a search whose tangent does not use the node.
impl Saved for () {
    fn words(&mut self, _: &mut Words) {}
}

impl Saved for f64 {
    fn words(&mut self, words: &mut Words) {
        let mut bits = self.to_bits();
        words.word(&mut bits);
        *self = Self::from_bits(bits);
    }
}

impl Saved for u64 {
    fn words(&mut self, words: &mut Words) {
        words.word(self);
    }
}

impl Saved for u32 {
    fn words(&mut self, words: &mut Words) {
        let mut word = u64::from(*self);
        words.word(&mut word);
        match Self::try_from(word) {
            Ok(known) => *self = known,
            Err(_) => words.refuse(),
        }
    }
}

impl Saved for usize {
    fn words(&mut self, words: &mut Words) {
        *self = words.count(*self, Self::MAX);
    }
}

impl Saved for bool {
    fn words(&mut self, words: &mut Words) {
        *self = words.count(usize::from(*self), 1) == 1;
    }
}

impl<X: Saved, const N: usize> Saved for [X; N] {
    fn words(&mut self, words: &mut Words) {
        self.iter_mut().for_each(|x| x.words(words));
    }
}

macro_rules! tuples {
    ($(($($part:ident $index:tt),*))*) => {
        $(impl<$($part: Saved),*> Saved for ($($part,)*) {
            fn words(&mut self, words: &mut Words) {
                $(self.$index.words(words);)*
            }
        })*
    };
}
tuples!((A 0)(A 0, B 1)(A 0, B 1, C 2)(A 0, B 1, C 2, D 3)(A 0, B 1, C 2, D 3, E 4)(A 0, B 1, C 2, D 3, E 4, F 5));

impl<X: Saved, const R: usize, const C: usize> Saved for SMatrix<X, R, C> {
    fn words(&mut self, words: &mut Words) {
        self.data.0.words(words);
    }
}

/// Numbers of which there may be more or fewer than before.
impl Saved for Vec<f64> {
    fn words(&mut self, words: &mut Words) {
        let count = words.count(self.len(), LONGEST);
        self.resize(count, 0.0);
        self.iter_mut().for_each(|x| x.words(words));
    }
}

impl Saved for Dense<f64> {
    fn words(&mut self, words: &mut Words) {
        self.rows = words.count(self.rows, LONGEST);
        self.cols = words.count(self.cols, LONGEST);
        self.data.words(words);
        if self.rows.checked_mul(self.cols) != Some(self.data.len()) {
            words.refuse();
        }
    }
}

/// Constant data of a trajectory: not saved.
macro_rules! given {
    ($($Type:ty),*) => {
        $(impl Saved for $Type {
            fn words(&mut self, _: &mut Words) {}
        })*
    };
}
given!(
    crate::solvers::Method,
    crate::solvers::moser_veselov::Order,
    core::marker::PhantomData<f64>
);

/// Values at sites, whose number does not change.
#[doc(hidden)]
pub fn sites<X: Saved>(list: &mut [X], words: &mut Words) {
    words.same(list.len() as u64);
    list.iter_mut().for_each(|x| x.words(words));
}

/// A list of values at sites, whose number does not change.
#[doc(hidden)]
pub trait Sites {
    /// All values, in order.
    fn sites(&mut self, words: &mut Words);
}

impl<X: Saved> Sites for Vec<X> {
    fn sites(&mut self, words: &mut Words) {
        sites(self, words);
    }
}

/// [`Saved`](crate::saved::Saved) for the state of a line over plain numbers; all lists of its sites are named. The
/// workspace is rebuilt from it.
#[doc(hidden)]
#[macro_export]
macro_rules! saved_line {
    ($name:ident { $($list:ident),* $(,)? } $($multiplier:ident)*) => {
        impl $crate::saved::Saved for $name<f64> {
            fn words(&mut self, words: &mut $crate::saved::Words) {
                $(
                    $crate::saved::Sites::sites(&mut self.places.$list, words);
                    $crate::saved::Sites::sites(&mut self.momenta.$list, words);
                )*
                $($crate::saved::Sites::sites(&mut self.multipliers.$multiplier, words);)*
                $crate::saved::Saved::words(&mut self.node, words);
                if words.are_given() {
                    self.stamp = $crate::line::Stamp::fresh();
                }
            }
        }
    };
}

/// An optional value. If it is missing but was saved, `blank` creates the value to restore into.
pub(crate) fn optional<X: Saved>(
    value: &mut Option<X>,
    words: &mut Words,
    blank: impl FnOnce() -> Option<X>,
) {
    match (words.count(usize::from(value.is_some()), 1), &value) {
        (0, _) => *value = None,
        (_, None) => *value = blank(),
        _ => {}
    }
    if let Some(value) = value {
        value.words(words);
    }
}

/// [`Saved`](crate::saved::Saved) for a struct over plain numbers, after const parameters in brackets; all fields are
/// named. Emitted for the workspace of every model.
#[doc(hidden)]
#[macro_export]
macro_rules! saved {
    ([$($size:ident)*] $name:ident { $($field:ident),* $(,)? }) => {
        impl<$(const $size: usize),*> $crate::saved::Saved for $name<$($size,)* f64> {
            fn words(&mut self, words: &mut $crate::saved::Words) {
                let Self { $($field),* } = self;
                $($crate::saved::Saved::words($field, words);)*
            }
        }
    };
}
