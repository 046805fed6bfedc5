//! Compiled models with labels: one stepper for every number of sites. The files in `models/lattices/` contain the
//! same models and run without a build.

pub mod coupled_body_chain;
pub mod coupled_tops;
pub mod geometrically_exact_rod;
pub mod hanging_chain;
pub mod kirchhoff_rod;
pub mod quaternion_rod;
pub mod shallow_water_1d;
pub mod sine_gordon;
pub mod toda_chain;
pub mod uniform_tension_rod;

/// The model files and the text of the compiled models.
pub const STATEMENTS: [(&str, &str); 10] = [
    (
        include_str!("../../lattices/coupled-body-chain.clebsch"),
        coupled_body_chain::CoupledBodyChain::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/coupled-tops.clebsch"),
        coupled_tops::CoupledTops::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/geometrically-exact-rod.clebsch"),
        geometrically_exact_rod::GeometricallyExactRod::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/hanging-chain.clebsch"),
        hanging_chain::HangingChain::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/kirchhoff-rod.clebsch"),
        kirchhoff_rod::KirchhoffRod::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/quaternion-rod.clebsch"),
        quaternion_rod::QuaternionRod::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/shallow-water-1d.clebsch"),
        shallow_water_1d::ShallowWater1D::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/sine-gordon.clebsch"),
        sine_gordon::SineGordon::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/toda-chain.clebsch"),
        toda_chain::TodaChain::<f64>::SOURCE,
    ),
    (
        include_str!("../../lattices/uniform-tension-rod.clebsch"),
        uniform_tension_rod::UniformTensionRod::<f64>::SOURCE,
    ),
];
