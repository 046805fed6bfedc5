//! Wraps the generated steppers of the gallery as `Motion`, so that the tests apply the same measurements to every stepper.
//! Starting data are plain arrays.

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

/// A matrix from its rows.
pub fn matrix(rows: &Matrix) -> Matrix3<f64> {
    Matrix3::from_fn(|r, c| rows[r][c])
}

/// The rows of a matrix.
pub fn rows(matrix: &Matrix3<f64>) -> Matrix {
    [0, 1, 2].map(|r| [0, 1, 2].map(|c| matrix[(r, c)]))
}

/// A column vector.
pub fn column(v: &Vector) -> Vector3<f64> {
    Vector3::new(v[0], v[1], v[2])
}

/// The entries of a column vector.
pub fn entries(v: &Vector3<f64>) -> Vector {
    [v[0], v[1], v[2]]
}

/// The rotation of a unit quaternion.
pub fn rotation(q: &Quaternion) -> Rotation<f64> {
    Rotation::from_quaternion(q.0).expect("a unit quaternion")
}

/// The generated free body at its current node.
pub struct GeneratedBody {
    /// The model and its parameters.
    pub model: FreeBody<f64>,
    /// The state at the current node.
    pub state: FreeBodyState<f64>,
    /// The workspace that the solver keeps between steps.
    pub workspace: FreeBodyWorkspace<f64>,
}

impl GeneratedBody {
    /// Starts a trajectory that is solvable.
    pub fn start(start: &Start) -> GeneratedBody {
        GeneratedBody::try_start(start).expect("solvable")
    }

    /// Starts a trajectory, or returns the error message.
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

/// The generated heavy top at its current node.
pub struct GeneratedTop {
    /// The model and its parameters.
    pub model: HeavyTop<f64>,
    /// The state at the current node.
    pub state: HeavyTopState<f64>,
    /// The workspace that the solver keeps between steps.
    pub workspace: HeavyTopWorkspace<f64>,
}

impl GeneratedTop {
    /// Starts a trajectory that is solvable.
    pub fn start(start: &Start) -> GeneratedTop {
        GeneratedTop::try_start(start).expect("solvable")
    }

    /// Starts a trajectory, or returns the error message.
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
