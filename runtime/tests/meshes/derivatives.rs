//! Tests derivatives of mesh functionals against central differences and dual numbers.

use clebsch::Dual;
use clebsch::mesh::{Domain, Functional, Setting};
use clebsch::nalgebra::SVector;

pub type Plane = SVector<f64, 2>;

pub fn setting(lengths: [f64; 2], particles: usize) -> Setting<2> {
    let domain = Domain::torus(lengths);
    Setting {
        domain,
        grid: None,
        particles,
    }
}

/// Random numbers in (0, 1) (xorshift).
pub fn numbers(seed: u64) -> impl FnMut() -> f64 {
    let mut s = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    move || {
        s ^= s << 13;
        s ^= s >> 7;
        s ^= s << 17;
        (s >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// Random positions in a domain of twice the size, and therefore not wrapped.
pub fn random(lengths: [f64; 2], count: usize, seed: u64) -> Vec<Plane> {
    let mut next = numbers(seed);
    let mut at = || {
        Plane::new(
            (2.0 * next() - 0.5) * lengths[0],
            (2.0 * next() - 0.5) * lengths[1],
        )
    };
    (0..count).map(|_| at()).collect()
}

/// The derivative of `sum seed value` against central differences with the step `h`.
pub fn against_differences<F: Functional<f64, 2, Argument = Plane>>(
    f: &mut F,
    at: &[Plane],
    seed: &[f64],
    h: f64,
    tolerance: f64,
) {
    let mut out = vec![0.0; at.len()];
    let mut gradient = vec![Plane::zeros(); at.len()];
    f.value(at, &mut out).unwrap();
    f.pull_back(at, seed, &mut gradient).unwrap();
    let size = clebsch::scalar::largest(gradient.iter().map(|g| g.norm()));
    let mut moved = at.to_vec();
    let mut sum = |moved: &[Plane]| -> f64 {
        f.value(moved, &mut out).unwrap();
        out.iter().zip(seed).map(|(a, b)| a * b).sum()
    };
    for a in 0..at.len() {
        for k in 0..2 {
            let mut difference = 0.0;
            // A fourth-order central difference.
            for (shift, weight) in [(-2.0, 1.0), (-1.0, -8.0), (1.0, 8.0), (2.0, -1.0)] {
                moved[a][k] = at[a][k] + shift * h;
                difference += weight / (12.0 * h) * sum(&moved);
            }
            moved[a][k] = at[a][k];
            let off = (gradient[a][k] - difference).abs();
            assert!(
                off < tolerance * size,
                "{a} {k}: {} {difference}",
                gradient[a][k]
            );
        }
    }
    let total: Plane = gradient.iter().sum();
    assert!(total.norm() < 1e-12 * size * at.len() as f64, "{total}");
}

/// The derivative of `sum seed value` against dual numbers through the mesh of the real parts.
pub fn against_duals<R, F>(f: &mut R, dual: &mut F, at: &[Plane], seed: &[f64])
where
    R: Functional<f64, 2, Argument = Plane>,
    F: Functional<Dual<1>, 2, Argument = SVector<Dual<1>, 2>>,
{
    let count = at.len();
    let mut out = vec![0.0; count];
    let mut gradient = vec![Plane::zeros(); count];
    f.value(at, &mut out).unwrap();
    f.pull_back(at, seed, &mut gradient).unwrap();
    let size = clebsch::scalar::largest(gradient.iter().map(|g| g.norm()));
    let mut moved: Vec<_> = at.iter().map(|x| x.map(Dual::<1>::constant)).collect();
    let mut values = vec![Dual::<1>::constant(0.0); count];
    for a in 0..count {
        for k in 0..2 {
            moved[a][k] = Dual::variable(at[a][k], 0);
            dual.value(&moved, &mut values).unwrap();
            moved[a][k] = Dual::constant(at[a][k]);
            let exact: f64 = values.iter().zip(seed).map(|(v, s)| v.dual[0] * s).sum();
            let off = (gradient[a][k] - exact).abs();
            assert!(off < 1e-10 * size, "{a} {k}: {} {exact}", gradient[a][k]);
        }
    }
}

pub fn seeds(count: usize) -> Vec<f64> {
    let mut next = numbers(11);
    (0..count).map(|_| next() - 0.4).collect()
}

/// Checks second derivatives, which the tangent map of a step needs: pull-backs of dual numbers are symmetric, and several entries
/// equal finite differences.
pub fn second_derivatives<R, F>(f: &mut R, dual: &mut F, at: &[Plane], seed: &[f64], tolerance: f64)
where
    R: Functional<f64, 2, Argument = Plane>,
    F: Functional<Dual<1>, 2, Argument = SVector<Dual<1>, 2>>,
{
    let count = at.len();
    let mut moved: Vec<_> = at.iter().map(|x| x.map(Dual::<1>::constant)).collect();
    let seeds: Vec<_> = seed.iter().map(|s| Dual::<1>::constant(*s)).collect();
    let mut values = vec![Dual::<1>::constant(0.0); count];
    let mut gradient = vec![SVector::<Dual<1>, 2>::zeros(); count];
    let mut rows = Vec::new();
    for i in 0..2 * count {
        let (a, k) = (i / 2, i % 2);
        moved[a][k] = Dual::variable(at[a][k], 0);
        dual.value(&moved, &mut values).unwrap();
        dual.pull_back(&moved, &seeds, &mut gradient).unwrap();
        moved[a][k] = Dual::constant(at[a][k]);
        let row: Vec<f64> = (0..2 * count)
            .map(|j| gradient[j / 2][j % 2].dual[0])
            .collect();
        rows.push(row);
    }
    let size = rows
        .iter()
        .flatten()
        .fold(0.0_f64, |size, x| size.max(x.abs()));
    for (i, row) in rows.iter().enumerate() {
        for (j, entry) in row.iter().enumerate() {
            let off = (entry - rows[j][i]).abs();
            assert!(off < 1e-10 * size, "{i} {j}: {entry} {}", rows[j][i]);
        }
    }
    let h = 1e-5;
    let (mut out, mut above) = (vec![0.0; count], vec![Plane::zeros(); count]);
    let mut below = above.clone();
    let mut at = at.to_vec();
    let x = at[1][0];
    for (shift, gradient) in [(h, &mut above), (-h, &mut below)] {
        at[1][0] = x + shift;
        f.value(&at, &mut out).unwrap();
        f.pull_back(&at, seed, gradient).unwrap();
    }
    for (j, entry) in rows[2].iter().enumerate() {
        let difference = (above[j / 2][j % 2] - below[j / 2][j % 2]) / (2.0 * h);
        assert!(
            (entry - difference).abs() < tolerance * size,
            "{j}: {entry} {difference}"
        );
    }
}
