//! An advected quantity under the name of a method of the model.

clebsch::model! {
    model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        advected energy: Vec<3>;
        constraint next(Λ) = Λ*Ω;
        constraint next(energy) = Ω^T*energy;
        lagrangian = -tr(J*Ω)/h - h*dot(energy, energy);
    }
}

fn main() {}
