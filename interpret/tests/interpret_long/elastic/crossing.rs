//! The bipolar chart near equal stretches: the tangent at rest is singular to the square of their difference and
//! grows along the curve from rest, so that the principal root of a step exists. In the thesis's run of figures 3.1
//! to 3.3, the stretches differ by only 4.1e-5 at node 949. The roots here are ends of this curve, followed with
//! forty digits by another program; along it, the determinant of the tangent is nowhere smaller than at rest.

use clebsch::card::{Settings, Trajectory};

const MODEL: &str = include_str!("../../../../models/elastic/pseudo-rigid.clebsch");

/// A step from stretches whose first two differ by this amount.
fn step(apart: f64) -> Result<Box<dyn Trajectory>, String> {
    let card = clebsch_interpret::card(MODEL).expect("is read");
    let one = vec![1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    let parameters = [0.1, 10.0, 10.0, 50.0].map(|x| vec![x]);
    let initial = [
        one.clone(),
        vec![0.0245, -0.0019, 0.0053],
        one,
        vec![-0.0272, 0.0024, -0.006],
        vec![1.03, 1.03 + apart, 0.909],
        vec![0.0; 3],
    ];
    let started = (card.open)(&parameters, &initial, Settings::step(0.05));
    let mut t = started.map_err(|e| e.to_string())?;
    t.step().map_err(|e| e.to_string())?;
    Ok(t)
}

#[test]
fn steps_near_equal_stretches_take_their_principal_root() {
    // Entries (1, 2), (1, 3), (2, 3) of both rotations of the step.
    for (apart, first, second) in [
        (
            4e-5,
            [
                0.019829816647907453,
                0.0008565255556325435,
                0.004001508943827009,
            ],
            [
                0.01996238811686918,
                0.0009273428635639077,
                0.004687762681542421,
            ],
        ),
        (
            4e-6,
            [
                0.01982974001977596,
                0.0008565470348410375,
                0.004003947000091715,
            ],
            [
                0.019962316118951634,
                0.000927364535640499,
                0.004690226255465945,
            ],
        ),
    ] {
        let t = step(apart).unwrap_or_else(|e| panic!("{apart:e}: {e}"));
        let card = t.card();
        let mut all = vec![0.0; card.observable_count()];
        t.observe(&mut all);
        let value = |name: &str| {
            let before = card.observables.iter().take_while(|f| f.ascii != name);
            let from: usize = before.map(|f| f.count()).sum();
            [1, 2, 5].map(|k| all[from + k])
        };
        for (found, wanted) in [(value("R"), first), (value("S"), second)] {
            for (a, b) in found.iter().zip(wanted) {
                // The smallest singular value of the tangent there is 2e-3 of the others.
                assert!((a - b).abs() < 1e-12, "{apart:e}: {a} {b}");
            }
        }
    }
}

/// If stretches agree to the rounding of the tangent, the velocity at rest is not determined: the step fails for all momenta.
#[test]
fn steps_at_equal_stretches_are_refused() {
    for apart in [0.0, 4e-7] {
        let refused = step(apart).err().expect("is refused");
        assert!(refused.contains("tangent becomes singular"), "{refused}");
        assert!(refused.contains("is degenerate"), "{refused}");
    }
}
