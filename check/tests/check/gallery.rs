//! Every model and case of the gallery is judged to be within its bound, step by step, and a wrong number is
//! detected.

use clebsch::card::{Card, Field, Kind, Settings};
use clebsch_check::{Judge, Judged, Setup, Stated, Verdict};
use clebsch_core::pipeline::parse_source;
use clebsch_models::{Case, gallery};
use std::sync::Arc;

/// The number of steps of each case.
const STEPS: u64 = 12;

/// The number of steps in longer runs of this test.
fn steps() -> u64 {
    let asked = std::env::var("CLEBSCH_CHECK_STEPS").ok();
    asked.and_then(|n| n.parse().ok()).unwrap_or(STEPS)
}

fn judge(card: &Card, case: &Case) -> Result<Judge, String> {
    let model = parse_source(card.source).map_err(|e| e.render(card.source, card.name))?;
    let sizes = card.dimensions.iter().map(|d| (d.name.to_owned(), d.value));
    let sizes: Vec<_> = sizes.collect();
    let fields = card.parameters.iter().map(|f| (f.name, f.rows, f.cols));
    let parameters = fields.zip(case.parameters.iter().map(Vec::as_slice));
    let observables = card.observables.iter().map(|f| (f.name, f.rows, f.cols));
    let stated = Arc::new(Stated::read(&model, &sizes)?);
    Judge::new(stated, Setup::new(case.h, parameters, observables))
}

/// The nodes of a few steps.
fn nodes(card: &Card, case: &Case) -> Vec<Vec<f64>> {
    let settings = Settings::step(case.h);
    let mut trajectory =
        (card.open)(&case.parameters, &case.initial, settings).expect("the case opens");
    let mut out = Vec::new();
    for _ in 0..=steps().min(case.steps) {
        let mut here = vec![0.0; card.observable_count()];
        trajectory.observe(&mut here);
        out.push(here);
        trajectory.step().expect("a step");
    }
    out
}

fn of_all(mut what: impl FnMut(&Card, &Case, &Judge, &[Vec<f64>])) {
    for entry in gallery() {
        for case in &entry.cases {
            let card = entry.card_of(case);
            let judge =
                judge(&card, case).unwrap_or_else(|e| panic!("{} {}: {e}", card.name, case.name));
            what(&card, case, &judge, &nodes(&card, case));
        }
    }
}

fn step(judge: &Judge, number: u64, both: &[Vec<f64>]) -> Judged {
    judge.step(number, &both[0], &both[1]).expect("judged")
}

