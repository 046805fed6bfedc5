//! Every model of the gallery, known by its card alone: what it conserves over a million steps (large ones a hundred
//! thousand), energies without drift, and its order. Takes the cases of the gallery; a model added there is tested here
//! without a word about it. Wrong trajectories and a model of first order fail, which is shown too.

use clebsch::card::{Card, Conserved, Field, OpenError, Settings, Trajectory};
use clebsch_models::Case;
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::physics::order::orders;
use clebsch_oracle::physics::trend::trend;
use rand_xoshiro::Xoshiro256StarStar;
use rand_xoshiro::rand_core::{Rng, SeedableRng};

const MILLION: u64 = 1_000_000;

/// What is conserved exactly drifts by rounding only: 1e-16 a step that adds up like a random walk of a million
/// steps to 1e-13, with a margin of ten.
const EXACT: f64 = 1e-12;

/// What an implicit step leaves unsolved, some roundings, may have one sign: 1e-17 of an energy at each of a million
/// steps is no property of the scheme.
const LEFT_BY_SOLVERS: f64 = 1e-11;

/// Largest change of a mean, over the amplitude, in a case that is not the first of its model: chaotic motions wander on
/// their energy surface for a good part of a million steps. The first case keeps to five percent.
const WANDER: f64 = 0.25;

/// Motions that gain speed without end, and with it an error of their energy, until the step is too long for them: what
/// is exact is looked at over the steps of the case.
const UNBOUNDED: [(&str, &str); 1] = [("kirchhoff-body", "sinking")];

/// Steady motions, for which what oscillates with h^2 is constant along the orbit: h^4 is left.
const STEADY: [(&str, &str); 1] = [("kepler", "circular")];

/// Entries of a configuration above which a case is run for a tenth of the million steps: a free body in five dimensions
/// and more, whose steps take up to a hundred times as long as in three.
const LARGE: usize = 16;

/// Something wrong with a trajectory, to show that it is noticed.
#[derive(Clone, Copy, PartialEq)]
enum Fault {
    None,
    /// Every invariant grows by this share of its scale a step.
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
    /// Largest |I_k - I_0| over the natural scale.
    drift: f64,
    /// (I_k - I_0) over the scale at every node; empty for what is exact.
    series: Vec<f64>,
}

/// Whether a long run is looked at after this step: after one of eight on average, as looking takes longer than
/// stepping. Equal gaps would beat against the periods of a regular motion and show a drift that is none, so the steps
/// are drawn at random, the same ones in every run.
fn is_looked_at(step: u64) -> bool {
    Xoshiro256StarStar::seed_from_u64(step).next_u64() >> 61 == 0
}

/// Runs a case and looks at every invariant at every step, in long runs at one of eight.
fn components(card: &Card, case: &Case, h: f64, steps: u64, fault: Fault) -> Vec<Component> {
    let mut motion = open(card, case, h);
    let count = card.invariant_count();
    let (mut start, mut scales, mut here) = (vec![0.0; count], vec![0.0; count], vec![0.0; count]);
    let (mut now, mut grown) = (vec![0.0; card.observable_count()], vec![0.0; count]);
    motion.observe(&mut now);
    let extent = largest(&now);
    motion.invariants(&mut start);
    motion.scales(&mut scales);
    // What is zero term by term, as the momentum across a field that is not there, is taken as it is.
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
                // Rounding is that of the terms an invariant is made of, which may grow on the way: a body that
                // travels has x cross p among them, and a million steps take it ten thousand lengths away; one that
                // starts nearly at rest and pulses has momenta a hundred times those of its start.
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

/// The largest of some numbers.
fn largest(numbers: &[f64]) -> f64 {
    numbers.iter().fold(0.0, |m: f64, x| worse(m, x.abs()))
}

/// Whether a series that should oscillate does so without a drift.
fn stays(series: &[f64], regular: bool) -> bool {
    let trend = trend(series);
    let wanders = trend.significance <= 3.0 && trend.change.abs() <= WANDER * trend.amplitude;
    trend.is_flat() || (!regular && wanders)
}

/// The series with a straight line added that ends at this share of the amplitude.
fn leaning(series: &[f64], share: f64) -> Vec<f64> {
    let slope = share * trend(series).amplitude / series.len() as f64;
    let line = (0..series.len()).map(|k| slope * k as f64);
    series.iter().zip(line).map(|(x, y)| x + y).collect()
}

/// Neighbours of a chaotic motion: one in ten of forty components leaves three standard errors by chance.
const NEIGHBOURS: u32 = 8;

/// Whether a component of a chaotic motion shows no drift over neighbours of the case, which a million steps part
/// entirely: their mean change is within three standard errors of zero, found from their own spread.
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

/// Components that are not kept as the card says, each with what was measured.
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

/// The cases of all models; whether each is the first of its model.
fn for_every_case(mut look: impl FnMut(&Card, &Case, bool)) {
    for entry in clebsch_models::gallery() {
        for (place, case) in entry.cases.iter().enumerate() {
            look(&entry.card_of(case), case, place == 0);
        }
    }
}

/// Long, since every case of the gallery takes a million steps.
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
        // 1e-14 a step is seen after a thousand steps in what is exact; an energy must grow by its own oscillation,
        // which is at most a few percent of its scale.
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
            // Terms two orders higher and the sampling of the maximum are a few percent of it.
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

/// Differences of all observables at a fixed time between neighbours in a sequence of halved steps.
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

/// Whether the finest two halvings show the order to 0.05, far above rounding.
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
        // The velocity tends to the rotation in the left factor, not to the identity: no limit of small steps.
        if (card.kebab, case.name.as_str()) == ("body-n", "turned") {
            return;
        }
        // A step that has not been shown to be reversible has at least the order of its card.
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
        // Errors of second order are still to be seen beside those of the first.
        let last = orders(&differences(&OneSidedTop::CARD, case)).pop();
        assert!(last.is_some_and(|o| (o - 1.0).abs() < 0.1), "{last:?}");
    }
}
