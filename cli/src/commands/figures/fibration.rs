//! The momentum map of SU(2): for a fixed spatial momentum m, q -> q* m q maps unit quaternions to body
//! momenta. This is Hopf's fibration. Takes the gallery; gives the sphere of body momenta with the path of a
//! case, and the fibres over its points. The fibres are circles of the three-sphere, projected
//! stereographically to space.

use super::sheet::Subject;
use crate::models::gallery::Gallery;
use crate::terminal::failure::Failure;
use clebsch_comparisons::handwritten::attitude::{Quaternion, Vector, cross, dot};
use std::f64::consts::TAU;
use std::fmt::Write;

/// Circles of latitude on the sphere, by the cosine of their angle from the spatial momentum, with
/// the colour of the points and of the fibres over them.
const LATITUDES: [(f64, &str); 3] = [(0.35, "#0072b2"), (-0.2, "#009e73"), (-0.75, "#d55e00")];
/// Fibres over each circle of latitude.
const FIBRES: usize = 12;
/// Pieces of a fibre, drawn from the farthest to the nearest.
const PIECES: usize = 90;

const WIDTH: f64 = 1000.0;
const HEIGHT: f64 = 560.0;

/// The view direction of both pictures.
const VIEW: [f64; 2] = [0.55, 0.95];

/// Right, up, and towards the reader, with the spatial momentum upward.
fn seen(v: &Vector, m: &Vector) -> Vector {
    let [turn, tilt] = VIEW;
    let [e, f] = frame(m);
    let [x, y, z] = [dot(&e, v), dot(&f, v), dot(m, v)];
    let right = turn.cos() * y - turn.sin() * x;
    let forward = turn.cos() * x + turn.sin() * y;
    [
        right,
        tilt.cos() * z - tilt.sin() * forward,
        tilt.cos() * forward + tilt.sin() * z,
    ]
}

/// Two unit vectors that make a right-handed frame with `axis`.
fn frame(axis: &Vector) -> [Vector; 2] {
    let [x, y, z] = axis.map(f64::abs);
    let far = if x <= y && x <= z {
        [1.0, 0.0, 0.0]
    } else if y <= z {
        [0.0, 1.0, 0.0]
    } else {
        [0.0, 0.0, 1.0]
    };
    let first = cross(axis, &far);
    let length = dot(&first, &first).sqrt();
    let first = first.map(|c| c / length);
    [first, cross(axis, &first)]
}

/// A unit quaternion that takes body vector `from` to space vector `to`, both of length one.
fn taking(from: &Vector, to: &Vector) -> Quaternion {
    let [x, y, z] = cross(from, to);
    let w = 1.0 + dot(from, to);
    if w < 1e-12 {
        // Opposite vectors: a half turn about any normal.
        let [[a, b, c], _] = frame(from);
        return Quaternion([0.0, a, b, c]);
    }
    Quaternion([w, x, y, z]).normalised()
}

/// A point of the three-sphere in space, projected from -1.
fn projected(q: &Quaternion) -> Vector {
    let [w, x, y, z] = q.0;
    let scale = 1.0 / (1.0 + w).max(1e-9);
    [x * scale, y * scale, z * scale]
}

/// The quaternion after a rotation by twice the angle about m in space. The rotation leaves q* m q unchanged,
/// so it follows the fibre through q.
fn turned(q: &Quaternion, m: &Vector, angle: f64) -> Quaternion {
    let (s, c) = angle.sin_cos();
    Quaternion([c, s * m[0], s * m[1], s * m[2]]).times(q)
}

/// A short line with its depth.
struct Piece {
    ends: [[f64; 2]; 2],
    depth: f64,
    color: &'static str,
}

/// The picture.
pub(super) fn hopf(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, "cayley-klein", "figure-2-9")?;
    let record = body.generated()?;
    let mu = body.components(&record, "body_momentum");
    let at = |node: usize| -> Vector {
        [0, 1, 2].map(|i| {
            let entry = mu.get(i).and_then(|series| series.get(node));
            entry.map_or(f64::NAN, |point| point.1)
        })
    };
    let q = body.components(&record, "q");
    let start = Quaternion([0, 1, 2, 3].map(|i| {
        let entry = q.get(i).and_then(|series| series.first());
        entry.map_or(f64::NAN, |point| point.1)
    }));
    let first = at(0);
    let norm = dot(&first, &first).sqrt();
    let m = start.matrix().map(|row| dot(&row, &first) / norm);
    let mut svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" \
         viewBox=\"0 0 {WIDTH} {HEIGHT}\" font-family=\"sans-serif\">\n\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>\n\
         <text x=\"16\" y=\"26\" font-size=\"16\" fill=\"#1e1e1e\">Momentum map of SU(2): Hopf's \
         fibration q ↦ M = q* m q</text>\n\
         <text x=\"16\" y=\"46\" font-size=\"12\" fill=\"#6e6e6e\">{}; m fixed in space</text>\n\
         <text x=\"200\" y=\"84\" font-size=\"13\" fill=\"#1e1e1e\" text-anchor=\"middle\">sphere \
         of body momenta</text>\n\
         <text x=\"700\" y=\"84\" font-size=\"13\" fill=\"#1e1e1e\" text-anchor=\"middle\">fibres \
         over its points: q with the same M, projected from −1 to space</text>\n",
        body.subtitle("")
    );
    let count = record.times.len();
    let course = (0..count).map(|node| at(node).map(|c| c / norm));
    sphere(&mut svg, &m, course);
    fibres(&mut svg, &m);
    svg.push_str("</svg>\n");
    Ok(svg)
}

