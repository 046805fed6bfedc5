//! Tests the judge of steps: steps of shipped models stay within its bounds, and its running errors bound the
//! errors of computed numbers.

mod gallery;
mod numbers;
mod rounding;
