//! Fluids that run from their text. Every number equals, bit for bit, the number from the stepper that is compiled from
//! the same statement.

use clebsch::mesh::placement::{self, Jitter};
use clebsch::mesh::{Domain, Nodes, Setting, Wall};
use clebsch::nalgebra::{SMatrix, Vector2};
use clebsch::saved::{Saved, Words};
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::pipeline;
use clebsch_interpret::lines::{LineModel, LineTrajectory};
use clebsch_models::fluids::STATEMENTS;
use clebsch_models::fluids::particle_mesh_1d::*;
use clebsch_models::fluids::particle_mesh_2d::*;
use clebsch_models::fluids::shallow_water_2d::*;
use clebsch_models::fluids::shallow_water_2d_regularised::*;
use std::collections::BTreeMap;
use std::sync::Arc;

type Data = BTreeMap<&'static str, Vec<f64>>;

const STEPS: u64 = 50;
const H: f64 = 0.01;

fn source(file: usize) -> &'static str {
    STATEMENTS[file].0
}

/// The number of particles, and of nodes if there is a grid.
fn choice(source: &str, particles: usize, nodes: usize) -> ChainConfig {
    let model = pipeline::parse_source(source).expect("is a model");
    let lattice = Lattice::read(&model).expect("has labels");
    let mut choice = ChainConfig::representative(&lattice, 1);
    for label in &lattice.labels {
        let count = if label.grid { nodes } else { particles };
        choice = choice
            .with_count(&lattice, &label.index.text, count)
            .expect("has sites");
    }
    choice
}

fn read(file: usize) -> Arc<LineModel> {
    LineModel::read(source(file)).expect("is read")
}

fn bits(list: &[f64]) -> Vec<u64> {
    list.iter().map(|x| x.to_bits()).collect()
}

fn flat<const R: usize>(list: &[SMatrix<f64, R, 1>]) -> Vec<f64> {
    list.iter().flat_map(|x| x.iter().copied()).collect()
}

fn vectors(list: &[f64]) -> Vec<Vector2<f64>> {
    list.chunks(2).map(Vector2::from_column_slice).collect()
}

/// Positions of a jittered lattice, masses close to depth 1, and momenta of velocities of size `speed`.
fn particles(side: usize, speed: f64) -> Data {
    let domain = Domain::torus([1.0, 1.0]);
    let jitter = Jitter { size: 0.2, seed: 5 };
    let places = placement::lattice(&domain, [side, side], true, jitter);
    let n = places.len();
    let m = |i: usize| (1.0 + 0.2 * (i as f64).sin()) / n as f64;
    let push = |i: usize| [(3 * i) as f64, (5 * i) as f64].map(|x| speed * m(i) * x.cos());
    Data::from([
        ("X", flat(&places)),
        ("m", (0..n).map(m).collect()),
        ("momentum_X", (0..n).flat_map(push).collect()),
        ("g", vec![1.0]),
        ("c0", vec![1.0]),
        ("f", vec![2.0]),
        ("L", vec![1.0, 1.0]),
        ("alpha", vec![0.1]),
        ("rc", vec![0.05]),
        ("kappa", vec![0.3]),
    ])
}

/// Steps both, and compares all observables.
macro_rules! compared {
    ($source:expr, $choice:expr, $data:expr, $model:expr, $initial:expr, [$($name:literal = $values:ident),*], [$($total:ident),*]) => {{
        let (data, model) = ($data, $model);
        let read = LineModel::read($source).expect("is read");
        let numbers = |name: &str| data.get(name).cloned();
        let mut line: LineTrajectory = read.start(&$choice, H, &numbers).expect("starts");
        let (mut state, mut work) = model.start($initial, H).expect("starts");
        for step in 0..=STEPS {
            if step > 0 {
                model.step(&mut state, &mut work).expect("steps");
                line.step().expect("steps");
            }
            assert_eq!(line.node(), state.node());
            let seen = |line: &mut LineTrajectory, name| bits(&line.observe(name).expect("is seen"));
            assert_eq!(seen(&mut line, "X"), bits(&flat(state.X())), "places at {step}");
            assert_eq!(seen(&mut line, "momentum_X"), bits(&flat(state.momentum_X())), "momenta at {step}");
            $(assert_eq!(seen(&mut line, $name), bits(&model.$values(&state).expect("has values")), "{} at {step}", $name);)*
            let (kinetic, potential) = model.energies(&state);
            assert!(kinetic.is_finite() && potential > 0.0);
            assert_eq!(bits(&line.energies().expect("has energies")), bits(&[kinetic, potential]), "energies at {step}");
            $(assert_eq!(
                bits(&line.total(stringify!($total)).expect("is conserved")),
                bits(model.$total(&state).as_slice()),
                "{} at {step}", stringify!($total)
            );)*
        }
        let seen: Vec<String> = read.observers().collect();
        assert_eq!(seen.len(), 2 + [$($name),*].len(), "{seen:?}");
        work.reflections_or_none()
    }};
}

