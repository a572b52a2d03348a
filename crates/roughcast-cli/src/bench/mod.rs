//! `roughcast bench`: what the methods cost on this machine.

mod figure_12;
mod gpu;
mod instructions;

use std::process::ExitCode;

use anyhow::Result;
use clap::Subcommand;

/// Measure what the methods cost on this machine.
#[derive(clap::Args)]
pub struct Args {
    #[command(subcommand)]
    what: What,
}

#[derive(Subcommand)]
enum What {
    Gpu(gpu::Args),
}

/// Measures, and prints a table.
pub fn run(args: &Args) -> Result<ExitCode> {
    match &args.what {
        What::Gpu(args) => gpu::run(args),
    }
}
