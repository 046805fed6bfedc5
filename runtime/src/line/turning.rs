//! Computes the attitudes at the end of the edges of several bodies at once, if one solver iteration suffices for each.
//! Takes attitudes, edges and a body shared by all sites; gives a stage of the loop over sites.

use super::part::{InColumns, LANES};
use super::window::Windowed;
use super::{Attitude, Attitudes, Edges, Stage};
use crate::Real;
use crate::solvers::moser_veselov::{Edge, Poinsot};

/// Rotates bodies by the principal solution of the Moser-Veselov equation.
pub struct Turning<'a, T: Real> {
    /// The attitudes at the start of the edges.
    pub at: &'a Attitudes<T>,
    /// The momenta of the edges, in space.
    pub edges: &'a Edges<T>,
    /// The bodies; a single one if all sites have the same body.
    pub bodies: &'a [Poinsot<T>],
    /// The step size.
    pub h: T,
    /// The first site of the part.
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

    /// If the bodies differ, the sites are computed one by one.
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
