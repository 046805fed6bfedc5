//! A number and a matrix are added.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param c: Real;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr((c + J)*Ω)/h;
    }
}

fn main() {}
