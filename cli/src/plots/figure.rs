//! Draws panels one above the other, each with its legend next to it, so that it hides no data.
//! Takes curves and axes; gives an SVG.

use super::axis::Axis;
use super::curve::{Curve, Marks, Stroke};
use super::map::Map;
use plotters::coord::Shift;
use plotters::prelude::{
    ChartBuilder, Circle, Color, DashedLineSeries, DrawingArea, IntoDrawingArea, LineSeries,
    PathElement, RGBColor, SVGBackend, ShapeStyle, Text, WHITE,
};
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters::style::{IntoFont, TextStyle};

/// The backend rounds to whole pixels. At this magnification the rounding is invisible.
const FINE: u32 = 4;
const WIDTH: u32 = 860;
const INK: RGBColor = RGBColor(30, 30, 30);
const FAINT: RGBColor = RGBColor(110, 110, 110);
const GRID: RGBColor = RGBColor(232, 232, 232);
const HEAD: u32 = 52;
const FOOT: u32 = 50;
const EDGE: u32 = 4;
/// The offset of legends below a chart.
const LEFT: u32 = 24;
/// Width of a column of a paper.
const COLUMN: u32 = 430;
/// The fraction of the width that a colour scale next to a chart takes.
const SCALE: u32 = 88;
/// The largest number of characters of a caption there.
const CAPTION: usize = 60;

/// Panels that share the axis of time.
#[derive(Clone, Debug)]
pub struct Figure {
    /// Above everything.
    pub title: String,
    /// Below the title, smaller.
    pub subtitle: String,
    /// The axis that all panels share.
    pub x: Axis,
    /// The quantity on this axis, with its unit.
    pub x_label: String,
    /// From above.
    pub panels: Vec<Panel>,
    /// For a column of a paper: as wide as that, without titles, legends below their charts.
    pub paper: bool,
}

/// One chart.
#[derive(Clone, Debug)]
pub struct Panel {
    /// Above the chart.
    pub caption: String,
    /// The quantity on the vertical axis, with its unit.
    pub y_label: String,
    /// The vertical axis.
    pub y: Axis,
    /// The curves, drawn in this order.
    pub curves: Vec<Curve>,
    /// Colours over time and sites, below the curves.
    pub map: Option<Map>,
    /// Height in pixels, caption included.
    pub height: u32,
}

/// The width in pixels of a legend text in the widest common font, up to a number of characters.
fn width_of(text: &str, most: usize) -> u32 {
    let tenths = text.chars().take(most).map(|letter| match letter {
        'm' | 'w' | 'M' | 'W' => 120,
        'f' | 'i' | 'j' | 'l' | 'r' | 't' | 'I' | ' ' | '.' | ',' | ':' | ';' | '(' | ')' => 51,
        '+' | '=' | '<' | '>' | '−' | '∝' | 'ω' => 101,
        'A'..='Z' => 95,
        _ => 77,
    });
    tenths.sum::<u32>().div_ceil(10)
}

pub(super) type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

impl Figure {
    /// The figure as SVG.
    ///
    /// # Errors
    /// The message of the drawing library.
    pub fn svg(&self) -> Result<String, String> {
        let head = if self.paper { EDGE } else { HEAD };
        let below = |panel: &Panel| if self.paper { panel.legend_height() } else { 0 };
        let panels = self
            .panels
            .iter()
            .map(|panel| panel.height(self.paper) + below(panel));
        let height = head + panels.sum::<u32>() + FOOT + EDGE;
        let width = if self.paper { COLUMN } else { WIDTH };
        let mut svg = String::new();
        {
            let backend = SVGBackend::with_string(&mut svg, (width * FINE, height * FINE));
            let root = backend.into_drawing_area();
            self.draw(&root).map_err(|error| error.to_string())?;
        }
        // The view box keeps the fine coordinates; the size on the page is the size in pixels.
        let fine = format!("width=\"{}\" height=\"{}\"", width * FINE, height * FINE);
        let plain = match self.paper {
            true => super::sphere::printed_size(f64::from(width), f64::from(height)),
            false => format!("width=\"{WIDTH}\" height=\"{height}\""),
        };
        let svg = svg.replacen(&fine, &plain, 1);
        Ok(match self.panels.iter().any(|panel| panel.map.is_some()) {
            // Adjacent cells are drawn without a line between them.
            true => svg.replacen("<svg ", "<svg shape-rendering=\"crispEdges\" ", 1),
            false => svg,
        })
    }

