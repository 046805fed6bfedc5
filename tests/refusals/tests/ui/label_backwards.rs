//! A label counts up from 0.

clebsch::model! {
    model Chain {
        label i in 5..0;
        param m: Real;
        field y: Real at i;
        lagrangian = m*(next(y) - y)^2/(2*h);
    }
}

fn main() {}
