//! Elastic ellipsoids on GL(n), convective and spatial, n = 2 to 4. Their balance is linear in the velocity, so each step is
//! explicit. Compared with the material form, in which the force is the second difference of the placement:
//! `C0 (Q'' - 2 Q' + Q) I0 = -h² ∇V(Q')`, Störmer-Verlet.

use super::text_model::{Given, Motion, TextModel, card, cause, given};
use clebsch::StepCause;
use clebsch::nalgebra::SMatrix;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;

/// Stored energy of the stretch in the reference frame.
const CONVECTIVE: &str = "model Convective {
    dim n in 2..=4;
    param C0, I0: Sym<n>;
    param a, b, d: Real;
    group Q: GL<n> velocity G;
    advected C: Sym<n> = Q^T*C0*Q;
    constraint next(Q) = Q*G;
    constraint next(C) = G^T*C*G;
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*(a*tr(C) + b*tr(C*C) - (d/2)*log(det(C)));
}";

/// The same energy of the second moments in space.
const SPATIAL: &str = "model Spatial {
    dim n in 2..=4;
    param C0, I0: Sym<n>;
    param a, b, d: Real;
    group Q: GL<n> velocity g;
    advected S: Sym<n> = Q*I0*Q^T;
    constraint next(Q) = g*Q;
    constraint next(S) = g*S*g^T;
    lagrangian = tr(C0*(g - Id)*S*(g - Id)^T)/(2*h) - h*(a*tr(S) + b*tr(S*S) - (d/2)*log(det(S)));
}";

/// Quartic in the velocity: not linear, solved by Newton.
const QUARTIC: &str = "model Quartic {
    param C0, I0: Sym<2>;
    param e: Real;
    group Q: GL<2> velocity G;
    advected C: Sym<2> = Q^T*C0*Q;
    constraint next(Q) = Q*G;
    constraint next(C) = G^T*C*G;
    lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) + (e/h^3)*tr((G - Id)*(G - Id)^T)^2;
}";

type Matrix<const N: usize> = SMatrix<f64, N, N>;

/// The data of both models.
struct EllipsoidData<const N: usize> {
    c0: Matrix<N>,
    i0: Matrix<N>,
    a: f64,
    b: f64,
    d: f64,
    h: f64,
}

fn matrix<const N: usize>(a: &Square<f64, N>) -> Matrix<N> {
    Matrix::from_fn(|i, j| a.0[i][j])
}

fn inverse<const N: usize>(a: &Matrix<N>) -> Matrix<N> {
    a.try_inverse().expect("regular")
}

impl<const N: usize> EllipsoidData<N> {
    fn random(source: &mut Source, h: f64) -> Self {
        Self {
            c0: matrix(&source.positive()),
            i0: matrix(&source.positive()),
            a: source.between(0.1, 1.0),
            b: source.between(0.1, 1.0),
            d: source.between(1.0, 3.0),
            h,
        }
    }

    /// `W'` of `a tr X + b tr X² - d/2 log det X`.
    fn derivative(&self, x: &Matrix<N>) -> Matrix<N> {
        Matrix::identity() * self.a + x * (2.0 * self.b) - inverse(x) * (self.d / 2.0)
    }

    /// The gradient of the potential with respect to the placement.
    fn gradient(&self, q: &Matrix<N>, spatial: bool) -> Matrix<N> {
        match spatial {
            true => self.derivative(&(q * self.i0 * q.transpose())) * q * self.i0 * 2.0,
            false => self.c0 * q * self.derivative(&(q.transpose() * self.c0 * q)) * 2.0,
        }
    }

    /// The residual of the material equation, relative to the size of its terms.
    fn left(&self, q: &[Matrix<N>; 3], spatial: bool) -> f64 {
        let second = self.c0 * (q[2] - q[1] * 2.0 + q[0]) * self.i0;
        let force = self.gradient(&q[1], spatial) * self.h.powi(2);
        // Placements have rounding errors relative to their own size, not to that of their differences.
        let size = self.c0.norm() * 4.0 * q[1].norm() * self.i0.norm() + force.norm();
        (second + force).norm() / size
    }
}

