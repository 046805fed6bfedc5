//! A quantity cannot have the name of a function.

clebsch::model! {
    model Top {
        param det: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(Ω)/h;
    }
}

fn main() {}
