//! Elliptic functions and integrals of real arguments, to a few rounding errors: Carlson's R_F and R_J (Numer. Algorithms 10,
//! 1995), and Jacobi's amplitude by the descending arithmetic-geometric mean (DLMF 22.20). The complementary parameter is m1 = 1 -
//! k^2 in (0, 1].

/// Carlson's R_F(x, y, z) for non-negative arguments of which at most one is zero.
pub fn carlson_rf(x: f64, y: f64, z: f64) -> f64 {
    let (mut x, mut y, mut z) = (x, y, z);
    // Each iteration brings the arguments closer by a factor of four; the series has an error of about spread^6 / 100.
    for _ in 0..200 {
        let mean = (x + y + z) / 3.0;
        let (dx, dy, dz) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        let spread = dx.abs().max(dy.abs()).max(dz.abs());
        if spread < 1e-3 {
            let e2 = dx * dy - dz * dz;
            let e3 = dx * dy * dz;
            let series = e2 * (-0.1 + e2 / 24.0 - e3 * 3.0 / 44.0 - e2 * e2 * 5.0 / 208.0)
                + e3 / 14.0
                + e3 * e3 * 3.0 / 104.0;
            return (1.0 + series) / mean.sqrt();
        }
        let lambda = (x * y).sqrt() + (y * z).sqrt() + (z * x).sqrt();
        (x, y, z) = (
            0.25 * (x + lambda),
            0.25 * (y + lambda),
            0.25 * (z + lambda),
        );
    }
    f64::NAN
}

/// R_C(1, 1 + e) for e > -1: an inverse tangent or inverse hyperbolic tangent, whichever is real.
fn carlson_rc_beside_one(e: f64) -> f64 {
    if e.abs() < 1e-3 {
        // Six terms of the common Taylor series have an error of 1e-19.
        let mut sum = 0.0;
        for n in (0..=6).rev() {
            sum = sum * -e + 1.0 / f64::from(2 * n + 1);
        }
        sum
    } else if e > 0.0 {
        e.sqrt().atan() / e.sqrt()
    } else {
        (-e).sqrt().atanh() / (-e).sqrt()
    }
}

/// Carlson's R_J(x, y, z, p) for p > 0 and non-negative x, y, z of which at most one is zero.
pub fn carlson_rj(x: f64, y: f64, z: f64, p: f64) -> f64 {
    let (mut x, mut y, mut z, mut p) = (x, y, z, p);
    let delta = (p - x) * (p - y) * (p - z);
    let (mut weight, mut sum) = (1.0, 0.0);
    for _ in 0..200 {
        let mean = (x + y + z + 2.0 * p) / 5.0;
        let (dx, dy, dz) = (1.0 - x / mean, 1.0 - y / mean, 1.0 - z / mean);
        let spread = dx
            .abs()
            .max(dy.abs())
            .max(dz.abs())
            .max((1.0 - p / mean).abs());
        if spread < 1e-3 {
            let dp = -0.5 * (dx + dy + dz);
            let e2 = dx * dy + dy * dz + dz * dx - 3.0 * dp * dp;
            let e3 = dx * dy * dz + 2.0 * e2 * dp + 4.0 * dp * dp * dp;
            let e4 = dp * (2.0 * dx * dy * dz + e2 * dp + 3.0 * dp * dp * dp);
            let e5 = dx * dy * dz * dp * dp;
            let series = 1.0 - e2 * 3.0 / 14.0 + e3 / 6.0 + e2 * e2 * 9.0 / 88.0
                - e4 * 3.0 / 22.0
                - e2 * e3 * 9.0 / 52.0
                + e5 * 3.0 / 26.0;
            return weight * series / (mean * mean.sqrt()) + 6.0 * sum;
        }
        let (rx, ry, rz, rp) = (x.sqrt(), y.sqrt(), z.sqrt(), p.sqrt());
        let lambda = rx * ry + ry * rz + rz * rx;
        let d = (rp + rx) * (rp + ry) * (rp + rz);
        sum += weight / d * carlson_rc_beside_one(weight * weight * weight * delta / (d * d));
        weight *= 0.25;
        (x, y, z, p) = (
            0.25 * (x + lambda),
            0.25 * (y + lambda),
            0.25 * (z + lambda),
            0.25 * (p + lambda),
        );
    }
    f64::NAN
}

/// The complete integral K.
pub fn complete(m1: f64) -> f64 {
    carlson_rf(0.0, m1, 1.0)
}

/// F(phi), the inverse of Jacobi's amplitude, for |phi| <= pi/2, in terms of the sine and cosine of phi.
pub fn incomplete(sine: f64, cosine: f64, m1: f64) -> f64 {
    let (s2, c2) = (sine * sine, cosine * cosine);
    sine * carlson_rf(c2, c2 + m1 * s2, 1.0)
}

/// The integral of the third kind, int dphi / ((1 - n sin^2 phi) sqrt(1 - k^2 sin^2 phi)), for |phi| <= pi/2, in terms of the sine
/// and cosine of phi; `rest` is 1 - n, positive.
pub fn third_kind(rest: f64, sine: f64, cosine: f64, m1: f64) -> f64 {
    let (s2, c2) = (sine * sine, cosine * cosine);
    let (y, p) = (c2 + m1 * s2, c2 + rest * s2);
    sine * carlson_rf(c2, y, 1.0) + (1.0 - rest) / 3.0 * sine * s2 * carlson_rj(c2, y, 1.0, p)
}

/// sn, cn, dn of u with |u| <= K.
pub fn jacobi(u: f64, m1: f64) -> [f64; 3] {
    // Ratios c/a of the mean, from its second member. Convergence is quadratic; for any m1 that a double can represent, twenty
    // members reach rounding.
    let mut ratios = [0.0; 20];
    let (mut a, mut b) = (1.0_f64, m1.sqrt());
    let mut power = 1.0;
    let mut members = 0;
    for ratio in &mut ratios {
        if a - b <= f64::EPSILON * a {
            break;
        }
        let c = 0.5 * (a - b);
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
        *ratio = c / a;
        power *= 2.0;
        members += 1;
    }
    let mut phi = power * a * u;
    for ratio in ratios.iter().take(members).rev() {
        phi = 0.5 * (phi + (ratio * phi.sin()).asin());
    }
    let (sn, cn) = phi.sin_cos();
    // This form avoids cancellation if dn is small: dn^2 = cn^2 + m1 sn^2.
    [sn, cn, (cn * cn + m1 * sn * sn).sqrt()]
}
