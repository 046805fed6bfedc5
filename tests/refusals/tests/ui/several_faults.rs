//! Every mistake is reported, not only the first, but no mistake that follows from another.

clebsch::model! {
    model Top {
        param J: Symm<3>;
        param g, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*Z;
        constraint next(Λ) = Λ*Omega;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
    }
}

fn main() {}
