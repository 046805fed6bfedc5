//! The commands that differentiate a case: `gradient`, `linearise`,
//! `equilibrium`, `orbit`, `section`, `lyapunov` and
//! `fit`. Takes nothing; gives their clap commands.

use super::of_a_case::of_a_case;
use super::option::{flag, json, option, positive_count, positive_number};
use clap::{Command, value_parser};

/// Adds the arguments of every command that analyses a case.
fn analysed(command: Command, out: &'static str) -> Command {
    of_a_case(command)
        .arg(option("out", "DIR", out).value_parser(value_parser!(std::path::PathBuf)))
        .arg(flag("force", "Replace DIR if it contains earlier results").requires("out"))
        .arg(json())
}

pub(super) fn gradient() -> Command {
    analysed(
        Command::new("gradient")
            .about("Differentiate an observed quantity at the end of a run in all parameters, initial values and the step size")
            .long_about(
                "Differentiate an observed quantity at the end of a run in all parameters, initial values and the step size.\n\n\
                 The derivatives are exact derivatives of the discrete motion, by the adjoint method. Rotations are turned about \
                 their body axes; `turn_1(Lambda)` is such an angle. Momenta are held fixed while parameters change.",
            )
            .after_help(
                "Examples:\n  clebsch gradient kepler --of 'X[1]' --steps 500\n  clebsch gradient heavy-top --of 'Lambda[3,3]^2' \
                 --until 10\n  clebsch gradient heavy-top --of energy --sum --out out/gradient",
            ),
        "Write gradient.csv and gradient.json into this new folder",
    )
    .arg(
        option(
            "of",
            "EXPR",
            "Quantity: + - * / ^ and functions of observables and invariants, such as 'X[1]^2 + X[2]^2' or energy. Components \
             count from 1; q[3] is site 3 of a chain",
        )
        .required(true),
    )
    .arg(flag("sum", "Differentiate the sum over all nodes instead of the value at the end"))
}

pub(super) fn section() -> Command {
    analysed(
        Command::new("section")
            .about("Find where a motion crosses a surface, to rounding, and plot a section")
            .long_about(
                "Find where a motion crosses a surface, to rounding, and plot a section.\n\n\
                 A crossing within a step is a state after a shorter step from the node before. Two crossings within one step \
                 are not seen: use a smaller step size.",
            )
            .after_help(
                "Examples:\n  clebsch section kepler:eccentric --at 'X[2]' --up --count 20\n  clebsch section heavy-top:general \
                 --at 'body_momentum[1]' --down --plot 'Gamma[1],Gamma[2]' --out out/section",
            ),
        "Write section.csv, section.json and section.svg into this new folder",
    )
    .arg(
        option(
            "at",
            "EXPR",
            "Surface: where this quantity is zero, such as 'X[2]' or 'Gamma[3] - 0.5'; see `clebsch gradient --help`",
        )
        .required(true),
    )
    .arg(flag("up", "Only crossings from negative to positive values").conflicts_with("down"))
    .arg(flag("down", "Only crossings from positive to negative values"))
    .arg(
        option("count", "N", "Number of crossings; the run ends there, or after its steps")
            .default_value("100")
            .value_parser(positive_count),
    )
    .arg(option(
        "plot",
        "X,Y",
        "Two quantities of the plot; by default the first two initial values that vary over the section",
    ))
}

pub(super) fn lyapunov() -> Command {
    analysed(
        Command::new("lyapunov")
            .about("Compute the largest Lyapunov exponents of a motion, with errors")
            .long_about(
                "Compute the largest Lyapunov exponents of a motion, with errors.\n\n\
                 The tangents of all steps act on an orthonormal frame. Exponents of a regular motion fall towards zero like \
                 log(t)/t; take more steps to tell a small exponent from zero.",
            )
            .after_help(
                "Examples:\n  clebsch lyapunov heavy-top:general --steps 2e4\n  clebsch lyapunov kepler --count 6 --out \
                 out/lyapunov",
            ),
        "Write lyapunov.csv, lyapunov.json and lyapunov.svg into this new folder",
    )
    .arg(
        option("count", "N", "Number of exponents, by default one")
            .default_value("1")
            .value_parser(positive_count),
    )
}

