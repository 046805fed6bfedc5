//! Spheres with curves on them, seen from one side. The far side is drawn faint. Takes curves in space and functions
//! on a sphere; gives SVG text.

use clebsch::nalgebra::Vector3;
use std::fmt::Write;

type Vector = Vector3<f64>;

/// Width of a picture and of a column of a paper, in pixels; a column is printed 86 mm wide.
pub(super) const WIDE: f64 = 860.0;
pub(super) const COLUMN: f64 = 430.0;
/// Its width in print, in millimetres.
const COLUMN_IN_PRINT: f64 = 86.0;

/// The largest number of points of a curve, far more than are visible.
const MOST_POINTS: usize = 6000;

/// Cells of the grid on which lines of equal value are looked for: in latitude, and twice as many in longitude.
const CELLS: usize = 72;

/// Lines of equal value.
const LEVELS: usize = 9;

/// A curve in space.
#[derive(Clone, Debug)]
pub(super) struct Course(Vec<Vector>);

impl Course {
    /// The finite points, at most the largest number.
    pub(super) fn of(points: impl Iterator<Item = Vector>) -> Self {
        let all: Vec<Vector> = points.filter(|p| p.iter().all(|x| x.is_finite())).collect();
        let stride = all.len().div_ceil(MOST_POINTS).max(1);
        Self(all.into_iter().step_by(stride).collect())
    }
}

/// A sphere.
#[derive(Clone, Debug)]
pub(super) struct Sphere {
    /// Above it.
    pub(super) caption: String,
    /// In the unit of the curves.
    pub(super) radius: f64,
    /// Curves on it or in it.
    pub(super) courses: Vec<Course>,
    /// Pieces of lines of equal value.
    pub(super) contours: Vec<[Vector; 2]>,
}

/// The view directions: right, up, and towards the reader.
fn view() -> [Vector; 3] {
    let (azimuth, elevation) = (35.0_f64.to_radians(), 22.0_f64.to_radians());
    let towards = Vector::new(
        elevation.cos() * azimuth.cos(),
        elevation.cos() * azimuth.sin(),
        elevation.sin(),
    );
    let right = Vector::new(-azimuth.sin(), azimuth.cos(), 0.0);
    [right, towards.cross(&right), towards]
}

/// Pieces of the lines of equal value of `f` on the sphere of this radius, between its extremes.
pub(super) fn contours(radius: f64, f: &dyn Fn(&Vector) -> f64) -> Vec<[Vector; 2]> {
    let at = |i: usize, j: usize| {
        let theta = std::f64::consts::PI * i as f64 / CELLS as f64;
        let phi = std::f64::consts::PI * j as f64 / CELLS as f64;
        radius
            * Vector::new(
                theta.sin() * phi.cos(),
                theta.sin() * phi.sin(),
                theta.cos(),
            )
    };
    let grid = || (0..CELLS).flat_map(|i| (0..2 * CELLS).map(move |j| (i, j)));
    let values = grid().map(|(i, j)| f(&at(i, j))).filter(|x| x.is_finite());
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| {
        (a.min(x), b.max(x))
    });
    // A function that is constant up to rounding has no contours.
    let varies = high - low > 1e-9 * low.abs().max(high.abs());
    if !varies {
        return Vec::new();
    }
    let mut pieces = Vec::new();
    for number in 0..LEVELS {
        let level = low + (high - low) * (number as f64 + 0.5) / LEVELS as f64;
        for (i, j) in grid() {
            let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            let sides = corners.iter().zip(corners.iter().cycle().skip(1));
            let crossed = sides.filter_map(|(a, b)| {
                let (x, y) = (f(a) - level, f(b) - level);
                ((x < 0.0) != (y < 0.0)).then(|| {
                    let point = a + (b - a) * (x / (x - y));
                    point.normalize() * radius
                })
            });
            let crossed: Vec<Vector> = crossed.collect();
            pieces.extend(crossed.as_chunks::<2>().0);
        }
    }
    pieces
}

/// The size in print of a picture as wide as a column.
pub(super) fn printed_size(width: f64, height: f64) -> String {
    let tall = COLUMN_IN_PRINT * height / width;
    format!("width=\"{COLUMN_IN_PRINT}mm\" height=\"{tall:.2}mm\"")
}

