//! Decisions beyond the normal form: evaluation at random points in exact arithmetic modulo the prime 2^61 - 1.
//! Special identities of three dimensions, which no reordering of words reveals, vanish there at every point. Any
//! other expression vanishes at a point with probability below 1e-16.

pub(super) use super::prime::{HALF, QUARTER, mix, power, root};
use super::prime::{PRIME, of_rational};
pub(crate) use super::prime::{add, inverse, mul, negate, rational};
use super::rational::Rational;
use crate::expr::shape::{Dim, Shape, Structure};
use crate::expr::symbol::Symbols;
use crate::expr::{self, Expr, Function, Hashed, Letter, Map, Node, Part};
use crate::work;
use std::cell::RefCell;
use std::collections::BTreeMap;

mod matrix;

pub(crate) use matrix::{Matrix, paired};

/// Points at which an identity must hold.
pub(crate) const POINTS: u64 = 6;

/// Attempts to find a point at which every root exists and no divisor is zero.
pub(crate) const ATTEMPTS: u64 = 100;

/// Attempts of a check for which a point need not exist.
const FEW_ATTEMPTS: u64 = 4;

/// The value of a named dimension.
#[derive(Clone, Copy)]
enum Size {
    Smallest,
    Largest,
    Given(usize),
}

/// A point: every letter has the value set for it, or a value computed from the seed and the letter.
#[derive(Clone)]
pub(crate) struct Point<'a> {
    symbols: &'a Symbols,
    pub(super) seed: u64,
    size: Size,
    given: BTreeMap<Letter, Matrix>,
    found: ValueCache,
}

/// Values at a point, so that shared subexpressions are evaluated once. A copy starts empty.
#[derive(Default)]
struct ValueCache(RefCell<Hashed<Matrix>>);

impl Clone for ValueCache {
    fn clone(&self) -> ValueCache {
        ValueCache::default()
    }
}

impl<'a> Point<'a> {
    /// The point of an attempt. Named dimensions alternate between their smallest and their largest size.
    pub(crate) fn new(symbols: &'a Symbols, attempt: u64) -> Point<'a> {
        Point {
            symbols,
            seed: mix(attempt.wrapping_mul(0x5851_f42d_4c95_7f2d)),
            size: match attempt % 2 {
                0 => Size::Smallest,
                _ => Size::Largest,
            },
            given: BTreeMap::new(),
            found: ValueCache::default(),
        }
    }

    /// This point, with this size for every named dimension.
    pub(crate) fn sized(mut self, size: usize) -> Point<'a> {
        self.size = Size::Given(size);
        self.found = ValueCache::default();
        self
    }

