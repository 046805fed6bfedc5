//! The reconstruction is not a product of element and velocity.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω^T;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
