//! A map of the particles of a fluid at the first and the last sample, coloured by a functional of all sites: on the cells of
//! particles, or at the nodes of a grid below them; and one of the vorticity of cells. Takes a run; gives an SVG.

use super::cells::{area, around, cells_of, clipped, most_of};
use super::figure::{Area, fine, text};
use super::map::{Map, color};
use super::sphere::printed_size;
use super::window::Window;
use super::{Plot, subscript, titles};
use crate::case_file::space::Space;
use crate::output::Finished;
use crate::output::fluid::{Coloured, space};
use crate::output::sites::{AtSites, at_sites};
use crate::words::number;
use clebsch::record::Record;
use plotters::prelude::{
    Circle, Color, IntoDrawingArea, PathElement, Polygon, RGBColor, Rectangle, SVGBackend, WHITE,
};

/// Widest side of a panel, in pixels; of two in a column of a paper.
const SIDE: f64 = 360.0;
const PRINTED: f64 = 118.0;
const LEFT: i32 = 44;
/// The offset of the panels, below the title if there is one.
const TOP: i32 = 76;
const BARE: i32 = 26;
const GAP: i32 = 56;
/// Least room of a particle that is drawn above cells, in square pixels.
const ROOM: f64 = 30.0;
/// Least height, which the bar of colours takes.
const LEAST: i32 = 170;
const INK: RGBColor = RGBColor(30, 30, 30);
const FAINT: RGBColor = RGBColor(110, 110, 110);

/// A colour at a position.
pub(super) struct Mark {
    place: [f64; 2],
    value: f64,
}

/// The state at one sample: coloured marks or cells, and particles above them.
pub(super) struct Snapshot {
    pub(super) time: f64,
    pub(super) marks: Vec<Mark>,
    /// Cells instead of marks, by their corners.
    pub(super) cells: Vec<(Vec<[f64; 2]>, f64)>,
    pub(super) dots: Vec<[f64; 2]>,
    /// Radius of a mark, in pixels.
    pub(super) radius: f64,
}

/// Whether a run is a fluid in the plane. Its particles have no order along a chain, so they are drawn at their
/// positions.
pub(super) fn in_plane(run: &Finished<'_>) -> bool {
    space(run.card, run.plan).is_some_and(|(space, _)| space.lengths.len() > 1)
}

/// The picture; `None` if the model is not a fluid.
pub(crate) fn particles(run: &Finished<'_>, record: &Record) -> Plot {
    let all = at_sites(run.card);
    let Some(Coloured {
        space,
        places,
        shown,
        what,
    }) = Coloured::of(run.card, run.plan, &all)
    else {
        return Ok(None);
    };
    let count = record.times.len();
    let picked = [0, count.saturating_sub(1)];
    let side = if run.plan.paper { PRINTED } else { SIDE };
    let shots = match cells_of(run, record, &picked, &shown.key) {
        Some(shots) => shots,
        None => picked.map(|sample| snapshot(record, sample, &space, (places, shown), side)),
    };
    let names = [&what, &shown.name, &places.name].map(String::as_str);
    titled(run, record, names, (&space, &shots, side))
}

/// The vorticity of a fluid with cells; `None` for other models.
pub(crate) fn vorticity(run: &Finished<'_>, record: &Record) -> Plot {
    let Some((space, stated)) = space(run.card, run.plan) else {
        return Ok(None);
    };
    let side = if run.plan.paper { PRINTED } else { SIDE };
    let picked = [0, record.times.len().saturating_sub(1)];
    match cells_of(run, record, &picked, "vorticity") {
        None => Ok(None),
        Some(mut shots) => {
            let all = shots.iter().flat_map(|s| s.cells.iter().map(|(_, v)| *v));
            let (low, high) = most_of(all.collect());
            let each = shots.iter_mut().flat_map(|s| &mut s.cells);
            each.for_each(|(_, v)| *v = v.clamp(low, high));
            let what = "vorticity (colour scale clipped at the 99th percentile)";
            let places = stated.lattice.places().map(|q| q.name.text.as_str());
            let names = [what, "vorticity", places.unwrap_or_default()];
            titled(run, record, names, (&space, &shots, side))
        }
    }
}

/// Two samples below the titles of a run: the quantity, its name above the colours, and the name of positions
/// at the axes.
fn titled(
    run: &Finished<'_>,
    record: &Record,
    [what, colours, places]: [&str; 3],
    (space, shots, side): (&Space, &[Snapshot; 2], f64),
) -> Plot {
    let count = record.times.len();
    let window = Window {
        record,
        count,
        cut: false,
    };
    let titles = titles(run, window, what);
    let titles = (!run.plan.paper).then_some(titles);
    draw(titles, [colours, places], space, shots, side).map(Some)
}

