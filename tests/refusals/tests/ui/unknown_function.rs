//! A misspelt function.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -trace(J*Ω)/h;
    }
}

fn main() {}
