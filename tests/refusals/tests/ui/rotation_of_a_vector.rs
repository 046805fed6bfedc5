//! The rotation of a vector in the plane instead of the rotation of the velocity.

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
