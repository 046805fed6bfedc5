//! The generated free body in the interface of the compared methods, and their common initial data.

use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::solvers::Method;
use clebsch::{BodyMomentum, Order, Rotation, StartError};
use clebsch_comparisons::body::{BodyMotion, Start};
use clebsch_comparisons::handwritten::Unsolvable;
use clebsch_comparisons::handwritten::attitude::Quaternion;
use clebsch_models::free_body::{
    FreeBody, FreeBodyInitial, FreeBodyParameters, FreeBodyState, FreeBodyWorkspace,
};
use std::hint::black_box;

/// A body at the identity with principal moments of inertia along its axes.
pub fn start_of(moments: [f64; 3], body_momentum: [f64; 3], h: f64) -> Start {
    let half = moments.iter().sum::<f64>() / 2.0;
    let entry = |r: usize, c: usize| if r == c { half - moments[r] } else { 0.0 };
    Start {
        poinsot: std::array::from_fn(|r| std::array::from_fn(|c| entry(r, c))),
        attitude: Quaternion::IDENTITY,
        body_momentum,
        h,
    }
}

/// Parameters and initial data of the generated model.
pub fn body_of(start: &Start) -> (FreeBodyParameters, FreeBodyInitial) {
    let parameters = FreeBodyParameters {
        J: Matrix3::from_fn(|r, c| start.poinsot[r][c]),
    };
    let initial = FreeBodyInitial {
        Λ: Rotation::from_quaternion(start.attitude.0).expect("a unit quaternion"),
        body_momentum: BodyMomentum(Vector3::from(start.body_momentum)),
    };
    (parameters, initial)
}

/// The generated stepper as a method for comparison.
#[derive(Clone)]
pub struct Generated {
    /// The body.
    pub model: FreeBody<f64>,
    /// The state at the current node.
    pub state: FreeBodyState<f64>,
    /// The workspace of its solver.
    pub workspace: FreeBodyWorkspace<f64>,
}

impl Generated {
    /// Starts a solvable motion.
    pub fn start(start: &Start, order: Order) -> Self {
        Self::solved_by(start, order, Method::Kappa).expect("solvable")
    }

    /// Starts a motion with the given solver.
    ///
    /// # Errors
    /// If the solver does not solve the first step of this body.
    pub fn solved_by(start: &Start, order: Order, method: Method) -> Result<Self, StartError> {
        let (parameters, initial) = body_of(start);
        let model = FreeBody::new(parameters)
            .expect("a body")
            .with_solver(method);
        let (state, workspace) = model.start_with(initial, start.h, order)?;
        Ok(Self {
            model,
            state,
            workspace,
        })
    }

    /// A block of `steps` steps in the loop that a user would write.
    pub fn block(self, steps: u32) -> impl FnOnce() {
        move || {
            let (model, mut state, mut workspace) =
                black_box((self.model, self.state, self.workspace));
            for _ in 0..steps {
                model.step(&mut state, &mut workspace).expect("solvable");
            }
            black_box((&state, &workspace));
        }
    }
}

impl BodyMotion for Generated {
    #[inline(always)]
    fn step(&mut self) -> Result<(), Unsolvable> {
        let done = self.model.step(&mut self.state, &mut self.workspace);
        done.map_err(|_| Unsolvable)
    }

    fn attitude(&self) -> Quaternion {
        Quaternion(self.state.Λ().quaternion())
    }

    fn body_momentum(&self) -> [f64; 3] {
        self.state.body_momentum().0.into()
    }
}
