//! The limit of values for small steps, if the values depend on the square of the step. Polynomials through the values
//! are extrapolated (Neville), and the one with the smallest estimated error is used (Ridders). Takes values at halved
//! steps, in blocks of values of similar size; gives the limits with their errors.

/// The largest number of steps.
const MOST: usize = 14;

/// The typical rounding error, as a fraction of its bound.
const BOUND_OF_ROUNDING: f64 = 1.0 / 16.0;

/// The values of a block.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Block {
    /// The values.
    pub values: Vec<f64>,
    /// Bounds on the rounding error of each value.
    pub rounding: Vec<f64>,
    /// Whether values are taken for zero that are within these bounds.
    pub snaps: bool,
}

/// The limit of a block.
#[derive(Clone, Debug, PartialEq)]
pub struct Refined {
    /// The values; zero if rounding explains a value.
    pub values: Vec<f64>,
    /// An estimate of the largest of their errors.
    pub error: f64,
    /// The largest bound on rounding at the steps of the estimate.
    pub rounding: f64,
}

/// The limits of the blocks of `at` at steps 1, 1/2, 1/4, ...
///
/// # Errors
/// The errors of `at`.
pub fn limit<E>(mut at: impl FnMut(u32) -> Result<Vec<Block>, E>) -> Result<Vec<Refined>, E> {
    let mut best: Vec<Refined> = Vec::new();
    let mut rows: Vec<Vec<Vec<f64>>> = Vec::new();
    for level in 0..MOST {
        let blocks = at(u32::try_from(level).unwrap_or(0))?;
        rows.resize(blocks.len(), Vec::new());
        let nothing = Refined {
            values: Vec::new(),
            error: f64::INFINITY,
            rounding: 0.0,
        };
        best.resize(blocks.len(), nothing);
        let mut all_good = true;
        for ((block, row), best) in blocks.into_iter().zip(&mut rows).zip(&mut best) {
            all_good &= extrapolated(block, row, best);
        }
        if all_good {
            break;
        }
    }
    Ok(best)
}

/// Adds the values of a step to the table of a block; returns true if the best estimate has reached the rounding
/// level.
fn extrapolated(block: Block, row: &mut Vec<Vec<f64>>, best: &mut Refined) -> bool {
    let rounding = block.rounding.iter().fold(0.0, |a, x| f64::max(a, *x));
    let mut is_good = false;
    let mut next = vec![block.values];
    let mut power = 1.0;
    for before in row.iter() {
        power *= 4.0;
        let Some(own) = next.last() else { break };
        let each = own.iter().zip(before);
        let better: Vec<f64> = each.map(|(x, y)| x + (x - y) / (power - 1.0)).collect();
        let apart = distance(&better, own).max(distance(&better, before));
        let error = apart + BOUND_OF_ROUNDING * rounding;
        is_good |= apart <= rounding;
        if error < best.error {
            let each = better.iter().zip(&block.rounding);
            let values = each.map(|(x, r)| match block.snaps && x.abs() <= *r {
                true => 0.0,
                false => *x,
            });
            *best = Refined {
                values: values.collect(),
                error,
                rounding,
            };
        }
        next.push(better);
    }
    *row = next;
    is_good
}

/// The largest difference, or infinity if a difference is not a number.
fn distance(a: &[f64], b: &[f64]) -> f64 {
    let each = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    each.fold(0.0, |most, d| match d.is_nan() {
        true => f64::INFINITY,
        false => f64::max(most, d),
    })
}

#[cfg(test)]
mod tests {
    use super::{Block, Refined, limit};

    fn of(f: impl Fn(f64) -> f64) -> Refined {
        let found = limit(|level| {
            let value = f(0.5_f64.powi(i32::try_from(level).unwrap_or(0)));
            Ok::<_, ()>(vec![Block {
                values: vec![value],
                rounding: vec![1e-15 * value.abs()],
                snaps: false,
            }])
        });
        let mut found = found.expect("nothing fails");
        found.pop().expect("there is one block")
    }

    #[test]
    fn limits_are_found_to_rounding() {
        let sine = of(|h| (2.0 * h).sin() / h);
        assert!((sine.values[0] - 2.0).abs() < 1e-14, "{sine:?}");
        assert_eq!(of(|h| 3.0 + h * h).values, [3.0]);
        // If there is no limit, the estimate has a large error.
        let none = of(|h| 1.0 / h);
        assert!(none.error > 0.1, "{none:?}");
        // Values that are NaN are ignored.
        let root = of(|h| (0.3 - h * h).sqrt());
        assert!((root.values[0] - 0.3_f64.sqrt()).abs() < 1e-12, "{root:?}");
    }
}
