//! A body followed once, at the first site, with the values that are there: what is done with them becomes
//! operations. What is not known here has none, and the body is executed as it is.

use super::{At, Captured, Flat, Op, Read};
use crate::code::{Code, Known, Native, Operator, Pattern, Places};
use crate::library;
use crate::sites::Column;
use crate::value::{Struct, Value};
use clebsch::Real;
use clebsch::linalg::Dense;
use std::collections::BTreeMap;

/// Most operations of a body: a longer one is executed as it is.
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

    fn binary(&mut self, operator: Operator, a: &Slot<T>, b: &Slot<T>) -> Option<Slot<T>> {
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

    /// A function of the runtime as it is.
    fn native(&mut self, native: Native<T>, slots: &[Slot<T>], sizes: &[usize]) -> Option<Slot<T>> {
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

    fn call(
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

    fn function(&mut self, f: fn(T) -> T, x: &Slot<T>, native: Native<T>) -> Option<Slot<T>> {
        let value = native(&[&x.value], &[])?;
        let from = self.real(x)?;
        self.made(value, &[At::Real(from)], |to| {
            Some(Op::Function(f, from, first(to)?))
        })
    }

    /// Registers for a value, and the operation that fills them from those that it uses.
    fn made(
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

    /// Functions that change what they are given, and those that call back.
    fn special(&mut self, list: &[Code<T>], known: Known) -> Option<Slot<T>> {
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

/// The product of two arrays of any size.
fn times<T: Real>(a: &[&Value<T>], _: &[usize]) -> Option<Value<T>> {
    library::binary(Operator::Mul, a.first()?, a.get(1)?)
}

fn first<T: Real>(at: &At<T>) -> Option<usize> {
    match at {
        At::Real(x) | At::Array(_, x) => Some(*x),
        _ => None,
    }
}
