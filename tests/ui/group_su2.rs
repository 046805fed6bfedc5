//! A group that is not in the table.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SU<2> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
