//! Values at a node that the tangent of a step depends on, of any sizes: one type for all of them.

use crate::dense::Dense;
use crate::library::numbers;
use crate::value::Value;
use clebsch::solvers::newton::{Enclosure, NodeValues, Spread, Turn};
use clebsch::{OfScalars, Real};
use nalgebra::SMatrix;

/// Most numbers of all values together.
pub const MOST: usize = 48;

/// One value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Kept {
    /// Rows.
    pub rows: usize,
    /// Columns.
    pub cols: usize,
    /// Whether its entries are between -1 and 1.
    pub turn: bool,
}

/// The body for the number of entries of one value, those that are compiled.
macro_rules! of_count {
    ($n:expr, $N:ident, $body:expr, $other:expr, $($count:literal)*) => {
        match $n {
            $($count => {
                const $N: usize = $count;
                $body
            })*
            _ => $other,
        }
    };
    ($n:expr, $N:ident, $body:expr, $other:expr) => {
        of_count!($n, $N, $body, $other, 1 2 3 4 5 6 7 8 9 10 12 16)
    };
}

/// Values one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Nodes<T> {
    numbers: [T; MOST],
    kept: &'static [Kept],
}

/// Whether values of these sizes can be kept.
pub fn are_kept(list: &[Kept]) -> bool {
    let each = |k: &Kept| of_count!(k.rows * k.cols, N, N > 0, false);
    list.iter().all(each) && list.iter().map(|k| k.rows * k.cols).sum::<usize>() <= MOST
}

/// What a search asks of a node: nothing, or values.
pub trait Asked: NodeValues<Scalar = f64> {
    /// From the value that emitted code has, one inside the other.
    fn read(value: &Value<f64>, kept: &'static [Kept]) -> Option<Self>;

    /// The other way round, over another scalar.
    fn given<U: Real>(of: &Self::Over<U>) -> Value<U>;
}

impl Asked for [f64; 0] {
    fn read(_: &Value<f64>, _: &'static [Kept]) -> Option<Self> {
        Some([])
    }

    fn given<U: Real>(_: &[U; 0]) -> Value<U> {
        Value::Unit
    }
}

impl Asked for Nodes<f64> {
    fn read(value: &Value<f64>, kept: &'static [Kept]) -> Option<Self> {
        let list = numbers(value)?;
        let mut numbers = [0.0; MOST];
        for (place, x) in numbers.iter_mut().zip(&list) {
            *place = *x;
        }
        Some(Nodes { numbers, kept })
    }

    fn given<U: Real>(of: &Nodes<U>) -> Value<U> {
        let parts: Vec<Value<U>> = of
            .parts()
            .map(|(kept, own)| {
                let (rows, cols) = (kept.rows, kept.cols);
                let data = own.to_vec();
                let value = Value::of(Dense { rows, cols, data });
                match kept.turn {
                    true => Value::List(vec![value]),
                    false => value,
                }
            })
            .collect();
        let mut parts = parts.into_iter().rev();
        parts
            .by_ref()
            .fold(Value::Unit, |rest, own| Value::List(vec![own, rest]))
    }
}

impl<T> Nodes<T> {
    fn parts(&self) -> impl Iterator<Item = (&'static Kept, &[T])> {
        let mut from = 0;
        self.kept.iter().map(move |kept| {
            let own = self.numbers.get(from..from + kept.rows * kept.cols);
            from += kept.rows * kept.cols;
            (kept, own.unwrap_or(&[]))
        })
    }
}

impl<T: Real> OfScalars for Nodes<T> {
    type Scalar = T;
    type Over<U: Real> = Nodes<U>;

    fn over<U: Real>(&self, change: &mut impl FnMut(T) -> U) -> Nodes<U> {
        Nodes {
            numbers: self.numbers.map(change),
            kept: self.kept,
        }
    }
}

impl<T: Real> NodeValues for Nodes<T> {
    const ANY: bool = true;

    fn enclosed<const K: usize>(&self, lane: usize, spread: Spread) -> Nodes<Enclosure<K>> {
        let mut numbers = [Enclosure::exactly(0.0); MOST];
        let mut places = numbers.iter_mut();
        for (kept, own) in self.parts() {
            of_count!(
                own.len(),
                N,
                {
                    let m = SMatrix::<T, N, 1>::from_column_slice(own);
                    let m = match kept.turn {
                        true => Turn(m).enclosed::<K>(lane, spread).0,
                        false => m.enclosed::<K>(lane, spread),
                    };
                    for (x, place) in m.iter().zip(places.by_ref()) {
                        *place = *x;
                    }
                },
                ()
            );
        }
        Nodes {
            numbers,
            kept: self.kept,
        }
    }

    fn is_near(&self, others: &Self, spread: Spread) -> bool {
        let mut near = true;
        for ((kept, own), (_, other)) in self.parts().zip(others.parts()) {
            near &= of_count!(
                own.len(),
                N,
                {
                    let m = SMatrix::<T, N, 1>::from_column_slice(own);
                    let o = SMatrix::<T, N, 1>::from_column_slice(other);
                    match kept.turn {
                        true => Turn(m).is_near(&Turn(o), spread),
                        false => m.is_near(&o, spread),
                    }
                },
                false
            );
        }
        near
    }
}
