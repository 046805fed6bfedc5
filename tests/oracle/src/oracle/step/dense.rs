//! Dense linear systems in double precision, by elimination with row exchanges: one factorisation, many right-hand sides.

/// A factored matrix, row by row.
#[derive(Clone, Debug)]
pub struct Factored {
    rows: Vec<Vec<f64>>,
    order: Vec<usize>,
}

impl Factored {
    /// Factors a matrix. Pivots are scaled by the largest entry of their row, so that units do not affect the choice.
    #[must_use]
    pub fn of(mut rows: Vec<Vec<f64>>) -> Self {
        let n = rows.len();
        let mut order: Vec<usize> = (0..n).collect();
        let largest = |row: &Vec<f64>| row.iter().fold(0.0_f64, |m, x| m.max(x.abs()));
        let mut sizes: Vec<f64> = rows.iter().map(largest).collect();
        for column in 0..n {
            let relative = |i: usize, rows: &[Vec<f64>]| rows[i][column].abs() / sizes[i];
            let mut pivot = column;
            for row in column + 1..n {
                if relative(row, &rows) > relative(pivot, &rows) {
                    pivot = row;
                }
            }
            rows.swap(column, pivot);
            sizes.swap(column, pivot);
            order.swap(column, pivot);
            let (above, below) = rows.split_at_mut(column + 1);
            let head = &above[column];
            for row in below {
                let factor = row[column] / head[column];
                if factor == 0.0 {
                    continue;
                }
                row[column] = factor;
                for j in column + 1..n {
                    row[j] -= factor * head[j];
                }
            }
        }
        Self { rows, order }
    }

    /// The solution for one right-hand side.
    #[must_use]
    pub fn solve(&self, right: &[f64]) -> Vec<f64> {
        let mut x: Vec<f64> = self.order.iter().map(|i| right[*i]).collect();
        for i in 0..x.len() {
            for j in 0..i {
                x[i] -= self.rows[i][j] * x[j];
            }
        }
        for i in (0..x.len()).rev() {
            for j in i + 1..x.len() {
                x[i] -= self.rows[i][j] * x[j];
            }
            x[i] /= self.rows[i][i];
        }
        x
    }
}
