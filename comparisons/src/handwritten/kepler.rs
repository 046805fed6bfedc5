//! A planet about a fixed sun by Störmer-Verlet: half a kick, a drift, half a kick, with one force evaluation per step. Takes mass,
//! gravitational parameter, position, momentum and h; gives positions and momenta at the nodes.

use super::Unsolvable;
use super::attitude::{Vector, add_scaled, dot, scaled};

/// A moving planet.
#[derive(Clone, Copy, Debug)]
pub struct Kepler {
    x: Vector,
    v: Vector,
    /// Acceleration at the current position, which the next step uses first.
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
    /// [`Unsolvable`] at the sun, and for zero mass.
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

    /// Steps once; the state is unchanged if the planet would meet the sun.
    ///
    /// # Errors
    /// [`Unsolvable`] in that case.
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

    /// Position at the current node.
    pub fn place(&self) -> Vector {
        self.x
    }

    /// Momentum at the current node.
    pub fn momentum(&self) -> Vector {
        scaled(self.m, &self.v)
    }

    /// Kinetic minus gravitational energy; oscillates within O(h^2).
    pub fn energy(&self) -> f64 {
        self.m * (0.5 * dot(&self.v, &self.v) - self.k / dot(&self.x, &self.x).sqrt())
    }
}
