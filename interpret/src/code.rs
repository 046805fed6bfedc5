//! The operations of a function, read once: a tree over numbered places. Executing it looks no name up.

use crate::failure::Failure;
use crate::value::{Frame, Layout, Struct, Value};
use clebsch::Real;
use std::sync::{Arc, OnceLock};

/// The places of a function that runs: parameters, then locals.
pub type Places<T> = Vec<Value<T>>;

/// A function of the runtime; nothing for arguments that it does not take.
pub type Native<T> = fn(&[&Value<T>], &[usize]) -> Option<Value<T>>;

/// A function of the runtime that changes its first argument, or calls back.
pub type Special<T> = fn(&mut Places<T>, &[Code<T>]) -> Result<Value<T>, Exit<T>>;

/// Why an expression has no value.
#[derive(Debug)]
pub enum Exit<T: Real> {
    /// The function returns.
    Return(Value<T>),
    /// An operation on values that it does not take, which emission never asks for.
    Unfit(&'static str),
}

/// An operator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operator {
    /// `+`
    Add,
    /// `-`
    Sub,
    /// `*`
    Mul,
    /// `/`
    Div,
    /// `==`
    Equal,
    /// `!=`
    Differs,
    /// `<`
    Less,
    /// `<=`
    AtMost,
    /// `>`
    More,
    /// `>=`
    AtLeast,
}

/// A function that is called rather than written out where it is called.
#[derive(Debug)]
pub struct Routine<T: Real> {
    /// How many places it needs.
    pub places: usize,
    /// Its operations.
    pub body: Code<T>,
}

/// A pattern.
#[derive(Clone, Debug)]
pub enum Pattern<T: Real> {
    /// Anything.
    Any,
    /// Anything, under a name.
    Place(usize),
    /// A tuple.
    List(Vec<Pattern<T>>),
    /// `Ok(..)` or `Some(..)`.
    Done(Box<Pattern<T>>),
    /// `Err(..)`.
    Failed(Box<Pattern<T>>),
    /// `None`.
    None,
    /// This value.
    Exactly(Value<T>),
}

/// An arm of a match.
#[derive(Clone, Debug)]
pub struct Arm<T: Real> {
    /// What is met.
    pub pattern: Pattern<T>,
    /// And holds.
    pub guard: Option<Code<T>>,
    /// Then.
    pub body: Code<T>,
}

/// An expression or a statement.
#[derive(Clone, Debug)]
pub enum Code<T: Real> {
    /// A constant.
    Constant(Value<T>),
    /// A place.
    Place(usize),
    /// A field of a struct, by the number of its name.
    Field(Box<Code<T>>, u32),
    /// What stands inside: `.0` of a momentum.
    Inner(Box<Code<T>>),
    /// An element of a list or of a matrix.
    Index(Box<Code<T>>, Vec<Code<T>>),
    /// An operator.
    Binary(Operator, Box<Code<T>>, Box<Code<T>>),
    /// `&&`, `||`: the second where the first does not settle it.
    Lazy(bool, Box<Code<T>>, Box<Code<T>>),
    /// `-`
    Negative(Box<Code<T>>),
    /// `!`
    Not(Box<Code<T>>),
    /// A function of the runtime, with sizes.
    Call(Native<T>, Vec<Code<T>>, Vec<usize>),
    /// One that changes places or calls back.
    Special(Special<T>, Vec<Code<T>>),
    /// A function of the model, its parameters given as expressions; changed ones are put back.
    Routine(Arc<OnceLock<Routine<T>>>, Vec<Code<T>>),
    /// A function with parameters at these places, to be called back.
    Closure(Vec<usize>, Box<Code<T>>),
    /// Statements, of which the last is the value.
    Block(Vec<Code<T>>),
    /// A pattern bound.
    Let(Pattern<T>, Box<Code<T>>, Option<Box<Code<T>>>),
    /// `if`
    If(Box<Code<T>>, Box<Code<T>>, Option<Box<Code<T>>>),
    /// `match`
    Match(Box<Code<T>>, Vec<Arm<T>>),
    /// `for` over counts.
    For(usize, Box<Code<T>>, Box<Code<T>>, Box<Code<T>>),
    /// A value put into places: one, or a tuple of them.
    Assign(Vec<Code<T>>, Box<Code<T>>),
    /// A number added to a place.
    Increase(Box<Code<T>>, Box<Code<T>>),
    /// A struct; fields not given are those of the base.
    Struct(Arc<Layout>, Vec<(usize, Code<T>)>, Option<Box<Code<T>>>),
    /// A tuple or an array.
    List(Vec<Code<T>>),
    /// An array of equal values.
    Repeat(Box<Code<T>>, Box<Code<T>>),
    /// A momentum of a frame.
    Momentum(Frame, Box<Code<T>>),
    /// A function of the model written out: `return` ends it.
    Function(Box<Code<T>>),
    /// `return`
    Return(Box<Code<T>>),
    /// `?`
    Try(Box<Code<T>>),
}

