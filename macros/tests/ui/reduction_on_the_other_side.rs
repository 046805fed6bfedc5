//! Distances along the axes of space, with a velocity in space: the moments would have to move.
use clebsch::model;

model! {
    model Body {
        param S: Sym<3>;
        group Λ: SO<3> velocity ω;
        constraint next(Λ) = ω*Λ;
        lagrangian = -tr(S*next(Λ)*Λ^T)/h - h*tr(Λ*Λ*S);
    }
}

fn main() {}
