//! Blocks of work for the elastic bodies in `models/elastic/`, compiled, and for hand-written steppers: the same steps from the
//! initial state of the model's case. `interpret/tests/interpret_long/elastic/against_hand.rs` compares the hand-written steppers with
//! the model files; here each statement is compared with the hand-written stepper.

use crate::loops::{generated, written};
use crate::operation_counts::Block;
use clebsch::nalgebra::Matrix3;
use clebsch::{Additive, BodyMomentumMatrix, FieldMomentum, Linear};
use clebsch_oracle::handwritten;
use clebsch_oracle::handwritten::Unsolvable;
use clebsch_oracle::handwritten::attitude::Matrix;
use clebsch_oracle::handwritten::ellipsoid::{ElasticEllipsoid, Ellipsoid, Of};

clebsch::model! {
    /// Neo-Hookean body on GL(3), convective representation.
    model NeoHooke {
        /// second moments of mass, reference configuration
        param I0: Sym<3>;
        /// shear modulus and first Lamé constant
        param mu, lambda: Real;
        /// placement, reference to space
        group Q: GL<3> velocity G;
        /// right Cauchy-Green tensor
        advected C: Sym<3> = Q^T*Q;
        constraint next(Q) = Q*G;
        constraint next(C) = G^T*C*G;
        let W = (mu/2)*(tr(C) - log(det(C))) + (lambda/8)*log(det(C))^2;
        lagrangian = tr(C*(G - Id)*I0*(G - Id)^T)/(2*h) - h*W;
    }
}

clebsch::model! {
    /// Elastic ellipsoid in terms of its placement, with a Mooney-Rivlin material in the form of Ciarlet and Geymonat.
    /// `ellipsoid-convective` and `ellipsoid-spatial` state the same motion on GL(n).
    model MooneyRivlin {
        /// metric of space; second moments of mass, reference configuration
        param C0, I0: Sym<3>;
        /// stiffness against changes of length, area and volume
        param a, b, c: Real;
        /// resistance to collapse; the identity is stress-free if d = 2 a + 4 b + 2 c
        param d: Real;
        /// placement, reference to space
        field Q: Mat<3>;
        let V = next(Q) - Q;
        let C = Q^T*C0*Q;
        let W = a*I1(C) + b*I2(C) + c*det(C) - (d/2)*log(det(C));
        lagrangian = tr(C0*V*I0*V^T)/(2*h) - h*W;
    }
}

const IDENTITY: Matrix = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// The step size of all of them.
const H: f64 = 0.02;

fn matrix(rows: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| rows[r][c])
}

/// Placement and momentum, and the function that steps them.
#[derive(Clone, Copy)]
struct Stepped<F> {
    at: [Matrix; 2],
    by: F,
}

impl<F: Fn(&[Matrix; 2]) -> Result<[Matrix; 2], Unsolvable>> Stepped<F> {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.at = (self.by)(&self.at)?;
        Ok(())
    }
}

/// A generated block, after a check that its first step gives the placement of the hand-written step.
macro_rules! agreeing {
    ($model:expr, $initial:expr, $hand:expr, $place:expr) => {{
        let (model, mut hand) = ($model.expect("parameters"), $hand);
        let start = model.start($initial, H);
        let (mut state, mut work) = start.expect("solvable");
        model.step(&mut state, &mut work).expect("solvable");
        hand.step().expect("solvable");
        let apart = ($place(&state) - matrix(&hand.at[0])).amax();
        assert!(apart < 1e-12, "generated and by hand differ by {apart:e}");
        generated!(Some(model), $initial, H)
    }};
}

