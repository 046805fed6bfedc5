//! A planet about a fixed sun by Störmer and Verlet: half a kick, a drift, half a kick, one force a step.
//! Takes mass, gravitational parameter, place, momentum and h; gives places and momenta at the nodes.

use super::Unsolvable;
use super::attitude::{Vector, add_scaled, dot, scaled};

/// A planet on its way.
#[derive(Clone, Copy, Debug)]
pub struct Kepler {
    x: Vector,
    v: Vector,
    /// Of the present place: the next step begins with it.
    acceleration: Vector,
    m: f64,
    k: f64,
    h: f64,
}

/// The acceleration -k x/|x|^3.
#[inline(always)]
fn acceleration(k: f64, x: &Vector) -> Vector {
    let square = dot(x, x);
    scaled(-k / (square * square.sqrt()), x)
}

impl Kepler {
    /// Starts a trajectory with the momentum of node 0.
    ///
    /// # Errors
    /// [`Unsolvable`] at the sun, and without mass.
    pub fn start(
        m: f64,
        k: f64,
        place: &Vector,
        momentum: &Vector,
        h: f64,
    ) -> Result<Kepler, Unsolvable> {
        let start = Kepler {
            x: *place,
            v: scaled(1.0 / m, momentum),
            acceleration: acceleration(k, place),
            m,
            k,
            h,
        };
        let known = start.v.iter().chain(&start.acceleration);
        match known.fold(0.0, |sum, x| sum + x).is_finite() {
            true => Ok(start),
            false => Err(Unsolvable),
        }
    }

    /// One step of the motion; unchanged when it would meet the sun.
    ///
    /// # Errors
    /// [`Unsolvable`] then.
    #[inline(always)]
    pub fn step(&mut self) -> Result<(), Unsolvable> {
        let half = 0.5 * self.h;
        let v = add_scaled(&self.v, half, &self.acceleration);
        let x = add_scaled(&self.x, self.h, &v);
        let square = dot(&x, &x);
        if !(square > 0.0 && square.is_finite()) {
            return Err(Unsolvable);
        }
        let acceleration = acceleration(self.k, &x);
        self.v = add_scaled(&v, half, &acceleration);
        self.x = x;
        self.acceleration = acceleration;
        Ok(())
    }

    /// Place at the present node.
    pub fn place(&self) -> Vector {
        self.x
    }

    /// Momentum at the present node.
    pub fn momentum(&self) -> Vector {
        scaled(self.m, &self.v)
    }

    /// Kinetic less gravitational energy: oscillates within O(h^2).
    pub fn energy(&self) -> f64 {
        self.m * (0.5 * dot(&self.v, &self.v) - self.k / dot(&self.x, &self.x).sqrt())
    }
}