/// Points over which fibres are drawn: body momenta of length one.
fn base(m: &Vector) -> impl Iterator<Item = (Vector, &'static str)> {
    let m = *m;
    let [e, f] = frame(&m);
    LATITUDES.into_iter().flat_map(move |(cosine, color)| {
        let sine = (1.0 - cosine * cosine).sqrt();
        (0..FIBRES).map(move |k| {
            let (s, c) = (TAU * k as f64 / FIBRES as f64).sin_cos();
            let point = [0, 1, 2].map(|i: usize| {
                let part = |v: &Vector| v.get(i).copied().unwrap_or(0.0);
                cosine * part(&m) + sine * (c * part(&e) + s * part(&f))
            });
            (point, color)
        })
    })
}

/// The sphere, the points and the path of the case. The far side is drawn faint.
fn sphere(svg: &mut String, m: &Vector, course: impl Iterator<Item = Vector>) {
    const CENTRE: [f64; 2] = [200.0, 310.0];
    const RADIUS: f64 = 160.0;
    let place = |v: &Vector| {
        let [x, y, depth] = seen(v, m);
        ([CENTRE[0] + RADIUS * x, CENTRE[1] - RADIUS * y], depth)
    };
    let _ = writeln!(
        svg,
        "<circle cx=\"{}\" cy=\"{}\" r=\"{RADIUS}\" fill=\"#f6f6f6\" stroke=\"#b0b0b0\"/>",
        CENTRE[0], CENTRE[1]
    );
    let mut before: Option<([f64; 2], f64)> = None;
    for (here, depth) in course.map(|v| place(&v)) {
        if let Some((there, _)) = before {
            let ink = if depth > 0.0 { "#1e1e1e" } else { "#c8c8c8" };
            stroke(svg, [there, here], ink, 0.8);
        }
        before = Some((here, depth));
    }
    for (point, color) in base(m) {
        let ([x, y], depth) = place(&point);
        let opacity = if depth > 0.0 { 1.0 } else { 0.3 };
        let _ = writeln!(
            svg,
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"4\" fill=\"{color}\" fill-opacity=\"{opacity}\"/>"
        );
    }
    let _ = writeln!(
        svg,
        "<text x=\"{}\" y=\"{}\" font-size=\"12\" fill=\"#1e1e1e\" text-anchor=\"middle\">m \
         points upward; black: course of M in the case</text>",
        CENTRE[0],
        CENTRE[1] + RADIUS + 28.0
    );
}

/// The fibres: circles, linked pairwise; nearer pieces hide farther ones.
fn fibres(svg: &mut String, m: &Vector) {
    const CENTRE: [f64; 2] = [700.0, 325.0];
    const SCALE: f64 = 66.0;
    let mut pieces = Vec::new();
    for (point, color) in base(m) {
        let one = taking(&point, m);
        let points: Vec<Vector> = (0..=PIECES)
            .map(|k| {
                let angle = TAU * k as f64 / PIECES as f64;
                seen(&projected(&turned(&one, m, angle)), m)
            })
            .collect();
        for pair in points.windows(2) {
            if let [a, b] = pair {
                let flat = |v: &Vector| [CENTRE[0] + SCALE * v[0], CENTRE[1] - SCALE * v[1]];
                pieces.push(Piece {
                    ends: [flat(a), flat(b)],
                    depth: 0.5 * (a[2] + b[2]),
                    color,
                });
            }
        }
    }
    pieces.sort_by(|a, b| a.depth.total_cmp(&b.depth));
    for piece in &pieces {
        // A white rim separates a line from the lines behind it.
        stroke(svg, piece.ends, "white", 5.0);
        stroke(svg, piece.ends, piece.color, 2.2);
    }
}

fn stroke(svg: &mut String, [[a, b], [c, d]]: [[f64; 2]; 2], ink: &str, width: f64) {
    let _ = writeln!(
        svg,
        "<path d=\"M{a:.1} {b:.1}L{c:.1} {d:.1}\" stroke=\"{ink}\" stroke-width=\"{width}\"/>"
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use clebsch_comparisons::handwritten::attitude::apply_transposed;

    /// Every point of a fibre maps to the same body momentum. A rotation about another axis changes it.
    #[test]
    fn fibres_lie_over_their_points() {
        let m = [0.6, 0.0, 0.8];
        for (point, _) in base(&m) {
            let one = taking(&point, &m);
            let apart = |q: Quaternion| {
                let image = apply_transposed(&q.matrix(), &m);
                clebsch::scalar::largest(image.iter().zip(point).map(|(a, b)| a - b))
            };
            for k in 0..7 {
                assert!(apart(turned(&one, &m, f64::from(k))) < 1e-14);
            }
            assert!(apart(turned(&one, &[0.0, 1.0, 0.0], 1.0)) > 0.1);
        }
    }
}
