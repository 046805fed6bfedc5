//! Models that are in no gallery, known by their statements alone: the free body and the heavy top
//! in the spatial representation and two bodies joined at a point, against runs in 32 digits.
//! They exercise what the gallery does not: the spatial side, advected tensors, several groups,
//! Newton.
#![allow(mixed_script_confusables)]

use clebsch::nalgebra::{Matrix3, SVector, Vector3};
use clebsch::{BodyMomentum, Rotation, SpatialMomentum};

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

const H: f64 = 0.1;

/// Nodes at which the reference is given.
const NODES: [u64; 4] = [1, 10, 100, 1000];

fn largest(a: impl IntoIterator<Item = f64>) -> f64 {
    a.into_iter().fold(0.0, |m, x| m.max(x.abs()))
}

fn gap(found: &Matrix3<f64>, wanted: &[f64; 9]) -> f64 {
    largest((found - Matrix3::from_row_slice(wanted)).iter().copied())
}

fn vector_gap(found: &Vector3<f64>, wanted: &[f64; 3]) -> f64 {
    largest((found - Vector3::from_row_slice(wanted)).iter().copied())
}

/// `J` and `Λ` of the spatial run at the nodes.
const SPATIAL: [([f64; 9], [f64; 9]); 4] = [
    (
        [
            1.1212998136600831,
            -0.1788832615477211,
            -0.6388603402624519,
            -0.1788832615477211,
            1.416271812691244,
            -0.33006107098914733,
            -0.6388603402624519,
            -0.33006107098914733,
            1.462428373648673,
        ],
        [
            0.7178234137195826,
            -0.45998805726641306,
            -0.5226284855308176,
            0.355728393439753,
            0.8875969270563239,
            -0.29262434140198107,
            0.5984871400596151,
            0.02413881215888564,
            0.800768668799436,
        ],
    ),
    (
        [
            1.446034792787772,
            -0.2879854977009068,
            -0.4727742636581185,
            -0.2879854977009068,
            1.0004235237421535,
            -0.43688790689631973,
            -0.4727742636581185,
            -0.43688790689631973,
            1.5535416834700748,
        ],
        [
            0.47353000500432063,
            -0.659726016999694,
            -0.5835502693464613,
            0.7179468800393783,
            0.6729114242163381,
            -0.17816422929662956,
            0.5102172202134405,
            -0.33459198683300684,
            0.7922919856623633,
        ],
    ),
    (
        [
            1.235364881625805,
            0.6372501699008541,
            -0.2678621828023647,
            0.6372501699008541,
            1.4579622850661014,
            0.3042612653924765,
            -0.2678621828023647,
            0.3042612653924765,
            1.3066728333080937,
        ],
        [
            0.673393017030588,
            -0.4109693061430703,
            -0.6145291482287277,
            -0.5896036655249647,
            0.20292358824536433,
            -0.7817861184065316,
            0.4459925584737573,
            0.888777951313999,
            -0.10566168200498699,
        ],
    ),
    (
        [
            1.9132499521164714,
            -0.07224348207133242,
            -0.3276889463506713,
            -0.07224348207133242,
            1.5107204018965288,
            0.009746856918873156,
            -0.3276889463506713,
            0.009746856918873156,
            0.5760296459869998,
        ],
        [
            -0.22620007829092995,
            -0.14142372329488678,
            -0.9637597496630519,
            -0.006774854987211114,
            -0.9891519095804492,
            0.14673990974936948,
            -0.9740573011486949,
            0.03972191162018943,
            0.22278811417164615,
        ],
    ),
];

/// `m` and `χ` of the spatial run of the Lagrange top.
const TOP: [([f64; 3], [f64; 3]); 4] = [
    (
        [0.6802482783957736, 0.060064637593528675, 0.74],
        [
            0.6012927518705735,
            -0.0049655679154722385,
            0.7990133726560462,
        ],
    ),
    (
        [0.6987571854194187, 0.6420946262506662, 0.74],
        [
            0.7229817242489152,
            -0.025064536659576853,
            0.6904123372334147,
        ],
    ),
    (
        [-0.5644334056263964, -2.2352660888470304, 0.74],
        [
            -0.8278018379577496,
            -0.37614409648626485,
            -0.416244802673022,
        ],
    ),
    (
        [0.37174802542576774, -0.6801350522321518, 0.74],
        [0.5474756238197137, -0.3382940754727149, 0.7653937286281332],
    ),
];

