//! Pseudospectral solver for regularised shallow water: `h_t + div(h u) = 0`, `u_t + (ζ + f) k x u = -grad(c0² S h + |u|²/2)`,
//! where S is the inverse of a Helmholtz operator, in a periodic box or a channel. A channel is half of a periodic box in which
//! depth is even about the walls and the normal velocity odd. Products are dealiased: two thirds of the components are kept, and
//! initial data are truncated. Time steps use the classical Runge-Kutta method.

use super::fourier::{Complex, Fourier};
use core::f64::consts::TAU;

/// The smoothing of the depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Smoothing {
    /// `1 / ((1 + α²k²)(1 + α²l²))`.
    Split,
    /// `1 / (1 + α²(k² + l²))`.
    Isotropic,
    /// `1 / (1 + α²(k² + l²))²`.
    Twice,
}

/// Depth and velocity at the grid nodes, including mirrored ones.
#[derive(Clone, Debug, PartialEq)]
pub struct Fields {
    /// Depth.
    pub h: Vec<f64>,
    /// Velocity along the first direction.
    pub u: Vec<f64>,
    /// Velocity along the second.
    pub v: Vec<f64>,
}

/// The equations on a grid.
#[derive(Clone, Debug)]
pub struct Spectral {
    /// Square of the wave speed of unit depth.
    pub speed_squared: f64,
    /// The Coriolis parameter, twice the rotation rate.
    pub coriolis: f64,
    /// Lengths of the periodic box.
    lengths: [f64; 2],
    nodes: [usize; 2],
    walls: bool,
    fourier: Fourier,
    /// Wave numbers of each component; zero for components that products drop.
    waves: Vec<[f64; 2]>,
    /// Whether a component is kept.
    kept: Vec<bool>,
    smoothing: Vec<f64>,
}

impl Spectral {
    /// Water in a box of these lengths, with or without walls across the first direction, on this number of intervals. The depth is
    /// smoothed over the length `alpha`. `None` if a number of intervals is not a power of two.
    pub fn new(
        lengths: [f64; 2],
        walls: bool,
        intervals: [usize; 2],
        (alpha, smoothing): (f64, Smoothing),
        speed_squared: f64,
        coriolis: f64,
    ) -> Option<Self> {
        let factor = if walls { 2 } else { 1 };
        let nodes = [factor * intervals[0], intervals[1]];
        let lengths = [factor as f64 * lengths[0], lengths[1]];
        let fourier = Fourier::new(nodes)?;
        let along = |d: usize| fourier.waves(d).map(move |k| (k, TAU * k / lengths[d]));
        let (mut waves, mut kept, mut factors) = (vec![], vec![], vec![]);
        for (k, one) in along(0) {
            for (l, other) in along(1) {
                let keep = 3.0 * k.abs() <= nodes[0] as f64 && 3.0 * l.abs() <= nodes[1] as f64;
                kept.push(keep);
                waves.push([one, other]);
                let [a, b] = [one, other].map(|k| (alpha * k).powi(2));
                factors.push(match smoothing {
                    Smoothing::Split => 1.0 / ((1.0 + a) * (1.0 + b)),
                    Smoothing::Isotropic => 1.0 / (1.0 + a + b),
                    Smoothing::Twice => (1.0 + a + b).powi(-2),
                });
            }
        }
        Some(Self {
            speed_squared,
            coriolis,
            lengths,
            nodes,
            walls,
            fourier,
            waves,
            kept,
            smoothing: factors,
        })
    }

    /// The fields with depth and velocity `[h, u, v]` as a function of the position.
    pub fn fields(&self, at: impl Fn([f64; 2]) -> [f64; 3]) -> Fields {
        let count = self.nodes[0] * self.nodes[1];
        let value = |node: usize| {
            let index = [node / self.nodes[1], node % self.nodes[1]];
            let place = |d: usize| self.lengths[d] * index[d] as f64 / self.nodes[d] as f64;
            let (x, y) = (place(0), place(1));
            let mirrored = self.walls && 2 * index[0] > self.nodes[0];
            let [h, u, v] = at([if mirrored { self.lengths[0] - x } else { x }, y]);
            [h, if mirrored { -u } else { u }, v]
        };
        let part = |c: usize| (0..count).map(|node| value(node)[c]).collect();
        Fields {
            h: part(0),
            u: part(1),
            v: part(2),
        }
    }

    fn components(&mut self, values: impl Iterator<Item = f64>) -> Vec<Complex> {
        let mut all: Vec<Complex> = values.map(|x| [x, 0.0]).collect();
        self.fourier.forwards(&mut all);
        all
    }

    /// Two real fields from the components of both, in one transform.
    fn both(&mut self, a: impl Fn(usize) -> Complex, b: impl Fn(usize) -> Complex) -> Vec<Complex> {
        let all = (0..self.waves.len()).map(|k| {
            let ([a, c], [b, d]) = (a(k), b(k));
            [a - d, c + b]
        });
        let mut all: Vec<Complex> = all.collect();
        self.fourier.backwards(&mut all);
        all
    }

    /// Drops the dealiased components, as required for initial data that are not smooth.
    pub fn truncate(&mut self, fields: &mut Fields) {
        let kept = self.kept.clone();
        for values in [&mut fields.h, &mut fields.u, &mut fields.v] {
            let all = self.components(values.iter().copied());
            let of = |k: usize| if kept[k] { all[k] } else { [0.0; 2] };
            let part = self.both(of, |_| [0.0; 2]);
            values.iter_mut().zip(part).for_each(|(x, p)| *x = p[0]);
        }
    }

