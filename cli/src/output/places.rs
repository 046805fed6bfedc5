//! The positions at which bodies at the sites of a chain are drawn: the point of their node, or the midpoint of their
//! segment. They include points with prescribed positions, and the first point of a ring, repeated at the end.

use crate::output::sites::{AtSites, at_sites};
use crate::plan::Plan;
use clebsch::card::Card;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Sites;
use std::ops::Range;

/// A point that a body is drawn at.
#[derive(Clone)]
pub(crate) enum Point {
    /// A moving point, in these columns, with the offset for one turn around a ring.
    Moving(Range<usize>, Vec<f64>),
    /// A point whose position an end condition prescribes.
    Held(Vec<f64>),
}

impl Point {
    /// The columns of the point; `None` if its position is prescribed.
    pub(crate) fn columns(&self) -> Option<Range<usize>> {
        match self {
            Point::Held(_) => None,
            Point::Moving(columns, _) => Some(columns.clone()),
        }
    }

    /// Its position in a sample.
    pub(crate) fn at(&self, row: &[f64]) -> Vec<f64> {
        match self {
            Point::Held(place) => place.clone(),
            Point::Moving(columns, around) => {
                let own = row.get(columns.clone()).unwrap_or_default().iter();
                let around = around.iter().copied().chain(std::iter::repeat(0.0));
                own.zip(around).map(|(x, by)| x + by).collect()
            }
        }
    }
}

/// The points at which bodies at sites are drawn: a field of positions with the same label.
pub(crate) struct Places<'a> {
    card: &'a Card,
    plan: &'a Plan,
    points: &'a AtSites<'a>,
    /// Offsets from the site of a body to the sites of the points next to it.
    next: [isize; 2],
    /// The number of points, without the points with prescribed positions.
    count: usize,
}

impl<'a> Places<'a> {
    /// The points of these bodies; `None` if no points are at or next to the sites of the bodies.
    pub(crate) fn of(
        (card, plan): (&'a Card, &'a Plan),
        sites: &'a [AtSites<'_>],
        bodies: &AtSites<'_>,
    ) -> Option<Self> {
        let points = || {
            let all = sites.iter().filter(|q| q.moves && q.field.count() == 3);
            all.filter(|q| q.index == bodies.index)
        };
        // Points at the sites of the bodies are preferred to points next to them.
        let points = points().find(|q| q.at == bodies.at).or(points().next())?;
        let next = match (bodies.at, points.at) {
            (a, b) if a == b => [0, 0],
            (Sites::Segments, Sites::Nodes) => [0, 1],
            (Sites::Nodes, Sites::Segments) => [-1, 0],
            _ => return None,
        };
        Some(Places {
            next,
            ..Self::themselves((card, plan), points)
        })
    }

    /// These points at their own sites.
    pub(crate) fn themselves((card, plan): (&'a Card, &'a Plan), points: &'a AtSites<'a>) -> Self {
        Places {
            card,
            plan,
            points,
            next: [0, 0],
            count: points.members.len(),
        }
    }

    /// The points next to a site. At an end of a chain there is only one, which is returned twice. `None` if such a
    /// point does not exist.
    pub(crate) fn at(&self, site: usize) -> Option<(Point, Point)> {
        let beside = self.next.map(|by| {
            let wanted = isize::try_from(site).ok()? + by;
            self.point(wanted)
        });
        match beside {
            [Some(a), Some(b)] => Some((a, b)),
            // There is no segment before the first and after the last one.
            [Some(only), None] | [None, Some(only)] if self.next == [-1, 0] => {
                Some((only.clone(), only))
            }
            _ => None,
        }
    }

    /// The point at a site. On a ring the site may be beyond the last one.
    pub(crate) fn point(&self, wanted: isize) -> Option<Point> {
        let found = |site: usize| {
            // There may be a hundred thousand points. They are in the order of their sites, so a binary search finds
            // a site.
            let members = &self.points.members;
            let at = members.binary_search_by_key(&site, |(s, _)| *s).ok()?;
            members.get(at).map(|(_, c)| c.clone())
        };
        let site = usize::try_from(wanted).ok();
        if let Some(columns) = site.and_then(found) {
            return Some(Point::Moving(columns, Vec::new()));
        }
        if let Some(held) =
            site.and_then(|s| self.given(&format!("{}_{s}", ascii(&self.points.name))))
        {
            return Some(Point::Held(held));
        }
        // On a ring the index wraps around. A ring starts at site 0 and has no end.
        let count = isize::try_from(self.count).ok()?;
        let around = usize::try_from(wanted.rem_euclid(count)).ok()?;
        let ring = self.is_ring() && !(0..count).contains(&wanted);
        let columns = found(around).filter(|_| ring)?;
        let offset = self.points.offset.as_ref();
        let offset = offset.and_then(|name| self.given(name)).unwrap_or_default();
        let turns = if wanted < 0 { -1.0 } else { 1.0 };
        Some(Point::Moving(
            columns,
            offset.iter().map(|x| turns * x).collect(),
        ))
    }

    /// The value of a parameter.
    fn given(&self, name: &str) -> Option<Vec<f64>> {
        let parameters = self.card.parameters.iter();
        let mut all = parameters.zip(&self.plan.case.parameters);
        let (_, value) = all.find(|(field, _)| field.ascii == name)?;
        Some(value.clone())
    }

    /// An open chain has one node more than segments. Positions prescribed at its ends were handled above.
    fn is_ring(&self) -> bool {
        if let Some(choice) = &self.plan.choice {
            return choice.periodic;
        }
        let segments = at_sites(self.card);
        let mut other = segments
            .iter()
            .filter(|q| q.index == self.points.index && q.at != self.points.at);
        other.any(|q| q.members.len() == self.count)
    }
}
