//! The arrays in the npz file of a run. The copies of a quantity at the sites of a label form one array.
//! Takes a card and a number of samples; gives the arrays, whose words are columns of the rows.

use super::sites::at_sites;
use clebsch::card::Card;
use clebsch::record::npz::{self, Array};
use clebsch_core::expr::symbol::ascii;
use std::collections::HashSet;

/// The first column of the observables in a row, after node and time.
const OFFSET: usize = 2;

/// All arrays of a run. A quantity at sites is one array with the site as second index, and replaces its
/// copies.
pub(crate) fn arrays(card: &Card, samples: u64) -> Vec<Array> {
    let at_sites = at_sites(card);
    let members = at_sites.iter().flat_map(|q| &q.members);
    let starts: HashSet<usize> = members.map(|(_, columns)| columns.start).collect();
    let mut from = 0;
    let copies = card.observables.iter().filter_map(|field| {
        let start = from;
        from += field.count();
        starts.contains(&start).then_some(field.ascii)
    });
    let copies: HashSet<&str> = copies.collect();
    let mut arrays = npz::arrays(card, samples);
    arrays.retain(|array| !copies.contains(array.name()));
    for q in at_sites {
        let (rows, cols) = (q.field.rows, q.field.cols);
        let mut shape = vec![q.members.len()];
        shape.extend((rows * cols > 1).then_some(rows));
        shape.extend((cols > 1).then_some(cols));
        let mut members = q.members.iter().enumerate();
        // A value prescribed at the last end is a parameter.
        let behind = format!("{}_{}", ascii(&q.name), q.members.len());
        let whole = members.all(|(i, (site, _))| i == *site)
            && card.parameters.iter().all(|f| f.ascii != behind);
        if !whole {
            // The value at some site is prescribed.
            let numbers = q.members.iter().map(|(site, _)| *site as u64);
            let name = format!("sites_of_{}", q.key);
            arrays.push(Array::of_numbers(&name, numbers.collect()));
        }
        let members = q.members.into_iter();
        let own = members.map(|(_, c)| c.start + OFFSET..c.end + OFFSET);
        arrays.push(Array::of_columns(&q.key, samples, &shape, own.collect()));
    }
    arrays
}

/// One array a column, the first of counts.
pub(crate) fn columns(names: &[String], samples: u64) -> Vec<Array> {
    let array = |(column, name): (usize, &String)| match column {
        0 => Array::of_nodes(name, samples),
        _ => Array::of_columns(
            name,
            samples,
            &[],
            std::iter::once(column..column + 1).collect(),
        ),
    };
    names.iter().enumerate().map(array).collect()
}
