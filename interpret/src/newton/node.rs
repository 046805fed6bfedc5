//! Values at a node that the tangent of a step depends on, of any sizes.

use crate::library::numbers;
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;
use clebsch::solvers::newton::{NodeList, NodeValue, Spread};

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

/// From the value that emitted code has, one inside the other.
pub fn read(value: &Value<f64>, kept: &[Kept]) -> Option<NodeList> {
    let all = match kept {
        [] => Vec::new(),
        _ => numbers(value)?,
    };
    let mut rest = all.as_slice();
    let mut values = Vec::with_capacity(kept.len());
    for kept in kept {
        let (own, others) = rest.split_at_checked(kept.rows * kept.cols)?;
        rest = others;
        values.push(NodeValue {
            numbers: own.to_vec(),
            turn: kept.turn,
        });
    }
    Some(NodeList { values })
}

/// The other way round, over any scalar: `number` makes one of its middle and its radius.
pub fn given<U: Real>(
    list: &NodeList,
    kept: &[Kept],
    spread: Option<Spread>,
    number: impl Fn([f64; 2]) -> U,
) -> Value<U> {
    let parts = kept.iter().zip(&list.values).map(|(kept, own)| {
        let data = match spread {
            Some(spread) => own.enclosed(spread).map(&number).collect(),
            None => own.numbers.iter().map(|x| number([*x, 0.0])).collect(),
        };
        let (rows, cols) = (kept.rows, kept.cols);
        let value = Value::of(Dense { rows, cols, data });
        match kept.turn {
            true => Value::List(vec![value]),
            false => value,
        }
    });
    let parts: Vec<Value<U>> = parts.collect();
    let parts = parts.into_iter().rev();
    parts.fold(Value::Unit, |rest, own| Value::List(vec![own, rest]))
}
