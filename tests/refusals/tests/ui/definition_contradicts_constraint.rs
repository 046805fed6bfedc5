//! Γ is defined by Λ, but its constraint requires Λ^T.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param g, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
    }
}

fn main() {}
