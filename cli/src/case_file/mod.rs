//! Cases as TOML files: the output of `clebsch case` and the input of `clebsch run --case FILE.toml`. Keys:
//! `model`, `name`, `doc`, `h`, `steps`, tables `[parameters]`, `[initial]`, `[bounds]`, and for models with
//! labels `[labels]` and `[ends]`.

mod allowed_keys;
pub(crate) mod archive;
mod at_sites;
mod attitude;
mod chain_choice;
mod copies;
mod field_numbers;
mod fields;
mod fluid;
mod from_npz;
pub(crate) mod functions;
mod inertia;
mod keys;
mod lattice;
mod location;
mod motion;
mod names;
mod not_toml;
mod read;
mod remarks;
mod sample;
mod scope;
mod sites;
pub(crate) mod space;
mod start;
pub(crate) mod stated;
mod table;
mod taken_as;
mod value;
mod velocity;
mod write;

pub(crate) use attitude::is_key_of_rotation;
pub(crate) use chain_choice::{choice, default_choice};
pub(crate) use keys::{at_site, line_of, quantity_of};
pub(crate) use lattice::write_lattice;
pub use location::Located;
pub(crate) use motion::{Motion, is_velocity, statement, undefined, velocity_keys};
pub use read::read;
pub(crate) use read::{no_steps, read_of};
pub(crate) use write::DEFAULT_BOUND;
pub use write::write;
