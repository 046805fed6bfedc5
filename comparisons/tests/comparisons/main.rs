//! The comparisons against closed forms and against one another. One binary: linking costs more than these tests.

mod free_body;
mod shallow_water;
mod spectral;
