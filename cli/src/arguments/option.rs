//! Options and flags, and the checks of their values that need no model. Takes a text; gives its value, or the
//! message.

use crate::words::number::{value, whole};
use clap::{Arg, ArgAction};
use clebsch::validate::positive_step;

/// The name of the option without a cache.
pub(crate) const NO_CACHE: &str = "no-cache";

pub(super) fn json() -> Arg {
    flag(
        "json",
        "Print one JSON object on standard output and nothing else",
    )
}

/// The option of every command that reads a model to run it.
pub(super) fn no_cache() -> Arg {
    flag(
        NO_CACHE,
        "Derive the model anew: neither read nor write the cache of derivations. Without this option, the cache is in the folder \
         $CLEBSCH_CACHE if the variable is set (`off` for no cache), otherwise in the user's folder for caches",
    )
}

pub(super) fn flag(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name)
        .long(name)
        .action(ArgAction::SetTrue)
        .help(help)
}

/// Negative numbers are passed to the check of the value, which has a clearer message.
pub(super) fn option(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    Arg::new(name)
        .long(name)
        .value_name(value)
        .allow_negative_numbers(true)
        .help(help)
}

pub(super) fn positive_count(text: &str) -> Result<u64, String> {
    match whole(text) {
        Some(count) if count > 0 => Ok(count),
        _ => Err(format!(
            "give a whole number, such as 20000 or 2e4, at least 1 and at most {}",
            u64::MAX
        )),
    }
}

/// The available orders depend on the model, whose message lists them.
pub(super) fn order_number(text: &str) -> Result<u32, String> {
    let order = text.parse::<u32>();
    order.map_err(|_| "give a whole number: 2, 4, 6, 8, or 10 for a free body".to_owned())
}

pub(super) fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number >= 0.0 => Ok(number),
        _ => Err("give a finite number that is not negative".to_owned()),
    }
}

pub(super) fn positive_number(text: &str) -> Result<f64, String> {
    match value(text, &|_| None) {
        Ok(number) if number > 0.0 => Ok(number),
        _ => Err("give a positive, finite number, such as 0.01, 1/100 or 2*pi".to_owned()),
    }
}

/// A step size, as a case has it.
pub(super) fn step_size(text: &str) -> Result<f64, String> {
    let number = value(text, &|_| None);
    let number = number.map_err(|_| "give a positive, finite number".to_owned())?;
    match positive_step(number) {
        Ok(()) => Ok(number),
        Err(error) => Err(error.remedy.to_owned()),
    }
}
