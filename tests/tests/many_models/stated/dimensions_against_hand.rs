//! Compares the generated free body in n dimensions with the hand-written one: one step from ten thousand random states in four
//! dimensions and a thousand in eight. A test checks that a body with different inertia fails.

use super::text_model::{TextModel, given};
use clebsch::card::Settings;
use clebsch_oracle::handwritten::body_n::BodyN as Written;
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::Square;
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// Free body in n dimensions.
const FREE_BODY_N: &str = "model FreeBodyN {
    dim n in 3..=8;
    param C: Mat<n>;
    group Λ: SO<n> velocity Ω;
    constraint next(Λ) = Λ*Ω;
    lagrangian = -tr(C^T*Ω)/h;
}";

/// About thirty rounding errors of numbers of order one, for data without amplification.
const ONE_STEP: f64 = 1e-14;

/// Relative change of the data to measure conditioning: far above rounding, far below one.
const NUDGE: f64 = 1e-6;

struct State<const N: usize> {
    j: [f64; N],
    attitude: Square<f64, N>,
    momentum: Square<f64, N>,
    h: f64,
}

impl<const N: usize> State<N> {
    fn draw(source: &mut Source) -> State<N> {
        State {
            j: from_fn(|_| source.between(0.3, 2.0)),
            attitude: source.orthogonal(),
            momentum: source.skew(),
            h: source.between(0.05, 0.2),
        }
    }

    /// Momenta increased by the fraction `momentum`, inertia by the fraction `inertia`.
    fn nudged(&self, momentum: f64, inertia: f64) -> State<N> {
        State {
            j: self.j.map(|x| x * (1.0 + inertia)),
            momentum: self.momentum.scaled(1.0 + momentum),
            ..*self
        }
    }

    /// Attitude and body momentum after one step.
    fn by_hand(&self) -> Option<Vec<f64>> {
        let mut body = Written::start(&self.j, &self.attitude.0, &self.momentum.0, self.h).ok()?;
        body.step().ok()?;
        Some([body.attitude().concat(), body.body_momentum().concat()].concat())
    }

    fn generated(&self, model: &TextModel) -> Option<Vec<f64>> {
        let factor = Square::<f64, N>::from_entries(|r, c| if r == c { self.j[r] } else { 0.0 });
        let given = given! { C: factor, Λ: self.attitude, body_momentum: self.momentum };
        let one_step = Settings::step(self.h).to_inquire();
        let mut motion = model.start_with(one_step, &given).ok()?;
        motion.step().ok()?;
        Some([motion.numbers("Λ"), motion.numbers("body_momentum")].concat())
    }
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter()
        .zip(b)
        .map(|(x, y)| (x - y).abs())
        .fold(
            0.0,
            |m: f64, x| if x.is_nan() { f64::INFINITY } else { m.max(x) },
        )
}

/// Largest difference divided by the amplification of changes of momenta or inertia, at least one.
fn single_steps<const N: usize>(count: u32, mistaken: f64) -> f64 {
    let model = TextModel::read(FREE_BODY_N).of_size(N);
    let mut source = Source::seeded(41);
    let (mut worst, mut hardest, mut refused) = (0.0_f64, 1.0_f64, 0);
    for _ in 0..count {
        let state = State::<N>::draw(&mut source);
        let generated = state.nudged(0.0, mistaken).generated(&model);
        match (generated, state.by_hand()) {
            (Some(generated), Some(hand)) => {
                let condition = [(NUDGE, 0.0), (0.0, NUDGE)]
                    .into_iter()
                    .filter_map(|(m, j)| Some(apart(&state.nudged(m, j).by_hand()?, &hand) / NUDGE))
                    .fold(1.0, worse);
                hardest = worse(hardest, condition);
                worst = worse(worst, apart(&generated, &hand) / condition);
            }
            (None, None) => refused += 1,
            (generated, hand) => panic!(
                "one refuses: generated {}, hand {}",
                generated.is_some(),
                hand.is_some()
            ),
        }
    }
    println!(
        "{N} dimensions: {worst:.1e} over conditioning (at most {hardest:.1}), {refused} refused"
    );
    assert!(refused * 20 < count, "{refused} refused");
    worst
}

#[test]
fn four_dimensions() {
    let worst = single_steps::<4>(10_000, 0.0);
    assert!(worst < ONE_STEP, "{worst:e}");
}

#[test]
fn eight_dimensions() {
    let worst = single_steps::<8>(1_000, 0.0);
    assert!(worst < ONE_STEP, "{worst:e}");
}

#[test]
fn another_body_is_noticed() {
    let worst = single_steps::<4>(100, 1e-6);
    assert!(worst > 1e4 * ONE_STEP, "{worst:e}");
}
