//! One function for each kind of operation. A single function would need a stack frame with room for the values of all
//! kinds.

use super::{Arm, Code, Evaluated, Exit, Native, Operator, Places, Routine, WRONG, unfit};
use crate::value::{Layout, Struct, Value};
use clebsch::Real;
use std::sync::{Arc, OnceLock};

/// An argument. A value that is stored in a place is not copied.
pub(super) enum CallArgument<T: Real> {
    There,
    Made(Value<T>),
}

impl<T: Real> CallArgument<T> {
    #[inline]
    pub(super) fn of(code: &Code<T>, places: &mut Places<T>) -> Result<Self, Exit<T>> {
        match code {
            Code::Place(_) | Code::Constant(_) => Ok(CallArgument::There),
            Code::Field(..) | Code::Index(..) if code.place(places).is_some() => {
                Ok(CallArgument::There)
            }
            _ => Ok(CallArgument::Made(code.run(places)?)),
        }
    }

    #[inline]
    pub(super) fn get<'a>(
        &'a self,
        code: &'a Code<T>,
        places: &'a Places<T>,
    ) -> Result<&'a Value<T>, Exit<T>> {
        match self {
            CallArgument::Made(value) => Ok(value),
            CallArgument::There => unfit(code.place(places)),
        }
    }
}

/// A function of one value.
#[inline(never)]
pub(super) fn apply<T: Real>(
    a: &Code<T>,
    places: &mut Places<T>,
    f: impl Fn(&Value<T>) -> Option<Value<T>>,
) -> Evaluated<T> {
    let x = CallArgument::of(a, places)?;
    unfit(f(x.get(a, places)?))
}

#[inline(never)]
pub(super) fn operation<T: Real>(
    operator: Operator,
    a: &Code<T>,
    b: &Code<T>,
    places: &mut Places<T>,
) -> Evaluated<T> {
    let x = CallArgument::of(a, places)?;
    let y = CallArgument::of(b, places)?;
    unfit(crate::library::binary(
        operator,
        x.get(a, places)?,
        y.get(b, places)?,
    ))
}

#[inline(never)]
pub(super) fn one<T: Real>(
    native: Native<T>,
    a: &Code<T>,
    sizes: &[usize],
    places: &mut Places<T>,
) -> Evaluated<T> {
    let x = CallArgument::of(a, places)?;
    unfit(native(&[x.get(a, places)?], sizes))
}

#[inline(never)]
pub(super) fn two<T: Real>(
    native: Native<T>,
    a: &Code<T>,
    b: &Code<T>,
    sizes: &[usize],
    places: &mut Places<T>,
) -> Evaluated<T> {
    let x = CallArgument::of(a, places)?;
    let y = CallArgument::of(b, places)?;
    unfit(native(&[x.get(a, places)?, y.get(b, places)?], sizes))
}

#[inline(never)]
pub(super) fn many<T: Real>(
    native: Native<T>,
    all: &[Code<T>],
    sizes: &[usize],
    places: &mut Places<T>,
) -> Evaluated<T> {
    match all.len() {
        0 => unfit(native(&[], sizes)),
        3 => several::<T, 3>(native, all, sizes, places),
        4 => several::<T, 4>(native, all, sizes, places),
        5 => several::<T, 5>(native, all, sizes, places),
        _ => Err(Exit::Unfit(WRONG)),
    }
}

#[inline(never)]
pub(super) fn several<T: Real, const N: usize>(
    native: Native<T>,
    all: &[Code<T>],
    sizes: &[usize],
    places: &mut Places<T>,
) -> Evaluated<T> {
    let mut given = [const { CallArgument::There }; N];
    for (slot, a) in given.iter_mut().zip(all) {
        *slot = CallArgument::of(a, places)?;
    }
    let nothing = Value::Unit;
    let mut list = [&nothing; N];
    for (slot, (x, a)) in list.iter_mut().zip(given.iter().zip(all)) {
        *slot = x.get(a, places)?;
    }
    unfit(native(&list, sizes))
}

#[inline(never)]
pub(super) fn matched<T: Real>(
    value: &Code<T>,
    arms: &[Arm<T>],
    places: &mut Places<T>,
) -> Evaluated<T> {
    let value = value.run(places)?;
    for arm in arms {
        if !arm.pattern.meets(&value) {
            continue;
        }
        let Some(guard) = &arm.guard else {
            arm.pattern.bind(value, places);
            return arm.body.run(places);
        };
        arm.pattern.bind(value.clone(), places);
        if guard.truth(places)? {
            return arm.body.run(places);
        }
    }
    Err(Exit::Unfit(WRONG))
}

#[inline(never)]
pub(super) fn made<T: Real>(
    layout: &Arc<Layout>,
    given: &[(usize, Code<T>)],
    base: Option<&Code<T>>,
    places: &mut Places<T>,
) -> Evaluated<T> {
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
    Ok(Value::Struct(Struct {
        layout: layout.clone(),
        values,
    }))
}

#[inline(never)]
pub(super) fn listed<T: Real>(all: &[Code<T>], places: &mut Places<T>) -> Evaluated<T> {
    let mut values = Vec::with_capacity(all.len());
    for code in all {
        values.push(code.run(places)?);
    }
    Ok(match values.is_empty() {
        true => Value::Unit,
        false => Value::List(values),
    })
}

#[inline(never)]
pub(super) fn repeated<T: Real>(
    value: &Code<T>,
    count: &Code<T>,
    places: &mut Places<T>,
) -> Evaluated<T> {
    let value = value.run(places)?;
    Ok(Value::List(vec![value; count.count(places)?]))
}

/// Calls a function of the model with places of its own.
#[inline(never)]
pub(super) fn called<T: Real>(
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
    let value = routine.body.returned(&mut own)?;
    for (a, changed) in arguments.iter().zip(own) {
        // Return every argument to its place, whether the function changed it or not.
        if let Some(place) = a.place_mut(places) {
            *place = changed;
        }
    }
    Ok(value)
}
