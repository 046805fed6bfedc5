//! A few random models of fields and groups together.

use super::common::mixed::agree_with_their_own_masses_alone;

/// The first of those of `tests/tests/many_models/`.
#[test]
fn random_models_of_fields_and_groups_agree_with_the_variation_of_the_action() {
    agree_with_their_own_masses_alone(0..10);
}