const STRETCHED: [Matrix; 2] = [
    [[1.2, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
    [[0.0, -0.6, 0.0], [0.5, 0.0, 0.1], [0.0, -0.1, 0.0]],
];

fn hooke_by_hand() -> Stepped<impl Fn(&[Matrix; 2]) -> Result<[Matrix; 2], Unsolvable> + Copy> {
    let body = handwritten::neo_hooke::NeoHooke {
        moments: IDENTITY,
        shear: 10.0,
        lame: 15.0,
    };
    Stepped {
        at: STRETCHED,
        by: move |[q, p]: &[Matrix; 2]| body.step(q, p, H),
    }
}

/// A block of the generated neo-Hookean body.
pub fn generated_hooke() -> Block<impl FnOnce()> {
    let model = NeoHooke::new(NeoHookeParameters {
        I0: Matrix3::identity(),
        mu: 10.0,
        lambda: 15.0,
    });
    let [place, momentum] = STRETCHED.each_ref().map(matrix);
    let initial = || NeoHookeInitial {
        Q: Linear::from_matrix(&place).expect("invertible"),
        body_momentum: BodyMomentumMatrix(momentum),
    };
    agreeing!(
        model,
        initial(),
        hooke_by_hand(),
        |state: &NeoHookeState<f64>| state.Q().matrix()
    )
}

/// A block of the hand-written neo-Hookean body.
pub fn written_hooke() -> impl FnOnce() {
    written!(hooke_by_hand())
}

const NATURAL: [Matrix; 2] = [
    IDENTITY,
    [[0.6, -0.15, -0.3], [0.15, 0.15, 0.15], [-0.3, 0.45, 0.0]],
];

const MOONEY_RIVLIN: [f64; 4] = [0.1, 10.0, 10.0, 60.2];

/// The hand-written stepper, which stores the velocity of the placement.
struct Mooney {
    at: [Matrix; 1],
    body: ElasticEllipsoid<3>,
}

impl Mooney {
    fn step(&mut self) -> Result<(), Unsolvable> {
        self.body.step()?;
        self.at = [self.body.placement()];
        Ok(())
    }
}

fn mooney_by_hand() -> ElasticEllipsoid<3> {
    let body = Ellipsoid {
        metric: IDENTITY,
        moments: IDENTITY,
        energy: MOONEY_RIVLIN,
        of: Of::Metric,
    };
    let [place, momentum] = &NATURAL;
    // At the identity placement, the body momentum equals the material momentum.
    ElasticEllipsoid::start(&body, place, momentum, H).expect("solvable")
}

/// A block of the generated Mooney-Rivlin body, stated by its placement.
pub fn generated_mooney() -> Block<impl FnOnce()> {
    let [a, b, c, d] = MOONEY_RIVLIN;
    let model = MooneyRivlin::new(MooneyRivlinParameters {
        C0: Matrix3::identity(),
        I0: Matrix3::identity(),
        a,
        b,
        c,
        d,
    });
    let [place, momentum] = NATURAL.each_ref().map(matrix);
    let initial = || MooneyRivlinInitial {
        Q: Additive::new(place),
        momentum: FieldMomentum(momentum),
    };
    let hand = Mooney {
        at: [IDENTITY],
        body: mooney_by_hand(),
    };
    agreeing!(model, initial(), hand, |state: &MooneyRivlinState<f64>| {
        state.Q().matrix()
    })
}

/// A block of the hand-written Mooney-Rivlin body.
pub fn written_mooney() -> impl FnOnce() {
    written!(mooney_by_hand())
}

clebsch::model! {
    /// Self-gravitating homogeneous fluid ellipsoid of Dirichlet and Riemann, with a linear flow map.
    /// The constraint det(Q) = 1 on the placement makes it incompressible.
    model FluidEllipsoid {
        /// second moments of mass, reference configuration; M/5 Id for the unit ball
        param I0: Sym<3>;
        /// mass, in units where the gravitational constant is 1
        param M: Real;
        /// Carlson's integral R_F of the eigenvalues of a matrix, from its trace, second invariant and determinant
        given RF(Real, Real, Real): Real = clebsch::functions::carlson_rf_of_invariants;
        /// placement, reference to space
        field Q: Mat<3>;
        hold λ: det(Q) = 1;
        let V = next(Q) - Q;
        let B = Q*Q^T;
        lagrangian = tr(V*I0*V^T)/(2*h) + h*(3/5)*M^2*RF(I1(B), I2(B), det(B));
    }
}

/// An ellipsoid with axes 1.25, 1 and 0.8, and a momentum that rotates and shears it.
const FLUID: [Matrix; 2] = [
    [[1.25, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.8]],
    [[0.05, -0.12, 0.0], [0.16, 0.02, 0.03], [0.0, 0.02, -0.048]],
];

fn fluid_by_hand() -> Stepped<impl Fn(&[Matrix; 2]) -> Result<[Matrix; 2], Unsolvable> + Copy> {
    let body = handwritten::fluid_ellipsoid::FluidEllipsoid {
        moments: IDENTITY.map(|row| row.map(|x| 0.2 * x)),
        mass: 1.0,
    };
    Stepped {
        at: FLUID,
        by: move |[q, p]: &[Matrix; 2]| body.step(q, p, H).map(|(q, p, _)| [q, p]),
    }
}

/// A block of the generated fluid ellipsoid.
pub fn generated_fluid() -> Block<impl FnOnce()> {
    let model = FluidEllipsoid::new(FluidEllipsoidParameters {
        I0: Matrix3::identity() * 0.2,
        M: 1.0,
    });
    let [place, momentum] = FLUID.each_ref().map(matrix);
    let initial = || FluidEllipsoidInitial {
        Q: Additive::new(place),
        momentum: FieldMomentum(momentum),
    };
    agreeing!(
        model,
        initial(),
        fluid_by_hand(),
        |state: &FluidEllipsoidState<f64>| state.Q().matrix()
    )
}

/// A block of the hand-written fluid ellipsoid.
pub fn written_fluid() -> impl FnOnce() {
    written!(fluid_by_hand())
}
