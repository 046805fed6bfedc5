//! A vector with one component.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        param c: Vec<1>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
