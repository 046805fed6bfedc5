//! The reconstruction of Λ is missing.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
