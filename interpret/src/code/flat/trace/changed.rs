//! Arrays that a body fills bit by bit: each time they are others, in registers of their own.

use super::super::{At, Op};
use super::{Loc, Slot, Tracer, constant};
use crate::code::{Code, Known};
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;

impl<T: Real> Tracer<'_, T> {
    /// Functions that change what they are given, and those that call back.
    pub(super) fn special(&mut self, list: &[Code<T>], known: Known) -> Option<Slot<T>> {
        match (known, list) {
            (Known::Rest, [Code::Place(at)]) => Some(constant(Value::Part(*at, 0))),
            (Known::PutVector | Known::PutMatrix, [rest, value]) => {
                let Value::Part(at, from) = self.trace(rest)?.value else {
                    return None;
                };
                let value = self.trace(value)?;
                let whole = self.env.get(&at)?.clone();
                let ([rows, cols], data) = match &value.value {
                    Value::Real(x) => ([1, 1], vec![*x]),
                    v => v.dense().map(|d| ([d.rows, d.cols], d.data))?,
                };
                let source = match self.standing(value, None)? {
                    At::Real(x) | At::Array(_, x) => x,
                    _ => return None,
                };
                let order = |k: usize| match known {
                    Known::PutMatrix => (k % cols) * rows + k / cols,
                    _ => k,
                };
                let moves = (0..rows * cols).map(|k| Move {
                    from: source + order(k),
                    to: from + k,
                    value: data.get(order(k)).copied(),
                });
                let moves: Vec<Move<T>> = moves.collect();
                let next = from + moves.len();
                let changed = self.changed(&whole, &moves)?;
                self.env.insert(at, changed);
                Some(constant(Value::Part(at, next)))
            }
            (Known::SetColumn, [Code::Place(at), index, column]) => {
                let (index, column) = (self.trace(index)?, self.trace(column)?);
                let Loc::One(At::Constant(index)) = index.loc else {
                    return None;
                };
                let whole = self.env.get(at)?.clone();
                let (dims, source) = self.array(&column, None)?;
                let from = index.count()? * dims[0];
                let data = column.value.dense()?.data;
                let moves = (0..dims[0]).map(|k| Move {
                    from: source + k,
                    to: from + k,
                    value: data.get(k).copied(),
                });
                let moves: Vec<Move<T>> = moves.collect();
                let changed = self.changed(&whole, &moves)?;
                self.env.insert(*at, changed);
                Some(constant(Value::Unit))
            }
            (Known::PutBlock, [Code::Place(at), row, column, block]) => {
                let (row, column) = (self.trace(row)?, self.trace(column)?);
                let (Loc::One(At::Constant(row)), Loc::One(At::Constant(column))) =
                    (row.loc, column.loc)
                else {
                    return None;
                };
                let block = self.trace(block)?;
                let whole = self.env.get(at)?.clone();
                let all = whole.value.dense()?.rows;
                let ([rows, cols], source) = self.array(&block, None)?;
                let (row, column) = (row.count()?, column.count()?);
                let data = block.value.dense()?.data;
                let mut moves = Vec::new();
                for j in 0..cols {
                    for i in 0..rows {
                        moves.push(Move {
                            from: source + j * rows + i,
                            to: (column + j) * all + row + i,
                            value: data.get(j * rows + i).copied(),
                        });
                    }
                }
                let changed = self.changed(&whole, &moves)?;
                self.env.insert(*at, changed);
                Some(constant(Value::Unit))
            }
            (Known::FromFn, [rows, cols, Code::Closure(parameters, body)]) => {
                let (rows, cols) = (self.trace(rows)?, self.trace(cols)?);
                let (rows, cols) = (rows.value.count()?, cols.value.count()?);
                let mut moves = Vec::new();
                for j in 0..cols {
                    for i in 0..rows {
                        for (at, n) in parameters.iter().zip([i, j]) {
                            self.env.insert(*at, constant(Value::Int(n as i64)));
                        }
                        let entry = self.trace(body)?;
                        let Value::Real(value) = entry.value else {
                            return None;
                        };
                        moves.push(Move {
                            from: self.real(&entry)?,
                            to: j * rows + i,
                            value: Some(value),
                        });
                    }
                }
                let zeros = constant(Value::of(Dense::zeros(rows, cols)));
                self.changed(&zeros, &moves)
            }
            (Known::Map, [value, Code::Closure(parameters, body)]) => {
                let [at] = parameters.as_slice() else {
                    return None;
                };
                let value = self.trace(value)?;
                if let Value::Sites(_) | Value::None | Value::Failed(_) = value.value {
                    return None;
                }
                self.env.insert(*at, value);
                self.trace(body)
            }
            (Known::MapErr, [value, _]) => {
                let value = self.trace(value)?;
                match value.value {
                    Value::Failed(_) => None,
                    _ => Some(value),
                }
            }
            _ => None,
        }
    }

    /// An array with some numbers put into it.
    fn changed(&mut self, whole: &Slot<T>, moves: &[Move<T>]) -> Option<Slot<T>> {
        let (dims, before) = self.array(whole, None)?;
        let count = dims[0] * dims[1];
        let mut value = whole.value.dense()?;
        let to = self.numbers(count, false);
        self.emit(Op::Copy(before, count, to), false);
        for m in moves {
            *value.data.get_mut(m.to)? = m.value?;
            self.emit(Op::Copy(m.from, 1, to + m.to), false);
        }
        Some(Slot {
            value: Value::of(value),
            loc: Loc::One(At::Array(dims, to)),
        })
    }
}

/// A number put into an array: from which register, to which entry, and what it is at the first site.
struct Move<T: Real> {
    from: usize,
    to: usize,
    value: Option<T>,
}
