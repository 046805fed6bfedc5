//! Bounds of scalars that hold for all values of their letters: `exp` is positive, squares are not negative, a sine
//! is at most one. Takes an expression; gives an interval that contains every possible value, and whether each end
//! may be attained. Bounds are rounded outward and never wrong.

use super::{Expr, Function, Node};
use crate::algebra::Rational;

/// The size of the largest expression that is bounded; a larger one has no bounds.
const LARGEST: u32 = 4_000;

/// An end of an interval.
#[derive(Clone, Copy, PartialEq, Debug)]
struct End {
    at: f64,
    /// Whether the value may be attained: `exp` comes arbitrarily close to 0 but is never 0.
    met: bool,
}

/// An interval that contains all possible values of a scalar.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Range {
    low: End,
    high: End,
}

const fn end(at: f64, met: bool) -> End {
    End { at, met }
}

impl End {
    fn opposite(self) -> End {
        end(-self.at, self.met)
    }

    fn plus(self, other: End) -> End {
        end(self.at + other.at, self.met && other.met)
    }

    fn times(self, other: End) -> End {
        // Zero times an infinite bound: the factor 0 decides.
        match self.at == 0.0 || other.at == 0.0 {
            true => end(
                0.0,
                (self.at == 0.0 && self.met) || (other.at == 0.0 && other.met),
            ),
            false => end(self.at * other.at, self.met && other.met),
        }
    }
}

impl Range {
    const ALL: Range = Range {
        low: end(f64::NEG_INFINITY, false),
        high: end(f64::INFINITY, false),
    };

    const fn between(low: f64, high: f64) -> Range {
        Range {
            low: end(low, true),
            high: end(high, true),
        }
    }

    /// The smallest interval that contains these ends.
    fn hull(ends: &[End]) -> Range {
        let mut list = ends.iter().copied();
        let Some(first) = list.next() else {
            return Range::ALL;
        };
        let mut out = Range {
            low: first,
            high: first,
        };
        for x in list {
            if x.at.is_nan() {
                return Range::ALL;
            }
            let low = out.low;
            if x.at < low.at || (x.at == low.at && x.met) {
                out.low = x;
            }
            let high = out.high;
            if x.at > high.at || (x.at == high.at && x.met) {
                out.high = x;
            }
        }
        match first.at.is_nan() {
            true => Range::ALL,
            false => out,
        }
    }

    /// The interval with its ends moved outward by more than the rounding error. Integers are exact, and 0 stays 0.
    fn outward(self) -> Range {
        let exact = |x: f64| x.fract() == 0.0 && x.abs() < 1e15;
        let moved = |e: End, by: f64| match exact(e.at) || e.at.is_infinite() {
            true => e,
            false => end(e.at + by * 1e-12 * e.at.abs(), false),
        };
        Range {
            low: moved(self.low, -1.0),
            high: moved(self.high, 1.0),
        }
    }

    /// The image under an increasing function.
    fn under(self, f: impl Fn(f64) -> f64) -> Range {
        let image = |e: End| end(f(e.at), e.met);
        Range::hull(&[image(self.low), image(self.high)]).rounded()
    }

    /// The interval moved outward, for a computation that is never exact.
    fn rounded(self) -> Range {
        let moved = |e: End, by: f64| match e.at == 0.0 || e.at.is_infinite() {
            true => e,
            false => end(e.at + by * 1e-12 * e.at.abs(), e.met),
        };
        Range {
            low: moved(self.low, -1.0),
            high: moved(self.high, 1.0),
        }
    }

    fn opposite(self) -> Range {
        Range {
            low: self.high.opposite(),
            high: self.low.opposite(),
        }
    }

    fn plus(self, other: Range) -> Range {
        let (low, high) = (self.low.plus(other.low), self.high.plus(other.high));
        match low.at.is_nan() || high.at.is_nan() {
            true => Range::ALL,
            false => Range { low, high }.outward(),
        }
    }

    fn times(self, other: Range) -> Range {
        let (a, b) = ([self.low, self.high], [other.low, other.high]);
        let all = a.map(|x| b.map(|y| x.times(y)));
        Range::hull(all.as_flattened()).outward()
    }

