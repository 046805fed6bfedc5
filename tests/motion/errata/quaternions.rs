//! Errata of section 2.9 and table A.6: SU(2) and quaternions. Points are random. Complex 2 x 2 matrices are written out, so that
//! the test does not depend on the quaternion layout of the runtime.

use super::{Vector, judge, judge_within, length, minus};
use clebsch_oracle::oracle::points::Source;
use clebsch_oracle::oracle::square::{cross, dot};
use clebsch_oracle::physics::measure::worse;
use std::array::from_fn;

/// A complex number.
type Complex = [f64; 2];
/// A complex 2 x 2 matrix.
type Spin = [[Complex; 2]; 2];
type Quaternion = [f64; 4];

fn product(a: &Spin, b: &Spin) -> Spin {
    from_fn(|i| {
        from_fn(|j| {
            let terms = (0..2).map(|k| (a[i][k], b[k][j]));
            terms.fold([0.0; 2], |s, (x, y)| {
                [
                    s[0] + x[0] * y[0] - x[1] * y[1],
                    s[1] + x[0] * y[1] + x[1] * y[0],
                ]
            })
        })
    })
}

fn dagger(a: &Spin) -> Spin {
    from_fn(|i| from_fn(|j| [a[j][i][0], -a[j][i][1]]))
}

fn apart(a: &Spin, b: &Spin) -> f64 {
    let entries = (0..4).flat_map(|k| {
        let (x, y) = (a[k / 2][k % 2], b[k / 2][k % 2]);
        [x[0] - y[0], x[1] - y[1]]
    });
    entries.fold(0.0, |m, x| worse(m, x.abs()))
}

fn difference(a: &Spin, b: &Spin) -> Spin {
    from_fn(|i| from_fn(|j| from_fn(|k| a[i][j][k] - b[i][j][k])))
}

/// Pauli's matrices times a complex number, summed with weights.
fn pauli(v: &Vector, factor: Complex) -> Spin {
    let [x, y, z] = *v;
    let sigma: Spin = [[[z, 0.0], [x, -y]], [[x, y], [-z, 0.0]]];
    sigma.map(|row| {
        row.map(|[re, im]| {
            [
                factor[0] * re - factor[1] * im,
                factor[0] * im + factor[1] * re,
            ]
        })
    })
}

fn identity() -> Spin {
    [[[1.0, 0.0], [0.0, 0.0]], [[0.0, 0.0], [1.0, 0.0]]]
}

fn unit(s: &mut Source) -> Quaternion {
    let q: Quaternion = s.vector();
    let size = dot(&q, &q).sqrt();
    q.map(|x| x / size)
}

fn hamilton(a: &Quaternion, b: &Quaternion) -> Quaternion {
    let [p, q]: [Vector; 2] = [a, b].map(|x| [x[1], x[2], x[3]]);
    let turned = cross(&p, &q);
    let imaginary: Vector = from_fn(|i| a[0] * q[i] + b[0] * p[i] + turned[i]);
    [
        a[0] * b[0] - dot(&p, &q),
        imaginary[0],
        imaginary[1],
        imaginary[2],
    ]
}

fn conjugate(a: &Quaternion) -> Quaternion {
    [a[0], -a[1], -a[2], -a[3]]
}

fn imaginary(a: &Quaternion) -> Vector {
    [a[1], a[2], a[3]]
}

fn of_vector(v: &Vector) -> Quaternion {
    [0.0, v[0], v[1], v[2]]
}

/// The matrix of (2.189) with this lower left entry.
fn spin([w, x, y, z]: &Quaternion, lower_left: Complex) -> Spin {
    [[[*w, -*z], [-*y, -*x]], [lower_left, [*w, *z]]]
}

#[test]
fn two_189_is_not_unitary() {
    judge("(2.189)", |s| {
        let q = unit(s);
        let off = |u: Spin| apart(&product(&u, &dagger(&u)), &identity());
        (off(spin(&q, [q[2], q[1]])), off(spin(&q, [q[2], -q[1]])))
    });
    // With the correct entry it is a homomorphism.
    for seed in 1..=super::DRAWS {
        let mut s = Source::seeded(seed);
        let (p, q) = (unit(&mut s), unit(&mut s));
        let of = |q: &Quaternion| spin(q, [q[2], -q[1]]);
        let together = of(&hamilton(&p, &q));
        assert!(apart(&together, &product(&of(&p), &of(&q))) < super::ROUNDING);
    }
}

#[test]
fn two_190_reverses_the_bracket() {
    judge("(2.190)", |s| {
        let (x, y): (Vector, Vector) = (s.vector(), s.vector());
        let off = |factor: Complex| {
            let [a, b, c] = [x, y, cross(&x, &y)].map(|v| pauli(&v, factor));
            apart(&difference(&product(&a, &b), &product(&b, &a)), &c)
        };
        // i/2 as printed, 1/(2 i) = -i/2.
        (off([0.0, 0.5]), off([0.0, -0.5]))
    });
}

