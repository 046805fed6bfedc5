//! The scalar types on their own: functions, derivatives, reductions, rational powers.

use clebsch::num_traits::{One, Zero};
use clebsch::{DoubleDouble, Dual, Lanes, Real};

fn dd(x: f64) -> DoubleDouble {
    DoubleDouble::from(x)
}

fn off(a: DoubleDouble, b: DoubleDouble) -> f64 {
    ((a - b) / b).magnitude()
}

/// Operations on more than eight derivatives call functions instead of loops in place.
#[test]
fn many_derivatives_are_computed_as_few_are() {
    fn all<const N: usize>() -> Vec<(f64, [f64; 2])> {
        let [x, y] = [0.7, -1.3].map(|x| x * std::f64::consts::PI);
        let (x, y) = (Dual::<N>::variable(x, 0), Dual::variable(y, 1));
        let ended = [
            x + y,
            x - y,
            x * y,
            x / y,
            -x,
            x.sqrt(),
            x.exp(),
            y.sin(),
            y.tanh(),
        ];
        let each = ended.into_iter();
        each.map(|z| (z.real, [z.dual[0], z.dual[1]])).collect()
    }
    assert_eq!(all::<2>(), all::<8>());
    assert_eq!(all::<2>(), all::<9>());
    assert_eq!(all::<2>(), all::<32>());
    // A derivative that no operation touches stays zero, and the last one is not left out.
    let [x, y] = [3, 31].map(|k| Dual::<32>::variable(0.5, k));
    let product = x * y - y;
    assert_eq!(
        (product.dual[0], product.dual[3], product.dual[31]),
        (0.0, 0.5, -0.5)
    );
}

#[test]
fn double_double_has_thirty_digits() {
    // Constants to 32 digits, as sums of two doubles.
    let pi = DoubleDouble::from_parts(std::f64::consts::PI, 1.224_646_799_147_353_2e-16);
    let e = DoubleDouble::from_parts(std::f64::consts::E, 1.445_646_891_729_250_2e-16);
    let ln_2 = DoubleDouble::from_parts(std::f64::consts::LN_2, 2.319_046_813_846_299_6e-17);
    let root_2 = DoubleDouble::from_parts(std::f64::consts::SQRT_2, -9.667_293_313_452_913e-17);
    assert!(off(dd(1.0).exp(), e) < 1e-30);
    assert!(off(e.ln(), dd(1.0)) < 1e-30);
    assert!(off(dd(2.0).ln(), ln_2) < 1e-30);
    assert!(off(dd(2.0).sqrt(), root_2) < 1e-31);
    assert!(off((pi / dd(6.0)).sin(), dd(0.5)) < 1e-30);
    assert!(off((pi / dd(3.0)).cos(), dd(0.5)) < 1e-30);
    for i in -20..=20 {
        let x = DoubleDouble::from_ratio(i, 3);
        let (sin, cos) = (x.sin(), x.cos());
        assert!((sin * sin + cos * cos - dd(1.0)).magnitude() < 1e-30);
        assert!(off(x.exp() * (-x).exp(), dd(1.0)) < 1e-30);
        assert!((x.exp().ln() - x).magnitude() < 1e-29);
        assert!((sin - dd(2.0) * (x * dd(0.5)).sin() * (x * dd(0.5)).cos()).magnitude() < 1e-30);
    }
    assert!(off(DoubleDouble::from_ratio(1, 3) * dd(3.0), dd(1.0)) < 1e-31);
    let large = DoubleDouble::from_ratio(i64::MAX, 1);
    assert_eq!((large - dd(63.0_f64.exp2())).value(), -1.0);
    assert!(dd(-1.0).sqrt().value().is_nan());
    assert!(dd(-1.0).ln().value().is_nan());
    assert_eq!(dd(0.0).sqrt(), dd(0.0));
    assert_eq!(dd(1000.0).exp().value(), f64::INFINITY);
    assert_eq!(dd(-1000.0).exp().value(), 0.0);
    assert_eq!((-dd(2.5)).abs(), dd(2.5));
    for i in -20..=20 {
        // On both sides of the switch between series and exponentials.
        let x = DoubleDouble::from_ratio(i, 13);
        let (sinh, cosh) = (x.sinh(), x.cosh());
        assert!(off(sinh + cosh, x.exp()) < 1e-30);
        assert!(off(cosh * cosh - sinh * sinh, dd(1.0)) < 1e-29);
        assert!((x.tanh() * cosh - sinh).magnitude() < 1e-30);
        assert!((dd(2.0) * sinh * cosh - (x + x).sinh()).magnitude() < 1e-29);
    }
    assert_eq!(dd(-1000.0).tanh(), dd(-1.0));
    assert!(dd(f64::NAN).tanh().value().is_nan());
}

