//! The smaller size of a range comes first.

clebsch::model! {
    model Body {
        dim n in 8..=3;
        param J: Sym<n>;
        group Λ: SO<n> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
