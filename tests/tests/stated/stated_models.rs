//! Models outside the gallery, tested through their statements alone, against 32-digit runs: the free body and the heavy top in the
//! spatial representation, and two bodies joined at a point. They cover features that the gallery does not use: the spatial side,
//! advected tensors, several groups, Newton's method.

use clebsch::nalgebra::{Matrix3, SVector, Vector3};
use clebsch::{BodyMomentum, Rotation, SpatialMomentum};
use clebsch_oracle::physics::measure::worse;
use clebsch_oracle::reference::{H, NODES, TOLERANCE, coupled_sym, spatial, top_lagrange};

clebsch::model! {
    /// Free rigid body, spatial representation (thesis 2.5.5).
    model FreeBodySpatial {
        group Λ: SO<3> velocity ω;
        advected J: Sym<3>;
        constraint next(Λ) = ω*Λ;
        constraint next(J) = ω*J*ω^T;
        lagrangian = -tr(ω*J)/h;
    }
}

clebsch::model! {
    /// Heavy top, spatial representation.
    model HeavyTopSpatial {
        param w: Real;
        param z: Vec<3>;
        group Λ: SO<3> velocity ω;
        advected J: Sym<3>;
        advected chi: Vec<3>;
        constraint next(Λ) = ω*Λ;
        constraint next(J) = ω*J*ω^T;
        constraint next(chi) = ω*chi;
        lagrangian = -tr(ω*J)/h - h*w*dot(chi, z);
    }
}

clebsch::model! {
    /// Two bodies with a spherical joint (thesis 2.8, corrected).
    model CoupledBodies {
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
    }
}

fn largest(a: impl IntoIterator<Item = f64>) -> f64 {
    a.into_iter().fold(0.0, |m, x| worse(m, x.abs()))
}

fn gap(found: &Matrix3<f64>, wanted: &[[f64; 3]; 3]) -> f64 {
    let wanted = Matrix3::from_fn(|i, j| wanted[i][j]);
    largest((found - wanted).iter().copied())
}

fn vector_gap(found: &Vector3<f64>, wanted: &[f64; 3]) -> f64 {
    largest((found - Vector3::from_row_slice(wanted)).iter().copied())
}

fn spatial_start() -> (Rotation, Matrix3<f64>, Vector3<f64>) {
    let attitude = Rotation::from_quaternion([0.86f64.sqrt(), 0.1, -0.3, 0.2]).unwrap();
    let r = attitude.matrix();
    let body = Matrix3::from_diagonal(&Vector3::new(0.5, 1.5, 2.0));
    let momentum = r * Vector3::new(-0.5, 0.0, 1.0);
    (attitude, r * body * r.transpose(), momentum)
}

#[test]
fn free_body_in_space() {
    let (attitude, j, m) = spatial_start();
    let model = FreeBodySpatial::new(FreeBodySpatialParameters {
        scalar: std::marker::PhantomData,
    })
    .unwrap();
    let initial = FreeBodySpatialInitial {
        Λ: attitude,
        spatial_momentum: SpatialMomentum(m),
        // Exactly symmetric, as required for the parameter.
        J: (j + j.transpose()) / 2.0,
    };
    let (mut state, mut work) = model.start(initial, H).unwrap();
    for (i, node) in NODES.into_iter().enumerate() {
        while state.node() < node {
            model.step(&mut state, &mut work).unwrap();
        }
        let attitude = gap(&state.Λ().matrix(), &spatial::ATTITUDE[i]);
        let worst = worse(gap(&model.J(&state), &spatial::POINSOT[i]), attitude);
        assert!(worst < TOLERANCE, "node {node}: {worst:e}");
    }
}

#[test]
fn lagrange_top_in_space() {
    let r = Matrix3::new(0.8, 0.0, 0.6, 0.0, 1.0, 0.0, -0.6, 0.0, 0.8);
    let j = r * Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5)) * r.transpose();
    let model = HeavyTopSpatial::new(HeavyTopSpatialParameters {
        w: 1.0,
        z: Vector3::z(),
    })
    .unwrap();
    let initial = HeavyTopSpatialInitial {
        Λ: Rotation::from_matrix(&r).unwrap(),
        spatial_momentum: SpatialMomentum(r * Vector3::new(0.1, 0.0, 1.0)),
        J: (j + j.transpose()) / 2.0,
        chi: r * Vector3::z(),
    };
    let (mut state, mut work) = model.start(initial, H).unwrap();
    for (i, node) in NODES.into_iter().enumerate() {
        while state.node() < node {
            model.step(&mut state, &mut work).unwrap();
        }
        let momentum = vector_gap(
            &state.spatial_momentum().0,
            &top_lagrange::SPATIAL_MOMENTUM[i],
        );
        let worst = worse(
            vector_gap(&model.chi(&state), &top_lagrange::SPATIAL_ARM[i]),
            momentum,
        );
        assert!(worst < TOLERANCE, "node {node}: {worst:e}");
    }
}

#[test]
fn coupled_bodies() {
    let axis = Vector3::z();
    let inertia = Matrix3::from_diagonal(&Vector3::new(0.5, 0.5, 1.5));
    let eps = 0.5;
    let j = inertia + eps * axis * axis.transpose();
    let model = CoupledBodies::new(CoupledBodiesParameters {
        J1: j,
        J2: j,
        d1: axis,
        d2: axis,
        eps,
    })
    .unwrap();
    let quarter = Matrix3::new(1.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 1.0, 0.0);
    let initial = CoupledBodiesInitial {
        Λ1: Rotation::identity(),
        body_momentum_Λ1: BodyMomentum(Vector3::new(0.5, 0.0, 1.0)),
        Λ2: Rotation::from_matrix(&quarter).unwrap(),
        body_momentum_Λ2: BodyMomentum(Vector3::new(0.5, 0.0, 1.0)),
    };
    let (mut state, mut work) = model.start(initial, H).unwrap();
    let total = |s: &CoupledBodiesState| -> SVector<f64, 3> {
        s.spatial_momentum_Λ1().0 + s.spatial_momentum_Λ2().0
    };
    let (energy, momentum) = (model.energy(&state), total(&state));
    let mut swing = 0.0f64;
    for (i, node) in NODES.into_iter().enumerate() {
        while state.node() < node {
            model.step(&mut state, &mut work).unwrap();
            swing = worse(swing, (model.energy(&state) - energy).abs());
        }
        let [first, second] = [state.body_momentum_Λ1(), state.body_momentum_Λ2()];
        let worst = [
            vector_gap(&first.0, &coupled_sym::FIRST_MOMENTUM[i]),
            vector_gap(&second.0, &coupled_sym::SECOND_MOMENTUM[i]),
            gap(&model.R(&state), &coupled_sym::RELATIVE_ATTITUDE[i]),
        ]
        .into_iter()
        .fold(0.0, worse);
        // The tolerance is one digit larger for coupled runs.
        assert!(worst < coupled_sym::TOLERANCE, "node {node}: {worst:e}");
    }
    assert!((energy - coupled_sym::ENERGY_0).abs() < 1e-14);
    let [lowest, _] = coupled_sym::ENERGY_DEVIATION;
    assert!((swing + lowest).abs() < 1e-12, "{swing:e}");
    assert!(largest((total(&state) - momentum).iter().copied()) < 1e-13);
}
