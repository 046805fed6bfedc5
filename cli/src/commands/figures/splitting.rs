//! Figures 2.15 to 2.17: the generated stepper of the free body and McLachlan's splitting. Takes the gallery;
//! gives SVG of energy against step size, computing time, drift.

use super::sheet::{Series, Subject, change, dashed, drawn, line, magnitudes, norm, sheet};

use crate::models::gallery::{Case, Gallery};
use crate::plan::Plan;
use crate::plots::axis::{Axis, FLOOR};
use crate::plots::curve::Curve;
use crate::plots::figure::{Figure, Panel};
use crate::terminal::failure::Failure;
use clebsch::record::Record;
use clebsch::scalar;
use clebsch_comparisons::gallery::{Offer, Problem, offers};
use std::time::Instant;

/// Figure 2.15: largest error of the energy, and of the momentum at the end, against the step.
pub(super) fn energy_against_step(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, "free-body", "figure-2-15")?;
    let methods = ["generated", "splitting", "splitting-4"];
    let mut energies: Vec<Series> = vec![Vec::new(); methods.len() + 1];
    let mut errors: Vec<Series> = vec![Vec::new(); methods.len()];
    let time = crate::plan::end(body.case.h, body.case.steps);
    for halvings in 0..6 {
        let h = 0.4 / f64::from(1 << halvings);
        let case = Case {
            h,
            steps: (time / h).round() as u64,
            ..body.case.clone()
        };
        let subject = body.with(&case);
        let truth = subject.components(&subject.reference()?, "body_momentum");
        for (index, method) in methods.iter().enumerate() {
            let record = match *method {
                "generated" => subject.generated()?,
                other => subject.by(other)?,
            };
            let energy = subject.invariant(&record, "energy").into_iter().next();
            let energy = energy.unwrap_or_default();
            let first = energy.first().map_or(1.0, |point| point.1);
            put(&mut energies, index, (h, largest(&change(&energy)) / first));
            let mu = subject.components(&record, "body_momentum");
            let pairs = mu.iter().zip(&truth);
            let apart: Vec<Series> = pairs.map(|(a, b)| super::sheet::difference(a, b)).collect();
            put(&mut errors, index, (h, largest(&norm(&apart))));
            if index == 0 {
                let offset = discrete_energy(&subject, &record, h) / first - 1.0;
                put(&mut energies, methods.len(), (h, offset.abs()));
            }
        }
    }
    let names = [
        "generated",
        "splitting",
        "splitting, order 4",
        "generated, discrete energy",
    ];
    let strokes = [0, 1, 2, 3];
    let curve = |(index, series): (usize, &Series)| Curve {
        label: names.get(index).copied().unwrap_or_default().to_owned(),
        note: None,
        points: series
            .iter()
            .map(|(x, y)| (x.log10(), y.max(FLOOR).log10()))
            .collect(),
        stroke: crate::plots::curve::Stroke::number(strokes.get(index).copied().unwrap_or(0)),
    };
    let panel = |caption: &str, y_label: &str, all: &[Series]| {
        let mut curves: Vec<Curve> = all.iter().enumerate().map(curve).collect();
        // Through the first point of the splitting method, which is of second order.
        let anchor = all.get(1).and_then(|series| series.first());
        let (x, y) = anchor.map_or((0.0, 0.0), |(x, y)| (x.log10(), y.log10() - 0.6));
        let last = all.first().and_then(|series| series.last());
        let to = last.map_or(0.0, |point| point.0.log10());
        curves.push(Curve {
            label: "∝ h²".to_owned(),
            note: None,
            points: vec![(x, y), (to, y + 2.0 * (to - x))],
            stroke: crate::plots::curve::Stroke::shared_bound(),
        });
        Panel {
            map: None,
            caption: caption.to_owned(),
            y_label: y_label.to_owned(),
            y: Axis::decades(&curves),
            curves,
            height: 290,
        }
    };
    let steps: Vec<f64> = (0..6)
        .map(|halvings| 0.4 / f64::from(1 << halvings))
        .collect();
    drawn(&Figure {
        paper: false,
        title: "Figure 2.15: energy against the step, I = (1, 2, 3)".to_owned(),
        subtitle: format!(
            "free-body, case {}, to time {time}; discrete energy: (tr J − tr ΩJ) / h²",
            body.case.name
        ),
        x: Axis::logarithmic(&steps),
        x_label: "step h".to_owned(),
        panels: vec![
            panel("largest |E − E(0)| / E(0)", "", &energies),
            panel("largest |M − M*|, M* the exact body momentum", "", &errors),
        ],
    })
}

fn put(all: &mut [Series], index: usize, point: (f64, f64)) {
    if let Some(series) = all.get_mut(index) {
        series.push(point);
    }
}

fn largest(series: &Series) -> f64 {
    scalar::largest(series.iter().map(|point| point.1))
}

