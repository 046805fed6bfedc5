//! A line of sites is not derived yet.
use clebsch::model;

model! {
    model M {
        param m: Real;
        field X: Vec<3> at nodes;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h);
    }
}

fn main() {}
