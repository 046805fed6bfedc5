//! The commands that run cases: `run`, `compare`, `converge`, `sweep` and `collect`.

use super::of_a_case::{of_a_case, planned};
use super::option::{flag, json, option, positive_number, seconds};
use super::shard::Shard;
use clap::{Arg, ArgAction, Command, value_parser};

pub(super) fn run() -> Command {
    let checkpoint = option(
        "checkpoint",
        "SECONDS",
        "Time between two checkpoints of a run with --out; --resume continues from the last checkpoint",
    );
    planned(
        Command::new("run")
            .about("Run a case and check its invariants")
            .after_help(
                "Examples:\n  clebsch run heavy-top\n  clebsch run free-body --order 6 --steps 1e6\n  \
                 clebsch run heavy-top --case my-top.toml --out out/my-top\n  \
                 clebsch run my-model.clebsch",
            ),
        "Record every N-th node and the last: check invariants and write samples there. By default at most 10000 nodes are \
         recorded, so that a long run spends little time on this",
        "Write trajectory.csv, trajectory.npz, run.json and plots into this new folder; if a step fails, they contain the \
         run up to that step",
    )
    .arg(
        flag(
            "resume",
            "Resume the interrupted or killed run in DIR, with bitwise identical results; start it if there is none",
        )
        .requires("out")
        .conflicts_with("force"),
    )
    .arg(
        flag(
            "paper",
            "Draw figures for one column of a paper: 86 mm wide, without titles, legends below; also as PDF if the command was \
             built with `--features pdf`",
        )
        .requires("out"),
    )
    .arg(
        flag(
            "csv",
            "Write trajectory.csv even if it has more than 500000 numbers; trajectory.npz always contains all numbers",
        )
        .requires("out"),
    )
    .arg(
        flag(
            "vtk",
            "Write ParaView files into DIR/vtk: lines, cells, particles, grids and bodies at every sample, at most about 1000 \
             unless you give --every",
        )
        .requires("out"),
    )
    .arg(flag("quiet", "Print only warnings and errors; the exit code shows how the run ended").conflicts_with_all(["json", "verbose"]))
    .arg(flag("verbose", "Print the derived equations and the solver of a step before the result").conflicts_with("json"))
    .arg(
        option(
            "stability-limit",
            "SECONDS",
            "Time limit of the search for the stability limit of the step size, which the run only reports; 0 disables the search",
        )
        .default_value("1")
        .value_parser(seconds),
    )
    .arg(
        option(
            "check",
            "STEPS",
            "Steps to check against the stated action, independently of the derivation and the stepper: a sample of a hundred \
             steps and the last step, all steps, or none",
        )
        .value_parser(["sample", "all", "none"])
        .default_value("sample"),
    )
    .arg(
        checkpoint
            .requires("out")
            .default_value("60")
            .value_parser(positive_number),
    )
}

pub(super) fn compare() -> Command {
    planned(
        Command::new("compare")
            .about(
                "Compare the generated stepper with a hand-written one and other methods on a case",
            )
            .after_help(
                "Examples:\n  clebsch compare free-body\n  clebsch compare heavy-top --steps 1000 --out out/compared",
            ),
        "Compare at every N-th node; by default at most 10000 nodes are compared",
        "Write comparison.csv, comparison.json and comparison.svg into this new folder",
    )
}

pub(super) fn converge() -> Command {
    of_a_case(
        Command::new("converge")
            .about("Measure the error at a fixed time for several step sizes, and the order of convergence")
            .after_help(
                "Examples:\n  clebsch converge kepler --until 10\n  clebsch converge my-model.clebsch --h 0.1 --until 1 --out out/converged",
            ),
    )
    .arg(
        option(
            "levels",
            "N",
            "Number of step sizes h, h/2, h/4, ..., from 3 to 16",
        )
        .default_value("6")
        .value_parser(value_parser!(u32).range(3..=16)),
    )
    .arg(
        option(
            "out",
            "DIR",
            "Write convergence.csv, convergence.json and convergence.svg into this new folder",
        )
        .value_parser(value_parser!(std::path::PathBuf)),
    )
    .arg(flag("force", "Replace DIR if it contains earlier results").requires("out"))
    .arg(json())
}

pub(super) fn sweep() -> Command {
    of_a_case(
        Command::new("sweep")
            .about("Run a case at every point of a parameter grid, on all cores, and write one table")
            .after_help(
                "Examples:\n  clebsch sweep heavy-top --vary gU.z=0:1:100 --out out/sweep\n  \
                 clebsch sweep heavy-top --vary gU.z=0:1:100 --vary h=0.1,0.05 --shard 3/16 --out out/part-3\n  \
                 clebsch collect out/part-* --out out/sweep",
            ),
    )
    .arg(
        option(
            "vary",
            "NAME=VALUES",
            "Parameter, initial value or step h, with its component, and its values as FROM:TO:COUNT or A,B,...; if you give \
             --vary several times, the last quantity varies fastest",
        )
        .action(ArgAction::Append)
        .required(true),
    )
    .arg(
        option(
            "shard",
            "PART/OF",
            "Compute only this part of the points; `clebsch collect` joins the parts",
        )
        .value_parser(Shard::read),
    )
    .arg(
        option(
            "out",
            "DIR",
            "Write sweep.csv, sweep.npz and sweep.json into this new folder",
        )
        .required(true)
        .value_parser(value_parser!(std::path::PathBuf)),
    )
    .arg(
        flag(
            "resume",
            "Resume the interrupted or killed sweep in DIR; start it if there is none",
        )
        .conflicts_with("force"),
    )
    .arg(flag("force", "Replace DIR if it contains an earlier sweep"))
    .arg(json())
}

pub(super) fn collect() -> Command {
    Command::new("collect")
        .about("Join the parts of a sweep into one table")
        .after_help("Examples:\n  clebsch collect out/part-* --out out/sweep")
        .arg(
            Arg::new("parts")
                .value_name("PART")
                .required(true)
                .action(ArgAction::Append)
                .num_args(1..)
                .value_parser(value_parser!(std::path::PathBuf))
                .help("Folders of all parts, in any order"),
        )
        .arg(
            option("out", "DIR", "Write the table into this new folder")
                .required(true)
                .value_parser(value_parser!(std::path::PathBuf)),
        )
        .arg(flag("force", "Replace DIR if it contains an earlier sweep"))
        .arg(json())
}