fn snapshot(
    record: &Record,
    sample: usize,
    space: &Space,
    (places, shown): (&AtSites<'_>, &AtSites<'_>),
    side: f64,
) -> Snapshot {
    let at = |column: usize| {
        let mut own = record.observables.column(column);
        own.nth(sample).unwrap_or(f64::NAN)
    };
    let values: Vec<f64> = shown.members.iter().map(|(_, c)| at(c.start)).collect();
    let place = |columns: &std::ops::Range<usize>| -> Vec<f64> {
        let each = columns.clone().zip(&space.lengths).zip(&space.walls);
        each.map(|((c, length), solid)| match solid {
            true => at(c),
            false => at(c).rem_euclid(*length),
        })
        .collect()
    };
    let particles = places.members.iter().map(|(_, c)| place(c));
    let nodes = (shown.index != places.index).then(|| space.nodes().map(|(x, _)| x));
    let (on, dots) = match nodes {
        Some(Ok(nodes)) => (nodes, particles.collect()),
        _ => (particles.collect(), Vec::new()),
    };
    // On a line the value is the height.
    let marks: Vec<Mark> = on
        .iter()
        .zip(&values)
        .map(|(x, value)| Mark {
            place: match x.as_slice() {
                [x, y] => [*x, *y],
                [x] => [*x, *value],
                _ => [f64::NAN; 2],
            },
            value: *value,
        })
        .collect();
    let dots = dots.iter().filter_map(|x: &Vec<f64>| match x.as_slice() {
        [x, y] => Some([*x, *y]),
        _ => None,
    });
    let (radius, room) = match space.lengths.as_slice() {
        // As large as the area of each particle permits.
        [width, height] => {
            let longest = width.max(*height);
            let whole = width * height * (side / longest).powi(2);
            let room = whole / marks.len().max(1) as f64;
            ((0.55 * room.sqrt()).clamp(1.0, 16.0), whole)
        }
        _ => (2.5, 0.0),
    };
    let on_grid = shown.index != places.index && space.lengths.len() == 2;
    let (marks, cells) = match on_grid {
        true => {
            let each = on.iter().zip(&values);
            (
                Vec::new(),
                each.filter_map(|(x, v)| Some((around(space, x)?, *v)))
                    .collect(),
            )
        }
        false => (marks, Vec::new()),
    };
    let dots: Vec<[f64; 2]> = dots.collect();
    // If the dots would cover the colours, they are omitted.
    let dots = if ROOM * dots.len() as f64 > room {
        Vec::new()
    } else {
        dots
    };
    Snapshot {
        radius,
        time: record.times.get(sample).copied().unwrap_or(f64::NAN),
        marks,
        cells,
        dots,
    }
}

/// The box of a panel: its corner and its sides in pixels, and the ranges it shows.
struct Frame {
    corner: [f64; 2],
    side: [f64; 2],
    low: [f64; 2],
    high: [f64; 2],
}

impl Frame {
    /// The parts of a cell inside the panel. A cell across a periodic seam has parts on both sides.
    #[allow(clippy::cast_possible_truncation)]
    fn within(&self, corners: &[[f64; 2]]) -> Vec<Vec<(i32, i32)>> {
        let length = |d: usize| self.high[d] - self.low[d];
        let unit = f64::from(fine(1));
        let mut parts = Vec::new();
        for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (f64::from(i), f64::from(j)))) {
            let moved = |c: &[f64; 2]| {
                let part = |d: usize, by: f64| (c[d] - self.low[d]) / length(d) + by;
                [part(0, i), part(1, j)]
            };
            let inside = clipped(corners.iter().map(moved).collect());
            // A part that only touches the edge has zero area.
            if area(&inside) > 1e-12 {
                let at =
                    |d: usize, p: f64| ((self.corner[d] + p * self.side[d]) * unit).round() as i32;
                let drawn = inside.iter().map(|[x, y]| (at(0, *x), at(1, 1.0 - y)));
                parts.push(drawn.collect());
            }
        }
        parts
    }

    #[allow(clippy::cast_possible_truncation)]
    fn at(&self, place: [f64; 2]) -> Option<(i32, i32)> {
        let part = |d: usize| (place[d] - self.low[d]) / (self.high[d] - self.low[d]);
        let (x, y) = (part(0), 1.0 - part(1));
        let inside = |p: f64| (-0.01..=1.01).contains(&p);
        let unit = f64::from(fine(1));
        (inside(x) && inside(y)).then(|| {
            let at = |d: usize, p: f64| ((self.corner[d] + p * self.side[d]) * unit).round() as i32;
            (at(0, x), at(1, y))
        })
    }
}

