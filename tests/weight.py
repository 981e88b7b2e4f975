"""How much code the grader has: one number with a limit, and a table that says where it is.

`python -m tests.weight` prints the table: nodes of the syntax tree by package and room, and beside them what the nodes
do not count, in characters: TOML, scripts and styles, templates, and long texts in the code.
"""

import ast
from collections import Counter, defaultdict
from pathlib import Path

ROOT = Path(__file__).parent.parent / "grader"
MAX_NODES = 965_000  # of all code together; what comes in beyond it is paid by what goes out
MIN_LONG_TEXT = 200  # characters: a shorter text is a message
OTHER_FILES = {
    ".toml": "TOML",
    ".js": "scripts",
    ".css": "scripts",
    ".html": "templates",
}
COLUMNS = ("nodes", "TOML", "scripts", "templates", "long texts")


def count_nodes() -> int:
    """Return how many nodes the code has."""
    return sum(counts["nodes"] for counts in weigh_rooms().values())


def weigh_rooms() -> dict[str, Counter[str]]:
    """Return the figures of each room: nodes, and characters of what the nodes do not count."""
    rooms: defaultdict[str, Counter[str]] = defaultdict(Counter)
    for path in sorted(ROOT.rglob("*")):
        if path.suffix == ".py":
            rooms[_name_room(path)] += _weigh_code(path)
        elif path.suffix in OTHER_FILES:
            size = len(path.read_text(encoding="utf-8"))
            rooms[_name_room(path)][OTHER_FILES[path.suffix]] += size
    return dict(rooms)


def _name_room(path: Path) -> str:
    """Return the package and the room of a file: `ros.urdf`, or `ros` for a file beside the rooms."""
    return ".".join(path.relative_to(ROOT).parts[:-1][:2])


def _weigh_code(path: Path) -> Counter[str]:
    nodes = [*ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    docstrings = {id(node.value) for node in nodes if isinstance(node, ast.Expr)}
    counts = Counter(nodes=len(nodes))
    for node in nodes:
        match node:
            case ast.Constant(value=str(text)) if id(node) not in docstrings:
                counts["long texts"] += len(text) if len(text) >= MIN_LONG_TEXT else 0
    return counts


def table() -> str:
    """Return the figures as text, with one line for each room and one for all."""
    rooms = weigh_rooms()
    total: Counter[str] = Counter()
    for counts in rooms.values():
        total += counts
    lines = ["".join(f"{column:>12}" for column in COLUMNS)]
    for name, counts in [*rooms.items(), ("all", total)]:
        lines.append("".join(f"{counts[column]:>12,}" for column in COLUMNS) + f"  {name}")
    return "\n".join(lines)


if __name__ == "__main__":
    print(table())
