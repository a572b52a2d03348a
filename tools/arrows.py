"""Checks that the crates depend on each other in one direction only, as drawn in ARCHITECTURE.md.

Reads `cargo metadata`. Faults are dependencies and crates that are not in the tables below, and dependencies of the
library on anything but a few small crates.
"""

import sys

from workspace import cargo_metadata, members, report

# Crate -> crates of this workspace that it may depend on, at run time or in its build script.
ALLOWED = {
    "roughcast": set(),
    "roughcast-io": {"roughcast", "roughcast-scene"},
    "roughcast-pipeline": {"roughcast", "roughcast-io"},
    "roughcast-scene": {"roughcast"},
    "roughcast-gpu": {"roughcast", "roughcast-scene"},
    "roughcast-cli": {"roughcast", "roughcast-io", "roughcast-pipeline", "roughcast-scene", "roughcast-gpu"},
    "roughcast-py": {"roughcast", "roughcast-io", "roughcast-pipeline"},
    "roughcast-fuzz": {"roughcast", "roughcast-io", "roughcast-testdata"},
    "roughcast-testdata": set(),
}

# The same for tests only. All tests may use fixtures; those of crates above the library may also read real files. The
# library's own tests may not, because cargo would build the library twice, with incompatible types.
ALLOWED_IN_TESTS = {
    "roughcast-scene": {"roughcast-io"},
    "roughcast-gpu": {"roughcast-io"},
    "roughcast-py": {"roughcast-io"},
}

# Crate -> crates that must use it without its default features. Users of the scene description must not get the CPU
# renderer with it, because a browser page or a mesh reader does not need it.
WITHOUT_FEATURES = {
    "roughcast-scene": {"roughcast-io", "roughcast-gpu"},
}

FIXTURES = "roughcast-testdata"

# Third-party crates that the library may use (tests are unrestricted). The library is arithmetic on images in memory,
# and an engine that includes it includes these too; the optional ones only if a feature asks for them.
LIBRARY = "roughcast"
LIBRARY_MAY_USE = {"glam", "half", "thiserror"}
LIBRARY_MAY_OFFER = {"multiversion", "rayon", "serde"}


def arrow_faults(package, workspace_names):
    """Faults of the dependencies of one workspace crate on others."""
    name = package["name"]
    if name not in ALLOWED:
        yield f"{name}: unknown crate: add it to the table in tools/arrows.py"
        return
    for dependency in package["dependencies"]:
        target, in_tests = dependency["name"], dependency["kind"] == "dev"
        if target in workspace_names:
            in_tests_too = {FIXTURES} | ALLOWED_IN_TESTS.get(name, set())
            allowed = ALLOWED[name] | (in_tests_too if in_tests else set())
            if target not in allowed:
                yield f"{name} -> {target}: this arrow is not allowed{' in tests' if in_tests else ''}"
            has_features = dependency.get("uses_default_features") or dependency.get("features")
            if not in_tests and has_features and name in WITHOUT_FEATURES.get(target, set()):
                yield f"{name} -> {target}: this arrow takes no features of {target}"
        elif dependency["source"] is None:
            yield f"{name} -> {target}: a path outside the workspace"
        elif name == LIBRARY and not in_tests and target not in LIBRARY_MAY_USE:
            if target not in LIBRARY_MAY_OFFER:
                may_use = ", ".join(sorted(LIBRARY_MAY_USE | LIBRARY_MAY_OFFER))
                yield f"{name} -> {target}: the library may use only {may_use}"
            elif not dependency.get("optional"):
                yield f"{name} -> {target}: this dependency of the library must be optional"


def faults(metadata):
    """Every fault of the workspace, one line each."""
    packages = members(metadata)
    names = {package["name"] for package in packages}
    missing = [] if LIBRARY in names else [f"{LIBRARY}: the library is not in the workspace"]
    return missing + [fault for package in packages for fault in arrow_faults(package, names)]


def main():
    metadata = cargo_metadata()
    names = {package["name"] for package in members(metadata)}
    arrows = sorted(
        f"{package['name']} -> {dependency['name']}"
        for package in members(metadata)
        for dependency in package["dependencies"]
        if dependency["name"] in names
    )
    return report(faults(metadata), f"{len(names)} crates; arrows: {'; '.join(arrows)}")


if __name__ == "__main__":
    sys.exit(main())
