//! A name that Rust keeps for itself.

clebsch::model! {
    model Top {
        param type: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(type*Ω)/h;
    }
}

fn main() {}