/// Every function of a dual number, against the central difference quotient in double-double.
#[test]
fn dual_numbers_follow_the_chain_rule() {
    fn all<T: Real>(x: T) -> [T; 19] {
        let c = T::from_f64(0.7);
        [
            x + c * x,
            c - x,
            x * x,
            c / x,
            -x,
            x.sqrt(),
            x.exp(),
            x.ln(),
            x.sin(),
            x.cos(),
            x.powi(5),
            x.powi(-3),
            x.powr(2, 3),
            x.powr(-3, 2),
            (x - c).sinh(),
            (x - c).cosh(),
            (x - c).tanh(),
            (x - c).abs(),
            (x - c).sign(),
        ]
    }
    for x in [0.2, 1.0, 1.3, 4.0] {
        let dual = all(Dual::<1>::variable(x, 0));
        let step = 1e-10;
        let (plus, minus) = (all(dd(x) + dd(step)), all(dd(x) - dd(step)));
        for (k, value) in dual.iter().enumerate() {
            let slope = ((plus[k] - minus[k]) / dd(2.0 * step)).value();
            let allowed = 4e-15 * slope.abs().max(1.0);
            assert!(
                (value.dual[0] - slope).abs() < allowed,
                "function {k} at {x}"
            );
            assert!((value.real - all(x)[k]).abs() <= 1e-15 * value.real.abs().max(1.0));
        }
    }
}

#[test]
fn reductions_see_every_lane_and_every_derivative() {
    let lanes = Lanes([2.0, -3.0, 0.5]);
    assert_eq!(
        (lanes.value(), lanes.least(), lanes.greatest()),
        (2.0, -3.0, 2.0)
    );
    assert_eq!(lanes.magnitude(), 3.0);
    assert_eq!((lanes.lane(1), Lanes::<3>::LANES), (-3.0, 3));
    assert!(lanes.lane(3).is_nan());
    let poisoned = Lanes([2.0, f64::NAN, 0.5]);
    assert!(poisoned.least().is_nan() && poisoned.greatest().is_nan());
    assert!(poisoned.magnitude().is_nan() && !poisoned.is_finite());
    assert!(Lanes([-1.0, 0.0, -0.0]).nowhere_positive() && (-1.0_f64).nowhere_positive());
    assert!(
        !lanes.nowhere_positive() && !poisoned.nowhere_positive() && !1.0_f64.nowhere_positive()
    );
    assert!(!Lanes([-1.0, f64::NAN]).nowhere_positive() && !f64::NAN.nowhere_positive());
    assert!(lanes == lanes && poisoned != poisoned && lanes != Lanes([2.0, -3.0, 0.25]));
    assert!(lanes.is_finite() && !poisoned.is_finite());
    let mask = lanes.where_positive(Lanes([7.0; 3]));
    assert_eq!(mask, Lanes([7.0, 0.0, 7.0]));
    assert_eq!(
        poisoned.where_positive(Lanes::one()),
        Lanes([1.0, 0.0, 1.0])
    );

    let mut dual = Dual::<2>::variable(0.5, 1);
    assert_eq!((dual.magnitude(), dual.least()), (1.0, 0.5));
    dual.dual[0] = f64::NAN;
    assert!(dual.magnitude().is_nan() && !dual.is_finite());
    assert_eq!(Dual::<2>::variable(0.5, 7), Dual::constant(0.5));
    assert!(!dual.is_zero() && Dual::<2>::zero().is_zero());
}