#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
fn draw(
    titles: Option<(String, String)>,
    [colours, places]: [&str; 2],
    space: &Space,
    shots: &[Snapshot; 2],
    longest_side: f64,
) -> Result<String, String> {
    let values = shots.iter().flat_map(|s| {
        let of_cells = s.cells.iter().map(|(_, value)| *value);
        s.marks.iter().map(|m| m.value).chain(of_cells)
    });
    let map = Map {
        times: Vec::new(),
        end: 0.0,
        rows: vec![(0, values.collect())],
        said: None,
    };
    let (low, high) = map.range();
    let (bottom, top, side) = match space.lengths.as_slice() {
        [width, height] => {
            let longest = width.max(*height);
            (
                0.0,
                *height,
                [width, height].map(|l| (longest_side * l / longest).max(40.0)),
            )
        }
        _ => {
            let room = 0.05 * (high - low);
            (low - room, high + room, [longest_side, 0.6 * longest_side])
        }
    };
    let length = space.lengths.first().copied().unwrap_or(1.0);
    let wide = LEFT * 2 + GAP + 2 * side[0] as i32 + 90;
    let above = if titles.is_some() { TOP } else { BARE };
    let tall = above + (side[1] as i32 + 44).max(LEAST - BARE);
    let (wide, tall) = (wide as u32, tall as u32);
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (fine(wide), fine(tall))).into_drawing_area();
        let all = || -> Result<(), Box<dyn std::error::Error>> {
            root.fill(&WHITE)?;
            if let Some((title, subtitle)) = &titles {
                text(&root, title, 16, INK, (16, 10))?;
                text(&root, subtitle, 12, FAINT, (16, 31))?;
            }
            for (k, shot) in shots.iter().enumerate() {
                let left = f64::from(LEFT) + k as f64 * (side[0] + f64::from(GAP));
                let frame = Frame {
                    corner: [left, f64::from(above)],
                    side,
                    low: [0.0, bottom],
                    high: [length, top],
                };
                panel(&root, &frame, shot, [low, high])?;
                axes(&root, &frame, [colours, places], space.lengths.len())?;
            }
            let (_, right) = root.split_horizontally(fine(wide - 90));
            let (_, right) = right.split_vertically(fine(above as u32 - 26));
            map.legend(&right)?;
            text(&right, colours, 12, INK, (6, 6))?;
            root.present()?;
            Ok(())
        };
        all().map_err(|e| e.to_string())?;
    }
    let large = format!("width=\"{}\" height=\"{}\"", fine(wide), fine(tall));
    let printed = match titles {
        Some(_) => format!("width=\"{wide}\" height=\"{tall}\""),
        None => printed_size(f64::from(wide), f64::from(tall)),
    };
    Ok(svg.replacen(&large, &printed, 1))
}

/// The labels at the axes of a panel: the components of the position, or in one dimension the position and the
/// value.
#[allow(clippy::cast_possible_truncation)]
fn axes(
    root: &Area<'_>,
    frame: &Frame,
    [value, places]: [&str; 2],
    dimensions: usize,
) -> Result<(), Box<dyn std::error::Error>> {
    let middle = |d: usize| (frame.corner[d] + 0.5 * frame.side[d]) as i32;
    let [across, up] = match dimensions {
        1 => [places.to_owned(), value.to_owned()],
        _ => [1, 2].map(|d| format!("{places}{}", subscript(d))),
    };
    let below = (frame.corner[1] + frame.side[1]) as i32 + 4;
    text(root, &across, 12, INK, (middle(0), below))?;
    let left = frame.corner[0] as i32 - 24;
    text(root, &up, 12, INK, (left, middle(1) - 7))
}

#[allow(clippy::cast_possible_truncation)]
fn panel(
    root: &Area<'_>,
    frame: &Frame,
    shot: &Snapshot,
    [low, high]: [f64; 2],
) -> Result<(), Box<dyn std::error::Error>> {
    let unit = fine(1).cast_signed();
    let corner = |d: usize, p: f64| (frame.corner[d] + p * frame.side[d]) as i32;
    let (left, right, up, down) = (
        corner(0, 0.0),
        corner(0, 1.0),
        corner(1, 0.0),
        corner(1, 1.0),
    );
    for (corners, value) in shot.cells.iter().filter(|(_, v)| v.is_finite()) {
        let color = color((value - low) / (high - low));
        for part in frame.within(corners) {
            // Neighbours are adjacent without a seam.
            root.draw(&Polygon::new(part.clone(), color.filled()))?;
            root.draw(&PathElement::new(part, color.stroke_width(fine(1))))?;
        }
    }
    let edge = [(left * unit, up * unit), (right * unit, down * unit)];
    root.draw(&Rectangle::new(edge, INK.stroke_width(fine(1))))?;
    let time = format!("t = {}", number::plain(shot.time));
    text(root, &time, 13, INK, (left, up - 20))?;
    text(
        root,
        &number::short(frame.low[0]),
        11,
        INK,
        (left, down + 4),
    )?;
    text(
        root,
        &number::short(frame.high[0]),
        11,
        INK,
        (right - 10, down + 4),
    )?;
    text(
        root,
        &number::short(frame.high[1]),
        11,
        INK,
        (left - 38, up),
    )?;
    text(
        root,
        &number::short(frame.low[1]),
        11,
        INK,
        (left - 38, down - 12),
    )?;
    let radius = shot.radius * f64::from(fine(1));
    for mark in &shot.marks {
        if let Some(at) = frame.at(mark.place).filter(|_| mark.value.is_finite()) {
            let fill = color((mark.value - low) / (high - low)).filled();
            root.draw(&Circle::new(at, radius as i32, fill))?;
        }
    }
    for dot in &shot.dots {
        if let Some(at) = frame.at(*dot) {
            root.draw(&Circle::new(at, unit, FAINT.filled()))?;
        }
    }
    Ok(())
}
