"""Every check is documented, has a signature against which a rubric can be checked, and is tested both ways."""

import ast
import inspect
import re
from collections.abc import Callable, Mapping
from decimal import Decimal
from importlib.metadata import EntryPoint, EntryPoints
from pathlib import Path
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import pytest

from grader.base.errors import RubricError
from grader.lab.checks.check import Check
from grader.lab.checks.outcome import Outcome, judged
from grader.lab.checks.registry import ENTRY_POINTS, check_names, find_check, own_checks
from grader.lab.rubric.rubric import load_rubric
from grader.report.explanations import checks_text, explanation
from grader.ros.urdf.kinematics import Configuration
from tests.checks.cases import CASE, PACKAGE_CASE, PENDING_CASE
from tests.checks.outcomes import AnyCheck, ask
from tests.checks.submissions import REFERENCE

NAMES = [check.name for check in own_checks()]
# A value of each annotation that a parameter may have, as TOML gives it.
SAMPLES: Mapping[Any, Any] = {float: 1, int: 1, str: "a", bool: True}

SCALAR = str | float | bool
CONTENT = SCALAR | list[SCALAR]

every_check = pytest.mark.parametrize("check", own_checks(), ids=NAMES)


@every_check
def test_the_first_paragraph_is_the_fact(check: Check) -> None:
    """A check's docstring starts with a paragraph of its own: the fact that it tests."""
    first, *_ = (inspect.getdoc(check.function) or "").split("\n\n")
    assert " ".join(first.split()) == check.documentation.fact
    assert check.documentation.fact


@every_check
def test_the_signature_is_a_schema(check: Check) -> None:
    """A check takes its subject, and then keyword arguments that a rubric can give, in types that TOML has."""
    every = list(inspect.signature(check.function).parameters.values())
    examined, rest = every[: len(check.examined)], every[len(check.examined) :]
    assert tuple(parameter.name for parameter in examined) == check.examined
    assert {parameter.kind for parameter in examined} == {inspect.Parameter.POSITIONAL_OR_KEYWORD}
    assert [parameter.kind for parameter in rest] == [inspect.Parameter.KEYWORD_ONLY] * len(rest)
    names = {"not_": "not", "from_": "from"}  # keywords of Python
    assert list(check.parameters) == [
        names.get(parameter.name, parameter.name) for parameter in rest
    ]
    for parameter in check.parameters.values():
        assert is_supported(parameter.annotation), parameter
        assert parameter.type.name
        assert parameter.type.parse(sample(parameter.annotation)) is not None
        is_unset = (
            parameter.default is None
        )  # either it is required, or it is not checked unless it is given
        assert (parameter.required or NoneType in get_args(parameter.annotation)) == is_unset
        assert is_unset or parameter.type.parse(as_toml(parameter.default)) == parameter.default


@every_check
def test_every_argument_is_documented(check: Check) -> None:
    """`Args:` names exactly the arguments of the signature, in its order, each with its meaning."""
    meanings = check.documentation.arguments
    assert list(meanings) == list(check.parameters)
    assert all(meanings.values())
    assert "Args" not in " ".join(check.documentation.paragraphs)


@every_check
def test_a_check_has_samples(check: Check) -> None:
    """Every check has a sample that passes and one that fails, with arguments that a rubric can give."""
    assert check.name in {*PENDING_CASE, *CASE, *PACKAGE_CASE}, "add rows to tests/corpus/checks"
    if check.name in PENDING_CASE:
        pending = PENDING_CASE[check.name]
        of: tuple[AnyCheck, Mapping[str, Any]] = (pending.check, pending.arguments)
        assert ask(check.function, REFERENCE, **pending.arguments).status == "pending"
        assert ask(check.function, pending.failing, **pending.arguments).status == "pending"
    else:
        cases = CASE if check.subject in ("urdf", "robot") else PACKAGE_CASE
        assert check.name in cases, (
            f"no sample of {check.name}: the first row needs `scene` or `package`"
        )
        case = cases[check.name]
        of = (case.check, case.arguments)
        assert ask(check.function, case.passing, **case.arguments).status == "passed"
        assert ask(check.function, case.failing, **case.arguments).status == "failed"
    function, arguments = of
    assert function is check.function
    required = {parameter.name for parameter in check.parameters.values() if parameter.required}
    assert required <= set(arguments) <= set(check.parameters)
    for name, value in arguments.items():
        assert check.parameters[name].type.parse(as_toml(value)) == value


