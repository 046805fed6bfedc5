//! Functions of the runtime that are called in a body: those that are known become operations of their own.

use super::super::{At, Op};
use super::{Loc, Slot, Tracer, constant, first};
use crate::code::{Code, Known, Native};
use crate::value::Value;
use clebsch::Real;
use clebsch::linalg::Dense;

impl<T: Real> Tracer<'_, T> {
    /// A function of the runtime as it is.
    pub(super) fn native(
        &mut self,
        native: Native<T>,
        slots: &[Slot<T>],
        sizes: &[usize],
    ) -> Option<Slot<T>> {
        let values: Vec<&Value<T>> = slots.iter().map(|s| &s.value).collect();
        let value = native(&values, sizes)?;
        let fixed = |s: &Slot<T>| matches!(s.loc, Loc::One(At::Constant(_)));
        if slots.iter().all(fixed) {
            return Some(constant(value));
        }
        let arguments = slots.iter().map(|s| self.argument(s.clone()));
        let arguments = arguments.collect::<Option<Vec<At<T>>>>()?;
        let steady = arguments.iter().all(|at| self.is_steady(at));
        let made = match value {
            // A truth may differ from site to site: it is no choice that is followed.
            Value::Bool(_) => return None,
            value => self.place_for(value, steady)?,
        };
        let Loc::One(to) = &made.loc else {
            return None;
        };
        let op = Op::Native(native, arguments.into(), sizes.into(), to.clone());
        self.emit(op, steady);
        Some(made)
    }

    pub(super) fn call(
        &mut self,
        native: Native<T>,
        list: &[Code<T>],
        sizes: &[usize],
        known: Known,
    ) -> Option<Slot<T>> {
        if let (Known::Length, [path]) = (known, list)
            && let Some(length) = self.length(path)
        {
            return Some(length);
        }
        let slots = list.iter().map(|c| self.trace(c));
        let slots = slots.collect::<Option<Vec<Slot<T>>>>()?;
        let fixed = |s: &Slot<T>| matches!(s.loc, Loc::One(At::Constant(_)));
        if slots.iter().all(fixed) {
            return self.native(native, &slots, sizes);
        }
        let values: Vec<&Value<T>> = slots.iter().map(|s| &s.value).collect();
        match (known, slots.as_slice()) {
            (Known::Exp, [x]) => self.function(T::exp, x, native),
            (Known::Sin, [x]) => self.function(T::sin, x, native),
            (Known::Cos, [x]) => self.function(T::cos, x, native),
            (Known::Sqrt, [x]) => self.function(T::sqrt, x, native),
            (Known::Ln, [x]) => self.function(T::ln, x, native),
            (Known::Powi, [x, n]) => {
                let Loc::One(At::Constant(Value::Int(n))) = n.loc else {
                    return None;
                };
                let value = native(&values, sizes)?;
                let (n, from) = (i32::try_from(n).ok()?, self.real(x)?);
                self.made(value, &[At::Real(from)], |to| {
                    Some(Op::Powi(from, n, first(to)?))
                })
            }
            (Known::Single, [x]) => {
                let (value, from) = (native(&values, sizes)?, self.real(x)?);
                Some(Slot {
                    value,
                    loc: Loc::One(At::Array([1, 1], from)),
                })
            }
            (Known::Matrix, [x]) => match &x.loc {
                Loc::Attitude(column, site) => {
                    let (column, site) = (*column, *site);
                    let value = native(&values, sizes)?;
                    self.made(value, &[At::Int(site)], |to| {
                        Some(Op::Attitude(column, site, first(to)?))
                    })
                }
                // The way of a field is its array.
                Loc::One(at @ At::Array(..)) => Some(Slot {
                    value: native(&values, sizes)?,
                    loc: Loc::One(at.clone()),
                }),
                _ => self.native(native, &slots, sizes),
            },
            (Known::Divided, [x, number, _]) => {
                let value = native(&values, sizes)?;
                if let Value::Failed(_) = value {
                    return None;
                }
                let ((dims, from), by) = (self.array(x, None)?, self.real(number)?);
                let array = Value::of(Dense::zeros(dims[0], dims[1]));
                let used = [At::Array(dims, from), At::Real(by)];
                let made = self.made(array, &used, |to| {
                    Some(Op::Divided(from, by, dims[0] * dims[1], first(to)?))
                })?;
                Some(Slot {
                    value,
                    loc: made.loc,
                })
            }
            (Known::AllFinite, [x]) => {
                let (dims, from) = self.array(x, None)?;
                self.emit(Op::Finite(from, dims[0] * dims[1]), false);
                let Value::Bool(true) = native(&values, sizes)? else {
                    return None;
                };
                Some(constant(Value::Bool(true)))
            }
            (Known::Done, [x]) => match x.value {
                Value::Failed(_) | Value::None => None,
                _ => Some(x.clone()),
            },
            (Known::ThenSome, [truth, value]) => match truth.loc {
                Loc::One(At::Constant(Value::Bool(true))) => Some(value.clone()),
                _ => None,
            },
            (Known::Dot | Known::Cross | Known::TrMul | Known::Trace, _) => {
                let mut at = Vec::new();
                for slot in &slots {
                    at.push(self.array(slot, None)?);
                }
                let value = native(&values, sizes)?;
                let op: fn(usize, usize, usize) -> Op<T> = match (known, at.as_slice()) {
                    (Known::Dot, [([3, 1], _), ([3, 1], _)]) => Op::Dot,
                    (Known::Cross, [([3, 1], _), ([3, 1], _)]) => Op::Cross,
                    (Known::TrMul, [([3, 3], _), ([3, 1], _)]) => Op::TrMatVec,
                    (Known::TrMul, [([3, 3], _), ([3, 3], _)]) => Op::TrMatMat,
                    (Known::Trace, [([3, 3], _)]) => |a, _, to| Op::Trace(a, to),
                    _ => return self.native(native, &slots, sizes),
                };
                let used: Vec<At<T>> = at.iter().map(|(d, x)| At::Array(*d, *x)).collect();
                let (a, b) = (at.first()?.1, at.last()?.1);
                self.made(value, &used, |to| Some(op(a, b, first(to)?)))
            }
            _ => self.native(native, &slots, sizes),
        }
    }

    pub(super) fn function(
        &mut self,
        f: fn(T) -> T,
        x: &Slot<T>,
        native: Native<T>,
    ) -> Option<Slot<T>> {
        let value = native(&[&x.value], &[])?;
        let from = self.real(x)?;
        self.made(value, &[At::Real(from)], |to| {
            Some(Op::Function(f, from, first(to)?))
        })
    }

    /// Registers for a value, and the operation that fills them from those that it uses.
    pub(super) fn made(
        &mut self,
        value: Value<T>,
        used: &[At<T>],
        op: impl FnOnce(&At<T>) -> Option<Op<T>>,
    ) -> Option<Slot<T>> {
        let steady = used.iter().all(|at| self.is_steady(at));
        let made = self.place_for(value, steady)?;
        let Loc::One(to) = &made.loc else {
            return None;
        };
        let op = op(to)?;
        self.emit(op, steady);
        Some(made)
    }
}
