//! Shallow water in the plane on Voronoi cells. Here a cell is the square cut by the bisectors with all particles and their images,
//! and the smoothed depth solves a dense linear system. The runtime shares none of this code.

use super::dense::solved;
use super::{Line, Random, c, keeping, stepped};
use crate::action::{Configuration, D};
use clebsch::Real;
use clebsch::nalgebra::Vector2;
use clebsch_models::fluids::shallow_water_2d::*;
use clebsch_models::fluids::shallow_water_2d_regularised::*;

pub(super) type Place = Vector2<D>;

/// The edges of a particle's cell on the unit torus: both end points relative to the particle, the neighbour, and the vector to it.
pub(super) fn cell(at: &[Place], a: usize) -> Vec<(Place, Place, usize, Place)> {
    let half = c(0.5);
    // The sides of the initial square belong to no neighbour; with enough particles, none remains.
    let corner = |x: f64, y: f64| Vector2::new(c(x) * half, c(y) * half);
    let corners = [
        corner(-1.0, -1.0),
        corner(1.0, -1.0),
        corner(1.0, 1.0),
        corner(-1.0, 1.0),
    ];
    let mut edges: Vec<(Place, Place, usize, Place)> = (0..4)
        .map(|i| (corners[i], corners[(i + 1) % 4], usize::MAX, corners[i]))
        .collect();
    for b in 0..at.len() {
        for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
            let d = at[b] - at[a] + Vector2::new(c(f64::from(i)), c(f64::from(j)));
            let square = d.dot(&d);
            if square.value() < 1e-20 {
                continue;
            }
            // Keeps the half plane nearer to the particle: <x, d> <= |d|^2/2.
            let beyond = |x: &Place| x.dot(&d) - square * half;
            let mut kept = Vec::new();
            let (mut left, mut entered) = (None, None);
            for (from, to, who, how) in &edges {
                let (p, q) = (beyond(from), beyond(to));
                let cut = || *from + (*to - *from) * (p / (p - q));
                match (p.value() <= 0.0, q.value() <= 0.0) {
                    (true, true) => kept.push((*from, *to, *who, *how)),
                    (true, false) => {
                        let x = cut();
                        kept.push((*from, x, *who, *how));
                        left = Some(x);
                    }
                    (false, true) => {
                        let x = cut();
                        entered = Some(x);
                        kept.push((x, *to, *who, *how));
                    }
                    (false, false) => {}
                }
            }
            if let (Some(x), Some(y)) = (left, entered) {
                kept.push((x, y, b, d));
            }
            edges = kept;
        }
    }
    // The order of the edges does not matter: each forms a triangle with the particle.
    edges
}

pub(super) fn area(edges: &[(Place, Place, usize, Place)]) -> D {
    let each = edges
        .iter()
        .map(|(p, q, ..)| (p[0] * q[1] - p[1] * q[0]) * c(0.5));
    each.fold(c(0.0), |s, x| s + x)
}

/// The Voronoi depth smoothed over the length alpha: `(A + alpha^2 K) phi = m`.
fn smoothed(at: &[Place], m: &[f64], alpha: f64) -> Vec<D> {
    let n = at.len();
    let mut a = vec![vec![c(0.0); n]; n];
    for (i, row) in a.iter_mut().enumerate() {
        let edges = cell(at, i);
        row[i] += area(&edges);
        for (p, q, j, d) in edges {
            let (along, apart) = (q - p, d.dot(&d));
            let weight = (along.dot(&along) / apart).sqrt() * c(alpha * alpha);
            row[i] += weight;
            row[j] -= weight;
        }
    }
    solved(a, m.iter().map(|m| c(*m)).collect())
}

/// The core energy of all pairs within a radius, each pair once.
fn core(at: &[Place], rc: f64) -> D {
    let mut sum = c(0.0);
    for a in 0..at.len() {
        for b in 0..a {
            for (i, j) in (-1..=1).flat_map(|i| (-1..=1).map(move |j| (i, j))) {
                let d = at[b] - at[a] + Vector2::new(c(f64::from(i)), c(f64::from(j)));
                let r = d.dot(&d).sqrt();
                if r.value() < rc {
                    let x = c(1.0) - r * c(1.0 / rc);
                    sum += x * x * x;
                }
            }
        }
    }
    sum
}

/// Cells with the unsmoothed depth.
pub struct Cells {
    pub n: usize,
}

/// Cells with the smoothed depth.
pub struct Smoothed {
    pub n: usize,
}

const G: f64 = 0.9;
const F: f64 = 0.7;
pub(super) const DT: f64 = 0.01;

pub(super) fn mass(n: usize, i: usize) -> f64 {
    (1.0 + 0.2 * (i % 3) as f64) / n as f64
}

/// Random positions with a large minimum distance.
pub(super) fn places(n: usize, r: &mut Random) -> Vec<Vector2<f64>> {
    let mut out: Vec<Vector2<f64>> = Vec::new();
    let near = 0.6 / (n as f64).sqrt();
    let far = |x: &Vector2<f64>, y: &Vector2<f64>| {
        let d = (x - y).map(|d| d - d.round());
        d.norm() > near
    };
    let mut tries = 0;
    while out.len() < n {
        let x = Vector2::new(0.5 + 0.5 * r.number(), 0.5 + 0.5 * r.number());
        tries += 1;
        if tries > 20_000 || out.iter().all(|y| far(&x, y)) {
            out.push(x);
        }
    }
    out
}

