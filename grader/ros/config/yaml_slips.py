"""The slips for which a YAML file cannot be read.

A slip is a tab or another indentation, a blank after a colon, a bracket or a quote, an equals
sign or nothing for a colon, or an item of a list behind its key.
"""

import re
from collections.abc import Iterable, Iterator, Sequence

from grader.base.grouping import only_one
from grader.base.patterns import on_use
from grader.base.slips import Slip, Slips
from grader.base.source import Edit, Location
from grader.base.text import cut, quoted
from grader.ros.config.yaml_nodes import Visits, YamlFault, YamlNode, read_yaml
from grader.ros.config.yaml_values import PARAMETERS, is_misspelt_key

_MAX_SLIPS = 5  # in one file
_MAX_BYTES = 32 * 1024  # of a file: what may be meant is tried by reading it again
_MAX_LENGTH = 1_000  # characters of a line
_MAX_SHOWN = 60
_MAX_MOVED = 2  # columns of an indentation
_MAX_DEPTH = 5  # of the keys of nodes
_NO_BLANK = on_use(r"(?<![A-Za-z_])([A-Za-z_][\w /.-]{1,80}):(?=[^\s:/]|/[^/])")
_QUOTED_VALUE = on_use(
    r"""\s*(?P<key>[\w.]+):\s+(?P<written>(["'])
    (?P<value>[-+]?(?:\d++\.?\d*+|\.\d++)(?:[eE][-+]?\d++)?|true|false)\3)\s*(?:\#.*)?\Z""",
    re.VERBOSE,
)
# Lines with an item behind its key, with an equals sign, and without a colon; what each is read as.
_MEANT_VALUES = (
    (re.compile(r"^(\s*(?:-\s+)?[\w./]+:\s+)-\s+([^\s#]+)"), r"\1[\2]"),
    (re.compile(r"^(\s*(?:-\s+)?[\w./]+)\s*=\s*(?=\S)"), r"\1: "),
    (re.compile(r"^(\s*(?:-\s+)?[\w./]+)(?=\s+[^\s:#]+\s*(?:#.*)?$)"), r"\1:"),
)
_CLOSING = {"[": "]", "{": "}"}


def yaml_slips(data: bytes, path: str) -> list[Slip]:
    """Return what YAML refuses in a file, each with the change of one line.

    After this change it can be read on. Returns nothing where a line may mean several things.
    """
    if len(data) > _MAX_BYTES:
        return []
    text = data.decode("utf-8", "surrogateescape")
    lines = [line.removesuffix("\r") for line in text.split("\n")]
    slips: list[Slip] = []
    fault = _fault(lines, path)
    while isinstance(fault, YamlFault) and len(slips) < _MAX_SLIPS:
        correction = _meant(fault, lines, path)
        if correction is None:
            return []
        index, new = correction
        slips.append(_slip(fault, index, lines[index], new, path))
        lines[index] = new
        fault = _fault(lines, path)
    if isinstance(fault, YamlFault):
        return []
    return [*slips, *_misspelt_keys(fault, Visits()), *_quoted_values(lines, path)]


def _misspelt_keys(node: YamlNode, visits: Visits, depth: int = 0) -> Slips:
    """Yield the keys that surely stand for ros__parameters, which rcl refuses."""
    if depth == _MAX_DEPTH or not visits.enters(node):
        return
    for key, inner in node.pairs:
        if is_misspelt_key(key, inner):
            location = node.key_location(key)
            edit = Edit(location.path, location.line, location.column, key, PARAMETERS)
            reaction = f"rcl does not know the key {quoted(key)}"
            assumption = f"{key} is read as {PARAMETERS}"
            yield Slip((edit,), reaction, assumption, location, is_refused=True)
        else:
            yield from _misspelt_keys(inner, visits, depth + 1)


def _quoted_values(lines: Sequence[str], path: str) -> Slips:
    """Yield the numbers and booleans of parameters that are texts, because they are in quotes."""
    if not any(line.strip().startswith(f"{PARAMETERS}:") for line in lines):
        return
    for index, line in enumerate(lines):
        match = _QUOTED_VALUE.match(line) if len(line) <= _MAX_LENGTH else None
        if match:
            written = match["written"]
            value = match["value"]
            column = match.start("written") + 1
            edit = Edit(path, index + 1, column, written, value)
            reaction = f"{written} of {match['key']} is a text"
            assumption = f"{written} is read as {value}"
            yield Slip((edit,), reaction, assumption, Location(path, index + 1, column))


