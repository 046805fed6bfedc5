//! Tests every model of the gallery through its card alone: invariants over a million steps (a hundred thousand for large models),
//! energies without drift, and the order of accuracy. A new gallery model needs no change here. Separate tests check that wrong
//! trajectories and a first-order model fail.

use clebsch::card::{Card, Conserved, Field, OpenError, Settings, Trajectory};
use clebsch_models::Case;
use clebsch_oracle::physics::drift_detection::trend;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::order::orders;
use rand_xoshiro::Xoshiro256StarStar;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

const MILLION: u64 = 1_000_000;

/// Tolerance for exactly conserved quantities, which drift by rounding only: a random walk of a million steps of 1e-16 reaches
/// 1e-13, and the margin is a factor of ten.
const EXACT: f64 = 1e-12;

/// Tolerance for implicit steps. The unsolved residual, a few rounding errors, can have a systematic sign: 1e-17 of an energy in
/// each of a million steps is not a property of the scheme.
const LEFT_BY_SOLVERS: f64 = 1e-11;

/// Largest change of a mean, relative to the amplitude, in a case that is not the first of its model. Chaotic motions wander on the
/// energy surface for much of a million steps. The limit for the first case is five percent.
const WANDER: f64 = 0.25;

/// Motions whose speed, and therefore energy error, grows without bound until the step size is too large. Here the test checks
/// exact invariants only, over the number of steps of the case.
const UNBOUNDED: [(&str, &str); 1] = [("kirchhoff-body", "sinking")];

/// Steady motions: the h^2 term of the oscillation is constant along the orbit, so the h^4 term remains.
const STEADY: [(&str, &str); 1] = [("kepler", "circular")];

/// With more configuration entries than this, a case runs a tenth of the million steps. This applies to the free body in five or
/// more dimensions, whose steps take up to a hundred times as long as in three.
const LARGE: usize = 16;

/// A fault in a trajectory, which the tests must detect.
#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    /// Every invariant grows per step by this fraction of its scale.
    Growth(f64),
}

type Opened = Result<Box<dyn Trajectory>, OpenError>;

fn open(card: &Card, case: &Case, h: f64) -> Box<dyn Trajectory> {
    let opened: Opened = (card.open)(&case.parameters, &case.initial, Settings::step(h));
    opened.unwrap_or_else(|why| panic!("{} {}: {why}", card.kebab, case.name))
}

/// One component of an invariant.
struct Component {
    name: &'static str,
    conserved: Conserved,
    /// Largest |I_k - I_0| relative to the natural scale.
    drift: f64,
    /// (I_k - I_0) relative to the scale at every sampled node; empty for exact invariants.
    series: Vec<f64>,
}

/// Whether a long run samples this step. Sampling costs more than stepping, so a long run samples one step in eight. Equal gaps
/// would alias with the periods of a regular motion and show a false drift. The sampled steps are therefore pseudo-random, and the
/// same in every run.
fn is_looked_at(step: u64) -> bool {
    Xoshiro256StarStar::seed_from_u64(step).next_u64() >> 61 == 0
}

/// Runs a case and samples every invariant at every step; long runs sample one step in eight.
fn components(card: &Card, case: &Case, h: f64, steps: u64, fault: Fault) -> Vec<Component> {
    let mut motion = open(card, case, h);
    let count = card.invariant_count();
    let (mut start, mut scales, mut here) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
    let (mut now, mut grown) = (vec![0.0; card.observable_count()], vec![0.0; count]);
    motion.observe(&mut now);
    let extent = largest(&now);
    motion.invariants(&mut start);
    motion.scales(&mut scales);
    // If every term of an invariant is zero, such as the momentum transverse to an absent field, use the absolute error.
    for scale in scales.iter_mut().filter(|scale| **scale == 0.0) {
        *scale = 1.0;
    }
    let mut found: Vec<Component> = card
        .invariants
        .iter()
        .flat_map(|i| {
            (0..i.rows).map(|_| Component {
                name: i.name,
                conserved: i.conserved,
                drift: 0.0,
                series: Vec::new(),
            })
        })
        .collect();
    for step in 1..=steps {
        motion
            .step()
            .unwrap_or_else(|why| panic!("{} {}: {why}", card.kebab, case.name));
        if steps >= MILLION / 10 && !is_looked_at(step) {
            continue;
        }
        motion.invariants(&mut here);
        for (i, component) in found.iter_mut().enumerate() {
            let mut off = (here[i] - start[i]) / scales[i];
            if component.conserved == Conserved::Exactly && off.abs() > component.drift {
                // Rounding error scales with the terms of an invariant, and these can grow. For a translating body x cross p grows:
                // a million steps move it ten thousand lengths. A pulsating body that starts nearly at rest reaches a hundred times
                // its initial momentum.
                motion.observe(&mut now);
                motion.scales(&mut grown);
                let grown = worse(grown[i], scales[i] * (largest(&now) / extent).max(1.0));
                off = (here[i] - start[i]) / grown;
            }
            if let Fault::Growth(share) = fault {
                off += share * step as f64;
            }
            component.drift = worse(component.drift, off.abs());
            if component.conserved == Conserved::Boundedly {
                component.series.push(off);
            }
        }
    }
    found
}

