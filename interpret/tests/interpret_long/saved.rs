//! Trajectories of the whole gallery, compiled and interpreted, are saved in the middle and restored. They then equal
//! uninterrupted trajectories bit for bit, for every order.

use clebsch::card::{Card, Settings, Trajectory};
use clebsch::saved::Words;
use clebsch_models::{Case, Entry, gallery};
use std::sync::atomic::{AtomicUsize, Ordering};

/// Steps before and after.
const STEPS: u64 = 150;

fn bits(trajectory: &dyn Trajectory) -> Vec<u64> {
    let card = trajectory.card();
    let mut all = vec![0.0; card.observable_count() + 2 * card.invariant_count()];
    let (seen, rest) = all.split_at_mut(card.observable_count());
    let (invariants, scales) = rest.split_at_mut(card.invariant_count());
    trajectory.observe(seen);
    trajectory.invariants(invariants);
    trajectory.scales(scales);
    let mut bits: Vec<u64> = all.into_iter().map(f64::to_bits).collect();
    bits.push(trajectory.node());
    bits
}

fn steps(trajectory: &mut dyn Trajectory) -> bool {
    (0..STEPS).all(|_| trajectory.step().is_ok())
}

/// Whether the trajectory reached this node; if so, it must be the same.
fn goes_on_alike(card: &Card, case: &Case, settings: Settings) -> bool {
    let open = || (card.open)(&case.parameters, &case.initial, settings);
    let (Ok(mut whole), Ok(mut again)) = (open(), open()) else {
        return false;
    };
    if !steps(whole.as_mut()) {
        return false;
    }
    let what = format!("{} {} {settings:?}", card.kebab, case.name);
    let mut words = Words::gathered();
    whole.words(&mut words);
    let Some(list) = words.into_list() else {
        panic!("{what}: cannot be written down");
    };
    // One word too few or too many is an error.
    for other in [&list[1..], &[list.as_slice(), &[0]].concat()] {
        let mut words = Words::given(other.to_vec());
        again.words(&mut words);
        assert!(!words.all_put(), "{what}");
    }
    let Ok(mut again) = open() else { return false };
    let mut words = Words::given(list);
    again.words(&mut words);
    assert!(words.all_put(), "{what}");
    assert_eq!(bits(whole.as_ref()), bits(again.as_ref()), "{what}");
    for _ in 0..STEPS {
        let (one, other) = (whole.step(), again.step());
        assert_eq!(format!("{one:?}"), format!("{other:?}"), "{what}");
        assert_eq!(bits(whole.as_ref()), bits(again.as_ref()), "{what}");
        if one.is_err() {
            break;
        }
    }
    true
}

fn entry_goes_on_alike(entry: &Entry) {
    let read = match clebsch_interpret::card(entry.card.source) {
        Ok(card) => card,
        Err(refused) => panic!("{}: {refused}", entry.card.name),
    };
    let mut followed = 0;
    for case in &entry.cases {
        let built = entry.card_of(case);
        let sizes: Vec<usize> = built.dimensions.iter().map(|d| d.value).collect();
        let Some(read) = (read.sized)(&sizes) else {
            panic!("{} {sizes:?}", read.name);
        };
        for card in [&built, &read] {
            let plain = Settings::step(case.h);
            let mut ways = vec![plain];
            ways.extend(card.orders.iter().map(|order| plain.of_order(*order)));
            ways.push(Settings {
                compensated: true,
                ..plain.of_order(6)
            });
            ways.extend(clebsch::solvers::Method::ALL.map(|method| Settings {
                solver: Some(method),
                ..plain
            }));
            followed += ways
                .into_iter()
                .filter(|way| goes_on_alike(card, case, *way))
                .count();
        }
    }
    println!("{}: {followed} ways", entry.card.kebab);
    assert!(followed >= 2 * entry.cases.len(), "{}", entry.card.kebab);
}

/// Slow: runs the whole gallery with every order, compiled and from texts. It uses two threads, since the test
/// machines have two cores and no other test runs at the same time.
#[test]
fn every_trajectory_goes_on_as_if_it_had_not_been_written_down() {
    let (next, entries) = (AtomicUsize::new(0), gallery());
    let work = || {
        while let Some(entry) = entries.get(next.fetch_add(1, Ordering::Relaxed)) {
            entry_goes_on_alike(entry);
        }
    };
    std::thread::scope(|scope| {
        scope.spawn(work);
        work();
    });
    assert!(next.into_inner() >= entries.len());
}
