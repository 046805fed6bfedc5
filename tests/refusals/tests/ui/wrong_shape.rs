//! An unknown shape.

clebsch::model! {
    model Top {
        param J: Symm<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
