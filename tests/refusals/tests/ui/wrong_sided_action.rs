//! In a body model, the constraint advects Γ as a spatial model would.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param g: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
    }
}

fn main() {}
