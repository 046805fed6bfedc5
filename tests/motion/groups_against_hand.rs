//! Compares generated steppers on SU(2) and SE(3), run through their cards, with hand-written ones: one step from each of five
//! hundred random states. A test checks that the comparison detects a relative change of 1e-6 in every datum.

use clebsch::card::{Card, Field, Settings};
use clebsch_models::{Entry, gallery};
use clebsch_oracle::handwritten::attitude::{Quaternion, Vector, apply};
use clebsch_oracle::handwritten::cayley_klein::CayleyKlein;
use clebsch_oracle::handwritten::kirchhoff_body::{KirchhoffBody, Momentum, Submerged};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::points::asked_for;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;
use std::sync::LazyLock;

/// About thirty rounding errors of numbers of order one, for data without amplification.
const ONE_STEP: f64 = 1e-14;

/// Random states of each system. Measuring the conditioning costs one step per datum; `GROUP_STATES=2000` requests more states.
fn states() -> u32 {
    u32::try_from(asked_for("GROUP_STATES", 500)).unwrap_or(u32::MAX)
}

/// Relative change of a datum, both to measure conditioning and to plant a mistake: far above rounding, far below one.
const NUDGE: f64 = 1e-6;

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    let differences = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    differences.fold(
        0.0,
        |m: f64, x| if x.is_nan() { f64::INFINITY } else { m.max(x) },
    )
}

pub(super) fn stretched(v: Vector, factor: f64) -> Vector {
    v.map(|x| x * factor)
}

/// One step of a gallery model; returns these observables.
pub(super) fn generated(
    model: &str,
    shown: &[&str],
    parameters: &[Vec<f64>],
    initial: &[Vec<f64>],
    h: f64,
) -> Option<Vec<f64>> {
    // Loaded once: reading the cases of all models takes a thousand times longer than a step.
    static GALLERY: LazyLock<Vec<Entry>> = LazyLock::new(gallery);
    let entry = GALLERY.iter().find(|entry| entry.card.kebab == model);
    let entry = entry.expect("a model of the gallery");
    let sizes = |card: &Card| -> Vec<usize> { card.parameters.iter().map(Field::count).collect() };
    let given: Vec<usize> = parameters.iter().map(Vec::len).collect();
    let of_size = entry.cards().into_iter().find(|card| sizes(card) == given);
    let card = of_size.expect("a size of the model");
    let mut motion = (card.open)(parameters, initial, Settings::step(h)).ok()?;
    motion.step().ok()?;
    let mut all = vec![0.0; card.observable_count()];
    motion.observe(&mut all);
    let found = shown.iter().map(|name| {
        let fields = card.observables.iter();
        let before = fields.clone().take_while(|field| field.ascii != *name);
        let start: usize = before.map(Field::count).sum();
        let field = fields.clone().find(|field| field.ascii == *name);
        &all[start..start + field.expect("an observable of the model").count()]
    });
    Some(found.collect::<Vec<_>>().concat())
}

/// A state with its data.
pub(super) trait System: Sized {
    /// Kinds of data: 0 is the momentum, the others are parameters and advected quantities.
    const KINDS: usize;
    fn draw(source: &mut Source) -> Self;
    /// The same state, with the data of one kind increased by this fraction.
    fn nudged(&self, kind: usize, share: f64) -> Self;
    fn by_hand(&self) -> Option<Vec<f64>>;
    fn generated(&self) -> Option<Vec<f64>>;
}

/// The factor, at least one, by which one step amplifies relative changes of its data.
fn conditioning<S: System>(state: &S, result: &[f64]) -> f64 {
    (0..S::KINDS)
        .filter_map(|kind| Some(apart(&state.nudged(kind, NUDGE).by_hand()?, result) / NUDGE))
        .fold(1.0, worse)
}