    fn draw(&self, root: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
        root.fill(&WHITE)?;
        let (_, mut rest) = root.split_vertically(fine(if self.paper { EDGE } else { HEAD }));
        if !self.paper {
            text(root, &self.title, 16, INK, (16, 10))?;
            text(root, &self.subtitle, 12, FAINT, (16, 31))?;
        }
        let legend = self
            .panels
            .iter()
            .map(Panel::legend_width)
            .max()
            .unwrap_or(0);
        // Charts of one figure share their time axis, so all charts leave space if one has a colour scale.
        let scale = match self.panels.iter().any(Panel::has_scale) {
            true => SCALE,
            false => 0,
        };
        let last = self.panels.len().saturating_sub(1);
        for (index, panel) in self.panels.iter().enumerate() {
            let foot = if index == last { FOOT } else { 0 };
            let (area, below) = rest.split_vertically(fine(panel.height(self.paper) + foot));
            rest = below;
            if self.paper {
                let x_label = (index == last).then_some(self.x_label.as_str());
                let (chart, scale) = area.split_horizontally(fine(COLUMN - scale));
                panel.chart(&chart, &self.x, x_label)?;
                if let Some(map) = &panel.map {
                    map.legend(&scale)?;
                }
                let caption: String = match panel.caption.chars().count() {
                    ..=CAPTION => panel.caption.clone(),
                    _ => panel
                        .caption
                        .chars()
                        .take(CAPTION - 1)
                        .chain(['…'])
                        .collect(),
                };
                text(&area, &caption, 12, INK, (LEFT.cast_signed(), 3))?;
                let (beside, below) = rest.split_vertically(fine(panel.legend_height()));
                rest = below;
                panel.legend_in_lines(&beside)?;
                continue;
            }
            let (chart, beside) = area.split_horizontally(fine(WIDTH - legend));
            let x_label = (index == last).then_some(self.x_label.as_str());
            text(&chart, &panel.caption, 13, INK, (84, 2))?;
            panel.chart(&chart, &self.x, x_label)?;
            panel.legend(&beside)?;
        }
        root.present()?;
        Ok(())
    }
}

impl Panel {
    fn chart(
        &self,
        area: &Area<'_>,
        x: &Axis,
        x_label: Option<&str>,
    ) -> Result<(), Box<dyn std::error::Error>> {
        let y_label = self.y.described(&self.y_label);
        let mut chart = ChartBuilder::on(area)
            .margin_top(fine(24))
            .margin_right(fine(14))
            .margin_left(fine(8))
            .x_label_area_size(fine(if x_label.is_some() { FOOT } else { 10 }))
            .y_label_area_size(fine(76))
            .build_cartesian_2d(x.clone(), self.y.clone())?;
        let x_words = |value: &f64| match x_label {
            Some(_) => plotters::coord::ranged1d::ValueFormatter::format_ext(x, value),
            None => String::new(),
        };
        let y_words =
            |value: &f64| plotters::coord::ranged1d::ValueFormatter::format_ext(&self.y, value);
        let x_described = x_label.map_or_else(String::new, |label| x.described(label));
        chart
            .configure_mesh()
            .bold_line_style(line(GRID, 3))
            .light_line_style(line(WHITE, 0))
            .axis_style(line(INK, 4))
            .set_all_tick_mark_size(fine(4))
            .label_style(style(12, INK))
            .axis_desc_style(style(13, INK))
            .x_label_formatter(&x_words)
            .y_label_formatter(&y_words)
            .x_desc(x_described)
            .y_desc(y_label)
            .draw()?;
        if let Some(map) = &self.map {
            map.draw(&mut chart)?;
        }
        for curve in &self.curves {
            let points = curve
                .points
                .iter()
                .copied()
                .filter(|point| point.1.is_finite());
            let stroke = line(curve.stroke.color, 5);
            match curve.stroke.dash {
                None => chart.draw_series(LineSeries::new(points, stroke))?,
                Some((dash, gap)) => chart.draw_series(DashedLineSeries::new(
                    points,
                    fine(dash),
                    fine(gap),
                    stroke,
                ))?,
            };
            let inside = curve.points.iter().filter(|point| point.1.is_finite());
            chart.draw_series(inside.flat_map(|point| mark(*point, curve.stroke)))?;
        }
        Ok(())
    }

    /// Whether a colour scale is drawn next to the chart.
    fn has_scale(&self) -> bool {
        self.map.as_ref().is_some_and(|map| map.said.is_none())
    }

    /// The height of the panel. On paper the legend is below the chart, so the height is limited.
    fn height(&self, paper: bool) -> u32 {
        match paper {
            true => self.height.min(230),
            false => self.height,
        }
    }

    /// The entries of a legend below the chart: the line of each, and its offset from the left.
    fn lines(&self) -> Vec<(u32, u32, String, Stroke)> {
        let (mut line, mut at) = (0, LEFT);
        let mut all = Vec::new();
        for curve in self.curves.iter().filter(|curve| !curve.label.is_empty()) {
            let words = match &curve.note {
                Some(note) => format!("{}: {note}", curve.label),
                None => curve.label.clone(),
            };
            let wide = 40 + width_of(&words, 100);
            if at > LEFT && at + wide > COLUMN {
                (line, at) = (line + 1, LEFT);
            }
            all.push((line, at, words, curve.stroke));
            at += wide;
        }
        all
    }

