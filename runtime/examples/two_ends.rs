//! The static rod as a boundary-value problem: Kirchhoff's rod by shooting from one end and correcting at the other.
//!
//! `cargo run --release -p clebsch --example two_ends`
//!
//! The six unknowns are the moment at the first section and the force along the rod. The conditions are the position and attitude
//! of the last section. Steps with dual numbers give the exact derivatives for Newton's method.

use clebsch::Dual;
use clebsch::nalgebra::{SMatrix, SVector};
use clebsch::prelude::*;

clebsch::model! {
    /// Kirchhoff's rod at rest, read along its arc length: h is the length of a segment.
    pub model Rod {
        param K1, K3: Real;                  // bending stiffness, torsional stiffness
        param n: Vec<3>;                     // force on the far end, space frame
        group Λ: SO<3> velocity Ω;           // attitude of a section; its third axis is the tangent
        advected ν: Vec<3> = Λ^T * n;
        constraint next(Λ) = Λ * Ω;
        constraint next(ν) = Ω^T * ν;
        let B = (K3/2)*Id + (K1 - K3)*E3*E3^T;
        lagrangian = -tr(B*Ω)/h - h*dot(ν, E3);
    }
}

const SEGMENTS: usize = 100;
const LENGTH: f64 = 1.0;

/// The six unknowns: the moment at the first section, in its frame, and the force, in space.
type Sought = SVector<f64, 6>;

/// The position and attitude of the last section.
struct End<T = f64> {
    place: Vector3<T>,
    attitude: Matrix3<T>,
}

/// Integrates the rod from the origin upwards with this moment and force, and passes its sections to `seen`.
fn shot<T: Real>(
    sought: &SVector<T, 6>,
    mut seen: impl FnMut(&Vector3<T>),
) -> Result<End<T>, Error> {
    let rod = Rod::new(RodParameters {
        K1: T::from_f64(1.0),
        K3: T::from_f64(0.8),
        n: sought.fixed_rows::<3>(3).into_owned(),
    })?;
    let initial = RodInitial {
        Λ: Rotation::identity(),
        body_momentum: BodyMomentum(sought.fixed_rows::<3>(0).into_owned()),
    };
    let h = T::from_f64(LENGTH / SEGMENTS as f64);
    let (mut state, mut work) = rod.start(initial, h)?;
    let tangent = |state: &RodState<T>| state.Λ().matrix().column(2).into_owned();
    let mut place = Vector3::zeros();
    seen(&place);
    for _ in 0..SEGMENTS {
        // The force acts on the tangents of nodes; the end nodes count half.
        let before = tangent(&state);
        rod.step(&mut state, &mut work)?;
        place += (before + tangent(&state)) * (h * T::from_f64(0.5));
        seen(&place);
    }
    Ok(End {
        place,
        attitude: state.Λ().matrix(),
    })
}

/// The mismatch of an end: in position, and about the axes of the wanted section.
fn missed<T: Real>(end: &End<T>, wanted: &End) -> SVector<T, 6> {
    let place = end.place - wanted.place.map(T::from_f64);
    let turn = wanted.attitude.map(T::from_f64).transpose() * end.attitude;
    let turn = Vector3::new(
        turn[(2, 1)] - turn[(1, 2)],
        turn[(0, 2)] - turn[(2, 0)],
        turn[(1, 0)] - turn[(0, 1)],
    ) * T::from_f64(0.5);
    SVector::from_fn(|i, _| if i < 3 { place[i] } else { turn[i - 3] })
}

/// Newton's method from an initial guess; `None` if ten corrections are not enough.
fn joined(mut sought: Sought, wanted: &End) -> Option<Sought> {
    for _ in 0..10 {
        let seeds = SVector::<Dual<6>, 6>::from_fn(|i, _| Dual::variable(sought[i], i));
        let off = missed(&shot(&seeds, |_| ()).ok()?, wanted);
        let size = off.map(|x| x.real).norm();
        let tangent = SMatrix::<f64, 6, 6>::from_fn(|i, j| off[i].dual[j]);
        sought -= tangent.lu().solve(&off.map(|x| x.real))?;
        // The remaining error is the square of this, at rounding level.
        if size < 1e-9 {
            return Some(sought);
        }
    }
    None
}

fn main() -> Result<(), Error> {
    // A straight rod does not respond to a change of its axial force, so the first rod is bent. Its end is then moved and rotated
    // in twenty steps.
    let mut sought = Sought::from([0.0, 1.0, 0.0, 0.0, 0.0, 0.0]);
    let bent = shot(&sought, |_| ())?;
    for part in 1..=20 {
        let part = f64::from(part) / 20.0;
        let turn = Rotation::exp(&(Vector3::new(0.3, 0.5, 1.8) * part)).matrix();
        let wanted = End {
            place: bent.place - Vector3::new(0.1, 0.2, 0.5) * part,
            attitude: bent.attitude * turn,
        };
        sought = joined(sought, &wanted).expect("twenty parts are small enough");
        if ((part * 20.0).round() as u32).is_multiple_of(5) {
            let mut height: f64 = 0.0;
            let end = shot(&sought, |place| height = height.max(place[1].abs()))?;
            let [m, n] = [0, 3].map(|at| sought.fixed_rows::<3>(at).into_owned());
            println!(
                "part {part:4.2}   moment {:7.3} {:7.3} {:7.3}   force {:8.3} {:8.3} {:8.3}   out of plane {height:.3}   missed by {:.0e}",
                m[0],
                m[1],
                m[2],
                n[0],
                n[1],
                n[2],
                missed(&end, &wanted).norm()
            );
        }
    }
    Ok(())
}

#[test]
fn it_runs() {
    main().unwrap();
}
