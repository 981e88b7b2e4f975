"""What code does when the parameters of its nodes are set at run time."""

import re
from typing import NamedTuple

from grader.base.patterns import on_use
from grader.base.source import Location, Source
from grader.base.text import blanked
from grader.workspace.model.code_text import code_alone
from grader.workspace.model.text_files import CODE_ENDINGS
from grader.workspace.model.workspace import Workspace

_BUILD = "CMakeLists.txt"
_COMMENT = on_use(r"#[^\n]*")  # of CMake
# Callbacks that can refuse values, and those that are told of values that were set.
_REFUSING = on_use(r"\badd_(?:on|pre)_set_parameters_callback\s*+\(")
_TOLD = on_use(
    r"\b(?:add_post_set_parameters_callback|add_parameter_callback"
    r"|add_parameter_event_callback|on_parameter_event)\s*+\("
)
_REFUSES = on_use(
    r"\bsuccessful\s*+=(?!=)\s*+(?!True\b|true\b)|successful\s*+\(\s*+(?!True\b|true\b|\))"
)
# A result that is not successful unless a statement below it says so.
_DEFAULT = on_use(
    r"^([ \t]*+)\S[^\n]*SetParametersResult(?:\s*+\(\s*+\)|\s++\w++\s*+;)", re.MULTILINE
)
_RETURNS = on_use(r"\breturn\b")
_CONDITION = on_use(r"\b(?:if|else)\b")
_THROWS = on_use(r"\bthrow\b")
_SUCCEEDS = on_use(r"^([ \t]*+)\S*successful\s*+=", re.MULTILINE)
# What a descriptor limits a parameter to: a range, or the value that it has first.
_LIMITS = on_use(r"\b(?:floating_point_range|integer_range)\b|\bread_only\s*+=\s*+[Tt]rue\b")
_FROM_MAPPING = on_use(r"\bParameterDescriptor\(\s*+\*\*")
_GENERATES = on_use(r"\bgenerate_parameter_(?:library|module)\b")
_READS = on_use(r"\bget_parameters?\s*+[(<]")


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
    for source in workspace.texts.every_source((*CODE_ENDINGS, _BUILD)):
        code = _strip_comments(source)
        may_refuse = may_refuse or _may_refuse(code)
        for pattern in (_REFUSING, _TOLD, _REFUSES, _LIMITS, _GENERATES, _READS):
            match = pattern.search(code)
            if match:
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
        return _COMMENT.sub(blanked, source.text)
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
    if not made:
        return "SetParametersResult(**" in code
    set_below = list(_SUCCEEDS.finditer(code, made.end()))
    if not set_below or _RETURNS.search(code, made.end(), set_below[0].start()):
        return True
    return any(len(each[1]) > len(made[1]) for each in set_below)
