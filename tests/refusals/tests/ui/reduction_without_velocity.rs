//! The second body has no kinetic energy.
use clebsch::model;

model! {
    model Bodies {
        param J: Sym<3>;
        param d, z: Vec<3>;
        group A: SO<3> velocity a;
        group B: SO<3> velocity b;
        constraint next(A) = A*a;
        constraint next(B) = B*b;
        lagrangian = -tr(J*A^T*next(A))/h - h*dot(z, next(B)*d);
    }
}

fn main() {}
