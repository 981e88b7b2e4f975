"""Rows of the corpus of checks: an edit of a scene or of a package, arguments, and what a check finds in it.

tests/corpus/checks/README.md describes their form.
"""

import re
import tomllib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from pathlib import Path
from typing import Any

from grader.base.errors import MissingElement, NotDecided, RubricError
from grader.base.source import LazyLocation, Location
from grader.lab.checks.check import Check
from grader.lab.checks.registry import own_checks
from grader.ros.urdf.shapes import UnknownShape
from tests.checks.outcomes import AnyCheck, Arguments, NoSubject, ask, graded, own_message
from tests.checks.robots import PATH, Scene
from tests.checks.submissions import REFERENCE, Submitted
from tests.recordings import cart

CORPUS = Path(__file__).parents[1] / "corpus" / "checks"
GIVEN = (
    "about",
    "scene",
    "urdf",
    "package",
    "removed",
    "renamed",
    "files",
    "copies",
    "recorded",
    "edits",
    "reference",
    "with",
)
_LONG = 1_000  # characters of an answer, of which the rest is counted
_REST = 60  # characters of the line that are shown from a place on

Fields = Mapping[str, Any]


@dataclass(frozen=True, slots=True)
class Row:
    """What a check gets, and what it is expected to find, as lines of TOML."""

    check: Check
    index: int
    given: Fields
    expected: str

    @property
    def name(self) -> str:
        """Return the name of the check, and the number and meaning of the row."""
        return f"{self.check.name}-{self.index + 1}: {self.given['about']}"

    @property
    def subject(self) -> Scene | Submitted:
        """Return the robot or the submission."""
        if "package" in self.given:
            return submitted(self.given)
        text = (
            whole(self.given["urdf"]) if "urdf" in self.given else scene_text(self.given["scene"])
        )
        return Scene(edited(text, self.given.get("edits", ())))

    @property
    def arguments(self) -> dict[str, Any]:
        """Return the arguments as the rubric reader makes them of a table of TOML."""
        types = {name: parameter.type for name, parameter in self.check.parameters.items()}
        return {name: types[name].parse(value) for name, value in self.given["with"].items()}

    def found(self) -> str:
        """Return what the check finds now."""
        reference = Scene(scene_text(self.given.get("reference", "arm")))
        return finding(self.check.function, self.subject, reference, self.arguments)


def finding(check: AnyCheck, of: Scene | Submitted, reference: Scene, arguments: Arguments) -> str:
    """Return what a check finds as the criterion of a rubric, and what is different if it is called alone."""
    try:
        outcome = graded(check, of, reference, **arguments)
    except RubricError as error:
        return lines({"status": "refused", "message": str(error)})
    found = _fields(outcome._asdict(), of)
    try:
        alone = _fields(ask(check, of, reference, **arguments)._asdict(), of)
    except MissingElement as error:
        alone = {"missing": [error.kind, error.name, *error.known], "message": str(error)}
        alone |= _fields(
            {"location": error.location, "mistake": error.mistake, "problem": error.problem}, of
        )
    except (NotDecided, UnknownShape) as error:
        alone = {
            "open": type(error).__name__,
            "message": str(error),
            "mistake": getattr(error, "cause", ""),
        }
    except NoSubject:
        alone = {}
    message = own_message(outcome)
    usual = {
        **found,
        "message": message.removesuffix("; needs manual grading") if "open" in alone else message,
    }
    different = {key: value for key, value in alone.items() if usual.get(key) != value}
    return lines({**found, "alone": different} if different else found)


def whole(value: Any) -> str:
    """Return a text, or the texts of a list, each of which may be a table with the `times` that it is repeated."""
    if isinstance(value, list):
        return "".join(map(whole, value))
    return value["text"] * value.get("times", 1) if isinstance(value, Mapping) else str(value)


def edited(text: str, edits: Any) -> str:
    """Return a text with parts replaced, each of which must occur exactly once."""
    for old, new in edits:
        assert text.count(old) == 1, f"{old!r} stands {text.count(old)} times in\n{text}"
        text = text.replace(old, new)
    return text


@cache
def scene_text(name: str) -> str:
    """Return the text of a scene."""
    return (CORPUS / "scenes" / f"{name}.urdf").read_text(encoding="utf-8")


@cache
def _packages() -> dict[str, Any]:
    return tomllib.loads((CORPUS / "scenes" / "packages.toml").read_text(encoding="utf-8"))


