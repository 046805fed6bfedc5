//! The operations of a function, parsed once into a tree over numbered places. Execution needs no look-up of names.

mod apply;
mod map_scalar;
mod parts;
mod sweep;

use crate::failure::Failure;
use crate::listing::{FieldNames, Section};
use crate::recorded::Traced;
use crate::sites::Column;
use crate::value::{Frame, Layout, Value};
use apply::{apply, called, listed, made, many, matched, one, operation, repeated, two};
use clebsch::Real;
use clebsch::solvers::newton::Rounded;
use std::sync::{Arc, OnceLock};
pub use sweep::{Kind, Slice, Sweep, Terms};

/// The places of a function that runs: parameters, then locals.
pub type Places<T> = Vec<Value<T>>;

/// A function of the runtime. It returns nothing if it does not accept the arguments.
pub type Native<T> = fn(&[&Value<T>], &[usize]) -> Option<Value<T>>;

/// A function of the runtime that changes its first argument, or calls back.
pub type Special<T> = fn(&mut Places<T>, &[Code<T>]) -> Result<Value<T>, Exit<T>>;

/// A scalar with functions of the runtime over it.
pub trait Library: Real {
    /// A function by its name and how many arguments it takes.
    fn native(name: &str, arguments: usize) -> Option<Native<Self>>;

    /// A function that changes its first argument, or calls back.
    fn special(name: &str) -> Option<Special<Self>>;

    /// A loop, with its recording.
    fn iterate(_recorded: Option<Arc<dyn Iterate<Traced>>>) -> Option<Arc<dyn Iterate<Self>>> {
        None
    }
}

impl Library for f64 {
    fn native(name: &str, arguments: usize) -> Option<Native<Self>> {
        crate::library::native(name, arguments)
    }

    fn special(name: &str) -> Option<Special<Self>> {
        crate::library::special(name)
    }
}

/// Only residuals and the functions that they call are evaluated with rounding bounds. They call no solver and move no element.
impl Library for Rounded {
    fn native(name: &str, arguments: usize) -> Option<Native<Self>> {
        crate::library::kernel(name, arguments)
    }

    fn special(name: &str) -> Option<Special<Self>> {
        crate::library::kernel_special(name)
    }
}

/// Why the evaluation of an expression ends without a value.
#[derive(Debug)]
pub enum Exit<T: Real> {
    /// The function returns.
    Return(Box<Value<T>>),
    /// The operands do not fit the operation. Emitted code never causes this.
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
    /// `%`
    Rem,
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

/// A function that is called, not inlined.
#[derive(Debug)]
pub struct Routine<T: Real> {
    /// The number of places that it needs.
    pub places: usize,
    /// Its operations.
    pub body: Code<T>,
}

/// A pattern.
#[derive(Clone, Debug)]
pub enum Pattern<T: Real> {
    /// Anything.
    Any,
    /// Any value, bound to a place.
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
    Exactly(Box<Value<T>>),
    /// Any of these patterns.
    Or(Vec<Pattern<T>>),
    /// The full name of an enum variant, and patterns of its fields by their numbers.
    Variant(Arc<str>, Vec<(u32, Pattern<T>)>),
}

/// An arm of a match.
#[derive(Clone, Debug)]
pub struct Arm<T: Real> {
    /// The pattern.
    pub pattern: Pattern<T>,
    /// The condition behind `if`.
    pub guard: Option<Code<T>>,
    /// The expression behind `=>`.
    pub body: Code<T>,
}

/// A loop: Newton's method, or one over sites.
pub trait Iterate<T: Real>: std::fmt::Debug + Send + Sync {
    /// Iterates to the solution, or to the last site.
    ///
    /// # Errors
    /// [`Exit`] with the error of the step.
    fn run(&self, places: &mut Places<T>) -> Result<Value<T>, Exit<T>>;

    /// The recorded body of a loop over sites as text.
    fn section(&self, _names: &FieldNames) -> Option<Section> {
        None
    }

