"""Compare graphs with lists of public workspaces: `python -m tests.workspace.public_graphs FOLDER [TEXT]`.

FOLDER has a checkout of each repository of public_graphs.toml, as OWNER+NAME. It prints the figures of each launch file
whose path or repository has TEXT, and each line whose mark is no longer that of the table.
"""

import json
import sys
import tomllib
from collections import Counter
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, Literal, NamedTuple, get_args

from tests.command_line import ROOT, run

TABLE = ROOT / "tests/workspace/public_graphs.toml"
Drawn = Literal["certain", "dashed", "missing", "wrong"]
_MARKS: dict[str, Drawn] = {"~": "dashed", "-": "missing", "!": "wrong"}


class Line(NamedTuple):
    """A node, an end or a transform of a launch file, and how it is drawn."""

    what: tuple[str, ...]  # a node; a node, kind, name and type; or "transform" and two frames
    drawn: Drawn
    is_later: bool = False  # whether it was missing at first look

    @property
    def is_end(self) -> bool:
        """Return whether it is an end of a topic, a service or an action."""
        return len(self.what) == 4  # node, kind, name, type


def read_lines(text: str) -> Iterator[Line]:
    """Yield the lines of a list; the mark before one says how it is drawn."""
    for line in text.splitlines():
        words = line.split()
        if not words:
            continue
        is_later = words[0] == "+"
        drawn = _MARKS.get(words[0], "certain")
        marked = is_later or words[0] in _MARKS
        yield Line(tuple(words[1:] if marked else words), drawn, is_later)


def counted(lines: list[Line]) -> Counter[Drawn]:
    """Return how many ends are drawn in which way."""
    return Counter(line.drawn for line in lines if line.is_end)


def read_table() -> Any:
    """Return the table of public workspaces."""
    return tomllib.loads(TABLE.read_text(encoding="utf-8"))


def drawn_lines(graph: Mapping[str, Any]) -> dict[tuple[str, ...], Drawn]:
    """Return the nodes, ends and transforms of a graph as JSON, and how each is drawn.

    The services of the controller manager are not listed.
    """
    lines: dict[tuple[str, ...], Drawn] = {}
    for node in graph["nodes"]:
        name = node["name"] or f"({node['program']})"
        lines[name,] = "certain"
        for end in node["ends"]:
            if name == "/controller_manager" and end["kind"] == "service":
                continue
            what = (name, end["kind"].replace(" ", "-"), end["name"], end["type"] or "?")
            is_certain = node["certain"] and end["certain"]
            if is_certain or what not in lines:
                lines[what] = "certain" if is_certain else "dashed"
    for transform in graph["transforms"]:
        lines["transform", transform["parent"], transform["child"]] = "certain"
    return lines


def differences(lines: list[Line], drawn: Mapping[tuple[str, ...], Drawn]) -> Iterator[str]:
    """Yield each line that is drawn otherwise than its mark says, and what no line has.

    Nodes and transforms that have no line are not compared, and what is dashed may be anything.
    """
    listed = {line.what: line.drawn for line in lines}
    for what, mark in listed.items():
        now = drawn.get(what, "missing")
        if now != ("certain" if mark == "wrong" else mark):
            yield f"{' '.join(what)}: {now}, listed as {mark}"
    for what, now in drawn.items():
        if Line(what, now).is_end and now == "certain" and what not in listed:
            yield f"{' '.join(what)}: not listed"


def main(folder: Path, text: str) -> int:
    """Compare all launch files with checkouts, and return how many lines differ."""
    total = 0
    for row in read_table()["launch"]:
        if text not in f"{row['repository']} {row['file']}":
            continue
        path = folder / row["repository"].replace("/", "+") / row.get("folder", "")
        done = run(["graph", path, "--launch", row["file"], "--format", "json"])
        lines = [*read_lines(row["lines"])]
        if not done.stdout:
            print(row["repository"], row["file"], done.stderr.decode())
            total += 1
            continue
        differing = [*differences(lines, drawn_lines(json.loads(done.stdout)))]
        counts = counted(lines)
        shown = ", ".join(f"{counts[kind]} {kind}" for kind in get_args(Drawn))
        print(f"{row['repository']} {row['file']}: {shown}", *differing, sep="\n  ")
        total += len(differing)
    return total


if __name__ == "__main__":
    sys.exit(bool(main(Path(sys.argv[1]), sys.argv[2] if len(sys.argv) > 2 else "")))
