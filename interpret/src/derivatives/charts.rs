//! Local coordinates of the states of a trajectory: from coordinates to states and back, with derivatives.

use super::coordinates::moved_all;
use super::linear::Linear;
use super::trajectory::{Differentiated, by_recording};
use super::values::numbers;
use crate::sites::Column;
use crate::value::Value;
use clebsch::derivatives::{Derivatives, Jacobian, NoDerivative, Point};
use nalgebra::{DMatrix, DVector};
use std::ops::Range;

/// The most corrections that a difference of two states takes.
const CORRECTIONS: usize = 40;

/// A use of a recording at changing inputs, whose coordinates start at an index.
type InChart<'a, R> = &'a dyn Fn(&mut Linear, &[f64], usize) -> Option<R>;

/// Initial values and the state that they begin.
struct Chart {
    given: Value<f64>,
    numbers: Vec<f64>,
}

impl Chart {
    fn of(given: Value<f64>) -> Result<Self, NoDerivative> {
        let mut all = Vec::new();
        let counted = numbers(&given, &mut all);
        counted.ok_or(NoDerivative::Unrecorded {
            what: "the initial values",
        })?;
        Ok(Chart {
            given,
            numbers: all,
        })
    }
}

impl Differentiated {
    /// The number of local coordinates.
    pub fn dimension(&self) -> usize {
        self.dimensions().iter().sum()
    }

    /// The initial values that begin this state.
    fn chart(&mut self, at: &Point) -> Result<Chart, NoDerivative> {
        let lists = self.initial_of(at)?;
        let started = &self.started;
        let given = started.source.initial_value(&started.lists, &lists)?;
        Chart::of(given)
    }

