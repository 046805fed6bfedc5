//! One name for the index of the nodes and for the step.

clebsch::model! {
    model Top {
        time k step k;
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/k;
    }
}

fn main() {}