pub(super) fn linearise() -> Command {
    analysed(
        Command::new("linearise")
            .about("Find the frequencies, modes and stability of a case at rest")
            .long_about(
                "Find the frequencies, modes and stability of a case at rest.\n\n\
                 If a step moves the state of the case, Newton's method searches for a fixed point of the step nearby. The table \
                 shows the modes of the step, and of the continuous system by extrapolation to small steps.",
            )
            .after_help(
                "Examples:\n  clebsch linearise toda-chain --out out/modes\n  clebsch linearise my-chain.clebsch:at-rest",
            ),
        "Write linearise.csv, linearise.json and, for chains, modes.svg into this new folder",
    )
}

pub(super) fn equilibrium() -> Command {
    analysed(
        Command::new("equilibrium")
            .about("Find a critical point of the energy at fixed conserved quantities, with its stability")
            .long_about(
                "Find a critical point of the energy at fixed conserved quantities, with its stability.\n\n\
                 Critical points at fixed momenta are steady motions, such as a steadily spinning top. With --continue, the branch \
                 of critical points is followed over a parameter, through folds. Derivatives in this parameter are central \
                 differences; all others are exact.",
            )
            .after_help(
                "Examples:\n  clebsch equilibrium free-body:steady-rotation\n  clebsch equilibrium my-model.clebsch --fix none\n  \
                 clebsch equilibrium heavy-top --continue gU.3=0.2:1 --out out/branch",
            ),
        "Write equilibrium.json and, with --continue, branch.csv and branch.svg into this new folder",
    )
    .arg(option(
        "fix",
        "NAME,...",
        "Fixed quantities: invariants such as spatial_momentum or spatial_momentum.3, initial values such as body_momentum.3, all \
         (exact invariants) or none. By default the independent exact invariants that are not zero",
    ))
    .arg(option(
        "continue",
        "NAME=FROM:TO",
        "Follow the branch of critical points over this parameter",
    ))
}

pub(super) fn orbit() -> Command {
    of_a_case(
        Command::new("orbit")
            .about("Find a periodic orbit near the state of a case, with its stability")
            .long_about(
                "Find a periodic orbit near the state of a case, with its stability.\n\n\
                 The step size becomes the period divided by the number of steps, which is nearest to the step size of the case \
                 unless you give --steps.",
            )
            .after_help(
                "Examples:\n  clebsch orbit kepler --period 2*pi\n  clebsch orbit kepler --period 2*pi --steps 600 \
                 --write-case orbit.toml",
            ),
    )
    .arg(
        option("period", "T", "Period of the orbit, such as 6.5 or 2*pi")
            .required(true)
            .value_parser(positive_number),
    )
    .arg(
        option("write-case", "FILE.toml", "Write a case file that starts on the orbit")
            .value_parser(value_parser!(std::path::PathBuf)),
    )
    .arg(json())
}

pub(super) fn fit() -> Command {
    analysed(
        Command::new("fit")
            .about("Fit parameters and initial values of a case to data, with standard errors")
            .long_about(
                "Fit parameters and initial values of a case to data, with standard errors.\n\n\
                 The sum of squares of all differences is minimised by the method of Levenberg and Marquardt with exact \
                 derivatives. The start is the case. All data have the same weight, and momenta are held fixed unless you vary \
                 them.",
            )
            .after_help(
                "Examples:\n  clebsch fit kepler --data orbit.csv --vary k,initial:momentum\n  clebsch fit heavy-top --data top.csv \
                 --vary J.11,J.22,initial:body_momentum --columns Gamma_1,Gamma_3 --out out/fit",
            ),
        "Write fit.csv, fit.json and fit.svg into this new folder",
    )
    .arg(
        option(
            "data",
            "FILE",
            "CSV or npz file with a column `t` or `time` and columns named as in trajectory.csv; empty cells have no data",
        )
        .required(true)
        .value_parser(value_parser!(std::path::PathBuf)),
    )
    .arg(
        option(
            "vary",
            "NAME,...",
            "Parameters such as k or J.11, and initial values such as initial:momentum",
        )
        .required(true),
    )
    .arg(option("columns", "NAME,...", "Columns of the data to use, by default all"))
}
