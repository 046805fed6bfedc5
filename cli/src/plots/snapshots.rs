//! The shape of a chain at eight times: its positions in the planes of their largest components, or a field
//! over its sites.
//! Takes a run; gives an SVG with two rows of panels per plane, or `None` for a model without a chain.

use super::figure::{Area, fine, text};
use super::sphere::{COLUMN, WIDE, printed_size};
use super::window::Window;
use super::{Plot, subscript, titles};
use crate::output::Finished;
use crate::output::places::{Places, Point};
use crate::output::sites::{AtSites, at_sites};
use crate::words::number;
use clebsch::record::Record;
use clebsch::scalar::largest;
use clebsch_core::lattice::Sites;
use plotters::prelude::{
    Circle, Color, IntoDrawingArea, PathElement, RGBColor, Rectangle, SVGBackend, WHITE,
};

const SHOTS: usize = 8;
const COLUMNS: usize = 4;
/// The largest number of points of a curve. More points could not be distinguished in a panel.
const POINTS: usize = 400;
const GAP: f64 = 14.0;
const LEFT: f64 = 32.0;
/// Margin to the right of the last panel.
const RIGHT: f64 = 16.0;
/// The offset of the panels, below the title if there is one.
const TOP: f64 = 58.0;
const BARE: f64 = 8.0;
/// Space above each panel for its time, and below all panels for the scale.
const ABOVE: f64 = 26.0;
const BELOW: f64 = 52.0;
/// If the third extent exceeds this fraction of the largest extent, it gets its own plane.
const DEEP: f64 = 0.1;
const INK: RGBColor = RGBColor(30, 30, 30);
const FAINT: RGBColor = RGBColor(150, 150, 150);
const CURVE: RGBColor = RGBColor(0, 90, 156);

/// The picture; `None` if the model has no field on a chain.
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
    let Some(strip) = Strip::of(field, &shots) else {
        return Ok(None);
    };
    let window = Window {
        record,
        count: record.times.len(),
        cut: false,
    };
    let what = match field.field.count() {
        1 => format!("{} along the line", field.name),
        2 => format!("shape of {}", field.name),
        _ => format!("shape of {}, {}", field.name, strip.seen()),
    };
    let titles = (!run.plan.paper).then(|| titles(run, window, &what));
    strip.svg(titles).map(Some)
}

/// The line at one sample.
struct Shot {
    time: f64,
    points: Vec<Vec<f64>>,
}

/// Eight samples from the first to the last, including points with prescribed positions.
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
    // A prescribed value does not have a column. On a ring, the first node is repeated at the end.
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

/// The two axes of a panel.
#[derive(Clone, Copy)]
enum PanelAxes {
    /// The coordinates with these numbers.
    Plane([usize; 2]),
    /// The number of the point, and a number.
    Graph,
}

/// The planes in which points with three coordinates are drawn, from the range of each. The first plane has the
/// two largest ranges. If the third range is not small, a second plane has the third range and the largest.
fn planes(extents: [f64; 3]) -> Vec<PanelAxes> {
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| extents[*b].total_cmp(&extents[*a]));
    let [most, second, third] = order;
    let plane = |a: usize, b: usize| PanelAxes::Plane([a.min(b), a.max(b)]);
    let mut all = vec![plane(most, second)];
    if extents[third] > DEEP * extents[most] {
        all.push(plane(most, third));
    }
    all
}

/// Curves in panels with one scale, with a block of panels for each plane.
struct Strip {
    /// The name of the drawn quantity, for the axes.
    name: String,
    times: Vec<f64>,
    blocks: Vec<Block>,
}

/// The curves of one plane.
struct Block {
    seen: PanelAxes,
    curves: Vec<Vec<[f64; 2]>>,
    low: [f64; 2],
    high: [f64; 2],
}

