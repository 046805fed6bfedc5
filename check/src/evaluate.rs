//! Evaluates expressions of the statement on numbers with derivatives. Takes an expression and its position in time and
//! along a label; gives its value, or the reason why it cannot be evaluated.

use crate::calls::called;
use crate::expression::{Expression, Kind};
use crate::functions;
use crate::matrix::Matrix;
use crate::number::{Number, UNIT};
use crate::scene::Scene;
use crate::terms::Terms;
use crate::value::Value;

/// The position in time and along a label at which an expression is evaluated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Here {
    /// The number of steps after the first node of the edge. In an update of an advected quantity, 0 is the stored node
    /// and 1 the varied node.
    pub time: i32,
    /// The index along a label.
    pub index: i64,
    /// Whether the index is the last node, whose segment is the last segment.
    pub at_last: bool,
    /// The node at which quantities are advected from the stored to the varied configuration.
    pub carried: Option<usize>,
}

impl Here {
    /// On the edge, at this index.
    #[must_use]
    pub fn at(index: i64) -> Self {
        Self {
            time: 0,
            index,
            at_last: false,
            carried: None,
        }
    }

    /// The same index at another time level.
    #[must_use]
    pub fn later(self, by: i32) -> Self {
        Self {
            time: self.time + by,
            ..self
        }
    }

    /// The same time level at another index.
    #[must_use]
    pub fn beside(self, by: i64) -> Self {
        Self {
            index: self.index + by,
            ..self
        }
    }

    /// The positions at which the parts of this expression are evaluated.
    #[must_use]
    pub fn within(self, e: &Expression) -> Self {
        match &e.kind {
            Kind::Call(f, list) => match (f.as_str(), list.len()) {
                ("next", 1) => self.later(1),
                ("prev", 1) => self.later(-1),
                ("next", 2) => self.beside(1),
                ("prev", 2) => self.beside(-1),
                _ => self,
            },
            _ => self,
        }
    }
}

/// The value, or the reason why the expression cannot be evaluated.
pub type Evaluated = Result<Value, String>;

/// A sentence about sizes.
fn misfit(what: &str) -> String {
    format!("the sizes in this {what} do not match")
}

