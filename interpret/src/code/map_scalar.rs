//! Operations over another scalar: the same operations, with the functions of the runtime for that scalar.

use super::{Arm, Code, Evaluated, Library, Pattern, Places, Routine, unfit};
use crate::map_scalar::map_scalar;
use crate::value::Value;
use clebsch::Real;
use std::cell::RefCell;
use std::collections::HashMap;
use std::sync::{Arc, OnceLock};

/// A function over another scalar.
type Changed<U> = Arc<OnceLock<Routine<U>>>;

/// The functions that have been changed, by address; `None` while a function is being changed. Each is changed once, or a step
/// with many blocks would grow without bound: the refusal of each block calls the whole step.
type Known<U> = RefCell<HashMap<*const (), Option<Changed<U>>>>;

/// A call of a function by itself, which only a refused step makes. If it runs over another scalar, clebsch computes with
/// plain numbers instead.
fn recursive<T: Real>(_: &mut Places<T>, _: &[Code<T>]) -> Evaluated<T> {
    unfit(None)
}

impl<T: Real> Routine<T> {
    /// The function over another scalar; nothing if it loops or calls what that scalar lacks.
    pub fn map_scalar<U: Library>(&self, change: fn(T) -> U) -> Option<Routine<U>> {
        Some(Routine {
            places: self.places,
            body: self.body.map_scalar(change)?,
        })
    }
}

impl<T: Real> Code<T> {
    /// As [`Routine::over`].
    pub fn map_scalar<U: Library>(&self, change: fn(T) -> U) -> Option<Code<U>> {
        let known = &Known::default();
        Change { change, known }.code(self)
    }
}

/// A change of the scalar.
struct Change<'a, T, U: Real> {
    change: fn(T) -> U,
    known: &'a Known<U>,
}

impl<T, U: Real> Clone for Change<'_, T, U> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T, U: Real> Copy for Change<'_, T, U> {}

