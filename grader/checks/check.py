"""A check, as a rubric names it, and how its signature is read."""

import inspect
import sys
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from itertools import takewhile
from typing import TYPE_CHECKING, Any, Literal, get_args, get_type_hints

from grader.checks.about import About
from grader.checks.outcome import Outcome
from grader.checks.toml_types import TomlType, toml_type
from grader.errors import InputError

if TYPE_CHECKING:
    from grader.checks.docstring import Documentation


# The arguments of checks that name links, or list their names.
LINK_ARGUMENTS = ("link", "leader", "relative_to", "parent", "holds", "on", "of", "base", "links", "wheels")


Subject = Literal["urdf", "robot", "package", "submission", "reference"]


SUBJECTS: tuple[Subject, ...] = get_args(Subject)


@dataclass(frozen=True, slots=True)
class Parameter:
    """One argument of a check: its annotation, and its default if it has one."""

    name: str
    annotation: Any
    required: bool
    default: object = None

    @property
    def type(self) -> TomlType:
        """The type of the TOML value that a rubric gives."""
        return toml_type(self.annotation)


@dataclass(frozen=True, slots=True)
class Check:
    """A check, as a rubric names it.

    `examined` are the objects that it gets, the main one first: the URDF as it was read, its robot, the package, the
    whole submission, or the robot of the reference solution. `distribution` is the installed package that the check
    comes from; empty for the grader's own. `about` is what its module declares of it.
    """

    name: str
    function: Callable[..., Outcome]
    examined: tuple[Subject, ...]
    parameters: Mapping[str, Parameter]
    distribution: str = ""
    about: About = field(default_factory=About)

    @property
    def subject(self) -> Subject:
        """The main object that it examines."""
        return self.examined[0]

    @property
    def documentation(self) -> "Documentation":
        """What its docstring says. The fact is true of a submission that passes."""
        from grader.checks.docstring import documentation  # late: grading does not read it

        return documentation(self.function)


def describe(function: Callable[..., Outcome], distribution: str = "") -> Check:
    """Return the check that a function is: its signature is the schema of the rubric's `with` table.

    Raises InputError for a signature that is no schema.
    """
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
        parameters[name] = Parameter(name, hints[name], is_required, None if is_required else default)
    main = subject.name if subject.name in SUBJECTS else "robot"
    examined = tuple(
        name for given in (main, *(parameter.name for parameter in also)) for name in SUBJECTS if name == given
    )
    name = function.__name__
    about = getattr(sys.modules.get(function.__module__), "ABOUT", {}).get(name, About())
    if not isinstance(about, About):
        raise InputError(f"ABOUT says of {name} what is no About(...)")
    return Check(name, function, examined, parameters, distribution, about)


def _is_subject(parameter: inspect.Parameter) -> bool:
    """Return whether a parameter after the first is another object that is examined: it is no keyword-only argument."""
    return parameter.kind is parameter.POSITIONAL_OR_KEYWORD and parameter.name in SUBJECTS
