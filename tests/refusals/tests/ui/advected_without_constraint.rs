//! Γ lacks an evolution constraint.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param g: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - h*dot(g, Γ);
    }
}

fn main() {}