impl<T: Real, U: Library> Change<'_, T, U> {
    #[inline(never)]
    fn value(self, value: &Value<T>) -> Option<Value<U>> {
        map_scalar(value, &mut |x| (self.change)(x))
    }

    fn boxed(self, code: &Code<T>) -> Option<Box<Code<U>>> {
        self.code(code).map(Box::new)
    }

    #[inline(never)]
    fn all(self, all: &[Code<T>]) -> Option<Vec<Code<U>>> {
        let mut changed = Vec::with_capacity(all.len());
        for code in all {
            changed.push(self.code(code)?);
        }
        Some(changed)
    }

    /// An operation that may be missing.
    fn perhaps(self, code: Option<&Code<T>>) -> Option<Option<Box<Code<U>>>> {
        match code {
            Some(code) => self.boxed(code).map(Some),
            None => Some(None),
        }
    }

    #[inline(never)]
    fn pattern(self, pattern: &Pattern<T>) -> Option<Pattern<U>> {
        let boxed = |inner: &Pattern<T>| self.pattern(inner).map(Box::new);
        let each = |all: &[Pattern<T>]| -> Option<Vec<Pattern<U>>> {
            all.iter().map(|p| self.pattern(p)).collect()
        };
        Some(match pattern {
            Pattern::Any => Pattern::Any,
            Pattern::Place(at) => Pattern::Place(*at),
            Pattern::List(all) => Pattern::List(each(all)?),
            Pattern::Or(all) => Pattern::Or(each(all)?),
            Pattern::Done(inner) => Pattern::Done(boxed(inner)?),
            Pattern::Failed(inner) => Pattern::Failed(boxed(inner)?),
            Pattern::None => Pattern::None,
            Pattern::Exactly(value) => Pattern::Exactly(Box::new(self.value(value)?)),
            Pattern::Variant(name, fields) => {
                let field = |(at, p): &(u32, Pattern<T>)| Some((*at, self.pattern(p)?));
                let fields = fields.iter().map(field).collect::<Option<_>>()?;
                Pattern::Variant(name.clone(), fields)
            }
        })
    }

    #[inline(never)]
    fn arms(self, arms: &[Arm<T>]) -> Option<Vec<Arm<U>>> {
        let mut changed = Vec::with_capacity(arms.len());
        for arm in arms {
            let guard = self.perhaps(arm.guard.as_ref())?;
            changed.push(Arm {
                pattern: self.pattern(&arm.pattern)?,
                guard: guard.map(|guard| *guard),
                body: self.code(&arm.body)?,
            });
        }
        Some(changed)
    }

    #[inline(never)]
    fn fields(self, given: &[(usize, Code<T>)]) -> Option<Vec<(usize, Code<U>)>> {
        let mut changed = Vec::with_capacity(given.len());
        for (at, code) in given {
            changed.push((*at, self.code(code)?));
        }
        Some(changed)
    }

    #[inline(never)]
    fn call(self, routine: &Arc<OnceLock<Routine<T>>>, given: &[Code<T>]) -> Option<Code<U>> {
        let own = Arc::as_ptr(routine).cast::<()>();
        let known = self.known.borrow().get(&own).cloned();
        let changed = match known {
            Some(Some(changed)) => changed,
            Some(None) => return Some(Code::Special(recursive, Vec::new(), "recursive".into())),
            None => {
                self.known.borrow_mut().insert(own, None);
                let Routine { places, body } = routine.get()?;
                let body = self.code(body)?;
                let places = *places;
                let changed = Arc::new(OnceLock::from(Routine { places, body }));
                let shared = Some(changed.clone());
                self.known.borrow_mut().insert(own, shared);
                changed
            }
        };
        Some(Code::Routine(changed, self.all(given)?))
    }

    fn code(self, code: &Code<T>) -> Option<Code<U>> {
        Some(match code {
            Code::Constant(value) => Code::constant(self.value(value)?),
            Code::Place(at) => Code::Place(*at),
            Code::Field(base, name) => Code::Field(self.boxed(base)?, *name),
            Code::Inner(a) => Code::Inner(self.boxed(a)?),
            Code::Index(base, at) => Code::Index(self.boxed(base)?, self.all(at)?),
            Code::Binary(operator, a, b) => Code::Binary(*operator, self.boxed(a)?, self.boxed(b)?),
            Code::Lazy(settles, a, b) => Code::Lazy(*settles, self.boxed(a)?, self.boxed(b)?),
            Code::Negative(a) => Code::Negative(self.boxed(a)?),
            Code::Not(a) => Code::Not(self.boxed(a)?),
            Code::Call(_, list, sizes, name) => {
                let native = U::native(name, list.len())?;
                Code::Call(native, self.all(list)?, sizes.clone(), name.clone())
            }
            Code::Special(_, list, name) => {
                Code::Special(U::special(name)?, self.all(list)?, name.clone())
            }
            Code::Routine(routine, list) => self.call(routine, list)?,
            Code::Closure(places, body) => Code::Closure(places.clone(), self.boxed(body)?),
            Code::Iterate(iterate) => Code::Iterate(U::iterate(iterate.clone().recorded())?),
            Code::Block(all) => Code::Block(self.all(all)?),
            Code::Let(pattern, value, otherwise) => {
                let pattern = self.pattern(pattern)?;
                let otherwise = self.perhaps(otherwise.as_deref())?;
                Code::Let(pattern, self.boxed(value)?, otherwise)
            }
            Code::Once(at, value) => Code::Once(*at, self.boxed(value)?),
            Code::If(condition, then, otherwise) => {
                let otherwise = self.perhaps(otherwise.as_deref())?;
                Code::If(self.boxed(condition)?, self.boxed(then)?, otherwise)
            }
            Code::Match(value, arms) => Code::Match(self.boxed(value)?, self.arms(arms)?),
            Code::While(condition, body) => Code::While(self.boxed(condition)?, self.boxed(body)?),
            Code::For(at, from, to, body) => {
                Code::For(*at, self.boxed(from)?, self.boxed(to)?, self.boxed(body)?)
            }
            Code::Down(at, from, to, body) => {
                Code::Down(*at, self.boxed(from)?, self.boxed(to)?, self.boxed(body)?)
            }
            Code::Assign(targets, value) => Code::Assign(self.all(targets)?, self.boxed(value)?),
            Code::Increase(target, value) => {
                Code::Increase(self.boxed(target)?, self.boxed(value)?)
            }
            Code::Struct(layout, given, base) => {
                let given = self.fields(given)?;
                Code::Struct(layout.clone(), given, self.perhaps(base.as_deref())?)
            }
            Code::List(all) => Code::List(self.all(all)?),
            Code::Repeat(value, count) => Code::Repeat(self.boxed(value)?, self.boxed(count)?),
            Code::Momentum(frame, a) => Code::Momentum(*frame, self.boxed(a)?),
            Code::Function(body) => Code::Function(self.boxed(body)?),
            Code::Return(value) => Code::Return(self.boxed(value)?),
            Code::Try(value) => Code::Try(self.boxed(value)?),
        })
    }
}
