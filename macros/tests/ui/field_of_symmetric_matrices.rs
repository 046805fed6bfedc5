//! Of matrices all entries vary.
use clebsch::model;

model! {
    model M {
        param k: Real;
        field S: Sym<3>;
        lagrangian = tr((next(S) - S)*(next(S) - S))/(2*h);
    }
}

fn main() {}