    /// The initial values that the observables of a state give, one list for each field.
    fn initial_of(&mut self, at: &Point) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let seen = self.at_observables(at, &|linear, late| linear.value(late))?;
        self.among(&seen)
    }

    /// The initial values among the observables, or their derivatives.
    fn among(&self, seen: &[f64]) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let places = self.started.places.as_ref().map_err(Clone::clone)?;
        let own = |range: &Range<usize>| seen.get(range.clone()).map(<[f64]>::to_vec);
        Ok(places.iter().filter_map(own).collect())
    }

    /// Derivatives of the initial values that the observables give, along changes of the numbers of a state.
    fn seen_along(
        &mut self,
        at: &Point,
        changes: &[Vec<f64>],
    ) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let pushed = self.at_observables(at, &|linear, late| linear.push_each(late, changes))?;
        let each = pushed.iter().map(|seen| Ok(self.among(seen)?.concat()));
        each.collect()
    }

    /// The state moved by local coordinates.
    pub fn moved_by(&mut self, at: &Point, by: &[f64]) -> Result<Point, NoDerivative> {
        let chart = self.chart(at)?;
        let mut state = self.begun(&chart, by)?;
        state.node = at.node;
        Ok(state)
    }

    /// The state at coordinates of a chart.
    fn begun(&self, chart: &Chart, xi: &[f64]) -> Result<Point, NoDerivative> {
        let unrecorded = NoDerivative::Unrecorded {
            what: "the initial state",
        };
        let started = &self.started;
        let given = moved_all(&chart.given, &started.coordinates, xi);
        let given = given.ok_or(unrecorded.clone())?;
        let begun = started
            .source
            .state(&started.begun.model, given, started.h)?;
        let mut all = Vec::new();
        numbers(&begun, &mut all).ok_or(unrecorded)?;
        Ok(Point {
            numbers: all,
            node: 0,
        })
    }

    /// Uses a recording of the state as a function of the coordinates.
    fn in_chart<R>(
        &mut self,
        chart: &Chart,
        xi: &[f64],
        used: &dyn Fn(&mut Linear, &[f64]) -> Option<R>,
    ) -> Result<R, NoDerivative> {
        let started = &self.started;
        let late: Vec<f64> = chart.numbers.iter().chain(xi).copied().collect();
        let record = || started.record_chart(&chart.given, xi);
        let found = by_recording(&mut self.charts, &late, record, used);
        found.ok_or(NoDerivative::Unrecorded {
            what: "the initial state",
        })
    }

    /// The derivatives of the numbers of the initial state along the coordinates of the initial values.
    pub fn columns_at_start(&mut self) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let chart = Chart::of(self.started.begun.initial.clone())?;
        let zero = vec![0.0; self.dimension()];
        self.columns_at(&chart, &zero)
    }

    /// The derivatives of the numbers of a state along each of its coordinates.
    pub fn columns(&mut self, at: &Point) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let chart = self.chart(at)?;
        let zero = vec![0.0; self.dimension()];
        let columns = self.columns_at(&chart, &zero)?;
        let signs = self.signs(at, &self.begun(&chart, &zero)?);
        let signed = |column: Vec<f64>| column.iter().zip(&signs).map(|(x, s)| x * s).collect();
        Ok(columns.into_iter().map(signed).collect())
    }

    fn columns_at(&mut self, chart: &Chart, xi: &[f64]) -> Result<Vec<Vec<f64>>, NoDerivative> {
        let (first, count) = (chart.numbers.len(), xi.len());
        self.in_chart(chart, xi, &move |linear, late| {
            let unit = |k: usize| {
                let mut unit = vec![0.0; count];
                *unit.get_mut(k)? = 1.0;
                linear.push_from(late, first, &unit)
            };
            (0..count).map(unit).collect()
        })
    }

    /// The coordinates at a state of changes of its numbers.
    pub fn in_coordinates(
        &mut self,
        at: &Point,
        changes: &[Vec<f64>],
    ) -> Result<Jacobian, NoDerivative> {
        let chart = self.chart(at)?;
        let zero = vec![0.0; self.dimension()];
        let columns = self.columns_at(&chart, &zero)?;
        let begun = self.begun(&chart, &zero)?;
        let columns = self.seen_along(&begun, &columns)?;
        let changes = self.seen_along(at, changes)?;
        let (rows, cols) = (columns.len(), changes.len());
        let entries = solved(&columns, &changes).ok_or(NoDerivative::Unrecorded {
            what: "the coordinates",
        })?;
        Ok(Jacobian {
            rows,
            cols,
            entries,
        })
    }

    /// The coordinates at `from` that move it nearest to `to`, by the method of Gauss and Newton.
    pub fn coordinates_between(
        &mut self,
        from: &Point,
        to: &Point,
    ) -> Result<Vec<f64>, NoDerivative> {
        let chart = self.chart(from)?;
        let there = self.initial_of(to)?.concat();
        let mut xi = vec![0.0; self.dimension()];
        let mut before = f64::INFINITY;
        for _ in 0..CORRECTIONS {
            let here = self.begun(&chart, &xi)?;
            let own = self.initial_of(&here)?.concat();
            let off = there.iter().zip(&own).map(|(to, here)| to - here).collect();
            let columns = self.columns_at(&chart, &xi)?;
            let columns = self.seen_along(&here, &columns)?;
            let correction = solved(&columns, &[off]).ok_or(NoDerivative::Unrecorded {
                what: "the coordinates",
            })?;
            for (x, by) in xi.iter_mut().zip(&correction) {
                *x += by;
            }
            let size = correction.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
            // The corrections of a solution are rounding: they fall quadratically before, and not any more then.
            if size == 0.0 || size >= before && size < 1e-6 || !size.is_finite() {
                break;
            }
            before = size;
        }
        Ok(xi)
    }

    /// For each number of a state, -1 if it belongs to a rotation whose quaternions in both states are nearly opposite,
    /// otherwise 1. A rotation has two unit quaternions.
    fn signs(&self, one: &Point, other: &Point) -> Vec<f64> {
        let mut out = Vec::with_capacity(one.numbers.len());
        if let (Ok(one), Ok(other)) = (self.state(one), self.state(other)) {
            signs_of(&one, &other, &mut out);
        }
        out.resize(one.numbers.len(), 1.0);
        out
    }

    /// The derivative of the invariants in coordinates.
    pub fn slopes_of_invariants(&mut self, at: &Point) -> Result<Jacobian, NoDerivative> {
        let (rows, cols) = (self.card().invariant_count(), self.dimension());
        let slopes = self.in_chart_of_invariants(at, &move |linear, late, first| {
            let row = |k: usize| {
                let mut unit = vec![0.0; rows];
                *unit.get_mut(k)? = 1.0;
                let pulled = linear.pull(late, &unit)?;
                Some(pulled.get(pulled.len() - late.len() + first..)?.to_vec())
            };
            (0..rows).map(row).collect::<Option<Vec<_>>>()
        })?;
        let entry = |k: usize| slopes.get(k % rows).and_then(|row| row.get(k / rows));
        Ok(Jacobian {
            rows,
            cols,
            entries: (0..rows * cols).filter_map(|k| entry(k).copied()).collect(),
        })
    }

    /// The second derivative of the weighted sum of the invariants in coordinates.
    pub fn curvature_of_invariants(
        &mut self,
        at: &Point,
        weights: &[f64],
    ) -> Result<Jacobian, NoDerivative> {
        let cols = self.dimension();
        let columns = self.in_chart_of_invariants(at, &move |linear, late, first| {
            let along = |k: usize| {
                let mut unit = vec![0.0; cols];
                *unit.get_mut(k)? = 1.0;
                let bent = linear.bend(late, weights, (first, &unit))?;
                Some(bent.get(bent.len() - late.len() + first..)?.to_vec())
            };
            (0..cols).map(along).collect::<Option<Vec<_>>>()
        })?;
        Ok(Jacobian {
            rows: cols,
            cols,
            entries: columns.concat(),
        })
    }

    /// Uses a recording of the invariants as functions of the coordinates, which come last among its changing inputs, from
    /// the given index on.
    fn in_chart_of_invariants<R>(
        &mut self,
        at: &Point,
        used: InChart<'_, R>,
    ) -> Result<R, NoDerivative> {
        let chart = self.chart(at)?;
        let zero = vec![0.0; self.dimension()];
        let started = &self.started;
        let first = chart.numbers.len();
        let late: Vec<f64> = chart.numbers.iter().chain(&zero).copied().collect();
        let record = || started.record_invariants_in_chart(&chart.given, &zero);
        let used = |linear: &mut Linear, late: &[f64]| used(linear, late, first);
        let found = by_recording(&mut self.conserved, &late, record, &used);
        found.ok_or(NoDerivative::Unrecorded {
            what: "the invariants",
        })
    }
}

