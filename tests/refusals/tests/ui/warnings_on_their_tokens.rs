//! A model that derives but is probably not intended causes a rustc warning on the tokens concerned; the lint is
//! denied here, so that the warning is an error.
#![deny(deprecated)]

clebsch::model! {
    model Forgotten {
        param J: Sym<3>;
        param gU, z: Vec<3>;
        param spare: Real;
        group R: SO<3> velocity V;
        advected Y: Vec<3> = R^T*z;
        constraint next(R) = R*V;
        constraint next(Y) = V^T*Y;
        lagrangian = -tr(J*V) - h*dot(gU, Y);
    }
}

fn main() {}
