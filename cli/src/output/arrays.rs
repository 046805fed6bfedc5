//! Which arrays a run's npz has: those of the card, the copies of one quantity at the sites of a label as one array.
//! Takes a card and a number of samples; gives the arrays, whose words are columns of the rows.

use super::sites::at_sites;
use clebsch::card::Card;
use clebsch::record::invariant_name;
use clebsch::record::npz::{Array, shape};
use std::collections::HashSet;
use std::ops::Range;

/// Where the observables begin in a row, after node and time.
const OFFSET: usize = 2;

/// All arrays of a run: `node`, `time`, the observables, the invariants, quantities at sites with the site as their
/// second index.
pub(super) fn arrays(card: &Card, samples: u64) -> Vec<Array> {
    let all = |range: Range<usize>| vec![range];
    let mut arrays = vec![
        Array::of_nodes("node", samples),
        Array::of_columns("time", samples, &[], all(1..OFFSET)),
    ];
    let at_sites = at_sites(card);
    let of_sites = at_sites.iter().flat_map(|q| &q.members);
    let of_sites: HashSet<usize> = of_sites.map(|(_, c)| c.start).collect();
    let mut from = OFFSET;
    for field in card.observables {
        let here = from..from + field.count();
        from = here.end;
        if !of_sites.contains(&(here.start - OFFSET)) {
            let shape = shape(field.rows, field.cols);
            arrays.push(Array::of_columns(field.ascii, samples, &shape, all(here)));
        }
    }
    for invariant in card.invariants {
        let here = from..from + invariant.rows;
        from = here.end;
        let (name, shape) = (invariant_name(invariant), shape(invariant.rows, 1));
        arrays.push(Array::of_columns(&name, samples, &shape, all(here)));
    }
    for q in at_sites {
        let (rows, cols) = (q.field.rows, q.field.cols);
        let mut shape = vec![q.members.len()];
        shape.extend((rows * cols > 1).then_some(rows));
        shape.extend((cols > 1).then_some(cols));
        let mut members = q.members.iter().enumerate();
        let whole = members.all(|(i, (site, _))| i == *site);
        if !whole {
            // Some site has its value given.
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
