//! A mistake in a `let` is reported once, not again where it is used.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        let W = tr(J*Q);
        lagrangian = -W/h;
    }
}

fn main() {}
