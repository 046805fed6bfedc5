//! The plot of the modes of a chain: the amplitude of each over the sites. Takes modes; gives SVG.

use super::half;
use crate::case_file::at_site;
use crate::derivatives::problem::Problem;
use crate::models::fields::is_momentum;
use crate::plots::axis::Axis;
use crate::plots::curve::{Curve, Marks, Stroke};
use crate::plots::figure::{Figure, Panel};
use crate::words::number::{plain, short};
use clebsch::nalgebra::Complex;
use clebsch_analysis::{Linear, Mode};
use std::collections::BTreeMap;

/// The largest number of modes in the picture.
const MODES: usize = 8;

/// The figure, for models with at least three sites of a quantity.
pub(super) fn figure(
    problem: &Problem,
    dimensions: &[usize],
    found: &Linear,
) -> Option<Result<String, String>> {
    let sites = sites(problem, dimensions)?;
    let mut modes = half(&found.modes);
    modes.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    let first = sites.places.first()?.0;
    let last = sites.places.last()?.0;
    let panels = modes.into_iter().take(MODES).map(|mode| {
        let points = amplitudes(mode, &sites);
        let curves = vec![Curve {
            label: String::new(),
            note: None,
            points,
            stroke: Stroke::number(0).marked(Marks::Full),
        }];
        let growth = match mode.growth.abs() > 10.0 * mode.error {
            true => format!(", growth {}", short(mode.growth)),
            false => String::new(),
        };
        Panel {
            map: None,
            caption: format!("frequency {}{growth}", short(mode.frequency)),
            y_label: sites.name.clone(),
            y: Axis::linear(-1.1, 1.1, 4),
            height: 120,
            curves,
        }
    });
    let figure = Figure {
        paper: false,
        title: format!("{}: modes", problem.title()),
        subtitle: format!(
            "lowest frequencies, amplitudes of {} scaled to 1, h = {}",
            sites.name,
            plain(problem.plan.case.h)
        ),
        x: Axis::whole(first as f64, last as f64, 10),
        x_label: "site".to_owned(),
        panels: panels.collect(),
    };
    Some(figure.svg())
}

/// A quantity at sites: its name, and for each site its coordinates.
struct Sites {
    name: String,
    places: Vec<(usize, Vec<usize>)>,
}

/// The first quantity that is at several sites and no momentum.
fn sites(problem: &Problem, dimensions: &[usize]) -> Option<Sites> {
    let mut first = 0;
    let mut all: Vec<(&str, BTreeMap<usize, Vec<usize>>)> = Vec::new();
    for (field, count) in problem.card.initial.iter().zip(dimensions) {
        let places: Vec<usize> = (first..first + count).collect();
        first += count;
        let Some((stem, site)) = at_site(field.ascii).filter(|_| !is_momentum(field)) else {
            continue;
        };
        match all.iter_mut().find(|(own, _)| *own == stem) {
            Some((_, own)) => {
                own.insert(site, places);
            }
            None => all.push((stem, BTreeMap::from([(site, places)]))),
        }
    }
    let (name, places) = all.into_iter().find(|(_, places)| places.len() >= 3)?;
    Some(Sites {
        name: name.to_owned(),
        places: places.into_iter().collect(),
    })
}

/// The real amplitudes at the sites, in the phase of the largest one, of the component with the largest one.
fn amplitudes(mode: &Mode, sites: &Sites) -> Vec<(f64, f64)> {
    let entry = |at: usize| mode.vector.get(at).copied().unwrap_or_default();
    let component = |places: &[usize], c: usize| places.get(c).map(|at| entry(*at));
    let each = sites
        .places
        .iter()
        .flat_map(|(_, places)| places.iter().enumerate());
    let largest = each.max_by(|a, b| entry(*a.1).norm().total_cmp(&entry(*b.1).norm()));
    let Some((c, at)) = largest else {
        return Vec::new();
    };
    let scale: Complex<f64> = entry(*at);
    let own = sites.places.iter().filter_map(|(site, places)| {
        let z = component(places, c)?;
        let part = if scale.norm() > 0.0 {
            (z / scale).re
        } else {
            0.0
        };
        Some((*site as f64, part))
    });
    own.collect()
}
