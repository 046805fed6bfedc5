//! A label set belongs to rods.

clebsch::model! {
    model Top {
        param J: Sym<3> at nodes;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
