//! The varied quantities of a sweep: `gU.z=0:1:100`, `h=0.1,0.05`, `kappa=2`.
//! Takes texts and a card; gives quantities with their values, and the values of each point of the grid.

use crate::case_file::Motion;
use crate::overrides::quantity::Quantity;
use crate::terminal::failure::Failure;
use crate::words::plain::shown;
use clebsch::card::Card;

/// The largest number of values of one quantity, so that a typing error does not fill the memory.
const MOST_VALUES: usize = 1_000_000;

/// The largest number of points of a sweep.
pub(super) const MOST_POINTS: u64 = 1_000_000_000;

/// A quantity and its values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// The quantity that is varied. Its name is the name of a column.
    pub(super) quantity: Quantity,
    pub(super) values: Vec<f64>,
}

impl Axis {
    /// Reads `NAME=FROM:TO:COUNT` or `NAME=VALUE,VALUE,...`. `case` is the text of the case, if it has one.
    ///
    /// # Errors
    /// Usage: the text is wrong; the message lists the names of the model.
    pub(super) fn read(
        text: &str,
        card: &Card,
        motion: &Motion,
        case: Option<&str>,
    ) -> Result<Self, Failure> {
        let wrong = |why: String| Failure::Usage(format!("--vary {}: {why}", shown(text)));
        let Some((name, values)) = text.split_once('=') else {
            return Err(wrong(
                "give NAME=FROM:TO:COUNT or NAME=VALUE,VALUE,..., such as gU.z=0:1:100".to_owned(),
            ));
        };
        let quantity = Quantity::of_case(name, card, motion, case).map_err(wrong)?;
        let values = read_values(values).map_err(wrong)?;
        Ok(Self { quantity, values })
    }
}

fn read_values(text: &str) -> Result<Vec<f64>, String> {
    let number = |text: &str| crate::words::number::value(text, &|_| None);
    let parts: Vec<&str> = text.split(':').collect();
    match parts.as_slice() {
        [from, to, count] => {
            let (from, to) = (number(from)?, number(to)?);
            let count = crate::words::number::whole(count.trim())
                .and_then(|count| usize::try_from(count).ok())
                .filter(|count| (1..=MOST_VALUES).contains(count))
                .ok_or_else(|| match count_of(from, to, count) {
                    Some(count) => {
                        format!("the third part is the number of values; write {from}:{to}:{count}")
                    }
                    None => format!("give 1 to {MOST_VALUES} values"),
                })?;
            if count == 1 {
                return Ok(vec![from]);
            }
            // The first and the last value are exactly the given numbers.
            let last = count - 1;
            let value = |i: usize| match i {
                _ if i == last => to,
                _ => from + (to - from) * (i as f64 / last as f64),
            };
            Ok((0..count).map(value).collect())
        }
        [list] => list.split(',').map(number).collect(),
        _ => Err("a range has three parts, FROM:TO:COUNT".to_owned()),
    }
}

/// The number of values of a range whose third part is probably a distance.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn count_of(from: f64, to: f64, distance: &str) -> Option<usize> {
    let distance = distance.trim().parse::<f64>().ok()?;
    let parts = ((to - from) / distance).abs().round();
    let fits = distance.fract() != 0.0 && parts.is_finite() && parts < MOST_VALUES as f64;
    fits.then_some(parts as usize + 1)
}

/// How many points all axes have together.
pub(super) fn points(axes: &[Axis]) -> Result<u64, Failure> {
    let all = axes
        .iter()
        .try_fold(1_u64, |n, axis| n.checked_mul(axis.values.len() as u64));
    all.filter(|n| *n <= MOST_POINTS)
        .ok_or_else(|| Failure::Usage(format!("a sweep can have at most {MOST_POINTS} points")))
}

/// The values of a point, one from each axis: the last axis varies fastest.
pub(super) fn at(axes: &[Axis], point: u64) -> Vec<f64> {
    let mut left = point;
    let mut values: Vec<f64> = axes
        .iter()
        .rev()
        .map(|axis| {
            let count = (axis.values.len() as u64).max(1);
            let own = usize::try_from(left % count).unwrap_or(0);
            left /= count;
            axis.values.get(own).copied().unwrap_or(f64::NAN)
        })
        .collect();
    values.reverse();
    values
}

#[cfg(test)]
mod tests {
    use super::{Axis, at, points, read_values};
    use crate::overrides::quantity::Quantity;

    #[test]
    fn ranges_hold_their_ends_and_lists_are_taken_as_they_are() {
        assert_eq!(
            read_values("0:0.3:4").expect("a range"),
            [0.0, 0.3 * (1.0 / 3.0), 0.3 * (2.0 / 3.0), 0.3]
        );
        assert_eq!(read_values("2:9:1").expect("a range"), [2.0]);
        assert_eq!(read_values("0.1, 1e-2").expect("a list"), [0.1, 0.01]);
        for wrong in ["", "1:2", "1:2:0", "1:inf:3", "a", "1,,2", "1:2:3:4"] {
            assert!(read_values(wrong).is_err(), "{wrong}");
        }
        let why = read_values("1:2:0.25").expect_err("no count");
        assert_eq!(why, "the third part is the number of values; write 1:2:5");
    }

    #[test]
    fn the_last_axis_varies_fastest() {
        let axis = |values: &[f64]| Axis {
            quantity: Quantity::step(),
            values: values.to_vec(),
        };
        let axes = [axis(&[1.0, 2.0]), axis(&[5.0, 6.0, 7.0])];
        assert_eq!(points(&axes), Ok(6));
        let all: Vec<Vec<f64>> = (0..6).map(|point| at(&axes, point)).collect();
        assert_eq!(all[1], [1.0, 6.0]);
        assert_eq!(all[3], [2.0, 5.0]);
        assert!(points(&vec![axis(&[0.0; 2000]); 3]).is_err());
    }
}
