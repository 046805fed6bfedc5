//! The integers modulo the prime 2^61 - 1, the field in which identities are decided. Takes and gives representatives
//! below the prime.

use super::rational::Rational;

pub(super) const PRIME: u64 = (1 << 61) - 1;

#[inline(always)]
pub(crate) fn add(a: u64, b: u64) -> u64 {
    let sum = a + b;
    if sum >= PRIME { sum - PRIME } else { sum }
}

pub(crate) fn negate(a: u64) -> u64 {
    if a == 0 { 0 } else { PRIME - a }
}

#[inline(always)]
pub(crate) fn mul(a: u64, b: u64) -> u64 {
    let wide = u128::from(a) * u128::from(b);
    // 2^61 is 1 modulo the prime: the high part is added to the low one.
    add((wide as u64) & PRIME, (wide >> 61) as u64)
}

pub(super) fn power(mut a: u64, mut n: u64) -> u64 {
    let mut out = 1;
    while n > 0 {
        if n & 1 == 1 {
            out = mul(out, a);
        }
        a = mul(a, a);
        n >>= 1;
    }
    out
}

pub(crate) fn inverse(a: u64) -> Option<u64> {
    (a != 0).then(|| power(a, PRIME - 2))
}

/// A square root, if there is one. The root of a square is always the same of the two.
pub(super) fn root(a: u64) -> Option<u64> {
    // The prime is 3 modulo 4.
    let r = power(a, PRIME.div_ceil(4));
    (mul(r, r) == a).then_some(r)
}

/// A half and a quarter: 2^61 is 1 modulo the prime.
pub(super) const HALF: u64 = 1 << 60;
pub(super) const QUARTER: u64 = 1 << 59;

pub(super) fn of_rational(q: Rational) -> Option<u64> {
    let num = (q.numerator().rem_euclid(i128::from(PRIME))) as u64;
    match q.denominator() {
        1 => Some(num),
        2 => Some(mul(num, HALF)),
        den => {
            let den = (den.rem_euclid(i128::from(PRIME))) as u64;
            Some(mul(num, inverse(den)?))
        }
    }
}

/// The fraction with numerator and denominator up to `largest` that equals this number.
pub(crate) fn rational(x: u64, largest: u64) -> Option<(i64, i64)> {
    // Euclid's algorithm on the prime and x, stopped at a small remainder.
    let (mut a, mut b) = (i128::from(PRIME), i128::from(x));
    let (mut s, mut t) = (0i128, 1i128);
    while b > i128::from(largest) {
        let q = a / b;
        (a, b) = (b, a - q * b);
        (s, t) = (t, s - q * t);
    }
    let (num, den) = if t < 0 { (-b, -t) } else { (b, t) };
    if den == 0 || den > i128::from(largest) {
        return None;
    }
    Some((i64::try_from(num).ok()?, i64::try_from(den).ok()?))
}

/// A fixed mixing of bits (SplitMix64): the same points in every run.
pub(super) fn mix(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    (x ^ (x >> 31)) % PRIME
}
