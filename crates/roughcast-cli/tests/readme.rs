//! The README stays true: its commands run, its links lead somewhere, and it speaks of every layout and report key.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use roughcast::texture::Layout;

/// The line before a block of commands that are run here.
const MARK: &str = "<!-- tested -->";

/// What a command of the README may start with, to be run by the program that was built for this test.
const PROGRAM: [&str; 2] = ["cargo run --release -- ", "roughcast "];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn readme() -> String {
    std::fs::read_to_string(root().join("README.md")).expect("the README is at the root of the repository")
}

/// The commands of the marked blocks, in order.
fn commands(readme: &str) -> Vec<String> {
    let blocks = readme.split(MARK).skip(1).map(|after| {
        let block = after.trim_start().strip_prefix("```sh\n").expect("a block of commands follows the mark");
        block.split("```").next().expect("split gives one part or more")
    });
    blocks.flat_map(str::lines).map(str::to_owned).collect()
}

/// A folder of its own with the example maps in it, as the commands expect.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("an earlier run's folder can be removed");
    }
    let examples = folder.join("examples");
    std::fs::create_dir_all(&examples).expect("the folder can be made");
    for entry in std::fs::read_dir(root().join("examples")).expect("the repository has examples") {
        let path = entry.expect("the folder can be listed").path();
        // The maps, and not the folders of whole pages.
        if path.is_dir() {
            continue;
        }
        let name = path.file_name().expect("an entry has a name");
        std::fs::copy(&path, examples.join(name)).expect("an example can be copied");
    }
    folder
}

fn run(command: &str, folder: &Path) -> Output {
    let arguments = PROGRAM
        .iter()
        .find_map(|program| command.strip_prefix(program))
        .unwrap_or_else(|| panic!("'{command}' does not start the program"));
    Command::new(env!("CARGO_BIN_EXE_roughcast"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

#[test]
fn its_commands_run_without_a_warning() {
    let commands = commands(&readme());
    assert!(commands.len() >= 8, "only {} commands are marked: was the mark changed?", commands.len());
    let first = "cargo run --release -- bake examples/rock_normal.png -o baked.ktx2";
    assert_eq!(commands[0], first, "the first command is the one that a newcomer types");
    let folder = folder("readme-commands");
    for command in &commands {
        let output = run(command, &folder);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{command}\n{errors}");
        assert!(!errors.contains("warning"), "{command}\n{errors}");
    }
    for written in ["baked.ktx2", "rock.normal.dds", "moments.exr", "baked/rock_normal.dds"] {
        assert!(folder.join(written).is_file(), "{written} was not written");
    }
}

#[test]
fn its_links_lead_to_files() {
    for document in ["README.md", "ARCHITECTURE.md", "examples/README.md"] {
        let path = root().join(document);
        let text = std::fs::read_to_string(&path).expect("the document is there");
        let links = text.split("](").skip(1).map(|after| after.split(')').next().unwrap_or_default());
        for link in links.filter(|link| !link.starts_with("http") && !link.starts_with('#')) {
            let file = link.split('#').next().unwrap_or_default();
            assert!(path.with_file_name(file).exists(), "{document} links to {link}, which is not there");
        }
    }
}

#[test]
fn it_speaks_of_every_layout() {
    let readme = readme();
    for layout in Layout::ALL {
        assert!(readme.contains(&format!("\n| `{layout}`")), "'{layout}' is missing in the first table");
    }
}

#[test]
fn it_explains_every_key_of_the_report() {
    let readme = readme();
    let folder = folder("readme-report");
    let output = run("roughcast bake examples/rock_normal.png -o rock.ktx2 --json", &folder);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    let mut keys: Vec<&String> = report.as_object().expect("the report is an object").keys().collect();
    keys.extend(report["levels"][0].as_object().expect("a level is an object").keys());
    assert!(keys.len() > 30, "only {} keys", keys.len());
    for key in keys {
        assert!(readme.contains(&format!("`{key}`")), "the README does not explain '{key}'");
    }
}
