//! Three dimensions have three unit vectors.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param gU: Vec<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Λ^T*E4);
    }
}

fn main() {}
