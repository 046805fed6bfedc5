//! Compares every compiled random model with the oracle. The test checks residuals at random points that solve nothing, and checks
//! that two steps make the unreduced action stationary at the middle node. Both must agree to rounding. The oracle builds the model
//! as a tree and never parses text.

mod compiled;

use clebsch::card::{Card, Field, Kind, Settings};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::wide::grid::Grid;
use clebsch_oracle::oracle::wide::grow::AROUND;
use clebsch_oracle::oracle::wide::model::{Family, Model};
use clebsch_oracle::oracle::wide::point::{Node, Point};
use compiled::{Compiled, MODELS, NamedValues};

/// Random points per model.
const POINTS: u64 = 4;
/// Tolerance of residuals relative to the sum of the absolute summands. Inverses and determinants of random matrices, whose
/// condition number seldom exceeds 1e4, amplify a few rounding errors.
const AGREEMENT: f64 = 1e-12;
/// Tolerance for two steps: Newton's method stops at a few rounding errors of the momentum, which has the size of the summands.
const SOLVED: f64 = 1e-11;
/// Step size of the two steps, small enough for the kinetic terms to dominate.
const STEP: f64 = 0.02;

fn given(point: &Point<'_>, nodes: &[Node; 3]) -> NamedValues {
    let list = point.given(nodes).into_iter();
    NamedValues(list.map(|g| (g.name, g.shift, g.data)).collect())
}

/// The largest disagreement of residuals.
fn residuals(compiled: &Compiled) -> Result<f64, String> {
    let model = Model::of_seed(compiled.seed);
    let mut source = Source::seeded(compiled.seed ^ 0xa9ee);
    let mut worst: f64 = 0.0;
    for _ in 0..POINTS {
        let step = source.between(0.2, 1.0);
        let point = Point::draw(&model, &mut source, step);
        let nodes: [Node; 3] = std::array::from_fn(|_| point.node(&mut source));
        let oracle = point.stationarity(&nodes);
        let found = (compiled.residual)(step, &given(&point, &nodes))?;
        let off = oracle.disagreement(&found);
        if off > AGREEMENT {
            return Err(format!(
                "off by {off:e} of {:e}\noracle  {:?}\nemitted {found:?}",
                oracle.scale, oracle.derivative
            ));
        }
        worst = worst.max(off);
    }
    Ok(worst)
}

/// Initial values by field, from the oracle's symbols; momenta are random, one body after another.
fn initial(
    model: &Model,
    card: &Card,
    at_start: &[Grid<f64>],
    source: &mut Source,
) -> Vec<Vec<f64>> {
    let mut bodies = model.bodies.iter().filter(|b| !b.family.is_added());
    let mut value = |field: &Field| {
        if !is_momentum(field) {
            let found = model
                .letters
                .iter()
                .zip(at_start)
                .find(|(l, _)| l.name == field.name);
            return found.map_or_else(Vec::new, |(_, value)| as_field(field, value));
        }
        let family = match field.kind {
            Kind::FieldMomentum => None,
            _ => bodies.next().map(|b| b.family),
        };
        let (count, n) = (field.rows * field.cols, field.cols);
        let draws: Vec<f64> = (0..count).map(|_| source.between(-0.3, 0.3)).collect();
        match family {
            // In dimensions other than three, the momentum of a body is a skew matrix.
            Some(Family::Rotation(_)) if n > 1 => (0..count)
                .map(|k| draws[k] - draws[k % n * n + k / n])
                .collect(),
            _ => draws,
        }
    };
    card.initial.iter().map(&mut value).collect()
}

/// A value in the entries of its field: four components for a unit quaternion.
fn as_field(field: &Field, value: &Grid<f64>) -> Vec<f64> {
    match field.rows * field.cols {
        4 if value.data.len() == 16 => (0..4).map(|i| value.at(i, 0)).collect(),
        _ => value.data.clone(),
    }
}

/// Builds a group element from the entries of its field.
fn element(family: Family, data: &[f64]) -> Grid<f64> {
    match (family, data) {
        (Family::Quaternion, [w, x, y, z]) => Grid::quaternion(*w, [*x, *y, *z]),
        _ => {
            let rows = family.size();
            Grid {
                rows,
                cols: data.len() / rows,
                data: data.to_vec(),
            }
        }
    }
}

fn is_momentum(field: &Field) -> bool {
    matches!(
        field.kind,
        Kind::BodyMomentum | Kind::SpatialMomentum | Kind::FieldMomentum
    )
}

/// Initial momenta in the bases of their Lie algebras.
fn coordinates(card: &Card, values: &[Vec<f64>]) -> Vec<f64> {
    let momenta = card.initial.iter().zip(values);
    let momenta = momenta.filter(|(field, _)| is_momentum(field));
    let each = momenta.flat_map(|(field, m)| {
        let n = field.cols;
        let is_skew = n > 1 && (0..n * n).all(|k| m[k] == -m[k % n * n + k / n]);
        match is_skew {
            true => (0..n)
                .flat_map(|i| (i + 1..n).map(move |j| m[j * n + i]))
                .collect(),
            false => m.clone(),
        }
    });
    each.collect()
}

