//! The `roughcast` program: one file per subcommand.
//!
//! Results go to stdout, everything else to stderr. Exit codes: 0 done, 1 an input or a file failed, 2 the command
//! line is invalid.

mod added;
mod albedo;
mod args;
mod backend;
mod bake;
mod batch;
#[cfg(feature = "gpu")]
mod bench;
mod bumps;
mod compare;
mod display;
mod fault;
mod figures;
mod findings;
mod html;
mod info;
mod input;
mod precision;
mod progress;
mod refusals;
mod render;
mod report;
mod roughness;
mod scene_args;
mod shader;
mod textures;
mod tone;
mod unpack;

use std::io::{ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

use anyhow::Context;
use clap::{Parser, Subcommand};

/// Bumps in, roughness out: filters normal and height maps so that detail too small to see becomes roughness instead
/// of shimmering.
#[derive(Parser)]
#[command(name = "roughcast", version, max_term_width = 100, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    Bake(bake::Args),
    Info(info::Args),
    Unpack(unpack::Args),
    Precision(precision::Args),
    Render(render::Args),
    Compare(compare::Args),
    Figures(figures::Args),
    #[cfg(feature = "gpu")]
    Bench(bench::Args),
    Shader(shader::Args),
}

fn main() -> ExitCode {
    fault::install_hook();
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => return explain(&error),
    };
    let result = match cli.command {
        Command::Bake(args) => bake::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Unpack(args) => unpack::run(&args),
        Command::Precision(args) => precision::run(&args),
        Command::Render(args) => render::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Figures(args) => figures::run(&args),
        #[cfg(feature = "gpu")]
        Command::Bench(args) => bench::run(&args),
        Command::Shader(args) => shader::run(&args),
    };
    match result {
        Ok(code) => code,
        Err(error) => {
            complain(&format!("error: {}", one_line(&error)));
            let usage = error.chain().any(|cause| cause.is::<UsageError>());
            ExitCode::from(if usage { 2 } else { 1 })
        }
    }
}

/// Reports an error in the command line, in one line, or shows the requested help.
fn explain(error: &clap::Error) -> ExitCode {
    let asked_for_help = !error.use_stderr()
        || error.kind() == clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand;
    if asked_for_help {
        let _ = error.print();
    } else {
        // clap adds a usage and a pointer to --help, each after an empty line, which is noise in the logs of scripts.
        let text = error.render().to_string();
        let said = text
            .split("\n\n")
            .filter(|part| !part.starts_with("Usage:") && !part.starts_with("For more information"));
        let words = said.flat_map(str::split_whitespace).collect::<Vec<_>>();
        complain(&format!("{} (see --help)", words.join(" ")));
    }
    ExitCode::from(error.exit_code() as u8)
}

/// A command line that is invalid regardless of the files.
#[derive(Debug)]
struct UsageError(String);

impl std::fmt::Display for UsageError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UsageError {}

/// A command line that is invalid because of this path.
fn usage(path: &Path, line: &str) -> anyhow::Error {
    UsageError(format!("{}: {line}", path.display())).into()
}

/// An error with its causes on one line. Decoders' messages may contain line breaks or control characters, which must
/// not reach a terminal.
fn one_line(error: &anyhow::Error) -> String {
    let text = error.chain().map(refusals::with_options).collect::<Vec<_>>().join(": ");
    // Spaces are kept, since they may be part of a file's name.
    let pieces = text.split(char::is_control).map(str::trim).filter(|piece| !piece.is_empty());
    pieces.collect::<Vec<_>>().join(" ")
}

/// Prints a line to stdout. A closed pipe, for example by `head`, is not an error; a full disk is.
fn say(text: &str) -> anyhow::Result<()> {
    match writeln!(std::io::stdout(), "{text}") {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error).context("stdout"),
        _ => Ok(()),
    }
}

/// Prints JSON to stdout.
fn say_json(value: &serde_json::Value) -> anyhow::Result<()> {
    say(&serde_json::to_string_pretty(value).expect("a report is plain data"))
}

/// Prints a line to stderr. If stderr is closed, the line is dropped.
fn complain(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}

/// Prints a warning to stderr.
fn warn(path: &Path, warning: &str) {
    complain(&format!("warning: {}: {warning}", path.display()));
}
