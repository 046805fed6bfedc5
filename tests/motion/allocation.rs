//! A step does not allocate. The global allocator of this binary counts the allocations of the testing thread, and a test checks
//! that the counter detects one.

use super::allocations::allocations;
use super::generated_motion::{GeneratedBody, GeneratedTop};
use clebsch_oracle::physics::cases::{asymmetric_body, generic_top, lagrange_top};
use std::hint::black_box;

#[test]
fn the_count_sees_allocations() {
    assert_eq!(allocations(|| drop(black_box(vec![1.0_f64; 3]))), 1);
    // Allocations of another thread do not count.
    let other = std::thread::spawn(|| drop(black_box(vec![0_u8; 100])));
    assert_eq!(
        allocations(|| while !other.is_finished() {
            std::hint::spin_loop()
        }),
        0
    );
    other.join().expect("a quiet thread");
}

#[test]
fn steps_allocate_nothing() {
    let mut body = GeneratedBody::start(&asymmetric_body());
    // More steps than the interval between two projections onto the conserved quantities.
    let count = allocations(|| {
        for _ in 0..10_000 {
            body.model
                .step(&mut body.state, &mut body.workspace)
                .expect("solvable");
        }
    });
    assert_eq!(count, 0, "free body");
    for start in [lagrange_top(), generic_top()] {
        let mut top = GeneratedTop::start(&start);
        let count = allocations(|| {
            for _ in 0..10_000 {
                top.model
                    .step(&mut top.state, &mut top.workspace)
                    .expect("solvable");
            }
        });
        assert_eq!(count, 0, "heavy top");
    }
}

#[test]
fn observing_allocates_nothing() {
    let body = GeneratedBody::start(&asymmetric_body());
    let top = GeneratedTop::start(&generic_top());
    let count = allocations(|| {
        black_box(body.model.energy(&body.state));
        black_box((
            body.state.Λ(),
            body.state.body_momentum(),
            body.state.spatial_momentum(),
            body.state.node(),
        ));
        black_box(top.model.energy(&top.state));
        black_box((top.model.Γ(&top.state), top.state.body_momentum()));
    });
    assert_eq!(count, 0);
}

fn body_of_any_dimension<const N: usize>() {
    use clebsch::nalgebra::SMatrix;
    use clebsch::{BodyMomentumMatrix, Orthogonal};
    use clebsch_models::body_n::{BodyN, BodyNInitial, BodyNParameters};
    let c = SMatrix::<f64, N, N>::from_fn(|i, j| match i == j {
        true => 1.0 + 0.2 * i as f64,
        false => 0.05 * (i as f64 - 0.5 * j as f64),
    });
    let m = SMatrix::<f64, N, N>::from_fn(|i, j| 0.3 * (i as f64 - j as f64));
    let model = BodyN::new(BodyNParameters { C: c }).expect("a factor");
    for method in clebsch::solvers::Method::ALL {
        let initial = BodyNInitial {
            Λ: Orthogonal::identity(),
            body_momentum: BodyMomentumMatrix(m),
        };
        // Some methods exist in three dimensions only.
        let Ok((mut state, mut work)) = model.start_with(initial, 0.1, method) else {
            continue;
        };
        let made = allocations(|| {
            for _ in 0..100 {
                black_box(model.step(&mut state, &mut work)).expect("solvable");
            }
        });
        assert_eq!(made, 0, "{N} {method}");
    }
}

#[test]
fn steps_in_any_dimension_allocate_nothing() {
    body_of_any_dimension::<3>();
    body_of_any_dimension::<4>();
    body_of_any_dimension::<8>();
}