    /// The largest frequency of small-amplitude waves on unit depth at rest: `sqrt(f² + c² |k|² S)`.
    pub fn fastest_wave(&self) -> f64 {
        let all = self.waves.iter().zip(&self.smoothing).zip(&self.kept);
        let square = |((k, s), kept): ((&[f64; 2], &f64), &bool)| match kept {
            true => self.speed_squared * (k[0] * k[0] + k[1] * k[1]) * s,
            false => 0.0,
        };
        let largest = all.map(square).max_by(f64::total_cmp).unwrap_or(0.0);
        (self.coriolis * self.coriolis + largest).sqrt()
    }

    /// The smoothed depth at the nodes of the box, including both walls; the second direction is contiguous.
    pub fn smoothed(&mut self, fields: &Fields) -> Vec<f64> {
        let h = self.components(fields.h.iter().copied());
        let smoothing = self.smoothing.clone();
        let all = self.both(|k| h[k].map(|x| x * smoothing[k]), |_| [0.0; 2]);
        let rows = match self.walls {
            true => self.nodes[0] / 2 + 1,
            false => self.nodes[0],
        };
        all.iter()
            .map(|x| x[0])
            .take(rows * self.nodes[1])
            .collect()
    }

    /// Kinetic and potential energy of the periodic box, which is twice that of a channel.
    pub fn energy(&mut self, fields: &Fields) -> [f64; 2] {
        let h = self.components(fields.h.iter().copied());
        let smoothing = self.smoothing.clone();
        let smoothed = self.both(|k| h[k].map(|x| x * smoothing[k]), |_| [0.0; 2]);
        let area = self.lengths[0] * self.lengths[1] / self.waves.len() as f64;
        let (mut kinetic, mut potential) = (0.0, 0.0);
        for (i, s) in smoothed.iter().enumerate() {
            let (h, u, v) = (fields.h[i], fields.u[i], fields.v[i]);
            kinetic += h * (u * u + v * v) / 2.0 * area;
            potential += self.speed_squared / 2.0 * h * s[0] * area;
        }
        [kinetic, potential]
    }

    /// The rates of change of the fields.
    fn rates(&mut self, of: &Fields) -> Fields {
        let all = || of.h.iter().zip(&of.u).zip(&of.v);
        let h = self.components(of.h.iter().copied());
        let [u, v] = [&of.u, &of.v].map(|x| self.components(x.iter().copied()));
        let kinetic = self.components(all().map(|((_, u), v)| (u * u + v * v) / 2.0));
        let flux = self.components(all().map(|((h, u), _)| h * u));
        let across = self.components(all().map(|((h, _), v)| h * v));
        let (waves, kept) = (self.waves.clone(), self.kept.clone());
        let (smoothing, speed) = (self.smoothing.clone(), self.speed_squared);
        // The derivative along a direction: i k times the component.
        let slope = |values: &[Complex], k: usize, d: usize| {
            let [a, b] = values[k];
            [-waves[k][d] * b, waves[k][d] * a]
        };
        let filtered = |k: usize, x: Complex| if kept[k] { x } else { [0.0; 2] };
        let head: Vec<Complex> = (0..h.len())
            .map(|k| [0, 1].map(|c| speed * smoothing[k] * h[k][c] + kinetic[k][c]))
            .collect();
        let rest = self.both(
            |k| {
                let (a, b) = (slope(&flux, k, 0), slope(&across, k, 1));
                filtered(k, [-a[0] - b[0], -a[1] - b[1]])
            },
            |k| {
                let (a, b) = (slope(&v, k, 0), slope(&u, k, 1));
                filtered(k, [a[0] - b[0], a[1] - b[1]])
            },
        );
        // Products with the vorticity also produce components that are dropped.
        let coriolis = self.coriolis;
        let turning = |i: usize| rest[i][1] + coriolis;
        let turned = [&of.v, &of.u].map(|x| {
            let each = x.iter().enumerate().map(|(i, x)| turning(i) * x);
            self.components(each)
        });
        let all = self.both(
            |k| {
                let (a, b) = (turned[0][k], slope(&head, k, 0));
                filtered(k, [a[0] - b[0], a[1] - b[1]])
            },
            |k| {
                let (a, b) = (turned[1][k], slope(&head, k, 1));
                filtered(k, [-a[0] - b[0], -a[1] - b[1]])
            },
        );
        Fields {
            h: rest.iter().map(|x| x[0]).collect(),
            u: all.iter().map(|x| x[0]).collect(),
            v: all.iter().map(|x| x[1]).collect(),
        }
    }

    /// Steps once with the classical Runge-Kutta method.
    pub fn step(&mut self, fields: &mut Fields, dt: f64) {
        let start = fields.clone();
        let mut stage = fields.clone();
        for (ahead, share) in [(0.5, 1.0), (0.5, 2.0), (1.0, 2.0), (0.0, 1.0)] {
            let rates = self.rates(&stage);
            let parts = [
                (&mut fields.h, &mut stage.h, &start.h, rates.h),
                (&mut fields.u, &mut stage.u, &start.u, rates.u),
                (&mut fields.v, &mut stage.v, &start.v, rates.v),
            ];
            for (sum, stage, start, rate) in parts {
                for i in 0..rate.len() {
                    sum[i] += dt * share / 6.0 * rate[i];
                    stage[i] = start[i] + dt * ahead * rate[i];
                }
            }
        }
    }
}
