//! Compares generated steppers with the 32-digit reference states of tests/reference/generate.py, to 1e-12 up to node 1000. The
//! tests of the hand-written steppers check that the same comparisons reject a faulty stepper.

use super::generated_motion::{
    GeneratedBody, GeneratedTop, column, entries, matrix, rotation, rows,
};
use clebsch::nalgebra::Vector3;
use clebsch::{BodyMomentum, Rotation};
use clebsch_oracle::handwritten::attitude::{Matrix, Vector};
use clebsch_oracle::physics::against_reference;
use clebsch_oracle::physics::cases::Start;
use clebsch_oracle::physics::motion::Motion;
use clebsch_oracle::reference::TOLERANCE;

clebsch::model! {
    /// The heavy top with the whole potential at the head of each edge: its node momentum is N_{k+1}.
    pub model OneSidedTop {
        param J: Sym<3>;
        param gU: Vec<3>;
        param z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T * z;
        constraint next(Λ) = Λ * Ω;
        constraint next(Γ) = Ω^T * Γ;
        node incoming;
        lagrangian = -tr(J * Ω) / h - h * dot(gU, Γ);
    }
}

struct GeneratedOneSided {
    model: OneSidedTop<f64>,
    state: OneSidedTopState<f64>,
    workspace: OneSidedTopWorkspace<f64>,
}

impl GeneratedOneSided {
    fn start(start: &Start) -> GeneratedOneSided {
        let model = OneSidedTop::new(OneSidedTopParameters {
            J: matrix(&start.top.poinsot),
            gU: column(&start.top.weight),
            z: column(&start.top.up),
        })
        .expect("a top");
        let attitude: Rotation<f64> = rotation(&start.attitude);
        let momentum: Vector3<f64> = column(&start.body_momentum);
        let initial = OneSidedTopInitial {
            Λ: attitude,
            body_momentum: BodyMomentum(momentum),
        };
        let (state, workspace) = model.start(initial, start.h).expect("solvable");
        GeneratedOneSided {
            model,
            state,
            workspace,
        }
    }
}

impl Motion for GeneratedOneSided {
    fn step(&mut self) -> Result<(), String> {
        self.model
            .step(&mut self.state, &mut self.workspace)
            .map_err(|refusal| refusal.to_string())
    }

    fn attitude(&self) -> Matrix {
        rows(&self.state.Λ().matrix())
    }

    fn body_momentum(&self) -> Vector {
        entries(&self.state.body_momentum().0)
    }

    fn spatial_momentum(&self) -> Vector {
        entries(&self.state.spatial_momentum().0)
    }

    fn energy(&self) -> f64 {
        self.model.energy(&self.state)
    }

    fn vertical(&self) -> Vector {
        entries(&self.model.Γ(&self.state))
    }
}

fn meets(name: &str, deviation: Result<f64, String>) {
    let deviation = deviation.expect(name);
    println!("{name}: {deviation:.2e}");
    assert!(deviation < TOLERANCE, "{name}: {deviation:e}");
}

#[test]
fn symmetric_free_body() {
    meets(
        "body_sym",
        against_reference::symmetric(GeneratedBody::start),
    );
}

#[test]
fn lagrange_top() {
    meets(
        "top_lagrange",
        against_reference::lagrange(GeneratedTop::start),
    );
    meets(
        "top_lagrange, energy",
        against_reference::lagrange_energy(GeneratedTop::start),
    );
}

#[test]
fn steady_rotation() {
    meets(
        "steady_rotation",
        against_reference::steady(GeneratedBody::start),
    );
}

#[test]
fn a_top_without_weight_is_a_free_body() {
    meets(
        "top_lagrange without weight",
        against_reference::symmetric(GeneratedTop::start),
    );
    meets(
        "steady rotation of a top",
        against_reference::steady(GeneratedTop::start),
    );
}

#[test]
fn one_sided_lagrange_top() {
    meets(
        "one-sided",
        against_reference::one_sided(GeneratedOneSided::start),
    );
    // The comparison distinguishes the two forms: each fails against the other's numbers.
    let crossed = against_reference::one_sided(GeneratedTop::start).expect("solvable");
    assert!(crossed > 1e6 * TOLERANCE, "{crossed:e}");
    let crossed = against_reference::lagrange(GeneratedOneSided::start).expect("solvable");
    assert!(crossed > 1e6 * TOLERANCE, "{crossed:e}");
}
