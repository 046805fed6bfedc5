//! Measures the work of a macro expansion in allocations, which do not depend on the load of the machine. The benchmark `expansion`
//! in `benches/` measures its time, in an engine built as rustc builds it for the macro.

use super::allocations::allocations;
use clebsch_core::pipeline::expand;

/// Limit on allocations for every gallery model: above the expansion of the largest, which takes 33 ms, and far below the cost of
/// one superlinear pass.
const BUDGET: u64 = 2_000_000;

#[test]
fn every_model_of_the_gallery_expands_within_a_budget_of_work() {
    for entry in clebsch_models::gallery() {
        let tokens = clebsch_core::syntax::tokens(entry.card.source).expect("tokens");
        let mut expanded = String::new();
        let count = allocations(|| expanded = expand(tokens).to_string());
        println!("{}: {count} allocations", entry.card.kebab);
        // The output is the stepper and not an error message.
        assert!(
            expanded.contains(":: clebsch :: stepper !"),
            "{}",
            entry.card.kebab
        );
        assert!(count <= BUDGET, "{}: {count} allocations", entry.card.kebab);
    }
}
