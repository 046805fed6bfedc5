//! A misspelt parameter.

clebsch::model! {
    model Top {
        param inertia: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(inerta*Ω)/h;
    }
}

fn main() {}
