//! A 3 x 3 matrix times an element of SU(2), which acts as a 4 x 4 matrix; its rotation is `rot(Ω)`.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SU<2> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
