//! A chain runs from its file.

clebsch::model! {
    model Tops {
        label i in 0..N;
        param J, C: Sym<3>;
        group Λ: SO<3> at nodes velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h + h*tr(C*Λ^T*next(Λ, i));
    }
}

fn main() {}