/// The number of wall reflections, for models with walls.
trait Reflected {
    fn reflections_or_none(&self) -> u64;
}
impl Reflected for ParticleMesh1DWorkspace {
    fn reflections_or_none(&self) -> u64 {
        self.reflections()
    }
}
impl Reflected for ParticleMesh2DWorkspace {
    fn reflections_or_none(&self) -> u64 {
        self.reflections()
    }
}
impl Reflected for ShallowWater2DWorkspace {
    fn reflections_or_none(&self) -> u64 {
        0
    }
}
impl Reflected for SmoothedWorkspace {
    fn reflections_or_none(&self) -> u64 {
        0
    }
}
impl Reflected for ShallowWater2DRegularisedWorkspace {
    fn reflections_or_none(&self) -> u64 {
        0
    }
}

#[test]
fn cells_equal_the_compiled_ones_to_the_last_bit() {
    let data = particles(12, 0.1);
    let n = data["m"].len();
    let parameters = ShallowWater2DParameters {
        m: data["m"].clone(),
        g: 1.0,
        f: 2.0,
    };
    let sites = ShallowWater2DSites {
        N: n,
        L: [1.0, 1.0],
        scalar: Default::default(),
    };
    let initial = ShallowWater2DInitial {
        X: vectors(&data["X"]),
        momentum_X: vectors(&data["momentum_X"]),
    };
    let model = ShallowWater2D::new(parameters, sites).expect("is made");
    compared!(
        source(2),
        choice(source(2), n, 1),
        data,
        model,
        initial,
        ["A" = values_A],
        [momentum]
    );
}

#[test]
fn smoothed_cells_equal_the_compiled_ones_to_the_last_bit() {
    let data = particles(12, 0.1);
    let n = data["m"].len();
    let parameters = ShallowWater2DRegularisedParameters {
        m: data["m"].clone(),
        g: 1.0,
        f: 2.0,
        alpha: 0.1,
        rc: 0.05,
        kappa: 0.3,
    };
    let sites = ShallowWater2DRegularisedSites {
        N: n,
        L: [1.0, 1.0],
        scalar: Default::default(),
    };
    let initial = ShallowWater2DRegularisedInitial {
        X: vectors(&data["X"]),
        momentum_X: vectors(&data["momentum_X"]),
    };
    let model = ShallowWater2DRegularised::new(parameters, sites).expect("is made");
    compared!(
        source(3),
        choice(source(3), n, 1),
        data,
        model,
        initial,
        ["phi" = values_phi, "core" = values_core],
        [momentum]
    );
}

clebsch::model! {
    /// Half of the depth smoothed twice, half by a kernel.
    model Smoothed {
        time k step dt;
        label a in 0..N;
        param m: Real at a;
        param g, alpha: Real;
        field X: Vec<2> at a on torus(L);
        mesh phi: Real at a = helmholtz_twice(X, m, alpha);
        mesh chi: Real at a = kernel_depth(X, m, alpha);
        lagrangian = (m/(2*dt))*dot(next(X) - X, next(X) - X) - dt*g*m*(phi + chi)/4;
    }
}

