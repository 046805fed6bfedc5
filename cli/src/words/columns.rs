//! Text in aligned columns, for tables on a terminal. Takes rows of cells, the first of which is the header; gives
//! lines, each ended by a newline, no wider than the terminal. Texts are wrapped, and columns that are still too wide
//! continue below.

use crate::words::width::wrapped;

/// Between columns.
const GAP: usize = 2;

/// The smallest width of a column of texts, unless a table of two columns requires less.
const LEAST: usize = 14;

/// Aligns `rows`. The columns listed in `right` are numbers, flushed right and never wrapped. Widths are in
/// characters. Columns that do not fit next to the others follow in a table below, which repeats the first column.
#[must_use]
pub fn aligned(rows: &[Vec<String>], right: &[usize], width: Option<usize>) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let columns: Vec<usize> = (0..count).collect();
    let Some(width) = width else {
        return written(
            rows,
            right,
            &columns,
            &columns
                .iter()
                .map(|c| natural(rows, *c))
                .collect::<Vec<_>>(),
        );
    };
    let least = |column: usize| least(rows, right, column);
    let mut blocks: Vec<Vec<usize>> = Vec::new();
    for column in 0..count {
        let room = |block: &Vec<usize>| {
            let taken: usize = block.iter().map(|c| least(*c) + GAP).sum();
            taken + least(column) <= width
        };
        match blocks.last_mut() {
            None => blocks.push(vec![column]),
            // A block needs at least one column besides the first.
            Some(block) if block.len() == 1 || room(block) => block.push(column),
            Some(_) => blocks.push(vec![0, column]),
        }
    }
    let tables = blocks.iter().map(|block| {
        let widths = fitted(rows, right, block, width);
        written(rows, right, block, &widths)
    });
    tables.collect::<Vec<_>>().join("\n")
}

/// The number of characters in the longest cell.
fn natural(rows: &[Vec<String>], column: usize) -> usize {
    let cells = rows.iter().filter_map(|row| row.get(column));
    cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
}

/// The width below which a column shrinks only after all other columns have shrunk.
fn least(rows: &[Vec<String>], right: &[usize], column: usize) -> usize {
    let natural = natural(rows, column);
    match right.contains(&column) {
        true => natural,
        false => natural.min(LEAST.max(longest_piece(rows, column))),
    }
}

/// The number of characters in the longest piece that wrapping does not break.
fn longest_piece(rows: &[Vec<String>], column: usize) -> usize {
    let cells = rows.iter().filter_map(|row| row.get(column));
    let pieces = cells.flat_map(|cell| cell.split_inclusive([' ', '_']));
    pieces
        .map(|piece| piece.trim_end().chars().count())
        .max()
        .unwrap_or(0)
}

/// Widths of the columns of a table that fits: the widest text columns shrink first.
fn fitted(rows: &[Vec<String>], right: &[usize], block: &[usize], width: usize) -> Vec<usize> {
    let mut widths: Vec<usize> = block.iter().map(|column| natural(rows, *column)).collect();
    let gaps = GAP * block.len().saturating_sub(1);
    while widths.iter().sum::<usize>() + gaps > width {
        let texts = block.iter().zip(&mut widths);
        // First keep whole words and names; break them only if nothing else can shrink.
        let widest = texts
            .filter(|(column, _)| !right.contains(column))
            .map(|(column, width)| (*width > least(rows, right, *column), width))
            .max_by_key(|(ample, width)| (*ample, **width))
            .map(|(_, width)| width);
        match widest {
            Some(widest) if *widest > 1 => *widest -= 1,
            _ => break,
        }
    }
    widths
}

fn written(rows: &[Vec<String>], right: &[usize], block: &[usize], widths: &[usize]) -> String {
    let mut text = String::new();
    for row in rows {
        let cells: Vec<Vec<String>> = block
            .iter()
            .zip(widths)
            .map(|(column, width)| {
                let cell = row.get(*column).map_or("", String::as_str);
                match cell.chars().count() > *width {
                    true => wrapped(cell, *width),
                    false => vec![cell.to_owned()],
                }
            })
            .collect();
        for at in 0..cells.iter().map(Vec::len).max().unwrap_or(0) {
            let mut line = String::new();
            for ((column, cell), width) in block.iter().zip(&cells).zip(widths) {
                let part = cell.get(at).map_or("", String::as_str);
                let gap = if line.is_empty() && column == &0 {
                    0
                } else {
                    GAP
                };
                line.push_str(&match right.contains(column) {
                    true => format!("{:gap$}{part:>width$}", ""),
                    false => format!("{:gap$}{part:<width$}", ""),
                });
            }
            text.push_str(line.trim_end());
            text.push('\n');
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::aligned;

    fn rows(rows: &[&[&str]]) -> Vec<Vec<String>> {
        let row = |row: &&[&str]| row.iter().map(|cell| (*cell).to_owned()).collect();
        rows.iter().map(row).collect()
    }

    #[test]
    fn greek_letters_count_as_one() {
        let rows = rows(&[&["Γ·Γ", "1"], &["a", "10"]]);
        assert_eq!(aligned(&rows, &[1], None), "Γ·Γ   1\na    10\n");
        assert_eq!(aligned(&rows, &[1], Some(7)), "Γ·Γ   1\na    10\n");
    }

    #[test]
    fn texts_are_wrapped_to_the_width() {
        let rows = rows(&[&["name", "text"], &["x", "one two three four five"]]);
        assert_eq!(
            aligned(&rows, &[], Some(20)),
            "name  text\nx     one two three\n      four five\n"
        );
    }

    #[test]
    fn numbers_that_do_not_fit_follow_below() {
        let rows = rows(&[&["name", "first", "second"], &["x", "1.0", "2.0"]]);
        assert_eq!(
            aligned(&rows, &[1, 2], Some(12)),
            "name  first\nx       1.0\n\nname  second\nx        2.0\n"
        );
    }

    #[test]
    fn no_line_is_too_long() {
        let rows = rows(&[
            &["invariant", "formula", "scale", "max drift", "verdict"],
            &[
                "momentum_linear_across_P_part_squared",
                "(a × b)·(c × d) + e",
                "1.000e0",
                "-1.234e-16",
                "within bound",
            ],
            &["energy", "½ μ·I⁻¹μ", "5.5e-1", "6.1e-7", "no bound"],
        ]);
        let everything: String = rows.concat().concat().split_whitespace().collect();
        for width in 26..140 {
            let text = aligned(&rows, &[2, 3], Some(width));
            for line in text.lines() {
                assert!(line.chars().count() <= width, "{width}: {line}");
            }
            // Nothing is omitted.
            for letter in everything.chars() {
                let count = |text: &str| text.chars().filter(|other| *other == letter).count();
                assert!(count(&text) >= count(&everything), "{width}: {letter}");
            }
        }
    }
}
