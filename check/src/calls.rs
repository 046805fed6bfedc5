//! Functions of the language that take vectors and matrices. Takes the name and values; gives the value of the function.

use crate::carlson;
use crate::functions;
use crate::group::LEFT;
use crate::matrix::Matrix;
use crate::number::Number;
use crate::value::{Open, Sparse, Value};

/// The function of this name. A matrix of four rows is a quaternion or a rigid motion, as the statement declares.
///
/// # Errors
/// There is none, or sizes do not fit.
pub fn called(name: &str, values: &[Value], is_quaternion: bool) -> Result<Value, String> {
    let wrong = || format!("`{name}` of these values cannot be evaluated");
    let found = match values {
        [x] => of_one(name, x, is_quaternion),
        [x, y] => of_two(name, x, y),
        _ => None,
    };
    let given = || {
        let all: Option<Vec<Matrix>> = values.iter().map(known).collect();
        carlson::named(name, &all?).map(Value::number)
    };
    found.or_else(given).ok_or_else(wrong)
}

fn known(x: &Value) -> Option<Matrix> {
    match x {
        Value::Known(m) => Some(m.clone()),
        Value::Open(_) => None,
    }
}

fn of_one(name: &str, x: &Value, is_quaternion: bool) -> Option<Value> {
    if let Some(n) = x.as_number()
        && let Some(value) = functions::named(name, n)
    {
        return Some(Value::number(value));
    }
    let half = Number::exact(0.5);
    match name {
        "tr" | "Tr" | "I1" => Some(Value::number(match x {
            Value::Known(m) => m.trace(),
            Value::Open(s) => s.trace()?,
        })),
        "sym" => Some(x.plus(&x.transposed())?.map(|e| e.times(&half))),
        "skew" => Some(x.plus(&x.transposed().negated())?.map(|e| e.times(&half))),
        "diag" => diagonal(x),
        "perp" => {
            let v = x.sized(2, 1)?;
            let list = [v.at(1, 0).negated(), v.at(0, 0)];
            Some(Value::Known(Matrix::from_entries(2, 1, |i, _| {
                list[i].clone()
            })))
        }
        "hat" => Some(Value::Known(hat(&x.sized(3, 1)?))),
        _ => of_known(name, &known(x)?, is_quaternion),
    }
}

fn of_known(name: &str, m: &Matrix, is_quaternion: bool) -> Option<Value> {
    let half = Number::exact(0.5);
    match name {
        "det" => m.determinant().map(Value::number),
        "inv" => m.inverse().map(Value::Known),
        "I2" => {
            let trace = m.trace();
            let square = m.times(m)?.trace();
            Some(Value::number(
                trace.times(&trace).minus(&square).times(&half),
            ))
        }
        "vee" if (m.rows, m.cols) == (3, 3) => {
            let entry = |i: usize| {
                let (j, k) = ((i + 1) % 3, (i + 2) % 3);
                m.at(k, j).minus(&m.at(j, k)).times(&half)
            };
            Some(Value::Known(Matrix::from_entries(3, 1, |i, _| entry(i))))
        }
        "re" if m.rows == 4 => Some(Value::number(m.trace().times(&Number::exact(0.25)))),
        "im" if m.rows == 4 => Some(Value::Known(imaginary(m))),
        "quat" if (m.rows, m.cols) == (3, 1) => Some(Value::Known(quaternion(m))),
        "rot" if m.rows == 4 && is_quaternion => covered(m).map(Value::Known),
        "rot" if m.rows == m.cols && (3..=4).contains(&m.rows) => {
            let n = m.rows - 1;
            Some(Value::Known(Matrix::from_entries(n, n, |i, j| m.at(i, j))))
        }
        "pos" if m.rows == m.cols && (3..=4).contains(&m.rows) => {
            let n = m.rows - 1;
            Some(Value::Known(Matrix::from_entries(n, 1, |i, _| m.at(i, n))))
        }
        _ => None,
    }
}

fn of_two(name: &str, x: &Value, y: &Value) -> Option<Value> {
    match name {
        "dot" => x.transposed().times(y),
        "cross" => hat(&x.sized(3, 1)?)
            .times(&y.sized(3, 1)?)
            .map(Value::Known),
        _ => None,
    }
}

fn diagonal(x: &Value) -> Option<Value> {
    Some(match x {
        Value::Known(m) if m.cols == 1 => {
            let n = m.rows;
            Value::Known(Matrix::from_entries(n, n, |i, j| match i == j {
                true => m.at(i, 0),
                false => Number::default(),
            }))
        }
        Value::Known(m) => {
            Value::Known(Matrix::from_entries(m.rows, m.cols, |i, j| match i == j {
                true => m.at(i, j),
                false => Number::default(),
            }))
        }
        Value::Open(s) => {
            let each = s.entries.iter();
            let entries = match s.form {
                Open::Column => each.map(|(i, _, x)| (*i, *i, x.clone())).collect(),
                Open::Square => each.filter(|(i, j, _)| i == j).cloned().collect(),
                Open::Row => return None,
            };
            Value::Open(Sparse {
                form: Open::Square,
                diagonal: s.diagonal.clone(),
                entries,
            })
        }
    })
}

fn hat(v: &Matrix) -> Matrix {
    Matrix::from_entries(3, 3, |i, j| match (3 + j - i) % 3 {
        1 => v.at(3 - i - j, 0).negated(),
        2 => v.at(3 - i - j, 0),
        _ => Number::default(),
    })
}

/// The imaginary part of a 4 x 4 matrix: the mean over the entries that contain it in the matrix of a quaternion.
fn imaginary(m: &Matrix) -> Matrix {
    Matrix::from_entries(3, 1, |which, _| {
        let all = (0..16).map(|k| (k / 4, k % 4, LEFT[k / 4][k % 4]));
        let own = all.filter(|(_, _, (w, _))| *w == which + 1);
        let sum = own.fold(Number::default(), |sum, (i, j, (_, sign))| {
            match sign > 0.0 {
                true => sum.plus(&m.at(i, j)),
                false => sum.minus(&m.at(i, j)),
            }
        });
        sum.times(&Number::exact(0.25))
    })
}

fn quaternion(v: &Matrix) -> Matrix {
    Matrix::from_entries(4, 4, |i, j| match LEFT[i][j] {
        (0, _) => Number::default(),
        (which, sign) => v.at(which - 1, 0).times(&Number::exact(sign)),
    })
}

/// The rotation that a quaternion covers: `rot(q)*v` is `im(q*quat(v)*q^T)`.
fn covered(q: &Matrix) -> Option<Matrix> {
    let back = q.transposed();
    let columns: Option<Vec<Matrix>> = (0..3)
        .map(|j| {
            let unit =
                Matrix::from_entries(3, 1, |i, _| Number::exact(f64::from(u8::from(i == j))));
            Some(imaginary(&q.times(&quaternion(&unit))?.times(&back)?))
        })
        .collect();
    let columns = columns?;
    Some(Matrix::from_entries(3, 3, |i, j| columns[j].at(i, 0)))
}
