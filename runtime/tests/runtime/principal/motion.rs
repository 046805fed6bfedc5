//! Whole motions, in which a step may reuse the proof of an earlier one; every step of every motion is checked.

use super::models::*;
use super::oracle::{Curve, follow};
use super::{AT_A_FOLD, SAME, even};
use crate::common::Random;
use clebsch::integrate::Stepper;
use clebsch::solvers::moser_veselov::largest_step;
use std::cell::{Cell, RefCell};

/// Maximum number of steps of a motion.
const STEPS: usize = 40;

/// Motions per model; `PRINCIPAL_MOTIONS=1000` requests more.
fn motions() -> u64 {
    let asked = std::env::var("PRINCIPAL_MOTIONS").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(40)
}

/// Random problems, from small step sizes to about twice the solvable ones.
fn judge<J: Judged>(name: &str) {
    let mut random = Random(77);
    let unit = even::<J>();
    let (mut judged, mut other) = (0_u64, 0_u64);
    for motion in 0..motions() {
        let p = J::draw(&mut random);
        let h = p.unit * 10.0_f64.powf(random.symmetric() * 0.5 - 0.3);
        let mut state = (p.state)(1.0);
        let Ok(mut work) = p.model.workspace(&state, h) else {
            continue;
        };
        for step in 0..STEPS {
            let here = state;
            // Inside a search, a failed step does not start another search.
            let moving = RefCell::new((state, work.clone()));
            let made = Cell::new(false);
            let _ = largest_step(1.0, |_| {
                let (state, work) = &mut *moving.borrow_mut();
                made.set(p.model.advance(state, work).is_ok());
                Some(0.0)
            });
            if !made.get() {
                break;
            }
            (state, work) = moving.into_inner();
            let curve = At::<J> {
                model: &p.model,
                h,
                here,
            };
            let velocity = J::between(&here, &state);
            let Some(followed) = follow(&curve, &curve.value(&velocity), &unit) else {
                continue;
            };
            if followed.smallest < AT_A_FOLD && followed.share > 1.0 - 1e-4 {
                break;
            }
            judged += 1;
            let off = J::distance(&velocity, &followed.end);
            if followed.share < 1.0 || off > SAME {
                println!(
                    "{name} {motion}, step {step}: another root, {off:.2e} away; the curve has {} (σ {:.1e})",
                    followed.share, followed.smallest
                );
                other += 1;
                break;
            }
        }
    }
    println!("{name}: {judged} steps judged");
    assert_eq!(other, 0, "{name}");
    assert!(judged > 2 * motions(), "{name}: {judged}");
}

macro_rules! judges {
    ($($test:ident: $judge:ty;)+) => {$(
        #[test]
        fn $test() {
            judge::<$judge>(stringify!($test));
        }
    )+};
}

judges! {
    bodies_with_a_joint: JudgedPair;
    a_body_in_a_fluid: JudgedFluid;
    a_charged_top: JudgedCharged;
    three_bodies_with_springs: JudgedSprings;
    three_elastic_frames: JudgedFrames;
    a_varying_inertia: JudgedVarying;
    unit_quaternions: JudgedQuaternion;
    different_groups: JudgedMixed;
    four_dimensions: JudgedFour;
    random_0: Judged0;
    random_1: Judged1;
    random_2: Judged2;
    random_3: Judged3;
    random_4: Judged4;
    random_5: Judged5;
    random_6: Judged6;
    random_7: Judged7;
    random_8: Judged8;
    random_9: Judged9;
}
