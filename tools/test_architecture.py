"""The layout that ARCHITECTURE.md adds as an example applies to the sources as they are."""

import re
import unittest

from workspace import REPOSITORY


def hunks(text):
    """(file, first line, lines before, lines after) of every hunk of the diffs in a text."""
    for diff in re.findall(r"^```diff\n(.*?)^```$", text, re.MULTILINE | re.DOTALL):
        for file, changes in re.findall(r"^\+\+\+ (\S+)\n(.*?)(?=^\+\+\+ |\Z)", diff, re.MULTILINE | re.DOTALL):
            for first, body in re.findall(r"^@@ -(\d+).*?@@.*?\n(.*?)(?=^@@ |\Z)", changes, re.MULTILINE | re.DOTALL):
                lines = body.splitlines()
                before = [line[1:] for line in lines if line[:1] != "+"]
                after = [line[1:] for line in lines if line[:1] != "-"]
                yield file, int(first), before, after


def fault(sources, file, first, before):
    """Why a hunk does not apply to the sources (name -> text), or None."""
    if not before:
        return f"{file} exists" if file in sources else None
    lines = sources.get(file, "").splitlines()
    return None if lines[first - 1 : first - 1 + len(before)] == before else f"{file}:{first} differs: {before[0]}"


class Architecture(unittest.TestCase):
    def test_the_example_layout_applies(self):
        found = list(hunks((REPOSITORY / "ARCHITECTURE.md").read_text(encoding="utf-8")))
        self.assertGreater(len(found), 5)
        names = {file for file, *_ in found if (REPOSITORY / file).is_file()}
        sources = {file: (REPOSITORY / file).read_text(encoding="utf-8") for file in names}
        self.assertGreater(len(sources), 3)
        faults = [fault(sources, file, first, before) for file, first, before, _ in found]
        self.assertEqual([line for line in faults if line], [])

    def test_a_hunk_that_does_not_apply_is_found(self):
        sources = {"a.rs": "one\ntwo\nthree\n"}
        text = "```diff\n+++ a.rs\n@@ -2,2 +2,3 @@ fn f() {\n two\n+new\n three\n+++ b.rs\n@@ -0,0 +1,1 @@\n+all\n```\n"
        first, second = hunks(text)
        self.assertEqual(first, ("a.rs", 2, ["two", "three"], ["two", "new", "three"]))
        self.assertIsNone(fault(sources, *first[:3]))
        self.assertIsNone(fault(sources, *second[:3]))
        self.assertIsNotNone(fault({"a.rs": "one\n2\nthree\n"}, *first[:3]))
        self.assertIsNotNone(fault({"b.rs": "all\n"}, *second[:3]))


if __name__ == "__main__":
    unittest.main()
