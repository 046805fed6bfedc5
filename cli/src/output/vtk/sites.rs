//! Quantities at the sites of labels: lines from node to node, sets of points and bodies. Takes a card and a plan;
//! gives a part for each label.

use super::columns::{Columns, in_space, name_axes};
use super::{Data, Part};
use crate::output::places::{Places, Point};
use crate::output::sites::{AtSites, at_sites};
use crate::plan::Plan;
use clebsch::card::Card;
use clebsch::record::vtk::{PolyData, Values};
use clebsch_core::lattice::Sites;
use std::ops::Range;

/// The distance between sites without positions.
const APART: f64 = 1.0;

/// Points of sites, joined along a line.
struct OfSites {
    points: Vec<SiteLocation>,
    joined: bool,
    /// The name of the positions, and their number of components.
    places: Option<(String, usize)>,
    point_data: Vec<Columns>,
    cell_data: Vec<Columns>,
}

/// The location at which a site is drawn.
enum SiteLocation {
    /// A position in the plane or in space.
    At(Point),
    /// A number, as the height over the number of its site.
    Height(f64, Point),
    /// In a row.
    Standing(f64),
}

/// The labels of a model in the order of their first quantities; for a fluid whose particles are drawn, only its
/// chain.
pub(super) fn parts(card: &Card, plan: &Plan, fluid: bool) -> Vec<(String, Box<dyn Part>)> {
    let all = at_sites(card);
    let mut labels: Vec<&str> = Vec::new();
    for q in all.iter().filter(|q| q.on_line || !fluid) {
        if !labels.contains(&q.index.as_str()) {
            labels.push(&q.index);
        }
    }
    let sets = labels.len();
    let named = labels.into_iter().filter_map(|label| {
        let own: Vec<&AtSites<'_>> = all.iter().filter(|q| q.index == label).collect();
        let on_line = own.first()?.on_line;
        let part = of_label((card, plan), &own)?;
        let name = match (on_line, sets) {
            (true, _) => "line".to_owned(),
            (false, 1) => "sites".to_owned(),
            (false, _) => format!("sites-{}", clebsch_core::expr::symbol::ascii(label)),
        };
        Some((name, Box::new(part) as Box<dyn Part>))
    });
    named.collect()
}

#[allow(clippy::cast_precision_loss)]
fn of_label((card, plan): (&Card, &Plan), own: &[&AtSites<'_>]) -> Option<OfSites> {
    let is_place = |q: &AtSites<'_>, d: usize| q.moves && q.field.cols == 1 && q.field.rows == d;
    let of_size = |d: usize| own.iter().find(|q| is_place(q, d));
    let places = of_size(3).or(of_size(2)).or(of_size(1));
    let first = own.first()?;
    let on_line = first.on_line;
    // A chain without positions is drawn with nodes.
    let at = places.map_or(if on_line { Sites::Nodes } else { first.at }, |q| q.at);
    let (ring, segments) = ring_and_segments(plan, own, on_line);
    let count = match at {
        Sites::Nodes => segments + 1,
        Sites::Segments => segments,
        Sites::Members => first.members.len(),
    };
    let points = (0..count).map(|site| {
        let Some(q) = places else {
            return Some(SiteLocation::Standing(APART * site as f64));
        };
        let known = Places::themselves((card, plan), q);
        let point = known.point(isize::try_from(site).ok()?)?;
        Some(match q.field.rows {
            1 => SiteLocation::Height(site as f64, point),
            _ => SiteLocation::At(point),
        })
    });
    let points: Vec<SiteLocation> = points.collect::<Option<_>>()?;
    let of_sites = |at: Sites, count: usize| {
        let all = own.iter().filter(|q| q.at == at);
        // Positions are the points themselves, so they do not need an array of values.
        let all = all.filter(|q| places.is_none_or(|p| p.key != q.key));
        let mut all: Vec<Columns> = all
            .map(|q| Columns::of(&q.key, q.field, columns(q, count, ring.then_some(segments))))
            .collect();
        name_axes(&mut all);
        all
    };
    let joined = on_line && points.len() > 1;
    let cell_data = match (joined, at) {
        (true, Sites::Nodes) => of_sites(Sites::Segments, segments),
        _ => Vec::new(),
    };
    Some(OfSites {
        point_data: of_sites(at, points.len()),
        points,
        joined,
        places: places.map(|q| (q.key.clone(), q.field.rows)),
        cell_data,
    })
}

/// Whether a line is closed, and how many segments it has.
fn ring_and_segments(plan: &Plan, own: &[&AtSites<'_>], on_line: bool) -> (bool, usize) {
    let ring = on_line && plan.choice.as_ref().is_some_and(|c| c.periodic);
    let last = own
        .iter()
        .flat_map(|q| q.members.iter().map(move |(site, _)| (q.at, *site)));
    let segments = last.map(|(at, site)| match (at, ring) {
        (Sites::Nodes, false) => site,
        _ => site + 1,
    });
    let counted = segments.max().unwrap_or(0);
    // A last node with a prescribed value does not have a column, so the chosen count is preferred.
    let chosen = plan.choice.as_ref().and_then(|c| match *c.counts {
        [only] if on_line => Some(only),
        _ => None,
    });
    (ring, chosen.unwrap_or(counted))
}

/// The columns of a quantity at `count` sites. On a ring the first site is repeated at the end.
fn columns(q: &AtSites<'_>, count: usize, ring: Option<usize>) -> Vec<Option<Range<usize>>> {
    let mut at = vec![None; count];
    for (site, columns) in &q.members {
        if let Some(at) = at.get_mut(*site) {
            *at = Some(columns.clone());
        }
    }
    if let (Some(segments), Some(first)) = (ring, at.first().cloned())
        && let Some(last) = at.get_mut(segments)
    {
        *last = first;
    }
    at
}

impl SiteLocation {
    fn place(&self, row: &[f64]) -> [f64; 3] {
        match self {
            SiteLocation::Standing(x) => [*x, 0.0, 0.0],
            SiteLocation::At(point) => in_space(&point.at(row)),
            SiteLocation::Height(x, point) => {
                let height = point.at(row).first().copied();
                [*x, height.unwrap_or(f64::NAN), 0.0]
            }
        }
    }
}

impl Part for OfSites {
    fn data(&mut self, row: &[f64]) -> Data {
        let points: Vec<[f64; 3]> = self.points.iter().map(|p| p.place(row)).collect();
        let own = self.places.as_ref().map(|(name, size)| match size {
            1 => Values::numbers(name, points.iter().map(|p| p[1]).collect()),
            _ => Values::vectors(name, &points),
        });
        let last = points.len().saturating_sub(1) as u64;
        let mut data = match self.joined {
            // One line for each segment, from node to node, since segments have their own values.
            true => PolyData {
                points,
                lines: (0..last).map(|i| vec![i, i + 1]).collect(),
                ..PolyData::default()
            },
            false => PolyData::of_points(points),
        };
        let others = self.point_data.iter().flat_map(|c| c.values(row));
        data.point_data = own.into_iter().chain(others).collect();
        data.cell_data = self.cell_data.iter().flat_map(|c| c.values(row)).collect();
        Data::Poly(data)
    }
}