/// `μ1`, `μ2` and `R` of the coupled run.
const COUPLED: [([f64; 3], [f64; 3], [f64; 9]); 4] = [
    (
        [0.49699566145361207, -0.02993297036929924, 1.0],
        [0.5009966386227626, -0.03015379590433084, 1.0],
        [
            0.9899980762813941,
            -0.10001194802018724,
            -0.0995058752654652,
            -0.09901005065532793,
            0.009921465345752195,
            -0.9950369713707237,
            0.10050282995203841,
            0.9949367692364176,
            -7.995643342957276e-05,
        ],
    ),
    (
        [0.3886729094790274, -0.26496490224221475, 1.0],
        [0.4230912482907295, -0.28628272179005987, 1.0],
        [
            0.2871047799271793,
            -0.5069450919102413,
            -0.8127592011974291,
            -0.40907296015779504,
            0.7023316309856422,
            -0.5825715349935892,
            0.8661582757271935,
            0.49973688467549066,
            -0.005734761035158154,
        ],
    ),
    (
        [0.13236995500572835, 0.1822375359213733, 1.0],
        [0.5221399409008666, 0.34378983132738417, 1.0],
        [
            0.20004607831423657,
            -0.7570008567344376,
            0.6220379967931395,
            0.4124961899151701,
            0.6409350340751698,
            0.6473400770850889,
            -0.8887229376226103,
            0.12709045990312723,
            0.44047650918641434,
        ],
    ),
    (
        [0.25367478350424627, -0.1675965779374542, 1.0],
        [-0.383670944693886, 0.4374759480053105, 1.0],
        [
            -0.3353348301353707,
            -0.8252705536267935,
            -0.4543996754120847,
            -0.09582772286413035,
            -0.44994573308143226,
            0.8878997042529567,
            -0.9372126755591591,
            0.34128778266785115,
            0.07179867807212113,
        ],
    ),
];

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
        // Symmetric to the last bit, as the parameter would have to be.
        J: (j + j.transpose()) / 2.0,
    };
    let (mut state, mut work) = model.start(initial, H).unwrap();
    for (node, (j, attitude)) in NODES.into_iter().zip(&SPATIAL) {
        while state.node() < node {
            model.step(&mut state, &mut work).unwrap();
        }
        let worst = gap(&model.J(&state), j).max(gap(&state.Λ().matrix(), attitude));
        assert!(worst < 1e-12, "node {node}: {worst:e}");
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
    for (node, (m, chi)) in NODES.into_iter().zip(&TOP) {
        while state.node() < node {
            model.step(&mut state, &mut work).unwrap();
        }
        let worst =
            vector_gap(&state.spatial_momentum().0, m).max(vector_gap(&model.chi(&state), chi));
        assert!(worst < 1e-12, "node {node}: {worst:e}");
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
    for (node, (m1, m2, r)) in NODES.into_iter().zip(&COUPLED) {
        while state.node() < node {
            model.step(&mut state, &mut work).unwrap();
            swing = swing.max((model.energy(&state) - energy).abs());
        }
        let worst = vector_gap(&state.body_momentum_Λ1().0, m1)
            .max(vector_gap(&state.body_momentum_Λ2().0, m2))
            .max(gap(&model.R(&state), r));
        // The reference allows a digit more for coupled runs.
        assert!(worst < 1e-11, "node {node}: {worst:e}");
    }
    assert!((energy - 1.1).abs() < 1e-14);
    assert!((swing - 2.2539648949e-5).abs() < 1e-12, "{swing:e}");
    assert!(largest((total(&state) - momentum).iter().copied()) < 1e-13);
}
