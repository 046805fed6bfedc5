//! A model in which nothing moves.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        lagrangian = -tr(J)/h;
    }
}

fn main() {}