/// The largest absolute value.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |m: f64, x| worse(m, x.abs()))
}

/// Whether an oscillating series has no drift.
fn stays(series: &[f64], regular: bool) -> bool {
    let trend = trend(series);
    let wanders = trend.significance <= 3.0 && trend.change.abs() <= WANDER * trend.amplitude;
    trend.is_flat() || (!regular && wanders)
}

/// Adds a straight line to the series that ends at this fraction of the amplitude.
fn leaning(series: &[f64], share: f64) -> Vec<f64> {
    let slope = share * trend(series).amplitude / series.len() as f64;
    let line = (0..series.len()).map(|k| slope * k as f64);
    series.iter().zip(line).map(|(x, y)| x + y).collect()
}

/// Neighbours of a chaotic motion. By chance, about one in ten runs with forty components exceeds three standard errors.
const NEIGHBOURS: u32 = 8;

/// Whether a component of a chaotic motion shows no drift over neighbours of the case, which diverge completely in a million steps.
/// Their mean change must be within three standard errors of zero, estimated from their own spread.
fn stays_among_neighbours(
    card: &Card,
    case: &Case,
    place: usize,
    steps: u64,
    fault: Fault,
) -> bool {
    let trends: Vec<_> = (1..=NEIGHBOURS)
        .map(|k| {
            let mut near = case.clone();
            for value in near.initial.iter_mut().skip(1).step_by(2).flatten() {
                *value *= 1.0 + 1e-9 * f64::from(k);
            }
            trend(&components(card, &near, case.h, steps, fault)[place].series)
        })
        .collect();
    let count = f64::from(NEIGHBOURS);
    let mean = trends.iter().map(|t| t.change).sum::<f64>() / count;
    let spread = trends
        .iter()
        .map(|t| (t.change - mean).powi(2))
        .sum::<f64>()
        / (count - 1.0);
    let amplitude = trends.iter().fold(0.0_f64, |m, t| worse(m, t.amplitude));
    println!("mean change {mean:e}, error {:e}", (spread / count).sqrt());
    mean.abs() <= 3.0 * (spread / count).sqrt() && mean.abs() <= WANDER * amplitude
}

/// Components that violate the card, each with the measured value.
fn failures(card: &Card, case: &Case, regular: bool, steps: u64, fault: Fault) -> Vec<String> {
    let mut bad = Vec::new();
    let all = components(card, case, case.h, steps, fault).into_iter();
    for (place, component) in all.enumerate() {
        let title = format!("{} {}: {}", card.kebab, case.name, component.name);
        let drift = component.drift;
        match component.conserved {
            Conserved::Exactly if drift >= EXACT => {
                bad.push(format!("{title} drifts by {drift:e}"))
            }
            Conserved::Boundedly if drift >= LEFT_BY_SOLVERS => {
                let series = component.series;
                println!("{title} {:?}", trend(&series));
                let stayed = stays(&series, regular)
                    || (!regular && stays_among_neighbours(card, case, place, steps, fault));
                if !stayed {
                    bad.push(format!("{title} {:?}", trend(&series)));
                } else if stays(&leaning(&series, 2.0), regular) {
                    bad.push(format!("{title}: a drift of its own size would pass"));
                }
            }
            _ => {}
        }
    }
    bad
}

/// Visits the cases of all models; the flag marks the first case of a model.
fn for_every_case(mut look: impl FnMut(&Card, &Case, bool)) {
    for entry in clebsch_models::gallery() {
        for (place, case) in entry.cases.iter().enumerate() {
            look(&entry.card_of(case), case, place == 0);
        }
    }
}