/// Rounding errors of three placements, two inverses and the force.
const ROUNDING: f64 = 1e-14;

impl<const N: usize> EllipsoidData<N> {
    /// The parameters and a start; `momentum` is the name of the momentum.
    fn given(&self, q: Matrix<N>, momentum: &str, p: Matrix<N>) -> Given {
        let mut all = given! { C0: self.c0, I0: self.i0, a: self.a, b: self.b, d: self.d, Q: q };
        all.push((momentum.to_owned(), p.transpose().as_slice().to_vec()));
        all
    }
}

fn follow<const N: usize>(motion: &mut Motion, given: &EllipsoidData<N>, spatial: bool) {
    let mut past = [motion.matrix("Q"); 3];
    for step in 0..200 {
        motion.steps(1);
        past = [past[1], past[2], motion.matrix("Q")];
        if step > 0 {
            let left = given.left(&past, spatial);
            assert!(left < ROUNDING, "n = {N}, step {step}: {left:e}");
        }
    }
}

fn ellipsoids<const N: usize>(seed: u64) {
    let mut source = Source::seeded(seed);
    let [convective, spatial] = [CONVECTIVE, SPATIAL].map(|text| TextModel::read(text).of_size(N));
    for h in [1e-3, 1e-2] {
        for _ in 0..20 {
            let given = EllipsoidData::<N>::random(&mut source, h);
            // Near the reference, so that the placement stays invertible.
            let q = Matrix::<N>::identity() + matrix(&source.matrix()) * 0.1;
            let p = matrix(&source.matrix()) * 0.1;
            let start = given.given(q, "body_momentum", p);
            let mut motion = convective.start(h, &start).expect("determined");
            follow(&mut motion, &given, false);
            let start = given.given(q, "spatial_momentum", p);
            let mut motion = spatial.start(h, &start).expect("determined");
            follow(&mut motion, &given, true);
        }
    }
}

#[test]
fn two_dimensions() {
    ellipsoids::<2>(21);
}

#[test]
fn three_dimensions() {
    ellipsoids::<3>(22);
}

#[test]
fn four_dimensions() {
    ellipsoids::<4>(23);
}

fn convective(given: &EllipsoidData<3>, p: Matrix<3>) -> Result<Motion, clebsch::card::OpenError> {
    let start = given.given(Matrix::identity(), "body_momentum", p);
    TextModel::read(CONVECTIVE)
        .of_size(3)
        .start(given.h, &start)
}

#[test]
fn the_material_form_notices_a_wrong_force() {
    let mut source = Source::seeded(24);
    let mut given = EllipsoidData::<3>::random(&mut source, 1e-2);
    let mut motion = convective(&given, matrix(&source.matrix()) * 0.1).expect("determined");
    let past = [(); 3].map(|()| {
        motion.steps(1);
        motion.matrix("Q")
    });
    assert!(given.left(&past, false) < ROUNDING);
    given.d *= 1.0 + 1e-6;
    assert!(given.left(&past, false) > ROUNDING);
}

#[test]
fn a_form_that_is_singular_is_refused_by_its_factor() {
    let mut source = Source::seeded(25);
    let mut given = EllipsoidData::<3>::random(&mut source, 1e-2);
    given.i0 = Matrix::from_diagonal(&[1.0, 1.0, 0.0].into());
    let error = convective(&given, Matrix::zeros()).expect_err("flat");
    let StepCause::Singular(e) = cause(&error) else {
        panic!("{error}");
    };
    assert_eq!(e.factor, "I₀");
}

#[test]
fn linear_balances_are_explicit_and_others_are_not() {
    assert!(card(CONVECTIVE).solver.starts_with("Explicit"));
    assert!(card(SPATIAL).solver.starts_with("Explicit"));
    assert!(card(QUARTIC).solver.starts_with("Newton"));
}
