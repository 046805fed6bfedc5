//! The derivative of the action of a step with given initial velocities. Takes the numbers of a node, velocities and
//! the length of the step; gives `-D1 L` by the components of each configuration.

use super::{Legendre, NoMomentum, Velocities, copy, most};
use crate::displacement::moved;
use crate::evaluate::Here;
use crate::lagrangian::derivatives;
use crate::number::UNIT;
use crate::scene::{Scene, Varied};
use crate::setup::{Numbers, Setup};
use crate::sites::{Moving, varied};
use crate::small_step_limit::Block;
use crate::stated::Role;

/// Number of configurations whose derivatives are computed together.
const TOGETHER: usize = 32;

/// The largest number of corrections for the missing part of a velocity.
const STAGES: usize = 4;

/// The fraction of a velocity over which momenta are linear in it.
const SMALL: f64 = 1.0 / 4096.0;

impl Legendre {
    /// `-D1 L` for a step of this size, by the components of each configuration. Far from the origin, the rounding of
    /// displacements exceeds the velocity. Differences of `-D1 L` add the missing part of the velocity.
    pub(super) fn sample(
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
        // The part of the velocities that the displacements between two nodes do not represent.
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
            // Small enough that momenta are linear over it, and large enough not to vanish in rounding.
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

    /// The moving fields: the positions of their numbers, their names, and their velocities.
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
            let by = Varied {
                at_first_node_only: true,
                ..varied(&part)
            };
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

    /// The numbers after a step with these velocities, including advected quantities.
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
            let numbers = numbers.ok_or_else(|| {
                format!("the size of the velocity of `{}` does not match", m.name)
            })?;
            put(&mut after, own.from, &numbers);
        }
        let nothing = Varied::default();
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
}

/// These variables, numbered from the first.
fn renumbered<'a>(part: &[Moving<'a>]) -> Vec<Moving<'a>> {
    let mut first = 0;
    let each = part.iter().map(|m| {
        let own = Moving { first, ..m.clone() };
        first += u32::try_from(2 * m.components).unwrap_or(u32::MAX);
        own
    });
    each.collect()
}
