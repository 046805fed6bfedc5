//! A root between two numbers where a function has opposite signs.

/// Evaluations after which the search ends. Halving alone needs about 60 for an interval of size one.
const EVALUATIONS: usize = 200;

/// The root of `f` between `a` and `b`, to the spacing of numbers. `a` and `b` are arguments with their values, which
/// have opposite signs.
///
/// The method is the secant with halved values (Illinois: Dowell and Jarratt, BIT 11, 1971), and bisection wherever
/// three secants did not halve the interval.
pub(crate) fn bracketed<E>(
    mut f: impl FnMut(f64) -> Result<f64, E>,
    a: (f64, f64),
    b: (f64, f64),
) -> Result<f64, E> {
    let (mut a, mut b) = (a, b);
    // The best argument keeps its true value; the secant halves the values of `a` and `b`.
    let mut best = if a.1.abs() < b.1.abs() { a } else { b };
    let mut width = (b.0 - a.0).abs();
    let mut side = 0;
    for evaluation in 0..EVALUATIONS {
        let here = (b.0 - a.0).abs();
        let spacing = f64::EPSILON * a.0.abs().max(b.0.abs());
        if best.1 == 0.0 || here <= 2.0 * spacing {
            break;
        }
        let middle = a.0 + 0.5 * (b.0 - a.0);
        let secant = a.0 - a.1 * (b.0 - a.0) / (b.1 - a.1);
        let inside = (secant - a.0) * (b.0 - secant) > 0.0;
        let slow = evaluation % 3 == 2 && here > 0.5 * width;
        if evaluation % 3 == 2 {
            width = here;
        }
        let x = if inside && !slow { secant } else { middle };
        let y = f(x)?;
        if y.abs() < best.1.abs() {
            best = (x, y);
        }
        if y.is_nan() {
            break;
        }
        if (y > 0.0) == (a.1 > 0.0) {
            a = (x, y);
            b.1 *= if side == 1 { 0.5 } else { 1.0 };
            side = 1;
        } else {
            b = (x, y);
            a.1 *= if side == 2 { 0.5 } else { 1.0 };
            side = 2;
        }
    }
    Ok(best.0)
}
