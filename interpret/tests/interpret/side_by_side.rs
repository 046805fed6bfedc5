//! A compiled model and the same model from its text, side by side.

use clebsch::card::{Card, OpenError, Settings, Trajectory};
use clebsch_models::Case;

/// Everything a trajectory shows at a node, as bits.
pub fn seen(t: &dyn Trajectory, card: &Card) -> Vec<u64> {
    let mut out = vec![0.0; card.observable_count() + 2 * card.invariant_count()];
    let (observed, rest) = out.split_at_mut(card.observable_count());
    let (invariants, scales) = rest.split_at_mut(card.invariant_count());
    t.observe(observed);
    t.invariants(invariants);
    t.scales(scales);
    out.iter().map(|x| x.to_bits()).collect()
}

fn start(card: &Card, case: &Case, settings: Settings) -> Result<Box<dyn Trajectory>, OpenError> {
    (card.open)(&case.parameters, &case.initial, settings)
}

/// Both trajectories side by side; how many steps were compared.
pub fn compare(built: &Card, read: &Card, case: &Case, settings: Settings, steps: u64) -> u64 {
    let label = format!("{} {} {settings:?}", built.name, case.name);
    let (mut a, mut b) = match (start(built, case, settings), start(read, case, settings)) {
        (Ok(a), Ok(b)) => (a, b),
        (a, b) => {
            let told = |r: Result<Box<dyn Trajectory>, OpenError>| r.err().map(|e| e.to_string());
            assert_eq!(told(a), told(b), "{label}");
            return 0;
        }
    };
    assert_eq!(a.kinetic_warning(), b.kinetic_warning(), "{label}");
    assert_eq!(seen(&*a, built), seen(&*b, read), "{label} at the start");
    for k in 0..steps {
        let (x, y) = (a.step(), b.step());
        // Numbers in errors may be NaN, so the texts are compared.
        assert_eq!(format!("{x:?}"), format!("{y:?}"), "{label} in step {k}");
        assert_eq!(
            (a.node(), a.time().to_bits()),
            (b.node(), b.time().to_bits()),
            "{label}"
        );
        if k % 7 == 0 || k + 1 == steps || k < 3 {
            assert_eq!(seen(&*a, built), seen(&*b, read), "{label} after step {k}");
        }
        if x.is_err() {
            return k;
        }
    }
    steps
}
