//! A name that is a Rust keyword.

clebsch::model! {
    model Top {
        param type: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(type*Ω)/h;
    }
}

fn main() {}
