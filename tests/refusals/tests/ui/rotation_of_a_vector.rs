//! The rotation of a vector of the plane, where that of the velocity is meant.

clebsch::model! {
    model Body {
        param J: Sym<2>;
        param u: Vec<2>;
        group G: SE<2> velocity V;
        constraint next(G) = G*V;
        lagrangian = -tr(J*rot(u))/h;
    }
}

fn main() {}
