//! Nothing says how the field moves.
use clebsch::model;

model! {
    model M {
        param k: Real;
        field X: Vec<3>;
        lagrangian = -h*k*dot(X, X);
    }
}

fn main() {}
