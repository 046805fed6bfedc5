//! An assumption about a quantity that moves.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param g: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        assume dot(Γ, Γ) == 1;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
    }
}

fn main() {}
