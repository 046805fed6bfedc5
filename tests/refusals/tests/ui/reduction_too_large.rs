//! More words than the reduction can process.
use clebsch::model;

model! {
    model Top {
        param J: Sym<3>;
        param A, B, C, D: Mat<3>;
        param g, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Λ^T*next(Λ))/h - h*dot(z, (A + B + C + D)^8*Λ*g);
    }
}

fn main() {}
