//! Keeps the first page and the manual correct: their commands run and print the output shown, their links work, and
//! they cover every layout and report key.

mod common;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use common::check_all;
use roughcast::texture::Layout;

/// The line before a block of commands that this test runs.
const MARK: &str = "<!-- tested -->";

/// Possible starts of a command; the rest are the arguments of the program built for this test.
const PROGRAM: [&str; 2] = ["cargo run --release -- ", "roughcast "];

/// A line of shown output that represents any number of lines.
const ELLIPSIS: &str = "…";

/// A first page with more lines than this would be a manual.
const FIRST_PAGE_LINES: usize = 150;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

fn read(document: &str) -> String {
    std::fs::read_to_string(root().join(document)).unwrap_or_else(|fault| panic!("{document}: {fault}"))
}

/// The Markdown files in a folder of the repository, by their paths from its root.
fn documents_of(folder: &str) -> Vec<String> {
    let entries = std::fs::read_dir(root().join(folder)).expect("the folder can be listed");
    let names = entries.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned());
    let mut documents: Vec<String> =
        names.filter(|name| name.ends_with(".md")).map(|name| format!("{folder}{name}")).collect();
    documents.sort();
    documents
}

/// The first page and the chapters of the manual.
fn manual() -> Vec<String> {
    let mut documents = vec!["README.md".to_owned()];
    documents.extend(documents_of("docs/"));
    documents
}

/// A fenced block of a document.
#[derive(Debug)]
struct Block {
    language: String,
    lines: Vec<String>,
    /// Whether the mark is on the line before it.
    marked: bool,
    /// Whether only blank lines separate it from the previous block.
    follows: bool,
}

impl Block {
    /// The lines that start the program.
    fn commands(&self) -> impl Iterator<Item = &str> {
        let code = self.lines.iter().map(|line| line.split(" #").next().unwrap_or_default().trim_end());
        code.filter(|line| PROGRAM.iter().any(|program| format!("{line} ").starts_with(program)))
    }
}

/// The fenced blocks of a document, in order.
fn blocks(document: &str) -> Vec<Block> {
    let mut blocks: Vec<Block> = Vec::new();
    let (mut open, mut marked, mut follows) = (false, false, false);
    for line in document.lines() {
        match (open, line.strip_prefix("```")) {
            (false, Some(language)) => {
                blocks.push(Block { language: language.to_owned(), lines: Vec::new(), marked, follows });
                open = true;
            }
            (true, Some(_)) => (open, marked, follows) = (false, false, true),
            (true, None) => blocks.last_mut().expect("a block is open").lines.push(line.to_owned()),
            (false, None) => {
                marked = line == MARK;
                follows &= line.is_empty();
            }
        }
    }
    blocks
}

/// The lines outside of fenced blocks.
fn prose(document: &str) -> impl Iterator<Item = &str> {
    document.split("\n```").step_by(2).flat_map(str::lines)
}

/// A new folder that contains the example maps, as the commands expect.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).expect("an earlier run's folder can be removed");
    }
    let examples = folder.join("examples");
    std::fs::create_dir_all(&examples).expect("the folder can be made");
    for entry in std::fs::read_dir(root().join("examples")).expect("the repository has examples") {
        let path = entry.expect("the folder can be listed").path();
        // Copy the maps, but not the folders of complete pages.
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
        .unwrap_or_else(|| panic!("'{command}' does not start the program with arguments"));
    Command::new(env!("CARGO_BIN_EXE_roughcast"))
        .args(arguments.split_whitespace())
        .current_dir(folder)
        .output()
        .expect("the program starts")
}

/// Checks that a document's lines are those of an output, apart from what an ellipsis omits.
fn shows(lines: &[String], output: &str) -> Result<(), String> {
    let mut printed = output.lines();
    let mut skipping = false;
    for line in lines {
        if line.trim() == ELLIPSIS {
            skipping = true;
            continue;
        }
        let found = if skipping { printed.find(|other| other == line) } else { printed.next() };
        if found != Some(line) {
            return Err(format!("shown   {line}\nprinted {}", found.unwrap_or("nothing that matches")));
        }
        skipping = false;
    }
    match printed.next() {
        Some(more) if !skipping => Err(format!("not shown: {more}")),
        _ => Ok(()),
    }
}

/// Runs the marked commands of a document in a new folder; the output that the document shows after them must match as
/// well.
fn check_commands(document: &String) -> Result<(), String> {
    let folder = folder(&format!("manual-{}", document.replace('/', "-")));
    let mut printed = String::new();
    for block in blocks(&read(document)) {
        if block.marked && block.language == "sh" {
            printed.clear();
            for command in block.commands() {
                let output = run(command, &folder);
                let errors = String::from_utf8_lossy(&output.stderr);
                if !output.status.success() || errors.contains("warning") {
                    return Err(format!("{document}: {command}\n{errors}"));
                }
                printed += &String::from_utf8_lossy(&output.stdout);
            }
        } else if block.follows && block.language == "text" {
            shows(&block.lines, &printed).map_err(|fault| format!("{document}:\n{fault}"))?;
        }
    }
    Ok(())
}

