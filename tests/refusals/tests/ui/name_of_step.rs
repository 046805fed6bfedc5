//! The time step is a name of Rust.

clebsch::model! {
    model Top {
        time k step loop;
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Ω)/loop;
    }
}

fn main() {}
