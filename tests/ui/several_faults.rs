//! Every mistake is reported, not only the first.

clebsch::model! {
    model Top {
        param J: Symm<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Q;
        lagrangian = -Tr(J*Ω)/k;
    }
}

fn main() {}