    /// A point with other values of all letters and the same sizes.
    pub(crate) fn redrawn(&self, attempt: u64) -> Point<'a> {
        Point {
            size: self.size,
            ..Point::new(self.symbols, attempt)
        }
    }

    /// Sets the value of a letter.
    pub(crate) fn set(&mut self, letter: Letter, value: Matrix) {
        self.given.insert(letter, value);
        let found = self.found.0.get_mut();
        found.retain(|e, _| !expr::may_contain(e, letter));
    }

    /// The symbols of the letters.
    pub(crate) fn symbols(&self) -> &'a Symbols {
        self.symbols
    }

    /// The value of a dimension at this point.
    pub(crate) fn dim(&self, d: Dim) -> usize {
        match d {
            Dim::Fixed(n) => n as usize,
            Dim::Named(_) => match self.size {
                Size::Smallest => self.symbols.sizes(d).0,
                Size::Largest => self.symbols.sizes(d).1,
                Size::Given(n) => n,
            },
        }
    }

    /// The value of a letter.
    pub(crate) fn letter(&self, l: Letter) -> Option<Matrix> {
        if let Some(value) = self.given.get(&l) {
            return Some(value.clone());
        }
        let s = self.symbols.get(l.symbol);
        let (rows, cols) = (self.dim(s.shape.rows), self.dim(s.shape.cols));
        let label = (l.shift.label[0] as u64) << 8 | (l.shift.label[1] as u64 & 0xff);
        let key = mix(self.seed
            ^ mix(u64::from(l.symbol.0) << 32
                | (l.shift.time as u64 & 0xff) << 16
                | label & 0xffff));
        let raw = |i: usize, j: usize| mix(key ^ mix((i * 64 + j) as u64));
        let skew = |i: usize, j: usize| match i.cmp(&j) {
            core::cmp::Ordering::Less => raw(i, j),
            core::cmp::Ordering::Equal => 0,
            core::cmp::Ordering::Greater => negate(raw(j, i)),
        };
        Some(match s.structure {
            Structure::General | Structure::Invertible => Matrix::from_fn(rows, cols, raw),
            Structure::Symmetric => Matrix::from_fn(rows, cols, |i, j| raw(i.min(j), i.max(j))),
            Structure::Skew => Matrix::from_fn(rows, cols, skew),
            Structure::Diagonal => {
                Matrix::from_fn(rows, cols, |i, j| if i == j { raw(i, i) } else { 0 })
            }
            Structure::Orthogonal => cayley(&Matrix::from_fn(rows, cols, skew))?,
            // The same transform, applied to a vector as a quaternion.
            Structure::UnitQuaternion => {
                let v = [raw(1, 0), raw(2, 0), raw(3, 0)];
                cayley(&pure(&v))?
            }
            Structure::RigidMotion => {
                let last = rows.saturating_sub(1);
                let r = cayley(&Matrix::from_fn(last, last, skew))?;
                Matrix::from_fn(rows, rows, |i, j| match (i == last, j == last) {
                    (true, corner) => u64::from(corner),
                    (false, true) => raw(i, j),
                    (false, false) => r.at(i, j),
                })
            }
        })
    }

    /// The value; `None` if a divisor vanishes or a root does not exist.
    pub(crate) fn value(&self, e: &Expr) -> Option<Matrix> {
        if let Some(value) = self.found.0.borrow().get(e) {
            return Some(value.clone());
        }
        let value = self.evaluated(e)?;
        self.found.0.borrow_mut().insert(e.clone(), value.clone());
        Some(value)
    }

    fn evaluated(&self, e: &Expr) -> Option<Matrix> {
        let go = |x: &Expr| self.value(x);
        let number = |x: &Expr| self.value(x).map(|m| m.at(0, 0));
        let Shape { rows, cols } = e.shape();
        let (rows, cols) = (self.dim(rows), self.dim(cols));
        if !work::take(1) {
            return None;
        }
        Some(match e.node() {
            Node::Number(q) => Matrix::number(of_rational(*q)?),
            Node::Constant(c) => Matrix::number(mix(c.bits())),
            Node::Letter(l) => self.letter(*l)?,
            Node::Identity(_) => Matrix::identity(rows),
            Node::Zero(_) => Matrix::zeros(rows, cols),
            Node::Unit(_, axis) => Matrix::from_fn(rows, 1, |i, _| u64::from(i == *axis as usize)),
            Node::Inclusion(_, at) => {
                let at = *at as usize;
                Matrix::from_fn(rows, cols, |i, j| u64::from(i == at + j))
            }
            Node::Sum(list) => {
                let mut total = Matrix::zeros(rows, cols);
                for x in list {
                    total = total.plus(&go(x)?);
                }
                total
            }
            Node::Neg(a) => go(a)?.scaled(negate(1)),
            Node::Product(list) => {
                let mut parts = list.iter().map(go);
                let first = parts.next().unwrap_or_else(|| Some(Matrix::number(1)))?;
                parts.try_fold(first, |total, x| Some(total.times(&x?)))?
            }
            Node::Quotient(a, b) => {
                let below = inverse(number(b)?)?;
                go(a)?.scaled(below)
            }
            Node::Power(a, q) => {
                let base = number(a)?;
                let value = self.powered(base, *q);
                // Half of all constants have no root. Any value then serves, if it depends on the constant only.
                let constant = value.is_none() && expr::letters(a).is_empty();
                Matrix::number(match constant && base != 0 {
                    true => mix(base ^ mix(q.numerator() as u64)),
                    false => value?,
                })
            }
            Node::Transpose(a) => go(a)?.transposed(),
            Node::Inverse(a) => go(a)?.inverted()?.0,
            Node::Trace(a) => {
                let a = go(a)?;
                Matrix::number((0..a.rows).fold(0, |s, i| add(s, a.at(i, i))))
            }
            Node::Det(a) => {
                let a = go(a)?;
                Matrix::number(a.inverted().map_or(0, |(_, det)| det))
            }
            // A polynomial, which is defined for singular matrices too.
            Node::Adjugate(a) => go(&crate::expr::adjugate_polynomial(a))?,
            Node::Dot(a, b) => go(a)?.transposed().times(&go(b)?),
            Node::Cross(a, b) => hat(&go(a)?).times(&go(b)?),
            Node::Hat(a) => hat(&go(a)?),
            Node::Vee(a) => {
                let a = go(a)?;
                let part = |i, j| mul(HALF, add(a.at(i, j), negate(a.at(j, i))));
                Matrix {
                    rows: 3,
                    cols: 1,
                    data: vec![part(2, 1), part(0, 2), part(1, 0)],
                }
            }
            Node::Part(part, a) => {
                let a = go(a)?;
                match part {
                    Part::Symmetric => a.clone().transposed().plus(&a).scaled(HALF),
                    Part::Skew => a
                        .clone()
                        .transposed()
                        .scaled(negate(1))
                        .plus(&a)
                        .scaled(HALF),
                    Part::Diagonal => {
                        Matrix::from_fn(rows, cols, |i, j| if i == j { a.at(i, i) } else { 0 })
                    }
                }
            }
            Node::Map(map, argument) => {
                let a = go(argument)?;
                match map {
                    Map::Real => Matrix::number(mul(QUARTER, quaternion(&a)[0])),
                    Map::Imaginary => {
                        let [_, v @ ..] = quaternion(&a);
                        Matrix {
                            rows: 3,
                            cols: 1,
                            data: v.iter().map(|x| mul(QUARTER, *x)).collect(),
                        }
                    }
                    Map::Pure => pure(&a.data),
                    Map::Rotation if expr::is_motion(self.symbols, argument) => {
                        Matrix::from_fn(rows, cols, |i, j| a.at(i, j))
                    }
                    Map::Rotation => rotation(&quaternion(&a).map(|x| mul(QUARTER, x))),
                    Map::Translation => Matrix::from_fn(rows, 1, |i, _| a.at(i, rows)),
                    Map::Diagonal => {
                        Matrix::from_fn(rows, cols, |i, j| if i == j { a.at(i, 0) } else { 0 })
                    }
                    Map::DiagonalOf => Matrix::from_fn(rows, 1, |i, _| a.at(i, i)),
                    Map::Twist => {
                        let last = rows.saturating_sub(1);
                        let (turn, linear) = match last {
                            2 => (quarter(a.at(0, 0)), 1),
                            _ => (hat(&a), 3),
                        };
                        Matrix::from_fn(rows, rows, |i, j| match (i == last, j == last) {
                            (true, _) => 0,
                            (false, true) => a.at(i + linear, 0),
                            (false, false) => turn.at(i, j),
                        })
                    }
                }
            }
            Node::Call(function, a) => Matrix::number(self.called(*function, number(a)?)?),
            Node::Given(_) | Node::PullBack(..) => self.functional(e)?,
        })
    }

    /// A function of a scalar. Only three properties are used: that it is a function, its parity, and the relations
    /// between trigonometric or hyperbolic functions of one argument. These are rational in `t = tan(x/2)` or `t =
    /// tanh(x/2)`, and `t` is odd in `x`. The sign is an arbitrary odd function: if its square were 1, false
    /// identities of signs would be too likely.
    fn called(&self, function: Function, x: u64) -> Option<u64> {
        let odd = |tag: u64| {
            let (size, minus) = match x > PRIME / 2 {
                true => (negate(x), true),
                false => (x, false),
            };
            let value = mix(size ^ mix(self.seed.wrapping_add(tag)));
            match (size, minus) {
                (0, _) => 0,
                (_, true) => negate(value),
                (_, false) => value,
            }
        };
        let circular = || odd(3);
        let hyperbolic = || odd(1);
        let square = |t: u64, sign: u64| mul(sign, mul(t, t));
        let (one, minus) = (1, negate(1));
        let over = |a: u64, b: u64| Some(mul(a, inverse(b)?));
        match function {
            Function::Log => Some(mix(x ^ mix(self.seed.wrapping_add(2)))),
            Function::Exp => {
                let t = hyperbolic();
                over(add(one, t), add(one, negate(t)))
            }
            Function::Sinh => {
                let t = hyperbolic();
                over(mul(2, t), add(one, square(t, minus)))
            }
            Function::Cosh => {
                let t = hyperbolic();
                over(add(one, square(t, one)), add(one, square(t, minus)))
            }
            Function::Tanh => {
                let t = hyperbolic();
                over(mul(2, t), add(one, square(t, one)))
            }
            Function::Sin => {
                let t = circular();
                over(mul(2, t), add(one, square(t, one)))
            }
            Function::Cos => {
                let t = circular();
                over(add(one, square(t, minus)), add(one, square(t, one)))
            }
            Function::Sign => Some(odd(4)),
            Function::Abs => Some(mul(odd(4), x)),
        }
    }

    fn powered(&self, base: u64, q: Rational) -> Option<u64> {
        let num = i64::try_from(q.numerator()).ok()?;
        let base = match q.denominator() {
            1 => base,
            2 => root(base)?,
            // Other roots: an arbitrary value that depends on the base only.
            n => mix(base ^ mix(self.seed ^ u64::try_from(n).ok()?)),
        };
        let base = if num < 0 { inverse(base)? } else { base };
        Some(power(base, num.unsigned_abs()))
    }
}

