//! No Lagrangian.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
    }
}

fn main() {}
