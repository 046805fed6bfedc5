//! The trajectory as CSV: a header, then one line per sample.
//! Takes a record; writes numbers in the shortest form that reads back to the same f64.

use super::names;
use crate::record::Record;
use clebsch::card::Card;
use std::io::{self, Write};

/// Writes node, time, observables and invariants of every sample.
///
/// # Errors
/// Those of `file`.
pub(super) fn write(file: &mut dyn Write, card: &Card, record: &Record) -> io::Result<()> {
    write!(file, "node,time")?;
    for name in names::columns(card) {
        write!(file, ",{name}")?;
    }
    writeln!(file)?;
    let mut observables = record.observables.rows();
    let mut invariants = record.invariants.rows();
    for (node, time) in record.nodes.iter().zip(&record.times) {
        write!(file, "{node},{time:?}")?;
        let row = observables.next().unwrap_or_default();
        for number in row.iter().chain(invariants.next().unwrap_or_default()) {
            write!(file, ",{number:?}")?;
        }
        writeln!(file)?;
    }
    Ok(())
}
