//! A configuration under the name of a function of the state.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group node: SO<3> velocity Ω;
        constraint next(node) = node*Ω;
        lagrangian = -tr(J*Ω)/h;
    }
}

fn main() {}
