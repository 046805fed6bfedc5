//! The numbers of values that may contain lists of sites. All other values are as in [`map_scalar`].

use crate::map_scalar;
use crate::sites::Column;
use crate::value::{Struct, Value};
use clebsch::Real;
use clebsch::line::Attitude;
use clebsch::{OfScalars, Rotation};

/// The value with every number replaced. Returns nothing for the memory of a solver.
pub fn map<T: Real, U: Real>(
    value: &Value<T>,
    change: &mut impl FnMut(T) -> U,
) -> Option<Value<U>> {
    Some(match value {
        Value::Stamp(stamp) => Value::Stamp(*stamp),
        Value::At(place) => Value::At(*place),
        Value::Extent(extent) => Value::Extent(*extent),
        Value::Struct(s) => Value::Struct(Struct {
            layout: s.layout.clone(),
            values: map_all(&s.values, change)?,
        }),
        Value::List(list) => Value::List(map_all(list, change)?),
        Value::Sites(column) => Value::Sites(map_column(column, change)?),
        other => map_scalar::map_scalar(other, change)?,
    })
}

fn map_all<T: Real, U: Real>(
    list: &[Value<T>],
    change: &mut impl FnMut(T) -> U,
) -> Option<Vec<Value<U>>> {
    let mut out = Vec::with_capacity(list.len());
    for value in list {
        out.push(map(value, change)?);
    }
    Some(out)
}

fn map_column<T: Real, U: Real>(
    column: &Column<T>,
    change: &mut impl FnMut(T) -> U,
) -> Option<Column<U>> {
    Some(match column {
        Column::Numbers(all) => Column::Numbers(all.iter().map(|x| change(*x)).collect()),
        Column::Arrays(dims, all) => {
            Column::Arrays(*dims, all.iter().map(|x| change(*x)).collect())
        }
        Column::Attitudes(all) => {
            let turned = |x: &Attitude<T>| {
                let rotation: Rotation<U> = x.rotation().over(change);
                Attitude::new(rotation)
            };
            Column::Attitudes(all.iter().map(turned).collect())
        }
        Column::Structs(layout, fields, count) => {
            let mut changed = Vec::with_capacity(fields.len());
            for field in fields {
                changed.push(map_column(field, change)?);
            }
            Column::Structs(layout.clone(), changed, *count)
        }
        Column::Values(all) => Column::Values(map_all(all, change)?),
        Column::Tracked(_) => return None,
    })
}

/// Appends the numbers of a value, in the order of [`map`].
pub fn numbers<T: Real>(value: &Value<T>, out: &mut Vec<T>) -> Option<()> {
    map(value, &mut |x| {
        out.push(x);
        x
    })?;
    Some(())
}

/// How many numbers a value has; zero for the memory of a solver.
pub fn count<T: Real>(value: &Value<T>) -> usize {
    let mut all = Vec::new();
    numbers(value, &mut all).map_or(0, |()| all.len())
}

/// The value with these numbers, in the order of [`map`].
pub fn filled(value: &Value<f64>, from: &[f64]) -> Option<Value<f64>> {
    let mut from = from.iter();
    map(value, &mut |x| from.next().copied().unwrap_or(x))
}

/// Sets every count of a value to a node.
pub fn set_node(value: &mut Value<f64>, node: u64) {
    match value {
        Value::Int(n) => *n = i64::try_from(node).unwrap_or(i64::MAX),
        Value::Struct(s) => s.values.iter_mut().for_each(|v| set_node(v, node)),
        _ => {}
    }
}