/// (tr J - tr(Omega J)) / h^2 of the first step, a constant of the scheme.
fn discrete_energy(subject: &Subject<'_>, record: &Record, h: f64) -> f64 {
    let lambda = subject.components(record, "Lambda");
    let at = |node: usize, r: usize, c: usize| {
        let entry = lambda.get(3 * r + c).and_then(|series| series.get(node));
        entry.map_or(f64::NAN, |point| point.1)
    };
    let j = subject.case.parameters.first().cloned().unwrap_or_default();
    let second_moment = |i: usize| j.get(4 * i).copied().unwrap_or(f64::NAN);
    // Diagonal J: tr J - tr(Omega J) is the sum of J_i |difference of the columns|^2 / 2, without cancellation.
    let sum: f64 = (0..3)
        .map(|c| {
            let squares = (0..3).map(|r| (at(1, r, c) - at(0, r, c)).powi(2));
            second_moment(c) * squares.sum::<f64>() / 2.0
        })
        .sum();
    sum / (h * h)
}

/// Figure 2.16: time of computation against the number of steps. The only figure that differs from run
/// to run.
pub(super) fn time_against_steps(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, "free-body", "figure-2-16")?;
    let counts: Vec<u64> = [1_000, 10_000, 100_000, body.case.steps].to_vec();
    let plan = Plan::of(body.case, body.case.steps);
    let mut curves = Vec::new();
    let generated = |steps: u64| -> Result<f64, Failure> {
        let mut trajectory = plan.open(body.card())?;
        let begin = Instant::now();
        for _ in 0..steps {
            let step = trajectory.step();
            step.map_err(|error| Failure::Failed(error.to_string()))?;
        }
        Ok(begin.elapsed().as_secs_f64())
    };
    let by = |offer: &Offer, steps: u64| -> Result<f64, Failure> {
        let refused = |_| Failure::Failed(format!("{} failed", offer.name));
        let problem = Problem {
            parameters: &body.case.parameters,
            initial: &body.case.initial,
            h: body.case.h,
        };
        let mut method = (offer.start)(&problem).map_err(refused)?;
        let begin = Instant::now();
        for _ in 0..steps {
            method.step().map_err(refused)?;
        }
        Ok(begin.elapsed().as_secs_f64())
    };
    let wanted = [
        "splitting",
        "splitting-merged",
        "splitting-4",
        "fixed-point",
        "newton",
    ];
    let offers: Vec<Offer> = offers("free-body")
        .into_iter()
        .filter(|offer| wanted.contains(&offer.name))
        .collect();
    let mut draw = |label: &str, index: usize, time: &dyn Fn(u64) -> Result<f64, Failure>| {
        let mut points = Vec::new();
        for count in &counts {
            // The minimum of three measurements, since other load only adds time.
            let mut least = f64::INFINITY;
            for _ in 0..3 {
                least = least.min(time(*count)?);
            }
            points.push(((*count as f64).log10(), least.max(1e-9).log10()));
        }
        curves.push(Curve {
            label: label.to_owned(),
            note: None,
            points,
            stroke: crate::plots::curve::Stroke::number(index),
        });
        Ok::<(), Failure>(())
    };
    draw("generated", 0, &generated)?;
    for (index, offer) in offers.iter().enumerate() {
        draw(offer.name, index + 1, &|steps| by(offer, steps))?;
    }
    let places: Vec<f64> = counts.iter().map(|count| *count as f64).collect();
    drawn(&Figure {
        paper: false,
        title: "Figure 2.16: computation time, I = (1, 2, 3)".to_owned(),
        subtitle: format!(
            "free-body, case {}; h = {}; the shortest of three runs on this machine",
            body.case.name, body.case.h
        ),
        x: Axis::logarithmic(&places),
        x_label: "number of steps N".to_owned(),
        panels: vec![Panel {
            map: None,
            caption: "computation time, attitude included".to_owned(),
            y_label: "seconds".to_owned(),
            y: Axis::decades(&curves),
            curves,
            height: 330,
        }],
    })
}

/// Figure 2.17.
pub(super) fn drift(gallery: &Gallery) -> Result<String, Failure> {
    let body = Subject::new(gallery, "free-body", "figure-2-17")?;
    let records = [body.generated()?, body.by("splitting")?];
    let length = |record| change(&norm(&body.components(record, "body_momentum")));
    let spatial = |record| {
        let components = body.invariant(record, "spatial_momentum");
        norm(&components.iter().map(change).collect::<Vec<_>>())
    };
    let [own, split] = &records;
    let panels = vec![
        magnitudes(
            "|M| − |M(0)|",
            "",
            vec![
                line("generated", 0, length(own)),
                dashed("splitting", 1, length(split)),
            ],
        ),
        magnitudes(
            "|m − m(0)|",
            "",
            vec![
                line("generated", 0, spatial(own)),
                dashed("splitting", 1, spatial(split)),
            ],
        ),
    ];

    sheet(
        "Figure 2.17: drift compared with splitting, I = (1, 2, 3)",
        &body,
        "",
        panels,
    )
}
