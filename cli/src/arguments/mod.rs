//! The command line: subcommands, options and the checks that need no model.
//! Takes the width of the terminal; gives the clap command, whose matches the commands read.

mod analyses;
mod foreign_option;
mod of_a_case;
mod option;
mod prints;
mod runs;
mod shard;

pub(crate) use foreign_option::explained;
pub(crate) use shard::Shard;

use clap::{Arg, Command};
use of_a_case::{model, of_a_case, shown_case};
pub(crate) use option::NO_CACHE;
use option::{json, no_cache, option};

/// The largest width of help, because longer lines are hard to read.
const WIDEST: usize = 100;

/// The whole command line. Help lines have at most `width` characters, if it is given.
#[must_use]
pub fn command(width: Option<usize>) -> Command {
    Command::new("clebsch")
        .term_width(width.unwrap_or(WIDEST).min(WIDEST))
        .version(env!("CARGO_PKG_VERSION"))
        .about(
            "Discrete Clebsch variational integrators: derived from a Lagrangian, run from a case",
        )
        .after_help(
            "Examples:\n  clebsch list\n  clebsch run heavy-top\n  clebsch derive heavy-top\n  clebsch new my-model\n\nExit \
             codes: 0 success, 1 failure, 2 wrong usage, 3 an invariant exceeded the bound of its case (results are \
             written). A sweep writes its table and exits with 1 if a point was rejected or stopped early, otherwise with 3 \
             if an invariant exceeded its bound at a point.",
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
                .about("Print the text of a model and one of its cases")
                .after_help("Examples:\n  clebsch show toda-chain\n  clebsch show heavy-top:general")
                .arg(model())
                .arg(shown_case())
                .arg(no_cache()),
        )
        .subcommand(
            Command::new("case")
                .about("Print a complete case as TOML, as a template for your own")
                .after_help(
                    "Examples:\n  clebsch case heavy-top > my-top.toml\n  clebsch case heavy-top:general\n  \
                     clebsch case my-model.clebsch > my-model.toml",
                )
                .arg(model())
                .arg(shown_case())
                .arg(no_cache()),
        )
        .subcommand(
            Command::new("new")
                .about("Create a model and a case of your own, NAME.clebsch and NAME.toml")
                .after_help("Examples:\n  clebsch new my-model\n  clebsch new my-chain --from toda-chain:soliton")
                .arg(
                    Arg::new("name")
                        .value_name("NAME")
                        .required(true)
                        .help("Name of the model, such as my-top; existing files are never replaced"),
                )
                .arg(option(
                    "from",
                    "MODEL[:CASE]",
                    "Model to copy; two masses on a spring by default",
                )),
        )
        .subcommand(
            of_a_case(Command::new("check"))
                .about("Derive a model, read its case and take one step")
                .after_help("Examples:\n  clebsch check my-model.clebsch"),
        )
        .subcommand(runs::run())
        .subcommand(runs::sweep())
        .subcommand(runs::collect())
        .subcommand(runs::compare())
        .subcommand(runs::converge())
        .subcommand(analyses::gradient())
        .subcommand(analyses::linearise())
        .subcommand(analyses::equilibrium())
        .subcommand(analyses::orbit())
        .subcommand(analyses::section())
        .subcommand(analyses::lyapunov())
        .subcommand(analyses::fit())
        .subcommand(prints::plot())
        .subcommand(prints::figures())
        .subcommand(prints::derive())
}

#[cfg(test)]
mod tests {
    #[test]
    fn clap_finds_no_contradiction() {
        super::command(None).debug_assert();
    }
}
