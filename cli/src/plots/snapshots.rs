//! The shape of a line at eight times: the curve of its places in the plane or in space, or a field over its sites.
//! Takes a run; gives an SVG of two rows of panels, nothing for models without a line.

use super::figure::{Area, fine, text};
use super::sphere::{COLUMN, WIDE, printed_size, view};
use super::window::Window;
use super::{Plot, axis, titles};
use crate::output::Finished;
use crate::output::sites::{AtSites, at_sites};
use crate::page::places::{Places, Point};
use clebsch::record::Record;
use clebsch::scalar::largest;
use clebsch_core::lattice::Sites;
use plotters::prelude::{
    Circle, Color, IntoDrawingArea, PathElement, RGBColor, Rectangle, SVGBackend, WHITE,
};

const SHOTS: usize = 8;
const COLUMNS: usize = 4;
/// Most points of a curve: more are not told apart in a panel.
const POINTS: usize = 400;
const GAP: f64 = 14.0;
const LEFT: f64 = 16.0;
/// Where panels begin, below the title if there is one.
const TOP: f64 = 58.0;
const BARE: f64 = 8.0;
/// Above each panel for its time, below all for the scale.
const ABOVE: f64 = 26.0;
const BELOW: f64 = 44.0;
const INK: RGBColor = RGBColor(30, 30, 30);
const FAINT: RGBColor = RGBColor(150, 150, 150);
const CURVE: RGBColor = RGBColor(0, 90, 156);

/// The picture; nothing for models that have no field on a line.
pub(crate) fn snapshots(run: &Finished<'_>, record: &Record) -> Plot {
    let all = at_sites(run.card);
    let on_line = |d: usize| {
        let own = all
            .iter()
            .find(|q| q.on_line && q.moves && q.field.count() == d);
        own.filter(|q| q.field.cols == 1 || d == 1)
    };
    let Some(field) = on_line(3).or(on_line(2)).or(on_line(1)) else {
        return Ok(None);
    };
    let shots = shots(run, record, field);
    let Some(strip) = Strip::of(field, shots) else {
        return Ok(None);
    };
    let window = Window {
        record,
        count: record.times.len(),
        cut: false,
    };
    let what = match field.field.count() {
        1 => format!("{} along the line", field.name),
        _ => format!("shape of {}", field.name),
    };
    let titles = (!run.plan.paper).then(|| titles(run, window, &what));
    strip.svg(titles).map(Some)
}

/// The line at one sample.
struct Shot {
    time: f64,
    points: Vec<Vec<f64>>,
}

/// Eight samples from the first to the last, with those points that ends hold.
fn shots(run: &Finished<'_>, record: &Record, field: &AtSites<'_>) -> Vec<Shot> {
    let sites = field.members.iter().map(|(site, _)| *site);
    let (first, last) = (sites.clone().min().unwrap_or(0), sites.max().unwrap_or(0));
    let places = Places::themselves((run.card, run.plan), field);
    let stride = (last - first + 1).div_ceil(POINTS).max(1);
    let known = |site: usize| places.point(isize::try_from(site).ok()?);
    let mut wanted: Vec<usize> = (first..=last).step_by(stride).collect();
    if wanted.last() != Some(&last) {
        wanted.push(last);
    }
    // What an end holds has no columns; once around a ring stands the first node again.
    if first > 0 {
        wanted.insert(0, first - 1);
    }
    if field.at == Sites::Nodes {
        wanted.push(last + 1);
    }
    let points: Vec<Point> = wanted.into_iter().filter_map(known).collect();
    let count = record.times.len();
    let mut picked: Vec<usize> = (0..SHOTS)
        .map(|k| k * count.saturating_sub(1) / (SHOTS - 1))
        .collect();
    picked.dedup();
    let shot = |sample: usize| {
        let row = record.observables.rows().nth(sample).unwrap_or_default();
        Shot {
            time: record.times.get(sample).copied().unwrap_or(f64::NAN),
            points: points.iter().map(|p| p.at(row)).collect(),
        }
    };
    picked.into_iter().map(shot).collect()
}

/// What the two directions of a panel are.
enum Seen {
    /// The coordinates with these numbers.
    Plane([usize; 2]),
    /// All three, from one side.
    Space,
    /// The number of the point, and a number.
    Graph,
}