/// Cayley's transform `(1 - A)^-1 (1 + A)` of a skew matrix: a rotation.
fn cayley(a: &Matrix) -> Option<Matrix> {
    let id = Matrix::identity(a.rows);
    let below = a.clone().scaled(negate(1)).plus(&id).inverted()?.0;
    Some(below.times(&id.plus(a)))
}

/// The left multiplication by a vector, taken as a quaternion.
pub(crate) fn pure(v: &[u64]) -> Matrix {
    let [x, y, z] = [0, 1, 2].map(|i| v.get(i).copied().unwrap_or(0));
    let [a, b, c] = [x, y, z].map(negate);
    Matrix {
        rows: 4,
        cols: 4,
        data: vec![0, a, b, c, x, 0, c, y, y, z, 0, a, z, b, x, 0],
    }
}

/// Four times the quaternion nearest to a 4 x 4 matrix: its pairings with the four units.
fn quaternion(a: &Matrix) -> [u64; 4] {
    let sum = |list: [(u64, bool); 4]| {
        list.iter().fold(0, |s, (x, minus)| {
            add(s, if *minus { negate(*x) } else { *x })
        })
    };
    let pair = |m: &Matrix| {
        let entries = a.data.iter().zip(&m.data);
        entries.fold(0, |s, (x, y)| add(s, mul(*x, *y)))
    };
    let diagonal = [0, 1, 2, 3].map(|i| (a.at(i, i), false));
    [
        sum(diagonal),
        pair(&pure(&[1, 0, 0])),
        pair(&pure(&[0, 1, 0])),
        pair(&pure(&[0, 0, 1])),
    ]
}

