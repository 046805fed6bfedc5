//! A `let` after its use.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -W/h;
        let W = tr(J*Ω);
    }
}

fn main() {}
