//! The momenta of initial velocities: the discrete Legendre transform of the action as stated. Takes the numbers of a node and
//! velocities; gives `-D1 L` of a step that begins with these velocities, in the limit of small steps.
//!
//! The limit is the momentum to every order of the method: a step of h from it begins with the velocity that was given, while
//! `-D1 L` of a displacement of h times the velocity belongs to the mean velocity over that step, which differs by a term of order h.

use crate::evaluate::Here;
use crate::group::Group;
use crate::lagrangian::derivatives;
use crate::moved::{Frame, Velocity, along, moved};
use crate::number::UNIT;
use crate::refined::{Block, limit};
use crate::scene::{Scene, Varied};
use crate::setup::{Numbers, Setup};
use crate::sites::{Moving, all_moving, varied};
use crate::stated::{Role, Stated};
use clebsch_core::syntax::ast::Model;
use std::collections::{BTreeMap, BTreeSet};

/// Configurations whose derivatives are taken together.
const TOGETHER: usize = 32;

/// The angle by which the first displacement turns.
const FIRST: f64 = 0.25;

/// How often what is missing of a velocity is put in.
const STAGES: usize = 4;

/// Part of a velocity over which momenta are linear in it.
const SMALL: f64 = 1.0 / 4096.0;

/// The largest error, beside the momenta, of a limit that exists.
const CONVERGED: f64 = 1e-7;

/// What momenta that do not depend on another velocity may differ by, beside the largest of them.
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
    /// The statement, or what of it, is not evaluated.
    Unread(String),
    /// The derivative of the action of a step has no limit of small steps.
    NoLimit,
    /// A velocity is not tangent to a constraint: its name, the site, and the rate at which it is left.
    Across(String, Option<usize>, f64),
    /// The momentum of the first configuration depends on the velocity of the second one.
    Coupled(String, String),
}

impl From<String> for NoMomentum {
    fn from(why: String) -> Self {
        Self::Unread(why)
    }
}

/// Gives momenta to velocities, for one model and case.
#[derive(Clone, Debug)]
pub struct Legendre {
    stated: Stated,
    setup: Setup,
}

/// The velocities of all configurations, by name and site.
pub type Velocities = BTreeMap<String, Velocity>;

impl Legendre {
    /// For a model with these sizes by name. The observables of the setup are the initial values.
    ///
    /// # Errors
    /// Why it cannot be evaluated.
    pub fn new(model: &Model, sizes: &[(String, usize)], setup: Setup) -> Result<Self, String> {
        let mut stated = Stated::read(model, sizes)?;
        // Functionals of all sites stand in terms of a node, which vanish with the step.
        let functionals = std::mem::take(&mut stated.functionals);
        stated
            .terms
            .retain(|term| !functionals.iter().any(|name| term.value.has(name)));
        Ok(Self { stated, setup })
    }

    /// The momenta at a node of configurations that move with these velocities. What is not named rests, but for the
    /// configurations whose momenta are `known`: they have velocities that are not known here.
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
        if known.is_empty() {
            self.tangent(node, velocities, &moving)?;
            return Ok(plain);
        }
        // With other velocities of these the momenta that are asked for must be the same.
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
            // Of momenta that vanish rounding alone is left.
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
            return Err(format!("`{}` is not known", own.name).into());
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

    /// The longest step that is tried: at most that of the case, which resolves the motion, and nothing turns far over it. A power
    /// of two, by which divisions are exact.
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

