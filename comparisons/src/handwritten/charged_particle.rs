//! A charge in uniform fields by the method of Boris (1970). Velocities live on the edges: half a kick of E, a rotation about B by
//! 2 atan(q |B| h/2m), half a kick. Takes mass, charge, B, E, position, momentum and h; gives positions and momenta at the nodes.

use super::Unsolvable;
use super::attitude::{Vector, add_scaled, cross, dot, scaled};

/// A charge and its fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Charge {
    /// Mass.
    pub mass: f64,
    /// Charge.
    pub charge: f64,
    /// B.
    pub magnetic: Vector,
    /// E.
    pub electric: Vector,
}

/// A moving charge.
#[derive(Clone, Copy, Debug)]
pub struct ChargedParticle {
    x: Vector,
    /// Velocity on the outgoing edge.
    v: Vector,
    /// q h B/2m.
    t: Vector,
    /// 2/(1 + t.t).
    factor: f64,
    /// q h E/2m.
    kick: Vector,
    charge: Charge,
    h: f64,
}

impl ChargedParticle {
    /// Starts a trajectory with the momentum m V + (q/2) B x X of node 0.
    ///
    /// # Errors
    /// [`Unsolvable`] if a value is not finite.
    pub fn start(
        charge: &Charge,
        place: &Vector,
        momentum: &Vector,
        h: f64,
    ) -> Result<ChargedParticle, Unsolvable> {
        let share = 0.5 * charge.charge * h / charge.mass;
        let (t, kick) = (
            scaled(share, &charge.magnetic),
            scaled(share, &charge.electric),
        );
        let turned = cross(&charge.magnetic, place);
        let kinetic = add_scaled(momentum, -0.5 * charge.charge, &turned);
        let at_node = scaled(1.0 / charge.mass, &kinetic);
        // Half of a rotation separates the node from the edge: v + t x v = at_node + kick.
        let u = add_scaled(&at_node, 1.0, &kick);
        let along = add_scaled(&u, dot(&t, &u), &t);
        let factor = 2.0 / (1.0 + dot(&t, &t));
        let v = scaled(0.5 * factor, &add_scaled(&along, -1.0, &cross(&t, &u)));
        let start = ChargedParticle {
            x: *place,
            v,
            t,
            factor,
            kick,
            charge: *charge,
            h,
        };
        match v.iter().chain(place).all(|x| x.is_finite()) {
            true => Ok(start),
            false => Err(Unsolvable),
        }
    }

    /// Steps once.
    ///
    /// # Errors
    /// [`Unsolvable`] if the position is not finite.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let x = add_scaled(&self.x, self.h, &self.v);
        if !(x[0] + x[1] + x[2]).is_finite() {
            return Err(Unsolvable);
        }
        let minus = add_scaled(&self.v, 1.0, &self.kick);
        let prime = add_scaled(&minus, 1.0, &cross(&minus, &self.t));
        let plus = add_scaled(&minus, self.factor, &cross(&prime, &self.t));
        self.v = add_scaled(&plus, 1.0, &self.kick);
        self.x = x;
        Ok(())
    }

    /// Position at the current node.
    pub fn place(&self) -> Vector {
        self.x
    }

    /// Velocity at the current node, half a rotation and half a kick before the velocity of the outgoing edge.
    pub fn velocity(&self) -> Vector {
        let turned = add_scaled(&self.v, 1.0, &cross(&self.t, &self.v));
        add_scaled(&turned, -1.0, &self.kick)
    }

    /// The momentum m V + (q/2) B x X at the current node.
    pub fn momentum(&self) -> Vector {
        let Charge {
            mass,
            charge,
            magnetic,
            ..
        } = &self.charge;
        let turned = cross(magnetic, &self.x);
        add_scaled(&scaled(*mass, &self.velocity()), 0.5 * charge, &turned)
    }

    /// Kinetic and electric energy: constant.
    pub fn energy(&self) -> f64 {
        let v = self.velocity();
        0.5 * self.charge.mass * dot(&v, &v)
            - self.charge.charge * dot(&self.charge.electric, &self.x)
    }
}