/// The combinations of columns nearest to each right side, one after the other.
fn solved(columns: &[Vec<f64>], right: &[Vec<f64>]) -> Option<Vec<f64>> {
    let rows = columns.first()?.len();
    let matrix = DMatrix::from_fn(rows, columns.len(), |i, j| columns[j][i]);
    let qr = matrix.qr();
    let (q, r) = (qr.q(), qr.r());
    let mut all = Vec::with_capacity(columns.len() * right.len());
    for one in right {
        let along = q.tr_mul(&DVector::from_column_slice(one));
        all.extend(r.solve_upper_triangular(&along)?.iter());
    }
    Some(all)
}

fn signs_of(one: &Value<f64>, other: &Value<f64>, out: &mut Vec<f64>) {
    match (one, other) {
        (Value::Struct(a), Value::Struct(b)) => signs_of_all(&a.values, &b.values, out),
        (Value::List(a), Value::List(b)) => signs_of_all(a, b, out),
        (Value::Sites(a), Value::Sites(b)) => signs_of_columns(a, b, out),
        _ => {
            let (mut a, mut b) = (Vec::new(), Vec::new());
            if numbers(one, &mut a).is_none() || numbers(other, &mut b).is_none() {
                return;
            }
            let turned = match one {
                Value::Rotation(_) | Value::Attitude(_) => 0..4,
                Value::Motion(g) => {
                    // The numbers of the motion contain the numbers of the rotation, in one piece.
                    let mut own = Vec::new();
                    let _ = numbers(&Value::Rotation(g.rotation), &mut own);
                    let from = a.windows(4).position(|four| four == own).unwrap_or(0);
                    from..from + 4
                }
                _ => 0..0,
            };
            let pairs = a.iter().zip(&b).enumerate();
            let along: f64 = pairs
                .filter(|(k, _)| turned.contains(k))
                .map(|(_, (a, b))| a * b)
                .sum();
            let sign = if along < 0.0 { -1.0 } else { 1.0 };
            let each = (0..a.len()).map(|k| if turned.contains(&k) { sign } else { 1.0 });
            out.extend(each);
        }
    }
}

fn signs_of_all(one: &[Value<f64>], other: &[Value<f64>], out: &mut Vec<f64>) {
    for (a, b) in one.iter().zip(other) {
        signs_of(a, b, out);
    }
}

/// Lists store structs field by field.
fn signs_of_columns(one: &Column<f64>, other: &Column<f64>, out: &mut Vec<f64>) {
    match (one, other) {
        (Column::Structs(_, a, _), Column::Structs(_, b, _)) => {
            for (a, b) in a.iter().zip(b) {
                signs_of_columns(a, b, out);
            }
        }
        _ => {
            for (a, b) in one.values().zip(other.values()) {
                signs_of(&a, &b, out);
            }
        }
    }
}