pub(super) fn momenta(n: usize, r: &mut Random) -> Vec<Vector2<f64>> {
    let size = 0.3 / n as f64;
    (0..n)
        .map(|_| Vector2::new(size * r.number(), size * r.number()))
        .collect()
}

pub(super) fn seen(x: &[Vector2<f64>]) -> Configuration<f64> {
    Configuration::of(
        x.iter().flat_map(|x| [x[0], x[1]]).collect(),
        vec![],
        vec![],
    )
}

pub(super) fn at(q: &[D]) -> Vec<Place> {
    q.chunks(2).map(|x| Vector2::new(x[0], x[1])).collect()
}

/// The terms of an edge.
fn edge(n: usize, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
    let mut s = c(0.0);
    for (i, (x, y)) in at(&a.x).into_iter().zip(at(&b.x)).enumerate() {
        let d = y - x;
        s += c(w[0] * mass(n, i) / (2.0 * DT)) * d.dot(&d);
        s += c(w[1] * mass(n, i) * F / 2.0) * (x[0] * y[1] - x[1] * y[0]);
    }
    s
}

/// The total that translations conserve: the kinetic momentum, rotated with half of the frame's momentum.
fn total(n: usize, x: &[Vector2<f64>], p: &[Vector2<f64>]) -> f64 {
    let each = x.iter().zip(p).enumerate();
    each.map(|(i, (x, p))| p[0] - mass(n, i) * F / 2.0 * x[1])
        .sum()
}

impl Cells {
    fn stepper(&self) -> ShallowWater2D {
        let m = (0..self.n).map(|i| mass(self.n, i)).collect();
        let parameters = ShallowWater2DParameters { m, g: G, f: F };
        let sites = ShallowWater2DSites {
            N: self.n,
            L: [1.0, 1.0],
            scalar: Default::default(),
        };
        ShallowWater2D::new(parameters, sites).expect("cells")
    }
    fn initial(&self, seed: u64) -> ShallowWater2DInitial {
        let mut r = Random::new(seed + 11);
        ShallowWater2DInitial {
            X: places(self.n, &mut r),
            momentum_X: momenta(self.n, &mut r),
        }
    }
    fn seen(&self, s: &ShallowWater2DState) -> Configuration<f64> {
        seen(s.X())
    }
    keeping!(ShallowWater2D, |model, s: &ShallowWater2DState| {
        let own = total(s.X().len(), s.X(), s.momentum_X());
        // The engine computes the same total momentum.
        assert!((model.momentum(s)[0] - own).abs() < 1e-14);
        own
    });
}

impl Line for Cells {
    fn name(&self) -> String {
        format!("cells {}", self.n)
    }
    fn terms(&self) -> usize {
        3
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let mut s = edge(self.n, w, a, b);
        for q in [&a.x, &b.x] {
            let at = at(q);
            for i in 0..self.n {
                let m = mass(self.n, i);
                s -= c(w[2] * 0.5 * DT * G * m * m / 2.0) / area(&cell(&at, i));
            }
        }
        s
    }
    fn is_smooth(&self) -> bool {
        false
    }
    stepped!([momentum_X], DT, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.4 / self.n as f64 / DT
    }
}

impl Smoothed {
    fn lengths(&self) -> [f64; 2] {
        let dx = 1.0 / (self.n as f64).sqrt();
        [1.5 * dx, 0.9 * dx]
    }
    fn stepper(&self) -> ShallowWater2DRegularised {
        let m = (0..self.n).map(|i| mass(self.n, i)).collect();
        let [alpha, rc] = self.lengths();
        let parameters = ShallowWater2DRegularisedParameters {
            m,
            g: G,
            f: F,
            alpha,
            rc,
            kappa: 0.3,
        };
        let sites = ShallowWater2DRegularisedSites {
            N: self.n,
            L: [1.0, 1.0],
            scalar: Default::default(),
        };
        ShallowWater2DRegularised::new(parameters, sites).expect("cells")
    }
    fn initial(&self, seed: u64) -> ShallowWater2DRegularisedInitial {
        let mut r = Random::new(seed + 11);
        ShallowWater2DRegularisedInitial {
            X: places(self.n, &mut r),
            momentum_X: momenta(self.n, &mut r),
        }
    }
    fn seen(&self, s: &ShallowWater2DRegularisedState) -> Configuration<f64> {
        seen(s.X())
    }
    keeping!(
        ShallowWater2DRegularised,
        |_, s: &ShallowWater2DRegularisedState| total(s.X().len(), s.X(), s.momentum_X())
    );
}

impl Line for Smoothed {
    fn name(&self) -> String {
        format!("smoothed cells {}", self.n)
    }
    fn terms(&self) -> usize {
        4
    }
    fn weighed(&self, w: &[f64], a: &Configuration<D>, b: &Configuration<D>) -> D {
        let mut s = edge(self.n, w, a, b);
        let m: Vec<f64> = (0..self.n).map(|i| mass(self.n, i)).collect();
        let [alpha, rc] = self.lengths();
        let mean = m.iter().sum::<f64>() / m.len() as f64;
        for q in [&a.x, &b.x] {
            let at = at(q);
            for (m, phi) in m.iter().zip(smoothed(&at, &m, alpha)) {
                s -= c(w[2] * 0.5 * DT * G * m / 2.0) * phi;
            }
            s -= c(w[3] * 0.5 * DT * 0.3 * mean) * core(&at, rc);
        }
        s
    }
    fn is_smooth(&self) -> bool {
        false
    }
    stepped!([momentum_X], DT, 5e-2);
    fn mass_by_step(&self) -> f64 {
        1.4 / self.n as f64 / DT
    }
}
