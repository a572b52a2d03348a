//! `roughcast shader`: exports the shading models for use in other renderers.

mod export;
mod guest;
mod header;
mod layout;
mod names;
mod prefix;
mod stage;

use std::io::{IsTerminal, Write};
use std::path::PathBuf;
use std::process::ExitCode;

use anyhow::{Context, Result};
use clap::ValueHint;
use clap::builder::TypedValueParser;
use roughcast::wgsl::{MODULES, Module, Role};
use roughcast_io::AtomicFile;
use serde_json::{Value, json};

use crate::args::{REPORT, WordParser, one_of_or_advice};
use crate::{UsageError, say, say_json};
#[cfg(feature = "gpu")]
pub use export::parse;
use export::{Export, Language, export};
use prefix::Prefix;

/// Export the shading models as shader code, or list them.
///
/// The code has no entry points and no resources (SPIR-V, which has no libraries, has one fragment shader per model).
/// Names have a prefix, and in GLSL, HLSL and Metal's language each module has an include guard. Each export starts
/// with its source, its conventions and how to call it; docs/shaders.md has examples for every language.
#[derive(clap::Args)]
pub struct Args {
    /// What to export, or all; without a name, lists the exports
    #[arg(value_name = "NAME", value_parser = names_parser())]
    names: Vec<String>,

    /// The language
    #[arg(long, value_name = "LANGUAGE", default_value = "wgsl", value_parser = one_of_or_advice::<Language>(OTHER_LANGUAGES))]
    lang: Language,

    /// Prefix of functions and structs, which avoids clashes with other names; constants have it in capitals
    #[arg(long, value_name = "WORD", default_value = "rc_")]
    prefix: Prefix,

    /// Where to write it [default: standard output]
    #[arg(short, long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    output: Option<PathBuf>,

    /// Print the list as JSON
    #[arg(long, help_heading = REPORT, conflicts_with = "names")]
    json: bool,
}

/// The name that selects every export.
const ALL: &str = "all";

/// What can be exported.
fn exports() -> impl Iterator<Item = &'static Module> {
    MODULES.iter().filter(|module| matches!(module.role, Role::Model | Role::Companion))
}

/// Names of layouts and other words that users may try.
const OTHER_NAMES: &[(&str, &str)] = &[
    ("pbr", "the model for the layout 'pbr' is called 'ggx'"),
    ("gltf", "the model for glTF's textures is called 'ggx'"),
    (
        "schilling",
        "there is no shading model for the layout 'schilling' yet; the snippet in docs/layouts.md decodes it for 'off-centre'",
    ),
    (
        "schilling-isotropic",
        "there is no shading model for the layout 'schilling-isotropic' yet; 'variance' shades a mean slope and a variance",
    ),
    ("moments", "the model for moments is called 'lean'"),
    ("bump-slopes", "the model for moments is called 'lean'"),
    ("ward", "Ward's lobe about the bump normal is called 'beckmann'"),
    ("blinn", "blinn-phong"),
];

/// Other names of the languages.
const OTHER_LANGUAGES: &[(&str, &str)] = &[
    ("essl", "glsl-es300"),
    ("webgl", "glsl-es300"),
    ("webgl2", "glsl-es300"),
    ("glsl-es", "glsl-es300"),
    ("gles", "glsl-es300"),
    ("metal", "msl"),
    ("spv", "spirv"),
    ("spir-v", "spirv"),
    ("dxil", "hlsl"),
    ("webgpu", "wgsl"),
];

fn names_parser() -> impl TypedValueParser<Value = String> {
    // The name of an existing model takes precedence.
    WordParser { words: exports().map(|module| module.name).chain([ALL]).collect(), others: OTHER_NAMES }
}

pub fn run(args: &Args) -> Result<ExitCode> {
    if args.names.is_empty() {
        if args.output.is_some() {
            return Err(UsageError("--output needs the name of what to export, or all".to_owned()).into());
        }
        list(args.json)?;
        return Ok(ExitCode::SUCCESS);
    }
    let names: Vec<&str> = if args.names.iter().any(|name| name == ALL) {
        exports().map(|module| module.name).collect()
    } else {
        args.names.iter().map(String::as_str).collect()
    };
    let export = export(&names, args.lang, &args.prefix)?;
    let bytes = match &export {
        Export::Text(text) => text.as_bytes(),
        Export::Binary(bytes) => bytes,
    };
    match &args.output {
        Some(path) => {
            let file = AtomicFile::create(path).with_context(|| path.display().to_string())?;
            write_to(file, bytes).with_context(|| path.display().to_string())?;
        }
        None if matches!(export, Export::Binary(_)) && std::io::stdout().is_terminal() => {
            let line = "SPIR-V is binary: name a file with --output, or redirect it to a pipe";
            return Err(UsageError(line.to_owned()).into());
        }
        None => to_stdout(bytes)?,
    }
    Ok(ExitCode::SUCCESS)
}

fn write_to(mut file: AtomicFile, bytes: &[u8]) -> Result<()> {
    file.write_all(bytes)?;
    Ok(file.commit()?)
}

/// A closed pipe is not an error.
fn to_stdout(bytes: &[u8]) -> Result<()> {
    match std::io::stdout().write_all(bytes) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => Err(error).context("stdout"),
        _ => Ok(()),
    }
}

fn list(as_json: bool) -> Result<()> {
    if as_json {
        return say_json(&Value::Array(exports().map(entry).collect()));
    }
    for module in exports() {
        say(&format!("{:<16} {}", module.name, module.summary))?;
    }
    Ok(())
}

fn entry(module: &Module) -> Value {
    json!({
        "name": module.name,
        "summary": module.summary,
        "source": module.citation,
        "model": module.role == Role::Model,
    })
}
