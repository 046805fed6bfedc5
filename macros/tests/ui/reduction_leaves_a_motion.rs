//! Two terms that change with the frame of space, each named.
use clebsch::model;

model! {
    model Body {
        param J, M: Sym<3>;
        param z: Vec<3>;
        group G: SE<3> velocity V;
        constraint next(G) = G*V;
        let v = pos(G^-1*next(G));
        lagrangian = -tr(J*rot(G)^T*rot(next(G)))/h + dot(v, M*v)/(2*h)
            - h*dot(z, pos(G)) - h*tr(rot(G)) + dot(z, pos(G))*tr(G);
    }
}

fn main() {}
