//! The commands as a user types them: what they print, write and refuse. One binary, since linking is most of what a
//! test costs.

mod book;
mod case_files;
mod cases;
mod clocks;
mod common;
mod comparisons;
mod elastic;
mod exit_codes;
mod figures;
mod fluid_starts;
mod fluids;
mod from_npz;
mod functions;
mod groups;
mod halved;
mod lattices;
mod longest_step;
mod model_files;
mod multipliers;
mod names;
mod npz;
mod own_models;
mod page;
mod pictures;
mod pictures_of_lines;
mod rest;
mod results;
mod resumed;
mod scales;
mod staging;
mod stated;
mod stopped;
mod sweeps;
mod terminal;
mod vtk;
