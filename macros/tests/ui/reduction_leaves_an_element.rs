//! A term in which no parameter takes up the attitude; the others are left in peace.
use clebsch::model;

model! {
    model Top {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Λ^T*next(Λ))/h - h*dot(z, Λ*gU) - h*tr(Λ);
    }
}

fn main() {}
