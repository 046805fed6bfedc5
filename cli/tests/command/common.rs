//! A gallery for the tests of the commands: one hand-written model, a rotor on a fixed axis with a
//! restoring torque, whose steps, failures and invariants are known. No engine, no solver.
#![allow(dead_code, missing_docs)]

use clebsch::card::{Card, Conserved, Field, Invariant, Kind, OpenError, Settings, Trajectory};
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::{Poinsot, Rotation, StartError, StepCause, StepError, validate};
use clebsch_cli::gallery::{Case, Citations, Entry, Gallery};
use clebsch_cli::{Streams, execute};
use std::ffi::OsString;
use std::path::{Path, PathBuf};

const fn field(
    name: &'static str,
    ascii: &'static str,
    (rows, cols): (usize, usize),
    kind: Kind,
    doc: &'static str,
) -> Field {
    Field {
        name,
        ascii,
        rows,
        cols,
        kind,
        doc,
    }
}

pub static CARD: Card = Card {
    name: "HarmonicRotor",
    kebab: "harmonic-rotor",
    doc: "\n Rotor on a fixed axis with a restoring torque.\n\n More words.",
    source: "model HarmonicRotor {}",
    fingerprint: 0x0123_4567_89ab_cdef,
    summary: "p' = p - h κ sin θ\nθ' = θ + h p / I",
    solver: "explicit",
    order: 2,
    orders: &[2],
    preprocessed: false,
    reversible: true,
    parameters: &[
        field("J", "J", (3, 3), Kind::Symmetric, "Poinsot matrix"),
        field(
            "κ",
            "kappa",
            (1, 1),
            Kind::Scalar,
            "stiffness of the torque",
        ),
        field("z", "z", (3, 1), Kind::Vector, "vertical, space frame"),
    ],
    initial: &[
        field("Λ", "Lambda", (3, 3), Kind::Rotation, "attitude"),
        field(
            "body_momentum",
            "body_momentum",
            (3, 1),
            Kind::BodyMomentum,
            "",
        ),
    ],
    observables: &[
        field("Λ", "Lambda", (3, 3), Kind::Rotation, "attitude"),
        field(
            "body_momentum",
            "body_momentum",
            (3, 1),
            Kind::BodyMomentum,
            "",
        ),
        field(
            "Γ",
            "Gamma",
            (3, 1),
            Kind::Vector,
            "vertical seen from the body",
        ),
        field("angle", "angle", (1, 1), Kind::Scalar, ""),
    ],
    invariants: &[
        Invariant {
            name: "energy",
            formula: "½ p²/I + κ (1 - cos θ)",
            rows: 1,
            conserved: Conserved::Boundedly,
        },
        Invariant {
            name: "across",
            formula: "(μ₁, μ₂)",
            rows: 2,
            conserved: Conserved::Exactly,
        },
    ],
    discrete_energy: Invariant {
        name: "discrete_energy",
        formula: "p²/(2 I) + κ (1 - cos θ)",
        rows: 1,
        conserved: Conserved::Boundedly,
    },
    open: &open,
    solvers: &[],
    dimensions: &[],
    sized: &|_| None,
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
        files: Vec::new(),
    }
}

/// What a command did.
#[derive(Debug)]
pub struct Done {
    pub code: u8,
    pub out: String,
    pub err: String,
}

/// Runs `clebsch` on the gallery above.
pub fn clebsch(arguments: &[&str]) -> Done {
    on(&gallery(), arguments)
}

/// Runs `clebsch` on the models that it ships with.
pub fn shipped(arguments: &[&str]) -> Done {
    program(arguments)
}

/// Runs the program itself: a process opens so many model files and no more, and tests share one.
pub fn program(arguments: &[&str]) -> Done {
    program_in(".", arguments)
}

/// The same in another folder.
pub fn program_in(folder: &str, arguments: &[&str]) -> Done {
    let done = std::process::Command::new(env!("CARGO_BIN_EXE_clebsch"))
        .args(arguments)
        .current_dir(folder)
        .output()
        .expect("runs");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    Done {
        code: done
            .status
            .code()
            .and_then(|c| u8::try_from(c).ok())
            .expect("a code"),
        out: text(&done.stdout),
        err: text(&done.stderr),
    }
}

/// Runs `clebsch` on any gallery.
pub fn on(gallery: &Gallery, arguments: &[&str]) -> Done {
    with(gallery, arguments, "", None)
}

/// Runs `clebsch` with a standard input and a width of the terminal.
pub fn with(gallery: &Gallery, arguments: &[&str], input: &str, width: Option<usize>) -> Done {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let arguments = ["clebsch"].iter().chain(arguments).map(OsString::from);
    let code = execute(
        arguments,
        gallery,
        &mut Streams {
            input: &mut input.as_bytes(),
            out: &mut out,
            err: &mut err,
            progress: false,
            width,
        },
    );
    Done {
        code,
        out: String::from_utf8(out).expect("UTF-8"),
        err: String::from_utf8(err).expect("UTF-8"),
    }
}

/// A folder of its own for each test, empty at the start and removed at the end.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new(test: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(test);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("a folder for the test");
        Self(path)
    }

    pub fn path(&self, name: &str) -> String {
        self.0.join(name).to_str().expect("UTF-8").to_owned()
    }

    pub fn write(&self, name: &str, text: &str) -> String {
        let path = self.path(name);
        std::fs::write(&path, text).expect("a file for the test");
        path
    }

    /// Names of everything inside, hidden or not.
    pub fn names(&self) -> Vec<String> {
        let entries = std::fs::read_dir(&self.0).expect("the folder");
        let name = |entry: std::io::Result<std::fs::DirEntry>| entry.expect("an entry").file_name();
        let mut names: Vec<String> = entries
            .map(|entry| name(entry).into_string().expect("UTF-8"))
            .collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
