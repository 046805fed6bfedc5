//! The figure: error against CPU time on logarithmic axes, one curve per method, as SVG.

use super::precision::{MOMENTS, MOMENTUM, TIME};
use super::timing::Measured;
use clebsch_cli::plots::axis::Axis;
use clebsch_cli::plots::curve::{Curve, Marks, Stroke};
use clebsch_cli::plots::figure::{Figure, Panel};

/// The distinct methods, in the order of their measurements.
pub fn methods(measured: &[Measured]) -> Vec<&str> {
    let mut methods: Vec<&str> = Vec::new();
    for m in measured {
        if !methods.contains(&m.method.as_str()) {
            methods.push(&m.method);
        }
    }
    methods
}

/// The prefix of the generated steppers' names.
const OWN: &str = "generated";

/// The figure as SVG.
pub fn svg(measured: &[Measured]) -> Result<String, String> {
    // Methods that are too slow for these axes; the tables contain them.
    let drawn = |method: &&str| !["fixed point", "PyElastica", "SciPy RK45"].contains(method);
    let shown: Vec<&str> = methods(measured).into_iter().filter(drawn).collect();
    let family = shown.iter().filter(|m| m.starts_with(OWN)).count();
    let (mut own, mut others) = (0, 0);
    let curves: Vec<Curve> = shown
        .into_iter()
        .map(|method| {
            let points = measured.iter().filter(|m| m.method == method);
            let points: Vec<(f64, f64)> = points
                .filter(|m| m.error.is_finite() && m.error < 3.0)
                .map(|m| (m.micros.log10(), m.error.log10()))
                .collect();
            // The generated steppers in shades of blue, which no other method uses.
            let stroke = if method.starts_with(OWN) {
                own += 1;
                Stroke::shade(own - 1, family).marked(Marks::Full)
            } else {
                others += 1;
                // Six colours with dashed lines, then the same colours with solid lines.
                let stroke = Stroke::number(others + (others - 1) / 6);
                Stroke {
                    dash: (others <= 6).then_some((6, 4)),
                    ..stroke.marked(Marks::Hollow)
                }
            };
            Curve {
                label: method.to_owned(),
                note: None,
                points,
                stroke,
            }
        })
        .collect();
    let x = Axis::decades_around(curves.iter().flat_map(|c| &c.points).map(|point| point.0));
    let panel = Panel {
        map: None,
        caption: "error at the end: momentum (relative) or attitude (radians), the larger"
            .to_owned(),
        y_label: "error".to_owned(),
        y: Axis::decades(&curves),
        curves,
        height: 440,
    };
    let figure = Figure {
        title: format!("Free rigid body until time {TIME}: work and precision"),
        subtitle: format!(
            "I = {}, M = {}; each point a step or a tolerance",
            triple(MOMENTS),
            triple(MOMENTUM)
        ),
        x,
        x_label: "processor time of one trajectory, microseconds".to_owned(),
        panels: vec![panel],
        paper: false,
    };
    figure.svg()
}

fn triple([a, b, c]: [f64; 3]) -> String {
    format!("({a}, {b}, {c})")
}
