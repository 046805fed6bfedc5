//! A parenthesis that is closed only after the end of its statement: the compiler sees a matched pair.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param gU: Vec<3>;
        group Λ: SO<3> velocity Ω;
        advected Γ: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(Γ) = Ω^T*Γ;
        lagrangian = -tr(J*Ω)/h - h*dot(gU, Γ; let a = 2*(1 + h));
    }
}

fn main() {}
