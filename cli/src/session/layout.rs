//! Which columns of the rows in memory make which array: the arrays of a run's npz, by name. Takes a card; gives each array with its
//! shape and its columns.

use crate::output::arrays::arrays;
use clebsch::card::Card;

/// The columns of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Columns {
    /// The nodes of the samples.
    Nodes,
    /// The times of the samples.
    Times,
    /// Blocks of `size` columns: the first starts at `start`, each next block `step` columns later.
    Blocks {
        /// The first column.
        start: usize,
        /// From a block to the next one.
        step: usize,
        /// Columns of a block.
        size: usize,
        /// How many blocks there are.
        count: usize,
    },
    /// Columns without such an order.
    Listed(Vec<usize>),
    /// Numbers that do not belong to a sample: the sites of an array.
    Sites(Vec<u64>),
}

/// An array of a run.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Its name.
    pub name: String,
    /// Its shape behind the index of the sample.
    pub shape: Vec<usize>,
    /// The columns of its numbers.
    pub columns: Columns,
}

/// Words of a row before its numbers: node and time.
const BEFORE: usize = 2;

/// All arrays of a run, in the order of its npz.
#[must_use]
pub fn layout(card: &Card) -> Vec<Layout> {
    let all = arrays(card, 0);
    let each = all.iter().enumerate().map(|(number, array)| {
        let columns = match (number, array.columns()) {
            (0, _) => Columns::Nodes,
            (1, _) => Columns::Times,
            (_, Err(numbers)) => Columns::Sites(numbers.to_vec()),
            (_, Ok(ranges)) => regular(ranges),
        };
        let shape = match columns {
            Columns::Sites(_) => array.shape(),
            _ => array.shape().get(1..).unwrap_or_default(),
        };
        Layout {
            name: array.name().to_owned(),
            shape: shape.to_vec(),
            columns,
        }
    });
    each.collect()
}

/// Ranges as evenly spaced blocks, if possible.
fn regular(ranges: &[std::ops::Range<usize>]) -> Columns {
    let own = |column: usize| column.saturating_sub(BEFORE);
    let listed = || {
        let all = ranges.iter().flat_map(|range| range.clone().map(own));
        Columns::Listed(all.collect())
    };
    let Some(first) = ranges.first() else {
        return listed();
    };
    let step = ranges.get(1).map_or(first.len(), |second| {
        second.start.saturating_sub(first.start)
    });
    let mut wanted = first.start;
    for range in ranges {
        if range.start != wanted || range.len() != first.len() {
            return listed();
        }
        wanted += step;
    }
    Columns::Blocks {
        start: own(first.start),
        step,
        size: first.len(),
        count: ranges.len(),
    }
}

#[cfg(test)]
mod tests {
    use super::{Columns, regular};

    #[test]
    fn blocks_at_equal_distances_are_told_from_others() {
        assert_eq!(
            regular(&[2..4, 7..9, 12..14]),
            Columns::Blocks {
                start: 0,
                step: 5,
                size: 2,
                count: 3
            }
        );
        assert_eq!(
            regular(&[2..4, 7..9, 11..13]),
            Columns::Listed(vec![0, 1, 5, 6, 9, 10])
        );
        assert_eq!(regular(&[4..5, 2..3]), Columns::Listed(vec![2, 0]));
    }
}
