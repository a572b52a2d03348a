"""Checks that every crate and every npm package in the lock files has a licence that the project accepts.

Reads `cargo metadata`, with all dependencies on all platforms, including those of tests and build scripts, and npm's
lock files.
A licence is an SPDX expression; it is satisfied if the licences on the list below satisfy it.
"""

import collections
import json
import re
import sys

from workspace import REPOSITORY, cargo_metadata, members, report, tracked_files

NPM_LOCK_FILE = "package-lock.json"

ALLOWED = {
    "0BSD",
    "Apache-2.0",
    "Apache-2.0 WITH LLVM-exception",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "BSL-1.0",
    "CC0-1.0",
    "ISC",
    "MIT",
    "MIT-0",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
}

TOKEN = re.compile(r"\s*([()]|[A-Za-z0-9.+-]+)")


def tokens(expression):
    """The words and parentheses of an expression. `MIT/Apache-2.0` is the old way to write OR."""
    expression = expression.replace("/", " OR ").strip()
    found, position = [], 0
    while position < len(expression):
        match = TOKEN.match(expression, position)
        if match is None:
            raise ValueError(f"'{expression[position]}' in '{expression}'")
        found.append(match[1])
        position = match.end()
    return found


class Parser:
    """Evaluates an SPDX expression: WITH binds before AND, and AND before OR."""

    def __init__(self, expression):
        self.tokens = tokens(expression)
        self.expression = expression

    def peek(self):
        return self.tokens[0] if self.tokens else None

    def take(self):
        if not self.tokens:
            raise ValueError(f"'{self.expression}' ends too early")
        return self.tokens.pop(0)

    def whole(self):
        satisfied = self.any_of()
        if self.tokens:
            raise ValueError(f"'{self.peek()}' is too much in '{self.expression}'")
        return satisfied

    def any_of(self):
        satisfied = self.all_of()
        while self.peek() == "OR":
            self.take()
            # Parsed first, because `or` would leave the rest unread.
            other = self.all_of()
            satisfied = satisfied or other
        return satisfied

    def all_of(self):
        satisfied = self.one()
        while self.peek() == "AND":
            self.take()
            other = self.one()
            satisfied = satisfied and other
        return satisfied

    def one(self):
        word = self.take()
        if word == "(":
            satisfied = self.any_of()
            if self.take() != ")":
                raise ValueError(f"a parenthesis is not closed in '{self.expression}'")
            return satisfied
        if word in {")", "AND", "OR", "WITH"}:
            raise ValueError(f"'{word}' where a licence should be in '{self.expression}'")
        if self.peek() == "WITH":
            self.take()
            word = f"{word} WITH {self.take()}"
        return word in ALLOWED


def is_satisfied(expression):
    """Whether licences on the list satisfy the expression. ValueError if it is not one."""
    return Parser(expression).whole()


def dependencies(metadata):
    """Every package outside of the workspace."""
    own = {package["id"] for package in members(metadata)}
    return [package for package in metadata["packages"] if package["id"] not in own]


def npm_dependencies(lock):
    """Every package of an npm lock file (version 2 or 3), described as `cargo metadata` describes crates."""
    found = []
    for path, package in lock["packages"].items():
        # The empty path is the project's own package.
        if path:
            name = path.rpartition("node_modules/")[2]
            found.append({"name": name, "version": package.get("version"), "license": package.get("license")})
    return found


def fault_of(package):
    """What is wrong with the licence of a package, or None."""
    name = f"{package['name']} {package['version']}"
    if not package["license"]:
        return f"{name}: states no licence"
    try:
        if is_satisfied(package["license"]):
            return None
    except ValueError as error:
        return f"{name}: its licence is no SPDX expression: {error}"
    return f"{name}: '{package['license']}' needs a licence that is not on the list in tools/licences.py"


def faults(packages):
    """Every fault, one line each."""
    return [fault for fault in map(fault_of, packages) if fault]


def main():
    packages = dependencies(cargo_metadata())
    for path in tracked_files():
        if path.name == NPM_LOCK_FILE:
            packages += npm_dependencies(json.loads((REPOSITORY / path).read_text()))
    for licence, count in collections.Counter(package["license"] for package in packages).most_common():
        print(f"{count:4} {licence}")
    return report(faults(packages), f"{len(packages)} dependencies, all under licences on the list")


if __name__ == "__main__":
    sys.exit(main())
