//! Figures 3.1 to 3.3: the pulsating body of the thesis's section 3.2, by its placement, from a model file. Gives SVG
//! of stretches and volume, momenta along the stretches, energy and invariants.

use super::bipolar;
use super::sheet::{Series, Subject, change, dashed, line, magnitudes, norm, panel, sheet};
use crate::case_file;
use crate::models::gallery::{Citations, Entry, Gallery};
use crate::terminal::failure::Failure;
use clebsch::nalgebra::{Matrix3, Vector3};
use clebsch::record::Record;

const TEXT: &str = include_str!("../../../../models/elastic/mooney-rivlin.clebsch");
const CASE: &str = include_str!("../../../../models/elastic/mooney-rivlin/thesis-figures.toml");
pub(super) const MODEL: &str = "mooney-rivlin";
pub(super) const NAME: &str = "thesis-figures";

/// The gallery with the models of these figures.
///
/// # Errors
/// Usage: a model or case cannot be read.
pub(super) fn with_files(gallery: &Gallery) -> Result<Gallery, Failure> {
    let mut gallery = gallery.clone();
    for (model, text, file, case) in [
        (MODEL, TEXT, "thesis-figures.toml", CASE),
        (
            bipolar::MODEL,
            bipolar::TEXT,
            "pseudo-rigid.toml",
            bipolar::CASE,
        ),
    ] {
        let read = gallery.cache.card(text);
        let (card, _) = read.map_err(|refused| Failure::Usage(format!("{model}: {refused}")))?;
        let cases = vec![case_file::read(file, case, &card)?.case];
        gallery.entries.push(Entry {
            card,
            citations: Citations::NONE,
            cases,
        });
    }
    Ok(gallery)
}

/// The quantities that are drawn, at every node.
pub(super) struct Course {
    /// Stretches, the largest first.
    pub stretches: [Series; 3],
    /// Their product.
    pub volume: Series,
    /// Angular momentum and circulation, by components along the axes of stretches in space and in the reference.
    pub along: [[Series; 3]; 2],
    /// The vectors along fixed axes.
    pub fixed: [[Series; 3]; 2],
    /// Kinetic energy of the edge that starts at the node, and the stored one at the node.
    pub forward: Series,
    /// The energy of the node.
    pub energy: Series,
}

impl Course {
    /// # Errors
    /// Usage, failed: as for a run.
    pub fn new(body: &Subject<'_>) -> Result<Self, Failure> {
        let record = body.generated()?;
        let all = |name: &str| matrices(body, &record, name);
        let (places, momenta) = (all("Q"), all("momentum"));
        let times = &record.times;
        let mut course = Self {
            stretches: Default::default(),
            volume: Vec::new(),
            along: Default::default(),
            fixed: Default::default(),
            forward: Vec::new(),
            energy: body
                .invariant(&record, "energy")
                .into_iter()
                .next()
                .unwrap_or_default(),
        };
        let mut axes: [Matrix3<f64>; 2] = [Matrix3::identity(); 2];
        for (k, ((q, p), time)) in places.iter().zip(&momenta).zip(times).enumerate() {
            let parts = q.svd(true, true);
            let s = parts.singular_values;
            for (series, x) in course.stretches.iter_mut().zip(s.iter()) {
                series.push((*time, *x));
            }
            course.volume.push((*time, q.determinant()));
            let turned = [parts.u, parts.v_t.map(|v| v.transpose())];
            let [angular, circulation] = [p * q.transpose(), p.transpose() * q].map(axial);
            for (((known, found), vector), which) in axes
                .iter_mut()
                .zip(turned)
                .zip([angular, circulation])
                .zip(0..)
            {
                let found = found.unwrap_or(*known);
                // The sign of an axis follows the axis at the node before.
                let signs = |c: usize| {
                    let (new, old) = (found.column(c), known.column(c));
                    if new.dot(&old) < 0.0 { -1.0 } else { 1.0 }
                };
                *known = Matrix3::from_fn(|r, c| found[(r, c)] * signs(c));
                let seen = known.transpose() * vector;
                for i in 0..3 {
                    course.along[which][i].push((*time, seen[i]));
                    course.fixed[which][i].push((*time, vector[i]));
                }
            }
            if let Some(next) = places.get(k + 1) {
                let h = body.case.h;
                let kinetic = 0.5 * ((next - q) / h).norm_squared();
                course.forward.push((*time, kinetic + stored(body, &s)));
            }
        }
        Ok(course)
    }
}

/// The stored energy for these stretches and the parameters of the case.
pub(super) fn stored(body: &Subject<'_>, s: &Vector3<f64>) -> f64 {
    let number = |name: &str| {
        let fields = body.card().parameters.iter().zip(&body.case.parameters);
        let found = fields.into_iter().find(|(field, _)| field.ascii == name);
        found
            .and_then(|(_, value)| value.first())
            .copied()
            .unwrap_or(f64::NAN)
    };
    let squares = s.map(|x| x * x);
    let (first, volume) = (squares.sum(), squares.product());
    let second = 0.5 * (first * first - squares.norm_squared());
    number("a") * first + number("b") * second + number("c") * volume
        - 0.5 * number("d") * volume.ln()
}

