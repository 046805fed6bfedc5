//! The largest step that succeeds instead of one that failed. Takes a function that tries steps; gives the step, by
//! halving and bisection.

use core::cell::Cell;

/// The number of single halvings: most failed steps are only slightly too long.
const HALVINGS: u32 = 8;

/// After these, the step is divided by 2^12, at most this often.
const LEAPS: u32 = 31;
const LEAP: f64 = 1.0 / 4096.0;

/// The smallest share of the step that is tried: `2^-380`.
pub(crate) const SHORTEST_SHARE: f64 = f64::from_bits((1023 - 380) << 52);

/// The number of further halvings that must also succeed, because an isolated solution may exist far beyond the bound.
const CONFIRMED: u32 = 4;

/// Shares of the largest step that must also succeed.
pub(crate) const SHORTER: [f64; 13] = [
    1.0 - 1e-6,
    0.999,
    0.99,
    0.98,
    0.96,
    0.94,
    0.91,
    0.88,
    0.84,
    0.8,
    0.75,
    0.7,
    0.6,
];

/// The precision of a search with a closed form, and of a search whose trials cost a hundred steps
/// each.
const TO_ROUNDING: f64 = 2e-15;
const ROUGHLY: f64 = 1e-7;

/// How often the search continues below a shorter step that fails.
const RETURNS: usize = 8;

/// The largest step not beyond `h` whose ratio is at most 1, by bisection.
///
/// `solvable` gives the ratio to the bound at a trial step, or `None` if it cannot be evaluated. Torques that depend
/// on the step require a search. The result is slightly (1e-12) inside the bound, so that the solver accepts it.
/// Shorter steps are tried too, so that the result is not an isolated success among failing steps. It is 0 if no step
/// above `h / 2^380` succeeds. It is also 0 within a trial of another search, which only needs to know whether the
/// trial succeeds.
#[must_use]
pub fn largest_step(h: f64, solvable: impl Fn(f64) -> Option<f64>) -> f64 {
    search(h, TO_ROUNDING, &solvable)
}

/// The fraction of a step that a `dear` trial confirms: the largest fraction found with `cheap` trials, minus a
/// millionth or more. If no fraction down to 0.6 of it is confirmed, the search uses `dear` trials only.
pub(crate) fn confirmed_step(
    cheap: &dyn Fn(f64) -> Option<f64>,
    dear: &dyn Fn(f64) -> Option<f64>,
) -> f64 {
    let found = search(1.0, ROUGHLY, cheap);
    let whole = (found >= 1.0).then_some(1.0);
    let shares = whole.into_iter().chain(SHORTER);
    let mut offers = shares.map(|x| found * x).filter(|x| *x > 0.0);
    let confirmed = |share: &f64| search_of(|| dear(*share)).is_some_and(|found| found.is_some());
    match offers.find(confirmed) {
        Some(share) => share,
        None => SHORTER[0] * search(1.0, ROUGHLY, dear),
    }
}

/// Runs a trial in which failed steps do not start a search. `None` within another search.
pub(crate) fn search_of<R>(trial: impl FnOnce() -> R) -> Option<R> {
    let _search = Search::begin()?;
    Some(trial())
}

fn search(h: f64, precision: f64, solvable: &dyn Fn(f64) -> Option<f64>) -> f64 {
    let Some(_search) = Search::begin() else {
        return 0.0;
    };
    let fits = |share: f64| solvable(h * share).is_some_and(|ratio| ratio <= 1.0 - 1e-12);
    if fits(1.0) {
        return h;
    }
    let mut refused = 1.0;
    let mut found = 0.0;
    for _ in 0..RETURNS {
        let Some((low, high)) = bracket(refused, &fits) else {
            return 0.0;
        };
        found = between(low, high, precision, &fits);
        let mut tried = SHORTER.iter().map(|share| found * share);
        match tried.rfind(|share| !fits(*share)) {
            None => break,
            Some(shorter) => refused = shorter,
        }
    }
    h * found
}

thread_local! {
    static SEARCHING: Cell<bool> = const { Cell::new(false) };
}

/// A search on this thread, until it is dropped.
struct Search;

impl Search {
    fn begin() -> Option<Self> {
        if SEARCHING.replace(true) {
            return None;
        }
        Some(Self)
    }
}

impl Drop for Search {
    fn drop(&mut self) {
        SEARCHING.set(false);
    }
}

