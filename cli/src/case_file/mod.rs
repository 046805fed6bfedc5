//! Cases as TOML files: what `clebsch case` prints and `clebsch run --case FILE.toml` reads.
//! Keys: `model`, `name`, `doc`, `h`, `steps`, tables `[parameters]`, `[initial]`, `[bounds]`.

mod inertia;
mod location;
mod read;
mod value;
mod write;

pub use location::Located;
pub use read::read;
pub use write::write;