/// How far two emitted steps leave the action from stationarity, and the start from its momentum. Returns `None` if a step fails.
fn steps(compiled: &Compiled) -> Result<Option<f64>, String> {
    let model = Model::of_seed(compiled.seed);
    let mut source = Source::seeded(compiled.seed ^ 0x57e9);
    let point = Point::draw(&model, &mut source, STEP);
    let start = point.node(&mut source);
    let letters = point.letters(&start);
    let card = compiled.card;
    let parameters: Vec<Vec<f64>> = card
        .parameters
        .iter()
        .map(|f| {
            let found = model
                .letters
                .iter()
                .zip(&letters)
                .find(|(l, _)| l.name == f.name);
            found.map_or_else(Vec::new, |(_, value)| as_field(f, value))
        })
        .collect();
    let values = initial(&model, card, &letters, &mut source);
    let Ok(mut trajectory) = (card.open)(&parameters, &values, Settings::step(STEP)) else {
        return Ok(None);
    };
    let count: usize = card.observables.iter().map(|f| f.rows * f.cols).sum();
    let mut nodes = vec![start];
    for _ in 0..2 {
        if trajectory.step().is_err() {
            return Ok(None);
        }
        let mut out = vec![f64::NAN; count];
        trajectory.observe(&mut out);
        let mut node = Vec::new();
        let mut at = 0;
        for f in card.observables {
            let data = &out[at..at + f.rows * f.cols];
            at += data.len();
            let body = model
                .bodies
                .iter()
                .find(|b| model.letters[b.element].name == f.name);
            if let Some(b) = body {
                node.push(element(b.family, data));
            }
        }
        nodes.push(node);
    }
    let nodes = <[Node; 3]>::try_from(nodes).map_err(|_| "three nodes".to_owned())?;
    let oracle = point.stationarity(&nodes);
    let off = oracle.disagreement(&vec![0.0; oracle.derivative.len()]);
    let [started, _] = point.momenta(&nodes[0], &nodes[1]);
    let off = match model.summands.iter().any(|(_, t)| model.is_of_the_end(t)) {
        true => off,
        false => off.max(started.disagreement(&coordinates(card, &values))),
    };
    match off <= SOLVED {
        true => Ok(Some(off)),
        false => Err(format!(
            "off by {off:e} of {:e}: {:?}",
            oracle.scale, oracle.derivative
        )),
    }
}

fn report(failures: &[(u64, String)]) {
    let list: Vec<String> = failures
        .iter()
        .map(|(seed, why)| format!("seed {seed}: {why}\n{}", Model::of_seed(*seed).text()))
        .collect();
    assert!(
        list.is_empty(),
        "{} of {} failed\n{}",
        list.len(),
        MODELS.len(),
        list.join("\n\n")
    );
}

#[test]
fn residuals_are_those_of_the_unreduced_action() {
    let mut failures = Vec::new();
    let mut worst: f64 = 0.0;
    for compiled in MODELS {
        match residuals(compiled) {
            Ok(off) => worst = worst.max(off),
            Err(why) => failures.push((compiled.seed, why)),
        }
    }
    println!("{} models, worst {worst:e}", MODELS.len());
    report(&failures);
}

#[test]
fn steps_leave_the_action_stationary() {
    let mut failures = Vec::new();
    let (mut worst, mut refused): (f64, Vec<u64>) = (0.0, Vec::new());
    for compiled in MODELS {
        match steps(compiled) {
            Ok(Some(off)) => worst = worst.max(off),
            Ok(None) => refused.push(compiled.seed),
            Err(why) => failures.push((compiled.seed, why)),
        }
    }
    println!(
        "{} models, worst {worst:e}, refused {refused:?}",
        MODELS.len()
    );
    report(&failures);
    // Some actions are far from convex, but most are not.
    assert!(refused.len() * 10 <= MODELS.len(), "refused: {refused:?}");
}

#[test]
fn every_group_and_function_stands_in_some_model() {
    let texts: Vec<String> = MODELS
        .iter()
        .map(|c| Model::of_seed(c.seed).text())
        .collect();
    let functions = [
        "tr(", "det(", "log(", "exp(", "sqrt(", "sin(", "cos(", "sinh(", "cosh(", "tanh(", "abs(",
        "sign(", "inv(", "sym(", "skew(", "diag(", "hat(", "vee(", "dot(", "cross(", "re(", "im(",
        "I1(", "I2(", "next(", "quat(", "rot(", "pos(",
    ];
    let written = [
        "^(1/3)",
        "^(-3/2)",
        "^-1",
        "^T",
        "^2",
        "^3",
        "E1",
        "Id",
        "[1]",
        "[1, 1]",
        "SO<2>",
        "SO<3>",
        "SO<4>",
        "SO<5>",
        "SU<2>",
        "SE<2>",
        "SE<3>",
        "field ",
        "GL<2>",
        "GL<3>",
        "Real",
        "Vec<",
        "Sym<",
        "Skew<",
        "Diag<",
        "Mat<3>",
        "Mat<3, 2>",
        "node incoming",
        "node outgoing",
        "scale ",
    ];
    for wanted in functions.iter().chain(&written) {
        assert!(
            texts.iter().any(|t| t.contains(wanted)),
            "no model has `{wanted}`"
        );
    }
    // Each function is sampled around its own number, so that the test detects one function in place of another.
    assert_eq!(AROUND.len(), 16);
}
