"""Checks that the modules of the library use each other in one direction only, as drawn in ARCHITECTURE.md.

Reads the sources: a module is a file or a folder directly below `crates/roughcast/src`, and it uses another module by
its path (`crate::pyramid::...`) or by a name that the crate's root exports (`crate::Image`). Unit tests may use
anything.
"""

import re
import sys

from workspace import REPOSITORY, report, tracked_files

SOURCES = REPOSITORY / "crates/roughcast/src"

# Modules that may use each other, since they hold the types of one concept in two files.
ONE_IDEA = {frozenset({"moments", "slope"})}


def exports_of(root):
    """Name -> module, of the names that the crate's root exports."""
    found = re.findall(r"pub use (\w+)::(\{[^}]*\}|\w+);", root)
    return {name: module for module, names in found for name in re.findall(r"\w+", names)}


def code_of(text):
    """A file's code without its comments and its unit tests."""
    text = re.sub(r"//.*", "", text)
    # A module of tests in a file of its own, which main() leaves out.
    text = re.sub(r"#\[cfg\(test\)\]\s*mod \w+;", "", text)
    return text.split("#[cfg(test)]")[0]


def used_by(code, exports):
    """Modules that some code uses."""
    names = re.findall(r"crate::(\w+)", code)
    for group in re.findall(r"crate::\{([^;]*)\}", code):
        names += re.findall(r"\w+", group)
    return {exports.get(name, name) for name in names}


def arrows_of(files, exports):
    """Module -> modules that it uses, from the (path below the sources, text) of each file."""
    arrows = {}
    for path, text in files:
        module = path.parts[0].removesuffix(".rs")
        arrows.setdefault(module, set()).update(used_by(code_of(text), exports))
    return {module: (used & arrows.keys()) - {module} for module, used in arrows.items()}


def reached_from(module, arrows):
    """All modules to which arrows lead from this one."""
    reached, waiting = set(), [module]
    while waiting:
        new = arrows[waiting.pop()] - reached
        reached |= new
        waiting += new
    return reached


def faults(arrows):
    """Every arrow that is part of a circle, one line each."""
    for module, used in sorted(arrows.items()):
        for other in sorted(used):
            if module in reached_from(other, arrows) and frozenset({module, other}) not in ONE_IDEA:
                yield f"{module} -> {other}: this arrow closes a circle: move what both need to a module of its own"


def main():
    paths = [REPOSITORY / path for path in tracked_files() if path.suffix == ".rs"]
    paths = [path for path in paths if path.is_relative_to(SOURCES) and path.name not in {"lib.rs", "tests.rs"}]
    files = [(path.relative_to(SOURCES), path.read_text(encoding="utf-8")) for path in paths]
    arrows = arrows_of(files, exports_of((SOURCES / "lib.rs").read_text(encoding="utf-8")))
    missing = [] if len(arrows) > 1 else ["the library has no modules"]
    return report(missing + list(faults(arrows)), f"{len(arrows)} modules of the library, without a circle")


if __name__ == "__main__":
    sys.exit(main())
