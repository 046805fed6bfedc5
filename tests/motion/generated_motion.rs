//! The generated steppers of the gallery as motions, so that they meet the measurements made for any stepper.
//! Takes starting data in plain arrays; gives motions.

// Each test binary includes this file and uses a part of it.
#![allow(dead_code)]

use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{BodyMomentum, Rotation};
use clebsch_models::free_body::{
    FreeBody, FreeBodyInitial, FreeBodyParameters, FreeBodyState, FreeBodyWorkspace,
};
use clebsch_models::heavy_top::{
    HeavyTop, HeavyTopInitial, HeavyTopParameters, HeavyTopState, HeavyTopWorkspace,
};
use clebsch_oracle::handwritten::attitude::{Matrix, Quaternion, Vector};
use clebsch_oracle::physics::cases::Start;
use clebsch_oracle::physics::motion::Motion;

/// A matrix given by rows.
pub fn matrix(rows: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| rows[r][c])
}

/// The rows of a matrix.
pub fn rows(matrix: &Matrix3<f64>) -> Matrix {
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| matrix[(r, c)]))
}

/// A column.
pub fn column(v: &Vector) -> Vector3<f64> {
    Vector3::new(v[0], v[1], v[2])
}

/// The entries of a column.
pub fn entries(v: &Vector3<f64>) -> Vector {
    [v[0], v[1], v[2]]
}

/// A rotation of a unit quaternion.
pub fn rotation(q: &Quaternion) -> Rotation<f64> {
    Rotation::from_quaternion(q.0).expect("a unit quaternion")
}

/// The generated free body on its way.
pub struct GeneratedBody {
    /// The model with its parameters.
    pub model: FreeBody<f64>,
    /// The present node.
    pub state: FreeBodyState<f64>,
    /// What the solver keeps between steps.
    pub workspace: FreeBodyWorkspace<f64>,
}

impl GeneratedBody {
    /// Starts a trajectory that is known to be solvable.
    pub fn start(start: &Start) -> GeneratedBody {
        GeneratedBody::try_start(start).expect("solvable")
    }

    /// Starts a trajectory; the message of the refusal otherwise.
    pub fn try_start(start: &Start) -> Result<GeneratedBody, String> {
        let model = FreeBody::new(FreeBodyParameters {
            J: matrix(&start.top.poinsot),
        })
        .expect("a body");
        let initial = FreeBodyInitial {
            Λ: rotation(&start.attitude),
            body_momentum: BodyMomentum(column(&start.body_momentum)),
        };
        let (state, workspace) = model
            .start(initial, start.h)
            .map_err(|refusal| refusal.to_string())?;
        Ok(GeneratedBody {
            model,
            state,
            workspace,
        })
    }
}

impl Motion for GeneratedBody {
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
}

/// The generated heavy top on its way.
pub struct GeneratedTop {
    /// The model with its parameters.
    pub model: HeavyTop<f64>,
    /// The present node.
    pub state: HeavyTopState<f64>,
    /// What the solver keeps between steps.
    pub workspace: HeavyTopWorkspace<f64>,
}

impl GeneratedTop {
    /// Starts a trajectory that is known to be solvable.
    pub fn start(start: &Start) -> GeneratedTop {
        GeneratedTop::try_start(start).expect("solvable")
    }

    /// Starts a trajectory; the message of the refusal otherwise.
    pub fn try_start(start: &Start) -> Result<GeneratedTop, String> {
        let model = HeavyTop::new(HeavyTopParameters {
            J: matrix(&start.top.poinsot),
            gU: column(&start.top.weight),
            z: column(&start.top.up),
        })
        .expect("a top");
        let initial = HeavyTopInitial {
            Λ: rotation(&start.attitude),
            body_momentum: BodyMomentum(column(&start.body_momentum)),
        };
        let (state, workspace) = model
            .start(initial, start.h)
            .map_err(|refusal| refusal.to_string())?;
        Ok(GeneratedTop {
            model,
            state,
            workspace,
        })
    }
}

impl Motion for GeneratedTop {
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
