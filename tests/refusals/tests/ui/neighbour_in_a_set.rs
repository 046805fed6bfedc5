//! Members of a set have no neighbours.

clebsch::model! {
    model Points {
        label a in 0..N;
        param m: Real at a;
        field X: Vec<2> at a;
        lagrangian = m*dot(next(X) - X, next(X) - X)/(2*h) - h*dot(X, next(X, a));
    }
}

fn main() {}