#[test]
fn two_193_has_the_kinetic_energy_with_the_wrong_sign_and_factor() {
    // Finite differences with step 1e-3: the remaining error is its square.
    judge_within(1e-5, "(2.193)", |s| {
        let moments: Vector = from_fn(|_| s.between(1.5, 3.0));
        let w: Vector = from_fn(|_| s.between(0.3, 1.0));
        let h = 1e-3;
        let angle = dot(&w, &w).sqrt();
        let (sin, cos) = (0.5 * h * angle).sin_cos();
        let q: Vector = w.map(|x| x * sin / angle);
        let shape = |factor: f64| {
            let squares = (0..3).map(|i| (1.0 - moments[i]) * q[i] * q[i]);
            2.0 * cos + factor * squares.sum::<f64>()
        };
        // 2 - h² ω·I ω/4: the action of a body, up to a factor.
        let energy: f64 = (0..3).map(|i| moments[i] * w[i] * w[i]).sum();
        let off = |value: f64| ((value - 2.0) / (h * h) + 0.25 * energy).abs();
        (off(shape(-2.0)), off(shape(1.0)))
    });
}

#[test]
fn two_194_turns_about_the_first_axis() {
    judge("(2.194)", |s| {
        let angle = s.between(0.3, 1.2);
        let (b, a) = angle.sin_cos();
        let printed: Spin = [[[a, 0.0], [0.0, b]], [[0.0, b], [a, 0.0]]];
        let right: Spin = [[[a, -b], [0.0, 0.0]], [[0.0, 0.0], [a, b]]];
        let axis = pauli(&[0.0, 0.0, 1.0], [1.0, 0.0]);
        let off = |u: &Spin| apart(&product(&product(u, &axis), &dagger(u)), &axis);
        (off(&printed), off(&right))
    });
}

#[test]
fn two_201_the_coadjoint_action_is_that_of_the_velocity() {
    judge("(2.201)", |s| {
        let (q, w, m) = (unit(s), unit(s), s.vector());
        // The spatial momentum is conserved: the body momentum is q* m q at either end.
        let seen =
            |q: &Quaternion| imaginary(&hamilton(&hamilton(&conjugate(q), &of_vector(&m)), q));
        let (before, after) = (seen(&q), seen(&hamilton(&q, &w)));
        let carried =
            |w: &Quaternion| imaginary(&hamilton(&hamilton(w, &of_vector(&before)), &conjugate(w)));
        (
            length(&minus(&carried(&w), &after)),
            length(&minus(&carried(&conjugate(&w)), &after)),
        )
    });
}

#[test]
fn table_a_6_the_gradient_does_not_give_the_momentum() {
    judge("A of table A.6", |s| {
        let (h, c) = (s.between(0.1, 0.5), 1.0);
        let moments: Vector = from_fn(|_| s.between(1.5, 3.0));
        let (w, xi) = (unit(s), s.vector());
        // L = -(4 c/h) re W + (2/h) im W·(I - c) im W, quadratic in W: the central difference along δW = -ξ W/2, a rotation at the
        // start of the edge, is exact.
        let action = |w: &Quaternion| {
            let squares = (0..3).map(|i| (moments[i] - c) * w[i + 1] * w[i + 1]);
            (-4.0 * c * w[0] + 2.0 * squares.sum::<f64>()) / h
        };
        let turn = hamilton(&of_vector(&xi), &w);
        let at = |e: f64| action(&from_fn(|i| w[i] - 0.5 * e * turn[i]));
        let slope = -0.5 * (at(1.0) - at(-1.0));
        let momentum = |a: Quaternion, factor: f64| {
            let n = imaginary(&hamilton(&a, &conjugate(&w)));
            (factor * dot(&n, &xi) - slope).abs()
        };
        let printed: Quaternion = [1.0, moments[0] * w[1], moments[1] * w[2], moments[2] * w[3]];
        let right = [
            -c,
            (moments[0] - c) * w[1],
            (moments[1] - c) * w[2],
            (moments[2] - c) * w[3],
        ];
        // N = vec(A W*)/2 with A = ∇L, and ∇L is (4/h) times the expression here.
        (momentum(printed, 2.0 / h), momentum(right, 2.0 / h))
    });
}

#[test]
fn two_204_the_fibration_is_of_the_attitude_not_of_the_multiplier() {
    judge("(2.204)", |s| {
        let (attitude, radius) = (unit(s), s.between(1.5, 2.5));
        let [a, b] = [unit(s), unit(s)].map(|z| z.map(|x| radius * x));
        let m: Vector = s.vector();
        // A fibration maps the whole sphere to one sphere.
        let printed = |z: &Quaternion| {
            let v = imaginary(&hamilton(&conjugate(&attitude), z));
            dot(&v, &v).sqrt()
        };
        let right = |z: &Quaternion| {
            let q = z.map(|x| x / radius);
            let v = imaginary(&hamilton(&hamilton(&conjugate(&q), &of_vector(&m)), &q));
            dot(&v, &v).sqrt()
        };
        (
            (printed(&a) - printed(&b)).abs(),
            (right(&a) - right(&b)).abs(),
        )
    });
    // Its fibres are circles: q and exp(θ m) q have the same image.
    let mut s = Source::seeded(3);
    let (q, m): (Quaternion, Vector) = (unit(&mut s), s.vector());
    let size = dot(&m, &m).sqrt();
    let (sin, cos) = 0.7_f64.sin_cos();
    let turn = [cos, sin * m[0] / size, sin * m[1] / size, sin * m[2] / size];
    let image = |q: &Quaternion| imaginary(&hamilton(&hamilton(&conjugate(q), &of_vector(&m)), q));
    let moved = hamilton(&turn, &q);
    assert!(length(&minus(&image(&q), &image(&moved))) < super::ROUNDING);
}
