//! A chain of bodies with spatial velocities runs only from its file.

clebsch::model! {
    model Chain {
        label i in 0..N;
        param J: Sym<3>;
        param c: Real;
        group R: SO<3> at nodes velocity w;
        constraint next(R) = w*R;
        lagrangian = -tr(J*R^T*next(R))/h + h*c*tr(R^T*next(R, i));
    }
}

fn main() {}
