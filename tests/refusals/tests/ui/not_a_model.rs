//! The macro without a model.

clebsch::model! {
    param J: Sym<3>;
}

fn main() {}
