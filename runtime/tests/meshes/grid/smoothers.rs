//! Smoothers: exact factors of eigenfunctions, the inner product in which each is self-adjoint, and scalars with derivatives
//! against plain numbers.

use super::common::*;
use clebsch::mesh::*;
use clebsch::{DoubleDouble, Dual, Real};
use core::f64::consts::PI;

/// The factor of `cos(q π x / L)` between walls, and of `cos(q 2π x / L)` in a periodic direction.
fn factor(of: &Setting<2>, d: usize, q: usize) -> f64 {
    let cells = of.grid.expect("a grid")[d] as f64;
    let spacing = of.domain.lengths[d] / cells;
    match of.domain.walls[d] {
        Wall::Periodic => (2.0 * PI * q as f64 / of.domain.lengths[d]).powi(2),
        // The quotient of stiffness and mass of linear elements.
        Wall::Solid => {
            let cosine = (PI * q as f64 / cells).cos();
            6.0 * (1.0 - cosine) / (spacing * spacing * (2.0 + cosine))
        }
    }
}

fn wave(of: &Setting<2>, q: [usize; 2]) -> Vec<f64> {
    let nodes = Nodes::new(of).expect("a grid");
    let one = |x: [f64; 2]| {
        let along = |d: usize| {
            let half = match of.domain.walls[d] {
                Wall::Periodic => 2.0,
                Wall::Solid => 1.0,
            };
            (half * PI * q[d] as f64 * x[d] / of.domain.lengths[d]).cos()
        };
        along(0) * along(1)
    };
    nodes.places().into_iter().map(one).collect()
}

#[test]
fn waves_are_damped_by_exact_factors() {
    for domain in planes() {
        let of = setting(domain, [12, 15], 0);
        let alpha = 0.3_f64;
        let mut split = smooth::<f64, 2>::new(&of, (alpha,)).expect("a grid");
        let mut whole = smooth_isotropic::<f64, 2>::new(&of, (alpha,)).expect("a grid");
        for q in [[0, 0], [1, 0], [0, 3], [2, 5], [6, 7]] {
            let h = wave(&of, q);
            let [a, b] = [0, 1].map(|d| alpha * alpha * factor(&of, d, q[d]));
            let (s, i) = (values(&mut split, &h), values(&mut whole, &h));
            for ((h, s), i) in h.iter().zip(s).zip(i) {
                assert!((s - h / ((1.0 + a) * (1.0 + b))).abs() < 1e-14);
                // Conjugate gradients: the residual, at rounding level, divided by the smallest eigenvalue 0.05.
                assert!((i - h / (1.0 + a + b)).abs() < 1e-13);
            }
        }
    }
}

#[test]
fn between_walls_constants_stay_to_the_last_bit() {
    let of = setting(Domain::basin([1.0, 1.0]), [10, 17], 0);
    let mut split = smooth::<f64, 2>::new(&of, (0.3,)).expect("a grid");
    let h = vec![0.7; split.sites()];
    assert_eq!(values(&mut split, &h), h);
}

/// The asymmetry of an operator in a weighted inner product, relative to the product.
fn asymmetry(apply: &mut dyn FnMut(&[f64]) -> Vec<f64>, weights: &[f64]) -> f64 {
    let mut numbers = Numbers::new(11);
    let product =
        |a: &[f64], b: &[f64]| sum(a.iter().zip(b).zip(weights).map(|((a, b), w)| a * b * w));
    let (a, b) = (numbers.list(weights.len()), numbers.list(weights.len()));
    let (one, other) = (product(&a, &apply(&b)), product(&apply(&a), &b));
    (one / other - 1.0).abs()
}

fn check<const D: usize, F>(of: &Setting<D>, alpha: f64)
where
    F: for<'a> Functional<f64, D, Argument = f64, Data<'a> = (f64,)>,
{
    let mut smooth = F::new(of, (alpha,)).expect("a grid");
    let nodes = Nodes::new(of).expect("a grid");
    let weights = nodes.weights::<f64>();
    // Rounding error of sums, or of a solution times the condition number of the matrix.
    let ratio = largest(nodes.axes().iter().map(|axis| alpha / axis.spacing()));
    let tolerance = 1e-14_f64.max(1e-16 * (1.0 + 12.0 * ratio * ratio));
    assert!(asymmetry(&mut |h| values(&mut smooth, h), &weights) < tolerance);
    let mut numbers = Numbers::new(12);
    let (h, seed) = (numbers.list(weights.len()), numbers.list(weights.len()));
    let mut back = vec![0.0; h.len()];
    let s = values(&mut smooth, &h);
    smooth.pull_back(&h, &seed, &mut back).expect("a value");
    let product = |a: &[f64], b: &[f64]| sum(a.iter().zip(b).map(|(a, b)| a * b));
    let error = (product(&s, &seed) / product(&h, &back) - 1.0).abs();
    assert!(error < tolerance, "{of:?}, {alpha}: {error:e}");
    // The smoother conserves the mass.
    let error = (product(&s, &weights) / product(&h, &weights) - 1.0).abs();
    assert!(error < tolerance, "{of:?}, {alpha}: {error:e}");
}

