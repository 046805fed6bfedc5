//! Particle-mesh shallow water with a hand-written step (Störmer-Verlet; with rotation, the exact magnetic flow between kicks):
//! energy over many steps, mass, walls.

use super::common::*;
use super::smoothers::naive;
use clebsch::ParameterError;
use clebsch::mesh::*;
use clebsch::nalgebra::SVector;
use core::f64::consts::PI;

/// A run of particles on a grid.
pub struct Run<F, S, const D: usize> {
    deposit: F,
    smooth: S,
    weights: Vec<f64>,
    mass: Vec<f64>,
    depth: Vec<f64>,
    smoothed: Vec<f64>,
    /// Square of the wave speed.
    speed: f64,
    crossings: usize,
    domain: Domain<D>,
    cell: [f64; D],
}

impl<const D: usize, A, F, S> Run<F, S, D>
where
    A: Field<f64, D>,
    F: for<'a> Functional<f64, D, Argument = A, Data<'a> = (&'a [f64],)>,
    S: for<'a> Functional<f64, D, Argument = f64, Data<'a> = (f64,)>,
{
    pub fn new(of: &Setting<D>, alpha: f64, mass: Vec<f64>, speed: f64) -> Self {
        let weights = Nodes::new(of).expect("a grid").weights::<f64>();
        let grid = of.grid.expect("a grid");
        Self {
            deposit: F::new(of, (&mass,)).expect("a grid"),
            smooth: S::new(of, (alpha,)).expect("a grid"),
            depth: vec![0.0; weights.len()],
            smoothed: vec![0.0; weights.len()],
            weights,
            mass,
            speed,
            crossings: 0,
            domain: of.domain,
            cell: core::array::from_fn(|d| of.domain.lengths[d] / grid[d] as f64),
        }
    }

    pub fn potential(&mut self, x: &[A]) -> f64 {
        self.deposit.value(x, &mut self.depth).expect("inside");
        self.smooth
            .value(&self.depth, &mut self.smoothed)
            .expect("solved");
        let all = self.weights.iter().zip(&self.depth).zip(&self.smoothed);
        self.speed / 2.0 * sum(all.map(|((w, h), s)| w * h * s))
    }

    /// Derivatives of the potential at the positions of its last evaluation; the smoother is self-adjoint.
    pub fn slopes(&mut self, x: &[A], out: &mut [A]) {
        let all = self.weights.iter().zip(&self.smoothed);
        let seed: Vec<f64> = all.map(|(w, s)| self.speed * w * s).collect();
        self.deposit.pull_back(x, &seed, out).expect("inside");
    }

    /// Half a kick, the flow without potential, half a kick, reflection; `slopes` are the values at `x`, before and after.
    pub fn step(
        &mut self,
        x: &mut [A],
        u: &mut [A],
        slopes: &mut [A],
        dt: f64,
        flow: impl Fn(A, A) -> (A, A),
    ) {
        self.kick(u, slopes, dt / 2.0);
        for (site, (x, u)) in x.iter_mut().zip(u.iter_mut()).enumerate() {
            (*x, *u) = flow(*x, *u);
            let (mut place, mut velocity) = (x.parts(), u.parts());
            let crossed = self
                .domain
                .reflect(site, &self.cell, &mut place, &mut velocity);
            self.crossings += crossed.expect("near");
            (*x, *u) = (A::of(place), A::of(velocity));
        }
        self.potential(x);
        self.slopes(x, slopes);
        self.kick(u, slopes, dt / 2.0);
    }

    fn kick(&self, u: &mut [A], slopes: &[A], dt: f64) {
        for ((u, slope), m) in u.iter_mut().zip(slopes).zip(&self.mass) {
            let (mut velocity, slope) = (u.parts(), slope.parts());
            velocity
                .iter_mut()
                .zip(slope)
                .for_each(|(u, s)| *u -= dt * s / m);
            *u = A::of(velocity);
        }
    }

    /// The smoothed depth at the positions of the last evaluation.
    pub fn smoothed(&self) -> &[f64] {
        &self.smoothed
    }

    /// The energy at the positions of the last evaluation.
    pub fn energy(&self, u: &[A]) -> f64 {
        let all = self.weights.iter().zip(&self.depth).zip(&self.smoothed);
        self.kinetic(u) + self.speed / 2.0 * sum(all.map(|((w, h), s)| w * h * s))
    }

    pub fn kinetic(&self, u: &[A]) -> f64 {
        let all = self.mass.iter().zip(u);
        sum(all.map(|(m, u)| m / 2.0 * u.parts().iter().map(|u| u * u).sum::<f64>()))
    }

    /// Relative error of the mass on the grid.
    fn mass_error(&self) -> f64 {
        let grid = sum(self.weights.iter().zip(&self.depth).map(|(w, h)| w * h));
        grid / sum(self.mass.iter().copied()) - 1.0
    }
}

/// The largest relative energy error, and the number of reflections at walls. The initial depth is a Gaussian on unit depth, of 256
/// particles at rest in a basin of length 2π with 63 intervals; the wave speed is 1 and the step size 5e-3.
fn along_a_line<S>(amplitude: f64, steps: usize) -> (f64, usize)
where
    S: for<'a> Functional<f64, 1, Argument = f64, Data<'a> = (f64,)>,
{
    let (length, count, cells, dt) = (2.0 * PI, 256, 63, 5e-3);
    let of = setting(Domain::basin([length]), [cells], count);
    let place = |a: usize| (a as f64 + 0.5) * length / count as f64;
    let mut x: Vec<f64> = (0..count).map(place).collect();
    let depth = |x: &f64| 1.0 + amplitude * (-50.0 * (x / length - 0.5).powi(2)).exp();
    let mass = x.iter().map(|x| depth(x) * length / count as f64);
    let alpha = 2.0 * length / cells as f64;
    let mut run = Run::<deposit<f64, 1>, S, 1>::new(&of, alpha, mass.collect(), 1.0);
    let (mut u, mut slopes) = (vec![0.0; count], vec![0.0; count]);
    let start = run.potential(&x);
    run.slopes(&x, &mut slopes);
    let (mut worst, mut mass_error) = (0.0_f64, 0.0_f64);
    for _ in 0..steps {
        run.step(&mut x, &mut u, &mut slopes, dt, |x, u| (x + dt * u, u));
        worst = largest([worst, run.energy(&u) / start - 1.0]);
        mass_error = largest([mass_error, run.mass_error()]);
    }
    // Each of 64 nodes sums about twenty values, with rounding errors of random sign.
    assert!(mass_error < 2e-15, "{mass_error:e}");
    (worst, run.crossings)
}

#[test]
fn energy_along_a_line_stays_within_the_bound_of_its_amplitude() {
    // The error scales with the square of the amplitude. Over 3e5 steps it is 1.0e-10, 1.3e-8 and 4.9e-8: no drift.
    for (amplitude, expected) in [(0.01, 1.0e-10), (0.1, 1.2e-8), (0.2, 5.0e-8)] {
        let (worst, crossings) = along_a_line::<smooth<f64, 1>>(amplitude, 10_000);
        assert_eq!(crossings, 0);
        assert!(
            worst < 1.1 * expected && worst > 0.5 * expected,
            "{worst:e}"
        );
    }
}

/// The inverse of a symmetric second-difference matrix between walls, which a stepper would treat as self-adjoint in the weights.
#[derive(Clone, Debug)]
struct Naive(f64);

impl Functional<f64, 1> for Naive {
    type Argument = f64;
    type Data<'a> = (f64,);

    fn new(of: &Setting<1>, (alpha,): (f64,)) -> Result<Self, ParameterError> {
        let spacing = Nodes::new(of)?.axes()[0].spacing();
        Ok(Self((alpha / spacing).powi(2)))
    }

    fn sites(&self) -> usize {
        64
    }

    fn value(&mut self, at: &[f64], out: &mut [f64]) -> Result<(), MeshError> {
        out.copy_from_slice(&naive(at, self.0));
        Ok(())
    }

    fn pull_back(&mut self, _: &[f64], seed: &[f64], out: &mut [f64]) -> Result<(), MeshError> {
        out.copy_from_slice(&naive(seed, self.0));
        Ok(())
    }
}

#[test]
fn a_smoother_that_is_not_its_own_adjoint_does_not_keep_the_energy() {
    let (exact, _) = along_a_line::<smooth<f64, 1>>(0.1, 10_000);
    let (wrong, _) = along_a_line::<Naive>(0.1, 10_000);
    assert!(wrong > 1e4 * exact, "{wrong:e} {exact:e}");
}

/// Rotating shallow water in a channel, a pair of vortices in geostrophic balance.
#[test]
fn energy_in_a_rotating_channel_falls_with_the_square_of_the_step() {
    type Plane = Run<deposit<f64, 2>, smooth<f64, 2>, 2>;
    let (length, side, cells, f) = (2.0 * PI, 64, [31, 32], 2.0 * PI);
    let of = setting(Domain::channel([length; 2]), cells, side * side);
    let cell = length / side as f64;
    let at = |a: usize| [(a / side) as f64 + 0.5, (a % side) as f64 + 0.5].map(|i| i * cell);
    let speed = 4.0 * PI * PI;
    let bump = |x: [f64; 2], sign: f64| {
        let along = [x[0] - length / 2.0 - sign, x[1] - length / 2.0];
        let value = 0.1 * sign * (-(along[0].powi(2) + along[1].powi(2)) / 0.5).exp();
        (value, along.map(|d| -4.0 * d * value))
    };
    let mut errors = vec![];
    for dt in [0.01, 0.005] {
        let places: Vec<_> = (0..side * side).map(at).collect();
        let mass = |x: &[f64; 2]| (1.0 + bump(*x, 1.0).0 + bump(*x, -1.0).0) * cell * cell;
        let mut run = Plane::new(
            &of,
            2.0 * length / 31.0,
            places.iter().map(mass).collect(),
            speed,
        );
        let slope = |x: &[f64; 2], d: usize| bump(*x, 1.0).1[d] + bump(*x, -1.0).1[d];
        let mut u: Vec<_> = places
            .iter()
            .map(|x| SVector::<f64, 2>::new(-slope(x, 1), slope(x, 0)) * (speed / f))
            .collect();
        let mut x: Vec<SVector<f64, 2>> = places.iter().map(|x| SVector::from(*x)).collect();
        let (sin, cos) = (f * dt).sin_cos();
        let turn = |u: SVector<f64, 2>| {
            SVector::<f64, 2>::new(cos * u[0] + sin * u[1], cos * u[1] - sin * u[0])
        };
        let moved = |u: SVector<f64, 2>| {
            let versine = 1.0 - cos;
            SVector::<f64, 2>::new(u[0] * sin + u[1] * versine, u[1] * sin - u[0] * versine) / f
        };
        let mut slopes = vec![SVector::zeros(); x.len()];
        let kinetic = run.kinetic(&u);
        let start = run.potential(&x) + kinetic;
        run.slopes(&x, &mut slopes);
        let (mut worst, mut mass_error) = (0.0_f64, 0.0_f64);
        for _ in 0..(1.0 / dt) as usize {
            run.step(&mut x, &mut u, &mut slopes, dt, |x, u| {
                (x + moved(u), turn(u))
            });
            worst = largest([worst, run.energy(&u) / start - 1.0]);
            mass_error = largest([mass_error, run.mass_error()]);
        }
        assert!(mass_error < 1e-14);
        errors.push(worst);
    }
    let order = (errors[0] / errors[1]).log2();
    assert!((1.8..2.3).contains(&order), "{errors:?}");
    assert!(errors[1] < 1e-7, "{errors:?}");
}
