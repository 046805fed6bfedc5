//! A matrix of n rows is not a number.

clebsch::model! {
    model Body {
        dim n in 3..=8;
        param A: Mat<n>;
        field y: Real;
        lagrangian = A*(next(y) - y)^2/(2*h);
    }
}

fn main() {}