/// Largest difference divided by the conditioning. With `mistaken`, the generated stepper gets a wrong datum of that kind.
fn single_steps<S: System>(name: &str, count: u32, mistaken: Option<usize>) -> f64 {
    let mut source = Source::seeded(43);
    let (mut worst, mut bare, mut hardest, mut refused) = (0.0_f64, 0.0_f64, 1.0_f64, 0);
    for _ in 0..count {
        let state = S::draw(&mut source);
        let generated = match mistaken {
            Some(kind) => state.nudged(kind, NUDGE).generated(),
            None => state.generated(),
        };
        match (generated, state.by_hand()) {
            (Some(generated), Some(hand)) => {
                let condition = conditioning(&state, &hand);
                let off = apart(&generated, &hand);
                hardest = worse(hardest, condition);
                bare = worse(bare, off);
                worst = worse(worst, off / condition);
            }
            (None, None) => refused += 1,
            (generated, hand) => panic!(
                "{name}: one refuses: generated {}, hand {}",
                generated.is_some(),
                hand.is_some()
            ),
        }
    }
    println!(
        "{name}, mistaken {mistaken:?}: {bare:.1e}, over conditioning {worst:.1e} (at most {hardest:.1}), {refused} refused"
    );
    assert!(refused * 100 < count, "{name}: {refused} refused");
    worst
}

#[derive(Clone, Copy)]
struct OnUnitQuaternions {
    moments: [f64; 3],
    c: f64,
    q: Quaternion,
    momentum: [f64; 3],
    h: f64,
}

impl OnUnitQuaternions {
    fn moved(&self) -> Option<CayleyKlein> {
        let mut body =
            CayleyKlein::start(&self.moments, self.c, &self.q, &self.momentum, self.h).ok()?;
        body.step().ok()?;
        Some(body)
    }
}

impl System for OnUnitQuaternions {
    const KINDS: usize = 3;

