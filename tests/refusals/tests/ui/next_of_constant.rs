//! A constant is taken at the next node.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(next(J)*Ω)/h;
    }
}

fn main() {}
