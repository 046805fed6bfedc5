//! The independent entries are counted, so their number must be known.
use clebsch::model;

model! {
    model M {
        dim n in 2..=4;
        param k: Real;
        field S: Sym<n>;
        lagrangian = tr((next(S) - S)*(next(S) - S))/(2*h);
    }
}

fn main() {}