#[test]
fn lanes_round_as_doubles_do() {
    let (a, b) = ([0.1, -2.7, 1e300], [3.3, 1e-5, 7.0]);
    let (x, y) = (Lanes(a), Lanes(b));
    for i in 0..3 {
        assert_eq!((x + y).0[i], a[i] + b[i]);
        assert_eq!((x - y).0[i], a[i] - b[i]);
        assert_eq!((x * y).0[i], a[i] * b[i]);
        assert_eq!((x / y).0[i], a[i] / b[i]);
        assert_eq!(y.sqrt().0[i], b[i].sqrt());
        assert_eq!(y.ln().0[i], b[i].ln());
        assert_eq!(y.sinh().0[i], b[i].sinh());
        assert_eq!(y.cosh().0[i], b[i].cosh());
        assert_eq!(y.tanh().0[i], b[i].tanh());
        assert_eq!(x.abs().0[i], a[i].abs());
        assert_eq!(x.sign().0[i], a[i].signum());
    }
    assert_eq!(
        [1.0, 2.0].into_iter().collect::<Lanes<3>>(),
        Lanes([1.0, 2.0, 0.0])
    );
}

#[test]
fn signs_of_zero_and_of_no_number() {
    assert_eq!((Real::sign(0.0), Real::sign(-0.0)), (0.0, 0.0));
    assert!(Real::sign(f64::NAN).is_nan() && Real::abs(f64::NAN).is_nan());
    assert_eq!(Real::abs(Dual::<1>::variable(-2.0, 0)).dual, [-1.0]);
}

#[test]
fn rational_powers() {
    assert_eq!(2.0.powr(3, 1), 8.0);
    assert_eq!(4.0.powr(3, 2), 8.0);
    assert_eq!(4.0.powr(-6, 4), 0.125);
    assert_eq!(4.0.powr(1, -2), 0.5);
    assert_eq!((-2.0).powr(4, 2), 4.0);
    assert!((8.0.powr(2, 3) - 4.0).abs() < 1e-15);
    assert_eq!(2.0.powr(0, 5), 1.0);
    assert!(2.0.powr(1, 0).is_nan());
    assert!((-8.0).powr(1, 3).is_nan());
    assert_eq!(f64::from_ratio(1, 3), 1.0 / 3.0);
    assert_eq!(Real::powi(2.0, -2), 0.25);
    assert_eq!(Real::powi(dd(3.0), 0), dd(1.0));
    assert_eq!(2.0.powr(i64::MIN, i64::MIN), 2.0);
}

/// The root of zero: zero derivative if the argument does not vary, no derivative if it varies.
#[test]
fn the_root_of_zero_has_a_change_only_where_nothing_changes() {
    let still = Dual::<2>::constant(0.0).sqrt();
    assert_eq!((still.real, still.dual), (0.0, [0.0; 2]));
    // The length of a vector that stays zero along one direction and changes along the other.
    let x = Dual {
        real: 0.0,
        dual: [0.0, 1.0],
    };
    let length = (x * x).sqrt();
    assert_eq!((length.real, length.dual), (0.0, [0.0; 2]));
    let grows = x.sqrt();
    assert_eq!((grows.real, grows.dual[0]), (0.0, 0.0));
    assert_eq!(grows.dual[1], f64::INFINITY);
    assert!(!grows.is_finite());
    // Away from zero, the chain rule applies; below zero, the root is NaN.
    let four = Dual {
        real: 4.0,
        dual: [1.0, 0.0],
    };
    assert_eq!((four.sqrt().real, four.sqrt().dual), (2.0, [0.25, 0.0]));
    assert!(Dual::<1>::constant(-1.0).sqrt().real.is_nan());
}
