//! Where bodies at the sites of a line are drawn: at the point of their node, or midway between the nodes of their
//! segment, those that an end holds and those once around a ring among them.

use crate::output::sites::{AtSites, at_sites};
use crate::plan::Plan;
use clebsch::card::Card;
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::Sites;
use std::ops::Range;

/// A point that a body is drawn at.
#[derive(Clone)]
pub(crate) enum Point {
    /// One that moves, in these columns, and what is added to it once around a ring.
    Moving(Range<usize>, Vec<f64>),
    /// One that an end holds.
    Held(Vec<f64>),
}

impl Point {
    /// The columns that it is read from; of one that is held none.
    pub(crate) fn columns(&self) -> Option<Range<usize>> {
        match self {
            Point::Held(_) => None,
            Point::Moving(columns, _) => Some(columns.clone()),
        }
    }

    /// Its place in a sample.
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

/// The points that bodies at sites are drawn at: a field of places of the same label.
pub(crate) struct Places<'a> {
    card: &'a Card,
    plan: &'a Plan,
    points: &'a AtSites<'a>,
    /// From the site of a body to those of the points next to it.
    next: [isize; 2],
    /// Sites of the points, those that ends hold left out.
    count: usize,
}

impl<'a> Places<'a> {
    /// The points of these bodies; `None` where there are none, or none that stand beside them.
    pub(crate) fn of(
        (card, plan): (&'a Card, &'a Plan),
        sites: &'a [AtSites<'_>],
        bodies: &AtSites<'_>,
    ) -> Option<Self> {
        let points = || {
            let all = sites.iter().filter(|q| q.moves && q.field.count() == 3);
            all.filter(|q| q.index == bodies.index)
        };
        // Rather those of the same sites than those beside them.
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

    /// These points, at their own sites.
    pub(crate) fn themselves((card, plan): (&'a Card, &'a Plan), points: &'a AtSites<'a>) -> Self {
        Places {
            card,
            plan,
            points,
            next: [0, 0],
            count: points.members.len(),
        }
    }

    /// The points beside a site, twice the only one; `None` where there is none.
    pub(crate) fn at(&self, site: usize) -> Option<(Point, Point)> {
        let beside = self.next.map(|by| {
            let wanted = isize::try_from(site).ok()? + by;
            self.point(wanted)
        });
        match beside {
            [Some(a), Some(b)] => Some((a, b)),
            // Before the first segment and behind the last one there is none.
            [Some(only), None] | [None, Some(only)] if self.next == [-1, 0] => {
                Some((only.clone(), only))
            }
            _ => None,
        }
    }

    /// The point of a site, of a ring also beyond the last one.
    pub(crate) fn point(&self, wanted: isize) -> Option<Point> {
        let found = |site: usize| {
            // They stand in the order of their sites, a hundred thousand of them.
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
        // Once around a ring, which has the site 0 and no end that holds anything.
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

    /// On an open line one node more than segments; places given there are found before.
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
