//! Elastic ellipsoids on GL(n), convective and spatial, n = 2 to 4. Their balance is linear in the velocity, so each step is
//! explicit. Compared with the material form, in which the force is the second difference of the placement:
//! `C0 (Q'' - 2 Q' + Q) I0 = -h² ∇V(Q')`, Störmer-Verlet.

use clebsch::integrate::Stepper;
use clebsch::nalgebra::SMatrix;
use clebsch::{BodyMomentumMatrix, Linear, SpatialMomentumMatrix, StartError, StepCause};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;

clebsch::model! {
    /// Stored energy of the stretch in the reference frame.
    model Convective {
        dim n in 2..=4;
        param C0, I0: Sym<n>;
        param a, b, d: Real;
        group Q: GL<n> velocity G;
        advected C: Sym<n> = Q^T*C0*Q;
        constraint next(Q) = Q*G;
        constraint next(C) = G^T*C*G;
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*(a*tr(C) + b*tr(C*C) - (d/2)*log(det(C)));
    }
}

clebsch::model! {
    /// The same energy of the second moments in space.
    model Spatial {
        dim n in 2..=4;
        param C0, I0: Sym<n>;
        param a, b, d: Real;
        group Q: GL<n> velocity g;
        advected S: Sym<n> = Q*I0*Q^T;
        constraint next(Q) = g*Q;
        constraint next(S) = g*S*g^T;
        lagrangian = tr(C0*(g - Id)*S*(g - Id)^T)/(2*h) - h*(a*tr(S) + b*tr(S*S) - (d/2)*log(det(S)));
    }
}

clebsch::model! {
    /// Quartic in the velocity: not linear, solved by Newton.
    model Quartic {
        param C0, I0: Sym<2>;
        param e: Real;
        group Q: GL<2> velocity G;
        advected C: Sym<2> = Q^T*C0*Q;
        constraint next(Q) = Q*G;
        constraint next(C) = G^T*C*G;
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) + (e/h^3)*tr((G - Id)*(G - Id)^T)^2;
    }
}

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

fn follow<const N: usize, M: Stepper<Scalar = f64>>(
    model: &M,
    start: M::State,
    given: &EllipsoidData<N>,
    placement: impl Fn(&M::State) -> Matrix<N>,
    spatial: bool,
) where
    M::State: Copy,
{
    let mut work = model.workspace(&start, given.h).expect("determined");
    let mut past = [placement(&start); 3];
    let mut state = start;
    for step in 0..200 {
        model.advance(&mut state, &mut work).expect("determined");
        past = [past[1], past[2], placement(&state)];
        if step > 0 {
            let left = given.left(&past, spatial);
            assert!(left < ROUNDING, "n = {N}, step {step}: {left:e}");
        }
    }
}

fn ellipsoids<const N: usize>(seed: u64) {
    let mut source = Source::seeded(seed);
    for h in [1e-3, 1e-2] {
        for _ in 0..20 {
            let given = EllipsoidData::<N>::random(&mut source, h);
            // Near the reference, so that the placement stays invertible.
            let q = Matrix::<N>::identity() + matrix(&source.matrix()) * 0.1;
            let p = matrix(&source.matrix()) * 0.1;
            let placed = Linear::from_matrix(&q).expect("regular");
            let model = Convective::<N>::new(ConvectiveParameters {
                C0: given.c0,
                I0: given.i0,
                a: given.a,
                b: given.b,
                d: given.d,
            });
            let model = model.expect("admitted");
            let initial = ConvectiveInitial {
                Q: placed,
                body_momentum: BodyMomentumMatrix(p),
            };
            let (start, _) = model.start(initial, h).expect("determined");
            follow(&model, start, &given, |s| s.Q().matrix(), false);
            let model = Spatial::<N>::new(SpatialParameters {
                C0: given.c0,
                I0: given.i0,
                a: given.a,
                b: given.b,
                d: given.d,
            });
            let model = model.expect("admitted");
            let initial = SpatialInitial {
                Q: placed,
                spatial_momentum: SpatialMomentumMatrix(p),
            };
            let (start, _) = model.start(initial, h).expect("determined");
            follow(&model, start, &given, |s| s.Q().matrix(), true);
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

#[test]
fn the_material_form_notices_a_wrong_force() {
    let mut source = Source::seeded(24);
    let mut given = EllipsoidData::<3>::random(&mut source, 1e-2);
    let model = Convective::<3>::new(ConvectiveParameters {
        C0: given.c0,
        I0: given.i0,
        a: given.a,
        b: given.b,
        d: given.d,
    });
    let model = model.expect("admitted");
    let initial = ConvectiveInitial {
        Q: Linear::identity(),
        body_momentum: BodyMomentumMatrix(matrix(&source.matrix()) * 0.1),
    };
    let (mut state, mut work) = model.start(initial, given.h).expect("determined");
    let mut past = [state.Q().matrix(); 3];
    for _ in 0..3 {
        model.step(&mut state, &mut work).expect("determined");
        past = [past[1], past[2], state.Q().matrix()];
    }
    assert!(given.left(&past, false) < ROUNDING);
    given.d *= 1.0 + 1e-6;
    assert!(given.left(&past, false) > ROUNDING);
}

#[test]
fn a_form_that_is_singular_is_refused_by_its_factor() {
    let mut source = Source::seeded(25);
    let given = EllipsoidData::<3>::random(&mut source, 1e-2);
    let flat = Matrix::<3>::from_diagonal(&[1.0, 1.0, 0.0].into());
    let model = Convective::<3>::new(ConvectiveParameters {
        C0: given.c0,
        I0: flat,
        a: given.a,
        b: given.b,
        d: given.d,
    });
    let initial = ConvectiveInitial {
        Q: Linear::identity(),
        body_momentum: BodyMomentumMatrix(Matrix::zeros()),
    };
    let error = model
        .expect("finite")
        .start(initial, given.h)
        .expect_err("flat");
    let StartError::Refused(StepCause::Singular(e)) = error else {
        panic!("{error}");
    };
    assert_eq!(e.factor, "I₀");
}

#[test]
fn linear_balances_are_explicit_and_others_are_not() {
    assert!(Convective::<3>::CARD.solver.starts_with("Explicit"));
    assert!(Spatial::<3>::CARD.solver.starts_with("Explicit"));
    assert!(Quartic::<f64>::CARD.solver.starts_with("Newton"));
}