/// Several spheres on a sheet. For a paper the sheet is one column wide and has no title. A sentence may follow
/// below.
pub(super) fn sheet(
    spheres: &[Sphere],
    [title, subtitle, sentence]: [&str; 3],
    paper: bool,
) -> String {
    let (width, most, head) = match paper {
        true => (COLUMN, 2, 4.0),
        false => (WIDE, 3, 56.0),
    };
    let columns = spheres.len().clamp(1, most);
    let cell: f64 = width / most as f64;
    let tall = cell + 34.0;
    let lines = spheres.len().div_ceil(columns);
    // Characters of 12 pixels are about 6.6 pixels wide.
    let below = match sentence {
        "" => Vec::new(),
        words => folded(words, ((width - 32.0) / 6.6) as usize),
    };
    let foot = head + tall * lines as f64 + 4.0;
    let height = foot + 16.0 * below.len() as f64 + if below.is_empty() { 0.0 } else { 8.0 };
    let mut svg = String::new();
    let printed = match paper {
        true => printed_size(width, height),
        false => format!("width=\"{width}\" height=\"{height}\""),
    };
    let _ = writeln!(
        svg,
        "<svg {printed} viewBox=\"0 0 {width} {height}\" xmlns=\"http://www.w3.org/2000/svg\" \
         font-family=\"sans-serif\">\n<rect width=\"{width}\" height=\"{height}\" fill=\"#FFFFFF\"/>"
    );
    if !paper {
        write_text(&mut svg, title, [16.0, 24.0], 16.0, "#1E1E1E", "start");
        write_text(&mut svg, subtitle, [16.0, 43.0], 12.0, "#6E6E6E", "start");
    }
    for (index, sphere) in spheres.iter().enumerate() {
        let (column, line) = (index % columns, index / columns);
        let left = cell * column as f64;
        let top = head + tall * line as f64;
        sphere.draw(&mut svg, [left + cell / 2.0, top + 30.0 + cell / 2.0], cell);
    }
    for (index, line) in below.iter().enumerate() {
        let at = [16.0, foot + 12.0 + 16.0 * index as f64];
        write_text(&mut svg, line, at, 12.0, "#1E1E1E", "start");
    }
    svg.push_str("</svg>\n");
    svg
}

/// Text at a position, with the special characters of XML escaped.
fn write_text(svg: &mut String, words: &str, [x, y]: [f64; 2], size: f64, ink: &str, anchor: &str) {
    let words = words.replace('&', "&amp;").replace('<', "&lt;");
    let _ = writeln!(
        svg,
        "<text x=\"{x:.1}\" y=\"{y:.1}\" font-size=\"{size}\" fill=\"{ink}\" text-anchor=\"{anchor}\">{words}</text>"
    );
}

