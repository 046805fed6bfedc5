//! Rigid motions of four dimensions are not in the table of groups.

clebsch::model! {
    model Body {
        param m: Real;
        group G: SE<4> velocity V;
        constraint next(G) = G*V;
        lagrangian = m*dot(pos(V), pos(V))/(2*h);
    }
}

fn main() {}
