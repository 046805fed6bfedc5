//! A chain of rigid motions runs from its file.

clebsch::model! {
    model Chain {
        label i in 0..N;
        param J: Sym<3>;
        param m, c: Real;
        group G: SE<3> at nodes velocity V;
        constraint next(G) = G*V;
        let d = pos(next(G, i)) - pos(G);
        lagrangian = -tr(J*rot(V))/h + m*dot(pos(V), pos(V))/(2*h) - h*c*dot(d, d)/2;
    }
}

fn main() {}
