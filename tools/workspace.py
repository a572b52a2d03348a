"""What the tools know about the repository: its path, its tracked files, and cargo's metadata."""

import json
import subprocess
import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent


def run(command):
    """Standard output of a command in the repository. Ends the program if the command fails."""
    try:
        return subprocess.run(command, cwd=REPOSITORY, stdout=subprocess.PIPE, check=True).stdout
    except (OSError, subprocess.CalledProcessError) as error:
        sys.exit(f"{command[0]}: {error}")


def cargo_metadata():
    """Every package of the workspace and of its lock file, as `cargo metadata` describes them."""
    return json.loads(run(["cargo", "metadata", "--format-version", "1", "--locked"]))


def members(metadata):
    """The packages of the workspace itself."""
    return [package for package in metadata["packages"] if package["id"] in metadata["workspace_members"]]


def tracked_files():
    """Paths of the files that git tracks, relative to the repository."""
    names = run(["git", "ls-files", "-z"]).decode().split("\0")
    return [Path(name) for name in names if name and (REPOSITORY / name).is_file()]


def report(faults, success):
    """Prints the faults, or what is in order; returns the exit status."""
    for fault in faults:
        print(fault, file=sys.stderr)
    if not faults:
        print(success)
    return 1 if faults else 0
