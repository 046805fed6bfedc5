//! Loads numbers of lists into lanes, one site per lane, and stores them back.

use crate::code::Places;
use crate::map_scalar::{alike, map_scalar, numbers};
use crate::recorded::loop_inputs::List;
use crate::sites::Column;
use crate::value::Value;

/// The list that is read.
pub fn column<'a>(list: &'a List, places: &'a Places<f64>) -> Option<&'a Column<f64>> {
    let Value::Sites(column) = list.path.as_ref()?.place(places)? else {
        return None;
    };
    let mut column = column;
    for field in &list.fields {
        let Column::Structs(_, fields, _) = column else {
            return None;
        };
        column = fields.get(*field)?;
    }
    Some(column)
}

/// The numbers of a value, if it is of this kind.
pub fn numbers_of(value: &Value<f64>, kind: &Value<f64>, out: &mut Vec<f64>) -> Option<()> {
    out.clear();
    match alike(value, kind) {
        true => numbers(value, out),
        false => None,
    }
}

/// Fills inputs with components of the values at `count` sites of a list, starting at `from`. Further lanes repeat
/// the last site. `components` pairs inputs with components.
pub fn fill<const L: usize>(
    column: &Column<f64>,
    kind: &Value<f64>,
    [from, count]: [usize; 2],
    components: &[(usize, usize)],
    inputs: &mut [[f64; L]],
) -> Option<()> {
    match column {
        Column::Numbers(all) => {
            let own = all.get(from..from + count)?.iter().copied();
            for (input, _) in components {
                put(inputs.get_mut(*input)?, own.clone());
            }
        }
        Column::Arrays([rows, cols], all) => {
            let size = rows * cols;
            let all = all.get(from * size..(from + count) * size)?;
            for (input, component) in components {
                let own = all.iter().skip(*component).step_by(size.max(1));
                put(inputs.get_mut(*input)?, own.copied());
            }
        }
        Column::Attitudes(all) => {
            let all = all.get(from..from + count)?;
            for (input, component) in components {
                let own = all
                    .iter()
                    .map(|x| x.rotation().quaternion()[*component % 4]);
                put(inputs.get_mut(*input)?, own);
            }
        }
        other => {
            let mut own = Vec::new();
            for lane in 0..L {
                if lane < count {
                    numbers_of(&other.get(from + lane)?, kind, &mut own)?;
                }
                for (input, component) in components {
                    *inputs.get_mut(*input)?.get_mut(lane)? = *own.get(*component)?;
                }
            }
        }
    }
    Some(())
}

fn put<const L: usize>(lanes: &mut [f64; L], own: impl Iterator<Item = f64>) {
    let mut last = f64::NAN;
    let mut slots = lanes.iter_mut();
    for (slot, x) in slots.by_ref().zip(own) {
        *slot = x;
        last = x;
    }
    slots.for_each(|slot| *slot = last);
}

/// Stores outputs in a list, at `count` sites from `first` on. `output` returns the lanes of an output by its number;
/// `next` is the number of the next output.
pub fn store<'a>(
    column: &mut Column<f64>,
    [first, count]: [usize; 2],
    kind: &Value<f64>,
    next: &mut usize,
    output: &impl Fn(usize) -> &'a [f64],
) -> Option<()> {
    match (column, kind) {
        (Column::Numbers(all), Value::Real(_)) => {
            let own = output(*next).get(..count)?;
            all.get_mut(first..first + count)?.copy_from_slice(own);
            *next += 1;
        }
        (
            Column::Arrays([rows, cols], all),
            Value::Vector(_) | Value::Matrix(_) | Value::Dense(_),
        ) => {
            let size = *rows * *cols;
            let to = all.get_mut(first * size..(first + count) * size)?;
            for component in 0..size {
                let slots = to.iter_mut().skip(component).step_by(size);
                let own = output(*next + component);
                slots.zip(own).for_each(|(slot, x)| *slot = *x);
            }
            *next += size;
        }
        (Column::Structs(_, fields, _), Value::Struct(s)) => {
            for (field, kind) in fields.iter_mut().zip(&s.values) {
                store(field, [first, count], kind, next, output)?;
            }
        }
        (column, kind) => {
            let mut taken = 0;
            for lane in 0..count {
                taken = 0;
                let value = map_scalar(kind, &mut |_| {
                    taken += 1;
                    let own = output(*next + taken - 1).get(lane);
                    own.copied().unwrap_or(f64::NAN)
                })?;
                column.set(first + lane, &value)?;
            }
            *next += taken;
        }
    }
    Some(())
}

/// Appends this many sites to a list.
pub fn extend(column: &mut Column<f64>, count: usize, kind: &Value<f64>) -> Option<()> {
    match column {
        Column::Numbers(all) => all.resize(all.len() + count, 0.0),
        Column::Arrays([rows, cols], all) => all.resize(all.len() + count * *rows * *cols, 0.0),
        column => column.resize(column.len() + count, kind)?,
    }
    Some(())
}
