//! A body followed once, at the first site, with the values that are there: what is done with them becomes
//! operations. What is not known here has none, and the body is executed as it is.

mod arithmetic;
mod calls;
mod changed;

use super::{At, Captured, Flat, Op, Read};
use crate::code::{Code, Operator, Pattern, Places};
use crate::library;
use crate::sites::Column;
use crate::value::{Struct, Value};
use clebsch::Real;
use clebsch::linalg::Dense;
use std::collections::BTreeMap;

/// Most operations of a body: beyond these it is executed without a trace.
const MOST: usize = 1 << 14;

/// A value that is followed: what it is at the first site, and where it stands at each.
#[derive(Clone, Debug)]
struct Slot<T: Real> {
    value: Value<T>,
    loc: Loc<T>,
}

#[derive(Clone, Debug)]
enum Loc<T: Real> {
    One(At<T>),
    Many(Vec<Slot<T>>),
    /// An attitude in a list, at the site of a count.
    Attitude(usize, usize),
}

struct Tracer<'a, T: Real> {
    places: &'a Places<T>,
    env: BTreeMap<usize, Slot<T>>,
    paths: BTreeMap<String, Slot<T>>,
    lists: BTreeMap<String, usize>,
    /// Of each register, whether it is the same at all sites.
    steady: [Vec<bool>; 3],
    flat: Flat<T>,
}

/// The kinds of registers.
const NUMBERS: usize = 0;
const INTS: usize = 1;
const OBJECTS: usize = 2;

/// A body as operations, if all of it is known. `site` is the first site, `kept` what comes in there; `zeros`
/// are the shapes of what comes out, for values that are zero whatever their shape.
pub fn traced<T: Real>(
    places: &Places<T>,
    parameters: &[usize],
    body: &Code<T>,
    site: usize,
    kept: Option<Value<T>>,
    shapes: &[Option<[usize; 2]>],
) -> Option<Flat<T>> {
    let mut tracer = Tracer {
        places,
        env: BTreeMap::new(),
        paths: BTreeMap::new(),
        lists: BTreeMap::new(),
        steady: [Vec::new(), vec![false], Vec::new()],
        flat: Flat {
            captured: Vec::new(),
            columns: Vec::new(),
            numbers: Vec::new(),
            ints: vec![0],
            objects: Vec::new(),
            before: Vec::new(),
            body: Vec::new(),
            kept: None,
            out: Vec::new(),
        },
    };
    let index = Slot {
        value: Value::Int(i64::try_from(site).ok()?),
        loc: Loc::One(At::Int(0)),
    };
    tracer.env.insert(*parameters.first()?, index);
    if let (Some(value), Some(at)) = (kept, parameters.get(1)) {
        let slot = tracer.place_for(value, false)?;
        let Loc::One(own) = &slot.loc else {
            return None;
        };
        tracer.flat.kept = Some(own.clone());
        tracer.env.insert(*at, slot);
    }
    let slot = tracer.trace(body)?;
    let slots = match (shapes.len(), slot.loc) {
        (0, _) => Vec::new(),
        (1, loc) => vec![Slot {
            value: slot.value,
            loc,
        }],
        (n, Loc::Many(all)) if all.len() == n => all,
        _ => return None,
    };
    for (slot, shape) in slots.into_iter().zip(shapes) {
        let out = match slot.loc {
            Loc::Many(all) => {
                let all = all.into_iter().map(|s| tracer.standing(s, None));
                all.collect::<Option<Vec<At<T>>>>()?
            }
            _ => vec![tracer.standing(slot, *shape)?],
        };
        tracer.flat.out.push(out);
    }
    let count = tracer.flat.before.len() + tracer.flat.body.len();
    (count <= MOST).then_some(tracer.flat)
}

/// The place that a path begins with.
fn root<T: Real>(code: &Code<T>) -> Option<usize> {
    match code {
        Code::Place(at) => Some(*at),
        Code::Field(base, _) => root(base),
        _ => None,
    }
}

