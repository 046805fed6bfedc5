//! A Voronoi cell on a torus by definition: the part of a large square that is closer to its site than to any other copy of any
//! site. Slow, and independent of the mesh code.

use clebsch::nalgebra::SVector;

type Plane = SVector<f64, 2>;

/// Integrals over a cell, of 1, `x - X_a` and `|x - X_a|^2`.
pub struct Cell {
    pub area: f64,
    pub first: Plane,
    pub moment: f64,
    pub corners: Vec<Plane>,
}

pub fn cell(lengths: [f64; 2], at: &[Plane], a: usize) -> Cell {
    let reach = 2.0 * (lengths[0] + lengths[1]);
    let mut corners: Vec<Plane> = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
        .map(|c| Plane::from(c) * reach)
        .to_vec();
    let copies = lengths.map(|l| (1.5 * reach / l).ceil().min(14.0) as i32);
    for (b, x) in at.iter().enumerate() {
        let apart = x - at[a];
        let apart = Plane::from_fn(|k, _| apart[k] - (apart[k] / lengths[k]).round() * lengths[k]);
        for i in -copies[0]..=copies[0] {
            for j in -copies[1]..=copies[1] {
                if b == a && (i, j) == (0, 0) {
                    continue;
                }
                let d = apart + Plane::new(f64::from(i) * lengths[0], f64::from(j) * lengths[1]);
                corners = nearer(&corners, d);
            }
        }
    }
    let mut own = Cell {
        area: 0.0,
        first: Plane::zeros(),
        moment: 0.0,
        corners: Vec::new(),
    };
    for (k, p) in corners.iter().enumerate() {
        let q = corners[(k + 1) % corners.len()];
        let twice = p[0] * q[1] - p[1] * q[0];
        own.area += twice / 2.0;
        own.first += (p + q) * (twice / 6.0);
        own.moment += twice / 12.0 * (p.norm_squared() + p.dot(&q) + q.norm_squared());
    }
    own.corners = corners;
    own
}

/// The part of a polygon that is closer to the origin than to `d`.
fn nearer(corners: &[Plane], d: Plane) -> Vec<Plane> {
    let beyond = |p: &Plane| p.dot(&d) - d.norm_squared() / 2.0;
    let mut kept = Vec::new();
    for (k, p) in corners.iter().enumerate() {
        let q = &corners[(k + 1) % corners.len()];
        let (here, there) = (beyond(p), beyond(q));
        if here <= 0.0 {
            kept.push(*p);
        }
        if (here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0) {
            kept.push(p + (q - p) * (here / (here - there)));
        }
    }
    kept
}