#[test]
fn depths_of_other_smoothers_equal_the_compiled_ones_to_the_last_bit() {
    let data = particles(12, 0.1);
    let n = data["m"].len();
    let parameters = SmoothedParameters {
        m: data["m"].clone(),
        g: 1.0,
        alpha: 0.1,
    };
    let sites = SmoothedSites {
        N: n,
        L: [1.0, 1.0],
        scalar: Default::default(),
    };
    let initial = SmoothedInitial {
        X: vectors(&data["X"]),
        momentum_X: vectors(&data["momentum_X"]),
    };
    let source = Smoothed::<f64>::SOURCE;
    let model = Smoothed::new(parameters, sites).expect("is made");
    compared!(
        source,
        choice(source, n, 1),
        data,
        model,
        initial,
        ["phi" = values_phi, "chi" = values_chi],
        [momentum]
    );
}

#[test]
fn particles_on_a_grid_in_a_channel_equal_the_compiled_ones_to_the_last_bit() {
    let mut data = particles(16, 4.0);
    let n = data["m"].len();
    let domain = Domain {
        lengths: [1.0, 1.0],
        walls: [Wall::Periodic, Wall::Solid],
    };
    let setting = Setting {
        domain,
        grid: Some([16, 12]),
        particles: n,
    };
    let nodes = Nodes::new(&setting).expect("has nodes");
    data.insert("w", nodes.weights());
    data.insert("n", vec![16.0, 12.0]);
    data.insert("domain", vec![1.0, 1.0, 0.0, 1.0]);
    // Between the walls.
    let places = data.get_mut("X").expect("has places");
    places.iter_mut().for_each(|x| *x = x.clamp(0.0, 1.0));
    let parameters = ParticleMesh2DParameters {
        m: data["m"].clone(),
        w: data["w"].clone(),
        c0: 1.0,
        f: 2.0,
        alpha: 0.1,
    };
    let sites = ParticleMesh2DSites {
        N: n,
        n: [16, 12],
        domain,
        scalar: Default::default(),
    };
    let initial = ParticleMesh2DInitial {
        X: vectors(&data["X"]),
        momentum_X: vectors(&data["momentum_X"]),
    };
    let model = ParticleMesh2D::new(parameters, sites).expect("is made");
    let reflections = compared!(
        source(1),
        choice(source(1), n, nodes.count()),
        data,
        model,
        initial,
        ["H" = values_H, "S" = values_S],
        []
    );
    assert!(reflections > 100, "{reflections} reflections test walls");
}

#[test]
fn particles_on_an_interval_equal_the_compiled_ones_to_the_last_bit() {
    let n = 100;
    let domain = Domain::basin([1.0]);
    let setting = Setting {
        domain,
        grid: Some([20]),
        particles: n,
    };
    let nodes = Nodes::new(&setting).expect("has nodes");
    let place = |i: usize| (i as f64 + 0.5 + 0.3 * (7.0 * i as f64).sin()) / n as f64;
    let m = vec![1.0 / n as f64; n];
    let data = Data::from([
        ("X", (0..n).map(place).collect()),
        ("m", m.clone()),
        (
            "momentum_X",
            (0..n).map(|i| 2.0 * m[i] * (i as f64).cos()).collect(),
        ),
        ("w", nodes.weights()),
        ("n", vec![20.0]),
        ("domain", vec![1.0, 1.0]),
        ("c0", vec![1.0]),
        ("alpha", vec![0.1]),
    ]);
    let parameters = ParticleMesh1DParameters {
        m,
        w: data["w"].clone(),
        c0: 1.0,
        alpha: 0.1,
    };
    let sites = ParticleMesh1DSites {
        N: n,
        n: [20],
        domain,
        scalar: Default::default(),
    };
    let initial = ParticleMesh1DInitial {
        X: data["X"].iter().map(|x| SMatrix::from([[*x]])).collect(),
        momentum_X: data["momentum_X"]
            .iter()
            .map(|p| SMatrix::from([[*p]]))
            .collect(),
    };
    let model = ParticleMesh1D::new(parameters, sites).expect("is made");
    let reflections = compared!(
        source(0),
        choice(source(0), n, nodes.count()),
        data,
        model,
        initial,
        ["H" = values_H, "S" = values_S],
        []
    );
    assert!(reflections > 10, "{reflections} reflections test walls");
}