#[test]
fn commands_run_without_a_warning_and_print_what_is_shown() {
    check_all(&manual(), check_commands);
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("manual-README.md");
    for written in ["baked.ktx2", "rock.normal.dds", "moments.exr", "baked/rock_normal.dds"] {
        assert!(folder.join(written).is_file(), "the first page's commands did not write {written}");
    }
}

#[test]
fn every_command_of_the_program_is_marked() {
    let mut marked = 0;
    for document in manual() {
        for block in blocks(&read(&document)) {
            let commands = block.commands().count();
            if block.language != "sh" || commands == 0 {
                assert!(!block.marked, "{document}: nothing to run in a marked block: {:?}", block.lines);
                continue;
            }
            assert!(block.marked, "{document}: no '{MARK}' before {:?}", block.lines);
            assert_eq!(commands, block.lines.len(), "{document}: not a command: {:?}", block.lines);
            marked += commands;
        }
    }
    assert!(marked >= 25, "only {marked} commands: was the mark changed?");
    let first = blocks(&read("README.md")).swap_remove(0).lines;
    assert_eq!(
        first,
        ["cargo run --release -- bake examples/rock_normal.png -o baked.ktx2"],
        "a newcomer's first command"
    );
}

#[test]
fn differing_output_is_detected() {
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<Vec<_>>();
    assert!(shows(&lines("a\n  …\nd"), "a\nb\nc\nd\n").is_ok());
    for (shown, printed) in [("a\nb", "a\nc"), ("a", "a\nb"), ("a\nb", "a"), ("a\n…\nx", "a\nb")] {
        assert!(shows(&lines(shown), printed).is_err(), "{shown:?} for {printed:?}");
    }
}

/// The anchors that GitHub assigns to a document's headings.
fn anchors(document: &str) -> Vec<String> {
    let headings = prose(document).filter(|line| line.starts_with('#'));
    let anchor = |heading: &str| {
        let title = heading.trim_start_matches('#').trim().to_lowercase().replace(' ', "-");
        title.chars().filter(|letter| letter.is_alphanumeric() || "-_".contains(*letter)).collect()
    };
    headings.map(anchor).collect()
}

#[test]
fn links_lead_to_files_and_headings() {
    let mut documents = documents_of("");
    for folder in ["docs/", "examples/", "examples/webgl2/", "testdata/"] {
        documents.extend(documents_of(folder));
    }
    let mut count = 0;
    for document in documents {
        let path = root().join(&document);
        let text = read(&document);
        let prose: Vec<&str> = prose(&text).collect();
        let prose = prose.join("\n");
        let links = prose.split("](").skip(1).map(|after| after.split(')').next().unwrap_or_default());
        for link in links.filter(|link| !link.starts_with("http")) {
            let (file, anchor) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { path.clone() } else { path.with_file_name(file) };
            assert!(target.exists(), "{document} links to {link}, which is not there");
            if !anchor.is_empty() {
                let text =
                    std::fs::read_to_string(&target).expect("a link with an anchor leads to a document");
                let anchor = anchor.to_owned();
                assert!(
                    anchors(&text).contains(&anchor),
                    "{document} links to {link}: there is no such heading"
                );
            }
            count += 1;
        }
    }
    assert!(count > 100, "only {count} links");
}

#[test]
fn the_first_page_is_short() {
    let lines = read("README.md").lines().count();
    assert!(lines <= FIRST_PAGE_LINES, "{lines} lines");
}

#[test]
fn the_index_names_every_chapter() {
    let index = read("docs/README.md");
    for chapter in documents_of("docs/") {
        let name = chapter.trim_start_matches("docs/");
        assert!(
            name == "README.md" || index.contains(&format!("]({name})")),
            "docs/README.md does not name {name}"
        );
    }
}

#[test]
fn every_layout_is_in_the_tables() {
    let readme = read("README.md");
    let chapter = read("docs/layouts.md");
    let headings: Vec<&str> = prose(&chapter).filter(|line| line.starts_with("## ")).collect();
    for layout in Layout::ALL {
        assert!(
            readme.contains(&format!("\n| `{layout}`")),
            "'{layout}' is missing in the first page's table"
        );
        let name = layout.to_string();
        let described = headings.iter().any(|heading| heading[3..].split(", ").any(|title| title == name));
        assert!(described, "docs/layouts.md has no heading for '{layout}'");
    }
}

#[test]
fn every_key_of_the_report_is_explained() {
    let chapter = read("docs/reports.md");
    let folder = folder("manual-report");
    let output = run("roughcast bake examples/rock_normal.png -o rock.ktx2 --json", &folder);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("the report is JSON");
    let mut keys: Vec<&String> = report.as_object().expect("the report is an object").keys().collect();
    keys.extend(report["levels"][0].as_object().expect("a level is an object").keys());
    assert!(keys.len() > 30, "only {} keys", keys.len());
    for key in keys {
        assert!(chapter.contains(&format!("`{key}`")), "docs/reports.md does not explain '{key}'");
    }
}