#[test]
fn steps_of_the_gallery_hold() {
    let mut wrong = Vec::new();
    of_all(|card, case, judge, nodes| {
        let mut worst = 0.0;
        let mut told = String::new();
        for (k, both) in nodes.windows(2).enumerate() {
            let judged = step(judge, k as u64 + 1, both);
            let part = judged.worst.expect("equations");
            if part.ratio() > worst || part.ratio().is_nan() {
                worst = part.ratio();
                told = format!("{part:?}");
            }
        }
        println!(
            "{:22} {:20} {worst:.3} {}",
            card.name,
            case.name,
            if worst > 0.5 { &told } else { "" }
        );
        if worst > 1.0 || worst.is_nan() {
            wrong.push(format!("{} {}: {worst} {told}", card.name, case.name));
        }
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// A relative change of a millionth, of a number or of its neighbours.
const WRONG: f64 = 1e-6;

/// The observables that start a run, by position: elements, momenta on the stated side, advected quantities.
fn of_the_state(card: &Card) -> Vec<(Field, usize)> {
    let mut from = 0;
    let mut out = Vec::new();
    for field in card.observables {
        if card.initial.iter().any(|f| f.name == field.name) {
            out.push((*field, from));
        }
        from += field.count();
    }
    out
}

/// The numbers of a field after a rotation or after a change of one coordinate; `None` beyond its coordinates.
fn changed(field: &Field, own: &[f64], which: usize) -> Option<Vec<f64>> {
    let mut out = own.to_vec();
    let (n, size) = (field.rows, own.iter().fold(0.0, |a: f64, x| a.max(x.abs())));
    let mut turn = |n: usize, rows: usize| {
        let pairs: Vec<_> = (0..n)
            .flat_map(|i| (i + 1..n).map(move |j| (i, j)))
            .collect();
        let (i, j) = *pairs.get(which)?;
        for row in 0..rows {
            let (a, b) = (own[row * field.cols + i], own[row * field.cols + j]);
            out[row * field.cols + i] = a * WRONG.cos() + b * WRONG.sin();
            out[row * field.cols + j] = b * WRONG.cos() - a * WRONG.sin();
        }
        Some(())
    };
    match field.kind {
        Kind::Rotation => turn(n, n)?,
        Kind::UnitQuaternion => {
            // Multiplied by cos + sin of a unit quaternion of direction `which`.
            let unit = [[-1, 0, 3, -2], [-2, -3, 0, 1], [-3, 2, -1, 0]].get(which)?;
            let (cosine, sine) = ((WRONG / 2.0).cos(), (WRONG / 2.0).sin());
            let moved = [
                -own[which + 1],
                signed(own, unit[1]) + f64::from(u8::from(which == 0)) * own[0],
                signed(own, unit[2]) + f64::from(u8::from(which == 1)) * own[0],
                signed(own, unit[3]) + f64::from(u8::from(which == 2)) * own[0],
            ];
            out.iter_mut()
                .zip(moved)
                .for_each(|(x, m)| *x = *x * cosine + m * sine);
        }
        Kind::RigidMotion if which < 3 => turn(3, 3)?,
        Kind::RigidMotion => {
            *out.get_mut((which - 3) * 4 + 3).filter(|_| which < 6)? += WRONG * (1.0 + size)
        }
        // A momentum of rotations is skew.
        Kind::BodyMomentum | Kind::SpatialMomentum if is_skew(field, own) => {
            let mut all = (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j)));
            let (i, j) = all.nth(which)?;
            out[i * n + j] += WRONG * size;
            out[j * n + i] -= WRONG * size;
        }
        _ => {
            let x = out.get_mut(which)?;
            *x += WRONG * if *x == 0.0 { size.max(1.0) } else { *x };
        }
    }
    Some(out)
}

fn is_skew(field: &Field, own: &[f64]) -> bool {
    let n = field.rows;
    let opposite = |i: usize, j: usize| (own[i * n + j] + own[j * n + i]).abs() < 1e-12;
    field.cols == n && n > 1 && (0..n * n).all(|k| opposite(k / n, k % n))
}

/// The component with this number, counted from 1, with the sign of the number; zero for the number zero.
fn signed(own: &[f64], which: i32) -> f64 {
    match usize::try_from(which.abs()) {
        Ok(0) | Err(_) => 0.0,
        Ok(i) => own[i] * f64::from(which.signum()),
    }
}

#[test]
fn every_number_of_a_state_that_is_wrong_is_seen() {
    of_all(|card, case, judge, nodes| {
        for (field, from) in of_the_state(card) {
            let to = from + field.count();
            for end in [0, 1] {
                for which in 0..field.count() {
                    let mut both = nodes[3..5].to_vec();
                    let Some(numbers) = changed(&field, &both[end][from..to], which) else {
                        break;
                    };
                    both[end][from..to].copy_from_slice(&numbers);
                    let part = step(judge, 4, &both).worst.expect("equations");
                    let named = (card.name, &case.name, field.name, which, end);
                    assert!(part.ratio() > 1.0, "{named:?}: {part:?}");
                    assert!(
                        !part.what.starts_with("orthonormality"),
                        "{named:?}: {part:?}"
                    );
                }
            }
        }
    });
}

/// A constant that an equation may lose: `dot(vee(O), vee(O))` is (3 - tr(O^2))/4, and a number multiplied by it depends on the 3.
#[test]
fn a_step_of_a_wrong_equation_is_told() {
    let text = "model Spun {
        param m: Real;
        param J: Sym<3>;
        field q: Real;
        group R: SO<3> velocity O;
        constraint next(R) = R*O;
        lagrangian = m*(next(q) - q)^2/(2*h) - tr(J*O)/h + (h/2)*q*dot(vee(O), vee(O))/h^2;
    }";
    let model = parse_source(text).expect("reads");
    let unit = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let parameters = [(("m", 1, 1), &[1.3][..]), (("J", 3, 3), &unit[..])];
    let observables = [
        ("q", 1, 1),
        ("momentum_q", 1, 1),
        ("R", 3, 3),
        ("body_momentum_R", 3, 1),
    ];
    let setup = Setup::new(0.1, parameters.into_iter(), observables.into_iter());
    let stated = Arc::new(Stated::read(&model, &[]).expect("is read"));
    let judge = Judge::new(stated, setup).expect("is judged");
    let node = |q: f64, p: f64| {
        let mut out = vec![q, p];
        out.extend(unit);
        out.extend([0.0; 3]);
        out
    };
    let p = 1.3 * 0.001 / 0.1;
    let right = judge
        .step(1, &node(0.0, p), &node(0.001, p))
        .expect("judged");
    assert!(right.worst.expect("equations").ratio() <= 1.0);
    let wrong = judge
        .step(1, &node(0.0, p), &node(0.25, p))
        .expect("judged");
    let mut verdict = Verdict::default();
    verdict.take(1, Ok(wrong));
    let said = verdict.to_string();
    assert!(verdict.is_broken() && !verdict.holds(), "{said}");
    assert!(
        said.contains("does NOT hold") && said.contains("momentum of q"),
        "{said}"
    );
    assert_eq!(Verdict::of_numbers(&verdict.numbers()).to_string(), said);
}

