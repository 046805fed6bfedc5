//! The command line: subcommands, options and the checks that need no model.
//! Takes the width of the terminal; gives the clap command, whose matches the commands read.

use clap::builder::PossibleValue;
use clap::{Arg, ArgAction, Command, value_parser};
use clebsch::validate::positive_step;

/// Help is made no wider than this: longer lines are hard to read.
const WIDEST: usize = 100;

/// The whole command line; help fits `width` letters where that is given.
#[must_use]
pub fn command(width: Option<usize>) -> Command {
    Command::new("clebsch")
        .term_width(width.unwrap_or(WIDEST).min(WIDEST))
        .version(env!("CARGO_PKG_VERSION"))
        .about(
            "Discrete Clebsch variational integrators: derived from a Lagrangian, run from a case",
        )
        .after_help(
            "Examples:\n  clebsch list\n  clebsch run heavy-top\n  clebsch derive heavy-top\n  clebsch new my-model\n\n\
             Exit codes: 0 done, 1 failed, 2 usage, 3 an invariant exceeded the bound of its case \
             (results are written). A sweep ends with 1 if a point was refused or stopped before its end, else with 3 if an \
             invariant of a point exceeded its bound; its table is written.",
        )
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(
            Command::new("list")
                .about("List the models, or the cases of one model")
                .after_help(
                    "Examples:\n  clebsch list\n  clebsch list chain\n  clebsch list toda-chain\n  clebsch list --json",
                )
                .arg(Arg::new("which").value_name("FAMILY|MODEL").help(
                    "Family of models (rigid, particle, elastic, chain, fluid), or a model",
                ))
                .arg(json()),
        )
        .subcommand(
            Command::new("show")
                .about("Print the statement of a model and a case of it")
                .after_help("Examples:\n  clebsch show toda-chain\n  clebsch show heavy-top:general")
                .arg(model())
                .arg(shown_case()),
        )
        .subcommand(
            Command::new("case")
                .about("Print a complete case as TOML, to start your own from")
                .after_help(
                    "Examples:\n  clebsch case heavy-top > my-top.toml\n  clebsch case heavy-top:general\n  \
                     clebsch case my-model.clebsch > my-model.toml",
                )
                .arg(model())
                .arg(shown_case()),
        )
        .subcommand(
            Command::new("new")
                .about("Write a model and a case of your own, NAME.clebsch and NAME.toml, to start from")
                .after_help("Examples:\n  clebsch new my-model\n  clebsch new my-chain --from toda-chain:soliton")
                .arg(
                    Arg::new("name")
                        .value_name("NAME")
                        .required(true)
                        .help("Name of the model, such as my-top; files that exist are never replaced"),
                )
                .arg(option(
                    "from",
                    "MODEL[:CASE]",
                    "Model to copy; two masses on a spring by default",
                )),
        )
        .subcommand(
            of_a_case(Command::new("check"))
                .about("Derive a model, read its case and take one step, without a run")
                .after_help("Examples:\n  clebsch check my-model.clebsch"),
        )
        .subcommand(run())
        .subcommand(sweep())
        .subcommand(collect())
        .subcommand(compare())
        .subcommand(converge())
        .subcommand(plot())
        .subcommand(figures())
        .subcommand(derive())
}

