//! Parses printed formulas: the meaning of their names, and the velocities that `where` clauses define. Takes a formula as printed
//! on the card and the values of its symbols, and returns its value.

use clebsch_core::Derivation;
use clebsch_core::expr::{self, shape::Dim};
use clebsch_core::groups::Group;
use clebsch_core::print::{Format, Style, expression};
use clebsch_oracle::printed::{Value, value};

/// A printed formula and the function differ by the rounding of a few hundred operations on numbers of order one, amplified by the
/// inverse of an inertia with a condition number of a few tens.
pub const ROUNDING: f64 = 1e-12;

/// The printed form of a name.
pub fn printed(d: &Derivation, name: &str) -> String {
    let s = &d.letters.symbols;
    let id = s
        .ids()
        .find(|id| s.get(*id).name == name)
        .unwrap_or_else(|| panic!("no {name}"));
    let style = Style::new(&d.spec.time_index);
    expression(&expr::here(s, id), s, &style, Format::Text)
}

/// The names of velocities with their possible directions; `momenta` give their sizes.
pub fn velocities(d: &Derivation, momenta: &[Value]) -> Vec<(String, Vec<Value>)> {
    let s = &d.letters.symbols;
    let own = d.spec.configurations.iter().zip(&d.letters.rate);
    own.zip(momenta)
        .map(|((c, id), m)| (s.get(*id).name.clone(), directions(c.group, m.rows)))
        .collect()
}

/// Zero momenta with the sizes of the model.
pub fn still(d: &Derivation) -> Vec<Value> {
    let s = &d.letters.symbols;
    let shapes = d.letters.node_momentum.iter().map(|id| s.get(*id).shape);
    let sizes = shapes.map(|shape| {
        [shape.rows, shape.cols].map(|n| match n {
            Dim::Fixed(n) => n as usize,
            Dim::Named(_) => panic!("a size that has only a name"),
        })
    });
    sizes
        .map(|[rows, cols]| Value::new(rows, cols, &vec![0.0; rows * cols]))
        .collect()
}

/// Directions of a Lie algebra in the printed form of its velocity, for matrices with this number of rows.
fn directions(group: Group, rows: usize) -> Vec<Value> {
    let size = |n: Dim| match n {
        Dim::Fixed(n) => n as usize,
        Dim::Named(_) => rows,
    };
    let (shape, _) = group.dual();
    let (rows, cols) = (size(shape.rows), size(shape.cols));
    if cols == 1 {
        let unit = |k| {
            Value::new(
                rows,
                1,
                &(0..rows)
                    .map(|i| f64::from(u8::from(i == k)))
                    .collect::<Vec<_>>(),
            )
        };
        return (0..rows).map(unit).collect();
    }
    let one = |element: Vec<(usize, usize, i64)>| {
        let mut data = vec![0.0; rows * cols];
        for (i, j, x) in element {
            data[i * cols + j] = x as f64;
        }
        Value::new(rows, cols, &data)
    };
    group.basis(&size).into_iter().map(one).collect()
}

pub fn combination(basis: &[Value], by: &[f64]) -> Value {
    let mut out = Value::new(
        basis[0].rows,
        basis[0].cols,
        &vec![0.0; basis[0].data.len()],
    );
    for (e, x) in basis.iter().zip(by) {
        out.data
            .iter_mut()
            .zip(&e.data)
            .for_each(|(o, y)| *o += x * y);
    }
    out
}

/// Splits at commas outside brackets: `(a, b)` is one vector, and `μ_{1,k}` is one name.
fn apart(text: &str) -> Vec<&str> {
    let mut parts = Vec::new();
    let (mut from, mut depth) = (0, 0);
    for (at, letter) in text.char_indices() {
        match letter {
            '(' | '[' => depth += 1,
            ')' | ']' => depth -= 1,
            ',' if depth == 0 && text[at..].starts_with(", ") => {
                parts.push(text[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(text[from..].trim());
    parts
}

/// Evaluates `formula, where μ = ..., ...`: solves for the velocities that give these momenta.
pub fn evaluated(d: &Derivation, formula: &str, letters: &[(String, Value)]) -> Value {
    let Some((formula, relations)) = formula.split_once(", where ") else {
        return value(formula, letters);
    };
    let relations: Vec<(&str, &str)> = apart(relations)
        .into_iter()
        .map(|r| r.split_once(" = ").expect("an equation"))
        .collect();
    let given: Vec<Value> = relations.iter().map(|(m, _)| value(m, letters)).collect();
    let own = velocities(d, &given);
    let bases: Vec<Vec<Value>> = own.iter().map(|(_, list)| list.clone()).collect();
    let count: usize = bases.iter().map(Vec::len).sum();
    let moving = |by: &[f64]| -> Vec<(String, Value)> {
        let mut all = letters.to_vec();
        let mut from = 0;
        for ((name, _), basis) in own.iter().zip(&bases) {
            all.push((
                printed(d, name),
                combination(basis, &by[from..from + basis.len()]),
            ));
            from += basis.len();
        }
        all
    };
    let momentum = |by: &[f64]| -> Vec<f64> {
        let all = moving(by);
        relations
            .iter()
            .flat_map(|(_, right)| value(right, &all).data)
            .collect()
    };
    let given: Vec<f64> = given.into_iter().flat_map(|m| m.data).collect();
    let still = momentum(&vec![0.0; count]);
    let columns: Vec<Vec<f64>> = (0..count)
        .map(|k| {
            let unit: Vec<f64> = (0..count).map(|i| f64::from(u8::from(i == k))).collect();
            momentum(&unit)
                .iter()
                .zip(&still)
                .map(|(a, b)| a - b)
                .collect()
        })
        .collect();
    // Skew matrices contain each number twice, so this solves a least-squares problem, which is exact here.
    let inner = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(x, y)| x * y).sum::<f64>();
    let right: Vec<f64> = given.iter().zip(&still).map(|(a, b)| a - b).collect();
    let square: Vec<f64> = columns
        .iter()
        .flat_map(|a| columns.iter().map(|b| inner(a, b)).collect::<Vec<_>>())
        .collect();
    let inverse = Value::new(count, count, &square).inverted().0;
    let projected: Vec<f64> = columns.iter().map(|a| inner(a, &right)).collect();
    let by: Vec<f64> = inverse
        .data
        .chunks(count)
        .map(|row| inner(row, &projected))
        .collect();
    value(formula, &moving(&by))
}
