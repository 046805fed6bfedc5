//! Compositions of a symmetric step: their coefficients, and their order on a nonlinear problem.

use clebsch::integrate::{Composition, CompositionOrder, Reversible, Stepper};
use clebsch::{DoubleDouble, Real, StartError, StepError};

type Quad = DoubleDouble;

#[test]
fn factors_are_symmetric_and_meet_the_conditions_of_their_order() {
    for order in CompositionOrder::ALL {
        let factors = order.factors();
        let power = |p: i32| factors.iter().map(|g| g.powi(p)).sum::<f64>();
        assert!(factors.iter().eq(factors.iter().rev()));
        // Rounding error of about seventeen terms below 1.
        assert!((power(1) - 1.0).abs() < 1e-15, "{order}");
        for p in (3..order.number()).step_by(2) {
            let p = p as i32;
            assert!(power(p).abs() < 4e-15, "{order}: {p} {:e}", power(p));
        }
    }
}

/// A pendulum by the Störmer-Verlet method.
struct Pendulum;

#[derive(Clone, Copy, Debug)]
struct Swing {
    angle: Quad,
    momentum: Quad,
    node: u64,
}

impl Stepper for Pendulum {
    type Scalar = Quad;
    type State = Swing;
    type Workspace = Quad;

    fn workspace(&self, _: &Swing, h: Quad) -> Result<Quad, StartError> {
        Ok(h)
    }

    fn advance(&self, state: &mut Swing, h: &mut Quad) -> Result<(), StepError> {
        let half = *h * Quad::from_f64(0.5);
        state.momentum -= half * state.angle.sin();
        state.angle += *h * state.momentum;
        state.momentum -= half * state.angle.sin();
        state.node += 1;
        Ok(())
    }

    fn node(state: &Swing) -> u64 {
        state.node
    }

    fn at_node(state: Swing, node: u64) -> Swing {
        Swing { node, ..state }
    }
}

impl Reversible for Pendulum {}

fn swung(steps: u32, order: CompositionOrder) -> Swing {
    let mut state = Swing {
        angle: Quad::from_f64(2.0),
        momentum: Quad::from_f64(0.5),
        node: 0,
    };
    let h = Quad::from_f64(8.0) / Quad::from_f64(f64::from(steps));
    let mut composed = Composition::start(&Pendulum, &state, h, order).expect("no bound");
    for _ in 0..steps {
        composed.step(&Pendulum, &mut state).expect("no bound");
    }
    assert_eq!(state.node, u64::from(steps));
    state
}

#[test]
fn orders_are_measured() {
    let exact = swung(8192, CompositionOrder::Eight);
    for (order, coarse) in [
        (CompositionOrder::Four, 128),
        (CompositionOrder::Six, 128),
        (CompositionOrder::Eight, 128),
    ] {
        let error = |steps: u32| {
            let end = swung(steps, order);
            (end.angle - exact.angle)
                .magnitude()
                .max((end.momentum - exact.momentum).magnitude())
        };
        let (coarse, fine) = (error(coarse), error(2 * coarse));
        let measured = (coarse / fine).log2();
        println!("order {order}: {measured:.3} ({coarse:.1e}, {fine:.1e})");
        let nominal = f64::from(order.number());
        assert!((measured - nominal).abs() < 0.15, "{order}: {measured}");
    }
}
