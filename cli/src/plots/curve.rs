//! A curve of a plot and how it is stroked.
//! Takes an index; gives a colour that readers with any colour vision tell from its neighbours.

use plotters::style::RGBColor;

/// Okabe and Ito's palette without its yellow, which is too faint on white, in an order that separates neighbours.
/// Source: Okabe and Ito, Color Universal Design (2008).
const PALETTE: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(0, 0, 0),
    RGBColor(230, 159, 0),
    RGBColor(86, 180, 233),
];

/// Points to be joined, with an entry in the legend unless the label is empty.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name in the legend.
    pub label: String,
    /// A second, fainter line under the label.
    pub note: Option<String>,
    /// Time and value; for a logarithmic axis the decimal logarithm.
    pub points: Vec<(f64, f64)>,
    /// Its colour and dashes.
    pub stroke: Stroke,
}

/// Colour and dashes of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Stroke {
    /// Its colour.
    pub color: RGBColor,
    /// Lengths of dash and gap in pixels; `None` for a solid line.
    pub dash: Option<(u32, u32)>,
    /// The marks of the points, if a curve joins measurements.
    pub marks: Marks,
}

/// Marks at the points of a curve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marks {
    /// None.
    #[default]
    None,
    /// Discs.
    Full,
    /// Circles.
    Hollow,
}

impl Stroke {
    /// The stroke of curve `index`: first solid lines in all colours, then the same colours with longer and longer
    /// dashes.
    pub fn number(index: usize) -> Self {
        let color = PALETTE.get(index % PALETTE.len()).copied();
        Self {
            color: color.unwrap_or(RGBColor(0, 0, 0)),
            dash: match index / PALETTE.len() {
                0 => None,
                1 => Some((8, 4)),
                _ => Some((14, 4)),
            },
            marks: Marks::None,
        }
    }

    /// A dashed line in this colour, for the bound of the curve.
    pub fn dashed(self) -> Self {
        Self {
            dash: Some((4, 4)),
            ..self
        }
    }

    /// Member `index` of a family of `count` curves: shades of one blue, the last one darkest.
    pub fn shade(index: usize, count: usize) -> Self {
        let part = index as f64 / count.saturating_sub(1).max(1) as f64;
        // From a blue that is visible on white to one that is nearly black.
        let mix = |light: f64, dark: f64| (light + (dark - light) * part.min(1.0)) as u8;
        Self {
            color: RGBColor(mix(150.0, 0.0), mix(196.0, 34.0), mix(232.0, 92.0)),
            dash: None,
            marks: Marks::None,
        }
    }

    /// This curve with marked points.
    pub fn marked(self, marks: Marks) -> Self {
        Self { marks, ..self }
    }

    /// A bound that several curves have in common.
    pub fn shared_bound() -> Self {
        Self {
            color: RGBColor(110, 110, 110),
            dash: Some((4, 4)),
            marks: Marks::None,
        }
    }
}