impl Strip {
    /// `None` if nothing can be drawn.
    fn of(field: &AtSites<'_>, shots: &[Shot]) -> Option<Self> {
        let extent = |d: usize| {
            let all = shots.iter().flat_map(|s| &s.points);
            let own = all.filter_map(|p| p.get(d)).filter(|x| x.is_finite());
            let (low, high) = own.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
                (a.min(*x), b.max(*x))
            });
            high - low
        };
        let seen = match field.field.count() {
            1 => vec![PanelAxes::Graph],
            2 => vec![PanelAxes::Plane([0, 1])],
            _ => planes([0, 1, 2].map(extent)),
        };
        let blocks = seen.into_iter().map(|seen| Block::of(seen, shots));
        Some(Strip {
            name: field.name.clone(),
            times: shots.iter().map(|s| s.time).collect(),
            blocks: blocks.collect::<Option<_>>()?,
        })
    }

    /// The planes, for the title: `components 1 and 3`.
    fn seen(&self) -> String {
        let plane = |block: &Block| match block.seen {
            PanelAxes::Plane([a, b]) => Some(format!("{} and {}", a + 1, b + 1)),
            PanelAxes::Graph => None,
        };
        let all: Vec<String> = self.blocks.iter().filter_map(plane).collect();
        format!("components {}", all.join(", below "))
    }
}

