"""The text of a new rubric, in TOML as a person writes it: its keys, default tolerances, a criterion for each fact."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from grader.checks.measures.fact import Fact
from grader.checks.registry import check_names, usable_check
from grader.grading.toml_rows import assignment, toml_literal
from grader.text import printable

WIDTH = 120  # columns


def toml_lines(key: str, value: Any) -> Iterator[str]:
    """Yield a line that sets a key, or, of a list that is too long for one, a line for each item."""
    line = assignment(key, value)
    if len(line) <= WIDTH or not isinstance(value, list):
        yield line
        return
    yield f"{line.partition(' = ')[0]} = ["
    yield from (f"    {toml_literal(item)}," for item in value)
    yield "]"


_ROBOT, _PACKAGE = "robot", "package"
_MAX_ID = 60


class Head(NamedTuple):
    """What a rubric says of the lab. `reference` is a path relative to the rubric.

    `package` is empty without one, and so is `schema`, the path of a JSON Schema for editors.
    """

    id: str
    title: str
    reference: str
    urdf: str
    package: str
    schema: str = ""


def rubric_text(head: Head, facts: Mapping[str, Fact]) -> str:
    """Return a rubric with a criterion for each fact, by the ids of the criteria."""
    of_package = sum(fact.of_package for fact in facts.values())
    lines = [
        *_head(head, len(facts)),
        *_defaults({fact.check for fact in facts.values()}),
        *_part(_ROBOT, "The robot", "urdf", len(facts) - of_package),
        *(_part(_PACKAGE, "The package", "package", of_package) if of_package else ()),
    ]
    about = ""
    for name, fact in facts.items():
        if fact.about != about:
            about = fact.about
            lines += ["", _heading(about)]
        lines += _criterion(name, fact)
    return "\n".join(lines) + "\n"


def criterion_ids(facts: Sequence[Fact]) -> dict[str, Fact]:
    """Return the facts by their ids: words of the names that they are about, such as upper-arm-mass."""
    found: dict[str, Fact] = {}
    numbers: dict[str, int] = {}  # the last that each name got
    for fact in facts:
        words = re.sub(r"[\W_]+", "-", f"{fact.subject} {fact.aspect}".lower()).strip("-")[:_MAX_ID].strip("-")
        name = words = words or "criterion"
        while name in found:
            numbers[words] = numbers.get(words, 1) + 1
            name = f"{words}-{numbers[words]}"
        found[name] = fact
    return found


def _head(head: Head, points: int) -> Iterator[str]:
    yield from [f"#:schema {head.schema}"] if head.schema else []
    yield from (assignment("id", head.id), assignment("title", head.title))
    yield f"{assignment('reference', head.reference)}  # the solution that must get full marks"
    yield f"{assignment('urdf', head.urdf)}  # where a package keeps the file that is graded"
    yield from (
        [f"{assignment('package', head.package)}  # the name of the package that is graded"] if head.package else []
    )
    yield assignment("points", points)


def _defaults(checks: set[str]) -> Iterator[str]:
    yield from ("", "[defaults]", assignment("part", _ROBOT), assignment("points", 1))
    known = (usable_check(name) for name in check_names() if name in checks)
    usuals = [(check.name, check.about.usual) for check in known if check is not None and check.about.usual]
    yield from ("", "[defaults.with]") if usuals else ()
    yield from (f"{assignment(name, usual.arguments)}  # {usual.unit}" for name, usual in usuals)


def _part(name: str, title: str, needs: str, points: int) -> Iterator[str]:
    yield from ("", "[[part]]", assignment("id", name), assignment("title", title))
    yield from (assignment("needs", needs), assignment("points", points))


def _heading(about: str) -> str:
    return f"# --- {printable(about)} ".ljust(WIDTH, "-")


def _criterion(name: str, fact: Fact) -> Iterator[str]:
    yield from ("", "[[criterion]]", assignment("id", name))
    if fact.of_package:
        yield assignment("part", _PACKAGE)
    if fact.about:
        yield assignment("about", printable(fact.about))
    yield assignment("title", printable(fact.title))
    yield f"check = {toml_literal(fact.check)}"
    if len(assignment("with", fact.arguments)) <= WIDTH:
        yield from [assignment("with", fact.arguments)] if fact.arguments else []
        return
    yield from ("", "[criterion.with]")
    for key, value in sorted(fact.arguments.items(), key=lambda item: isinstance(item[1], Mapping)):
        is_long = isinstance(value, Mapping) and len(assignment(key, value)) > WIDTH
        yield from ("", f"[criterion.with.{key}]") if is_long else ()
        for inner, item in value.items() if is_long else ((key, value),):
            yield from toml_lines(inner, item)
