//! The parts of the figures: runs of named cases, columns of their records, panels.
//! Takes names of models, cases and fields; gives series of numbers and drawn sheets.

use crate::commands::compare::course::{self, Course};
use crate::models::gallery::{self, Case, Entry, Gallery};
use crate::plan::Plan;
use crate::plan::end;
use crate::plots::axis::{Axis, FLOOR};
use crate::plots::curve::{Curve, Stroke};
use crate::plots::figure::{Figure, Panel};
use crate::plots::reduce;
use crate::terminal::failure::Failure;
use crate::words::number::plain;
use crate::words::plain::steps;
use clebsch::card::Card;
use clebsch::record::Record;
use clebsch_comparisons::gallery::{Offer, ode45, offers};

/// A quantity at the nodes.
pub(super) type Series = Vec<(f64, f64)>;

/// A case of the gallery.
pub(super) struct Subject<'a> {
    entry: &'a Entry,
    pub case: &'a Case,
}

impl<'a> Subject<'a> {
    /// # Errors
    /// Usage: the gallery does not contain this model or case.
    pub fn new(gallery: &'a Gallery, model: &str, case: &str) -> Result<Self, Failure> {
        let entry = gallery.find(model)?;
        let case = gallery::case(entry, Some(case))?;
        Ok(Self { entry, case })
    }

    /// The same model with the data of another case.
    pub fn with<'b>(&self, case: &'b Case) -> Subject<'b>
    where
        'a: 'b,
    {
        Subject {
            entry: self.entry,
            case,
        }
    }

    pub fn card(&self) -> &'a Card {
        &self.entry.card
    }

    fn plan(&self) -> Plan {
        Plan::of(self.case, self.case.steps.div_ceil(10_000))
    }

    /// The record of the generated stepper.
    ///
    /// # Errors
    /// Failed: the stepper stops.
    pub fn generated(&self) -> Result<Record, Failure> {
        Ok(course::generated(self.card(), &self.plan(), false)?
            .0
            .record)
    }

    /// The record of the model's reference method.
    ///
    /// # Errors
    /// Failed: the model has no reference, or the method stops.
    pub fn reference(&self) -> Result<Record, Failure> {
        self.follow(offers(self.card().kebab).into_iter().next())
    }

    /// The record of ode45.
    ///
    /// # Errors
    /// Failed: the method stops.
    pub fn ode45(&self) -> Result<Record, Failure> {
        self.follow(ode45(self.card().kebab))
    }

    /// The record of the method with this name.
    ///
    /// # Errors
    /// Failed: there is no such method, or it stops.
    pub fn by(&self, name: &str) -> Result<Record, Failure> {
        let mut found = offers(self.card().kebab).into_iter();
        self.follow(found.find(|offer| offer.name == name))
    }

    fn follow(&self, offer: Option<Offer>) -> Result<Record, Failure> {
        let model = self.card().kebab;
        let Some(offer) = offer else {
            return Err(Failure::Failed(format!(
                "{model} has no method to compare with"
            )));
        };
        let Course { record, stopped } = course::other(self.card(), &self.plan(), &offer);
        match stopped {
            None => Ok(record),
            Some((node, why)) => Err(Failure::Failed(format!(
                "{model}, {}: {} at node {node}: {why}",
                self.case.name, offer.name
            ))),
        }
    }

    /// Component `index`, from 0, of the observable of this name.
    pub fn observable(&self, record: &Record, name: &str, index: usize) -> Series {
        let mut from = 0;
        for field in self.card().observables {
            if field.ascii == name && index < field.count() {
                return pair(&record.times, record.observables.column(from + index));
            }
            from += field.count();
        }
        Vec::new()
    }

    /// All components of the observable of this name.
    pub fn components(&self, record: &Record, name: &str) -> Vec<Series> {
        let field = self
            .card()
            .observables
            .iter()
            .find(|field| field.ascii == name);
        let count = field.map_or(0, |field| field.count());
        (0..count)
            .map(|i| self.observable(record, name, i))
            .collect()
    }

    /// All components of the invariant of this name.
    pub fn invariant(&self, record: &Record, name: &str) -> Vec<Series> {
        let mut from = 0;
        for invariant in self.card().invariants {
            if invariant.name == name {
                let columns = from..from + invariant.rows;
                return columns
                    .map(|i| pair(&record.times, record.invariants.column(i)))
                    .collect();
            }
            from += invariant.rows;
        }
        Vec::new()
    }

    /// The line under the title.
    pub fn subtitle(&self, more: &str) -> String {
        let case = self.case;
        let to = plain(end(case.h, case.steps));
        format!(
            "{}, case {}; h = {}, {}, to time {to}{more}",
            self.card().kebab,
            case.name,
            case.h,
            steps(case.steps)
        )
    }

    /// The axis of time.
    pub fn times(&self) -> Axis {
        Axis::linear(0.0, end(self.case.h, self.case.steps), 8)
    }
}