@every_check
def test_a_check_can_be_explained(check: Check) -> None:
    """`explain` and the list of checks print the check's sentence, and the type and meaning of each argument."""
    for text in (explanation(check.name, load_rubric("lab6")), checks_text()):
        assert check.name in text
        words = " ".join(text.split())
        assert check.documentation.fact in words
        for parameter in check.parameters.values():
            default = "" if parameter.required else ", default: "
            assert f" {parameter.name}: {parameter.type.name}{default}" in words
            assert check.documentation.arguments[parameter.name] in words


@every_check
def test_a_check_is_found_by_its_name(check: Check) -> None:
    """The name in a rubric is the function's name."""
    assert find_check(check.name) == check
    assert check.name in check_names()
    assert re.fullmatch(r"[a-z][a-z0-9]*(_[a-z0-9]+)*", check.name)


def test_names_are_unique() -> None:
    """No two checks have one name, and no case is for a missing check."""
    assert len(set(NAMES)) == len(NAMES)
    assert sorted((*CASE, *PACKAGE_CASE, *PENDING_CASE)) == sorted(NAMES)


def test_only_manual_checks_are_always_pending() -> None:
    """The checks of a written answer and of a picture are the only ones without a case that passes."""
    assert set(PENDING_CASE) == {"answered", "evidence_shown", "manual"}


def test_every_check_is_registered() -> None:
    """Every function of a module of checks that takes a subject and returns an outcome is in the list."""
    written = {name for path in check_modules() for name in checks_in(path)}
    assert written == set(NAMES)


def test_an_unknown_check_is_not_found() -> None:
    """An unregistered name is no check."""
    assert find_check("shows_bax") is None
    assert find_check("") is None
    assert find_check("describe") is None


def has_links(robot: Configuration, *, at_least: float) -> Outcome:
    """A robot has at least so many links."""
    count = len(robot.robot.links)
    return judged(count >= at_least, f"{count} links", actual=float(count), expected=at_least)


def shows_box(robot: Configuration) -> Outcome:
    """A plug-in check with a name that is taken."""
    raise NotImplementedError