fn run() -> Command {
    let checkpoint = option(
        "checkpoint",
        "SECONDS",
        "Write a checkpoint every so many seconds of a run with --out, from which --resume goes on",
    );
    planned(
        Command::new("run")
            .about("Run a case and check what it conserves")
            .after_help(
                "Examples:\n  clebsch run heavy-top\n  clebsch run free-body --order 6 --steps 1e6\n  \
                 clebsch run heavy-top --case my-top.toml --out out/my-top\n  \
                 clebsch run my-model.clebsch",
            ),
        "Look at every N-th node and the last: invariants are checked and samples are written there. The default looks at \
         10000 nodes at most, so that looking takes less time than a long run",
        "Write trajectory.csv, trajectory.npz, run.json and plots into this new folder; when a step \
         fails, those of the run up to there, which run.json and the plots say",
    )
    .arg(
        flag(
            "resume",
            "Go on with the run into DIR that was interrupted or killed, to the same results to the last \
             bit; begin it where there is none",
        )
        .requires("out")
        .conflicts_with("force"),
    )
    .arg(
        flag(
            "paper",
            "Draw pictures for a column of a paper: 86 mm wide, without titles, legends below; as PDF beside SVG \
             where the command is built with `--features pdf`",
        )
        .requires("out"),
    )
    .arg(
        flag(
            "csv",
            "Write trajectory.csv even if it is long; without it, only of at most 500000 numbers (trajectory.npz has all)",
        )
        .requires("out"),
    )
    .arg(
        flag(
            "vtk",
            "Write files for ParaView into DIR/vtk: lines, cells, particles, grids and bodies at every sample, at \
             most about 1000 unless --every says how many",
        )
        .requires("out"),
    )
    .arg(flag("quiet", "Print warnings and errors only; the exit code says how the run ended").conflicts_with_all(["json", "verbose"]))
    .arg(flag("verbose", "Print what was derived, and how steps are solved, before the result").conflicts_with("json"))
    .arg(
        option(
            "stability-limit",
            "SECONDS",
            "Search at most this long for the stability limit of the step size, which is only reported; 0 skips the search",
        )
        .default_value("1")
        .value_parser(seconds),
    )
    .arg(
        option(
            "check",
            "STEPS",
            "Which steps are judged by the action as stated, independently of derivation and program: a sample of a \
             hundred and the last, all, or none",
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

fn compare() -> Command {
    planned(
        Command::new("compare")
            .about(
                "Run a case by the generated stepper, the hand-written one and other methods, side \
                 by side",
            )
            .after_help(
                "Examples:\n  clebsch compare free-body\n  clebsch compare heavy-top --steps 1000 --out out/compared",
            ),
        "Compare at every N-th node; by default such that at most 10000 are compared",
        "Write comparison.csv, comparison.json and comparison.svg into this new folder",
    )
}

fn converge() -> Command {
    of_a_case(
        Command::new("converge")
            .about("Measure the error at a fixed time against the step size, and the order")
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
    .arg(flag("force", "Replace DIR when it holds earlier results").requires("out"))
    .arg(json())
}

fn plot() -> Command {
    Command::new("plot")
        .about("Draw columns of a finished run, against time or against each other")
        .after_help(
            "Examples:\n  clebsch plot out/kepler\n  clebsch plot out/kepler --x X.1 --y X.2\n  \
             clebsch plot out/kepler --y X --y invariant_energy --from 100 --to 120",
        )
        .arg(
            Arg::new("dir")
                .value_name("DIR")
                .required(true)
                .value_parser(value_parser!(std::path::PathBuf))
                .help("Folder that `clebsch run --out` wrote"),
        )
        .arg(
            option(
                "x",
                "NAME",
                "Column along the horizontal axis; time by default. Give one for all, or one for each --y, as for the orbits of two bodies",
            )
            .action(ArgAction::Append),
        )
        .arg(
            option(
                "y",
                "NAME",
                "Column to draw, such as X.1, X (all components) or q_3 (site 3 of a chain); a list with commas, or repeated. \
                 Without it the columns are listed",
            )
            .action(ArgAction::Append),
        )
        .arg(option("from", "T", "First time to draw").value_parser(value_parser!(f64)))
        .arg(option("to", "T", "Last time to draw").value_parser(value_parser!(f64)))
        .arg(
            option("out", "FILE", "SVG to write; by default into DIR, named by its columns")
                .value_parser(value_parser!(std::path::PathBuf)),
        )
        .arg(flag("force", "Replace FILE even if it is not a picture of this command"))
}

fn figures() -> Command {
    Command::new("figures")
        .about("Draw the figures of the thesis's second chapter, and of the body of its third, from named cases")
        .after_help("Examples:\n  clebsch figures --out out/figures")
        .arg(
            option(
                "out",
                "DIR",
                "Write one SVG per figure into this new folder",
            )
            .required(true)
            .value_parser(value_parser!(std::path::PathBuf)),
        )
        .arg(flag("force", "Replace DIR when it holds earlier figures"))
        .arg(json())
}

/// What every command that runs a case once takes.
fn planned(command: Command, every: &'static str, out: &'static str) -> Command {
    of_a_case(command)
        .arg(option("every", "N", every).value_parser(positive_count))
        .arg(option("out", "DIR", out).value_parser(value_parser!(std::path::PathBuf)))
        .arg(flag("force", "Replace DIR when it holds an earlier run").requires("out"))
        .arg(json())
}

fn sweep() -> Command {
    of_a_case(
        Command::new("sweep")
            .about("Run a case at every point of a grid, on all cores, into one table")
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
            "Parameter, initial value or step h, with its component, and its values as FROM:TO:COUNT or \
             A,B,...; of several the last varies fastest",
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
        .value_parser(crate::sweep::Shard::read),
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
            "Go on with the sweep into DIR that was interrupted or killed; begin it where there is none",
        )
        .conflicts_with("force"),
    )
    .arg(flag("force", "Replace DIR when it holds an earlier sweep"))
    .arg(json())
}

fn collect() -> Command {
    Command::new("collect")
        .about("Join the parts of a sweep to the table of the whole")
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
        .arg(flag("force", "Replace DIR when it holds an earlier sweep"))
        .arg(json())
}

/// The case that `show` and `case` print.
fn shown_case() -> Arg {
    option(
        "case",
        "NAME",
        "Case to print; the first one by default, and placeholder values for a model file",
    )
}

/// What says which case is run, and how.
fn of_a_case(command: Command) -> Command {
    command
        .arg(model())
        .arg(option(
            "case",
            "NAME|FILE.toml",
            "Case of the model, or a file ending in .toml. The default is the model's first case, and M.toml for a model \
             file M.clebsch; a NAME is then the case M/NAME.toml. MODEL:NAME does the same",
        ))
        .arg(
            option(
                "steps",
                "N",
                "Number of steps instead of the case's, such as 20000 or 2e4",
            )
            .value_parser(positive_count),
        )
        .arg(
            option(
                "until",
                "T",
                "Time to run to, instead of a number of steps; the run ends at the node nearest to it",
            )
            .conflicts_with("steps")
            .value_parser(positive_number),
        )
        .arg(
            option(
                "set",
                "NAME=VALUE",
                "Parameter or initial value instead of the case's: a number, a component, or what a case file takes, such as gU.z=0.5, gU=[0,0,1], R.angle=1 or 'R={axis=[0,0,1], angle=1}'; may be repeated",
            )
            .action(ArgAction::Append),
        )
        .arg(
            option(
                "h",
                "H",
                "Step size instead of the case's, in its unit of time",
            )
            .value_parser(step_size),
        )
        .arg(
            option(
                "order",
                "N",
                "Order of accuracy of a step, where the model offers more than one: 2 to 10 for a \
                 free body, 2 to 8 for other reversible steps",
            )
            .value_parser(order_number),
        )
        .arg(flag(
            "compensated",
            "Make steps of order 4, 6 or 8 of a free body symplectic with the attitude, by a \
             constant turn about the momentum",
        ))
        .arg(option(
            "solver",
            "NAME",
            "Solver of the implicit step instead of the model's own, where it offers several",
        ))
        .arg(flag(
            "halve",
            "Make a step that is refused by two, four, ... steps of a part of its length; the result says how many \
             were, and is no longer symplectic",
        ))
        .arg(
            option(
                "dim",
                "N",
                "Size of the matrices, for a model of any size: its first case of that size, or the \
                 size of the case file",
            )
            .value_parser(positive_count),
        )
}

fn derive() -> Command {
    Command::new("derive")
        .about("Derive the equations of a model")
        .after_help(
            "Examples:\n  clebsch derive heavy-top\n  clebsch derive heavy-top --format latex > top.tex\n  \
             clebsch derive my-top.clebsch --explain\n  clebsch derive - < my-top.clebsch",
        )
        .arg(
            Arg::new("model")
                .value_name("MODEL|FILE")
                .required_unless_present("write")
                .help(
                    "Model of the gallery, or a file that holds a model's text; - for standard input",
                ),
        )
        .arg(
            option("format", "FORMAT", "What to print")
                .value_parser([
                    PossibleValue::new("text").alias("txt"),
                    PossibleValue::new("latex").alias("tex"),
                    PossibleValue::new("markdown").alias("md"),
                    PossibleValue::new("rust").alias("rs"),
                    PossibleValue::new("json"),
                ])
                .default_value("text"),
        )
        .arg(flag(
            "explain",
            "Show why each step of the derivation holds",
        ))
        .arg(flag(
            "second-proof",
            "Prove each step a second time, by equality saturation, which takes longer",
        ))
        .arg(flag(
            "no-thesis",
            "Leave out where the equations stand in Dixon's thesis",
        ))
        .arg(flag(
            "standalone",
            "Print a LaTeX document that compiles by itself, with its bibliography",
        ))
        .arg(flag(
            "write",
            "Write the derivations of all models of the gallery to generated/",
        ))
}

fn model() -> Arg {
    Arg::new("model")
        .value_name("MODEL")
        .required(true)
        .help("Model as `clebsch list` shows it, MODEL:CASE, or a model file")
}

fn json() -> Arg {
    flag(
        "json",
        "Print one JSON object and nothing else on standard output",
    )
}

fn flag(name: &'static str, help: &'static str) -> Arg {
    Arg::new(name)
        .long(name)
        .action(ArgAction::SetTrue)
        .help(help)
}

/// Negative numbers reach the value's own check, whose message says what is wrong with them.
fn option(name: &'static str, value: &'static str, help: &'static str) -> Arg {
    Arg::new(name)
        .long(name)
        .value_name(value)
        .allow_negative_numbers(true)
        .help(help)
}

fn positive_count(text: &str) -> Result<u64, String> {
    match whole(text) {
        Some(count) if count > 0 => Ok(count),
        _ => Err(format!(
            "give a whole number, such as 20000 or 2e4, at least 1 and at most {}",
            u64::MAX
        )),
    }
}

/// Above this a number of type f64 may stand for another whole one.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// A whole number in digits, or as `2e4` and `1.5e3`, up to where that is exact.
pub(crate) fn whole(text: &str) -> Option<u64> {
    if let Ok(count) = text.parse::<u64>() {
        return Some(count);
    }
    let number = text.parse::<f64>().ok()?;
    // A whole number of this size is converted without loss.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)]
    ((0.0..=EXACT).contains(&number) && number.fract() == 0.0).then_some(number as u64)
}

/// Which orders there are depends on the model, whose message lists them.
fn order_number(text: &str) -> Result<u32, String> {
    let order = text.parse::<u32>();
    order.map_err(|_| "give a whole number: 2, 4, 6, 8, or 10 for a free body".to_owned())
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number >= 0.0 => Ok(number),
        _ => Err("give a finite number that is not negative".to_owned()),
    }
}

fn positive_number(text: &str) -> Result<f64, String> {
    match crate::number::value(text, &|_| None) {
        Ok(number) if number > 0.0 => Ok(number),
        _ => Err("give a positive, finite number, such as 0.01, 1/100 or 2*pi".to_owned()),
    }
}

/// A step size, as a case has it.
fn step_size(text: &str) -> Result<f64, String> {
    let number = crate::number::value(text, &|_| None);
    let number = number.map_err(|_| "give a positive, finite number".to_owned())?;
    match positive_step(number) {
        Ok(()) => Ok(number),
        Err(error) => Err(error.remedy.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::whole;

    #[test]
    fn clap_finds_no_contradiction() {
        super::command(None).debug_assert();
    }

    #[test]
    fn whole_numbers_may_have_an_exponent() {
        for (text, number) in [
            ("0", 0),
            ("1e6", 1_000_000),
            ("1.5e3", 1500),
            ("2E4", 20_000),
            ("9007199254740992.0", 1 << 53),
            ("18446744073709551615", u64::MAX),
        ] {
            assert_eq!(whole(text), Some(number), "{text}");
        }
        for text in [
            "1.5", "1e-3", "-1e3", "1e300", "1e16", "inf", "nan", "", "1 000",
        ] {
            assert_eq!(whole(text), None, "{text}");
        }
    }
}
