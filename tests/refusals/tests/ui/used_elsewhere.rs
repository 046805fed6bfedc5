//! Code that uses a model with a mistake: the mistake is all that is reported.

clebsch::model! {
    pub model Top {
        param J: Sym<3>;
        group Λ: SO<3> velocity Ω;
        constraint next(Λ) = Λ*Ω;
        lagrangian = -tr(J*Q)/h;
    }
}

use clebsch::nalgebra::Matrix3;
use clebsch::{BodyMomentum, Rotation};

pub struct Experiment {
    pub model: Top,
    pub state: TopState<f64>,
    pub work: TopWorkspace<f64>,
}

pub fn start(initial: TopInitial) -> Result<Experiment, Box<dyn std::error::Error>> {
    let model = Top::new(TopParameters { J: Matrix3::identity() })?;
    let (state, work) = model.start(initial, 0.1)?;
    Ok(Experiment { model, state, work })
}

fn main() {
    let initial = TopInitial {
        Λ: Rotation::identity(),
        body_momentum: BodyMomentum(clebsch::nalgebra::Vector3::z()),
    };
    let Experiment { model, mut state, mut work } = start(initial).unwrap();
    model.step(&mut state, &mut work).unwrap();
    println!("{} {:?} {}", model.energy(&state), state.body_momentum(), Top::<f64>::CARD.name);
}
