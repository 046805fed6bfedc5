//! A compiled stepper needs the expressions of its functions.
use clebsch::model;

model! {
    model Bowl {
        param m: Real;
        given b(Vec<2>): Real = case;
        field X: Vec<2>;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - h*b(X);
    }
}

fn main() {}
