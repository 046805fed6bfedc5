//! Names of arrays and columns in files: ASCII, invariants marked as such.
//! Takes fields and invariants; gives names such as `Gamma_3`, `Lambda_12`, `invariant_energy`.

use crate::card::{Card, Field, Invariant};

/// Name of an invariant's array. The prefix distinguishes it from an observable of the same name.
#[must_use]
pub fn invariant(invariant: &Invariant) -> String {
    format!("invariant_{}", invariant.name)
}

/// Names of all columns after `node` and `time`.
#[must_use]
pub fn columns(card: &Card) -> Vec<String> {
    let mut names = Vec::new();
    for field in card.observables {
        names.extend(components(field.ascii, field));
    }
    for conserved in card.invariants {
        let name = invariant(conserved);
        if conserved.rows == 1 {
            names.push(name);
        } else {
            names.extend((1..=conserved.rows).map(|row| format!("{name}_{row}")));
        }
    }
    names
}

/// Components count from 1, as in print; row before column.
fn components(name: &str, field: &Field) -> Vec<String> {
    let Field { rows, cols, .. } = *field;
    if rows * cols == 1 {
        return vec![name.to_owned()];
    }
    if cols == 1 {
        return (1..=rows).map(|row| format!("{name}_{row}")).collect();
    }
    let gap = if rows > 9 || cols > 9 { "_" } else { "" };
    let pairs = (1..=rows).flat_map(|row| (1..=cols).map(move |col| (row, col)));
    pairs
        .map(|(row, col)| format!("{name}_{row}{gap}{col}"))
        .collect()
}
