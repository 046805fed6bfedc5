//! The work of an expansion, counted in allocations: a property of the code that no other load of the machine
//! changes. Its time, in an engine built as rustc builds it for the macro, is `expansion` of `benches/`.

use super::allocations::allocations;
use clebsch_core::pipeline::expand;

/// Allocations allowed for every model of the gallery: above what the 33 ms of the largest can hold,
/// and far below what one superlinear pass would make of it.
const BUDGET: u64 = 2_000_000;

#[test]
fn every_model_of_the_gallery_expands_within_a_budget_of_work() {
    for entry in clebsch_models::gallery() {
        let tokens = clebsch_core::syntax::tokens(entry.card.source).expect("tokens");
        let mut expanded = String::new();
        let count = allocations(|| expanded = expand(tokens).to_string());
        println!("{}: {count} allocations", entry.card.kebab);
        // The stepper, not an error message in its place.
        assert!(
            expanded.contains(":: clebsch :: stepper !"),
            "{}",
            entry.card.kebab
        );
        assert!(count <= BUDGET, "{}: {count} allocations", entry.card.kebab);
    }
}
