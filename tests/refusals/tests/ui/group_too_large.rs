//! A group with equations but without a stepper.

clebsch::model! {
    model Top {
        param J: Sym<9>;
        group Λ: SO<9> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
