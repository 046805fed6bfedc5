//! Numbers in bounds as the scalar of equations that were read: those of the runtime, with as many variables
//! as the velocities at work take. How a number moves with them stands in a table of the thread; most numbers
//! do not move at all.

use clebsch::solvers::newton::{Affine, Bounded, swing_of};
use std::cell::RefCell;

/// A number in bounds.
pub type Bound = Bounded<Along>;

/// How a number moves with the variables: a row of the table, the first of them not at all.
#[derive(Clone, Copy, Debug)]
pub struct Along(u32);

struct Table {
    width: usize,
    numbers: Vec<f64>,
}

thread_local! {
    static TABLE: RefCell<Table> = const {
        RefCell::new(Table {
            width: 0,
            numbers: Vec::new(),
        })
    };
}

/// While it lives, numbers of this thread may move; none of them is kept longer.
pub struct Variables;

impl Variables {
    /// So many variables.
    pub fn at_work(width: usize) -> Self {
        TABLE.with_borrow_mut(|table| table.width = width);
        Variables
    }
}

impl Drop for Variables {
    fn drop(&mut self) {
        TABLE.with_borrow_mut(|table| {
            table.width = 0;
            table.numbers.clear();
        });
    }
}

impl Table {
    fn row(&self, Along(row): Along) -> &[f64] {
        let end = row as usize * self.width;
        let from = end.checked_sub(self.width);
        from.and_then(|from| self.numbers.get(from..end))
            .unwrap_or(&[])
    }

    /// A new row of these numbers.
    fn add(&mut self, number: impl Fn(&Self, usize) -> f64) -> Along {
        for k in 0..self.width {
            let x = number(self, k);
            self.numbers.push(x);
        }
        let rows = self.numbers.len().checked_div(self.width).unwrap_or(0);
        Along(u32::try_from(rows).unwrap_or(0))
    }

    /// A new row made of two others, number by number.
    fn both(&mut self, a: Along, b: Along, number: impl Fn(f64, f64) -> f64) -> Along {
        let start = |Along(row): Along| (row as usize * self.width).checked_sub(self.width);
        let (Some(a), Some(b)) = (start(a), start(b)) else {
            return Along(0);
        };
        self.numbers.reserve(self.width);
        for k in 0..self.width {
            let (Some(x), Some(y)) = (self.numbers.get(a + k), self.numbers.get(b + k)) else {
                return Along(0);
            };
            let z = number(*x, *y);
            self.numbers.push(z);
        }
        let rows = self.numbers.len().checked_div(self.width).unwrap_or(0);
        Along(u32::try_from(rows).unwrap_or(0))
    }
}

impl Along {
    /// As these variables of its own, the first of them counted from `first` on.
    pub fn placed(own: &[f64], first: usize) -> Self {
        if own.iter().all(|x| *x == 0.0) {
            return Along(0);
        }
        let at = |k: usize| k.checked_sub(first).and_then(|k| own.get(k)).copied();
        TABLE.with_borrow_mut(|table| table.add(|_, k| at(k).unwrap_or(0.0)))
    }
}

impl PartialEq for Along {
    fn eq(&self, other: &Self) -> bool {
        if (self.0, other.0) == (0, 0) {
            return true;
        }
        TABLE.with_borrow(|table| {
            let at = |row: &[f64], k: usize| row.get(k).copied().unwrap_or(0.0);
            let (a, b) = (table.row(*self), table.row(*other));
            (0..table.width).all(|k| at(a, k) == at(b, k))
        })
    }
}

impl Affine for Along {
    fn none() -> Self {
        Along(0)
    }

    fn variable(radius: f64, index: usize) -> Option<Self> {
        TABLE.with_borrow_mut(|table| {
            let own = |k: usize| if k == index { radius } else { 0.0 };
            (index < table.width).then(|| table.add(|_, k| own(k)))
        })
    }

    #[inline(never)]
    fn along(&self, index: usize) -> f64 {
        TABLE.with_borrow(|table| table.row(*self).get(index).copied().unwrap_or(0.0))
    }

    #[inline(never)]
    fn plus(self, other: Self) -> Self {
        match (self.0, other.0) {
            (_, 0) => self,
            (0, _) => other,
            _ => TABLE.with_borrow_mut(|table| table.both(self, other, |x, y| x + y)),
        }
    }

    #[inline(never)]
    fn opposite(self) -> Self {
        match self.0 {
            0 => self,
            _ => TABLE.with_borrow_mut(|table| table.both(self, self, |x, _| -x)),
        }
    }

    #[inline(never)]
    fn times(self, factor: f64) -> Self {
        match self.0 {
            0 => self,
            _ => TABLE.with_borrow_mut(|table| table.both(self, self, |x, _| x * factor)),
        }
    }

    #[inline(never)]
    fn weighted(self, factor: f64, other: Self, other_factor: f64) -> Self {
        match (self.0, other.0) {
            (_, 0) => self.times(factor),
            (0, _) => other.times(other_factor),
            _ => TABLE.with_borrow_mut(|table| {
                table.both(self, other, |x, y| x * factor + y * other_factor)
            }),
        }
    }

    #[inline(never)]
    fn swing(&self) -> f64 {
        match self.0 {
            0 => 0.0,
            _ => TABLE.with_borrow(|table| swing_of(table.row(*self))),
        }
    }
}
