//! Operators between numbers, counts and arrays, in the order of operations of the runtime's own.

use super::super::{At, Op};
use super::{Loc, Slot, Tracer, constant};
use crate::code::Operator;
use crate::library;
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;

impl<T: Real> Tracer<'_, T> {
    /// What an operator makes of two values.
    pub(super) fn binary(
        &mut self,
        operator: Operator,
        a: &Slot<T>,
        b: &Slot<T>,
    ) -> Option<Slot<T>> {
        let both = (&a.loc, &b.loc);
        if let (Loc::One(At::Constant(x)), Loc::One(At::Constant(y))) = both
            && let Some(value) = library::binary(operator, x, y)
        {
            return Some(constant(value));
        }
        let shape = |v: &Value<T>| v.dense().map(|d| [d.rows, d.cols]);
        let zeros = [shape(&a.value), shape(&b.value)];
        let sized = |v: &Value<T>, of: Option<[usize; 2]>| match (v, of) {
            (Value::Zeros, Some([rows, cols])) => Value::of(Dense::zeros(rows, cols)),
            (v, _) => v.clone(),
        };
        let (x, y) = (sized(&a.value, zeros[1]), sized(&b.value, zeros[0]));
        let value = library::binary(operator, &x, &y)?;
        let one = self.standing(a.clone(), zeros[1])?;
        let other = self.standing(b.clone(), zeros[0])?;
        let steady = self.is_steady(&one) && self.is_steady(&other);
        let made = self.place_for(value, steady)?;
        let Loc::One(to) = &made.loc else {
            return None;
        };
        use Operator::{Add, Div, Mul, Sub};
        let size = |dims: &[usize; 2]| dims[0] * dims[1];
        let op = match (operator, one, other, to) {
            (Add, At::Real(a), At::Real(b), At::Real(to)) => Op::Add(a, b, *to),
            (Sub, At::Real(a), At::Real(b), At::Real(to)) => Op::Sub(a, b, *to),
            (Mul, At::Real(a), At::Real(b), At::Real(to)) => Op::Mul(a, b, *to),
            (Div, At::Real(a), At::Real(b), At::Real(to)) => Op::Div(a, b, *to),
            (Add, At::Int(a), At::Int(b), At::Int(to)) => Op::AddInt(a, b, *to),
            (Sub, At::Int(a), At::Int(b), At::Int(to)) => Op::SubInt(a, b, *to),
            (Add, At::Array(d, a), At::Array(_, b), At::Array(_, to)) => {
                Op::AddEach(a, b, size(&d), *to)
            }
            (Sub, At::Array(d, a), At::Array(_, b), At::Array(_, to)) => {
                Op::SubEach(a, b, size(&d), *to)
            }
            (Mul, At::Array(d, a), At::Real(b), At::Array(_, to)) => Op::MulBy(a, b, size(&d), *to),
            (Div, At::Array(d, a), At::Real(b), At::Array(_, to)) => Op::DivBy(a, b, size(&d), *to),
            (Mul, At::Array([3, 3], a), At::Array([3, 1], b), At::Array(_, to)) => {
                Op::MatVec(a, b, *to)
            }
            (Mul, At::Array([3, 3], a), At::Array([3, 3], b), At::Array(_, to)) => {
                Op::MatMat(a, b, *to)
            }
            (Mul, At::Array(d, a), At::Array(e, b), to @ At::Array(..)) => {
                let arguments = [At::Array(d, a), At::Array(e, b)].into();
                Op::Native(times, arguments, [].into(), to.clone())
            }
            _ => return None,
        };
        self.emit(op, steady);
        Some(made)
    }
}

/// The product of two arrays of any size.
fn times<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    library::binary(Operator::Mul, a.first()?, a.get(1)?)
}
