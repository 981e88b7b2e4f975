"""A check: what a rubric names.

It has what its signature and docstring say, and what it declares to hints and pictures.
"""

import inspect
import re
import sys
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from itertools import takewhile
from keyword import iskeyword, kwlist
from typing import Any, Literal, NamedTuple, get_args, get_type_hints

from grader.base.errors import InputError
from grader.base.grouping import Strings, StringsByName
from grader.base.records import Named
from grader.base.toml_types import TomlType, toml_type
from grader.lab.checks.outcome import MISSING, SLIP, WRONG, Outcome

# The ways in which the text of a robot is rewritten to an equal robot, in the order in which they
# are tried.
MIMIC_TURNED = "mimic joints with the other sign"
EQUIVALENTS = (
    "order of elements",
    "fixed joints split",
    "frames moved",
    "links renamed",
    "joints renamed",
    MIMIC_TURNED,
    "layout of the text",
    "xacro properties",
    "xacro macro",
)
_BreaksUnder = Callable[[Mapping[str, Any]], Collection[str]]
CAUSES = {
    WRONG: "what is examined is there, and is not as it should be",
    MISSING: "something that the check needs does not exist or cannot be read",
    SLIP: "a misspelt word or sign, with whose correction the rest is graded",
}
_SECTION = r"(?m)^(Args|Arguments|Examples?|Notes?|Raises|Returns):\s*$"
_ARGUMENT = r"^\*{0,2}(\w+)(?:\s*\([^)]*\))?:\s+"
_Given = Mapping[str, Any]  # the arguments of a check
_Function = Callable[..., Outcome]


def _breaks_under_none(arguments: _Given) -> Collection[str]:
    """Break under no equivalent, as most checks do: they are about behaviour."""
    del arguments
    return ()


def everything(arguments: _Given) -> Collection[str]:
    """Break under every equivalent: the check is about the text."""
    del arguments
    return EQUIVALENTS


class About(Named):
    """What a check declares, in the table `ABOUT` of its module by the name of its function.

    `looks_at` are the files of a package (`setup.py`, `package.xml`, `launch`, `rviz`) or the tags
    of a URDF (`limit`, `visual/origin`, `joint@type`) on which the result depends, where hints
    propose edits. `breaks_under` are the equivalents of a robot under which a criterion with such
    arguments may fail. `picture` is what a failure shows of the reference: the outline of the link
    or its frame; a `wheel` shows how it rolls. `function_for` returns what is called for such
    arguments, where they decide what is examined. A check that `is_of_writing` judges the words as
    they are written, not what a misspelt one surely stands for. `causes` are those of its
    failures beside `CAUSES`, each with its meaning, which the feedback of a rubric may name.
    """

    looks_at: Strings = ()
    breaks_under: _BreaksUnder = _breaks_under_none
    picture: Literal["", "outline", "wheel", "frame"] = ""
    function_for: Callable[[_Given], _Function] | None = None
    is_of_writing: bool = False
    causes: Mapping[str, str] = {}


# The arguments of checks that name links, or list their names.
LINK_ARGUMENTS = (
    "link",
    "leader",
    "relative_to",
    "parent",
    "holds",
    "on",
    "of",
    "base",
    "links",
    "wheels",
)


Subject = Literal["urdf", "robot", "package", "submission", "reference"]
_SUBJECTS = get_args(Subject)


class _CheckParameter(Named):
    """One argument of a check: its annotation, and its default if it has one."""

    name: str
    annotation: Any
    required: bool
    default: object = None

    @property
    def type(self) -> TomlType:
        """The type of the TOML value that a rubric gives."""
        return toml_type(self.annotation)


_KEYWORDS = frozenset(kwlist)


class Check(NamedTuple):
    """A check, as a rubric names it."""

    name: str
    function: _Function
    examined: tuple[Subject, ...]  # the objects that it gets, the main one first
    parameters: Mapping[str, _CheckParameter]  # what the rubric's `with` table gives
    distribution: str = ""  # the installed package that it comes from; empty for the grader's own
    about: About = About()  # what its module declares of it

    def for_arguments(self, arguments: _Given) -> "Check":
        """Return the check as it is called with these arguments.

        They may decide what is examined.
        """
        if self.about.function_for is not None:
            function = self.about.function_for(arguments)
        else:
            function = self.function
        if function is self.function:
            return self
        parameters = list(inspect.signature(function).parameters.values())
        return self._replace(function=function, examined=_examined(parameters))

    def outcome(self, examined: Iterable[object], arguments: _Given) -> Outcome:
        """Return what it finds in the objects that it examines, with the arguments of a rubric."""
        if not _KEYWORDS.isdisjoint(arguments):
            arguments = {
                f"{key}_" if iskeyword(key) else key: argument
                for key, argument in arguments.items()
            }
        return self.function(*examined, **arguments)

    @property
    def subject(self) -> Subject:
        """The main object that it examines."""
        return self.examined[0]

    @property
    def is_of_robot(self) -> bool:
        """Whether it examines a robot, as it is written or as ROS 2 reads it."""
        return self.subject in ("urdf", "robot")

    @property
    def causes(self) -> StringsByName:
        """The causes of its failures, each with its meaning."""
        return {**CAUSES, **self.about.causes}

    @property
    def documentation(self) -> "Documentation":
        """What its docstring says. The fact is true of a submission that passes."""
        return documentation(self.function)


