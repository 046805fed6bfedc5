//! The trajectory as CSV: a header, then one line per sample. Takes the rows of a run; writes numbers in the shortest
//! form that parses to the same f64.

use super::{Rows, names};
use crate::card::Card;
use std::io::{self, Write};

/// Writes node, time, observables and invariants of every sample.
///
/// # Errors
/// Errors of `file`, and of the rows.
pub fn write(file: &mut dyn Write, card: &Card, rows: &dyn Rows) -> io::Result<()> {
    write!(file, "node,time")?;
    for name in names::columns(card) {
        write!(file, ",{name}")?;
    }
    writeln!(file)?;
    rows.each(&mut |row| {
        let Some((node, numbers)) = row.split_first() else {
            return Ok(());
        };
        write!(file, "{node}")?;
        for number in numbers {
            write!(file, ",{:?}", f64::from_bits(*number))?;
        }
        writeln!(file)
    })
}
