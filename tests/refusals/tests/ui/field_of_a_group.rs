//! A rotation is no value that is added: rotations are configurations of their own.
use clebsch::model;

model! {
    model M {
        param m: Real;
        field X: SO<3>;
        lagrangian = m*tr(X^T*next(X))/h;
    }
}

fn main() {}
