"""Checks that no tracked file is too large, that the test data is within its bounds, that lock files name only public
registries, and that there is no unfinished code and no path from somebody's machine."""

import json
import re
import sys
from urllib.parse import urlsplit

from workspace import REPOSITORY, report, tracked_files

MAX_BYTES = 1 << 20
TEST_DATA, MAX_TEST_DATA_BYTES = "testdata", 10 << 20

CRATES_IO = "registry+https://github.com/rust-lang/crates.io-index"
# Hosts that Python's and npm's lock files may name.
PUBLIC_HOSTS = {"files.pythonhosted.org", "pypi.org", "registry.npmjs.org"}
LOCK_FILE = re.compile(r"(uv|poetry|yarn)\.lock|pnpm-lock\.yaml|(dev-)?requirements.*\.txt")
NPM_LOCK_FILES = {"package-lock.json", "npm-shrinkwrap.json"}
CARGO_CONFIG = re.compile(r"(^|/)\.cargo/config(\.toml)?$")

SOURCE_SUFFIXES = {".glsl", ".html", ".js", ".mjs", ".py", ".rs", ".sh", ".toml", ".ts", ".wgsl", ""}
# The one-character classes keep these lines from matching themselves.
UNFINISHED = re.compile(r"\b(todo|unimplemented)[!]\(|\bFIX[M]E\b|#\[ignor[e]")
HOME_PATH = re.compile(r"(?<![\w.])/(home|Users|root)/[\w.]|\b[A-Z]:\\+Users\\")
URL = re.compile(r"\b[a-z+]+://[^\s\"'<>]+")


def cargo_lock_faults(text):
    """Sources in a Cargo.lock other than crates.io."""
    for source in re.findall(r'^source = "(.*)"$', text, re.MULTILINE):
        if source != CRATES_IO:
            yield f"names the source {source}: only crates.io is allowed"


def foreign_url_faults(urls):
    """URLs of hosts that are not public registries."""
    for url in urls:
        if urlsplit(url).hostname not in PUBLIC_HOSTS:
            yield f"names {url}: only {', '.join(sorted(PUBLIC_HOSTS))} are allowed"


def resolved_urls(value):
    """The addresses from which npm gets packages, anywhere in a lock file. Other addresses in it are only information."""
    if isinstance(value, dict):
        for key, inner in value.items():
            if key == "resolved" and isinstance(inner, str) and "://" in inner:
                yield inner
            else:
                yield from resolved_urls(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from resolved_urls(inner)


def lock_faults(path, text):
    """Faults of a file that specifies the sources of packages; none for any other file."""
    if path.name == "Cargo.lock":
        yield from cargo_lock_faults(text)
    elif path.name in NPM_LOCK_FILES:
        yield from foreign_url_faults(resolved_urls(json.loads(text)))
    elif LOCK_FILE.fullmatch(path.name):
        yield from foreign_url_faults(URL.findall(text))
    elif CARGO_CONFIG.search(path.as_posix()) and re.search(r"^\s*\[(source|registr)", text, re.MULTILINE):
        yield "replaces crates.io: that belongs into the configuration of a machine"


def line_faults(path, text):
    """Faults of single lines."""
    for number, line in enumerate(text.splitlines(), start=1):
        if path.suffix in SOURCE_SUFFIXES and (found := UNFINISHED.search(line)):
            yield f"line {number}: unfinished: {found[0]}"
        if found := HOME_PATH.search(line):
            yield f"line {number}: a path of somebody's machine: {found[0]}"


def file_faults(path, data):
    """Every fault of one file, given its path in the repository and its bytes."""
    if len(data) > MAX_BYTES:
        yield f"{path}: {len(data)} bytes, more than the {MAX_BYTES} that a tracked file may have"
    if b"\0" in data:
        return  # Not text.
    text = data.decode(errors="replace")
    for fault in [*lock_faults(path, text), *line_faults(path, text)]:
        yield f"{path}: {fault}"


def test_data_faults(size):
    """The fault of test data of this many bytes, if any."""
    if size > MAX_TEST_DATA_BYTES:
        yield f"{TEST_DATA}/: {size} bytes, more than the {MAX_TEST_DATA_BYTES} that it may have"


def main():
    files = tracked_files()
    if not files:
        sys.exit("git tracks no file here")
    test_data = sum((REPOSITORY / path).stat().st_size for path in files if path.parts[0] == TEST_DATA)
    found = list(test_data_faults(test_data))
    found += [fault for path in files for fault in file_faults(path, (REPOSITORY / path).read_bytes())]
    return report(found, f"{len(files)} tracked files are in order")


if __name__ == "__main__":
    sys.exit(main())