type Evaluated<T> = Result<Value<T>, Exit<T>>;

const WRONG: &str = "an operation on values of other kinds";

/// What a missing value ends in.
pub fn unfit<T: Real, V>(value: Option<V>) -> Result<V, Exit<T>> {
    value.ok_or(Exit::Unfit(WRONG))
}

/// An argument that stands at a place is not copied.
enum Given<T: Real> {
    There,
    Made(Value<T>),
}

impl<T: Real> Given<T> {
    fn of(code: &Code<T>, places: &mut Places<T>) -> Result<Self, Exit<T>> {
        match code.place(places).is_some() {
            true => Ok(Given::There),
            false => Ok(Given::Made(code.run(places)?)),
        }
    }

    fn get<'a>(&'a self, code: &'a Code<T>, places: &'a Places<T>) -> Result<&'a Value<T>, Exit<T>> {
        match self {
            Given::Made(value) => Ok(value),
            Given::There => unfit(code.place(places)),
        }
    }
}

impl<T: Real> Pattern<T> {
    /// Whether a value is met; it is then bound.
    pub fn bind(&self, value: Value<T>, places: &mut Places<T>) -> bool {
        match self {
            Pattern::Any => true,
            Pattern::Place(at) => {
                if let Some(place) = places.get_mut(*at) {
                    *place = value;
                }
                true
            }
            Pattern::List(patterns) => match value {
                Value::List(list) => {
                    let pairs = patterns.iter().zip(list);
                    pairs.fold(true, |met, (p, v)| met && p.bind(v, places))
                }
                Value::Unit => patterns.is_empty(),
                _ => false,
            },
            Pattern::Done(inner) => {
                !matches!(value, Value::Failed(_) | Value::None) && inner.bind(value, places)
            }
            Pattern::Failed(inner) => matches!(value, Value::Failed(_)) && inner.bind(value, places),
            Pattern::None => matches!(value, Value::None),
            Pattern::Exactly(other) => value == *other,
        }
    }
}

