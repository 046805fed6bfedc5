//! A map: values over time and sites as colours, with a colour scale.

use super::figure::{Area, centred, fine, text};
use crate::words::number;
use plotters::chart::ChartContext;
use plotters::coord::cartesian::Cartesian2d;
use plotters::coord::ranged1d::Ranged;
use plotters::prelude::{Color, RGBColor, Rectangle, SVGBackend, Text, WHITE};

/// Values at sites and times.
#[derive(Clone, Debug)]
pub struct Map {
    /// Times of the columns.
    pub times: Vec<f64>,
    /// The end of the last column.
    pub end: f64,
    /// The sites with a value at each time.
    pub rows: Vec<(usize, Vec<f64>)>,
    /// A sentence that replaces the map if it holds at all sites and times: `zero throughout`.
    pub said: Option<String>,
}

/// The colour scale from low to high: five colours of "viridis", whose order is clear with any colour vision.
/// Source: N. Smith and S. van der Walt, matplotlib (2015).
const SCALE: [(u8, u8, u8); 5] = [
    (68, 1, 84),
    (59, 82, 139),
    (33, 145, 140),
    (94, 201, 98),
    (253, 231, 37),
];

/// The colour of a fraction of the range, from 0 to 1.
pub(super) fn color(part: f64) -> RGBColor {
    let at = part.clamp(0.0, 1.0) * (SCALE.len() - 1) as f64;
    let below = (at.floor() as usize).min(SCALE.len() - 2);
    let rest = at - below as f64;
    let (a, b) = (SCALE[below], SCALE[below + 1]);
    let mix = |a: u8, b: u8| (f64::from(a) + rest * (f64::from(b) - f64::from(a))).round() as u8;
    RGBColor(mix(a.0, b.0), mix(a.1, b.1), mix(a.2, b.2))
}

impl Map {
    /// The smallest and the largest value. If all values are equal, a range of length one around them.
    pub(super) fn range(&self) -> (f64, f64) {
        let values = self.rows.iter().flat_map(|(_, row)| row);
        let finite = values.copied().filter(|v| v.is_finite());
        let (low, high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| {
            (a.min(v), b.max(v))
        });
        match low <= high {
            false => (-0.5, 0.5),
            true if high - low > 1e-12 * low.abs().max(high.abs()) => (low, high),
            true => (low - 0.5, low + 0.5),
        }
    }

    /// Draws the cells.
    pub(super) fn draw<X, Y>(
        &self,
        chart: &mut ChartContext<'_, SVGBackend<'_>, Cartesian2d<X, Y>>,
    ) -> Result<(), Box<dyn std::error::Error>>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        if let Some(words) = &self.said {
            let (x, y) = (chart.x_range(), chart.y_range());
            let middle = (0.5 * (x.start + x.end), 0.5 * (y.start + y.end));
            let words = Text::new(words.clone(), middle, centred(13));
            chart.draw_series(std::iter::once(words))?;
            return Ok(());
        }
        let (low, high) = self.range();
        let top = self.rows.last().map_or(0.5, |(site, _)| *site as f64 + 0.5);
        for (site, row) in &self.rows {
            let at = *site as f64;
            // Each cell extends to the end and to the top, and the later cells cover it. This avoids seams.
            let cells = row.iter().enumerate().map(|(i, v)| {
                let from = self.times.get(i).copied().unwrap_or(self.end);
                let fill = match v.is_finite() {
                    true => color((v - low) / (high - low)).filled(),
                    false => WHITE.filled(),
                };
                Rectangle::new([(from, at - 0.5), (self.end, top)], fill)
            });
            chart.draw_series(cells)?;
        }
        Ok(())
    }

    /// The colour scale, from high to low, with three numbers. Nothing is drawn if a sentence replaces the map.
    pub(super) fn legend(&self, area: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
        if self.said.is_some() {
            return Ok(());
        }
        let (low, high) = self.range();
        const STEPS: i32 = 40;
        const TOP: i32 = 30;
        const TALL: i32 = 3;
        let unit = fine(1).cast_signed();
        for step in 0..STEPS {
            let part = 1.0 - f64::from(step) / f64::from(STEPS - 1);
            let y = TOP + TALL * step;
            let corners = [
                (6 * unit, y * unit),
                (20 * unit, (TOP + TALL * STEPS) * unit),
            ];
            area.draw(&Rectangle::new(corners, color(part).filled()))?;
        }
        for (part, y) in [
            (1.0, TOP),
            (0.5, TOP + TALL * STEPS / 2),
            (0.0, TOP + TALL * STEPS),
        ] {
            let value = low + part * (high - low);
            let words = number::plain(rounded(value, high - low)).replace('-', "−");
            text(area, &words, 11, RGBColor(30, 30, 30), (26, y - 7))?;
        }
        Ok(())
    }
}

/// Three digits of the range.
fn rounded(value: f64, range: f64) -> f64 {
    let unit = 10_f64.powf((range.abs().max(f64::MIN_POSITIVE)).log10().floor() - 2.0);
    let whole = (value / unit).round() * unit;
    // The product of an integer and a power of ten has rounding errors in its digits.
    let value: f64 = format!("{whole:.12e}").parse().unwrap_or(whole);
    // Adding zero turns -0 into 0.
    value + 0.0
}
