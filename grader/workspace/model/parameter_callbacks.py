"""What code does when the parameters of its nodes are set at run time."""

import re
from typing import NamedTuple

from grader.base.source import Location, Source
from grader.workspace.model.code_text import code_alone
from grader.workspace.model.workspace import Workspace

_ENDINGS = (".py", ".cpp", ".cc", ".cxx", ".hpp", ".h")
_BUILD = "CMakeLists.txt"
_COMMENT = re.compile(r"#[^\n]*")  # of CMake
# Callbacks that can refuse values, and those that are told of values that were set.
_REFUSING = re.compile(r"\badd_(?:on|pre)_set_parameters_callback\s*+\(")
_TOLD = re.compile(
    r"\b(?:add_post_set_parameters_callback|add_parameter_callback"
    r"|add_parameter_event_callback|on_parameter_event)\s*+\("
)
_REFUSES = re.compile(
    r"\bsuccessful\s*+=(?!=)\s*+(?!True\b|true\b)|successful\s*+\(\s*+(?!True\b|true\b|\))"
)
# A result that is not successful unless a statement below it says so.
_DEFAULT = re.compile(
    r"^([ \t]*+)\S[^\n]*SetParametersResult(?:\s*+\(\s*+\)|\s++\w++\s*+;)", re.MULTILINE
)
_RETURNS = re.compile(r"\breturn\b")
_CONDITION = re.compile(r"\b(?:if|else)\b")
_THROWS = re.compile(r"\bthrow\b")
_SUCCEEDS = re.compile(r"^([ \t]*+)\S*successful\s*+=", re.MULTILINE)
# What a descriptor limits a parameter to: a range, or the value that it has first.
_LIMITS = re.compile(r"\b(?:floating_point_range|integer_range)\b|\bread_only\s*+=\s*+[Tt]rue\b")
_FROM_MAPPING = re.compile(r"\bParameterDescriptor\(\s*+\*\*")
_GENERATES = re.compile(r"\bgenerate_parameter_(?:library|module)\b")
_READS = re.compile(r"\bget_parameters?\s*+[(<]")


class _ParameterCallbacks(NamedTuple):
    """Where code is told that parameters are set, and where it can refuse values; None for nowhere.

    A library may make more code of a table of parameters.
    """

    told: Location | None
    refuses: Location | None
    is_generated: bool  # whether a library makes code for parameters
    is_read: bool  # whether code reads the values of parameters, perhaps again and again
    may_refuse: bool  # whether a condition may decide that a result is successful


def parameter_callbacks(workspace: Workspace) -> _ParameterCallbacks:
    """Return where the code of the packages is told of parameters, and can refuse values."""
    first: dict[re.Pattern[str], Location] = {}
    may_refuse = False
    for package in workspace.packages:
        for source in workspace.texts.read_sources(package, (*_ENDINGS, _BUILD)):
            code = _strip_comments(source)
            may_refuse = may_refuse or _may_refuse(code)
            for pattern in (_REFUSING, _TOLD, _REFUSES, _LIMITS, _GENERATES, _READS):
                match = pattern.search(code)
                if match is not None:
                    first.setdefault(pattern, source.at(match.start()))
    can_refuse = first.get(_REFUSING) if _REFUSES in first else None
    return _ParameterCallbacks(
        first.get(_REFUSING) or first.get(_TOLD),
        can_refuse or first.get(_LIMITS),
        _GENERATES in first,
        _READS in first,
        may_refuse,
    )


def _strip_comments(source: Source) -> str:
    """Return a text without its comments, and without the texts in code."""
    if source.path.endswith(_BUILD):
        return _COMMENT.sub(lambda match: " " * len(match[0]), source.text)
    return code_alone(source.text, source.path)


def _may_refuse(code: str) -> bool:
    """Return whether a condition may decide that a result is successful, or an error ends it.

    A descriptor that is made from a mapping may do so, too.
    """
    if _FROM_MAPPING.search(code) or not _REFUSING.search(code):
        return _FROM_MAPPING.search(code) is not None
    lines = [line.partition("successful") for line in code.split("\n")]
    if _THROWS.search(code) or any(word and _CONDITION.search(start) for start, word, _ in lines):
        return True
    made = _DEFAULT.search(code)
    if made is None:
        return "SetParametersResult(**" in code
    set_below = [*_SUCCEEDS.finditer(code, made.end())]
    if not set_below or _RETURNS.search(code, made.end(), set_below[0].start()):
        return True
    return any(len(each[1]) > len(made[1]) for each in set_below)
