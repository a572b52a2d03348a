"""Writes the table of refusals into the manual, docs/formats.md: `python tools/oracle/manual.py`."""

from pathlib import Path

from refusals import REFUSALS

PAGE = Path(__file__).resolve().parent.parent.parent / "docs/formats.md"
BEGIN, END = "<!-- refusals: written by tools/oracle/manual.py -->\n", "<!-- end of refusals -->\n"


def table():
    """The rows that the comparison uses, in Markdown."""
    lines = ["| format | refused | why |", "|---|---|---|"]
    lines += [f"| {rule.format} | {rule.what} | {rule.why} |".replace("*", r"\*") for rule in REFUSALS]
    return "\n".join(lines) + "\n"


def updated(page):
    """The page with today's table. Raises ValueError if it has no place for it."""
    before, mark, rest = page.partition(BEGIN)
    _, end, after = rest.partition(END)
    if not mark or not end:
        raise ValueError(f"{PAGE.name} has no place for the table of refusals")
    return f"{before}{BEGIN}\n{table()}\n{END}{after}"


if __name__ == "__main__":
    PAGE.write_text(updated(PAGE.read_text()))
