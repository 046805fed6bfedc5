//! A size that is not declared.

clebsch::model! {
    model Top {
        param J: Sym<n>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