/// Slow: every case of the gallery takes a million steps.
#[test]
fn invariants_over_a_million_steps() {
    let mut bad = Vec::new();
    for_every_case(|card, case, first| {
        if !UNBOUNDED.contains(&(card.kebab, &case.name)) {
            let largest = card.initial.iter().map(Field::count).max();
            let large = largest.is_some_and(|entries| entries > LARGE);
            let steps = if large { MILLION / 10 } else { MILLION };
            bad.extend(failures(card, case, first, steps, Fault::None));
            return;
        }
        for component in components(card, case, case.h, case.steps, Fault::None) {
            let drift = component.drift;
            if component.conserved == Conserved::Exactly && drift >= EXACT {
                let name = component.name;
                bad.push(format!(
                    "{} {}: {name} drifts by {drift:e}",
                    card.kebab, case.name
                ));
            }
        }
    });
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn growth_is_noticed() {
    for_every_case(|card, case, _| {
        // In an exact invariant, a growth of 1e-14 per step is visible after a thousand steps. A bounded energy must grow by its
        // own oscillation, at most a few percent of its scale.
        let bad = failures(card, case, false, 2_000, Fault::Growth(1e-4));
        let all = card.invariant_count();
        assert_eq!(bad.len(), all, "{} {}: {bad:?}", card.kebab, case.name);
        let exact = card.invariants.iter();
        let exact = exact.filter(|i| i.conserved == Conserved::Exactly);
        let exact: usize = exact.map(|i| i.rows).sum();
        let bad = failures(card, case, false, 2_000, Fault::Growth(1e-14));
        assert!(bad.len() >= exact, "{} {}: {bad:?}", card.kebab, case.name);
    });
}

#[test]
fn energies_oscillate_with_the_square_of_the_step() {
    for_every_case(|card, case, _| {
        let [coarse, fine] = [1_u32, 2].map(|n| {
            let h = case.h / f64::from(4 * n);
            components(card, case, h, u64::from(400 * n), Fault::None)
        });
        for (a, b) in coarse.iter().zip(&fine) {
            if a.conserved == Conserved::Exactly || a.drift < EXACT {
                continue;
            }
            let ratio = a.drift / b.drift;
            println!("{} {}: {} {ratio:.3}", card.kebab, case.name, a.name);
            let order = match STEADY.contains(&(card.kebab, &case.name)) {
                true => 4,
                false => 2,
            };
            // Terms two orders higher and the sampling of the maximum contribute a few percent.
            let expected = f64::from(1 << order);
            assert!(
                (ratio / expected - 1.0).abs() < 0.1,
                "{} {}: {} {ratio}",
                card.kebab,
                case.name,
                a.name
            );
        }
    });
}

/// Differences of all observables at a fixed time between successive step halvings.
fn differences(card: &Card, case: &Case) -> Vec<f64> {
    let runs: Vec<Vec<f64>> = (0..5)
        .map(|k| {
            let halvings = f64::from(1 << k);
            let mut motion = open(card, case, case.h / halvings);
            for _ in 0..20_u64 << k {
                motion
                    .step()
                    .unwrap_or_else(|why| panic!("{} {}: {why}", card.kebab, case.name));
            }
            let mut seen = vec![0.0; card.observable_count()];
            motion.observe(&mut seen);
            seen
        })
        .collect();
    runs.windows(2)
        .map(|pair| {
            let off = pair[0].iter().zip(&pair[1]).map(|(a, b)| (a - b).abs());
            off.fold(0.0, worse)
        })
        .collect()
}

/// Whether the two finest halvings show the order to within 0.05, well above rounding.
fn has_order(card: &Card, case: &Case, order: f64) -> bool {
    let differences = differences(card, case);
    let measured = orders(&differences);
    println!("{} {}: {measured:.4?}", card.kebab, case.name);
    differences.iter().all(|d| *d > 1e-11)
        && measured
            .iter()
            .rev()
            .take(2)
            .all(|o| (o - order).abs() < 0.05)
}

#[test]
fn orders_are_those_of_the_cards() {
    for_every_case(|card, case, _| {
        // As h tends to 0, the velocity tends to the rotation in the left factor instead of the identity, so no small-step limit
        // exists.
        if (card.kebab, case.name.as_str()) == ("body-n", "turned") {
            return;
        }
        // If a step is not known to be reversible, it has at least the order on its card.
        let last = orders(&differences(card, case)).pop();
        let unexpected = !card.reversible && last.is_some_and(|o| o > f64::from(card.order) - 0.05);
        assert!(
            unexpected || has_order(card, case, f64::from(card.order)),
            "{} {}: {:?}",
            card.kebab,
            case.name,
            differences(card, case)
        );
    });
}

clebsch::model! {
    /// The heavy top with the whole potential at the head of each edge.
    model OneSidedTop {
        param J: Sym<3>;
        param gU: Vec<3>;
        param z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T * z;
        constraint next(Λ) = Λ * Ω;
        constraint next(Γ) = Ω^T * Γ;
        node incoming;
        lagrangian = -tr(J * Ω) / h - h * dot(gU, Γ);
    }
}

#[test]
fn the_order_of_a_one_sided_top_is_seen_to_be_one() {
    let entry = clebsch_models::find("heavy-top").expect("a model of the gallery");
    for case in &entry.cases {
        assert!(!has_order(&OneSidedTop::CARD, case, 2.0));
        // Second-order errors are still visible next to first-order errors.
        let last = orders(&differences(&OneSidedTop::CARD, case)).pop();
        assert!(last.is_some_and(|o| (o - 1.0).abs() < 0.1), "{last:?}");
    }
}