/// The vector v with hat(v) twice the skew part.
fn axial(a: Matrix3<f64>) -> Vector3<f64> {
    Vector3::new(
        a[(2, 1)] - a[(1, 2)],
        a[(0, 2)] - a[(2, 0)],
        a[(1, 0)] - a[(0, 1)],
    )
}

/// The values of a square matrix at every node.
pub(super) fn matrices(body: &Subject<'_>, record: &Record, name: &str) -> Vec<Matrix3<f64>> {
    let entries = body.components(record, name);
    let count = entries.first().map_or(0, Vec::len);
    let entry = |k: usize, i: usize| {
        let found = entries.get(i).and_then(|series| series.get(k));
        found.map_or(f64::NAN, |point| point.1)
    };
    (0..count)
        .map(|k| Matrix3::from_fn(|r, c| entry(k, 3 * r + c)))
        .collect()
}

/// Figure 3.1.
pub(super) fn stretches(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, MODEL, NAME)?;
    let course = Course::new(&body)?;
    let names = ["largest stretch", "middle stretch", "smallest stretch"];
    let mut panels: Vec<_> = names
        .iter()
        .zip(course.stretches)
        .map(|(name, series)| panel(name, "", vec![line("", 0, series)]))
        .collect();
    let volume = vec![line("", 1, course.volume)];
    panels.push(panel("det Q, the ratio of volumes", "", volume));
    let title = "Figure 3.1: stretches of a pulsating body";
    sheet(title, &body, "", panels)
}

/// Figure 3.2.
pub(super) fn momenta(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, MODEL, NAME)?;
    let course = Course::new(&body)?;
    let [angular, circulation] = course.along;
    let squared =
        |parts: &[Series]| -> Series { norm(parts).into_iter().map(|(t, x)| (t, x * x)).collect() };
    let [m, n] = [squared(&angular), squared(&circulation)];
    let names = [["M₁", "M₂", "M₃"], ["N₁", "N₂", "N₃"]];
    let all = [angular, circulation].into_iter().zip(names).zip(0..);
    let mut panels: Vec<_> = all
        .flat_map(|((parts, names), stroke)| {
            parts.into_iter().zip(names).map(move |(part, name)| {
                let caption = format!("{name}, along the axes of the stretches, the largest first");
                panel(&caption, "", vec![line("", stroke, part)])
            })
        })
        .collect();
    panels.push(panel(
        "|M|² and |N|²",
        "",
        vec![line("|M|²", 0, m), line("|N|²", 1, n)],
    ));
    let title = "Figure 3.2: angular momentum M and circulation N";
    sheet(title, &body, "", panels)
}

/// Figure 3.3.
pub(super) fn drift(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, MODEL, NAME)?;
    let course = Course::new(&body)?;
    let h = body.case.h;
    let times_square = |series: &Series| -> Series {
        change(series)
            .into_iter()
            .map(|(t, x)| (t, h * h * x))
            .collect()
    };
    let [angular, circulation] = course.fixed.map(|fixed| {
        let changes: Vec<Series> = fixed.iter().map(change).collect();
        norm(&changes)
    });
    let panels = vec![
        panel(
            "h² (E − E(0)): forward, from the velocity of the edge before the node; at the node, from its momentum",
            "",
            vec![
                line("forward", 0, times_square(&course.forward)),
                dashed("at the node", 2, times_square(&course.energy)),
            ],
        ),
        magnitudes(
            "change since time 0 of angular momentum and circulation along fixed axes",
            "",
            vec![
                line("angular momentum", 0, angular),
                line("circulation", 1, circulation),
            ],
        ),
    ];
    let title = "Figure 3.3: energy, angular momentum and circulation";
    sheet(title, &body, "", panels)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn range(series: &Series) -> [f64; 2] {
        let fold = |of: fn(f64, f64) -> f64, from: f64| series.iter().map(|p| p.1).fold(from, of);
        [
            fold(f64::min, f64::INFINITY),
            fold(f64::max, f64::NEG_INFINITY),
        ]
    }

    /// Ranges over ten thousand steps of the same data, computed by another program. The motion is not regular:
    /// rounding affects the last digits of extremes that occur late.
    #[test]
    fn ranges_are_those_of_the_reference_run() {
        let gallery = with_files(&Gallery::default()).expect("is read");
        let body = Subject::new(&gallery, MODEL, NAME).expect("the case");
        let course = Course::new(&body).expect("runs");
        let near = |found: f64, wanted: f64, by: f64| {
            assert!((found - wanted).abs() < by, "{found} {wanted}");
        };
        let [low, high] = range(&course.volume);
        near(low, 0.7533, 1e-4);
        near(high, 1.021_693_2, 1e-4);
        near(range(&course.stretches[2])[0], 0.6918, 1e-3);
        near(range(&course.stretches[0])[1], 1.3003, 1e-3);
        let h = body.case.h;
        let [low, high] = range(&change(&course.forward)).map(|x| x * h * h);
        near(low, -1.901_7e-3, 1e-5);
        near(high, 1.110_9e-3, 1e-5);
        // The energy at the nodes spans a seventh of that.
        let [low, high] = range(&course.energy).map(|x| x * h * h);
        near(high - low, 4.28e-4, 1e-5);
        for fixed in &course.fixed {
            for part in fixed {
                // The thesis's momenta are of size 0.02.
                let [low, high] = range(&change(part));
                assert!(high - low < 1e-12, "{low:e} {high:e}");
            }
        }
    }
}