/// Curves in panels of one scale.
struct Strip {
    seen: Seen,
    times: Vec<f64>,
    curves: Vec<Vec<[f64; 2]>>,
    low: [f64; 2],
    high: [f64; 2],
}

impl Strip {
    /// `None` where there is nothing that can be drawn.
    fn of(field: &AtSites<'_>, shots: Vec<Shot>) -> Option<Self> {
        let all = || shots.iter().flat_map(|s| &s.points);
        let range = |d: usize| {
            let own = all().filter_map(|p| p.get(d)).filter(|x| x.is_finite());
            own.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(*x), b.max(*x))
            })
        };
        let seen = match field.field.count() {
            1 => Seen::Graph,
            2 => Seen::Plane([0, 1]),
            _ => {
                let widths = [0, 1, 2].map(|d| range(d).1 - range(d).0);
                let widest = largest(widths);
                let flat = (0..3).find(|d| widths[*d] <= 1e-6 * widest);
                match flat {
                    Some(0) => Seen::Plane([1, 2]),
                    Some(1) => Seen::Plane([0, 2]),
                    Some(_) => Seen::Plane([0, 1]),
                    None => Seen::Space,
                }
            }
        };
        let [right, up, _] = view();
        let put = |(k, p): (usize, &Vec<f64>)| {
            let at = |d: usize| p.get(d).copied().unwrap_or(f64::NAN);
            match seen {
                Seen::Graph => [k as f64, at(0)],
                Seen::Plane([a, b]) => [at(a), at(b)],
                Seen::Space => [&right, &up].map(|v| (0..3).map(|d| v[d] * at(d)).sum()),
            }
        };
        let curve = |shot: &Shot| -> Vec<[f64; 2]> {
            let all = shot.points.iter().enumerate().map(put);
            all.filter(|p| p.iter().all(|x| x.is_finite())).collect()
        };
        let curves: Vec<Vec<[f64; 2]>> = shots.iter().map(curve).collect();
        let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for d in 0..2 {
            for point in curves.iter().flatten() {
                low[d] = low[d].min(point[d]);
                high[d] = high[d].max(point[d]);
            }
        }
        let widest = largest((0..2).map(|d| high[d] - low[d]));
        if !widest.is_finite() || widest <= 0.0 {
            return None;
        }
        let graph = matches!(seen, Seen::Graph);
        for d in 0..2 {
            let own = high[d] - low[d];
            // A graph fills its panel; a shape has one scale both ways, in panels not too flat to be seen.
            let least = if graph { own.max(1e-300) } else { 0.4 * widest };
            let wide = 1.1 * own.max(least);
            let middle = 0.5 * (low[d] + high[d]);
            (low[d], high[d]) = (middle - 0.5 * wide, middle + 0.5 * wide);
        }
        Some(Strip {
            seen,
            times: shots.iter().map(|s| s.time).collect(),
            curves,
            low,
            high,
        })
    }

    fn wide(&self, d: usize) -> f64 {
        self.high[d] - self.low[d]
    }

    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn svg(&self, titles: Option<(String, String)>) -> Result<String, String> {
        let whole = if titles.is_some() { WIDE } else { COLUMN };
        let top = if titles.is_some() { TOP } else { BARE };
        let columns = COLUMNS as f64;
        let width = (whole - 2.0 * LEFT - GAP * (columns - 1.0)) / columns;
        let ratio = match self.seen {
            Seen::Graph => 0.7,
            _ => (self.wide(1) / self.wide(0)).min(1.6),
        };
        let side = [width, (width * ratio).round()];
        let rows = self.curves.len().div_ceil(COLUMNS) as f64;
        let tall = (top + rows * (side[1] + ABOVE) + BELOW) as u32;
        let mut svg = String::new();
        {
            let size = (fine(whole as u32), fine(tall));
            let root = SVGBackend::with_string(&mut svg, size).into_drawing_area();
            let all = || -> Result<(), Box<dyn std::error::Error>> {
                root.fill(&WHITE)?;
                if let Some((title, subtitle)) = &titles {
                    text(&root, title, 16, INK, (16, 10))?;
                    text(&root, subtitle, 12, FAINT, (16, 31))?;
                }
                for (k, (curve, time)) in self.curves.iter().zip(&self.times).enumerate() {
                    let (row, column) = ((k / COLUMNS) as f64, (k % COLUMNS) as f64);
                    let corner = [
                        LEFT + column * (width + GAP),
                        top + row * (side[1] + ABOVE) + ABOVE,
                    ];
                    self.panel(&root, curve, *time, (corner, side))?;
                }
                let below = top + rows * (side[1] + ABOVE);
                self.scale(&root, [LEFT, below + 14.0], side)?;
                root.present()?;
                Ok(())
            };
            all().map_err(|e| e.to_string())?;
        }
        let large = format!("width=\"{}\" height=\"{}\"", fine(whole as u32), fine(tall));
        let printed = match titles {
            Some(_) => format!("width=\"{whole}\" height=\"{tall}\""),
            None => printed_size(whole, f64::from(tall)),
        };
        Ok(svg.replacen(&large, &printed, 1))
    }

    fn panel(
        &self,
        root: &Area<'_>,
        curve: &[[f64; 2]],
        time: f64,
        (corner, side): ([f64; 2], [f64; 2]),
    ) -> Result<(), Box<dyn std::error::Error>> {
        let far = [corner[0] + side[0], corner[1] + side[1]];
        let edge = [pixel(corner), pixel(far)];
        root.draw(&Rectangle::new(edge, FAINT.stroke_width(fine(1) / 2)))?;
        let words = format!("t = {}", axis::short(time));
        #[allow(clippy::cast_possible_truncation)]
        let above = (corner[0] as i32, corner[1] as i32 - 17);
        text(root, &words, 12, INK, above)?;
        // One scale both ways, the shape in the middle; a graph fills its panel.
        let unit = [side[0] / self.wide(0), side[1] / self.wide(1)];
        let unit = match self.seen {
            Seen::Graph => unit,
            _ => [unit[0].min(unit[1]); 2],
        };
        let middle = |d: usize| 0.5 * (self.low[d] + self.high[d]);
        let at = |p: &[f64; 2]| {
            let part = |d: usize| (p[d] - middle(d)) * unit[d];
            pixel([
                corner[0] + 0.5 * side[0] + part(0),
                corner[1] + 0.5 * side[1] - part(1),
            ])
        };
        let drawn: Vec<(i32, i32)> = curve.iter().map(at).collect();
        if let Some(first) = drawn.first() {
            root.draw(&Circle::new(
                *first,
                3 * fine(1).cast_signed(),
                CURVE.filled(),
            ))?;
        }
        root.draw(&PathElement::new(drawn, CURVE.stroke_width(fine(3) / 2)))?;
        Ok(())
    }

    /// A length of one digit below the first panel, and what the directions are.
    fn scale(
        &self,
        root: &Area<'_>,
        [left, top]: [f64; 2],
        side: [f64; 2],
    ) -> Result<(), Box<dyn std::error::Error>> {
        let unit = match self.seen {
            Seen::Graph => {
                let words = format!(
                    "from site to site; between {} and {}; a dot at the first site",
                    axis::short(self.low[1]),
                    axis::short(self.high[1])
                );
                #[allow(clippy::cast_possible_truncation)]
                return text(root, &words, 12, INK, (left as i32, top as i32));
            }
            _ => (side[0] / self.wide(0)).min(side[1] / self.wide(1)),
        };
        let most = 0.5 * side[0] / unit;
        let power = 10_f64.powf(most.log10().floor());
        let times = [5.0, 2.0, 1.0].into_iter().find(|x| x * power <= most);
        let length = times.unwrap_or(1.0) * power;
        let ends = [[left, top + 6.0], [left + length * unit, top + 6.0]].map(pixel);
        root.draw(&PathElement::new(ends, INK.stroke_width(fine(2))))?;
        let seen = match self.seen {
            Seen::Plane([a, b]) => format!("component {} to the right, {} up", a + 1, b + 1),
            _ => "seen from one side, component 3 up".to_owned(),
        };
        let words = format!("{}; {seen}; a dot at the first site", axis::short(length));
        #[allow(clippy::cast_possible_truncation)]
        text(
            root,
            &words,
            12,
            INK,
            ((left + length * unit) as i32 + 8, top as i32),
        )
    }
}

#[allow(clippy::cast_possible_truncation)]
fn pixel(place: [f64; 2]) -> (i32, i32) {
    let at = |d: usize| (place[d] * f64::from(fine(1))).round() as i32;
    (at(0), at(1))
}
