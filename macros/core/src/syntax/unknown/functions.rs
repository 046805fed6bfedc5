//! Functions of other languages: their form in the language, or the advice if there is none.

use crate::diagnostic::{Diagnostic, closest};

/// The advice for inverses of trigonometric functions.
const NO_INVERSE: &str = "clebsch has no inverse of sine, cosine or tangent. Declare the angle as a configuration, for example \
    `field θ: Real;`, and write its potential as `k*θ^2/2`";

/// The advice for piecewise functions.
const NO_CASES: &str = "piecewise functions are not supported yet, except through `abs` and `sign`: `(x + abs(x))/2` is x \
    where x > 0 and 0 elsewhere, `(1 + sign(x))/2` is 1 or 0";

/// The advice for rates of change.
const RATE: &str = "write a rate of change as a difference over the step: `(next(x) - x)/h`";

/// The advice for units of angles.
pub(crate) const RADIANS: &str = "angles are in radians: 30 degrees are `30*pi/180`, or `pi/6`";

/// The advice for derivatives and integrals.
const ENGINE: &str = "state the Lagrangian; clebsch takes the derivatives";

/// The advice for sums over pairs of sites.
pub(crate) const PAIRS: &str = "terms couple neighbours along a label, not all pairs of sites. Declare the bodies one by one, \
    `field x, y, z: Vec<3>;`, and write a term for each pair";

/// Adds the notation for a sum over sites.
pub(crate) fn how_to_sum(d: Diagnostic) -> Diagnostic {
    d.help(
        "in a `hold` constraint, write the summand in parentheses, as in `hold p: sum(m*x) = X;`",
    )
    .help("in the Lagrangian, leave out `sum`: clebsch sums each term over the sites of its label")
}

/// Functions of other languages with names that are long enough to be recognised when misspelt.
const LONG: [&str; 20] = [
    "norm",
    "length",
    "magnitude",
    "minimum",
    "maximum",
    "arccos",
    "arcsin",
    "arctan",
    "piecewise",
    "heaviside",
    "signum",
    "power",
    "square",
    "absolute",
    "determinant",
    "trace",
    "inverse",
    "transpose",
    "identity",
    "average",
];

/// The closest of these to a misspelt name, and its form in the language.
pub(crate) fn nearest_function(name: &str) -> Option<(&'static str, &'static str)> {
    let near = closest(name, LONG)?;
    Some((near, function(near)?))
}

/// The notation of the language for a function of another language, or advice if there is none.
pub(crate) fn function(name: &str) -> Option<&'static str> {
    Some(match name {
        "norm" | "Norm" | "length" | "len" | "magnitude" | "mag" | "hypot" | "modulus" => {
            "the length of a vector x is `sqrt(dot(x, x))`"
        }
        "min" | "minimum" | "fmin" => "the smaller of a and b is `(a + b - abs(a - b))/2`",
        "max" | "maximum" | "fmax" => "the larger of a and b is `(a + b + abs(a - b))/2`",
        "acos" | "arccos" | "asin" | "arcsin" | "atan" | "arctan" | "atan2" | "arctan2" | "arg"
        | "angle" => NO_INVERSE,
        "asinh" | "arcsinh" => "write `log(x + sqrt(x^2 + 1))`",
        "acosh" | "arccosh" => "write `log(x + sqrt(x^2 - 1))`",
        "atanh" | "arctanh" => "write `log((1 + x)/(1 - x))/2`",
        "tan" => "write `sin(a)/cos(a)`",
        "cot" => "write `cos(a)/sin(a)`",
        "sec" => "write `1/cos(a)`",
        "csc" => "write `1/sin(a)`",
        "if" | "where" | "piecewise" | "Piecewise" | "heaviside" | "Heaviside" | "step"
        | "relu" | "ramp" | "clip" | "clamp" | "select" => NO_CASES,
        "sgn" | "signum" => "write `sign(x)`",
        "ln" => "write `log(x)`",
        "log10" => "write `log(x)/log(10)`",
        "log2" => "write `log(x)/log(2)`",
        "pow" | "power" => "write a power as `x^2`, `x^(1/2)` or `exp(p*log(x))`",
        "sq" | "square" | "sqr" => "write `x^2` for a number, `dot(x, x)` for a vector",
        "cbrt" => "write `x^(1/3)`",
        "fabs" | "Abs" | "absolute" => "write `abs(x)`",
        "mod" | "fmod" | "floor" | "ceil" | "round" | "rint" => {
            "clebsch has no rounding or remainder. An angle needs none: `cos(q)` is periodic"
        }
        "I3" | "determinant" => "write `det(A)`",
        "trace" => "write `tr(A)`",
        "inverse" => "write `inv(A)`",
        "transpose" | "transposed" => "write `A^T`",
        "inner" | "scalar" | "vdot" | "matmul" => {
            "write `dot(a, b)` for vectors, `A*b` for a matrix times a vector or a matrix"
        }
        "outer" => "write `a*b^T`",
        "wedge" | "curl" => "write `cross(a, b)` for vectors with three components",
        "vec" | "Vec" | "vector" | "Vector" | "array" | "list" | "Matrix" | "matrix" => {
            "write a vector in unit vectors, `a*E1 + b*E2`, or declare it, `param v: Vec<3>;`"
        }
        "eye" | "identity" => "the identity matrix is `Id`",
        "mid" | "midpoint" | "mean" | "average" | "avg" => {
            "the mean over a step is `(x + next(x))/2`"
        }
        "diff" | "d" | "D" | "ddt" | "derivative" | "dt" | "der" | "rate" => RATE,
        "deg" | "degree" | "degrees" | "deg2rad" | "rad" | "radians" | "rad2deg" | "sind"
        | "cosd" | "tand" => RADIANS,
        "grad" | "gradient" | "nabla" | "div" | "laplacian" | "integrate" | "integral" | "quad" => {
            ENGINE
        }
        "pairs" | "combinations" => PAIRS,
        "range" | "product" | "prod" => {
            "terms `at nodes` and `at segments` are summed over the label automatically; other loops are not supported"
        }
        "random" | "rand" | "randn" | "normal" => {
            "a Lagrangian contains no random numbers: declare parameters, and give their values in the case"
        }
        "previous" => "write the term one step later: `x` for `previous(x)`, `next(x)` for `x`",
        _ => return None,
    })
}
