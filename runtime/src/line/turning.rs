//! Attitudes where the edges of several bodies end, found together where one iteration of each solve finds them.
//! Takes attitudes, edges and the one body that all of them are; gives a stage of the loop over sites.

use super::part::{InColumns, LANES};
use super::window::Windowed;
use super::{Attitude, Attitudes, Edges, Stage};
use crate::Real;
use crate::solvers::moser_veselov::{Edge, Poinsot};

/// The stage in which bodies turn by the principal solution of the Moser-Veselov equation.
pub struct Turning<'a, T: Real> {
    /// Attitudes at the nodes where edges begin.
    pub at: &'a Attitudes<T>,
    /// Momenta of the edges, in space.
    pub edges: &'a Edges<T>,
    /// The bodies: one where all are alike.
    pub bodies: &'a [Poinsot<T>],
    /// The step.
    pub h: T,
    /// The site with which the part begins.
    pub first: usize,
}

impl<T: Real> Turning<'_, T> {
    #[inline(always)]
    fn turned<P: InColumns<One = Attitude<T>>, const DIAGONAL: bool>(
        &self,
        body: &Poinsot<T>,
        first: usize,
        out: &mut P::Lanes,
    ) -> bool {
        let at = Windowed::<LANES>::window(self.at, first);
        let edges = Windowed::<LANES>::window(self.edges, first);
        let mut all = true;
        for lane in 0..LANES {
            let attitude = at.at(first + lane).rotation();
            let edge = Edge::of_space(edges.at(first + lane), &attitude);
            let (turned, found) = edge.turn_at_once::<DIAGONAL>(body, self.h, &attitude);
            P::put_lane(out, lane, Attitude::turned(&turned));
            all &= found;
        }
        all
    }
}

impl<T: Real> Stage for Turning<'_, T> {
    type One = Attitude<T>;

    /// Bodies that differ are not found together.
    #[inline(always)]
    fn lanes<P: InColumns<One = Attitude<T>>>(&self, first: usize, out: &mut P::Lanes) -> bool {
        let [body] = self.bodies else {
            return false;
        };
        let (body, first) = (*body, self.first + first);
        match body.is_diagonal() {
            true => self.turned::<P, true>(&body, first, out),
            false => self.turned::<P, false>(&body, first, out),
        }
    }
}