impl Block {
    /// `None` if nothing can be drawn.
    fn of(seen: PanelAxes, shots: &[Shot]) -> Option<Self> {
        let put = |(k, p): (usize, &Vec<f64>)| {
            let at = |d: usize| p.get(d).copied().unwrap_or(f64::NAN);
            match seen {
                PanelAxes::Graph => [k as f64, at(0)],
                PanelAxes::Plane([a, b]) => [at(a), at(b)],
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
        let graph = matches!(seen, PanelAxes::Graph);
        for d in 0..2 {
            let own = high[d] - low[d];
            // A graph fills its panel. A shape has one scale in both directions, in panels with a minimal
            // height.
            let least = if graph { own.max(1e-300) } else { 0.4 * widest };
            let wide = 1.1 * own.max(least);
            let middle = 0.5 * (low[d] + high[d]);
            (low[d], high[d]) = (middle - 0.5 * wide, middle + 0.5 * wide);
        }
        Some(Block {
            seen,
            curves,
            low,
            high,
        })
    }

    fn wide(&self, d: usize) -> f64 {
        self.high[d] - self.low[d]
    }

    /// The sides of a panel, in pixels.
    fn side(&self, width: f64) -> [f64; 2] {
        let ratio = match self.seen {
            PanelAxes::Graph => 0.7,
            PanelAxes::Plane(_) => (self.wide(1) / self.wide(0)).min(1.6),
        };
        [width, (width * ratio).round()]
    }

    /// Pixels for a unit along each direction. A shape has the same scale along both directions; a graph fills its
    /// panel.
    fn unit(&self, side: [f64; 2]) -> [f64; 2] {
        let unit = [side[0] / self.wide(0), side[1] / self.wide(1)];
        match self.seen {
            PanelAxes::Graph => unit,
            PanelAxes::Plane(_) => [unit[0].min(unit[1]); 2],
        }
    }
}

impl Strip {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    fn svg(&self, titles: Option<(String, String)>) -> Result<String, String> {
        let whole = if titles.is_some() { WIDE } else { COLUMN };
        let top = if titles.is_some() { TOP } else { BARE };
        let columns = COLUMNS as f64;
        let width = (whole - LEFT - RIGHT - GAP * (columns - 1.0)) / columns;
        let rows = self.times.len().div_ceil(COLUMNS) as f64;
        let height = |block: &Block| rows * (block.side(width)[1] + ABOVE) + BELOW;
        let tall = (top + self.blocks.iter().map(height).sum::<f64>()) as u32;
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
                let mut top = top;
                for block in &self.blocks {
                    let side = block.side(width);
                    for (k, (curve, time)) in block.curves.iter().zip(&self.times).enumerate() {
                        let (row, column) = ((k / COLUMNS) as f64, (k % COLUMNS) as f64);
                        let corner = [
                            LEFT + column * (width + GAP),
                            top + row * (side[1] + ABOVE) + ABOVE,
                        ];
                        block.panel(&root, curve, *time, (corner, side))?;
                    }
                    let below = top + rows * (side[1] + ABOVE);
                    block.axes(&root, &self.name, [below - side[1], below], width)?;
                    block.scale(&root, [LEFT, below + 22.0], side)?;
                    top += height(block);
                }
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
}

impl Block {
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
        let words = format!("t = {}", number::short(time));
        #[allow(clippy::cast_possible_truncation)]
        let above = (corner[0] as i32, corner[1] as i32 - 17);
        text(root, &words, 12, INK, above)?;
        // The shape in the middle of its panel.
        let unit = self.unit(side);
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

    /// The names of the components at the first panel of the last row, which extends between these heights.
    #[allow(clippy::cast_possible_truncation)]
    fn axes(
        &self,
        root: &Area<'_>,
        name: &str,
        [top, below]: [f64; 2],
        width: f64,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let PanelAxes::Plane(components) = self.seen else {
            return Ok(());
        };
        let [across, up] = components.map(|d| format!("{name}{}", subscript(d + 1)));
        let middle = (LEFT + 0.5 * width) as i32;
        text(root, &across, 12, INK, (middle, below as i32 + 4))?;
        let middle = (0.5 * (top + below)) as i32 - 7;
        text(root, &up, 12, INK, (8, middle))
    }

    /// A scale bar with a length of one digit below the first panel, and the names of the directions.
    fn scale(
        &self,
        root: &Area<'_>,
        [left, top]: [f64; 2],
        side: [f64; 2],
    ) -> Result<(), Box<dyn std::error::Error>> {
        let PanelAxes::Plane([across, up]) = self.seen else {
            let words = format!(
                "from site to site; between {} and {}; a dot at the first site",
                number::short(self.low[1]),
                number::short(self.high[1])
            );
            #[allow(clippy::cast_possible_truncation)]
            return text(root, &words, 12, INK, (left as i32, top as i32));
        };
        let [unit, _] = self.unit(side);
        let most = 0.5 * side[0] / unit;
        let power = 10_f64.powf(most.log10().floor());
        let times = [5.0, 2.0, 1.0].into_iter().find(|x| x * power <= most);
        let length = times.unwrap_or(1.0) * power;
        let ends = [[left, top + 6.0], [left + length * unit, top + 6.0]].map(pixel);
        root.draw(&PathElement::new(ends, INK.stroke_width(fine(2))))?;
        let seen = format!("component {} to the right, {} up", across + 1, up + 1);
        let words = format!("{}; {seen}; a dot at the first site", number::short(length));
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

#[cfg(test)]
mod tests {
    use super::{PanelAxes, planes};

    /// The planes as components, counted from one.
    fn seen(extents: [f64; 3]) -> Vec<[usize; 2]> {
        let own = |seen: PanelAxes| match seen {
            PanelAxes::Plane(plane) => plane.map(|d| d + 1),
            PanelAxes::Graph => [0, 0],
        };
        planes(extents).into_iter().map(own).collect()
    }

    #[test]
    fn the_largest_components_are_seen() {
        assert_eq!(seen([1.0, 0.0, 0.8]), [[1, 3]]);
        assert_eq!(seen([0.5, 2.0, 0.1]), [[1, 2]]);
        assert_eq!(seen([0.05, 1.0, 3.0]), [[2, 3]]);
        // A depth that is not small is drawn in a second plane, with the largest component.
        assert_eq!(seen([1.0, 0.2, 0.8]), [[1, 3], [1, 2]]);
        assert_eq!(seen([0.2, 0.4, 1.0]), [[2, 3], [1, 3]]);
        // A straight line.
        assert_eq!(seen([0.0, 0.0, 1.0]), [[1, 3]]);
    }
}