def _slip(fault: YamlFault, index: int, written: str, new: str, path: str) -> Slip:
    shown = [quoted(cut(" ".join(text.split()), _MAX_SHOWN)) for text in (written, new)]
    assumption = f"{shown[0]} is read as {shown[1]}"
    if shown[0] == shown[1]:
        blanks = [len(text) - len(text.lstrip()) for text in (written, new)]
        assumption = f"the indentation of {blanks[0]} blanks is read as {blanks[1]}"
        if "\t" in written[: blanks[0]]:
            assumption = "the tab before it is read as blanks"
    edit = Edit(path, index + 1, 1, written, new)
    location = Location(path, index + 1, 1)
    return Slip((edit,), f"the file is no YAML: {fault}", assumption, location, is_refused=True)


def _fault(lines: Sequence[str], path: str) -> YamlFault | YamlNode:
    try:
        return read_yaml("\n".join(lines).encode("utf-8", "surrogateescape"), path)
    except YamlFault as fault:
        return fault


def _meant(fault: YamlFault, lines: list[str], path: str) -> tuple[int, str] | None:
    """Return the line, and what it is read as, after which the file can be read, or read on."""
    further: tuple[int, str] | None = None
    complete: dict[object, tuple[int, str]] = {}  # by what the file is then
    at = fault.location.line - 1
    for index in range(max(at - 2, 0), min(at + 1, len(lines))):
        for new in _changes(lines, index):
            after = list(lines)
            after[index] = new
            result = _fault(after, path)
            if isinstance(result, YamlNode):
                complete.setdefault(_plain(result), (index, new))
            elif result.location.line > fault.location.line:
                further = further or (index, new)
    if complete:
        return only_one(complete.values())
    return further


def _plain(root: YamlNode) -> tuple[object, ...]:
    """Return what a node holds, to compare it; what an alias stands for is only numbered again."""
    held = []
    numbers: dict[YamlNode, int] = {}
    waiting: list[object] = [root]
    while waiting:
        part = waiting.pop()
        if not isinstance(part, YamlNode):
            held.append(part)
        elif isinstance(part.value, str):
            held.append(part.value)
        elif part in numbers:
            held.append(numbers[part])
        else:
            numbers[part] = len(numbers)
            held += (type(part.value), len(part.value))
            waiting += part.value.values() if isinstance(part.value, dict) else part.value
            waiting += [tuple(part.value)] if isinstance(part.value, dict) else []
    return tuple(held)


def _changes(lines: Sequence[str], index: int) -> Iterator[str]:
    """Yield a line as it may be meant."""
    line = lines[index]
    if len(line) > _MAX_LENGTH or not line.strip():
        return
    yield from _with_other_indentation(lines, index)
    for pattern, meant in ((_NO_BLANK, r"\1: "), *_MEANT_VALUES):
        changed = pattern.sub(meant, line, count=1)
        if changed != line:
            yield changed
    code, _, comment = line.partition(" #")
    rest = f" #{comment}" if comment else ""
    for opening, closing in _CLOSING.items():
        if code.count(opening) > code.count(closing):
            yield f"{code.rstrip()}{closing}{rest}"
    for quote in "'\"":
        if code.count(quote) % 2:
            yield f"{code.rstrip()}{quote}{rest}"


def _with_other_indentation(lines: Sequence[str], index: int) -> Iterator[str]:
    """Yield a line with the indentation of its neighbours, or of those above where it has tabs."""
    line = lines[index]
    content = line.lstrip()
    blanks = line[: len(line) - len(content)]
    above = _list_texts(reversed(lines[:index]))
    below = _list_texts(lines[index + 1 :])
    near = (above + below)[:2] if "\t" in blanks else above[:1] + below[:1]
    for other in near:
        others = other[: len(other) - len(other.lstrip())]
        if "\t" in blanks or abs(len(others) - len(blanks)) <= _MAX_MOVED:
            yield others + content


def _list_texts(lines: Iterable[str]) -> list[str]:
    """Return the lines that are not empty and begin with no tab."""
    return [line for line in lines if line.strip() and not line.startswith("\t")]