    /// The height of a legend below the chart. A map has its colour scale next to the chart instead.
    fn legend_height(&self) -> u32 {
        match self.lines().last() {
            Some((line, ..)) => 18 * (line + 1) + 8,
            None => 0,
        }
    }

    fn legend_in_lines(&self, area: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
        for (line, at, words, stroke) in self.lines() {
            let (x, y) = (at.cast_signed(), (2 + 18 * line).cast_signed());
            sample(area, stroke, (x, y))?;
            text(area, &words, 12, INK, (x + 28, y))?;
        }
        Ok(())
    }

    /// Space for the longest text of the legend, at 7.3 pixels for each character: the width in the widest common
    /// font.
    fn legend_width(&self) -> u32 {
        if self.has_scale() {
            return 100;
        }
        let notes = self.curves.iter().filter_map(|curve| curve.note.as_ref());
        let texts = self.curves.iter().map(|curve| &curve.label).chain(notes);
        let widest = texts.map(|text| width_of(text, 60)).max().unwrap_or(0);
        (40 + widest).max(70)
    }

    fn legend(&self, area: &Area<'_>) -> Result<(), Box<dyn std::error::Error>> {
        if let Some(map) = &self.map {
            return map.legend(area);
        }
        let mut y = 28;
        for curve in self.curves.iter().filter(|curve| !curve.label.is_empty()) {
            sample(area, curve.stroke, (0, y))?;
            text(area, &curve.label, 12, INK, (32, y))?;
            y += 17;
            if let Some(note) = &curve.note {
                text(area, note, 11, FAINT, (32, y))?;
                y += 20;
            }
        }
        Ok(())
    }
}

/// The mark of a data point: a disc, or a circle on a white disc.
fn mark<P: Copy>(place: P, stroke: Stroke) -> Vec<Circle<P, i32>> {
    let disc = |color: RGBColor| Circle::new(place, 3 * fine(1).cast_signed(), color.filled());
    match stroke.marks {
        Marks::None => Vec::new(),
        Marks::Full => vec![disc(stroke.color)],
        Marks::Hollow => vec![
            disc(WHITE),
            Circle::new(place, 3 * fine(1).cast_signed(), line(stroke.color, 5)),
        ],
    }
}

/// A short piece of the curve, next to its label.
fn sample(
    area: &Area<'_>,
    stroke: Stroke,
    (x, y): (i32, i32),
) -> Result<(), Box<dyn std::error::Error>> {
    let level = (y + 7) * fine(1).cast_signed();
    let ends = [
        ((x + 4) * fine(1).cast_signed(), level),
        ((x + 26) * fine(1).cast_signed(), level),
    ];
    let pen = line(stroke.color, 7);
    match stroke.dash {
        None => area.draw(&PathElement::new(ends.to_vec(), pen))?,
        Some(_) => {
            let [(left, _), (right, _)] = ends;
            let third = (right - left) / 3;
            area.draw(&PathElement::new(
                vec![(left, level), (left + third, level)],
                pen,
            ))?;
            area.draw(&PathElement::new(
                vec![(right - third, level), (right, level)],
                pen,
            ))?;
        }
    }
    for mark in mark(((x + 15) * fine(1).cast_signed(), level), stroke) {
        area.draw(&mark)?;
    }
    Ok(())
}

pub(super) fn text(
    area: &Area<'_>,
    words: &str,
    size: u32,
    color: RGBColor,
    (x, y): (i32, i32),
) -> Result<(), Box<dyn std::error::Error>> {
    let place = (x * fine(1).cast_signed(), y * fine(1).cast_signed());
    area.draw(&Text::new(words.to_owned(), place, style(size, color)))?;
    Ok(())
}

/// The backend divides font sizes by 1.24; this factor restores sizes in pixels.
fn style(size: u32, color: RGBColor) -> TextStyle<'static> {
    let size = f64::from(size * FINE) * 1.24;
    TextStyle {
        font: ("sans-serif", size).into_font(),
        color: color.to_backend_color(),
        pos: Pos::new(HPos::Left, VPos::Top),
    }
}

/// Like `style`, with the text centred at its position.
pub(super) fn centred(size: u32) -> TextStyle<'static> {
    TextStyle {
        pos: Pos::new(HPos::Center, VPos::Center),
        ..style(size, INK)
    }
}

/// A pen of `quarters` quarter pixels.
fn line(color: RGBColor, quarters: u32) -> ShapeStyle {
    color.stroke_width(quarters * FINE / 4)
}

pub(super) const fn fine(pixels: u32) -> u32 {
    pixels * FINE
}

#[cfg(test)]
mod tests {
    use super::width_of;

    /// Advances of characters at 12 pixels in DejaVu Sans, or in Verdana if that is wider.
    #[test]
    fn legends_have_room_for_their_texts() {
        for (text, wide) in [
            ("body_momentum", 108),
            ("spatial_momentum", 125),
            ("order 2", 46),
            ("Lambda", 45),
            ("mmmmmm", 71),
        ] {
            assert!(width_of(text, 60) >= wide, "{text}");
        }
    }
}
