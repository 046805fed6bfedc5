//! Names of constants and quantities in other languages and papers.

/// Names of constants in other languages, and their form in the language.
const CONSTANTS: [(&str, &str); 15] = [
    ("PI", "pi"),
    ("Pi", "pi"),
    ("M_PI", "pi"),
    ("e1", "E1"),
    ("e2", "E2"),
    ("e3", "E3"),
    ("e_1", "E1"),
    ("e_2", "E2"),
    ("e_3", "E3"),
    ("e_x", "E1"),
    ("e_y", "E2"),
    ("e_z", "E3"),
    ("eye", "Id"),
    ("Identity", "Id"),
    ("identity", "Id"),
];

/// Common names of the time step.
pub(crate) const STEPS: [&str; 7] = ["h", "dt", "Dt", "Δt", "delta_t", "deltat", "tau"];

/// Common names of time.
pub(crate) const TIMES: [&str; 2] = ["t", "time"];

/// Common names of a velocity.
pub(crate) const VELOCITIES: [&str; 5] = ["v", "vel", "velocity", "xdot", "qdot"];

/// Units of angles.
pub(crate) const ANGLES: [&str; 6] = ["deg", "degree", "degrees", "rad", "radian", "radians"];

/// Python modules with functions.
pub(crate) const MODULES: [&str; 12] = [
    "np", "numpy", "math", "cmath", "scipy", "sp", "sympy", "sym", "jnp", "jax", "torch", "linalg",
];

/// The form of a constant in the language.
pub(crate) fn name(name: &str) -> Option<&'static str> {
    let found = CONSTANTS.iter().find(|(other, _)| *other == name);
    found.map(|(_, written)| *written)
}

/// The shape that other languages call by this name.
pub(crate) fn shape(name: &str) -> Option<&'static str> {
    Some(match name {
        "Scalar" | "Number" | "R" | "ℝ" | "f64" | "Float" | "float" | "Double" | "double"
        | "real" | "scalar" | "int" | "Int" | "angle" | "Angle" | "S1" => "Real",
        "Vector" | "vector" | "R3" | "ℝ3" | "array" | "ndarray" => "Vec<3>",
        "R2" | "ℝ2" => "Vec<2>",
        "Matrix" | "matrix" => "Mat<3>",
        "Symmetric" => "Sym<3>",
        "Quaternion" => "SU<2>",
        _ => return None,
    })
}
