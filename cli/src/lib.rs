//! The commands of `clebsch`: list, show and copy models, check, run, sweep and compare cases, derive equations.
//!
//! The binary only calls [`run_process`]; everything else takes its arguments, its gallery and its output streams
//! from its caller, so that tests run the same code on their own models. Results go to standard output, progress and
//! messages to standard error. Exit codes: [`failure`].

pub mod arguments;
pub mod case_file;
mod commands;
mod derivatives;
mod models;
mod named;
mod output;
mod overrides;
mod page;
mod plan;
pub mod plots;
pub mod session;
mod terminal;
mod trajectory;
mod words;

pub use commands::derive::generated;
pub use models::gallery;
pub use terminal::cache_folder::cache_of_process;
pub use terminal::{Streams, failure};

use clap::ArgMatches;
use clebsch_interpret::Cache;
use commands::{check, compare, converge, derive, figures, list, new, plot, run, show, sweep};
use commands::{equilibrium, fit, gradient, linearise, lyapunov, orbit, section};
use failure::{DONE, FAILED, Failure, USAGE};
use gallery::Gallery;
use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::process::ExitCode;
use words::plain::Plain;
use words::{lines, width};

/// Runs the process's own arguments on the shipped models.
#[must_use]
pub fn run_process() -> ExitCode {
    run_process_on(&Gallery::shipped())
}

/// Runs the process's own arguments on the models of `gallery`; the `main` of your own command line only needs to
/// call this.
#[must_use]
pub fn run_process_on(gallery: &Gallery) -> ExitCode {
    ExitCode::from(on_streams_of_process(std::env::args_os(), gallery))
}

/// Runs `arguments` on the shipped models and the streams of the process, for programs in other languages. The
/// first argument is the program's name. Gives the exit code.
pub fn run_arguments(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    on_streams_of_process(arguments, &Gallery::shipped())
}

fn on_streams_of_process(arguments: impl IntoIterator<Item = OsString>, gallery: &Gallery) -> u8 {
    #[cfg(feature = "native")]
    clebsch_native::install();
    let mut streams = Streams {
        input: &mut io::stdin(),
        out: &mut io::stdout(),
        err: &mut io::stderr(),
        progress: io::stderr().is_terminal(),
        width: width::of_the_terminal(),
    };
    let gallery = gallery.clone().with_cache(cache_of_process());
    execute(arguments, &gallery, &mut streams)
}

/// Runs `arguments` (the first is the program's name) and gives the exit code.
pub fn execute(
    arguments: impl IntoIterator<Item = OsString>,
    gallery: &Gallery,
    streams: &mut Streams<'_>,
) -> u8 {
    // Names come from files and arguments. Their control characters must not reach a terminal.
    let (mut out, mut err) = (Plain(streams.out), Plain(streams.err));
    let streams = &mut Streams {
        input: streams.input,
        out: &mut out,
        err: &mut err,
        progress: streams.progress,
        width: streams.width,
    };
    let mut command = arguments::command(streams.width);
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let name = arguments
        .get(1)
        .and_then(|name| name.to_str())
        .map(str::to_owned);
    let matches = match command.try_get_matches_from_mut(arguments) {
        Ok(matches) => matches,
        Err(error) => {
            let error = arguments::explained(error, &command, name.as_deref());
            return answer_clap(&error, streams);
        }
    };
    let as_json = matches.subcommand().is_some_and(|(name, matches)| {
        let flag = matches.try_get_one::<bool>("json");
        !["list"].contains(&name) && flag.is_ok_and(|given| given == Some(&true))
    });
    let without_cache = matches.subcommand().is_some_and(|(_, matches)| {
        let flag = matches.try_get_one::<bool>(arguments::NO_CACHE);
        flag.is_ok_and(|given| given == Some(&true))
    });
    let gallery = match without_cache {
        true => &gallery.clone().with_cache(Cache::none()),
        false => gallery,
    };
    let done = dispatch(&matches, gallery, streams);
    let done = done.and_then(|code| {
        streams.out.flush()?;
        Ok(code)
    });
    done.unwrap_or_else(|failure| {
        if failure != Failure::ReaderGone {
            // If this cannot be written either, only the exit code remains.
            let text = failure.to_string();
            // A message about a model has its own lines, without the prefix `clebsch:`.
            let _ = match text.strip_prefix('\n') {
                Some(of_model) => writeln!(streams.err, "{of_model}"),
                None => writeln!(streams.err, "clebsch: {text}"),
            };
            if as_json {
                let _ = writeln!(streams.out, "{}", failure.json());
            }
        }
        failure.code()
    })
}

fn dispatch(
    matches: &ArgMatches,
    gallery: &Gallery,
    streams: &mut Streams<'_>,
) -> Result<u8, Failure> {
    match matches.subcommand() {
        Some(("list", matches)) => list::list(gallery, matches, streams).map(|()| DONE),
        Some(("show", matches)) => show::show(gallery, matches, streams).map(|()| DONE),
        Some(("case", matches)) => show::case(gallery, matches, streams).map(|()| DONE),
        Some(("new", matches)) => new::new(gallery, matches, streams).map(|()| DONE),
        Some(("check", matches)) => check::check(gallery, matches, streams).map(|()| DONE),
        Some(("run", matches)) => run::run(gallery, matches, streams),
        Some(("sweep", matches)) => sweep::sweep(gallery, matches, streams),
        Some(("collect", matches)) => sweep::collect(matches, streams),
        Some(("compare", matches)) => compare::compare(gallery, matches, streams),
        Some(("converge", matches)) => converge::converge(gallery, matches, streams),
        Some(("gradient", matches)) => gradient::gradient(gallery, matches, streams),
        Some(("linearise", matches)) => linearise::linearise(gallery, matches, streams),
        Some(("equilibrium", matches)) => equilibrium::equilibrium(gallery, matches, streams),
        Some(("orbit", matches)) => orbit::orbit(gallery, matches, streams),
        Some(("fit", matches)) => fit::fit(gallery, matches, streams),
        Some(("lyapunov", matches)) => lyapunov::lyapunov(gallery, matches, streams),
        Some(("section", matches)) => section::section(gallery, matches, streams),
        Some(("plot", matches)) => plot::plot(matches, streams),
        Some(("figures", matches)) => figures::figures(gallery, matches, streams),
        Some(("derive", matches)) => {
            derive::derive(gallery, matches, streams)?;
            Ok(DONE)
        }
        // clap requires a subcommand and rejects unknown ones.
        _ => Err(Failure::Usage("no such command".to_owned())),
    }
}

/// Help and version are results; clap's other outputs are usage messages.
fn answer_clap(error: &clap::Error, streams: &mut Streams<'_>) -> u8 {
    let message = error.render();
    if error.use_stderr() {
        let _ = write!(streams.err, "{message}");
        return USAGE;
    }
    // Clap fits everything to the terminal but the line of usage.
    let message = message.to_string();
    let message = match streams.width {
        Some(width) => lines::fitted(&message, width),
        None => message,
    };
    match write!(streams.out, "{message}").and_then(|()| streams.out.flush()) {
        Ok(()) => DONE,
        Err(_) => FAILED,
    }
}
