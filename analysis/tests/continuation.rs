//! Branches with known folds and branch points.

use crate::bodies::Body;
use crate::systems::Line;
use clebsch_analysis::{ContinuationError, Definiteness, End, Event, Track, continuation};
use nalgebra::Vector3;

#[test]
fn a_fold_turns_the_branch_back() {
    let fold = Line(|x: f64, p: f64| {
        Some([
            x.powi(3) / 3.0 + (p - 1.0) * x,
            x * x + p - 1.0,
            2.0 * x,
            1.0,
        ])
    });
    let branch = continuation(&fold, &0.9, &[], 0.0, 3.0, &Track::between(0.0, 3.0)).unwrap();
    assert_eq!(branch.end, End::Returned);
    let [special] = branch.specials.as_slice() else {
        panic!("{:?}", branch.specials)
    };
    assert!(special.event == Event::Fold && special.located);
    // The slope is zero where x is; x has an error of a few roundings over the step, and p its square.
    assert!(
        (special.at.p - 1.0).abs() < 1e-14 && special.at.state.abs() < 1e-8,
        "{special:?}"
    );
    assert!(
        branch
            .points
            .iter()
            .all(|point| (point.state.powi(2) + point.p - 1.0).abs() < 1e-12)
    );
    let last = branch.points.last().unwrap();
    assert!(
        last.p == 0.0 && (last.state + 1.0).abs() < 1e-14,
        "{last:?}"
    );
    assert_eq!(
        branch.points[0].variation.definiteness,
        Definiteness::Minimum
    );
    assert_eq!(last.variation.definiteness, Definiteness::Maximum);
    assert!(branch.points[0].slope > 0.0 && last.slope < 0.0);
}

#[test]
fn a_pitchfork_is_a_branch_point() {
    let fork = Line(|x: f64, p: f64| {
        Some([
            p * x * x / 2.0 + x.powi(4) / 4.0,
            p * x + x.powi(3),
            p + 3.0 * x * x,
            x,
        ])
    });
    // Along x = 0, the only eigenvalue is p.
    let branch = continuation(&fork, &0.0, &[], 1.0, -1.0, &Track::between(1.0, -1.0)).unwrap();
    assert_eq!(branch.end, End::Reached);
    let [special] = branch.specials.as_slice() else {
        panic!("{:?}", branch.specials)
    };
    assert!(
        special.event
            == Event::BranchPoint {
                before: 0,
                after: 1
            }
            && special.located
    );
    assert!(
        special.at.p.abs() < 1e-14 && special.at.state == 0.0,
        "{special:?}"
    );
    assert!(
        branch
            .points
            .last()
            .is_some_and(|last| last.p == -1.0 && last.state == 0.0)
    );
    // Along x^2 = -p, the branch turns at p = 0 without a change of stability.
    let branch = continuation(&fork, &1.0, &[], -1.0, 1.0, &Track::between(-1.0, 1.0)).unwrap();
    for x in &branch.points {
        println!(
            "{} {} {} {:?}",
            x.p, x.state, x.slope, x.variation.eigenvalues
        );
    }
    println!("{:?}", branch.specials);
    assert_eq!(branch.end, End::Returned);
    assert!(
        branch
            .specials
            .iter()
            .all(|special| special.event == Event::Fold && special.at.p.abs() < 1e-4)
    );
    assert!(
        branch.specials.len() == 1 && (branch.points.last().unwrap().state + 1.0).abs() < 1e-12
    );
}

#[test]
fn an_imperfect_pitchfork_has_no_branch_point() {
    let fork = Line(|x: f64, p: f64| Some([0.0, p * x + x.powi(3) - 0.1, p + 3.0 * x * x, x]));
    let branch = continuation(&fork, &0.1, &[], 1.0, -1.0, &Track::between(1.0, -1.0)).unwrap();
    assert!(
        branch.end == End::Reached && branch.specials.is_empty(),
        "{:?}",
        branch.specials
    );
    // The other branch has a fold at p = -3 (0.1 / 2)^(2/3).
    let branch = continuation(&fork, &-0.94, &[], -1.0, 1.0, &Track::between(-1.0, 1.0)).unwrap();
    assert!(branch.end == End::Returned && branch.specials.len() == 1);
    let truth = -3.0 * 0.05_f64.powf(2.0 / 3.0);
    assert!(
        (branch.specials[0].at.p - truth).abs() < 1e-12,
        "{:?}",
        branch.specials
    );
}

