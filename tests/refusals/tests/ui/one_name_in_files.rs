//! Two names that become equal if Greek letters are spelt out.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param Γ, Gamma: Vec<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