def submitted(given: Fields) -> Submitted:
    """Return a package with its changes."""
    name = given["package"]
    bases = {
        "reference": REFERENCE,
        "empty": Submitted({}),
        "cart": Submitted({"cart.urdf": cart.URDF}),
    }
    of = bases[name] if name in bases else submitted(_packages()[name])
    of = of.without(*given.get("removed", ()))
    for old, new in given.get("renamed", {}).items():
        of = of.renaming(old, new)
    encoded = {
        path: whole(text).encode(_encoding(text)) for path, text in given.get("files", {}).items()
    }
    copied = {
        path: (CORPUS / "files" / name).read_bytes()
        for path, name in given.get("copies", {}).items()
    }
    of = of.with_files(encoded | copied)
    for name, options in given.get("recorded", {}).items():
        of = of.with_files(cart.files_of(name, _floats(options)))
    for path, old, new in given.get("edits", ()):
        of = of.with_files({path: edited(of.data(path).decode(), [(old, new)])})
    return of


def _encoding(text: Any) -> str:
    return str(text.get("encoding", "utf-8")) if isinstance(text, Mapping) else "utf-8"


def _fields(found: Fields, of: Scene | Submitted) -> dict[str, Any]:
    """Return the fields that are not empty, with the place in words."""
    fields = {
        key: value for key, value in found.items() if value is not None and value not in ("", ())
    }
    if len(str(fields.get("measured", ""))) > _LONG:
        fields["measured"] = (
            f"{fields['measured'][:40]} ... {fields['measured'][-40:]}: {len(fields['measured'])} characters"
        )
    at = fields.pop("location", None)
    return {**fields, "place": _place(at, of)} if at is not None else fields


def _place(at: Location | LazyLocation, of: Scene | Submitted) -> str:
    """Return line and column, and what stands there; in a submission also the path."""
    found = at.resolve() if isinstance(at, LazyLocation) else at
    text = of.text if isinstance(of, Scene) else of.data(found.path).decode(errors="replace")
    rest = text.split("\n")[found.line - 1][found.column - 1 :][:_REST].rstrip()
    path = "" if found.path == PATH else f"{found.path}:"
    return f"{path}{found.line}:{found.column} {rest}".rstrip()


def lines(fields: Fields) -> str:
    """Return fields as lines of TOML."""
    return "".join(f"{key} = {toml(value)}\n" for key, value in fields.items())


def toml(value: object) -> str:
    """Return a value of TOML; numbers have six digits."""
    match value:
        case bool():
            return str(value).lower()
        case int() | float():
            return f"{round(value, 9) + 0.0:.6g}"
        case Mapping():
            return (
                "{ " + ", ".join(f"{_key(key)} = {toml(one)}" for key, one in value.items()) + " }"
            )
        case list() | tuple():
            return f"[{', '.join(map(toml, value))}]"
    return _quoted(str(value))


def _key(key: str) -> str:
    return key if re.fullmatch(r"[\w-]+", key, re.ASCII) else _quoted(key)


def _quoted(text: str) -> str:
    is_plain = re.fullmatch(r"[^\x00-\x08\x0b-\x1f\x7f]*", text) is not None
    if "\n" in text and is_plain and "'''" not in text and not text.endswith("'"):
        return f"'''\n{text}'''"
    if is_plain and "\n" not in text and "'" not in text and ('"' in text or "\\" in text):
        return f"'{text}'"
    escaped = (
        text.replace("\\", "\\\\").replace('"', '\\"').replace("\n", "\\n").replace("\t", "\\t")
    )
    return '"' + re.sub(r"[\x00-\x1f\x7f]", lambda found: f"\\u{ord(found[0]):04x}", escaped) + '"'


def tables() -> Iterator[tuple[Check, Mapping[str, Any]]]:
    """Yield every check with its table, in the order of the catalogue; numbers are those of a rubric."""
    for check in own_checks():
        path = CORPUS / f"{check.name}.toml"
        if path.exists():
            yield check, tomllib.loads(path.read_text(encoding="utf-8"), parse_float=Decimal)


def rows_of(check: Check, table: Mapping[str, Any]) -> Iterator[Row]:
    """Yield the rows of a table; one without `about` continues the one before, and `with` adds to that of the table."""
    about = ""
    for index, row in enumerate(table["row"]):
        about = row.get("about", about)
        given = {"about": about, **{key: row[key] for key in GIVEN if key in row}}
        given["with"] = {**table.get("with", {}), **row.get("with", {})}
        expected = {key: _floats(value) for key, value in row.items() if key not in GIVEN}
        yield Row(check, index, given, lines(expected))


def read_rows() -> Iterator[Row]:
    """Yield the rows of all checks."""
    for check, table in tables():
        yield from rows_of(check, table)


def _floats(value: Any) -> Any:
    match value:
        case Decimal():
            return float(value)
        case list():
            return [_floats(one) for one in value]
        case dict():
            return {key: _floats(one) for key, one in value.items()}
    return value
