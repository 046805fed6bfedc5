//! Two constraints for one quantity.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        constraint next(Λ) = Ω*Λ;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
