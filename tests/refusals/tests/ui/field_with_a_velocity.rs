//! The velocity of a field is its increment, which has no name.
use clebsch::model;

model! {
    model M {
        param m: Real;
        field X: Vec<3> velocity V;
        lagrangian = m*dot(V, V)/(2*h);
    }
}

fn main() {}
