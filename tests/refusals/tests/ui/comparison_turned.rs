//! The operators of comparisons end with `=`.

clebsch::model! {
    model Particle {
        param m: Real;
        assume m => 0;
        field y: Real;
        lagrangian = m*(next(y) - y)^2/(2*h);
    }
}

fn main() {}
