//! The running error bounds the true error, and is at most a thousand times one rounding of the terms. The tests
//! compare random expressions with the same expressions in double-double.

use clebsch_check::{Number, Slope, UNIT, function};

/// A number with twice the digits.
#[derive(Clone, Copy, Debug)]
struct Wide {
    high: f64,
    low: f64,
}

fn two_sum(a: f64, b: f64) -> Wide {
    let high = a + b;
    let part = high - a;
    let low = (a - (high - part)) + (b - part);
    Wide { high, low }
}

fn two_product(a: f64, b: f64) -> Wide {
    let high = a * b;
    Wide {
        high,
        low: a.mul_add(b, -high),
    }
}

impl Wide {
    fn of(high: f64) -> Self {
        Self { high, low: 0.0 }
    }

    fn plus(self, other: Self) -> Self {
        let sum = two_sum(self.high, other.high);
        two_sum(sum.high, sum.low + self.low + other.low)
    }

    fn negated(self) -> Self {
        Self {
            high: -self.high,
            low: -self.low,
        }
    }

    fn times(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        let rest = product.low + self.high * other.low + self.low * other.high;
        two_sum(product.high, rest)
    }

    fn over(self, other: Self) -> Self {
        let first = self.high / other.high;
        let left = self.plus(other.times(Self::of(-first)));
        let second = left.high / other.high;
        let left = left.plus(other.times(Self::of(-second)));
        two_sum(first, second).plus(Self::of(left.high / other.high))
    }

    fn root(self) -> Self {
        let first = Self::of(self.high.sqrt());
        let left = self.plus(first.times(first).negated());
        first.plus(left.over(Self::of(2.0 * first.high)))
    }
}

/// A value with one derivative.
#[derive(Clone, Copy, Debug)]
struct Exact {
    value: Wide,
    slope: Wide,
    /// The sizes of the terms of the derivative, which may cancel, summed.
    terms: f64,
}

impl Exact {
    fn plus(self, o: Self) -> Self {
        Self {
            value: self.value.plus(o.value),
            slope: self.slope.plus(o.slope),
            terms: self.terms + o.terms,
        }
    }

    fn times(self, o: Self) -> Self {
        Self {
            value: self.value.times(o.value),
            slope: self.slope.times(o.value).plus(self.value.times(o.slope)),
            terms: self.terms * o.value.high + self.value.high * o.terms,
        }
    }

    fn over(self, o: Self) -> Self {
        let value = self.value.over(o.value);
        let moved = value.times(o.slope).negated();
        Self {
            value,
            slope: self.slope.plus(moved).over(o.value),
            terms: (self.terms + value.high * o.terms) / o.value.high,
        }
    }

    fn root(self) -> Self {
        let value = self.value.root();
        let slope = self.slope.over(value.plus(value));
        let terms = self.terms / (2.0 * value.high);
        Self {
            value,
            slope,
            terms,
        }
    }
}

struct Random(u64);

impl Random {
    fn below(&mut self, n: u64) -> u64 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) % n
    }

    #[allow(clippy::cast_precision_loss)]
    fn between(&mut self) -> f64 {
        self.below(1 << 30) as f64 / (1u64 << 30) as f64 + 0.1 * std::f64::consts::PI
    }
}

/// A value, its exact twin, and the sizes of its terms.
type Both = (Number, Exact);

fn leaf(random: &mut Random) -> Both {
    let (x, slope) = (random.between(), random.between());
    let number = Number::exact(x).with_slope(0, slope, 0.0);
    let exact = Exact {
        value: Wide::of(x),
        slope: Wide::of(slope),
        terms: slope,
    };
    (number, exact)
}

fn tree(random: &mut Random, depth: u32) -> Both {
    if depth == 0 {
        return leaf(random);
    }
    let (a, x) = tree(random, depth - 1);
    let (b, y) = tree(random, depth - 1);
    match random.below(5) {
        0 | 1 => (a.plus(&b), x.plus(y)),
        2 => (a.times(&b), x.times(y)),
        3 => (a.over(&b), x.over(y)),
        // All values are positive.
        _ => (
            function("sqrt", &a).expect("known").times(&b),
            x.root().times(y),
        ),
    }
}

fn error(found: f64, exact: Wide) -> f64 {
    two_sum(found, -exact.high)
        .plus(Wide::of(-exact.low))
        .high
        .abs()
}

#[test]
fn the_running_error_covers_the_true_one_and_little_more() {
    let mut random = Random(7);
    let (mut widest, mut ratios) = (0.0_f64, Vec::new());
    for _ in 0..20_000 {
        let depth = 1 + u32::try_from(random.below(5)).expect("small");
        let (number, exact) = tree(&mut random, depth);
        let slope = number.slopes.first().copied().unwrap_or(Slope {
            of: 0,
            value: 0.0,
            error: 0.0,
        });
        for (found, bound, twin, terms) in [
            (number.value, number.error, exact.value, number.value),
            (slope.value, slope.error, exact.slope, exact.terms),
        ] {
            let wrong = error(found, twin);
            assert!(wrong <= bound, "{found}: {wrong:e} > {bound:e}");
            // An error may be zero by chance, so at least one rounding of the terms is assumed.
            let least = wrong.max(UNIT * terms);
            widest = widest.max(bound / least);
            ratios.push(bound / least);
        }
    }
    assert!(widest < 1e3, "{widest}");
    ratios.sort_by(f64::total_cmp);
    println!(
        "median {:.2}, largest {widest:.1}",
        ratios[ratios.len() / 2]
    );
}

/// Functions of the standard library: the bound covers the difference between two ways to compute them.
#[test]
fn functions_agree_with_their_identities() {
    let mut random = Random(11);
    for _ in 0..2000 {
        let x = Number::within(random.between(), 1e-15).with_slope(0, 1.0, 0.0);
        let of = |name: &str| function(name, &x).expect("known");
        let close = |a: &Number, b: &Number| {
            let (s, t) = (a.slope(0), b.slope(0));
            assert!(
                (a.value - b.value).abs() <= a.error + b.error,
                "{a:?} {b:?}"
            );
            assert!((s.0 - t.0).abs() <= s.1 + t.1, "{a:?} {b:?}");
        };
        let (sine, cosine) = (of("sin"), of("cos"));
        close(
            &sine.times(&sine).plus(&cosine.times(&cosine)),
            &Number::exact(1.0),
        );
        close(&of("sinh").over(&of("cosh")), &of("tanh"));
        close(&function("log", &of("exp")).expect("known"), &x);
        let root = of("sqrt");
        close(&root.times(&root), &x);
    }
}
