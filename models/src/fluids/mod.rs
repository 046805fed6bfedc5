//! Fluids as particles with functionals of all of them, compiled: one stepper for every number of particles. Their
//! statements are those of the files in `models/fluids/`.

pub mod particle_mesh_1d;
pub mod particle_mesh_2d;
pub mod shallow_water_2d;
pub mod shallow_water_2d_regularised;

/// The files and the statements that are compiled.
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