fn pair(times: &[f64], values: impl Iterator<Item = f64>) -> Series {
    times.iter().copied().zip(values).collect()
}

/// Differences of two series at the same times.
pub(super) fn difference(a: &Series, b: &Series) -> Series {
    let pairs = a.iter().zip(b);
    pairs.map(|(x, y)| (x.0, x.1 - y.1)).collect()
}

/// A series less its first value.
pub(super) fn change(series: &Series) -> Series {
    let first = series.first().map_or(0.0, |point| point.1);
    series.iter().map(|(t, x)| (*t, x - first)).collect()
}

/// The norm of several components at each time.
pub(super) fn norm(components: &[Series]) -> Series {
    let Some(first) = components.first() else {
        return Vec::new();
    };
    let at = |i: usize| {
        components
            .iter()
            .filter_map(move |c| c.get(i))
            .map(|p| p.1 * p.1)
    };
    let times = first.iter().enumerate();
    times
        .map(|(i, (t, _))| (*t, at(i).sum::<f64>().sqrt()))
        .collect()
}

/// A quantity to draw: its label, its stroke, its values.
pub(super) struct Line<'a> {
    pub label: &'a str,
    pub stroke: Stroke,
    pub values: Series,
}

/// A line in the `index`-th stroke.
pub(super) fn line(label: &str, index: usize, values: Series) -> Line<'_> {
    Line {
        label,
        stroke: Stroke::number(index),
        values,
    }
}

/// A dashed line, for a curve that may coincide with another curve.
pub(super) fn dashed(label: &str, index: usize, values: Series) -> Line<'_> {
    Line {
        label,
        stroke: Stroke::number(index).dashed(),
        values,
    }
}

/// A panel with a linear axis.
pub(super) fn panel(caption: &str, y_label: &str, lines: Vec<Line<'_>>) -> Panel {
    let split = |line: &Line<'_>| -> (Vec<f64>, Vec<f64>) { line.values.iter().copied().unzip() };
    let curves: Vec<Curve> = lines
        .iter()
        .map(|line| {
            let (times, values) = split(line);
            Curve {
                label: line.label.to_owned(),
                note: None,
                points: reduce::extremes(&times, values.into_iter()),
                stroke: line.stroke,
            }
        })
        .collect();
    Panel {
        map: None,
        caption: caption.to_owned(),
        y_label: y_label.to_owned(),
        y: Axis::around(&curves),
        curves,
        height: 175,
    }
}

/// A panel of magnitudes with a logarithmic axis; each point is the largest value in an interval of time.
pub(super) fn magnitudes(caption: &str, y_label: &str, lines: Vec<Line<'_>>) -> Panel {
    let curves: Vec<Curve> = lines
        .into_iter()
        .map(|line| {
            let values: Series = line
                .values
                .iter()
                .skip(1)
                .map(|(t, x)| (*t, x.abs()))
                .collect();
            let points = reduce::envelope(&values).into_iter();
            Curve {
                label: line.label.to_owned(),
                note: None,
                points: points.map(|(t, x)| (t, x.max(FLOOR).log10())).collect(),
                stroke: line.stroke,
            }
        })
        .collect();
    Panel {
        map: None,
        caption: caption.to_owned(),
        y_label: y_label.to_owned(),
        y: Axis::decades(&curves),
        curves,
        height: 230,
    }
}

/// A sheet of panels against time.
///
/// # Errors
/// Failed: it cannot be drawn.
pub(super) fn sheet(
    title: &str,
    subject: &Subject<'_>,
    more: &str,
    panels: Vec<Panel>,
) -> Result<String, Failure> {
    drawn(&Figure {
        paper: false,
        title: title.to_owned(),
        subtitle: subject.subtitle(more),
        x: subject.times(),
        x_label: "time t".to_owned(),
        panels,
    })
}

/// The SVG of a figure.
///
/// # Errors
/// Failed: it cannot be drawn.
pub(super) fn drawn(figure: &Figure) -> Result<String, Failure> {
    let svg = figure.svg();
    svg.map_err(|error| Failure::Failed(format!("cannot draw {}: {error}", figure.title)))
}
