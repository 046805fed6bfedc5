//! The Lagrangian does not contain the increment of the field.
use clebsch::model;

model! {
    model M {
        param k: Real;
        field X: Vec<3>;
        lagrangian = -h*k*dot(X, X);
    }
}

fn main() {}
