//! Forces on particles: the gradient of the discrete potential `V = (c0²/2) Σ w H (S H)`, composed of pull-backs as in a stepper.
//! Compared with derivatives of V by dual numbers and by central differences.

use super::common::*;
use clebsch::mesh::*;
use clebsch::nalgebra::SVector;
use clebsch::{Dual, Real};

/// The square of the wave speed of unit depth.
const SPEED_SQUARED: f64 = 1.7;

const ALPHA: f64 = 0.23;

/// The potential and, if requested, its derivative with respect to each position.
pub fn potential<T: Real, const D: usize, F, S, A: Field<T, D> + Send + Sync>(
    of: &Setting<D>,
    mass: &[T],
    at: &[[T; D]],
    forces: Option<&mut [A]>,
) -> T
where
    F: for<'a> Functional<T, D, Argument = A, Data<'a> = (&'a [T],)>,
    S: for<'a> Functional<T, D, Argument = T, Data<'a> = (T,)>,
{
    let mut deposit = F::new(of, (mass,)).expect("a grid");
    let mut smooth = S::new(of, (T::from_f64(ALPHA),)).expect("a grid");
    let weights = Nodes::new(of).expect("a grid").weights::<T>();
    let fields: Vec<A> = at.iter().map(|x| A::of(*x)).collect();
    let h = values(&mut deposit, &fields);
    let s = values(&mut smooth, &h);
    let half = T::from_f64(SPEED_SQUARED / 2.0);
    let all = weights.iter().zip(&h).zip(&s);
    let energy = all.fold(T::zero(), |sum, ((w, h), s)| sum + *w * *h * *s) * half;
    if let Some(forces) = forces {
        let seed: Vec<T> = weights
            .iter()
            .zip(&h)
            .map(|(w, h)| *w * *h * half)
            .collect();
        let mut along_h = vec![T::zero(); h.len()];
        smooth
            .pull_back(&h, &seed, &mut along_h)
            .expect("a gradient");
        for ((along, w), s) in along_h.iter_mut().zip(&weights).zip(&s) {
            *along += *w * *s * half;
        }
        deposit
            .pull_back(&fields, &along_h, forces)
            .expect("a gradient");
    }
    energy
}

/// Number of particles whose derivatives are compared, with every kind of position.
const COMPARED: usize = 12;

fn compare<const D: usize, A, B, F, S, G, R>(of: &Setting<D>)
where
    A: Field<f64, D> + Send + Sync,
    B: Field<Dual<1>, D> + Send + Sync,
    F: for<'a> Functional<f64, D, Argument = A, Data<'a> = (&'a [f64],)>,
    S: for<'a> Functional<f64, D, Argument = f64, Data<'a> = (f64,)>,
    G: for<'a> Functional<Dual<1>, D, Argument = B, Data<'a> = (&'a [Dual<1>],)>,
    R: for<'a> Functional<Dual<1>, D, Argument = Dual<1>, Data<'a> = (Dual<1>,)>,
{
    let at = places(of, 17);
    let mass: Vec<f64> = Numbers::new(18)
        .list(at.len())
        .iter()
        .map(|x| 0.1 + x)
        .collect();
    let mut forces = vec![A::of([0.0; D]); at.len()];
    let v = potential::<f64, D, F, S, A>(of, &mass, &at, Some(&mut forces));
    let scale = largest(forces.iter().flat_map(|f| f.parts()));
    let wide: Vec<_> = mass.iter().map(|m| Dual::constant(*m)).collect();
    let cell = of.domain.lengths[0] / of.grid.expect("a grid")[0] as f64;
    for a in 0..COMPARED {
        for d in 0..D {
            let force = forces[a].parts()[d];
            let mut moved: Vec<_> = at.iter().map(|x| x.map(Dual::constant)).collect();
            moved[a][d].dual = [1.0];
            let dual = potential::<Dual<1>, D, G, R, B>(of, &wide, &moved, None);
            let error = (dual.dual[0] - force).abs() / scale;
            assert!(error < 1e-12, "particle {a} along {d} of {of:?}: {error:e}");
            assert!((dual.real / v - 1.0).abs() < 1e-13);
            // Fourth-order differences of 1e-3 cells have an error of 1e-11 times the fifth derivative, plus the rounding of V
            // divided by the step. At the knots of cubic splines, where the third derivative jumps, the error is 1e-9 of the jump.
            let step = 1e-4 * cell;
            let shifted = |steps: f64| {
                let mut moved = at.clone();
                moved[a][d] += steps * step;
                potential::<f64, D, F, S, A>(of, &mass, &moved, None)
            };
            let one = shifted(1.0) - shifted(-1.0);
            let two = shifted(2.0) - shifted(-2.0);
            let slope = (8.0 * one - two) / (12.0 * step);
            let error = (slope - force).abs() / scale;
            assert!(error < 1e-8, "particle {a} along {d} of {of:?}: {error:e}");
        }
    }
}

#[test]
fn forces_are_the_gradient_of_the_potential_along_a_line() {
    type Twin = Dual<1>;
    for domain in lines() {
        let of = setting(domain, [14], 40);
        compare::<1, f64, Twin, deposit<f64, 1>, smooth<f64, 1>, deposit<Twin, 1>, smooth<Twin, 1>>(
            &of,
        );
        compare::<
            1,
            f64,
            Twin,
            deposit_quintic<f64, 1>,
            smooth<f64, 1>,
            deposit_quintic<Twin, 1>,
            smooth<Twin, 1>,
        >(&of);
    }
}

#[test]
fn forces_are_the_gradient_of_the_potential_in_the_plane() {
    type Twin = Dual<1>;
    type Place<T> = SVector<T, 2>;
    type Cubic<T> = deposit<T, 2>;
    type Quintic<T> = deposit_quintic<T, 2>;
    type Split<T> = smooth<T, 2>;
    type Whole<T> = smooth_isotropic<T, 2>;
    for domain in planes() {
        let of = setting(domain, [10, 13], 60);
        compare::<2, Place<f64>, Place<Twin>, Cubic<f64>, Split<f64>, Cubic<Twin>, Split<Twin>>(
            &of,
        );
        compare::<2, Place<f64>, Place<Twin>, Cubic<f64>, Whole<f64>, Cubic<Twin>, Whole<Twin>>(
            &of,
        );
        compare::<2, Place<f64>, Place<Twin>, Quintic<f64>, Split<f64>, Quintic<Twin>, Split<Twin>>(
            &of,
        );
        compare::<2, Place<f64>, Place<Twin>, Quintic<f64>, Whole<f64>, Quintic<Twin>, Whole<Twin>>(
            &of,
        );
    }
}

#[test]
fn on_a_wall_nothing_pulls_along_the_normal() {
    // The depth is even about a wall, so its slope vanishes there, on whichever side the particle is.
    let of = setting(Domain::basin([1.0, 1.0]), [8, 8], 2);
    let at = [[0.0, 0.37], [0.61, 1.0]];
    let mut forces = [SVector::<f64, 2>::zeros(); 2];
    type Cubic = deposit<f64, 2>;
    potential::<f64, 2, Cubic, smooth<f64, 2>, _>(&of, &[1.0; 2], &at, Some(&mut forces));
    // Spline slopes of order 1 cancel in pairs with the values of the other direction.
    assert!(
        forces[0][0].abs() < 1e-13 && forces[1][1].abs() < 1e-13,
        "{forces:?}"
    );
    assert!(forces[0][1].abs() > 1e-3);
}
