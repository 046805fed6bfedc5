//! The timed loops, as a user would write them, with one fallible call per step. Takes a model with its initial values, or a
//! motion; gives a closure to time. Initialisation is outside the measured time.

/// Steps a generated model from these initial values, with the reference step size or another one.
macro_rules! generated {
    ($model:expr, $initial:expr) => {
        $crate::loops::generated!($model, $initial, clebsch_oracle::reference::H)
    };
    ($model:expr, $initial:expr, $h:expr) => {{
        let model = $model.expect("parameters");
        let start = model.start($initial, $h);
        let (state, workspace) = start.expect("solvable");
        let counted = $crate::operation_counts::work_of(&model, &state, $h);
        let work = counted.expect("solvable");
        let run = move || {
            let whole = std::hint::black_box((model, state, workspace));
            let (model, mut state, mut workspace) = whole;
            for _ in 0..$crate::blocks::STEPS {
                model.step(&mut state, &mut workspace).expect("solvable");
            }
            std::hint::black_box((&state, &workspace));
        };
        $crate::operation_counts::Block { work, run }
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