fn constant<T: Real>(value: Value<T>) -> Slot<T> {
    Slot {
        loc: Loc::One(At::Constant(value.clone())),
        value,
    }
}

fn inner<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    library::inner(a.first()?)
}

impl<T: Real> Tracer<'_, T> {
    /// Registers for a value of this kind.
    fn place_for(&mut self, value: Value<T>, steady: bool) -> Option<Slot<T>> {
        let at = match &value {
            Value::Real(_) => At::Real(self.numbers(1, steady)),
            Value::Vector(_) => At::Array([3, 1], self.numbers(3, steady)),
            Value::Matrix(_) => At::Array([3, 3], self.numbers(9, steady)),
            Value::Dense(a) => At::Array([a.rows, a.cols], self.numbers(a.rows * a.cols, steady)),
            Value::Int(_) => {
                self.flat.ints.push(0);
                self.steady[INTS].push(steady);
                At::Int(self.flat.ints.len() - 1)
            }
            Value::Unit => At::Constant(Value::Unit),
            // What a body ends with where something fails.
            Value::Failed(_) | Value::None | Value::Zeros => return None,
            Value::Struct(_) | Value::List(_) | Value::Sites(_) => return None,
            value => {
                self.flat.objects.push(value.clone());
                self.steady[OBJECTS].push(steady);
                At::Object(self.flat.objects.len() - 1)
            }
        };
        Some(Slot {
            value,
            loc: Loc::One(at),
        })
    }

    fn numbers(&mut self, count: usize, steady: bool) -> usize {
        let from = self.flat.numbers.len();
        self.flat.numbers.resize(from + count, T::zero());
        self.steady[NUMBERS].resize(from + count, steady);
        from
    }

    fn is_steady(&self, at: &At<T>) -> bool {
        let known = |kind: usize, x: usize| self.steady[kind].get(x).copied().unwrap_or(false);
        match at {
            At::Constant(_) => true,
            At::Real(x) | At::Array(_, x) => known(NUMBERS, *x),
            At::Int(x) => known(INTS, *x),
            At::Object(x) => known(OBJECTS, *x),
        }
    }

    fn emit(&mut self, op: Op<T>, steady: bool) {
        match steady {
            true => self.flat.before.push(op),
            false => self.flat.body.push(op),
        }
    }

    /// A constant put into registers.
    fn put(&mut self, value: &Value<T>) -> Option<At<T>> {
        let slot = self.place_for(value.clone(), true)?;
        let Loc::One(at) = slot.loc else {
            return None;
        };
        match (&at, value) {
            (At::Real(x), Value::Real(v)) => *self.flat.numbers.get_mut(*x)? = *v,
            (At::Array(dims, x), value) => {
                let data = value.dense()?.data;
                let own = self.flat.numbers.get_mut(*x..*x + dims[0] * dims[1])?;
                own.copy_from_slice(&data);
            }
            (At::Int(x), Value::Int(n)) => *self.flat.ints.get_mut(*x)? = *n,
            _ => {}
        }
        Some(at)
    }

    /// Where a value stands, in registers.
    fn standing(&mut self, slot: Slot<T>, zeros: Option<[usize; 2]>) -> Option<At<T>> {
        match slot.loc {
            Loc::One(At::Constant(Value::Zeros)) => {
                let [rows, cols] = zeros?;
                self.put(&Value::of(Dense::zeros(rows, cols)))
            }
            Loc::One(At::Constant(value)) => self.put(&value),
            Loc::One(at) => Some(at),
            Loc::Attitude(column, site) => {
                let made = self.place_for(slot.value, false)?;
                let Loc::One(At::Object(to)) = made.loc else {
                    return None;
                };
                self.emit(Op::Value(column, site, to), false);
                Some(At::Object(to))
            }
            Loc::Many(_) => None,
        }
    }

    /// The same as an argument of a function, where constants stay.
    fn argument(&mut self, slot: Slot<T>) -> Option<At<T>> {
        match slot.loc {
            Loc::One(at) => Some(at),
            _ => self.standing(slot, None),
        }
    }

    fn real(&mut self, slot: &Slot<T>) -> Option<usize> {
        match self.standing(slot.clone(), None)? {
            At::Real(x) => Some(x),
            _ => None,
        }
    }

    fn array(&mut self, slot: &Slot<T>, zeros: Option<[usize; 2]>) -> Option<([usize; 2], usize)> {
        match self.standing(slot.clone(), zeros)? {
            At::Array(dims, x) => Some((dims, x)),
            _ => None,
        }
    }

    /// The body or a part of it.
    fn trace(&mut self, code: &Code<T>) -> Option<Slot<T>> {
        match code {
            Code::Constant(value) => Some(constant(value.clone())),
            Code::Place(at) => match self.env.get(at) {
                Some(slot) => Some(slot.clone()),
                None => self.captured(code),
            },
            Code::Field(base, name) => self.field(code, base, *name),
            Code::Index(base, at) => self.index(base, at),
            Code::Inner(base) => {
                let slot = self.trace(base)?;
                match slot.loc {
                    Loc::Many(all) => all.into_iter().next(),
                    _ => self.native(inner, &[slot], &[]),
                }
            }
            Code::Binary(operator, a, b) => {
                let (a, b) = (self.trace(a)?, self.trace(b)?);
                self.binary(*operator, &a, &b)
            }
            Code::Negative(a) => {
                let a = self.trace(a)?;
                let value = library::negative(&a.value)?;
                if let Loc::One(At::Constant(_)) = a.loc {
                    return Some(constant(value));
                }
                let at = self.standing(a, None)?;
                let steady = self.is_steady(&at);
                let made = self.place_for(value, steady)?;
                let op = match (&at, &made.loc) {
                    (At::Real(x), Loc::One(At::Real(to))) => Op::Neg(*x, *to),
                    (At::Array(dims, x), Loc::One(At::Array(_, to))) => {
                        Op::NegEach(*x, dims[0] * dims[1], *to)
                    }
                    _ => return None,
                };
                self.emit(op, steady);
                Some(made)
            }
            Code::Call(native, list, sizes, known) => self.call(*native, list, sizes, *known),
            Code::Special(_, list, known) => self.special(list, *known),
            Code::Block(all) => {
                let (last, first) = all.split_last()?;
                for code in first {
                    self.follow(code)?;
                }
                self.trace(last)
            }
            Code::Let(..)
            | Code::Once(..)
            | Code::Assign(..)
            | Code::Increase(..)
            | Code::For(..) => {
                self.follow(code)?;
                Some(constant(Value::Unit))
            }
            Code::Function(body) => self.trace(body),
            Code::Try(value) => self.trace(value),
            Code::Match(value, arms) => {
                let value = self.trace(value)?;
                // What succeeds here may fail elsewhere, which is left to the body; other choices may
                // differ from site to site.
                let fixed = matches!(value.loc, Loc::One(At::Constant(_)));
                let usual = |p: &Pattern<T>| match p {
                    Pattern::Done(inner) => matches!(**inner, Pattern::Any | Pattern::Place(_)),
                    Pattern::Failed(_) | Pattern::None | Pattern::Any | Pattern::Place(_) => true,
                    _ => false,
                };
                for arm in arms {
                    if arm.guard.is_some() || !(fixed || usual(&arm.pattern)) {
                        return None;
                    }
                    if arm.pattern.meets(&value.value) {
                        self.bind(&arm.pattern, value)?;
                        return self.trace(&arm.body);
                    }
                }
                None
            }
            Code::If(condition, then, otherwise) => {
                let condition = self.trace(condition)?;
                match (condition.loc, otherwise) {
                    (Loc::One(At::Constant(Value::Bool(true))), _) => self.trace(then),
                    (Loc::One(At::Constant(Value::Bool(false))), Some(e)) => self.trace(e),
                    (Loc::One(At::Constant(Value::Bool(false))), None) => {
                        Some(constant(Value::Unit))
                    }
                    _ => None,
                }
            }
            Code::Struct(layout, given, None) => {
                let mut all = vec![constant(Value::Unit); layout.fields.len()];
                for (at, code) in given {
                    *all.get_mut(*at)? = self.trace(code)?;
                }
                let values = all.iter().map(|s| s.value.clone()).collect();
                Some(Slot {
                    value: Value::Struct(Struct {
                        layout: layout.clone(),
                        values,
                    }),
                    loc: Loc::Many(all),
                })
            }
            Code::List(all) => {
                let all = all.iter().map(|c| self.trace(c));
                let all = all.collect::<Option<Vec<Slot<T>>>>()?;
                let values = all.iter().map(|s| s.value.clone()).collect();
                Some(Slot {
                    value: Value::List(values),
                    loc: Loc::Many(all),
                })
            }
            _ => None,
        }
    }

    /// A statement.
    fn follow(&mut self, code: &Code<T>) -> Option<()> {
        match code {
            Code::Let(pattern, value, _) => {
                let value = self.trace(value)?;
                self.bind(pattern, value)
            }
            Code::Once(at, value) => {
                let value = self.trace(value)?;
                self.env.insert(*at, value);
                Some(())
            }
            Code::Assign(targets, value) => {
                let [Code::Place(at)] = targets.as_slice() else {
                    return None;
                };
                let value = self.trace(value)?;
                self.env.get_mut(at).map(|slot| *slot = value)
            }
            Code::Increase(target, value) => {
                let Code::Place(at) = &**target else {
                    return None;
                };
                let value = self.trace(value)?;
                let before = self.env.get(at)?.clone();
                let sum = self.binary(Operator::Add, &before, &value)?;
                self.env.insert(*at, sum);
                Some(())
            }
            Code::For(at, from, to, body) => {
                let (from, to) = (self.trace(from)?, self.trace(to)?);
                let (Loc::One(At::Constant(from)), Loc::One(At::Constant(to))) = (from.loc, to.loc)
                else {
                    return None;
                };
                for i in from.count()?..to.count()? {
                    self.env.insert(*at, constant(Value::Int(i as i64)));
                    self.trace(body)?;
                }
                Some(())
            }
            other => self.trace(other).map(|_| ()),
        }
    }

    fn bind(&mut self, pattern: &Pattern<T>, slot: Slot<T>) -> Option<()> {
        match pattern {
            Pattern::Any => Some(()),
            Pattern::Place(at) => {
                self.env.insert(*at, slot);
                Some(())
            }
            Pattern::Done(inner) => self.bind(inner, slot),
            Pattern::List(all) => match slot.loc {
                Loc::Many(slots) if slots.len() == all.len() => {
                    for (pattern, slot) in all.iter().zip(slots) {
                        self.bind(pattern, slot)?;
                    }
                    Some(())
                }
                _ => None,
            },
            Pattern::Exactly(_) => Some(()),
            _ => None,
        }
    }

    /// What stands at a place around the loop.
    fn captured(&mut self, path: &Code<T>) -> Option<Slot<T>> {
        if self.env.contains_key(&root(path)?) {
            return None;
        }
        let key = format!("{path:?}");
        if let Some(known) = self.paths.get(&key) {
            return Some(known.clone());
        }
        let value = path.place(self.places)?;
        if let Value::Struct(_) | Value::List(_) | Value::Sites(_) = value {
            return None;
        }
        let slot = self.place_for(value.clone(), true)?;
        if let Loc::One(to) = &slot.loc {
            let (path, to) = (path.clone(), to.clone());
            self.flat.captured.push(Captured { path, to });
        }
        self.paths.insert(key, slot.clone());
        Some(slot)
    }

    /// How many sites a list around the loop has.
    fn length(&mut self, path: &Code<T>) -> Option<Slot<T>> {
        if self.env.contains_key(&root(path)?) {
            return None;
        }
        let Value::Sites(column) = path.place(self.places)? else {
            return None;
        };
        let slot = self.place_for(Value::Int(i64::try_from(column.len()).ok()?), true)?;
        if let Loc::One(to) = &slot.loc {
            let (path, to) = (path.clone(), to.clone());
            self.flat.captured.push(Captured { path, to });
        }
        Some(slot)
    }

    fn field(&mut self, code: &Code<T>, base: &Code<T>, name: u32) -> Option<Slot<T>> {
        if let Some(slot) = self.captured(code) {
            return Some(slot);
        }
        // A field of the struct of a site.
        if let Code::Index(list, at) = base
            && let [at] = at.as_slice()
            && let Some(column) = self.column(list, Some(name))
        {
            let site = self.trace(at)?;
            return self.loaded(list, Some(name), column, site);
        }
        let slot = self.trace(base)?;
        let (Value::Struct(s), Loc::Many(all)) = (slot.value, slot.loc) else {
            return None;
        };
        let at = s.layout.fields.iter().position(|f| *f == name)?;
        all.into_iter().nth(at)
    }

    /// The number of a list, or of a field of a list of structs.
    fn column(&mut self, path: &Code<T>, field: Option<u32>) -> Option<usize> {
        if self.env.contains_key(&root(path)?) {
            return None;
        }
        let Value::Sites(column) = path.place(self.places)? else {
            return None;
        };
        if let Some(name) = field {
            column.field(name)?;
        }
        let key = format!("{path:?} {field:?}");
        let next = self.flat.columns.len();
        let at = *self.lists.entry(key).or_insert(next);
        if at == next {
            let path = path.clone();
            self.flat.columns.push(Read { path, field });
        }
        Some(at)
    }

    /// What a list has at a site.
    fn loaded(
        &mut self,
        path: &Code<T>,
        field: Option<u32>,
        at: usize,
        site: Slot<T>,
    ) -> Option<Slot<T>> {
        let Value::Sites(column) = path.place(self.places)? else {
            return None;
        };
        let column = match field {
            Some(name) => column.field(name)?,
            None => column,
        };
        let value = column.get(site.value.count()?)?;
        let At::Int(site) = self.standing(site, None)? else {
            return None;
        };
        if let Column::Attitudes(_) = column {
            return Some(Slot {
                value,
                loc: Loc::Attitude(at, site),
            });
        }
        let steady = self.is_steady(&At::Int(site));
        let made = self.place_for(value, steady)?;
        let op = match &made.loc {
            Loc::One(At::Real(to)) => Op::Number(at, site, *to),
            Loc::One(At::Array(dims, to)) => Op::Array(at, site, *dims, *to),
            Loc::One(At::Object(to)) => Op::Value(at, site, *to),
            _ => return None,
        };
        self.emit(op, steady);
        Some(made)
    }

    fn index(&mut self, base: &Code<T>, at: &[Code<T>]) -> Option<Slot<T>> {
        if let [at] = at
            && let Some(column) = self.column(base, None)
        {
            let site = self.trace(at)?;
            return self.loaded(base, None, column, site);
        }
        let slot = self.trace(base)?;
        let mut indices = [0; 2];
        for (index, code) in indices.iter_mut().zip(at) {
            let Loc::One(At::Constant(n)) = self.trace(code)?.loc else {
                return None;
            };
            *index = n.count()?;
        }
        if let Loc::Many(all) = slot.loc {
            return all.into_iter().nth(indices[0]);
        }
        let value = library::entry(&slot.value, indices, at.len())?;
        let ([rows, cols], from) = self.array(&slot, None)?;
        let [i, j] = match at.len() {
            1 => [indices[0] % rows, indices[0] / rows],
            _ => indices,
        };
        (i < rows && j < cols).then_some(Slot {
            value,
            loc: Loc::One(At::Real(from + j * rows + i)),
        })
    }
}

fn first<T: Real>(at: &At<T>) -> Option<usize> {
    match at {
        At::Real(x) | At::Array(_, x) => Some(*x),
        _ => None,
    }
}