    /// The reciprocal; unbounded if the interval contains zero in its interior.
    fn inverse(self) -> Range {
        let over = |e: End, zero: f64| match e.at == 0.0 {
            true => end(zero, false),
            false => end(1.0 / e.at, e.met && e.at.is_finite()),
        };
        if self.low.at >= 0.0 {
            let ends = [
                over(self.low, f64::INFINITY),
                over(self.high, f64::INFINITY),
            ];
            return Range::hull(&ends).outward();
        }
        if self.high.at <= 0.0 {
            let ends = [
                over(self.low, f64::NEG_INFINITY),
                over(self.high, f64::NEG_INFINITY),
            ];
            return Range::hull(&ends).outward();
        }
        Range::ALL
    }

    fn magnitude(self) -> Range {
        let (a, b) = (self.low, self.high);
        let size = |e: End| end(e.at.abs(), e.met);
        match a.at <= 0.0 && b.at >= 0.0 {
            true => {
                let inside = a.at < 0.0 && b.at > 0.0;
                let zero = end(
                    0.0,
                    inside || (a.at == 0.0 && a.met) || (b.at == 0.0 && b.met),
                );
                Range::hull(&[zero, size(a), size(b)])
            }
            false => Range::hull(&[size(a), size(b)]),
        }
    }

    fn power(self, q: Rational) -> Range {
        if q.is_negative() {
            return self.power(q.negated()).inverse();
        }
        let whole = q.as_integer();
        let base = match whole {
            Some(1) => return self,
            Some(n) if n % 2 != 0 => return self.under(|x| x.powi(n)),
            Some(_) => self.magnitude(),
            // A root is defined from 0 on only.
            None => Range {
                low: match self.low.at > 0.0 {
                    true => self.low,
                    false => end(0.0, true),
                },
                high: self.high,
            },
        };
        base.under(|x| x.max(0.0).powf(q.value()))
    }

    /// Whether every value is above zero.
    pub fn is_positive(self) -> bool {
        self.low.at > 0.0 || (self.low.at == 0.0 && !self.low.met)
    }

    /// Whether no value is below zero.
    pub fn is_not_negative(self) -> bool {
        self.low.at >= 0.0
    }

    /// Whether every value is below zero.
    pub fn is_negative(self) -> bool {
        self.opposite().is_positive()
    }

    /// Whether no value is above zero.
    pub fn is_not_positive(self) -> bool {
        self.high.at <= 0.0
    }

    /// Whether every value is beyond the largest double.
    pub fn overflows(self) -> bool {
        self.low.at > f64::MAX || self.high.at < -f64::MAX
    }
}

/// The bounds of a scalar.
pub fn range(e: &Expr) -> Range {
    match e.size() > LARGEST || !e.shape().is_scalar() {
        true => Range::ALL,
        false => bounds(e),
    }
}

fn bounds(e: &Expr) -> Range {
    if !e.shape().is_scalar() {
        return Range::ALL;
    }
    match e.node() {
        Node::Zero(_) => Range::between(0.0, 0.0),
        Node::Number(q) => Range::between(q.value(), q.value()).outward(),
        Node::Constant(c) => Range::between(c.value(), c.value()).outward(),
        Node::Neg(a) => bounds(a).opposite(),
        Node::Sum(list) => {
            let mut parts = list.iter().map(bounds);
            let first = parts.next().unwrap_or(Range::between(0.0, 0.0));
            parts.fold(first, Range::plus)
        }
        Node::Product(list) if list.iter().all(|f| f.shape().is_scalar()) => {
            let mut distinct: Vec<(&Expr, i64)> = Vec::new();
            for f in list {
                match distinct.iter_mut().find(|(x, _)| *x == f) {
                    Some((_, n)) => *n += 1,
                    None => distinct.push((f, 1)),
                }
            }
            let parts = distinct
                .into_iter()
                .map(|(f, n)| bounds(f).power(Rational::integer(n)));
            parts.fold(Range::between(1.0, 1.0), Range::times)
        }
        Node::Quotient(a, b) => bounds(a).times(bounds(b).inverse()),
        Node::Power(a, q) => bounds(a).power(*q),
        Node::Dot(a, b) if a == b => Range {
            low: end(0.0, true),
            ..Range::ALL
        },
        Node::Call(f, a) => image(*f, bounds(a)),
        _ => Range::ALL,
    }
}

