//! Signs of unit quaternions of an expanded chain. Signs are aligned in the same way as in a chain with loops over
//! sites. Takes the initial values in the order of a card; changes the signs of some.

use clebsch::card::Card;
use clebsch::line::{self, Attitude, Attitudes};
use clebsch::{ParameterError, UnitQuaternion};
use clebsch_core::expr::symbol::ascii;
use clebsch_core::lattice::{ChainConfig, Lattice};
use clebsch_core::line::Signs;
use nalgebra::Matrix4;

/// One quantity along a chain.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// The quantity.
    quantity: &'static str,
    /// The indices of its sites among the initial values, in order.
    sites: Vec<usize>,
    /// Quaternions that end conditions prescribe, the last end before the first: the index among the parameters, and
    /// the neighbouring site.
    walls: Vec<(usize, usize)>,
    /// Whether it has to agree around a ring.
    closes: bool,
}

impl Agreement {
    /// The quantities of a card whose signs must agree. Fields of the card are copies of quantities.
    pub fn of(
        signs: Vec<Signs>,
        lattice: &Lattice,
        choice: &ChainConfig,
        card: &Card,
    ) -> Vec<Self> {
        let each = signs.into_iter().filter_map(|signs| {
            let count = choice.sites_of(lattice, lattice.find(&signs.of)?);
            let of = ascii(&signs.of);
            let place = |i: usize| {
                let name = format!("{of}_{i}");
                card.initial.iter().position(|f| f.ascii == name)
            };
            let sites: Option<Vec<usize>> = (0..count).map(place).collect();
            let segments = lattice.line.map_or(0, |l| choice.count(l));
            let mut walls = Vec::new();
            for last in [true, false] {
                let at = usize::from(last);
                let own = signs.walls[at].iter();
                let chosen = own.filter(|w| w.which == choice.ends[at] && !choice.periodic);
                for wall in chosen {
                    let end = if last { segments } else { 0 };
                    let name = format!("{}_{end}", ascii(&wall.parameter));
                    let given = card.parameters.iter().position(|f| f.ascii == name)?;
                    let site = match last {
                        true => (count - 1).checked_sub(wall.site)?,
                        false => wall.site,
                    };
                    walls.push((given, site));
                }
            }
            Some(Agreement {
                quantity: crate::text(&signs.of),
                sites: sites?,
                walls,
                closes: signs.seen && choice.periodic,
            })
        });
        each.collect()
    }

    /// Makes the signs agree.
    ///
    /// # Errors
    /// If the signs cannot agree around a ring.
    pub fn make(
        &self,
        parameters: &[Vec<f64>],
        initial: &mut [Vec<f64>],
    ) -> Result<(), ParameterError> {
        let read = |place: &usize| -> Option<Attitude> {
            let components = <[f64; 4]>::try_from(initial.get(*place)?.as_slice()).ok()?;
            let q = UnitQuaternion::from_components(components).ok()?;
            Some(Attitude::of_quaternion(q))
        };
        let given: Option<Attitudes<f64>> = self.sites.iter().map(read).collect();
        // Values that are not unit quaternions are reported when they are read.
        let Some(given) = given else {
            return Ok(());
        };
        let mut list = given.clone();
        line::agree(&mut list);
        for (place, site) in &self.walls {
            if let Some(wall) = parameters.get(*place).filter(|w| w.len() == 16) {
                line::turn_towards(&mut list, *site, &Matrix4::from_row_slice(wall));
            }
        }
        for ((place, before), after) in self.sites.iter().zip(given.iter()).zip(list.iter()) {
            if before != after
                && let Some(own) = initial.get_mut(*place)
            {
                own.iter_mut().for_each(|x| *x = -*x);
            }
        }
        match self.closes {
            true => line::closes(self.quantity, &list),
            false => Ok(()),
        }
    }
}
