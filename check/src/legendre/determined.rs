//! Checks that the momenta determine the velocities. Without kinetic energy, the velocity of a configuration would
//! not affect the momenta. Takes the momenta; compares them with the momenta at rest.

use super::{Legendre, Momentum, NoMomentum, Velocities, copy, mean};
use crate::displacement::Velocity;
use crate::number::larger;
use crate::sites::Moving;

/// The smallest change of a momentum in the limit that counts, relative to its change over a step.
const KNOWN: f64 = 1e-9;

/// A velocity below this fraction of the largest velocity may vanish in the rounding of a momentum, for example far
/// from a vortex.
const SLIGHT: f64 = 1e-9;

/// The largest number of configurations that are tried separately.
const MOST: usize = 8;

impl Legendre {
    /// Rejects a velocity on which no momentum depends.
    pub(super) fn determined(
        &self,
        node: &[f64],
        velocities: &Velocities,
        moving: &[Moving<'_>],
        momenta: &[Momentum],
    ) -> Result<(), NoMomentum> {
        let most = velocities.values().map(Velocity::size).fold(0.0, larger);
        let is_moved = |v: Option<&Velocity>| v.is_some_and(|v| v.size() > SLIGHT * most);
        if most == 0.0 {
            return Ok(());
        }
        let rest = self.limit(node, &Velocities::new(), moving)?;
        let step = self.longest(velocities);
        let over_a_step = self.over_a_step(node, velocities, moving, step)?;
        let own = moving.iter().zip(momenta.iter().zip(&rest));
        let doubtful = own
            .zip(over_a_step)
            .filter(|((m, (with, without)), steps)| {
                is_moved(velocities.get(&copy(m))) && !is_changed(with, without, *steps)
            });
        // A velocity may be determined by the momentum of another configuration.
        for ((m, _), _) in doubtful.take(MOST) {
            let name = copy(m);
            let mut alone = Velocities::new();
            if let Some(velocity) = velocities.get(&name) {
                alone.insert(name.clone(), velocity.clone());
            }
            let with = self.limit(node, &alone, moving)?;
            let over_a_step = self.over_a_step(node, &alone, moving, step)?;
            let mut all = with.iter().zip(&rest).zip(over_a_step);
            if !all.any(|((with, without), steps)| is_changed(with, without, steps)) {
                return Err(NoMomentum::Lost(name));
            }
        }
        Ok(())
    }

    /// How much the velocities change the momentum of each configuration over a finite step, compared with a step at
    /// rest.
    fn over_a_step(
        &self,
        node: &[f64],
        velocities: &Velocities,
        moving: &[Moving<'_>],
        step: f64,
    ) -> Result<Vec<f64>, NoMomentum> {
        let of = |velocities: &Velocities| {
            let ahead = self.sample(node, velocities, moving, step)?;
            let behind = self.sample(node, velocities, moving, -step)?;
            Ok::<_, NoMomentum>(ahead.into_iter().zip(behind).map(mean))
        };
        let each = of(velocities)?.zip(of(&Velocities::new())?);
        Ok(each.map(|(a, b)| apart(&a.values, &b.values)).collect())
    }
}

fn is_changed(with: &Momentum, without: &Momentum, over_a_step: f64) -> bool {
    apart(&with.components, &without.components) > KNOWN * over_a_step
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    let each = a.iter().zip(b).map(|(x, y)| (x - y).abs());
    each.fold(0.0, larger)
}
