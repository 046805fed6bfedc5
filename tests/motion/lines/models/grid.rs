//! Particle-mesh shallow water. Here the grid depth is a sum of B-splines over particles and their images; the smoother is a dense
//! system between walls and a sum of Fourier modes in periodic directions. The runtime shares none of this code.

use super::dense::solved;
use super::{Line, Random, c, keeping, numbers, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch::mesh::{Domain, Wall};
use clebsch::nalgebra::{SMatrix, Vector2};
use clebsch_models::fluids::particle_mesh_1d::*;
use clebsch_models::fluids::particle_mesh_2d::*;

/// The cubic B-spline of unit spacing centred at 0; its integer translates sum to one.
fn spline(x: D) -> D {
    let x = if x.value() < 0.0 { -x } else { x };
    match x.value() {
        v if v < 1.0 => c(2.0 / 3.0) - x * x + x * x * x * c(0.5),
        v if v < 2.0 => {
            let y = c(2.0) - x;
            y * y * y * c(1.0 / 6.0)
        }
        _ => c(0.0),
    }
}

/// One direction: its length, its number of cells, and whether it ends in walls.
#[derive(Clone, Copy)]
struct Axis {
    length: f64,
    cells: usize,
    walls: bool,
}

impl Axis {
    fn nodes(self) -> usize {
        self.cells + usize::from(self.walls)
    }
    fn spacing(self) -> f64 {
        self.length / self.cells as f64
    }
    /// The weight of a node in the trapezoidal rule.
    fn weight(self, i: usize) -> f64 {
        let end = self.walls && (i == 0 || i == self.cells);
        self.spacing() * if end { 0.5 } else { 1.0 }
    }
    /// The contribution of a particle to a node, including images behind walls or periodic images.
    fn basis(self, x: D, i: usize) -> D {
        let n = self.cells as f64;
        let u = x * c(1.0 / self.spacing());
        let at = |u: D| spline(u - c(i as f64));
        let mut sum = c(0.0);
        for turn in -3..=3 {
            let turn = f64::from(turn);
            match self.walls {
                true => sum += at(u + c(2.0 * n * turn)) + at(c(2.0 * n * turn) - u),
                false => sum += at(u + c(n * turn)),
            }
        }
        sum
    }
    /// The smoother of this direction as a matrix.
    fn smoother(self, alpha: f64) -> Vec<Vec<f64>> {
        let (n, dx) = (self.nodes(), self.spacing());
        let mut out = vec![vec![0.0; n]; n];
        if !self.walls {
            for (i, row) in out.iter_mut().enumerate() {
                for (j, entry) in row.iter_mut().enumerate() {
                    for mode in 0..n {
                        let wave = if 2 * mode > n { n - mode } else { mode } as f64;
                        let k = std::f64::consts::TAU * wave / self.length;
                        let phase =
                            std::f64::consts::TAU * mode as f64 * (i as f64 - j as f64) / n as f64;
                        *entry += phase.cos() / (1.0 + alpha * alpha * k * k) / n as f64;
                    }
                }
            }
            return out;
        }
        let mut mass = vec![vec![0.0; n]; n];
        let mut all = vec![vec![0.0; n]; n];
        for e in 0..self.cells {
            for (i, j, m, k) in [
                (e, e, 2.0, 1.0),
                (e, e + 1, 1.0, -1.0),
                (e + 1, e, 1.0, -1.0),
                (e + 1, e + 1, 2.0, 1.0),
            ] {
                mass[i][j] += dx / 6.0 * m;
                all[i][j] += dx / 6.0 * m + alpha * alpha / dx * k;
            }
        }
        for j in 0..n {
            let a = all
                .iter()
                .map(|r| r.iter().map(|x| c(*x)).collect())
                .collect();
            let column = solved(a, (0..n).map(|i| c(mass[i][j])).collect());
            for (row, x) in out.iter_mut().zip(column) {
                row[j] = x.value();
            }
        }
        out
    }
}

/// `sum w H S / 2` times the square of the wave speed.
fn potential(axes: &[Axis], places: &[Vec<D>], m: &[f64], c0: f64, alpha: f64) -> D {
    let nodes: usize = axes.iter().map(|a| a.nodes()).product();
    let index = |node: usize| -> Vec<usize> {
        match axes {
            [_] => vec![node],
            [_, y] => vec![node / y.nodes(), node % y.nodes()],
            _ => Vec::new(),
        }
    };
    let volume: f64 = axes.iter().map(|a| a.spacing()).product();
    let depth: Vec<D> = (0..nodes)
        .map(|node| {
            let at = index(node);
            let each = places.iter().zip(m).map(|(x, m)| {
                let along = axes.iter().zip(&at).zip(x);
                along.fold(c(m / volume), |p, ((a, i), x)| p * a.basis(*x, *i))
            });
            each.fold(c(0.0), |s, x| s + x)
        })
        .collect();
    let mut smooth = depth.clone();
    for (d, axis) in axes.iter().enumerate() {
        let matrix = axis.smoother(alpha);
        let before = smooth.clone();
        for (node, out) in smooth.iter_mut().enumerate() {
            let own = index(node);
            *out = c(0.0);
            for (other, value) in before.iter().enumerate() {
                let theirs = index(other);
                let beside = own.iter().zip(&theirs).enumerate();
                if beside.into_iter().all(|(e, (i, j))| e == d || i == j) {
                    *out += *value * c(matrix[own[d]][theirs[d]]);
                }
            }
        }
    }
    let mut sum = c(0.0);
    for (node, (h, s)) in depth.iter().zip(&smooth).enumerate() {
        let w: f64 = axes
            .iter()
            .zip(index(node))
            .map(|(a, i)| a.weight(i))
            .product();
        sum += *h * *s * c(w);
    }
    sum * c(c0 * c0 / 2.0)
}

/// Particles on an interval between walls.
pub struct Basin {
    pub n: usize,
}

/// Particles in a rotating plane, with or without walls across the first direction.
pub struct Plane {
    pub n: usize,
    pub walls: bool,
}

const C0: f64 = 0.8;
const F: f64 = 0.9;
const DT: f64 = 0.02;
const LINE: Axis = Axis {
    length: 1.2,
    cells: 7,
    walls: true,
};

fn mass(n: usize, i: usize) -> f64 {
    (1.0 + 0.2 * (i % 3) as f64) / n as f64
}

impl Basin {
    pub fn stepper(&self) -> ParticleMesh1D {
        let parameters = ParticleMesh1DParameters {
            m: (0..self.n).map(|i| mass(self.n, i)).collect(),
            w: (0..LINE.nodes()).map(|i| LINE.weight(i)).collect(),
            c0: C0,
            alpha: 0.25,
        };
        let sites = ParticleMesh1DSites {
            N: self.n,
            n: [LINE.cells],
            domain: Domain::basin([LINE.length]),
            scalar: Default::default(),
        };
        ParticleMesh1D::new(parameters, sites).expect("a basin")
    }
    pub fn initial(&self, seed: u64) -> ParticleMesh1DInitial {
        let mut r = Random::new(seed + 5);
        ParticleMesh1DInitial {
            X: (0..self.n)
                .map(|_| SMatrix::repeat(0.6 + 0.5 * r.number()))
                .collect(),
            momentum_X: (0..self.n)
                .map(|i| SMatrix::repeat(0.3 * mass(self.n, i) * r.number()))
                .collect(),
        }
    }
    fn seen(&self, s: &ParticleMesh1DState) -> Configuration<f64> {
        let x = numbers(s.X());
        Configuration {
            x,
            r: Vec::new(),
            q: Vec::new(),
        }
    }
    // The grid breaks translation invariance, so no momentum is conserved.
    keeping!(ParticleMesh1D, |_, _: &ParticleMesh1DState| 0.0);
}

impl Line for Basin {
    fn name(&self) -> String {
        format!("basin {}", self.n)
    }
    fn terms(&self) -> usize {
        2
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let m: Vec<f64> = (0..self.n).map(|i| mass(self.n, i)).collect();
        let mut s = c(0.0);
        for (i, m) in m.iter().enumerate() {
            let d = b.x[i] - a.x[i];
            s += c(w[0] * m / (2.0 * DT)) * d * d;
        }
        for q in [&a.x, &b.x] {
            let places: Vec<Vec<D>> = q.iter().map(|x| vec![*x]).collect();
            s -= c(w[1] * 0.5 * DT) * potential(&[LINE], &places, &m, C0, 0.25);
        }
        s
    }
    stepped!([momentum_X], DT, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.4 / self.n as f64 / DT
    }
}

impl Plane {
    fn axes(&self) -> [Axis; 2] {
        let (x, y) = (1.1, 0.9);
        [
            Axis {
                length: x,
                cells: 5,
                walls: self.walls,
            },
            Axis {
                length: y,
                cells: 4,
                walls: false,
            },
        ]
    }
    pub fn stepper(&self) -> ParticleMesh2D {
        let [x, y] = self.axes();
        let weights =
            (0..x.nodes()).flat_map(|i| (0..y.nodes()).map(move |j| x.weight(i) * y.weight(j)));
        let parameters = ParticleMesh2DParameters {
            m: (0..self.n).map(|i| mass(self.n, i)).collect(),
            w: weights.collect(),
            c0: C0,
            f: F,
            alpha: 0.3,
        };
        let lengths = [x.length, y.length];
        let domain = match self.walls {
            true => Domain::channel(lengths),
            false => Domain::torus(lengths),
        };
        assert_eq!(domain.walls[0] == Wall::Solid, self.walls);
        let sites = ParticleMesh2DSites {
            N: self.n,
            n: [x.cells, y.cells],
            domain,
            scalar: Default::default(),
        };
        ParticleMesh2D::new(parameters, sites).expect("a plane")
    }
    pub fn initial(&self, seed: u64) -> ParticleMesh2DInitial {
        let mut r = Random::new(seed + 5);
        ParticleMesh2DInitial {
            X: (0..self.n)
                .map(|_| Vector2::new(0.55 + 0.5 * r.number(), 0.45 + 0.44 * r.number()))
                .collect(),
            momentum_X: (0..self.n)
                .map(|i| Vector2::new(r.number(), r.number()) * (0.3 * mass(self.n, i)))
                .collect(),
        }
    }
    fn seen(&self, s: &ParticleMesh2DState) -> Configuration<f64> {
        Configuration::of(numbers(s.X()), vec![], vec![])
    }
    keeping!(ParticleMesh2D, |_, _: &ParticleMesh2DState| 0.0);
}

impl Line for Plane {
    fn name(&self) -> String {
        format!("plane {} {}", self.n, self.walls)
    }
    fn terms(&self) -> usize {
        3
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let m: Vec<f64> = (0..self.n).map(|i| mass(self.n, i)).collect();
        let at = |x: &[D], i: usize| Vector2::new(x[2 * i], x[2 * i + 1]);
        let mut s = c(0.0);
        for (i, m) in m.iter().enumerate() {
            let (x, y) = (at(&a.x, i), at(&b.x, i));
            let d = y - x;
            s += c(w[0] * m / (2.0 * DT)) * d.dot(&d);
            s += c(w[1] * m * F / 2.0) * (x[0] * y[1] - x[1] * y[0]);
        }
        for q in [&a.x, &b.x] {
            let places: Vec<Vec<D>> = q.chunks(2).map(<[D]>::to_vec).collect();
            s -= c(w[2] * 0.5 * DT) * potential(&self.axes(), &places, &m, C0, 0.3);
        }
        s
    }
    stepped!([momentum_X], DT, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.4 / self.n as f64 / DT
    }
}
