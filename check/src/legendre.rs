//! Computes the momenta of initial velocities by the discrete Legendre transform of the action as stated. Takes the
//! numbers of a node and velocities; gives `-D1 L` of a step that begins with these velocities, in the limit of small
//! steps.
//!
//! The limit is the momentum to every order of the method: a step of size h with this momentum starts with the given
//! velocity. If the displacement is h times the velocity, `-D1 L` belongs to the mean velocity over the step, which
//! differs by a term of order h.

mod determined;
mod step;

use crate::displacement::{Frame, Velocity, along};
use crate::group::Group;
use crate::scene::Scene;
use crate::setup::Setup;
use crate::sites::{Moving, all_moving, varied};
use crate::small_step_limit::{Block, limit};
use crate::stated::{Role, Stated};
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

/// The angle of the first rotation.
const FIRST: f64 = 0.25;

/// The largest error, relative to the momenta, with which a limit counts as converged.
const CONVERGED: f64 = 1e-7;

/// The largest difference between momenta that do not depend on another velocity, relative to the largest momentum.
const APART: f64 = 1e-9;

/// The momentum of one configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Momentum {
    /// The configuration, with its site: `x_3`.
    pub name: String,
    /// Its components.
    pub components: Vec<f64>,
}

/// Why velocities give no momenta.
#[derive(Clone, Debug, PartialEq)]
pub enum NoMomentum {
    /// The statement or a part of it cannot be evaluated.
    Unread(String),
    /// The derivative of the action of a step does not converge for small steps.
    NoLimit,
    /// A velocity is not tangent to a constraint: its name, the site, and the rate of change of the constraint.
    Across(String, Option<usize>, f64),
    /// The momentum of the first configuration depends on the velocity of the second one.
    Coupled(String, String),
    /// No momentum depends on the velocity of this configuration.
    Lost(String),
}

impl From<String> for NoMomentum {
    fn from(why: String) -> Self {
        Self::Unread(why)
    }
}

/// Gives momenta to velocities, for one model and case.
#[derive(Clone, Debug)]
pub struct Legendre {
    stated: Arc<Stated>,
    setup: Setup,
}

/// The velocities of all configurations, by name and site.
pub type Velocities = BTreeMap<String, Velocity>;

impl Legendre {
    /// For a statement and the data of a case. The observables of the setup are the initial values.
    #[must_use]
    pub fn new(mut stated: Arc<Stated>, setup: Setup) -> Self {
        // Functionals of all sites appear in terms of a node, which vanish with the step.
        if !stated.functionals.is_empty() {
            let own = Arc::make_mut(&mut stated);
            let functionals = std::mem::take(&mut own.functionals);
            own.terms
                .retain(|term| !functionals.iter().any(|name| term.value.has(name)));
        }
        Self { stated, setup }
    }

    /// The momenta of configurations at a node with these velocities. If a configuration is not named, it is at rest.
    /// If its momentum is `known`, its velocity is unknown here.
    ///
    /// # Errors
    /// [`NoMomentum`].
    pub fn momenta(
        &self,
        node: &[f64],
        velocities: &Velocities,
        known: &[String],
    ) -> Result<Vec<Momentum>, NoMomentum> {
        let moving = all_moving(&self.stated, &self.setup);
        let plain = self.limit(node, velocities, &moving)?;
        self.determined(node, velocities, &moving, &plain)?;
        if known.is_empty() {
            self.tangent(node, velocities, &moving)?;
            return Ok(plain);
        }
        // The requested momenta must not depend on the velocities of configurations with known momenta.
        let known: BTreeSet<&str> = known.iter().map(String::as_str).collect();
        let mut others = velocities.clone();
        for m in &moving {
            let name = copy(m);
            if known.contains(name.as_str()) {
                others.insert(name, self.probe(m)?);
            }
        }
        let with = self.limit(node, &others, &moving)?;
        let all = plain.iter().chain(&with).flat_map(|m| &m.components);
        let size = all.fold(0.0, |most, x| f64::max(most, x.abs()));
        let asked = plain.iter().zip(&with);
        for (a, b) in asked.filter(|(a, _)| !known.contains(a.name.as_str())) {
            let both = a.components.iter().zip(&b.components);
            let off = both.fold(0.0, |most, (x, y)| f64::max(most, (x - y).abs()));
            if off > APART * size {
                let other = known
                    .first()
                    .map_or_else(String::new, |name| (*name).to_owned());
                return Err(NoMomentum::Coupled(a.name.clone(), other));
            }
        }
        Ok(plain)
    }

