//! Values by their names: parameters, and what moves at one node.
//! Takes a table of names and sizes and the numbers behind it; gives numbers, columns and matrices.

use crate::oracle::dual::Number;
use crate::oracle::square::Square;
use std::array::from_fn;

/// One name of a table.
#[derive(Clone, Debug)]
pub struct Letter {
    /// As the model writes it.
    pub name: String,
    /// How many sites have a value of their own.
    pub sites: usize,
    /// Rows of a value.
    pub rows: usize,
    /// Columns of a value.
    pub cols: usize,
    /// Where its first number stands.
    pub at: usize,
}

/// Names with their places in one list of numbers.
#[derive(Clone, Debug, Default)]
pub struct Table {
    /// All names.
    pub letters: Vec<Letter>,
    /// How many numbers there are.
    pub count: usize,
}

impl Table {
    /// Puts a name behind the others.
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

    /// How many sites have a value of this name.
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
    /// The numbers of one value; a name that is the same everywhere has it at every site.
    fn own(&self, name: &str, site: usize) -> &[T] {
        let letter = self.table.letter(name);
        let size = letter.rows * letter.cols;
        let site = if letter.sites == 1 { 0 } else { site };
        assert!(site < letter.sites, "`{name}` has no site {site}");
        let from = letter.at + site * size;
        &self.values[from..from + size]
    }

    /// A number at a site.
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

    /// A number.
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
