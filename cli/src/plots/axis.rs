//! An axis: its range, its ticks and their labels. Takes a range of numbers or of decades; gives the limits of the
//! chart and ticks at round numbers.

use super::curve::Curve;
use super::power_of_ten;
use crate::words::number::plain;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use std::ops::Range;

/// Smaller drifts are drawn at this value: a tenth of the unit roundoff, so that rounding stays visible above it.
pub(crate) const FLOOR: f64 = 1e-17;

/// A linear axis, or one of decimal logarithms.
#[derive(Clone, Debug)]
pub struct Axis {
    low: f64,
    high: f64,
    ticks: Vec<(f64, String)>,
    /// Power of ten taken out of the labels.
    factor: Option<String>,
    /// The common part of all numbers, removed from the labels.
    offset: Option<String>,
}

/// If the numbers of an axis exceed the distance of its ticks by this many decades, labels show only the
/// differences.
const DECADES: f64 = 5.0;

/// Values that agree to this relative accuracy are drawn as a flat line, since their differences are rounding.
pub(crate) const ROUNDING: f64 = 1e-12;

impl Axis {
    /// The range from `low` to `high` without rounding, with about `count` ticks.
    pub fn linear(low: f64, high: f64, count: u32) -> Self {
        let (low, high) = if high > low {
            (low, high)
        } else {
            (low, low + 1.0)
        };
        let step = round_step((high - low) / f64::from(count.max(1)));
        let magnitude = low.abs().max(high.abs()).log10().floor();
        if magnitude - step.log10().floor() >= DECADES && low * high > 0.0 {
            return Self::beside_an_offset(low, high, step);
        }
        let exponent = if (-3.0..6.0).contains(&magnitude) {
            0.0
        } else {
            magnitude
        };
        let unit = 10_f64.powf(exponent);
        // The number of digits that distinguishes neighbouring ticks.
        let digits = (exponent - step.log10().floor()).clamp(0.0, 17.0) as usize;
        let mut ticks = Vec::new();
        let mut index = (low / step).ceil();
        while index * step <= high + step * 1e-9 {
            // Adding zero turns -0 into 0.
            let label = format!("{:.digits$}", index * step / unit + 0.0);
            ticks.push((index * step, label.replace('-', "−")));
            index += 1.0;
        }
        Self {
            low,
            high,
            ticks,
            factor: (exponent != 0.0).then(|| power_of_ten(exponent as i32)),
            offset: None,
        }
    }

    /// An axis for numbers that agree in many digits. The common digits are next to the axis, the others at its
    /// ticks.
    fn beside_an_offset(low: f64, high: f64, step: f64) -> Self {
        let decade = step.log10().floor();
        // Numbers with these digits are at least ten ticks apart.
        let unit = 10_f64.powf(decade + 1.0);
        let common = (0.5 * (low + high) / unit).floor();
        let digits = (-(decade + 1.0)).clamp(0.0, 17.0) as usize;
        let offset = common * unit;
        let of_unit = (unit / step).round();
        let mut ticks = Vec::new();
        let rounding = step * 1e-9 + 2.0 * f64::EPSILON * high.abs();
        let mut index = ((low - rounding - offset) / step).ceil();
        while offset + index * step <= high + rounding {
            // Steps are 1, 2 or 5 times the power of ten.
            let label = format!("{:.0}", index * 10.0 / of_unit + 0.0);
            ticks.push((offset + index * step, label.replace('-', "−")));
            index += 1.0;
        }
        let exponent = decade as i32;
        Self {
            low,
            high,
            ticks,
            factor: (exponent != 0).then(|| power_of_ten(exponent)),
            offset: Some(format!("{offset:.digits$}").replace('-', "−")),
        }
    }

    /// The label of the axis, followed by the part that was removed from the tick labels.
    pub fn described(&self, label: &str) -> String {
        match (&self.offset, &self.factor) {
            (None, None) => label.to_owned(),
            (None, Some(factor)) => format!("{label}   / {factor}"),
            (Some(offset), None) => format!("{label}   = {offset} + …"),
            (Some(offset), Some(factor)) => format!("{label}   = {offset} + … × {factor}"),
        }
    }