    /// The loop as a part of a recording, if it can be recorded.
    fn recorded(self: Arc<Self>) -> Option<Arc<dyn Iterate<Traced>>> {
        None
    }
}

/// An expression or a statement.
#[derive(Clone, Debug)]
pub enum Code<T: Real> {
    /// A constant.
    Constant(Box<Value<T>>),
    /// A place.
    Place(usize),
    /// A field of a struct, by the number of its name.
    Field(Box<Code<T>>, u32),
    /// The content of a newtype: `.0` of a momentum.
    Inner(Box<Code<T>>),
    /// An element of a list or of a matrix.
    Index(Box<Code<T>>, Vec<Code<T>>),
    /// An operator.
    Binary(Operator, Box<Code<T>>, Box<Code<T>>),
    /// `&&`, `||`: evaluates the second operand only if needed.
    Lazy(bool, Box<Code<T>>, Box<Code<T>>),
    /// `-`
    Negative(Box<Code<T>>),
    /// `!`
    Not(Box<Code<T>>),
    /// A function of the runtime, with sizes, and its name.
    Call(Native<T>, Vec<Code<T>>, Vec<usize>, Arc<str>),
    /// A function that changes places or calls back.
    Special(Special<T>, Vec<Code<T>>, Arc<str>),
    /// A function of the model with expressions as arguments; changed arguments are written back.
    Routine(Arc<OnceLock<Routine<T>>>, Vec<Code<T>>),
    /// A callback with parameters at these places.
    Closure(Vec<usize>, Box<Code<T>>),
    /// The loop of Newton's method, or one over sites.
    Iterate(Arc<dyn Iterate<T>>),
    /// Statements, of which the last is the value.
    Block(Vec<Code<T>>),
    /// A pattern bound.
    Let(Pattern<T>, Box<Code<T>>, Option<Box<Code<T>>>),
    /// A value that is computed once and then kept in a place.
    Once(usize, Box<Code<T>>),
    /// `if`
    If(Box<Code<T>>, Box<Code<T>>, Option<Box<Code<T>>>),
    /// `match`
    Match(Box<Code<T>>, Vec<Arm<T>>),
    /// `while`
    While(Box<Code<T>>, Box<Code<T>>),
    /// `for` over counts, upwards.
    For(usize, Box<Code<T>>, Box<Code<T>>, Box<Code<T>>),
    /// `for` over counts, downwards.
    Down(usize, Box<Code<T>>, Box<Code<T>>, Box<Code<T>>),
    /// An assignment of a value to one place, or to a tuple of places.
    Assign(Vec<Code<T>>, Box<Code<T>>),
    /// Adds a number to a place.
    Increase(Box<Code<T>>, Box<Code<T>>),
    /// A struct. Fields that are not listed come from the base.
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

/// A value, or the reason why it is missing.
pub type Evaluated<T> = Result<Value<T>, Exit<T>>;

const WRONG: &str = "an operation does not support values of these shapes";

/// Returns `Exit::Unfit` if a value is missing.
#[inline]
pub fn unfit<T: Real, V>(value: Option<V>) -> Result<V, Exit<T>> {
    value.ok_or(Exit::Unfit(WRONG))
}

impl<T: Real> Pattern<T> {
    /// Whether a value matches.
    pub(crate) fn meets(&self, value: &Value<T>) -> bool {
        match self {
            Pattern::Any | Pattern::Place(_) => true,
            Pattern::List(patterns) => match value {
                Value::List(list) => patterns.iter().zip(list).all(|(p, v)| p.meets(v)),
                Value::Unit => patterns.is_empty(),
                _ => false,
            },
            Pattern::Done(inner) => {
                !matches!(value, Value::Failed(_) | Value::None) && inner.meets(value)
            }
            Pattern::Failed(inner) => match value {
                Value::Failed(e) => match &**e {
                    // A site and its error, a functional and its error.
                    Failure::At(..) | Failure::Functional(..) => true,
                    _ => inner.meets(value),
                },
                _ => false,
            },
            Pattern::None => matches!(value, Value::None),
            Pattern::Exactly(other) => *value == **other,
            Pattern::Or(all) => all.iter().any(|p| p.meets(value)),
            Pattern::Variant(name, fields) => match value {
                Value::Struct(s) => {
                    let met = |(number, p): &(u32, Pattern<T>)| {
                        s.field(*number).is_some_and(|value| p.meets(value))
                    };
                    s.layout.name == **name && fields.iter().all(met)
                }
                _ => false,
            },
        }
    }

