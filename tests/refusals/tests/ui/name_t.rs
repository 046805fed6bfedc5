//! T is the transpose and no name.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param T: Real;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
