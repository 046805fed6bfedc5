//! A product of a 3 x 2 and a 3 x 3 matrix.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param B: Mat<3, 2>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h - h*tr(B*Ω*B);
    }
}

fn main() {}
