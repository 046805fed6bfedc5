//! A constraint for a field, whose increments are free.

clebsch::model! {
    model Drift {
        param m: Real;
        param R: Mat<3>;
        field X: Vec<3>;
        let d = next(X) - X;
        constraint next(X) = R*X;
        lagrangian = m*dot(d, d)/(2*h);
    }
}

fn main() {}
