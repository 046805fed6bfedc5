//! Models outside the gallery, tested through their statements alone, against 32-digit runs: the free body and the heavy top in the
//! spatial representation, and two bodies joined at a point. They cover features that the gallery does not use: the spatial side,
//! advected tensors, several groups, Newton's method.

use super::text_model::{Motion, TextModel, given};
use clebsch::Rotation;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::reference::{H, NODES, TOLERANCE, coupled_sym, spatial, top_lagrange};

/// Free rigid body, spatial representation (thesis 2.5.5).
const FREE_BODY_SPATIAL: &str = "model FreeBodySpatial {
    group Λ: SO<3> velocity ω;
    advected J: Sym<3>;
    constraint next(Λ) = ω*Λ;
    constraint next(J) = ω*J*ω^T;
    lagrangian = -tr(ω*J)/h;
}";

/// Heavy top, spatial representation.
pub(crate) const HEAVY_TOP_SPATIAL: &str = "model HeavyTopSpatial {
    param w: Real;
    param z: Vec<3>;
    group Λ: SO<3> velocity ω;
    advected J: Sym<3>;
    advected chi: Vec<3>;
    constraint next(Λ) = ω*Λ;
    constraint next(J) = ω*J*ω^T;
    constraint next(chi) = ω*chi;
    lagrangian = -tr(ω*J)/h - h*w*dot(chi, z);
}";

/// Two bodies with a spherical joint (thesis 2.8, corrected).
pub(crate) const COUPLED_BODIES: &str = "model CoupledBodies {
    param J1, J2: Sym<3>;
    param d1, d2: Vec<3>;
    param eps: Real;
    group Λ1: SO<3> velocity Ω1;
    group Λ2: SO<3> velocity Ω2;
    advected R: SO<3> = Λ1^T*Λ2;
    constraint next(Λ1) = Λ1*Ω1;
    constraint next(Λ2) = Λ2*Ω2;
    constraint next(R) = Ω1^T*R*Ω2;
    lagrangian = -(tr(J1*Ω1) + tr(J2*Ω2) + eps*dot((Ω1 - Id)*d1, R*(Ω2 - Id)*d2))/h;
}";

fn largest(a: impl IntoIterator<Item = f64>) -> f64 {
    a.into_iter().fold(0.0, |m, x| worse(m, x.abs()))
}

/// The largest difference of an observable from its reference value.
fn gap(motion: &Motion, name: &str, wanted: &[f64]) -> f64 {
    let found = motion.numbers(name);
    assert_eq!(found.len(), wanted.len(), "{name}");
    largest(found.iter().zip(wanted).map(|(x, y)| x - y))
}

#[test]
fn free_body_in_space() {
    let attitude = Rotation::from_quaternion([0.86f64.sqrt(), 0.1, -0.3, 0.2]).unwrap();
    let r = attitude.matrix();
    let j = r * Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0)) * r.transpose();
    let given = given! {
        Λ: attitude,
        spatial_momentum: r * Vector3::new(-0.5, 0.0, 1.0),
        // Exactly symmetric, as required for the parameter.
        J: (j + j.transpose()) / 2.0,
    };
    let mut motion = TextModel::read(FREE_BODY_SPATIAL).start(H, &given).unwrap();
    for (i, node) in NODES.into_iter().enumerate() {
        motion.steps((node - motion.node()) as usize);
        let attitude = gap(&motion, "Λ", &spatial::ATTITUDE[i].concat());
        let worst = worse(gap(&motion, "J", &spatial::POINSOT[i].concat()), attitude);
        assert!(worst < TOLERANCE, "node {node}: {worst:e}");
    }
}

#[test]
fn lagrange_top_in_space() {
    let r = Matrix3::new(0.8, 0.0, 0.6, 0.0, 1.0, 0.0, -0.6, 0.0, 0.8);
    let j = r * Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5)) * r.transpose();
    let given = given! {
        w: 1.0, z: Vector3::z(), Λ: r, spatial_momentum: r * Vector3::new(0.1, 0.0, 1.0),
        J: (j + j.transpose()) / 2.0, chi: r * Vector3::z(),
    };
    let mut motion = TextModel::read(HEAVY_TOP_SPATIAL).start(H, &given).unwrap();
    for (i, node) in NODES.into_iter().enumerate() {
        motion.steps((node - motion.node()) as usize);
        let momentum = gap(
            &motion,
            "spatial_momentum",
            &top_lagrange::SPATIAL_MOMENTUM[i],
        );
        let worst = worse(gap(&motion, "chi", &top_lagrange::SPATIAL_ARM[i]), momentum);
        assert!(worst < TOLERANCE, "node {node}: {worst:e}");
    }
}

#[test]
fn coupled_bodies() {
    let axis = Vector3::z();
    let eps = 0.5;
    let j = Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5)) + eps * axis * axis.transpose();
    let given = given! {
        J1: j, J2: j, d1: axis, d2: axis, eps: eps,
        Λ1: Matrix3::<f64>::identity(), body_momentum_Λ1: [0.5, 0.0, 1.0],
        Λ2: [1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0], body_momentum_Λ2: [0.5, 0.0, 1.0],
    };
    let mut motion = TextModel::read(COUPLED_BODIES).start(H, &given).unwrap();
    let total = |m: &Motion| {
        let [one, two] = ["Λ1", "Λ2"].map(|body| m.vector(&format!("spatial_momentum_{body}")));
        one + two
    };
    let (energy, momentum): (f64, Vector3<f64>) = (motion.energy(), total(&motion));
    let mut swing = 0.0f64;
    for (i, node) in NODES.into_iter().enumerate() {
        while motion.node() < node {
            motion.steps(1);
            swing = worse(swing, (motion.energy() - energy).abs());
        }
        let worst = [
            gap(&motion, "body_momentum_Λ1", &coupled_sym::FIRST_MOMENTUM[i]),
            gap(
                &motion,
                "body_momentum_Λ2",
                &coupled_sym::SECOND_MOMENTUM[i],
            ),
            gap(&motion, "R", &coupled_sym::RELATIVE_ATTITUDE[i].concat()),
        ]
        .into_iter()
        .fold(0.0, worse);
        // The tolerance is one digit larger for coupled runs.
        assert!(worst < coupled_sym::TOLERANCE, "node {node}: {worst:e}");
    }
    assert!((energy - coupled_sym::ENERGY_0).abs() < 1e-14);
    let [lowest, _] = coupled_sym::ENERGY_DEVIATION;
    assert!((swing + lowest).abs() < 1e-12, "{swing:e}");
    assert!(largest((total(&motion) - momentum).iter().copied()) < 1e-13);
}
