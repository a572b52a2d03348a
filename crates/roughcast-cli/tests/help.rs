//! The help: every subcommand has a help text that fits 80 columns and lists all of its choices.

mod common;

use common::{Outcome, command, run};
use roughcast::texture::Layout;

const SUBCOMMANDS: [&str; 9] =
    ["bake", "info", "unpack", "precision", "render", "compare", "figures", "bench", "shader"];

fn help(subcommand: &str, flag: &str) -> String {
    let output = command([subcommand, flag]).env("COLUMNS", "80").output().expect("the program starts");
    let outcome = Outcome::of(&output).expect_success();
    assert!(outcome.stderr.is_empty(), "{}", outcome.stderr);
    outcome.stdout
}

#[test]
fn every_subcommand_explains_itself_within_80_columns() {
    for subcommand in SUBCOMMANDS {
        for flag in ["-h", "--help"] {
            let text = help(subcommand, flag);
            assert!(text.contains(&format!("Usage: roughcast {subcommand}")), "{text}");
            let long: Vec<_> = text.lines().filter(|line| line.chars().count() > 80).collect();
            assert!(long.is_empty(), "{subcommand} {flag}: {long:#?}");
        }
    }
    let overview = run(["--help"]).expect_success().stdout;
    for subcommand in SUBCOMMANDS {
        assert!(overview.contains(&format!("\n  {subcommand} ")), "{overview}");
    }
}

#[test]
fn the_help_of_bake_explains_every_layout() {
    let text = help("bake", "-h");
    let (_, table) = text.split_once("\nLayouts:\n").expect("a table of layouts");
    for layout in Layout::ALL {
        assert!(
            table.contains(&format!("\n  {layout} ")) || table.starts_with(&format!("  {layout} ")),
            "{layout}"
        );
    }
}

#[test]
fn the_documented_options_exist() {
    let bake = help("bake", "-h");
    for option in [
        "as",
        "bits",
        "scale",
        "base",
        "specular-power",
        "roughness",
        "roughness-channel",
        "roughness-stored",
        "roughness-output",
        "roughness-layout",
        "normal-range",
        "target",
        "split",
        "sidecar",
        "brdf",
        "filter",
        "compress",
        "supercompress",
        "anisotropy",
        "kind",
        "green",
        "range",
        "normal-channels",
        "height-scale",
        "invert-height",
        "gradient",
        "wrap",
        "max-slope",
        "max-pixels",
        "strict",
        "jobs",
        "format",
        "json",
        "verbose",
        "output",
    ] {
        assert!(bake.contains(&format!("--{option}")), "--{option}");
    }
    for (subcommand, options) in [
        ("info", &["json", "max-pixels", "green"][..]),
        ("unpack", &["output", "max-pixels"]),
        ("precision", &["specular-power", "json", "max-slope"]),
        ("compare", &["views", "filters", "samples", "frames", "scene", "reconstruction", "json"]),
        ("render", &["camera", "up", "look-at", "shading", "filter", "albedo", "tone"]),
        ("shader", &["lang", "output", "json"]),
    ] {
        let text = help(subcommand, "-h");
        assert!(options.iter().all(|option| text.contains(&format!("--{option}"))), "{text}");
    }
}

#[test]
fn the_version_is_the_crates() {
    let version = run(["--version"]).expect_success().stdout;
    assert_eq!(version.trim(), concat!("roughcast ", env!("CARGO_PKG_VERSION")));
}

#[test]
fn no_arguments_show_the_help_as_a_usage_error() {
    let outcome = run::<&str>([]);
    assert_eq!(outcome.code, Some(2));
    assert!(outcome.stdout.is_empty() && outcome.stderr.contains("Usage: roughcast"), "{}", outcome.stderr);
}