#[test]
fn each_smoother_is_its_own_adjoint_in_the_weights_of_nodes() {
    for alpha in [0.0, 0.02, 0.3, 5.0] {
        for domain in lines() {
            for cells in [1, 2, 3, 8, 65] {
                check::<1, smooth<f64, 1>>(&setting(domain, [cells], 0), alpha);
            }
        }
        for domain in planes() {
            for grid in [[1, 1], [2, 3], [16, 9], [33, 40]] {
                check::<2, smooth<f64, 2>>(&setting(domain, grid, 0), alpha);
                check::<2, smooth_isotropic<f64, 2>>(&setting(domain, grid, 0), alpha);
            }
        }
    }
}

/// Solves `(1 + α²K) s = h` with the symmetric second difference between walls, by elimination.
pub fn naive(h: &[f64], ratio: f64) -> Vec<f64> {
    let n = h.len();
    let diagonal = |i: usize| match i == 0 || i + 1 == n {
        true => 1.0 + ratio,
        false => 1.0 + 2.0 * ratio,
    };
    let (mut pivots, mut s) = (vec![diagonal(0)], h.to_vec());
    for i in 1..n {
        let factor = ratio / pivots[i - 1];
        pivots.push(diagonal(i) - factor * ratio);
        s[i] += factor * s[i - 1];
    }
    s[n - 1] /= pivots[n - 1];
    for i in (0..n - 1).rev() {
        s[i] = (s[i] + ratio * s[i + 1]) / pivots[i];
    }
    s
}

#[test]
fn a_symmetric_matrix_is_not_its_own_adjoint_in_the_weights() {
    let of = setting(Domain::basin([1.0]), [16], 0);
    let weights = Nodes::new(&of).expect("a grid").weights::<f64>();
    let plain = vec![1.0; weights.len()];
    let mut apply = |h: &[f64]| naive(h, 4.0);
    assert!(asymmetry(&mut apply, &plain) < 1e-14);
    assert!(asymmetry(&mut apply, &weights) > 1e-3);
}

/// Checks values, and derivatives with respect to an amplitude, for other scalars.
fn scalars<const D: usize, S, P, W>(of: &Setting<D>, tolerance: f64)
where
    S: for<'a> Functional<f64, D, Argument = f64, Data<'a> = (f64,)>,
    P: for<'a> Functional<Dual<1>, D, Argument = Dual<1>, Data<'a> = (Dual<1>,)>,
    W: for<'a> Functional<DoubleDouble, D, Argument = DoubleDouble, Data<'a> = (DoubleDouble,)>,
{
    let alpha = 0.25;
    let mut plain = S::new(of, (alpha,)).expect("a grid");
    let mut dual = P::new(of, (Dual::constant(alpha),)).expect("a grid");
    let mut wide = W::new(of, (DoubleDouble::from_f64(alpha),)).expect("a grid");
    let mut numbers = Numbers::new(21);
    let (h, change) = (numbers.list(plain.sites()), numbers.list(plain.sites()));
    let both: Vec<_> = h
        .iter()
        .zip(&change)
        .map(|(h, c)| Dual {
            real: *h,
            dual: [*c],
        })
        .collect();
    let (s, t) = (values(&mut plain, &h), values(&mut plain, &change));
    let both = values(&mut dual, &both);
    let wider: Vec<_> = h.iter().map(|h| DoubleDouble::from_f64(*h)).collect();
    let wider = values(&mut wide, &wider);
    for i in 0..s.len() {
        assert!((both[i].real - s[i]).abs() < tolerance);
        assert!((both[i].dual[0] - t[i]).abs() < tolerance);
        assert!((wider[i].high() - s[i]).abs() < tolerance);
    }
    // Smoothing is linear: checks a multiple of the values to all digits of the scalar.
    let third = DoubleDouble::one_third();
    let thirds: Vec<_> = h
        .iter()
        .map(|h| DoubleDouble::from_f64(*h) * third)
        .collect();
    for (t, s) in values(&mut wide, &thirds).into_iter().zip(wider) {
        assert!((t * DoubleDouble::from_f64(3.0) - s).magnitude() < 1e-28);
    }
}

trait Third {
    fn one_third() -> Self;
}

impl Third for DoubleDouble {
    fn one_third() -> Self {
        Self::from_ratio(1, 3)
    }
}

#[test]
fn other_scalars_give_the_same_values() {
    for domain in lines() {
        type S<T> = smooth<T, 1>;
        scalars::<1, S<f64>, S<Dual<1>>, S<DoubleDouble>>(&setting(domain, [31], 0), 1e-14);
    }
    for domain in planes() {
        type S<T> = smooth<T, 2>;
        type I<T> = smooth_isotropic<T, 2>;
        let of = setting(domain, [11, 14], 0);
        scalars::<2, S<f64>, S<Dual<1>>, S<DoubleDouble>>(&of, 1e-14);
        scalars::<2, I<f64>, I<Dual<1>>, I<DoubleDouble>>(&of, 1e-13);
    }
}

#[test]
fn a_length_that_is_none_is_refused() {
    let of = setting(Domain::basin([1.0, 1.0]), [10, 17], 0);
    for alpha in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(smooth::<f64, 2>::new(&of, (alpha,)).is_err());
        assert!(smooth_isotropic::<f64, 2>::new(&of, (alpha,)).is_err());
    }
    assert_eq!(smoothing_length(&of), Ok(0.2));
}
