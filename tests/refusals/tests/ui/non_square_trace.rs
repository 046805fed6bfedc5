//! The trace of a matrix that is not square.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param B: Mat<3, 2>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - h*tr(Ω*B);
    }
}

fn main() {}
