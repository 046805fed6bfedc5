//! The commands that differentiate a case: known answers, files, and wrong requests.

mod equilibria;
mod fits;
mod gradients;
mod modes;
mod motions;

use serde_json::Value;

/// Heavy top with moments `I`, upright, spinning with momentum `L`.
pub fn sleeping(moments: &str, momentum: f64) -> Vec<String> {
    let set = [
        format!("J={{I={moments}}}"),
        "Lambda=[[1,0,0],[0,1,0],[0,0,1]]".to_owned(),
        format!("body_momentum=[0,0,{momentum}]"),
    ];
    set.into_iter()
        .flat_map(|own| ["--set".to_owned(), own])
        .collect()
}

/// A word list from parts.
pub fn words(first: &str, rest: &[String]) -> Vec<String> {
    let first = first.split_whitespace().map(str::to_owned);
    first.chain(rest.iter().cloned()).collect()
}

/// Runs a command with `--json`; gives its results.
#[track_caller]
pub fn results(words: &[String]) -> Value {
    let words: Vec<&str> = words.iter().map(String::as_str).chain(["--json"]).collect();
    crate::common::runs(&words).json()["results"].clone()
}

#[track_caller]
pub fn number(value: &Value) -> f64 {
    value
        .as_f64()
        .unwrap_or_else(|| panic!("a number: {value}"))
}

#[track_caller]
pub fn near(found: f64, expected: f64, within: f64) {
    assert!((found - expected).abs() <= within, "{found} {expected}");
}