    /// Binds a value that matches.
    fn bind(&self, value: Value<T>, places: &mut Places<T>) {
        match (self, value) {
            (Pattern::Place(at), value) => {
                if let Some(place) = places.get_mut(*at) {
                    *place = value;
                }
            }
            (Pattern::List(patterns), Value::List(list)) => {
                let pairs = patterns.iter().zip(list);
                pairs.for_each(|(p, v)| p.bind(v, places));
            }
            (Pattern::Failed(inner), Value::Failed(e)) => match *e {
                Failure::At(site, e) => {
                    let both = vec![Value::Int(site as i64), Value::Failed(e)];
                    inner.bind(Value::List(both), places);
                }
                Failure::Functional(name, e) => {
                    let both = vec![Value::Text(name), Value::failed(e)];
                    inner.bind(Value::List(both), places);
                }
                Failure::Site(site) => inner.bind(Value::Int(site as i64), places),
                e => inner.bind(Value::failed(e), places),
            },
            (Pattern::Done(inner) | Pattern::Failed(inner), value) => inner.bind(value, places),
            (Pattern::Variant(_, fields), Value::Struct(mut s)) => {
                for (number, pattern) in fields {
                    if let Some(value) = s.field_mut(*number) {
                        let value = std::mem::replace(value, Value::Unit);
                        pattern.bind(value, places);
                    }
                }
            }
            (Pattern::Or(all), value) => {
                if let Some(pattern) = all.iter().find(|p| p.meets(&value)) {
                    pattern.bind(value, places);
                }
            }
            _ => {}
        }
    }
}

impl<T: Real> Code<T> {
    /// The stored value that an expression refers to, if it refers to one.
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
                (Value::List(list), [index]) => list.get(index.constant_count()?),
                _ => None,
            },
            _ => None,
        }
    }

    /// Like `place`, by mutable reference.
    pub fn place_mut<'a>(&self, places: &'a mut Places<T>) -> Option<&'a mut Value<T>> {
        match self {
            Code::Place(at) => places.get_mut(*at),
            Code::Field(base, name) => match base.place_mut(places)? {
                Value::Struct(s) => s.field_mut(*name),
                _ => None,
            },
            Code::Index(base, at) => match (base.place_mut(places)?, at.as_slice()) {
                (Value::List(list), [index]) => list.get_mut(index.constant_count()?),
                _ => None,
            },
            _ => None,
        }
    }

    fn truth(&self, places: &mut Places<T>) -> Result<bool, Exit<T>> {
        match self.run(places)? {
            Value::Bool(b) => Ok(b),
            _ => Err(Exit::Unfit(WRONG)),
        }
    }

    pub(crate) fn count(&self, places: &mut Places<T>) -> Result<usize, Exit<T>> {
        unfit(self.run(places)?.count())
    }

    /// The value of a function with this body, also if it returns from within.
    ///
    /// # Errors
    /// [`Exit::Unfit`] for values that an operation does not take.
    pub fn returned(&self, places: &mut Places<T>) -> Evaluated<T> {
        match self.run(places) {
            Err(Exit::Return(value)) => Ok(*value),
            other => other,
        }
    }

    /// The value.
    ///
    /// # Errors
    /// [`Exit`] where a function returns from within.
    pub fn run(&self, places: &mut Places<T>) -> Evaluated<T> {
        // One function for each kind: a single function would need a stack frame for the values of all kinds.
        match self {
            Code::Constant(value) => Ok(Value::clone(value)),
            Code::Place(at) => Ok(unfit(places.get(*at))?.clone()),
            Code::Field(base, name) => self.field(base, *name, places),
            Code::Inner(base) => apply(base, places, crate::library::inner),
            Code::Index(base, at) => self.entry(base, at, places),
            Code::Binary(operator, a, b) => operation(*operator, a, b, places),
            Code::Lazy(settles, a, b) => match a.truth(places)? {
                truth if truth == *settles => Ok(Value::Bool(truth)),
                _ => Ok(Value::Bool(b.truth(places)?)),
            },
            Code::Negative(a) => apply(a, places, crate::library::negative),
            Code::Not(a) => Ok(Value::Bool(!a.truth(places)?)),
            Code::Call(native, arguments, sizes, _) => match arguments.as_slice() {
                [a] => one(*native, a, sizes, places),
                [a, b] => two(*native, a, b, sizes, places),
                all => many(*native, all, sizes, places),
            },
            Code::Special(special, arguments, _) => special(places, arguments),
            Code::Routine(routine, arguments) => called(routine, arguments, places),
            Code::Iterate(iterate) => iterate.run(places),
            Code::Closure(..) => Err(Exit::Unfit(WRONG)),
            Code::Block(all) => {
                let Some((last, first)) = all.split_last() else {
                    return Ok(Value::Unit);
                };
                for code in first {
                    code.follow(places)?;
                }
                last.run(places)
            }
            Code::Let(..)
            | Code::Once(..)
            | Code::Assign(..)
            | Code::Increase(..)
            | Code::For(..)
            | Code::While(..)
            | Code::Down(..) => {
                self.follow(places)?;
                Ok(Value::Unit)
            }
            Code::If(condition, then, otherwise) => match (condition.truth(places)?, otherwise) {
                (true, _) => then.run(places),
                (false, Some(otherwise)) => otherwise.run(places),
                (false, None) => Ok(Value::Unit),
            },
            Code::Match(value, arms) => matched(value, arms, places),
            Code::Struct(layout, given, base) => made(layout, given, base.as_deref(), places),
            Code::List(all) => listed(all, places),
            Code::Repeat(value, count) => repeated(value, count, places),
            Code::Momentum(frame, a) => apply(a, places, |x| match x {
                Value::Failed(e) => Some(Value::Failed(e.clone())),
                value => Value::momentum(*frame, value),
            }),
            Code::Function(body) => body.returned(places),
            Code::Return(value) => Err(Exit::Return(Box::new(value.run(places)?))),
            Code::Try(value) => match value.run(places)? {
                Value::Failed(e) => Err(Exit::Return(Box::new(Value::Failed(e)))),
                Value::None => Err(Exit::Return(Box::new(Value::None))),
                value => Ok(value),
            },
        }
    }

    /// A statement.
    fn follow(&self, places: &mut Places<T>) -> Result<(), Exit<T>> {
        match self {
            Code::Let(pattern, value, otherwise) => {
                let value = value.run(places)?;
                if let Pattern::Place(at) = pattern {
                    *unfit(places.get_mut(*at))? = value;
                    return Ok(());
                }
                if pattern.meets(&value) {
                    pattern.bind(value, places);
                    return Ok(());
                }
                match otherwise {
                    Some(otherwise) => otherwise.run(places).map(|_| ()),
                    None => Err(Exit::Unfit(WRONG)),
                }
            }
            Code::Once(at, value) => {
                if let Some(Value::Unit) = places.get(*at) {
                    let value = value.run(places)?;
                    *unfit(places.get_mut(*at))? = value;
                }
                Ok(())
            }
            Code::Assign(targets, value) => {
                let value = value.run(places)?;
                match (targets.as_slice(), value) {
                    ([target], value) => target.put(value, places)?,
                    (many, Value::List(values)) => {
                        for (target, value) in many.iter().zip(values) {
                            target.put(value, places)?;
                        }
                    }
                    _ => return Err(Exit::Unfit(WRONG)),
                }
                Ok(())
            }
            Code::Increase(target, value) => {
                let value = value.run(places)?;
                let sum = match target.place(places) {
                    Some(place) => crate::library::binary(Operator::Add, place, &value),
                    None => {
                        let before = target.run(places)?;
                        crate::library::binary(Operator::Add, &before, &value)
                    }
                };
                target.put(unfit(sum)?, places)
            }
            Code::For(at, from, to, body) => {
                for i in from.count(places)?..to.count(places)? {
                    *unfit(places.get_mut(*at))? = Value::Int(i as i64);
                    body.run(places)?;
                }
                Ok(())
            }
            Code::While(condition, body) => {
                while condition.truth(places)? {
                    body.run(places)?;
                }
                Ok(())
            }
            Code::Down(at, from, to, body) => {
                for i in (from.count(places)?..to.count(places)?).rev() {
                    *unfit(places.get_mut(*at))? = Value::Int(i as i64);
                    body.run(places)?;
                }
                Ok(())
            }
            other => other.run(places).map(|_| ()),
        }
    }

    /// Writes a value to a place, or to a site of a list.
    fn put(&self, value: Value<T>, places: &mut Places<T>) -> Result<(), Exit<T>> {
        if let Some(place) = self.place_mut(places) {
            *place = value;
            return Ok(());
        }
        let mut fields = Vec::new();
        let mut list = self;
        while let Code::Field(base, name) = list {
            fields.push(*name);
            list = base;
        }
        let Code::Index(base, at) = list else {
            return Err(Exit::Unfit(WRONG));
        };
        let [at] = at.as_slice() else {
            return Err(Exit::Unfit(WRONG));
        };
        let site = at.count(places)?;
        let done = match base.place_mut(places) {
            Some(Value::Sites(column)) => {
                let field =
                    |column, name| Option::and_then(column, |c: &mut Column<T>| c.field_mut(name));
                let column = fields.into_iter().rev().fold(Some(column), field);
                column.and_then(|c| c.set(site, &value))
            }
            Some(Value::List(list)) if fields.is_empty() => {
                list.get_mut(site).map(|place| *place = value)
            }
            _ => None,
        };
        unfit(done)
    }

    #[inline(never)]
    fn field(&self, base: &Code<T>, name: u32, places: &mut Places<T>) -> Evaluated<T> {
        match self.place(places) {
            Some(value) => Ok(value.clone()),
            None => apply(base, places, |x| crate::library::field(x, name)),
        }
    }

    #[inline(never)]
    fn entry(&self, base: &Code<T>, at: &[Code<T>], places: &mut Places<T>) -> Evaluated<T> {
        if let Some(value) = self.place(places) {
            return Ok(value.clone());
        }
        let mut indices = [0; 2];
        for (index, code) in indices.iter_mut().zip(at) {
            *index = code.count(places)?;
        }
        apply(base, places, |x| {
            crate::library::entry(x, indices, at.len())
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
        body.returned(places)
    }
}

impl<T: Real> From<Failure> for Exit<T> {
    fn from(e: Failure) -> Self {
        Exit::Return(Box::new(Value::failed(e)))
    }
}
