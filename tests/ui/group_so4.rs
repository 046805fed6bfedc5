//! A group with equations but without a stepper.

clebsch::model! {
    model Top {
        param J: Sym<4>;
        group Λ: SO<4> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