    fn limit(
        &self,
        node: &[f64],
        velocities: &Velocities,
        moving: &[Moving<'_>],
    ) -> Result<Vec<Momentum>, NoMomentum> {
        let longest = self.longest(velocities);
        let refined = limit(|level| {
            let step = longest * 0.5_f64.powi(i32::try_from(level).unwrap_or(i32::MAX));
            let ahead = self.sample(node, velocities, moving, step)?;
            let behind = self.sample(node, velocities, moving, -step)?;
            Ok::<_, NoMomentum>(ahead.into_iter().zip(behind).map(mean).collect())
        })?;
        let mut out = Vec::with_capacity(moving.len());
        for (m, found) in moving.iter().zip(refined) {
            let size = found.values.iter().fold(0.0, |a, x| f64::max(a, x.abs()));
            // If a momentum vanishes, only rounding is left.
            if !(found.error <= CONVERGED * size || found.error <= 2.0 * found.rounding) {
                return Err(NoMomentum::NoLimit);
            }
            out.push(Momentum {
                name: copy(m),
                components: found.values,
            });
        }
        Ok(out)
    }

    /// Some velocity of a configuration.
    fn probe(&self, own: &Moving<'_>) -> Result<Velocity, NoMomentum> {
        #[allow(clippy::cast_precision_loss)]
        let some = |count: usize| (1..=count).map(|i| 1.0 / i as f64).collect::<Vec<f64>>();
        let Some(q) = self.stated.quantities.get(own.name) else {
            return Err(format!("`{}` is unknown", own.name).into());
        };
        Ok(match &q.role {
            Role::Element(Group::Motion(n), _) => Velocity {
                turning: Some((some(own.components - n), Frame::Body)),
                moving: Some(some(*n)),
            },
            Role::Element(Group::Rotation(_) | Group::Quaternion, _) => Velocity {
                turning: Some((some(own.components), Frame::Body)),
                moving: None,
            },
            _ => Velocity {
                turning: None,
                moving: Some(some(own.components)),
            },
        })
    }

    /// The largest step that is tried. It is a power of two, so that divisions are exact. Rotations in it are at most
    /// `FIRST`. If a configuration moves or nothing rotates, it is not larger than the step of the case, which
    /// resolves the motion.
    fn longest(&self, velocities: &Velocities) -> f64 {
        let turning = velocities.values().filter_map(|v| v.turning.as_ref());
        let fastest = most(turning.flat_map(|(w, _)| w));
        let moves = velocities.values().any(|v| v.moving.is_some());
        let time = match (fastest > 0.0, moves) {
            (true, true) => (FIRST / fastest).min(self.setup.h),
            (true, false) => FIRST / fastest,
            (false, _) => self.setup.h,
        };
        time.log2().floor().exp2()
    }

    /// Rejects velocities that are not tangent to a constraint.
    fn tangent(
        &self,
        node: &[f64],
        velocities: &Velocities,
        moving: &[Moving<'_>],
    ) -> Result<(), NoMomentum> {
        if self.stated.holds.is_empty() || velocities.values().all(Velocity::is_zero) {
            return Ok(());
        }
        let rates = self.rates(node, velocities, moving);
        let by = varied(moving);
        let scene = Scene::new(&self.stated, &self.setup, [node, node], &by);
        for held in crate::holds::gradients(&scene, &self.stated, &self.setup, moving)? {
            // The terms of a rate may all be rounding, for example at the lowest point of a pendulum.
            let (mut rate, mut gradient) = (0.0, 0.0_f64);
            let mut held_places = BTreeSet::new();
            for (of, slope) in held.slopes {
                rate += slope * rates.get(&of).copied().unwrap_or(0.0);
                gradient = gradient.hypot(slope);
                let own = moving.iter().map(places).find(|own| own.contains(&of));
                held_places.extend(own.into_iter().flatten());
            }
            let held_rates = held_places.iter().filter_map(|of| rates.get(of));
            let speed = held_rates.fold(0.0_f64, |all, x| all.hypot(*x));
            if rate.abs() > TANGENT * gradient * speed {
                return Err(NoMomentum::Across(held.name, held.site, rate));
            }
        }
        Ok(())
    }

    /// The velocities by the variables of the first node.
    fn rates(
        &self,
        node: &[f64],
        velocities: &Velocities,
        moving: &[Moving<'_>],
    ) -> BTreeMap<usize, f64> {
        let mut out = BTreeMap::new();
        for m in moving {
            let own = self.setup.observed(m.name, m.site).map(|o| o.of(node));
            let role = self.stated.quantities.get(m.name).map(|q| &q.role);
            let (Some(numbers), Some(role), Some(velocity)) = (own, role, velocities.get(&copy(m)))
            else {
                continue;
            };
            let first = usize::try_from(m.first).unwrap_or(usize::MAX);
            let components = along(role, numbers, velocity).unwrap_or_default();
            out.extend(
                components
                    .into_iter()
                    .enumerate()
                    .map(|(i, v)| (first + i, v)),
            );
        }
        out
    }
}

/// The largest rate of change of a constraint, relative to its gradient times the velocity, that counts as zero.
const TANGENT: f64 = 1e-8;

/// The mean of a forward and a backward step, in which odd powers of the step cancel.
fn mean((ahead, behind): (Block, Block)) -> Block {
    let both = |a: Vec<f64>, b: Vec<f64>| -> Vec<f64> {
        let each = a.into_iter().zip(b);
        each.map(|(x, y)| 0.5 * (x + y)).collect()
    };
    Block {
        values: both(ahead.values, behind.values),
        rounding: both(ahead.rounding, behind.rounding),
        snaps: ahead.snaps,
    }
}

fn most<'n>(all: impl IntoIterator<Item = &'n f64>) -> f64 {
    all.into_iter().fold(0.0, |a, x| f64::max(a, x.abs()))
}

/// The variables of a configuration at the first node.
fn places(m: &Moving<'_>) -> std::ops::Range<usize> {
    let first = usize::try_from(m.first).unwrap_or(usize::MAX);
    first..first.saturating_add(m.components)
}

/// The name of a configuration with its site.
fn copy(m: &Moving<'_>) -> String {
    match m.site {
        None => m.name.to_owned(),
        Some(site) => format!("{}_{site}", m.name),
    }
}
