//! Text in aligned columns, for tables on a terminal.
//! Takes rows of cells; gives lines, each ended by a newline.

/// Aligns `rows`; the columns listed in `right` are flushed right. Widths count characters.
#[must_use]
pub fn aligned(rows: &[Vec<String>], right: &[usize]) -> String {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for ((column, cell), &width) in row.iter().enumerate().zip(&widths) {
            let gap = if column == 0 { "" } else { "  " };
            let padded = if right.contains(&column) {
                format!("{gap}{cell:>width$}")
            } else {
                format!("{gap}{cell:<width$}")
            };
            line.push_str(&padded);
        }
        text.push_str(line.trim_end());
        text.push('\n');
    }
    text
}

#[cfg(test)]
mod tests {
    #[test]
    fn greek_letters_count_as_one() {
        let rows = [
            vec!["Γ·Γ".to_owned(), "1".to_owned()],
            vec!["a".to_owned(), "10".to_owned()],
        ];
        assert_eq!(super::aligned(&rows, &[1]), "Γ·Γ   1\na    10\n");
    }
}
