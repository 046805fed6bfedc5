//! Nodes belong to a label.
use clebsch::model;

model! {
    model M {
        param m: Real;
        field X: Vec<3> at nodes;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h);
    }
}

fn main() {}