    /// The range from `low` to `high` with ticks only at integers, for sites.
    pub fn whole(low: f64, high: f64, count: u32) -> Self {
        let mut axis = Self::linear(low, high, count);
        axis.ticks.retain(|(at, _)| (at - at.round()).abs() < 1e-9);
        for (at, label) in &mut axis.ticks {
            *label = format!("{:.0}", at.round() + 0.0);
        }
        (axis.factor, axis.offset) = (None, None);
        axis
    }

    /// Around the values of `curves`, with a margin. Values that agree to twelve digits are drawn as a
    /// flat line, not as rounding noise.
    pub fn around(curves: &[Curve]) -> Self {
        Self::around_parts(curves, 0.0)
    }

    /// The axis for parts of a quantity of this `size`. Curves that vary only by its rounding are flat.
    pub fn around_parts(curves: &[Curve], size: f64) -> Self {
        let values = curves
            .iter()
            .flat_map(|curve| curve.points.iter().map(|point| point.1));
        let values = values.filter(|value| value.is_finite());
        let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        if low > high {
            return Self::linear(-1.0, 1.0, 5);
        }
        let largest = low.abs().max(high.abs());
        let size = size.max(largest);
        let margin = if high - low > ROUNDING * size {
            0.06 * (high - low)
        } else if largest > ROUNDING * size {
            // Wide enough that rounding is invisible.
            (0.2 * largest).max(200.0 * (high - low))
        } else if size > 0.0 {
            0.2 * size
        } else {
            1.0
        };
        Self::linear(low - margin, high + margin, 5)
    }

    /// A logarithmic axis around these positive values, with a tick at each of them.
    pub fn logarithmic(places: &[f64]) -> Self {
        let logarithms = || places.iter().map(|place| place.log10());
        let low = logarithms().fold(f64::INFINITY, f64::min);
        let high = logarithms().fold(f64::NEG_INFINITY, f64::max);
        let margin = 0.04 * (high - low).max(0.1);
        let label = |place: f64| {
            let exponent = place.log10();
            if place >= 1000.0 && exponent == exponent.round() {
                power_of_ten(exponent as i32)
            } else {
                plain(place)
            }
        };
        Self {
            low: low - margin,
            high: high + margin,
            ticks: places
                .iter()
                .map(|place| (place.log10(), label(*place)))
                .collect(),
            factor: None,
            offset: None,
        }
    }

    /// Whole decades around the logarithms in `curves`, not below the floor.
    pub fn decades(curves: &[Curve]) -> Self {
        let points = curves.iter().flat_map(|curve| &curve.points);
        Self::decades_around(points.map(|point| point.1))
    }

    /// Whole decades around logarithms, not below the floor.
    pub fn decades_around(logarithms: impl Iterator<Item = f64>) -> Self {
        let values = logarithms.filter(|value| value.is_finite());
        let floor = FLOOR.log10().round();
        let (low, high) = values.fold((f64::INFINITY, floor), |(low, high), value| {
            (low.min(value), high.max(value))
        });
        // A hair above a decade is on it.
        let low = (low.min(high) + 1e-9).floor();
        let clamped = low <= floor;
        let high = (high + 0.2).ceil().max(low + 2.0);
        let stride = ((high - low) / 9.0).ceil().max(1.0);
        let mut ticks = Vec::new();
        let mut exponent = low;
        while exponent <= high {
            let power = power_of_ten(exponent as i32);
            let at_floor = clamped && exponent == low;
            ticks.push((
                exponent,
                if at_floor {
                    format!("≤ {power}")
                } else {
                    power
                },
            ));
            exponent += stride;
        }
        Self {
            // Space below, so that the axis does not hide a curve on the floor.
            low: low - 0.02 * (high - low),
            high,
            ticks,
            factor: None,
            offset: None,
        }
    }
}

