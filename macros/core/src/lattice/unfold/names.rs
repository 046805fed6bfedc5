//! Names of the expanded model: the copies of quantities, and names of invariants in terms of stated quantities.

use super::ExpandedModel;
use crate::expr::symbol::ascii;
use crate::lattice::declared::{Lattice, Sites};
use crate::lattice::names::Copied;

impl ExpandedModel {
    /// The largest distance between the letters of one term, in sites.
    pub fn width(&self) -> usize {
        self.summands.iter().map(|s| s.width).max().unwrap_or(0)
    }

    /// The name of an invariant with stated names instead of copies, its words separated.
    pub fn plain(&self, name: &str) -> String {
        let mut words: Vec<&str> = Vec::new();
        let mut rest = name;
        while !rest.is_empty() {
            // A position after `about` is named even if the rotating copies were named before.
            let place = words.last() == Some(&"about");
            match self.copied(rest) {
                Some((word, behind, copy)) => {
                    if place || !copy || !words.contains(&word) {
                        words.push(word);
                    }
                    rest = behind;
                }
                None => {
                    let (word, behind) = rest.split_once('_').unwrap_or((rest, ""));
                    words.push(word);
                    rest = behind;
                }
            }
        }
        words.join(" ")
    }

    /// Splits a name that begins with a copy or a parameter of an end: the declared name, the rest, and whether it is
    /// a copy. Names may contain underscores, so the longest match is used.
    fn copied<'n>(&self, name: &'n str) -> Option<(&'n str, &'n str, bool)> {
        let sited = |of: &str| {
            let behind = name.strip_prefix(of)?.strip_prefix('_')?;
            let (site, behind) = behind.split_once('_').unwrap_or((behind, ""));
            site.parse::<usize>().ok()?;
            Some((name.get(..of.len())?, behind))
        };
        let end = self.end_parameters.iter().find_map(|(own, ..)| {
            let own = ascii(own);
            let behind = name.strip_prefix(own.as_str())?;
            let behind = match behind.is_empty() {
                true => behind,
                false => behind.strip_prefix('_')?,
            };
            let stem = own.rsplit_once('_')?.0;
            Some((name.get(..stem.len())?, behind, false))
        });
        let copies = self.copies.iter().filter_map(|c| {
            let (word, behind) = sited(&ascii(&c.of)).or_else(|| sited(&c.of))?;
            Some((word, behind, true))
        });
        end.or_else(|| copies.max_by_key(|(word, ..)| word.len()))
    }

    /// The copy with this name.
    pub fn copy(&self, name: &str) -> Option<&Copied> {
        self.copies.iter().find(|c| c.name == name)
    }

    /// Whether a quantity is at the segments of a chain.
    pub fn is_segment(lattice: &Lattice, of: &str) -> bool {
        lattice.find(of).is_some_and(|q| q.sites == Sites::Segments)
    }
}
