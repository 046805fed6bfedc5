//! A chain of unit quaternions runs from its file.

clebsch::model! {
    model Chain {
        label i in 0..N;
        param c, w: Real;
        group q: SU<2> at nodes velocity v;
        constraint next(q) = q*v;
        lagrangian = -2*w*re(v)/h - h*c*re(q^T*next(q, i));
    }
}

fn main() {}
