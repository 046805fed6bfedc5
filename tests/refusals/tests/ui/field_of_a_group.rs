//! Rotations cannot be added: a rotation is a configuration in a group.
use clebsch::model;

model! {
    model M {
        param m: Real;
        field X: SO<3>;
        lagrangian = m*tr(X^T*next(X))/h;
    }
}

fn main() {}
