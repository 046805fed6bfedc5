//! A gallery for the tests of the commands: one hand-written model, a rotor on a fixed axis with a
//! restoring torque, whose steps, failures and invariants are known. No engine, no solver.
#![allow(missing_docs)]

use clebsch::card::{Card, Invariant, Kind, OpenError, Settings, Trajectory};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{Poinsot, Rotation, StartError, StepCause, StepError, validate};
use clebsch_cli::gallery::{Case, Citations, Entry, Gallery};

pub static CARD: Card = Card {
    name: "HarmonicRotor",
    kebab: "harmonic-rotor",
    doc: "\n Rotor on a fixed axis with a restoring torque.\n\n More words.",
    source: "model HarmonicRotor {}",
    fingerprint: 0x0123_4567_89ab_cdef,
    summary: "p' = p - h κ sin θ\nθ' = θ + h p / I",
    solver: "explicit",
    orders: &[2],
    parameters: &[
        Kind::Symmetric.field("J", [3, 3], "Poinsot matrix"),
        Kind::Scalar.spelt("κ", "kappa", [1, 1], "stiffness of the torque"),
        Kind::Vector.field("z", [3, 1], "vertical, space frame"),
    ],
    initial: &[
        Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude"),
        Kind::BodyMomentum.field("body_momentum", [3, 1], ""),
    ],
    observables: &[
        Kind::Rotation.spelt("Λ", "Lambda", [3, 3], "attitude"),
        Kind::BodyMomentum.field("body_momentum", [3, 1], ""),
        Kind::Vector.spelt("Γ", "Gamma", [3, 1], "vertical seen from the body"),
        Kind::Scalar.field("angle", [1, 1], ""),
    ],
    invariants: &[
        Invariant::bounded("energy", "½ p²/I + κ (1 - cos θ)", 1),
        Invariant::exact("across", "(μ₁, μ₂)", 2),
    ],
    discrete_energy: Invariant::bounded("discrete_energy", "p²/(2 I) + κ (1 - cos θ)", 1),
    ..Card::plain(&open, &|_| None)
};

struct Rotor {
    start: Rotation,
    vertical: Vector3<f64>,
    across: [f64; 2],
    inertia: f64,
    stiffness: f64,
    h: f64,
    node: u64,
    angle: f64,
    momentum: f64,
}

fn open(
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    settings: Settings,
) -> Result<Box<dyn Trajectory>, OpenError> {
    let h = settings.h;
    let [j, kappa, z] = parameters else {
        panic!("three parameters");
    };
    let [lambda, momentum] = initial else {
        panic!("two initial values");
    };
    validate::finite("J", j)?;
    let j = Matrix3::from_row_slice(j);
    validate::symmetric("J", &j)?;
    Poinsot::new(j).map_err(|error| error.in_field("J"))?;
    validate::positive_step(h)?;
    let start = Rotation::from_matrix(&Matrix3::from_row_slice(lambda))
        .map_err(|error| StartError::Initial(error.in_field("Λ")))?;
    let rotor = Rotor {
        start,
        vertical: Vector3::from_column_slice(z),
        across: [momentum[0], momentum[1]],
        inertia: j[(0, 0)] + j[(1, 1)],
        stiffness: kappa[0],
        h,
        node: 0,
        angle: 0.0,
        momentum: momentum[2],
    };
    if (h * rotor.momentum / rotor.inertia).abs() > 1.0 {
        return Err(OpenError::Start(StartError::Refused(
            StepCause::NotFinite { what: "Ω" },
        )));
    }
    Ok(Box::new(rotor))
}

impl Rotor {
    fn attitude(&self) -> Rotation {
        self.start * Rotation::exp(&Vector3::new(0.0, 0.0, self.angle))
    }
}

impl Trajectory for Rotor {
    fn node(&self) -> u64 {
        self.node
    }

    fn time(&self) -> f64 {
        self.h * self.node as f64
    }

    fn step(&mut self) -> Result<(), StepError> {
        let half = self.momentum - 0.5 * self.h * self.stiffness * self.angle.sin();
        if (self.h * half / self.inertia).abs() > 1.0 {
            return Err(StepCause::NotFinite { what: "Ω" }.at_node(self.node));
        }
        self.angle += self.h * half / self.inertia;
        self.momentum = half - 0.5 * self.h * self.stiffness * self.angle.sin();
        self.node += 1;
        Ok(())
    }

    fn card(&self) -> &'static Card {
        &CARD
    }

    fn observe(&self, out: &mut [f64]) {
        let attitude = self.attitude();
        let matrix = attitude.matrix().transpose();
        let gamma = attitude.inverse_rotate(&self.vertical);
        let values = matrix
            .iter()
            .chain(&self.across)
            .chain([&self.momentum])
            .chain(gamma.iter())
            .chain([&self.angle]);
        for (slot, value) in out.iter_mut().zip(values) {
            *slot = *value;
        }
    }

    fn invariants(&self, out: &mut [f64]) {
        let kinetic = 0.5 * self.momentum * self.momentum / self.inertia;
        out[0] = kinetic + self.stiffness * (1.0 - self.angle.cos());
        out[1..].copy_from_slice(&self.across);
    }

    fn scales(&self, out: &mut [f64]) {
        let kinetic = 0.5 * self.momentum * self.momentum / self.inertia;
        out[0] = kinetic + (self.stiffness * (1.0 - self.angle.cos())).abs();
        out[1..].fill(1.0);
    }
}

pub fn case() -> Case {
    Case {
        name: "swing".to_owned(),
        doc: "Swings \"widely\".\nSecond line.".to_owned(),
        h: 0.05,
        steps: 2000,
        parameters: vec![
            vec![1.0, 0.1, 0.0, 0.1, 1.0, 0.0, 0.0, 0.0, 0.5],
            vec![1.0],
            vec![0.6, 0.0, 0.8],
        ],
        initial: vec![
            vec![1.0, 0.0, 0.0, 0.0, 0.6, -0.8, 0.0, 0.8, 0.6],
            vec![0.1, 1.0 / 3.0, 1.5],
        ],
        bounds: vec![("energy".to_owned(), 1e-3)],
    }
}

pub fn gallery() -> Gallery {
    let quiet = Case {
        name: "quiet".to_owned(),
        doc: String::new(),
        bounds: Vec::new(),
        ..case()
    };
    Gallery {
        entries: vec![Entry {
            card: CARD,
            citations: Citations::NONE,
            cases: vec![case(), quiet],
        }],
        ..Gallery::default()
    }
}
