//! Numbers of a case whose products leave the range of doubles. Takes a case whose velocities give no momenta; gives
//! the message about the number that causes this.

use super::Motion;
use crate::models::gallery::Case;
use clebsch::card::Card;
use clebsch_core::lattice::ChainConfig;

impl Motion {
    /// The message about a number that is too large or too small for products with it. The velocities give momenta if
    /// an ordinary number replaces it.
    pub(super) fn extreme(
        &self,
        card: &Card,
        choice: Option<&ChainConfig>,
        case: &Case,
    ) -> Option<String> {
        let said = |name: &str, x: f64| {
            let (flow, limit) = match x.abs() > 1.0 {
                true => (
                    "overflow: they exceed the largest double, 1.8e308",
                    "smaller",
                ),
                false => (
                    "underflow: they are below the smallest double, 4.9e-324",
                    "larger",
                ),
            };
            format!(
                "with `{name}` = {x:e}, terms of the momentum {flow}. Choose units in which this number is {limit}"
            )
        };
        let works = |motion: &Self, case: &Case| motion.momenta(card, choice, case).is_ok();
        for (at, field) in card.parameters.iter().enumerate() {
            let mut other = case.clone();
            let found = other.parameters.get_mut(at).and_then(|own| tame(own));
            if let Some(x) = found.filter(|_| works(self, &other)) {
                return Some(said(field.ascii, x));
            }
        }
        let mut other = self.clone();
        for (at, start) in self.given.iter().enumerate() {
            let found = other
                .given
                .get_mut(at)
                .and_then(|own| tame(&mut own.numbers));
            if let Some(x) = found.filter(|_| works(&other, case)) {
                return Some(said(&start.key, x));
            }
        }
        None
    }
}

/// Replaces numbers whose squares or products may leave the range of doubles by 1. Gives the first of them.
fn tame(numbers: &mut [f64]) -> Option<f64> {
    const LARGE: f64 = 1e100;
    let is_extreme = |x: f64| x != 0.0 && !(LARGE.recip()..=LARGE).contains(&x.abs());
    let mut first = None;
    for x in numbers.iter_mut().filter(|x| is_extreme(**x)) {
        first = first.or(Some(*x));
        *x = x.signum();
    }
    first
}
