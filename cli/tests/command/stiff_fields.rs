//! Steps of fields of which one oscillates much faster than the step size resolves. Each step must be solved to rounding of
//! each field, and its equations must be evaluated without large terms that cancel.

use crate::common::{Folder, rotor};

/// The fast field oscillates about ten times in one step, so that its midpoint is near zero. The expanded force would be
/// rounded relative to the position: it exceeded its bound by a factor of forty.
#[test]
fn a_stiff_quartic_spring_beside_soft_ones_is_solved_to_rounding() {
    let folder = Folder::new("stiff-fields");
    let model = folder.write(
        "stiff.clebsch",
        "model Stiff { param m1, m2, m3, k1, k2, k3: Real; field x, y, z: Real;
            let X = (next(x) + x)/2; let Y = (next(y) + y)/2; let Z = (next(z) + z)/2;
            let u = (next(x) - x)/h; let v = (next(y) - y)/h; let w = (next(z) - z)/h;
            lagrangian = h*(m1*(1 + Y^2)*u^2/2 + m2*(2 + sin(X))*v^2/2 + m3*exp(Z)*w^2/2
                - k1*X^2/2 - k2*Y^4/4 - k3*(cosh(Z) + X*Z/10)); }",
    );
    let case = folder.write(
        "stiff.toml",
        "model = \"stiff\"\nh = 0.01\nsteps = 30\n[parameters]\nm1 = 1.0\nm2 = 0.01\nm3 = 1.0\n\
         k1 = 1.0\nk2 = 1e6\nk3 = 1.0\n[initial]\nx = 1e-3\ny = -0.98\nz = -0.27\n\
         velocity_x = 0.0\nvelocity_y = 0.0\nvelocity_z = 0.0\n",
    );
    let run = format!("run {model} --case {case} --check all --stability-limit 0");
    let done = rotor(&run).succeeds();
    assert!(done.out.contains("30 steps checked"), "{}", done.out);
}
