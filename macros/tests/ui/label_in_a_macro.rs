//! A chain whose velocities are solved for together runs from its file.

clebsch::model! {
    model Chain {
        label i in 0..N;
        param m, k: Real;
        field q: Real at nodes;
        lagrangian = m*(next(q) - q)^2/(2*h) + (k/h)*(next(q) - q)*(next(next(q, i)) - next(q, i));
    }
}

fn main() {}
