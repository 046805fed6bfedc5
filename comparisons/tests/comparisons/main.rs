//! The comparisons against closed forms and against each other. All tests share one binary, because linking costs more than the
//! tests.

mod free_body;
mod shallow_water;
mod spectral;
