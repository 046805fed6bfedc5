//! Circular definitions.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param gU: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        let height = dot(gU, Γ) + weight;
        let weight = 2*height;
        lagrangian = -tr(J*Ω)/h - h*weight;
    }
}

fn main() {}