/// Two shares of the step below `refused`: one that succeeds, as do some shorter ones, and a longer
/// one that fails.
fn bracket(refused: f64, fits: &dyn Fn(f64) -> bool) -> Option<(f64, f64)> {
    let (mut share, mut shortest_refused) = (refused, refused);
    let mut longest = None;
    let mut confirmed = 0;
    for i in 0..HALVINGS + LEAPS {
        share *= if i < HALVINGS { 0.5 } else { LEAP };
        if fits(share) {
            longest = longest.or(Some(share));
            confirmed += 1;
            if confirmed > CONFIRMED {
                break;
            }
        } else {
            (longest, confirmed) = (None, 0);
            shortest_refused = share;
        }
    }
    Some((longest?, shortest_refused))
}

/// The boundary between a share that succeeds and one that fails, reduced by at most `precision`.
fn between(mut low: f64, mut high: f64, precision: f64, fits: &dyn Fn(f64) -> bool) -> f64 {
    // Octaves first.
    while high > 4.0 * low {
        let middle = (low * high).sqrt();
        *if fits(middle) { &mut low } else { &mut high } = middle;
    }
    while high - low > precision * low {
        let middle = 0.5 * (low + high);
        *if fits(middle) { &mut low } else { &mut high } = middle;
    }
    low
}

#[cfg(test)]
mod tests {
    use super::{confirmed_step, largest_step};
    use core::cell::Cell;

    #[test]
    fn a_search_in_a_trial_of_another_is_left_out() {
        let (trials, inner) = (Cell::new(0), Cell::new(0));
        let found = largest_step(30.0, |h| {
            trials.set(trials.get() + 1);
            let none = largest_step(30.0, |h| {
                inner.set(inner.get() + 1);
                Some(h)
            });
            assert_eq!(none, 0.0);
            Some(h)
        });
        assert!((found - 1.0).abs() < 2e-12);
        assert_eq!(inner.get(), 0);
        assert!(trials.get() < 100, "{}", trials.get());
        // The next search is independent.
        assert!(largest_step(2.0, Some) > 0.9);
    }

    #[test]
    fn the_shortest_step_is_tried_and_no_shorter() {
        let least = Cell::new(1.0);
        let refused = |h| {
            least.set(h);
            None
        };
        assert_eq!(largest_step(1.0, refused), 0.0);
        assert_eq!(least.get(), super::SHORTEST_SHARE);
        assert_eq!(super::SHORTEST_SHARE, 2.0_f64.powi(-380));
    }

    #[test]
    fn far_too_long_steps_are_reduced_to_the_bound() {
        for h in [1.1, 30.0, 1e6, 1e30, 1e100, -7.0] {
            let found = largest_step(h, |h: f64| Some(h.abs()));
            assert!((found.abs() - 1.0).abs() < 2e-12, "{h}: {found}");
            assert_eq!(found > 0.0, h > 0.0);
        }
        assert_eq!(largest_step(0.5, Some), 0.5);
        assert_eq!(largest_step(1.0, |h| Some(h * 1e300)), 0.0);
        assert_eq!(largest_step(1.0, |_| Some(f64::NAN)), 0.0);
    }

    #[test]
    fn what_cheap_trials_find_is_confirmed() {
        for bound in [0.9, 0.03, 1e-9, 2.0] {
            let (cheap, dear) = (Cell::new(0), Cell::new(0));
            let below = |bound: f64, trials: &Cell<u32>, share: f64| {
                trials.set(trials.get() + 1);
                (share < bound).then_some(0.0)
            };
            let found = confirmed_step(&|x| below(bound, &cheap, x), &|x| below(bound, &dear, x));
            let wanted = bound.min(1.0);
            assert!(
                wanted * (1.0 - 2e-6) < found && found <= wanted,
                "{bound}: {found}"
            );
            assert!(
                cheap.get() < 70 && dear.get() == 1,
                "{bound}: {cheap:?} {dear:?}"
            );
            // Expensive trials fail more often: first slightly more often, then nearly always.
            for refused in [0.95 * bound, 1e-5 * bound] {
                let found =
                    confirmed_step(&|x| below(bound, &cheap, x), &|x| below(refused, &dear, x));
                assert!(
                    0.9 * refused.min(1.0) < found && found <= refused.min(1.0),
                    "{found}"
                );
            }
        }
    }

    #[test]
    fn solutions_beyond_the_bound_are_passed_over() {
        let trials = Cell::new(0);
        for island in [(1800.0, 3800.0), (1.3, 1.6), (1.06, 1.12), (5.0, 11.0)] {
            let solvable = |h: f64| {
                trials.set(trials.get() + 1);
                (h < 1.0 || (h > island.0 && h < island.1)).then_some(0.0)
            };
            let found = largest_step(1e4, solvable);
            assert!((found - 1.0).abs() < 1e-12, "{island:?}: {found}");
        }
        assert!(trials.get() < 4 * 250, "{}", trials.get());
    }
}