#[test]
fn momenta_of_velocities_are_mass_times_velocity_and_what_rotation_adds() {
    let data = particles(6, 0.0);
    let (n, f) = (data["m"].len(), 2.0);
    let velocities: Vec<f64> = (0..2 * n).map(|k| (k as f64).sin()).collect();
    let numbers = |name: &str| data.get(name).cloned();
    let momenta = read(2)
        .momenta(&choice(source(2), n, 1), &numbers, "X", &velocities)
        .expect("has momenta")
        .expect("are told");
    for a in 0..n {
        let (m, x, v) = (data["m"][a], &data["X"][2 * a..], &velocities[2 * a..]);
        // The limit of small steps: m |v|^2/2 + (m f/2) perp(X).v, with perp(X) = (-y, x).
        let expected = [m * (v[0] - f / 2.0 * x[1]), m * (v[1] + f / 2.0 * x[0])];
        for (p, q) in momenta[2 * a..].iter().zip(expected) {
            // A few roundings of terms of this size.
            assert!(
                (p - q).abs() <= 8.0 * f64::EPSILON * m * (1.0 + f),
                "{a}: {p} {q}"
            );
        }
    }
}

#[test]
fn what_is_wrong_is_named() {
    let data = particles(6, 0.1);
    let n = data["m"].len();
    let model = read(2);
    let told = |change: &dyn Fn(&mut Data)| {
        let mut own = data.clone();
        change(&mut own);
        let numbers = |name: &str| own.get(name).cloned();
        let started = model.start(&choice(source(2), n, 1), H, &numbers);
        started.map(|_| ()).expect_err("is refused").to_string()
    };
    let short = told(&|d| d.get_mut("m").expect("is given").truncate(n - 1));
    assert!(short.contains("`m` has values at 35 sites"), "{short}");
    let twice = told(&|d| {
        let x = d.get_mut("X").expect("is given");
        (x[2], x[3]) = (x[0], x[1]);
    });
    assert!(
        twice.contains("particles 0 and 1") || twice.contains("particles 1 and 0"),
        "{twice}"
    );
    assert!(twice.contains("`A`"), "{twice}");
    let nowhere = told(&|d| d.get_mut("X").expect("is given")[7] = f64::NAN);
    assert!(nowhere.contains("site 3"), "{nowhere}");
    let flat = told(&|d| d.get_mut("L").expect("is given")[0] = -1.0);
    assert!(!flat.is_empty(), "{flat}");
    let none = told(&|d| drop(d.remove("L")));
    assert_eq!(none, "`L` is missing");
}

#[test]
fn a_functional_of_ones_own_needs_a_build() {
    let own = source(2).replace("voronoi_area(X)", "crate::mine::area(X)");
    assert_ne!(own, source(2));
    let refused = LineModel::read(&own)
        .expect_err("is your own Rust code")
        .to_string();
    assert!(
        refused.contains("is your own Rust code") && refused.contains("mine::area"),
        "{refused}"
    );
}

#[test]
fn a_fluid_that_is_written_down_goes_on_to_the_same_bits() {
    let data = particles(8, 0.3);
    let numbers = |name: &str| data.get(name).cloned();
    for source in [source(2), source(3), Smoothed::<f64>::SOURCE] {
        let model = LineModel::read(source).expect("is read");
        let choice = choice(source, data["m"].len(), 1);
        let start = || model.start(&choice, H, &numbers).expect("starts");
        let mut whole = start();
        for _ in 0..30 {
            whole.step().expect("steps");
        }
        let mut words = Words::gathered();
        whole.words(&mut words);
        let mut words = Words::given(words.into_list().expect("is written down"));
        let mut again = start();
        again.words(&mut words);
        assert!(words.all_put());
        for _ in 0..30 {
            whole.step().expect("steps");
            again.step().expect("steps");
        }
        let [one, other] = [&mut whole, &mut again].map(|t| t.observe("X").expect("is seen"));
        assert_eq!(bits(&one), bits(&other), "{}", model.name());
    }
}