    /// `-D1 L` for a step of this length, by the components of each configuration. Displacements are rounded, by more than the
    /// velocity far from the origin: what is missing of the velocity is put in by differences.
    fn sample(
        &self,
        node: &[f64],
        velocities: &Velocities,
        moving: &[Moving<'_>],
        step: f64,
    ) -> Result<Vec<Block>, NoMomentum> {
        let setup = self.setup.clone().with_step(step);
        let first = self.after(&setup, node, velocities, moving)?;
        let base = self.derived(&setup, node, &first, moving)?;
        let mut out = base.clone();
        let shifts = self.shifts(&setup, moving, velocities);
        let speed = most(shifts.iter().flat_map(|(_, _, v)| v));
        let size = most(shifts.iter().flat_map(|(own, ..)| own.of(node)));
        // What displacements between two nodes leave of velocities.
        let without = |left: &[Vec<f64>], (from, to): (&[f64], &[f64]), by: f64| -> Vec<Vec<f64>> {
            let each = left.iter().zip(&shifts).map(|(left, (own, ..))| {
                let ends = own.of(from).iter().zip(own.of(to));
                let each = left.iter().zip(ends);
                each.map(|(v, (a, b))| v - (b - a) / (setup.h * by))
                    .collect()
            });
            each.collect()
        };
        let all: Vec<Vec<f64>> = shifts.iter().map(|(_, _, v)| v.clone()).collect();
        let mut left = without(&all, (node, &first), 1.0);
        for _ in 0..STAGES {
            let largest = most(left.iter().flatten());
            if largest <= 0.25 * UNIT * speed {
                break;
            }
            // So small that momenta are linear over it, so large that it is not lost in rounding.
            let wanted = f64::max(SMALL * speed, UNIT * size / (SMALL * step.abs()));
            let by = (wanted / largest).log2().ceil().exp2().max(1.0);
            if !by.is_finite() {
                break;
            }
            let mut others = velocities.clone();
            for (missing, (_, name, _)) in left.iter().zip(&shifts) {
                let own = others.get_mut(name).and_then(|v| v.moving.as_mut());
                for (v, w) in own.into_iter().flatten().zip(missing) {
                    *v += by * w;
                }
            }
            let after = self.after(&setup, node, &others, moving)?;
            let with = self.derived(&setup, node, &after, moving)?;
            for ((own, base), with) in out.iter_mut().zip(&base).zip(with) {
                let both = base.values.iter().zip(with.values);
                for (x, (a, b)) in own.values.iter_mut().zip(both) {
                    *x += (b - a) / by;
                }
            }
            left = without(&left, (&first, &after), by);
        }
        Ok(out)
    }

    /// The fields that move: where their numbers stand, their names, and their velocities.
    fn shifts(
        &self,
        setup: &Setup,
        moving: &[Moving<'_>],
        velocities: &Velocities,
    ) -> Vec<(Numbers, String, Vec<f64>)> {
        let each = moving.iter().filter_map(|m| {
            let role = self.stated.quantities.get(m.name).map(|q| &q.role);
            let name = copy(m);
            let velocity = velocities.get(&name)?.moving.clone()?;
            let own = setup.observed(m.name, m.site)?;
            matches!(role, Some(Role::Field(_))).then(|| (*own, name, velocity))
        });
        each.collect()
    }

    /// `-D1 L` between two nodes.
    fn derived(
        &self,
        setup: &Setup,
        node: &[f64],
        after: &[f64],
        moving: &[Moving<'_>],
    ) -> Result<Vec<Block>, NoMomentum> {
        let mut out = Vec::with_capacity(moving.len());
        for part in moving.chunks(TOGETHER) {
            let part = renumbered(part);
            let by = varied(&part);
            let slopes = derivatives(&self.stated, setup, [node, after], &part, &by)?;
            for m in &part {
                let first = usize::try_from(m.first).unwrap_or(usize::MAX);
                let own = || slopes.iter().skip(first).take(m.components);
                let role = self.stated.quantities.get(m.name).map(|q| &q.role);
                out.push(Block {
                    values: own().map(|slope| -slope.value).collect(),
                    rounding: own().map(|slope| slope.error).collect(),
                    snaps: matches!(role, Some(Role::Element(..))),
                });
            }
        }
        Ok(out)
    }

    /// The numbers after a step with these velocities, of what is advected too.
    fn after(
        &self,
        setup: &Setup,
        node: &[f64],
        velocities: &Velocities,
        moving: &[Moving<'_>],
    ) -> Result<Vec<f64>, NoMomentum> {
        let mut after = node.to_vec();
        let put = |after: &mut Vec<f64>, from: usize, numbers: &[f64]| {
            if let Some(slots) = after.get_mut(from..from + numbers.len()) {
                slots.copy_from_slice(numbers);
            }
        };
        for m in moving {
            let Some(velocity) = velocities.get(&copy(m)) else {
                continue;
            };
            let own = setup.observed(m.name, m.site);
            let role = self.stated.quantities.get(m.name).map(|q| &q.role);
            let (Some(own), Some(role)) = (own, role) else {
                continue;
            };
            let numbers = moved(role, own.of(node), velocity, setup.h);
            let numbers =
                numbers.ok_or_else(|| format!("the velocity of `{}` does not fit", m.name))?;
            put(&mut after, own.from, &numbers);
        }
        let nothing = Varied::new();
        let with_configurations = after.clone();
        let scene = Scene::new(&self.stated, setup, [node, &with_configurations], &nothing);
        for q in self.stated.quantities.values() {
            let (Role::Advected, Some(update)) = (&q.role, &q.update) else {
                continue;
            };
            let sites: Vec<Option<usize>> = match q.at {
                None => vec![None],
                Some((label, sites)) => {
                    let count = setup.sites(&self.stated, label, sites);
                    (0..count).map(Some).collect()
                }
            };
            for site in sites {
                let Some(own) = setup.observed(&q.name, site) else {
                    continue;
                };
                let index = site.map_or(0, |s| i64::try_from(s).unwrap_or(0));
                let value = scene.value(update, Here::at(index))?;
                let rows = if q.is_quaternion { 4 } else { own.rows };
                let cols = if q.is_quaternion { 4 } else { own.cols };
                let sized = value.sized(rows, cols);
                let sized = sized.ok_or_else(|| format!("`{}` changes its shape", q.name))?;
                let every = if q.is_quaternion && own.cols == 1 {
                    4
                } else {
                    1
                };
                let numbers: Vec<f64> = sized
                    .entries
                    .iter()
                    .step_by(every)
                    .map(|x| x.value)
                    .collect();
                put(&mut after, own.from, &numbers);
            }
        }
        Ok(after)
    }

    /// Refuses velocities that leave a constraint.
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
            let (mut rate, mut size) = (0.0, 0.0);
            for (of, slope) in held.slopes {
                let own = rates.get(&of).copied().unwrap_or(0.0);
                rate += slope * own;
                size += (slope * own).abs();
            }
            if rate.abs() > TANGENT * size {
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

/// Part of its terms by which the rate of what is held may differ from zero.
const TANGENT: f64 = 1e-8;

/// The mean of a step forward and one backward, in which odd powers of the step cancel.
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

/// The name of a configuration with its site.
fn copy(m: &Moving<'_>) -> String {
    match m.site {
        None => m.name.to_owned(),
        Some(site) => format!("{}_{site}", m.name),
    }
}

/// The same with variables counted from the first.
fn renumbered<'a>(part: &[Moving<'a>]) -> Vec<Moving<'a>> {
    let mut first = 0;
    let each = part.iter().map(|m| {
        let own = Moving { first, ..m.clone() };
        first += u32::try_from(2 * m.components).unwrap_or(u32::MAX);
        own
    });
    each.collect()
}