/// If the residuals of a check are far below rounding, the check is not independent of the stepper.
#[test]
fn residuals_far_below_rounding_are_a_failure() {
    let mut verdict = Verdict::default();
    let judged = |tested, roundings| {
        Ok(Judged {
            worst: None,
            tested,
            roundings,
        })
    };
    verdict.take(1, judged(30, 1e-4));
    assert!(verdict.is_empty() && !verdict.holds());
    verdict.take(2, judged(30, 0.4));
    assert!(!verdict.is_empty() && verdict.holds());
    let mut at_rest = Verdict::default();
    at_rest.take(1, judged(0, 0.0));
    assert!(at_rest.holds());
}

/// A pendulum with a driven support. One of its steps is typed by hand, with an advancing clock and with a clock that
/// does not advance.
#[test]
fn a_clock_that_stands_still_is_told() {
    let text = "model Driven {
        param m: Real;
        field q: Real;
        advected t: Real;
        constraint next(t) = t + h;
        lagrangian = m*(next(q) - q)^2/(2*h) + h*(1 + sin(t))*cos(q);
    }";
    let model = parse_source(text).expect("reads");
    let parameters = [(("m", 1, 1), &[1.3][..])];
    let observables = [("q", 1, 1), ("momentum", 1, 1), ("t", 1, 1)];
    let (m, h) = (1.3_f64, 0.1_f64);
    let setup = Setup::new(h, parameters.into_iter(), observables.into_iter());
    let stated = Arc::new(Stated::read(&model, &[]).expect("is read"));
    let judge = Judge::new(stated, setup).expect("is judged");
    let force = |q: f64, t: f64| -(1.0 + t.sin()) * q.sin();
    let judged = |later: f64| {
        let (q, p, t) = (0.3, 0.4, 0.7);
        let middle = p + h / 2.0 * force(q, t);
        let end = q + h * middle / m;
        let after = middle + h / 2.0 * force(end, later);
        let judged = judge.step(1, &[q, p, t], &[end, after, later]);
        judged.expect("judged").worst.expect("equations")
    };
    assert!(judged(0.7 + h).ratio() <= 1.0);
    let still = judged(0.7);
    assert!(still.ratio() > 1.0 && still.what == "t", "{still:?}");
}
