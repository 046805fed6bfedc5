//! Gallery models interpreted from their texts, with native code from the third step on, against the compiled models: steps,
//! observables, invariants and scales agree bit for bit.

use crate::side_by_side::compare;
use clebsch::card::Settings;
use clebsch_models::gallery;

/// Number of compared steps.
const STEPS: u64 = 200;

/// Number of compared steps with the second available order, which consist of nine substeps each.
const COMPOSED: u64 = 20;

#[test]
fn steps_agree_to_the_last_bit() {
    assert!(clebsch_native::install_after(2));
    for entry in gallery() {
        let card = clebsch_interpret::card(entry.card.source).expect("a model of the gallery");
        for case in &entry.cases {
            let built = entry.card_of(case);
            let sizes: Vec<usize> = built.dimensions.iter().map(|d| d.value).collect();
            let read = (card.sized)(&sizes).expect("sizes of the gallery");
            let plain = Settings::step(case.h);
            let made = compare(&built, &read, case, plain, STEPS.min(case.steps));
            assert!(made > 0, "{} {}", card.name, case.name);
            if let Some(order) = built.orders.get(2) {
                let higher = plain.of_order(*order);
                compare(&built, &read, case, higher, COMPOSED.min(case.steps));
            }
        }
    }
}