/// The rotation of a unit quaternion `(w, v)`: `(w^2 - v.v) Id + 2 v v^T + 2 w hat(v)`.
fn rotation([w, x, y, z]: &[u64; 4]) -> Matrix {
    let v = Matrix {
        rows: 3,
        cols: 1,
        data: vec![*x, *y, *z],
    };
    let row = v.clone().transposed();
    let square = row.times(&v).at(0, 0);
    let trace = add(mul(*w, *w), negate(square));
    let outer = v.times(&row).scaled(2);
    let turn = hat(&v).scaled(mul(2, *w));
    Matrix::identity(3).scaled(trace).plus(&outer).plus(&turn)
}

/// A multiple of the quarter turn of the plane.
fn quarter(x: u64) -> Matrix {
    Matrix {
        rows: 2,
        cols: 2,
        data: vec![0, negate(x), x, 0],
    }
}

fn hat(v: &Matrix) -> Matrix {
    let (x, y, z) = (v.at(0, 0), v.at(1, 0), v.at(2, 0));
    Matrix {
        rows: 3,
        cols: 3,
        data: vec![0, negate(z), y, z, 0, negate(x), negate(y), x, 0],
    }
}

/// Whether the expression vanishes at every one of the fixed random points. `false` also if no point is found at
/// which it is defined.
pub fn vanishes(symbols: &Symbols, e: &Expr) -> bool {
    let mut found = 0;
    for attempt in 0..ATTEMPTS {
        let Some(value) = Point::new(symbols, attempt).value(e) else {
            continue;
        };
        if !value.vanishes() {
            return false;
        }
        found += 1;
        if found == POINTS {
            return true;
        }
    }
    false
}

/// Whether the expression is nonzero at a random point. `false` if that proves nothing: functionals of sites cannot
/// be evaluated here, and modulo a prime neither of two roots is the positive one.
pub fn differs_from_zero(symbols: &Symbols, e: &Expr) -> bool {
    if has_root(e) {
        return false;
    }
    let value = (0..FEW_ATTEMPTS).find_map(|attempt| Point::new(symbols, attempt).value(e));
    value.is_some_and(|value| !value.vanishes())
}

/// Whether the expression contains a fractional power.
fn has_root(e: &Expr) -> bool {
    let is_root = matches!(e.node(), Node::Power(_, q) if q.as_integer().is_none());
    is_root || e.children().into_iter().any(has_root)
}

#[cfg(test)]
mod tests;
