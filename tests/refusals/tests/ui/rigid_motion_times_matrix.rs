//! A 3 x 3 matrix times an element of SE(3), which is 4 x 4; its rotation is `rot(Ω)`.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SE<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
