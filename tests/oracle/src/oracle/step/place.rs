//! Values by name: parameters, and the configuration at one node. Looks up scalars, columns and matrices in a table of names and
//! sizes and a list of numbers.

use crate::oracle::dual::Number;
use crate::oracle::square::Square;
use std::array::from_fn;

/// One name of a table.
#[derive(Clone, Debug)]
pub struct Letter {
    /// The name as the model writes it.
    pub name: String,
    /// The number of sites with their own value.
    pub sites: usize,
    /// Rows of a value.
    pub rows: usize,
    /// Columns of a value.
    pub cols: usize,
    /// The index of its first number.
    pub at: usize,
}

/// Names with their positions in one list of numbers.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// All names.
    pub letters: Vec<Letter>,
    /// The total count of numbers.
    pub count: usize,
}

impl Table {
    /// Appends a name.
    pub fn push(&mut self, name: &str, sites: usize, [rows, cols]: [usize; 2]) {
        self.letters.push(Letter {
            name: name.to_owned(),
            sites,
            rows,
            cols,
            at: self.count,
        });
        self.count += sites * rows * cols;
    }

    fn letter(&self, name: &str) -> &Letter {
        let found = self.letters.iter().find(|l| l.name == name);
        found.unwrap_or_else(|| panic!("the action has a letter `{name}` that the model has not"))
    }

    /// The number of sites with their own value of this name.
    #[must_use]
    pub fn sites(&self, name: &str) -> usize {
        self.letter(name).sites
    }
}

/// The values of a table.
#[derive(Clone, Copy, Debug)]
pub struct Place<'a, T> {
    /// Their names.
    pub table: &'a Table,
    /// The numbers.
    pub values: &'a [T],
}

impl<T: Number> Place<'_, T> {
    /// The numbers of one value. A name without per-site values has the same value at every site.
    fn own(&self, name: &str, site: usize) -> &[T] {
        let letter = self.table.letter(name);
        let size = letter.rows * letter.cols;
        let site = if letter.sites == 1 { 0 } else { site };
        assert!(site < letter.sites, "`{name}` has no site {site}");
        let from = letter.at + site * size;
        &self.values[from..from + size]
    }

    /// A scalar at a site.
    #[must_use]
    pub fn real_at(&self, name: &str, site: usize) -> T {
        self.own(name, site)[0]
    }

    /// A column at a site.
    #[must_use]
    pub fn column_at<const N: usize>(&self, name: &str, site: usize) -> [T; N] {
        let own = self.own(name, site);
        assert_eq!(own.len(), N, "{name}");
        from_fn(|i| own[i])
    }

    /// A matrix at a site.
    #[must_use]
    pub fn square_at<const N: usize>(&self, name: &str, site: usize) -> Square<T, N> {
        let own = self.own(name, site);
        assert_eq!(own.len(), N * N, "{name}");
        Square::from_entries(|i, j| own[i * N + j])
    }

    /// A scalar.
    #[must_use]
    pub fn real(&self, name: &str) -> T {
        self.real_at(name, 0)
    }

    /// A column.
    #[must_use]
    pub fn column<const N: usize>(&self, name: &str) -> [T; N] {
        self.column_at(name, 0)
    }

    /// A matrix.
    #[must_use]
    pub fn square<const N: usize>(&self, name: &str) -> Square<T, N> {
        self.square_at(name, 0)
    }
}
