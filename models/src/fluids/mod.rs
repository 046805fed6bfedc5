//! Compiled models of fluids as particles, with functionals of all particles: one stepper for every number of
//! particles. The files in `models/fluids/` contain the same models.

pub mod particle_mesh_1d;
pub mod particle_mesh_2d;
pub mod shallow_water_2d;
pub mod shallow_water_2d_regularised;

/// The model files and the text of the compiled models.
pub const STATEMENTS: [(&str, &str); 4] = [
    (
        include_str!("../../fluids/particle-mesh-1d.clebsch"),
        particle_mesh_1d::ParticleMesh1D::<f64>::SOURCE,
    ),
    (
        include_str!("../../fluids/particle-mesh-2d.clebsch"),
        particle_mesh_2d::ParticleMesh2D::<f64>::SOURCE,
    ),
    (
        include_str!("../../fluids/shallow-water-2d.clebsch"),
        shallow_water_2d::ShallowWater2D::<f64>::SOURCE,
    ),
    (
        include_str!("../../fluids/shallow-water-2d-regularised.clebsch"),
        shallow_water_2d_regularised::ShallowWater2DRegularised::<f64>::SOURCE,
    ),
];