impl Scene<'_> {
    /// The value of an expression.
    ///
    /// # Errors
    /// Why the expression cannot be evaluated.
    pub fn value(&self, e: &Expression, here: Here) -> Evaluated {
        match &e.kind {
            Kind::Number(a, b) => Ok(Value::number(rational(*a, *b))),
            Kind::Constant(c) => Ok(Value::number(Number::within(*c, UNIT * c.abs()))),
            Kind::Name(n) => self.name(n, here),
            Kind::Shaped(a, _, size) => self.shaped(a, *size, here),
            Kind::Sum(terms) => {
                let mut sum: Option<Value> = None;
                for (minus, t) in terms {
                    let t = self.value(t, here)?;
                    let t = if *minus { t.negated() } else { t };
                    sum = Some(match sum {
                        None => t,
                        Some(s) => s.plus(&t).ok_or_else(|| misfit("sum"))?,
                    });
                }
                sum.ok_or_else(|| "an empty sum".to_owned())
            }
            Kind::Product(list) => self.product(list, here),
            Kind::Quotient(a, b) => {
                let (a, b) = (self.value(a, here)?, self.value(b, here)?);
                let b = b.as_number().ok_or_else(|| misfit("quotient"))?;
                Ok(a.map(|x| x.over(b)))
            }
            Kind::Neg(a) => Ok(self.value(a, here)?.negated()),
            Kind::Transpose(a) => Ok(self.value(a, here)?.transposed()),
            Kind::Power(a, above, below) => power(&self.value(a, here)?, *above, *below),
            Kind::Component(a, at) => {
                let a = self.value(a, here)?;
                component(&a, at).ok_or_else(|| misfit("component"))
            }
            Kind::Call(f, list) => match (f.as_str(), list.as_slice()) {
                ("next" | "prev", [inner] | [inner, _]) => self.value(inner, here.within(e)),
                ("sum", [inner, ..]) => self.summed(e, inner, here),
                (name, list) => {
                    let values: Result<Vec<Value>, String> =
                        list.iter().map(|a| self.value(a, here)).collect();
                    let is_quaternion = list.first().is_some_and(|a| self.is_quaternion(a));
                    let path = self.stated().functions.get(name).map(String::as_str);
                    called(path.unwrap_or(name), &values?, is_quaternion)
                }
            },
        }
    }

    /// The value of an expression in which sums run over the sites `over`, or over the sites of their letters if `over`
    /// is `None`.
    ///
    /// # Errors
    /// Why the expression cannot be evaluated.
    pub fn value_with_sums(&self, e: &Expression, here: Here, over: Option<Vec<i64>>) -> Evaluated {
        self.sum_over(Some(over));
        let value = self.value(e, here);
        self.sum_over(None);
        value
    }

    /// A sum over sites. If no range is set, the term has its own range, and this is the value at one site.
    fn summed(&self, whole: &Expression, inner: &Expression, here: Here) -> Evaluated {
        let Some(over) = self.summed_over() else {
            return self.value(inner, here);
        };
        let over = match over {
            Some(over) => over,
            None => {
                let term = Terms::of(self.stated()).whole(whole.clone())?;
                self.range_of(&term)
            }
        };
        let mut sum: Option<Value> = None;
        for index in over {
            let value = self.value(inner, Here { index, ..here })?;
            sum = Some(match sum {
                None => value,
                Some(s) => s.plus(&value).ok_or_else(|| misfit("sum"))?,
            });
        }
        sum.ok_or_else(|| "an empty sum".to_owned())
    }

    /// Evaluates a product that ends in a vector from the right, which needs less work and causes less rounding.
    fn product(&self, list: &[Expression], here: Here) -> Evaluated {
        let mut values = Vec::with_capacity(list.len());
        for f in list {
            values.push(self.value(f, here)?);
        }
        let fold = |all: Vec<Value>| {
            let mut all = all.into_iter();
            let first = all.next()?;
            all.try_fold(first, |p, f| p.times(&f))
        };
        let is_column = matches!(values.last(), Some(Value::Known(m)) if m.cols == 1 && m.rows > 1);
        if is_column {
            let mut rest = values.clone();
            let last = rest.pop();
            let right = rest
                .into_iter()
                .rev()
                .try_fold(last, |p, f| Some(Some(f.times(&p?)?)));
            if let Some(Some(value)) = right {
                return Ok(value);
            }
        }
        fold(values).ok_or_else(|| misfit("product"))
    }

    fn shaped(&self, a: &Expression, [rows, cols]: [usize; 2], here: Here) -> Evaluated {
        match self.value(a, here)? {
            value @ Value::Known(_) => Ok(value),
            value @ Value::Open(_) => {
                let sized = value.sized(rows, cols);
                Ok(Value::Known(sized.ok_or_else(|| misfit("shape"))?))
            }
        }
    }

    /// Whether the first operand of an expression that is not a number is a unit quaternion.
    fn is_quaternion(&self, e: &Expression) -> bool {
        let stated = self.stated();
        let mut first = None;
        e.each(&mut |part| {
            if first.is_some() {
                return;
            }
            match &part.kind {
                Kind::Call(f, _) if f == "quat" => first = Some(true),
                Kind::Name(n) => {
                    let name = stated.velocities.get(n).unwrap_or(n);
                    let own = stated.quantities.get(name);
                    first = own.filter(|q| !q.is_number).map(|q| q.is_quaternion);
                }
                _ => {}
            }
        });
        first.unwrap_or(false)
    }
}

/// A number of the statement.
#[must_use]
#[allow(clippy::cast_precision_loss)]
pub fn rational(numerator: i128, denominator: i128) -> Number {
    let (a, b) = (numerator as f64, denominator as f64);
    let value = a / b;
    // Powers of two divide exactly.
    let exact = value * b == a && numerator.unsigned_abs() < 1 << 53 && {
        let bits = denominator.unsigned_abs();
        bits.is_power_of_two()
    };
    Number::within(value, if exact { 0.0 } else { 3.0 * UNIT * value.abs() })
}

fn power(a: &Value, numerator: i128, denominator: i128) -> Evaluated {
    if let Some(x) = a.as_number() {
        return Ok(Value::number(functions::power(x, numerator, denominator)));
    }
    if denominator != 1 {
        return Err(misfit("power"));
    }
    let base = match (numerator < 0, a) {
        (false, _) => a.clone(),
        (true, Value::Known(m)) => Value::Known(m.inverse().ok_or_else(|| misfit("power"))?),
        (true, Value::Open(_)) => return Err(misfit("power")),
    };
    let mut out = base.clone();
    for _ in 1..numerator.unsigned_abs() {
        out = out.times(&base).ok_or_else(|| misfit("power"))?;
    }
    Ok(out)
}

fn component(a: &Value, at: &[u64]) -> Option<Value> {
    let at: Option<Vec<usize>> = at
        .iter()
        .map(|i| usize::try_from(*i).ok()?.checked_sub(1))
        .collect();
    let (i, j) = match at?.as_slice() {
        [i] => (*i, 0),
        [i, j] => (*i, *j),
        _ => return None,
    };
    let entry = match a {
        Value::Known(m) if i < m.rows && j < m.cols => m.at(i, j),
        Value::Known(_) => return None,
        Value::Open(_) => {
            let most = i.max(j) + 8;
            let of = |rows, cols| a.sized(rows, cols).map(|m: Matrix| m.at(i, j));
            of(most, 1).or_else(|| of(most, most))?
        }
    };
    Some(Value::number(entry))
}
