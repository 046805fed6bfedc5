//! Chains whose kinetic energy couples the velocities of neighbours, such as the consistent mass matrix of
//! linear elements. The recorded momenta of a step are compared with derivatives of the action computed by
//! hand.

use crate::common::Folder;

const MODEL: &str = "model Bar {
    label i in 0..N step s;
    param m, k, b: Real;
    field u: Real at nodes;
    let d = next(u) - u;
    let D = next(next(u), i) - next(u, i);
    lagrangian = (m*s/(6*h))*(d^2 + d*D + D^2) - h*k*(next(u, i) - u)^2/(2*s) - h*b*(next(u, i) - u)^4/s^4;
    end i = 0 { free; pinned { u = given; } }
}";

/// Momenta of size one, sums of a dozen terms of size ten.
const ROUNDED: f64 = 1e-13;

/// `[-D1 L, D2 L]` at site `i` of a step from `x` to `y`, nodal terms split evenly.
fn momenta([m, k, b, s, h]: [f64; 5], x: &[f64], y: &[f64], i: usize) -> [f64; 2] {
    let velocity = |j: usize| y[j] - x[j];
    let mut inertia = 0.0;
    let mut force = [0.0; 2];
    for j in i.saturating_sub(1)..(i + 1).min(x.len() - 1) {
        let other = if j == i { i + 1 } else { j };
        inertia += m * s / (6.0 * h) * (2.0 * velocity(i) + velocity(other));
        let sign = if j == i { -1.0 } else { 1.0 };
        for (end, z) in [x, y].into_iter().enumerate() {
            let stretched = z[j + 1] - z[j];
            let slope = h * k * stretched / s + 4.0 * h * b * stretched.powi(3) / s.powi(4);
            force[end] += 0.5 * sign * slope;
        }
    }
    [inertia + force[0], inertia - force[1]]
}

fn lists(count: usize, from: impl Fn(f64) -> f64) -> (Vec<f64>, String) {
    let values: Vec<f64> = (0..count).map(|i| from(i as f64)).collect();
    let text: Vec<String> = values.iter().map(|x| format!("{x:?}")).collect();
    (values, format!("[{}]", text.join(", ")))
}

#[test]
fn velocities_of_neighbours_alone_are_found_for_every_number_of_sites() {
    let folder = Folder::new("consistent-mass");
    folder.write("bar.clebsch", MODEL);
    for n in [4, 32, 33, 100] {
        let (x, places) = lists(n + 1, |i| 0.3 * (1.7 * i).sin());
        let (p, momentum) = lists(n + 1, |i| 0.2 * (0.9 * i + 0.4).cos());
        let case = format!(
            "model = \"bar\"\nh = 0.01\nsteps = 1\n[labels]\ni = {n}\n[ends]\ni = [\"free\", \"free\"]\n\
             [parameters]\nm = 1.3\nk = 0.7\nb = 0.2\ns = 0.5\n[initial]\nu = {places}\nmomentum_u = {momentum}\n"
        );
        let case = folder.write("bar.toml", &case);
        folder.runs(&format!(
            "run @bar.clebsch --case {case} --csv --out @out --force"
        ));
        let samples = folder.samples("out/trajectory.csv");
        let of = |name: &str| -> Vec<f64> {
            (0..=n)
                .map(|i| samples.end(&format!("{name}_{i}")))
                .collect()
        };
        let (y, q) = (of("u"), of("momentum_u"));
        for i in 0..=n {
            let [leaving, arriving] = momenta([1.3, 0.7, 0.2, 0.5, 0.01], &x, &y, i);
            assert!(
                (leaving - p[i]).abs() < ROUNDED,
                "{n}, {i}: {leaving} {}",
                p[i]
            );
            assert!(
                (arriving - q[i]).abs() < ROUNDED,
                "{n}, {i}: {arriving} {}",
                q[i]
            );
        }
    }
}