@pytest.fixture
def installed(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Return a function that registers checks as if another distribution did; the requested groups are recorded."""
    requested: list[str] = []
    points = [
        EntryPoint(name, f"{__name__}:{name}", ENTRY_POINTS) for name in ("has_links", "shows_box")
    ]

    def entry_points(*, group: str) -> EntryPoints:
        requested.append(group)
        return EntryPoints(points if group == ENTRY_POINTS else [])

    monkeypatch.setattr("importlib.metadata.entry_points", entry_points)
    return requested


def test_another_distribution_adds_a_check(installed: list[str]) -> None:
    """A check registered under the entry-point group is found, listed and described like the grader's own."""
    check = find_check("has_links")
    assert check is not None
    assert (check.name, check.function, check.subject) == ("has_links", has_links, "robot")
    assert check.documentation.fact == "A robot has at least so many links."
    assert list(check.parameters) == ["at_least"]
    assert check.documentation.arguments == {}  # a plug-in may leave the section out
    assert "\n    at_least: a number\n" in checks_text()
    assert check_names()[: len(NAMES)] == NAMES
    assert "has_links" in check_names()
    assert set(installed) == {"grader.checks"}


def test_the_graders_own_check_takes_precedence(installed: list[str]) -> None:
    """A plug-in check cannot replace the grader's; the entry points are not even read for it."""
    check = find_check("shows_box")
    assert check is not None
    assert check.function is CASE["shows_box"].check
    assert installed == []


def test_a_rubric_can_name_a_plugin_check(installed: list[str], tmp_path: Path) -> None:
    """A rubric's arguments are checked against its signature, and its name is suggested for a misspelt one."""
    text = (
        'id = "r"\ntitle = "R"\n[[part]]\nid = "a"\ntitle = "A"\n'
        '[[criterion]]\nid = "c"\npart = "a"\ntitle = "C"\npoints = 1\ncheck = "{}"\nwith = {{ {} }}\n'
    )
    path = tmp_path / "rubric.toml"
    path.write_text(text.format("has_links", "at_least = 2"), encoding="utf-8")
    criterion = load_rubric(str(path)).criteria[0]
    assert criterion.check.function is has_links
    assert criterion.arguments == {"at_least": 2.0}
    path.write_text(text.format("has_links", "at_lest = 2"), encoding="utf-8")
    with pytest.raises(
        RubricError, match="the check has_links takes no 'at_lest'; did you mean 'at_least'"
    ):
        load_rubric(str(path))
    path.write_text(text.format("has_link", ""), encoding="utf-8")
    with pytest.raises(RubricError, match="there is no check 'has_link'; did you mean 'has_links'"):
        load_rubric(str(path))


def check_modules() -> list[Path]:
    """Return the modules that contain checks."""
    return sorted({Path(inspect.getfile(check.function)) for check in own_checks()})


def checks_in(path: Path) -> list[str]:
    """Return the public functions of a module that return an outcome."""
    body = ast.parse(path.read_text(encoding="utf-8")).body
    functions = [
        node for node in body if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")
    ]
    return [
        function.name
        for function in functions
        if function.returns is not None and ast.unparse(function.returns) == "Outcome"
    ]


def is_supported(annotation: Any) -> bool:
    """Return whether a rubric's table can hold a value of this annotation."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return is_supported(inner[0])
    if origin in (UnionType, Union):
        return all(is_supported(member) for member in inner if member is not NoneType)
    if origin is Literal:
        return all(isinstance(value, str) for value in inner)
    if origin is list:
        return inner[0] in SAMPLES or inner[0] == SCALAR
    if origin is tuple:
        return all(item in (float, Ellipsis) for item in inner) or inner == (str, Ellipsis)
    if origin is not None:
        if not issubclass(origin, Mapping) or inner[0] is not str:
            return False
        return inner[1] in (str, SCALAR, CONTENT) or get_origin(inner[1]) is Literal
    return annotation in SAMPLES


def sample(annotation: Any) -> Any:
    """Return a value for a parameter, as TOML gives it."""
    origin, inner = get_origin(annotation), get_args(annotation)
    if origin is Annotated and "enum" in (items := inner[1].schema.get("items", {})):
        return [items["enum"][0]]
    if origin in (Annotated, UnionType, Union):
        return sample(inner[0])
    if origin is Literal:
        return inner[0]
    if origin is list:
        return [sample(inner[0])]
    if origin is tuple:
        return [SAMPLES[inner[0]]] * (3 if Ellipsis in inner else len(inner))
    if origin is not None:
        return {"a": inner[1].__args__[0] if get_origin(inner[1]) is Literal else "b"}
    return SAMPLES[annotation]


def as_toml(value: object) -> object:
    """Return a Python value as tomllib would give it: lists for tuples, exact numbers for floats."""
    if isinstance(value, tuple | list):
        return [as_toml(item) for item in value]
    if isinstance(value, dict):
        return {key: as_toml(item) for key, item in value.items()}
    return Decimal(repr(value)) if isinstance(value, float) else value


def test_unsupported_types_are_refused() -> None:
    """Types that a rubric cannot give are refused by `is_supported` of this file."""
    for annotation in (
        bytes,
        complex,
        dict[str, int],
        Callable[[], None],
        list[list[float]],
        set[str],
        int | bytes,
        tuple[str, str],
        tuple[bytes, ...],
    ):
        assert not is_supported(annotation)
