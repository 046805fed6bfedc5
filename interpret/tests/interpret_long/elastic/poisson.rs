//! Whether the maps of rods are Poisson (sections 3.5 and 3.7.1 of the thesis leave it open): `D B Dᵀ` against B at
//! the image, D the derivative of one emitted step by differences of sixth order, B the bracket that is derived from
//! the statement. The static rod in its reduced space of moment and force; the geometrically exact rod in its phase
//! space, and the action of rotations of space on it. Brackets at the wrong end of a step, steps whose length depends
//! on the state, and the tangent advected as (3.66) prints it all fail.

use clebsch::Rotation;
use clebsch::card::{Card, Field, Kind, Settings};
use clebsch_core::derive::bracket::{Space, coordinates};
use clebsch_core::expr::shape::Structure;
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::{Assignment, Derivation, derive_source, pipeline};
use clebsch_oracle::oracle::points::Source;
use nalgebra::{DMatrix, Matrix3, Vector3};

const STATIC: &str = include_str!("../../../../models/elastic/kirchhoff-static.clebsch");
const EXACT: &str = include_str!("../../../../models/lattices/geometrically-exact-rod.clebsch");

/// Differences of sixth order of functions of order one leave 1e-13 of the step's sixth power and 1e-14 of rounding, which
/// products of three matrices of up to thirty rows magnify.
const TOLERANCE: f64 = 1e-10;

/// The derivative of a map at zero, one column per coordinate.
fn derivative(size: usize, map: impl Fn(&[f64]) -> Vec<f64>) -> DMatrix<f64> {
    let moved = 1e-2;
    let columns: Vec<Vec<f64>> = (0..size)
        .map(|k| {
            let at = |times: f64| {
                let mut x = vec![0.0; size];
                x[k] = times * moved;
                map(&x)
            };
            let weights = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)];
            let mut column = vec![0.0; map(&vec![0.0; size]).len()];
            for (times, weight) in weights {
                let (up, down) = (at(times), at(-times));
                for (sum, (u, d)) in column.iter_mut().zip(up.iter().zip(&down)) {
                    *sum += weight * (u - d) / moved;
                }
            }
            column
        })
        .collect();
    DMatrix::from_fn(columns[0].len(), size, |i, j| columns[j][i])
}

/// `D B Dᵀ - B'`: the largest entry, divided by the largest entry of B'.
fn defect(d: &DMatrix<f64>, before: &DMatrix<f64>, after: &DMatrix<f64>) -> f64 {
    (d * before * d.transpose() - after).amax() / after.amax()
}

fn values(of: &Card, card: &dyn clebsch::card::Trajectory) -> Vec<(&'static Field, Vec<f64>)> {
    let mut all = vec![0.0; of.observable_count()];
    card.observe(&mut all);
    let mut from = 0;
    of.observables
        .iter()
        .map(|field| {
            from += field.count();
            (field, all[from - field.count()..from].to_vec())
        })
        .collect()
}