def describe(function: _Function, distribution: str = "") -> Check:
    """Return the check that a function is.

    Its signature is the schema of the rubric's `with` table.

    An argument whose key is a keyword of Python, such as `not`, has an underscore behind it in the
    function: `not_`. Raises InputError for a signature that is no schema.
    """
    hints = function.__annotations__
    if any(isinstance(hint, str) for hint in hints.values()):
        hints = get_type_hints(function, include_extras=True)
    subject, *rest = inspect.signature(function).parameters.values()
    for parameter in (subject, *rest):
        if parameter.kind not in (parameter.KEYWORD_ONLY, parameter.POSITIONAL_OR_KEYWORD):
            raise InputError(f"its argument {parameter} cannot be given by name")
        if parameter.name not in hints:
            raise InputError(f"its argument {parameter.name} has no annotation")
    also = list(takewhile(_is_subject, rest))
    parameters = {}
    for name, default in ((parameter.name, parameter.default) for parameter in rest[len(also) :]):
        is_required = default is inspect.Parameter.empty
        key = _key(name)
        parameters[key] = _CheckParameter(
            key, hints[name], is_required, None if is_required else default
        )
    examined = _examined([subject, *also])
    name = function.__name__
    about = getattr(sys.modules.get(function.__module__), "ABOUT", {}).get(name, About())
    if not isinstance(about, About):
        raise InputError(f"ABOUT says of {name} what is no About(...)")
    return Check(name, function, examined, parameters, distribution, about)


def _examined(parameters: Sequence[inspect.Parameter]) -> tuple[Subject, ...]:
    """Return what a function with these parameters examines: the first one, and those after it."""
    subject, *rest = parameters
    main = subject.name if subject.name in _SUBJECTS else "robot"
    names = [main, *(parameter.name for parameter in takewhile(_is_subject, rest))]
    return tuple(name for given in names for name in _SUBJECTS if name == given)


def _key(name: str) -> str:
    """Return the key of an argument in a rubric."""
    if iskeyword(name.removesuffix("_")):
        return name.removesuffix("_")
    return name


def _is_subject(parameter: inspect.Parameter) -> bool:
    """Return whether a parameter after the first is another object that is examined.

    Such a parameter is no keyword-only argument.
    """
    return parameter.kind is parameter.POSITIONAL_OR_KEYWORD and parameter.name in _SUBJECTS


class Documentation(Named):
    """The parts of a docstring.

    They are the paragraphs before its first section, a fact first, and the meaning of each
    argument.
    """

    paragraphs: Strings
    arguments: StringsByName

    @property
    def fact(self) -> str:
        """The first paragraph, in one line."""
        return self.paragraphs[0] if self.paragraphs else ""


def documentation(function: Callable[..., Any]) -> Documentation:
    """Return what the docstring of a function says.

    A function without one, or without `Args:`, has empty parts.
    """
    text, *sections = re.split(_SECTION, inspect.getdoc(function) or "")
    named = dict(zip(sections[::2], sections[1::2], strict=True))
    paragraphs = tuple(
        _one_line(paragraph) for paragraph in text.split("\n\n") if paragraph.strip()
    )
    return Documentation(
        paragraphs, _arguments(inspect.cleandoc(named.get("Args", named.get("Arguments", ""))))
    )


def _arguments(section: str) -> dict[str, str]:
    """Return the entries of an `Args:` section by name.

    An entry continues on lines that are indented further.
    """
    entries = (re.split(_ARGUMENT, entry) for entry in re.split(r"\n(?=\S)", section))
    return {
        _key(entry_match[1]): _one_line(entry_match[2])
        for entry_match in entries
        if len(entry_match) == 3
    }


def _one_line(text: str) -> str:
    return " ".join(text.split())