/// A caption in lines of at most `letters` characters.
fn folded(caption: &str, letters: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in caption.split(' ') {
        let last = lines.last_mut().map_or(0, |line| line.chars().count());
        if last > 0 && last + 1 + word.chars().count() > letters {
            lines.push(String::new());
        }
        if let Some(line) = lines.last_mut() {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines
}

impl Sphere {
    fn draw(&self, svg: &mut String, [x, y]: [f64; 2], cell: f64) {
        // Characters of 12 pixels are about 6.6 pixels wide.
        let letters = (cell / 6.6) as usize;
        for (index, line) in folded(&self.caption, letters).iter().take(2).enumerate() {
            let at = y - cell / 2.0 - 16.0 + 14.0 * index as f64;
            write_text(svg, line, [x, at], 12.0, "#1E1E1E", "middle");
        }
        let size = cell * 0.40;
        let scale = size / self.radius;
        let [right, up, towards] = view();
        let seen = |p: &Vector| [x + scale * p.dot(&right), y - scale * p.dot(&up)];
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{size:.1}\" fill=\"#F7F9FB\" stroke=\"#9AA5AF\" stroke-width=\"0.8\"/>"
        );
        let circle = |a: Vector, b: Vector| -> Vec<Vector> {
            let point = |k: usize| {
                let angle = std::f64::consts::TAU * k as f64 / 120.0;
                self.radius * (a * angle.cos() + b * angle.sin())
            };
            (0..=120).map(point).collect()
        };
        let [e1, e2, e3] = [Vector::x(), Vector::y(), Vector::z()];
        let great = [circle(e1, e2), circle(e2, e3), circle(e3, e1)];
        let mut names = Vec::new();
        // Behind first, then the axes, then in front.
        for front in [false, true] {
            let [net, level, ink] = match front {
                true => ["#C4CCD4", "#8DA9BF", "#0072B2"],
                false => ["#E6EAEE", "#DCE5EC", "#B9D3E6"],
            };
            let wanted = |a: &Vector, b: &Vector| ((a + b).dot(&towards) >= 0.0) == front;
            for great in &great {
                stroke(svg, great, &wanted, &seen, net, 0.7);
            }
            let mut path = String::new();
            for [a, b] in self.contours.iter().filter(|[a, b]| wanted(a, b)) {
                let ([ax, ay], [bx, by]) = (seen(a), seen(b));
                let _ = write!(path, "M{ax:.1} {ay:.1}L{bx:.1} {by:.1}");
            }
            if !path.is_empty() {
                let _ = writeln!(
                    svg,
                    "<path d=\"{path}\" fill=\"none\" stroke=\"{level}\" stroke-width=\"0.7\"/>"
                );
            }
            for course in &self.courses {
                stroke(svg, &course.0, &wanted, &seen, ink, 1.3);
            }
            for (axis, name) in [(e1, "1"), (e2, "2"), (e3, "3")] {
                if (axis.dot(&towards) >= 0.0) == front {
                    let [from, to] = [
                        seen(&(axis * self.radius)),
                        seen(&(axis * self.radius * 1.14)),
                    ];
                    let _ = writeln!(
                        svg,
                        "<path d=\"M{:.1} {:.1}L{:.1} {:.1}\" stroke=\"#6E6E6E\" stroke-width=\"0.9\"/>",
                        from[0], from[1], to[0], to[1]
                    );
                    let [tx, ty] = seen(&(axis * self.radius * 1.21));
                    names.push((name, [tx, ty + 4.0]));
                }
            }
        }
        for (name, [tx, ty]) in names {
            // On a white background, so that curves do not cross it.
            let _ = writeln!(
                svg,
                "<circle cx=\"{tx:.1}\" cy=\"{:.1}\" r=\"6.5\" fill=\"#FFFFFF\" fill-opacity=\"0.8\"/>",
                ty - 4.0
            );
            write_text(svg, name, [tx, ty], 11.0, "#6E6E6E", "middle");
        }
        // The start and the end of the path.
        for course in &self.courses {
            for (point, fill) in [(course.0.first(), "#0072B2"), (course.0.last(), "#FFFFFF")] {
                let Some([px, py]) = point.map(&seen) else {
                    continue;
                };
                let _ = writeln!(
                    svg,
                    "<circle cx=\"{px:.1}\" cy=\"{py:.1}\" r=\"3\" fill=\"{fill}\" stroke=\"#0072B2\" stroke-width=\"1.2\"/>"
                );
            }
        }
    }
}

/// The pieces of a curve that are wanted, as one path.
fn stroke(
    svg: &mut String,
    points: &[Vector],
    wanted: &dyn Fn(&Vector, &Vector) -> bool,
    seen: &dyn Fn(&Vector) -> [f64; 2],
    ink: &str,
    width: f64,
) {
    let mut path = String::new();
    let mut joined = false;
    for [a, b] in points.array_windows() {
        if !wanted(a, b) {
            joined = false;
            continue;
        }
        if !joined {
            let [x, y] = seen(a);
            let _ = write!(path, "M{x:.1} {y:.1}");
        }
        let [x, y] = seen(b);
        let _ = write!(path, "L{x:.1} {y:.1}");
        joined = true;
    }
    if !path.is_empty() {
        let _ = writeln!(
            svg,
            "<path d=\"{path}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"{width}\" stroke-linejoin=\"round\"/>"
        );
    }
}

#[cfg(test)]
mod tests {
    use super::{contours, folded, view};
    use clebsch::nalgebra::Vector3;

    #[test]
    fn lines_of_equal_value_are_on_the_sphere_and_at_their_value() {
        let f = |m: &Vector3<f64>| m.x * m.x + 2.0 * m.y * m.y + 4.0 * m.z * m.z;
        let pieces = contours(2.0, &f);
        assert!(pieces.len() > 1000);
        for [a, b] in pieces {
            assert!((a.norm() - 2.0).abs() < 1e-12);
            // The chord of a cell of 2.5 degrees: of second order in its size.
            assert!((f(&a) - f(&b)).abs() < 0.05, "{} {}", f(&a), f(&b));
        }
        assert!(contours(1.0, &|m| m.norm()).is_empty());
    }

    #[test]
    fn the_view_is_a_frame() {
        let [right, up, towards] = view();
        assert!((right.cross(&up) - towards).norm() < 1e-14);
        assert_eq!(folded("a bc d", 4), ["a bc", "d"]);
    }
}