impl<T: Real> Code<T> {
    /// The value that stands at a place.
    #[inline]
    pub fn place<'a>(&'a self, places: &'a Places<T>) -> Option<&'a Value<T>> {
        match self {
            Code::Constant(value) => Some(value),
            Code::Place(at) => places.get(*at),
            Code::Field(base, name) => match base.place(places)? {
                Value::Struct(s) => s.field(*name),
                _ => None,
            },
            Code::Index(base, at) => match (base.place(places)?, at.as_slice()) {
                (Value::List(list), [Code::Constant(Value::Int(i))]) => {
                    list.get(usize::try_from(*i).ok()?)
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// The same, to be changed.
    pub fn place_mut<'a>(&self, places: &'a mut Places<T>) -> Option<&'a mut Value<T>> {
        match self {
            Code::Place(at) => places.get_mut(*at),
            Code::Field(base, name) => match base.place_mut(places)? {
                Value::Struct(s) => s.field_mut(*name),
                _ => None,
            },
            Code::Index(base, at) => match (base.place_mut(places)?, at.as_slice()) {
                (Value::List(list), [Code::Constant(Value::Int(i))]) => {
                    list.get_mut(usize::try_from(*i).ok()?)
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// The place by its number, where it is one of its own.
    pub fn number(&self) -> Option<usize> {
        match self {
            Code::Place(at) => Some(*at),
            _ => None,
        }
    }

    fn truth(&self, places: &mut Places<T>) -> Result<bool, Exit<T>> {
        match self.run(places)? {
            Value::Bool(b) => Ok(b),
            _ => Err(Exit::Unfit(WRONG)),
        }
    }

    fn count(&self, places: &mut Places<T>) -> Result<usize, Exit<T>> {
        unfit(self.run(places)?.count())
    }

    /// The value.
    ///
    /// # Errors
    /// [`Exit`] where a function returns from within.
    pub fn run(&self, places: &mut Places<T>) -> Evaluated<T> {
        Ok(match self {
            Code::Constant(value) => value.clone(),
            Code::Place(at) => unfit(places.get(*at))?.clone(),
            Code::Field(base, name) => {
                if let Some(value) = self.place(places) {
                    return Ok(value.clone());
                }
                let given = Given::of(base, places)?;
                unfit(crate::library::field(given.get(base, places)?, *name))?
            }
            Code::Inner(base) => {
                let given = Given::of(base, places)?;
                unfit(crate::library::inner(given.get(base, places)?))?
            }
            Code::Index(base, at) => {
                if let Some(value) = self.place(places) {
                    return Ok(value.clone());
                }
                let mut indices = [0; 2];
                for (index, code) in indices.iter_mut().zip(at) {
                    *index = code.count(places)?;
                }
                let given = Given::of(base, places)?;
                let value = given.get(base, places)?;
                unfit(crate::library::entry(value, indices, at.len()))?
            }
            Code::Binary(operator, a, b) => {
                let (x, y) = (Given::of(a, places)?, Given::of(b, places)?);
                let (x, y) = (x.get(a, places)?, y.get(b, places)?);
                unfit(crate::library::binary(*operator, x, y))?
            }
            Code::Lazy(settles, a, b) => match a.truth(places)? {
                truth if truth == *settles => Value::Bool(truth),
                _ => Value::Bool(b.truth(places)?),
            },
            Code::Negative(a) => {
                let x = Given::of(a, places)?;
                unfit(crate::library::negative(x.get(a, places)?))?
            }
            Code::Not(a) => Value::Bool(!a.truth(places)?),
            Code::Call(native, arguments, sizes) => match arguments.as_slice() {
                [] => unfit(native(&[], sizes))?,
                [a] => {
                    let x = Given::of(a, places)?;
                    unfit(native(&[x.get(a, places)?], sizes))?
                }
                [a, b] => {
                    let (x, y) = (Given::of(a, places)?, Given::of(b, places)?);
                    let list = [x.get(a, places)?, y.get(b, places)?];
                    unfit(native(&list, sizes))?
                }
                all => {
                    let mut given = Vec::with_capacity(all.len());
                    for a in all {
                        given.push(Given::of(a, places)?);
                    }
                    let pairs = given.iter().zip(all);
                    let list = pairs.map(|(x, a)| x.get(a, places));
                    let list: Vec<&Value<T>> = list.collect::<Result<_, _>>()?;
                    unfit(native(&list, sizes))?
                }
            },
            Code::Special(special, arguments) => special(places, arguments)?,
            Code::Routine(routine, arguments) => called(routine, arguments, places)?,
            Code::Closure(..) => return Err(Exit::Unfit(WRONG)),
            Code::Block(all) => {
                let Some((last, first)) = all.split_last() else {
                    return Ok(Value::Unit);
                };
                for code in first {
                    code.run(places)?;
                }
                last.run(places)?
            }
            Code::Let(pattern, value, otherwise) => {
                let value = value.run(places)?;
                if !pattern.bind(value, places) {
                    match otherwise {
                        Some(otherwise) => return otherwise.run(places),
                        None => return Err(Exit::Unfit(WRONG)),
                    }
                }
                Value::Unit
            }
            Code::If(condition, then, otherwise) => match (condition.truth(places)?, otherwise) {
                (true, _) => then.run(places)?,
                (false, Some(otherwise)) => otherwise.run(places)?,
                (false, None) => Value::Unit,
            },
            Code::Match(value, arms) => {
                let value = value.run(places)?;
                for arm in arms {
                    if !arm.pattern.bind(value.clone(), places) {
                        continue;
                    }
                    let holds = match &arm.guard {
                        Some(guard) => guard.truth(places)?,
                        None => true,
                    };
                    if holds {
                        return arm.body.run(places);
                    }
                }
                return Err(Exit::Unfit(WRONG));
            }
            Code::For(at, from, to, body) => {
                for i in from.count(places)?..to.count(places)? {
                    *unfit(places.get_mut(*at))? = Value::Int(i as i64);
                    body.run(places)?;
                }
                Value::Unit
            }
            Code::Assign(targets, value) => {
                let value = value.run(places)?;
                match (targets.as_slice(), value) {
                    ([target], value) => *unfit(target.place_mut(places))? = value,
                    (many, Value::List(values)) => {
                        for (target, value) in many.iter().zip(values) {
                            *unfit(target.place_mut(places))? = value;
                        }
                    }
                    _ => return Err(Exit::Unfit(WRONG)),
                }
                Value::Unit
            }
            Code::Increase(target, value) => {
                let value = value.run(places)?;
                let place = unfit(target.place_mut(places))?;
                *place = unfit(crate::library::binary(Operator::Add, place, &value))?;
                Value::Unit
            }
            Code::Struct(layout, given, base) => {
                let mut values = match base {
                    Some(base) => match base.run(places)? {
                        Value::Struct(base) => base.values,
                        _ => return Err(Exit::Unfit(WRONG)),
                    },
                    None => vec![Value::Unit; layout.fields.len()],
                };
                for (at, code) in given {
                    let value = code.run(places)?;
                    *unfit(values.get_mut(*at))? = value;
                }
                Value::Struct(Struct {
                    layout: layout.clone(),
                    values,
                })
            }
            Code::List(all) => {
                let values = all.iter().map(|code| code.run(places));
                match values.collect::<Result<Vec<_>, _>>()? {
                    values if values.is_empty() => Value::Unit,
                    values => Value::List(values),
                }
            }
            Code::Repeat(value, count) => {
                let (value, count) = (value.run(places)?, count.count(places)?);
                Value::List(vec![value; count])
            }
            Code::Momentum(frame, a) => {
                let x = Given::of(a, places)?;
                match x.get(a, places)? {
                    Value::Failed(e) => Value::Failed(e.clone()),
                    value => unfit(Value::momentum(*frame, value))?,
                }
            }
            Code::Function(body) => match body.run(places) {
                Err(Exit::Return(value)) => value,
                other => return other,
            },
            Code::Return(value) => return Err(Exit::Return(value.run(places)?)),
            Code::Try(value) => match value.run(places)? {
                Value::Failed(e) => return Err(Exit::Return(Value::Failed(e))),
                Value::None => return Err(Exit::Return(Value::None)),
                value => value,
            },
        })
    }

    /// Calls a closure back.
    ///
    /// # Errors
    /// As [`Code::run`].
    pub fn call(&self, arguments: Vec<Value<T>>, places: &mut Places<T>) -> Evaluated<T> {
        let Code::Closure(parameters, body) = self else {
            return Err(Exit::Unfit(WRONG));
        };
        for (at, value) in parameters.iter().zip(arguments) {
            *unfit(places.get_mut(*at))? = value;
        }
        match body.run(places) {
            Err(Exit::Return(value)) => Ok(value),
            other => other,
        }
    }
}

/// Calls a function of the model with places of its own.
fn called<T: Real>(
    routine: &OnceLock<Routine<T>>,
    arguments: &[Code<T>],
    places: &mut Places<T>,
) -> Evaluated<T> {
    let routine = unfit(routine.get())?;
    let mut own = Vec::with_capacity(routine.places);
    for a in arguments {
        own.push(a.run(places)?);
    }
    own.resize(routine.places.max(own.len()), Value::Unit);
    let value = match routine.body.run(&mut own) {
        Err(Exit::Return(value)) => value,
        other => other?,
    };
    for (a, changed) in arguments.iter().zip(own) {
        // What was lent is given back; what was not changed is put back as it was.
        if let Some(place) = a.place_mut(places) {
            *place = changed;
        }
    }
    Ok(value)
}

impl<T: Real> From<Failure> for Exit<T> {
    fn from(e: Failure) -> Self {
        Exit::Return(Value::failed(e))
    }
}