#[test]
fn long_steps_do_not_jump_to_a_near_branch() {
    // The branch turns sharply near p = 0, at a distance of about 0.1 from the other branch.
    let fork = Line(|x: f64, p: f64| Some([0.0, p * x + x.powi(3) - 1e-3, p + 3.0 * x * x, x]));
    let track = Track {
        first: 1.5,
        largest: 1.5,
        ..Track::between(1.0, -1.0)
    };
    let branch = continuation(&fork, &1e-3, &[], 1.0, -1.0, &track).unwrap();
    assert!(
        branch.end == End::Reached && branch.specials.is_empty(),
        "{:?}",
        branch.specials
    );
    assert!(
        branch
            .points
            .iter()
            .all(|point| point.state > 0.0 && point.slope < 0.0)
    );
    assert!(branch.points.last().unwrap().state > 0.99);
}

#[test]
fn long_steps_do_not_snap_through() {
    // x^3 - x = p has three branches for |p| < 2 / sqrt(27). The outer two are stable.
    let snap = Line(|x: f64, p: f64| Some([0.0, x.powi(3) - x - p, 3.0 * x * x - 1.0, -1.0]));
    for first in [0.1, 0.5, 1.0, 2.0] {
        let track = Track {
            first,
            largest: first,
            ..Track::between(-1.0, 1.0)
        };
        let branch = continuation(&snap, &-1.3, &[], -1.0, 1.0, &track).unwrap();
        assert_eq!(branch.end, End::Reached);
        let folds: Vec<f64> = branch.specials.iter().map(|special| special.at.p).collect();
        let truth = 2.0 / 27.0_f64.sqrt();
        assert!(folds.len() == 2, "{first}: {folds:?}");
        assert!(
            (folds[0] - truth).abs() < 1e-13 && (folds[1] + truth).abs() < 1e-13,
            "{folds:?}"
        );
        assert!(
            branch
                .specials
                .iter()
                .all(|special| special.event == Event::Fold && special.located)
        );
    }
}

#[test]
fn an_axis_of_inertia_loses_its_place() {
    // The second axis is the middle one for p > 1, and the shortest for p < 1.
    let body = Body {
        inertia: [1.0, 0.0, 3.0],
        symmetric: false,
    };
    let branch = continuation(
        &body,
        &Vector3::y(),
        &[0.5],
        2.0,
        0.5,
        &Track::between(2.0, 0.5),
    )
    .unwrap();
    assert_eq!(branch.end, End::Reached);
    let [special] = branch.specials.as_slice() else {
        panic!("{:?}", branch.specials)
    };
    assert!(
        special.event
            == Event::BranchPoint {
                before: 1,
                after: 2
            }
            && special.located
    );
    assert!((special.at.p - 1.0).abs() < 1e-13, "{special:?}");
    let verdicts: Vec<Definiteness> = [0, branch.points.len() - 1]
        .map(|i| branch.points[i].variation.definiteness)
        .to_vec();
    assert_eq!(
        verdicts,
        [
            Definiteness::Saddle {
                negative: 1,
                positive: 1
            },
            Definiteness::Maximum
        ]
    );
}

#[test]
fn a_branch_that_ends_is_named() {
    let ends = Line(|x: f64, p: f64| (p < 0.5).then_some([0.0, x - p, 1.0, -1.0]));
    let error = continuation(&ends, &0.0, &[], 0.0, 1.0, &Track::between(0.0, 1.0)).unwrap_err();
    assert!(
        matches!(error, ContinuationError::Stalled { p, .. } if p > 0.499_999 && p < 0.5),
        "{error}"
    );
    let none = Line(|x: f64, _: f64| Some([x.exp(), x.exp(), x.exp(), 0.0]));
    let mut track = Track::between(0.0, 1.0);
    track.search.iterations = 5;
    let error = continuation(&none, &0.0, &[], 0.0, 1.0, &track).unwrap_err();
    assert!(matches!(error, ContinuationError::Start(_)), "{error}");
}
