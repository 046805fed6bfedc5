//! Steps of lines of sites: chains with quartic strains and bending, bodies along a line.

use crate::steps::judged_lines;

#[path = "rows/chains.rs"]
mod chains;
#[path = "rows/rods.rs"]
mod rods;

#[test]
fn chains_of_numbers_and_vectors() {
    judged_lines(chains::ROWS);
}

#[test]
fn bodies_along_a_line() {
    judged_lines(rods::ROWS);
}
