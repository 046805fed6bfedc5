//! Division by a matrix.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param K: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(Ω/(J + K))/h;
    }
}

fn main() {}
