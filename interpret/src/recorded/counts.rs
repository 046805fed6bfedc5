//! The counts of a value, such as the node of a state. A tape computes only numbers, so counts are advanced separately.

use super::Traced;
use crate::value::Value;
use clebsch::Real;

/// How the counts of a recording are chosen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Choice {
    /// All are equal to the first count.
    Equal,
    /// The first count goes up by 1000, the second by 2000 and so on.
    Apart,
}

/// The counts of a recording, before a step.
#[derive(Debug)]
pub struct Chosen {
    choice: Choice,
    /// The counts as they were chosen.
    pub all: Vec<i64>,
}

impl Chosen {
    /// No counts yet.
    pub fn by(choice: Choice) -> Self {
        Chosen {
            choice,
            all: Vec::new(),
        }
    }

    /// Chooses the counts of a value.
    pub fn choose(&mut self, value: &mut Value<Traced>) {
        each_count(value, &mut |n| {
            *n = match self.choice {
                Choice::Equal => self.all.first().copied().unwrap_or(*n),
                Choice::Apart => *n + 1000 * (self.all.len() as i64 + 1),
            };
            self.all.push(*n);
        });
    }
}

/// A count after a step: some count before the step, plus a constant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Growth {
    /// Which one.
    pub from: usize,
    /// The constant.
    pub by: i64,
}

/// How each count grows, from two recordings: counts before and after. A count grows from itself if this is possible.
pub fn growth(one: [&[i64]; 2], other: [&[i64]; 2]) -> Option<Vec<Growth>> {
    let [before, after] = one;
    let [others, later] = other;
    if [before.len(), others.len(), later.len()] != [after.len(); 3] {
        return None;
    }
    let grown = |i: usize| {
        let from = |j: &usize| after[i] - before[*j] == later[i] - others[*j];
        let own = std::iter::once(i).chain(0..before.len());
        own.into_iter().find(from).map(|from| Growth {
            from,
            by: after[i] - before[from],
        })
    };
    (0..after.len()).map(grown).collect()
}

/// Replaces the counts by the counts after a step with this growth.
pub fn grow(counts: &mut Vec<i64>, by: &[Growth]) {
    let is_own = |(at, growth): (usize, &Growth)| at == growth.from;
    if by.iter().enumerate().all(is_own) {
        counts
            .iter_mut()
            .zip(by)
            .for_each(|(n, growth)| *n += growth.by);
        return;
    }
    let of = |growth: &Growth| counts.get(growth.from).copied().unwrap_or(0) + growth.by;
    *counts = by.iter().map(of).collect();
}

/// Visits every count of a value.
pub fn each_count<T: Real>(value: &mut Value<T>, met: &mut dyn FnMut(&mut i64)) {
    match value {
        Value::Int(n) => met(n),
        Value::Struct(s) => s.values.iter_mut().for_each(|v| each_count(v, met)),
        Value::List(list) => list.iter_mut().for_each(|v| each_count(v, met)),
        _ => {}
    }
}

/// The value with all counts zero.
pub fn uncounted<T: Real>(value: &Value<T>) -> Value<T> {
    let mut value = value.clone();
    each_count(&mut value, &mut |n| *n = 0);
    value
}

/// Appends every count of a value.
pub fn counts<T: Real>(value: &Value<T>, out: &mut Vec<i64>) {
    match value {
        Value::Int(n) => out.push(*n),
        Value::Struct(s) => s.values.iter().for_each(|v| counts(v, out)),
        Value::List(list) => list.iter().for_each(|v| counts(v, out)),
        _ => {}
    }
}