/// The number nearest to `step`, in ratio, among 1, 2 and 5 times a power of ten.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let multiples = [1.0, 2.0, 5.0].map(|multiple| multiple * power);
    let near = multiples.into_iter().find(|round| *round >= step / 1.45);
    near.unwrap_or(10.0 * power)
}

/// `⁻¹²`.
pub(crate) fn superscript(number: i32) -> String {
    let raised = |letter: char| match letter {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => digit
            .to_digit(10)
            .and_then(|digit| char::from_u32(0x2070 + digit))
            .unwrap_or(digit),
    };
    number.to_string().chars().map(raised).collect()
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    #[allow(clippy::cast_possible_truncation)]
    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let fraction = (value - self.low) / (self.high - self.low);
        limit.0 + (fraction * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() {
            return Vec::new();
        }
        self.ticks.iter().map(|tick| tick.0).collect()
    }

    fn range(&self) -> Range<f64> {
        self.low..self.high
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        let tick = self.ticks.iter().find(|tick| tick.0 == *value);
        tick.map_or_else(String::new, |tick| tick.1.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis) -> Vec<&str> {
        axis.ticks.iter().map(|tick| tick.1.as_str()).collect()
    }

    #[test]
    fn ticks_are_round_and_labels_are_short() {
        assert_eq!(
            labels(&Axis::linear(0.0, 1.0, 5)),
            ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]
        );
        assert_eq!(labels(&Axis::linear(-0.31, 0.3, 3)), ["−0.2", "0.0", "0.2"]);
        let small = Axis::linear(0.0, 4e-7, 4);
        assert_eq!(labels(&small), ["0", "1", "2", "3", "4"]);
        assert_eq!(small.factor.as_deref(), Some("10⁻⁷"));
        let large = Axis::linear(0.0, 1e6, 4);
        assert_eq!(labels(&large), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(large.factor.as_deref(), Some("10⁶"));
    }

    #[test]
    fn numbers_that_nearly_agree_are_told_from_what_they_have_in_common() {
        let axis = Axis::linear(1.234_567_890_1, 1.234_567_890_2, 5);
        assert_eq!(labels(&axis), ["0", "2", "4", "6", "8", "10"]);
        assert_eq!(
            axis.described("energy"),
            "energy   = 1.2345678901 + … × 10⁻¹¹"
        );
        let axis = Axis::linear(-1_234_567.4, -1_234_566.1, 5);
        assert_eq!(labels(&axis), ["−4", "−2", "0", "2", "4", "6", "8"]);
        assert_eq!(axis.described("x"), "x   = −1234567 + … × 10⁻¹");
        for (low, high) in [
            (1.0, 1.0 + 3e-7),
            (-5e9, -5e9 + 3.0),
            (7e-20, 7.000_001e-20),
        ] {
            let axis = Axis::linear(low, high, 5);
            let mut all = labels(&axis);
            let count = all.len();
            all.dedup();
            assert!(count > 2 && all.len() == count, "{all:?}");
        }
    }

    #[test]
    fn values_that_agree_are_a_flat_line() {
        let curve = Curve {
            label: String::new(),
            note: None,
            points: vec![(0.0, 1.0), (1.0, 1.0 + 1e-15)],
            stroke: super::super::Stroke::number(0),
        };
        let axis = Axis::around(&[curve]);
        assert!(axis.low < 0.9 && axis.high > 1.1);
        // Relative to other parts of the quantity: noise about zero, and a small number with the noise of a large
        // one.
        for (first, second) in [(1e-17, -3e-17), (1e-8, 1e-8 + 1e-14), (2e-12, 3e-12)] {
            let curve = Curve {
                label: String::new(),
                note: None,
                points: vec![(0.0, first), (1.0, second)],
                stroke: super::super::Stroke::number(0),
            };
            let axis = Axis::around_parts(std::slice::from_ref(&curve), 10.0);
            let seen = (first - second).abs() / (axis.high - axis.low);
            assert!(seen < 0.003, "{first}: {seen}");
            let own = Axis::around(&[curve]);
            assert!((first - second).abs() / (own.high - own.low) > 0.8);
        }
    }
}