fn value(seen: &[(&'static Field, Vec<f64>)], ascii: &str) -> Vec<f64> {
    let found = seen.iter().find(|(field, _)| field.ascii == ascii);
    found.unwrap_or_else(|| panic!("{ascii}")).1.clone()
}

/// A static rod: the step from moment and force in one section to the next section, with the rotation between them.
struct Section {
    card: Card,
    derived: Derivation,
    parameters: Vec<Vec<f64>>,
}

impl Section {
    /// The shipped rod, and a rod with two different bending stiffnesses.
    fn new(text: &str, parameters: Vec<Vec<f64>>) -> Self {
        Self {
            card: clebsch_interpret::card(text).expect("is read"),
            derived: derive_source(text).expect("derives"),
            parameters,
        }
    }

    fn step(&self, z: &[f64], h: f64) -> (Vec<f64>, Matrix3<f64>) {
        let one = vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let mut parameters = self.parameters.clone();
        // Seen from a section that is not rotated, the force equals the spatial force.
        parameters.push(z[3..].to_vec());
        let initial = [one, z[..3].to_vec()];
        let started = (self.card.open)(&parameters, &initial, Settings::step(h));
        let mut t = started.unwrap_or_else(|e| panic!("{e}"));
        t.step().unwrap_or_else(|e| panic!("{e}"));
        let seen = values(&self.card, &*t);
        let z = [value(&seen, "body_momentum"), value(&seen, "nu")].concat();
        (z, Matrix3::from_row_slice(&value(&seen, "Lambda")))
    }

    fn bracket(&self, z: &[f64]) -> DMatrix<f64> {
        let mut at = Assignment::new();
        let momentum = self.derived.letters.node_momentum[0];
        let momentum = &self.derived.letters.symbols.get(momentum).name;
        at.set(momentum, 0, 3, 1, &z[..3]);
        at.set("ν", 0, 3, 1, &z[3..]);
        let b = self.derived.bracket_matrix(Space::Reduced, &at);
        let b = b.expect("all values are given");
        DMatrix::from_row_slice(b.rows, b.cols, &b.data)
    }

    /// The defect of a map built from a step, with the bracket at its end or, wrongly, at its start.
    fn defect(&self, z: &[f64], late: bool, map: impl Fn(&[f64]) -> Vec<f64>) -> f64 {
        let from = |dz: &[f64]| -> Vec<f64> { z.iter().zip(dz).map(|(a, b)| a + b).collect() };
        let d = derivative(6, |dz| map(&from(dz)));
        let image = map(z);
        let after = self.bracket(if late { z } else { &image });
        defect(&d, &self.bracket(z), &after)
    }
}

#[test]
fn the_map_of_a_rod_at_rest_is_poisson() {
    let bends = "let B = (K3/2)*Id + (K1 - K3)*E3*E3^T;";
    assert!(STATIC.contains(bends));
    let flat = STATIC.replace(
        bends,
        "let B = (K3/2)*Id + (K1 - K3)*E3*E3^T + (K1/5)*E1*E1^T;",
    );
    let mut source = Source::seeded(41);
    let mut worst = 0.0_f64;
    for text in [STATIC.to_owned(), flat] {
        let rod = Section::new(&text, vec![vec![1.4], vec![2.0]]);
        for h in [0.1, 0.3, 0.6] {
            for _ in 0..3 {
                let z: [f64; 6] = source.vector();
                let own = rod.defect(&z, false, |z| rod.step(z, h).0);
                assert!(own < TOLERANCE, "{h}: {own:e}");
                worst = worst.max(own);
                // Three wrong maps: another bracket, sections with a state-dependent length, and the printed equation
                // of the tangent.
                let late = rod.defect(&z, true, |z| rod.step(z, h).0);
                let long = rod.defect(&z, false, |z| rod.step(z, h * (1.0 + 0.1 * z[0])).0);
                let printed = rod.defect(&z, false, |z| {
                    let (mut next, turn) = rod.step(z, h);
                    let carried = turn * Vector3::new(z[3], z[4], z[5]);
                    next[3..].copy_from_slice(carried.as_slice());
                    next
                });
                for wrong in [late, long, printed] {
                    assert!(
                        wrong > 1e4 * TOLERANCE,
                        "{h}: {late:e} {long:e} {printed:e}"
                    );
                }
                // Casimirs.
                let (next, _) = rod.step(&z, h);
                let casimirs = |z: &[f64]| {
                    let (m, f) = (
                        Vector3::from_column_slice(&z[..3]),
                        Vector3::from_column_slice(&z[3..]),
                    );
                    [m.dot(&f), f.dot(&f)]
                };
                for (a, b) in casimirs(&z).iter().zip(casimirs(&next)) {
                    assert!((a - b).abs() < 1e-14, "{a} {b}");
                }
            }
        }
    }
    println!("{worst:e}");
}

/// The rod with inertia on two segments with free ends, body by body.
struct Rod {
    card: Card,
    derived: Derivation,
}

/// A configuration with its momentum, in the order of the card.
type State = Vec<Vec<f64>>;

impl Rod {
    fn new(text: &str) -> Self {
        let model = pipeline::parse_source(text).expect("is a model");
        let lattice = Lattice::read(&model).expect("has labels");
        let choice = ChainConfig::representative(&lattice, 1);
        let choice = choice.with_count(&lattice, "i", 2).expect("has sites");
        let (_, derived) = pipeline::derive_lattice(&model, &lattice, &choice).expect("derives");
        let (card, _) = clebsch_interpret::card_on_lattice(text, &choice).expect("is read");
        Self { card, derived }
    }

    fn parameters(&self) -> Vec<Vec<f64>> {
        let each = self.card.parameters.iter().map(|field| {
            let key = field.ascii.split('_').next().unwrap_or_default();
            let diagonal = |a, b, c| vec![a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c];
            match key {
                "s" => vec![0.5],
                "m" => vec![0.4],
                "J" => diagonal(0.3, 0.4, 0.5),
                "S" => diagonal(2.0, 2.5, 3.0),
                "B" => diagonal(0.5, 0.4, 0.7),
                _ => vec![0.0; field.count()],
            }
        });
        each.collect()
    }

    fn random(&self, source: &mut Source) -> State {
        let each = self
            .card
            .initial
            .iter()
            .enumerate()
            .map(|(k, field)| match field.kind {
                Kind::Rotation => {
                    let v: [f64; 3] = source.vector();
                    row_major(&Rotation::exp(&(Vector3::from(v) * 0.3)).matrix())
                }
                // Positions along the third axis, and momenta.
                _ => {
                    let v: [f64; 3] = source.vector();
                    let along = if k % 2 == 0 { 0.25 * k as f64 } else { 0.0 };
                    vec![0.2 * v[0], 0.2 * v[1], 0.2 * v[2] + along]
                }
            });
        each.collect()
    }

    fn step(&self, state: &State, h: f64) -> State {
        let started = (self.card.open)(&self.parameters(), state, Settings::step(h));
        let mut t = started.unwrap_or_else(|e| panic!("{e}"));
        t.step().unwrap_or_else(|e| panic!("{e}"));
        let seen = values(&self.card, &*t);
        let fields = self.card.initial.iter();
        fields.map(|field| value(&seen, field.ascii)).collect()
    }

    /// The difference between two states in the coordinates of the bracket: momenta, then positions and rotations.
    fn beside(&self, state: &State, other: &State) -> Vec<f64> {
        let mut all = Vec::new();
        for (a, b) in state.iter().zip(other).skip(1).step_by(2) {
            all.extend(b.iter().zip(a).map(|(b, a)| b - a));
        }
        for (a, b) in state.iter().zip(other).step_by(2) {
            match a.len() {
                9 => {
                    let turn = matrix(a).transpose() * matrix(b);
                    let turn = (turn - turn.transpose()) * 0.5;
                    let own = coordinates(Structure::Orthogonal, 3, 3);
                    all.extend(own.iter().map(|(i, j)| turn[(*i, *j)]));
                }
                _ => all.extend(b.iter().zip(a).map(|(b, a)| b - a)),
            }
        }
        all
    }

    /// The state with this difference from another state, to first order.
    fn moved(&self, state: &State, by: &[f64]) -> State {
        let mut out = state.clone();
        let mut next = by.iter();
        let mut take = || *next.next().expect("as many as coordinates");
        for p in out.iter_mut().skip(1).step_by(2) {
            p.iter_mut().for_each(|x| *x += take());
        }
        for x in out.iter_mut().step_by(2) {
            match x.len() {
                9 => {
                    let mut turn = Matrix3::zeros();
                    for (i, j) in coordinates(Structure::Orthogonal, 3, 3) {
                        turn[(i, j)] = take();
                        turn[(j, i)] = -turn[(i, j)];
                    }
                    let axis = Vector3::new(turn[(2, 1)], turn[(0, 2)], turn[(1, 0)]);
                    *x = row_major(&(matrix(x) * Rotation::exp(&axis).matrix()));
                }
                _ => x.iter_mut().for_each(|x| *x += take()),
            }
        }
        out
    }

    fn bracket(&self, state: &State) -> DMatrix<f64> {
        let mut at = Assignment::new();
        let letters = &self.derived.letters;
        for (k, c) in self.derived.spec.configurations.iter().enumerate() {
            let name = |id| letters.symbols.get(id).name.as_str();
            let (x, p) = (&state[2 * k], &state[2 * k + 1]);
            let cols = if x.len() == 9 { 3 } else { 1 };
            at.set(name(c.element), 0, 3, cols, x);
            at.set(name(letters.node_momentum[k]), 0, 3, 1, p);
        }
        let b = self.derived.bracket_matrix(Space::Phase, &at);
        let b = b.expect("all values are given");
        DMatrix::from_row_slice(b.rows, b.cols, &b.data)
    }

    fn defect(&self, state: &State, late: bool, step: impl Fn(&State) -> State) -> f64 {
        let image = step(state);
        let before = self.bracket(state);
        let d = derivative(before.nrows(), |by| {
            self.beside(&image, &step(&self.moved(state, by)))
        });
        let after = self.bracket(if late { state } else { &image });
        defect(&d, &before, &after)
    }
}

fn matrix(list: &[f64]) -> Matrix3<f64> {
    Matrix3::from_row_slice(list)
}

fn row_major(m: &Matrix3<f64>) -> Vec<f64> {
    m.transpose().as_slice().to_vec()
}

#[test]
fn the_map_of_the_geometrically_exact_rod_is_poisson() {
    let rod = Rod::new(EXACT);
    let mut source = Source::seeded(42);
    let mut worst = 0.0_f64;
    for h in [0.02, 0.1, 0.2] {
        let state = rod.random(&mut source);
        let own = rod.defect(&state, false, |x| rod.step(x, h));
        assert!(own < TOLERANCE, "{h}: {own:e}");
        worst = worst.max(own);
        let late = rod.defect(&state, true, |x| rod.step(x, h));
        let long = rod.defect(&state, false, |x| rod.step(x, h * (1.0 + 0.1 * x[1][0])));
        assert!(late.min(long) > 1e4 * TOLERANCE, "{h}: {late:e} {long:e}");
        // Rotations of space commute with the step, so the step acts on quantities that they leave invariant: Λᵀ p,
        // M, Γ and Λᵀ next(Λ).
        let turn = Rotation::exp(&Vector3::new(0.7, -0.4, 1.1)).matrix();
        let turned = |x: &State| -> State {
            let each = x
                .iter()
                .zip(rod.card.initial)
                .map(|(x, field)| match field.kind {
                    Kind::Rotation => row_major(&(turn * matrix(x))),
                    Kind::BodyMomentum => x.clone(),
                    _ => (turn * Vector3::from_column_slice(x)).as_slice().to_vec(),
                });
            each.collect()
        };
        let (after, before) = (turned(&rod.step(&state, h)), rod.step(&turned(&state), h));
        for (a, b) in after.concat().iter().zip(before.concat()) {
            assert!((a - b).abs() < 1e-13, "{a} {b}");
        }
    }
    println!("{worst:e}");
}
