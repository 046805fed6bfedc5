//! The gallery. Each file contains one model with its source, its declaration and named cases; everything else is
//! derived from the declaration.

pub mod body_in_quadratic_field;
pub mod body_in_two_fields;
pub mod body_n;
pub mod case;
pub mod cayley_klein;
pub mod cayley_klein_spatial;
pub mod charged_particle;
pub mod coupled_bodies;
pub mod ellipsoid_convective;
pub mod ellipsoid_spatial;
mod ellipsoids;
pub mod files;
pub mod fluids;
pub mod free_body;
pub mod free_body_spatial;
pub mod heavy_top;
pub mod heavy_top_spatial;
pub mod kepler;
pub mod kirchhoff_body;
pub mod lattices;
pub mod mixed_four;
mod thesis;

pub use case::{Case, Citations, Entry};
pub use files::{CaseFile, FILES, Family, ModelFile};

/// All compiled models, ordered by name.
pub fn gallery() -> Vec<Entry> {
    vec![
        body_in_quadratic_field::entry(),
        body_in_two_fields::entry(),
        body_n::entry(),
        cayley_klein::entry(),
        cayley_klein_spatial::entry(),
        charged_particle::entry(),
        coupled_bodies::entry(),
        ellipsoid_convective::entry(),
        ellipsoid_spatial::entry(),
        free_body::entry(),
        free_body_spatial::entry(),
        heavy_top::entry(),
        heavy_top_spatial::entry(),
        kepler::entry(),
        kirchhoff_body::entry(),
        mixed_four::entry(),
    ]
}

/// The model with this command-line name, such as `heavy-top`.
pub fn find(kebab: &str) -> Option<Entry> {
    gallery().into_iter().find(|e| e.card.kebab == kebab)
}
