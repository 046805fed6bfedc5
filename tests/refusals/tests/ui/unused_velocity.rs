//! The Lagrangian contains no velocity.

clebsch::model! {
    model Top {
        param g, z: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3> = Λ^T*z;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -h*dot(g, Γ);
    }
}

fn main() {}