    fn draw(source: &mut Source) -> Self {
        let second: [f64; 3] = from_fn(|_| source.between(0.2, 1.0));
        let total: f64 = second.iter().sum();
        OnUnitQuaternions {
            moments: second.map(|j| total - j),
            c: source.between(-0.5, 1.5),
            q: Quaternion(source.vector()).normalised(),
            momentum: source.vector(),
            h: source.between(0.05, 0.2),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Self {
        let factor = 1.0 + share;
        let mut moved = *self;
        match kind {
            0 => moved.momentum = stretched(self.momentum, factor),
            1 => moved.moments = stretched(self.moments, factor),
            _ => moved.c *= factor,
        }
        moved
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let body = self.moved()?;
        Some([body.quaternion().0.to_vec(), body.body_momentum().to_vec()].concat())
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let [a, b, c] = self.moments;
        let moments = vec![a, 0.0, 0.0, 0.0, b, 0.0, 0.0, 0.0, c];
        let initial = [self.q.0.to_vec(), self.momentum.to_vec()];
        generated(
            "cayley-klein",
            &["q", "body_momentum"],
            &[moments, vec![self.c]],
            &initial,
            self.h,
        )
    }
}

/// The same body in the spatial form, compared with the hand-written body step seen from space.
struct SeenFromSpace(OnUnitQuaternions);

impl SeenFromSpace {
    /// R diag(moments) R^T.
    fn inertia(&self, q: &Quaternion) -> Vec<f64> {
        let (r, moments) = (q.matrix(), self.0.moments);
        let entry = |i: usize, j: usize| (0..3).map(|k| r[i][k] * r[j][k] * moments[k]).sum();
        (0..9).map(|n| entry(n / 3, n % 3)).collect()
    }
}

impl System for SeenFromSpace {
    const KINDS: usize = OnUnitQuaternions::KINDS;

    fn draw(source: &mut Source) -> Self {
        SeenFromSpace(OnUnitQuaternions::draw(source))
    }

    fn nudged(&self, kind: usize, share: f64) -> Self {
        SeenFromSpace(self.0.nudged(kind, share))
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let body = self.0.moved()?;
        let q = body.quaternion();
        let momentum = body.body_momentum().to_vec();
        Some([q.0.to_vec(), momentum, self.inertia(&q)].concat())
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let OnUnitQuaternions {
            q, momentum, c, h, ..
        } = &self.0;
        let initial = [
            q.0.to_vec(),
            apply(&q.matrix(), momentum).to_vec(),
            self.inertia(q),
        ];
        let shown = ["q", "body_momentum", "I"];
        generated("cayley-klein-spatial", &shown, &[vec![*c]], &initial, *h)
    }
}

#[derive(Clone, Copy)]
struct InFluid {
    body: Submerged,
    attitude: Quaternion,
    position: [f64; 3],
    momentum: Momentum,
    h: f64,
}

/// Homogeneous matrix, row by row.
pub(super) fn rigid(q: &Quaternion, x: &[f64; 3]) -> Vec<f64> {
    let r = q.matrix();
    let rows = (0..3).flat_map(|i| [r[i][0], r[i][1], r[i][2], x[i]]);
    rows.chain([0.0, 0.0, 0.0, 1.0]).collect()
}

impl System for InFluid {
    const KINDS: usize = 7;

    fn draw(source: &mut Source) -> Self {
        let direction: [f64; 3] = source.vector();
        let length = direction.iter().map(|x| x * x).sum::<f64>().sqrt();
        InFluid {
            body: Submerged {
                poinsot: source.positive::<3>().0,
                masses: source.positive::<3>().0,
                coupling: source.matrix::<3>().scaled(0.1).0,
                moment: source.vector(),
                weight: source.between(-1.0, 1.0),
                up: direction.map(|x| x / length),
            },
            attitude: Quaternion(source.vector()).normalised(),
            position: source.vector(),
            momentum: Momentum {
                angular: source.vector(),
                linear: source.vector(),
            },
            h: source.between(0.01, 0.05),
        }
    }

    fn nudged(&self, kind: usize, share: f64) -> Self {
        let factor = 1.0 + share;
        let mut moved = *self;
        let body = &mut moved.body;
        match kind {
            0 => {
                moved.momentum.angular = stretched(self.momentum.angular, factor);
                moved.momentum.linear = stretched(self.momentum.linear, factor);
            }
            1 => body.poinsot = body.poinsot.map(|row| stretched(row, factor)),
            2 => body.masses = body.masses.map(|row| stretched(row, factor)),
            3 => body.coupling = body.coupling.map(|row| stretched(row, factor)),
            4 => body.moment = stretched(body.moment, factor),
            5 => body.weight *= factor,
            _ => moved.position = stretched(self.position, factor),
        }
        moved
    }

    fn by_hand(&self) -> Option<Vec<f64>> {
        let (q, x, m) = (&self.attitude, &self.position, &self.momentum);
        let mut body = KirchhoffBody::start(&self.body, q, x, m, self.h).ok()?;
        body.step().ok()?;
        let (place, m) = (
            rigid(&body.attitude(), &body.position()),
            body.body_momentum(),
        );
        Some([place, m.angular.to_vec(), m.linear.to_vec()].concat())
    }

    fn generated(&self) -> Option<Vec<f64>> {
        let b = &self.body;
        let parameters = [
            b.poinsot.concat(),
            b.masses.concat(),
            b.coupling.concat(),
            [b.moment.to_vec(), vec![b.weight]].concat(),
            [b.up.to_vec(), vec![0.0]].concat(),
        ];
        let momentum = [self.momentum.angular, self.momentum.linear].concat();
        let initial = [rigid(&self.attitude, &self.position), momentum];
        let shown = ["G", "body_momentum"];
        generated("kirchhoff-body", &shown, &parameters, &initial, self.h)
    }
}

pub(super) fn agree<S: System>(name: &str) {
    let worst = single_steps::<S>(name, states(), None);
    assert!(worst < ONE_STEP, "{name}: {worst:e}");
    for kind in 0..S::KINDS {
        let worst = single_steps::<S>(name, 100, Some(kind));
        assert!(
            worst > 1e3 * ONE_STEP,
            "{name}, other datum {kind}: {worst:e}"
        );
    }
}

#[test]
fn cayley_klein() {
    agree::<OnUnitQuaternions>("Cayley-Klein");
}

#[test]
fn cayley_klein_spatial() {
    agree::<SeenFromSpace>("Cayley-Klein, spatial");
}

#[test]
fn kirchhoff_body() {
    agree::<InFluid>("Kirchhoff");
}
