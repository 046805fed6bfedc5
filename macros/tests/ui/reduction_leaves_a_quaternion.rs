//! The real part of a quaternion changes with the frame of space.
use clebsch::model;

model! {
    model Body {
        param I: Diag<3>;
        group q: SU<2> velocity W;
        constraint next(q) = q*W;
        let w = im(q^T*next(q));
        lagrangian = (2/h)*dot(w, I*w) - h*re(q);
    }
}

fn main() {}