/// The image of an interval under a function.
fn image(f: Function, a: Range) -> Range {
    let within = |r: Range, low: f64, high: f64| Range {
        low: end(r.low.at.max(low), r.low.met),
        high: end(r.high.at.min(high), r.high.met),
    };
    let constant = a.low.at == a.high.at;
    match f {
        Function::Exp => a.under(f64::exp),
        Function::Log => match a.low.at > 0.0 {
            true => a.under(f64::ln),
            false => Range {
                high: a.under(|x| x.max(0.0).ln()).high,
                ..Range::ALL
            },
        },
        Function::Sin | Function::Cos => {
            let whole = Range::between(-1.0, 1.0);
            let value = match f {
                Function::Sin => a.low.at.sin(),
                _ => a.low.at.cos(),
            };
            match constant && value.is_finite() {
                true => within(Range::between(value, value).rounded(), -1.0, 1.0),
                false => whole,
            }
        }
        Function::Sinh => a.under(f64::sinh),
        Function::Cosh => {
            let r = a.magnitude().under(f64::cosh);
            Range {
                low: end(r.low.at.max(1.0), true),
                high: r.high,
            }
        }
        Function::Tanh => {
            // It comes arbitrarily close to one.
            let r = a.under(f64::tanh);
            Range {
                low: match r.low.at <= -1.0 {
                    true => end(-1.0, false),
                    false => r.low,
                },
                high: match r.high.at >= 1.0 {
                    true => end(1.0, false),
                    false => r.high,
                },
            }
        }
        Function::Abs => a.magnitude(),
        Function::Sign => match (a.is_positive(), a.is_negative()) {
            (true, _) => Range::between(1.0, 1.0),
            (_, true) => Range::between(-1.0, -1.0),
            _ => Range {
                low: end(if a.is_not_negative() { 0.0 } else { -1.0 }, true),
                high: end(if a.is_not_positive() { 0.0 } else { 1.0 }, true),
            },
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::shape::{Shape, Structure};
    use crate::expr::symbol::{Role, Symbols};
    use crate::expr::{self, call, integer};

    #[test]
    fn values_lie_in_their_range() {
        // Every function and operation of two letters, at many values.
        let mut s = Symbols::default();
        let id = s.add("p", Shape::SCALAR, Structure::General, Role::Parameter);
        let p = expr::here(&s, id);
        let mut all = vec![p.clone()];
        for f in Function::ALL {
            all.push(call(f, p.clone()));
        }
        for q in [-3, -2, 2, 3] {
            all.push(expr::power(p.clone(), Rational::integer(q)));
            all.push(expr::power(
                expr::add(integer(1), expr::power(p.clone(), Rational::integer(2))),
                Rational::HALF
                    .times(Rational::integer(q))
                    .unwrap_or(Rational::ONE),
            ));
        }
        let once = all.clone();
        for a in &once {
            for b in &once {
                all.push(expr::mul(a.clone(), b.clone()));
                all.push(expr::sub(a.clone(), b.clone()));
                all.push(expr::quotient(a.clone(), b.clone()));
            }
            all.extend(Function::ALL.map(|f| call(f, a.clone())));
        }
        let mut bounded = 0;
        for e in &all {
            let r = range(e);
            bounded += usize::from(r != Range::ALL);
            // Points where a quotient is undefined or a power underflows are skipped.
            for k in (-40..=-5).chain(5..=40) {
                let mut values = crate::interpret::Assignment::default();
                values.set("p", 0, 1, 1, &[f64::from(k) * 0.12]);
                let Ok(v) = crate::interpret::evaluate(&s, e, &values) else {
                    continue;
                };
                let v = v.get(0, 0);
                if v.is_finite() {
                    assert!(r.low.at <= v && v <= r.high.at, "{e:?} = {v} in {r:?}");
                    assert!(
                        v != 0.0 || !r.is_positive() && !r.is_negative(),
                        "{e:?} {r:?}"
                    );
                }
            }
        }
        assert!(bounded > 200, "{bounded} of {}", all.len());
    }

    #[test]
    fn ends_that_are_never_met() {
        let mut s = Symbols::default();
        let id = s.add("p", Shape::SCALAR, Structure::General, Role::Parameter);
        let p = expr::here(&s, id);
        let exp = call(Function::Exp, p.clone());
        assert!(range(&exp).is_positive());
        assert!(range(&expr::neg(exp.clone())).is_negative());
        assert!(range(&expr::mul(exp.clone(), exp.clone())).is_positive());
        assert!(range(&expr::quotient(integer(1), exp)).is_positive());
        let square = expr::mul(p.clone(), p.clone());
        assert!(range(&square).is_not_negative() && !range(&square).is_positive());
        let tanh = call(Function::Tanh, p.clone());
        assert!(range(&expr::sub(integer(1), tanh)).is_positive());
        assert!(!range(&p).is_not_negative());
        assert!(range(&call(Function::Exp, integer(1000))).overflows());
    }
}
