//! The loops that are timed, as a user writes them: one call a step, each of which may refuse. Takes a model with its
//! initial values, or a motion; gives a closure for the clock, everything started outside it.

/// Steps a generated model from these initial values.
macro_rules! generated {
    ($model:expr, $initial:expr) => {{
        let model = $model.expect("parameters");
        let start = model.start($initial, clebsch_oracle::reference::H);
        let (state, workspace) = start.expect("solvable");
        move || {
            let whole = std::hint::black_box((model, state, workspace));
            let (model, mut state, mut workspace) = whole;
            for _ in 0..$crate::blocks::STEPS {
                model.step(&mut state, &mut workspace).expect("solvable");
            }
            std::hint::black_box((&state, &workspace));
        }
    }};
}

/// Steps a hand-written motion.
macro_rules! written {
    ($motion:expr) => {{
        let motion = $motion;
        move || {
            let mut motion = std::hint::black_box(motion);
            for _ in 0..$crate::blocks::STEPS {
                motion.step().expect("solvable");
            }
            std::hint::black_box(&motion);
        }
    }};
}

pub(crate) use {generated, written};
