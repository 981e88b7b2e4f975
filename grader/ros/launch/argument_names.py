"""The arguments of launch files where a file declares them, and where it uses them.

They are as they are written.
"""

import ast
import re
from collections.abc import Iterator
from contextlib import suppress
from typing import NamedTuple

from grader.base import markup
from grader.base.grouping import Span
from grader.base.patterns import on_use
from grader.base.source import Source
from grader.base.text import blanked
from grader.ros.python.parse import Code, location_in, make_position, parse
from grader.ros.python.walking import walk
from grader.ros.xml.parsing import XmlFault, XmlFile

# The classes of launch whose first argument is the name of a launch configuration, with the keyword
# that it may have, and whether they give it a value.
_CALLS = {
    "DeclareLaunchArgument": ("name", True),
    "SetLaunchConfiguration": ("name", True),
    "UnsetLaunchConfiguration": ("name", False),
    "LaunchConfiguration": ("variable_name", False),
    "LaunchConfigurationEquals": ("launch_configuration_name", False),
    "LaunchConfigurationNotEquals": ("launch_configuration_name", False),
}
_OPENING = on_use(r"(?i:[rbuf]{0,2})(\"{3}|'{3}|\"|')")
_VARIABLE = on_use(r"\$\(\s*var\s+['\"]?([\w.-]+)")
_COMMENT = on_use(r"<!--.*?(?:-->|\Z)", re.DOTALL)
_YAML_COMMENT = on_use(r"(?:^|(?<=\s))#[^\n]*")
_YAML_ARGUMENT = on_use(
    r"-\s+(?:arg|let)\s*+:\s*+(?:\{\s*+)?(?:[\w-]+\s*:[^\n{}]{0,200}\n\s*)*?name\s*:\s*['\"]?([\w.-]+)"
)


class _ArgumentName(NamedTuple):
    """The name of a launch argument, at the offsets in a text, without quotes."""

    name: str
    is_definition: bool
    start: int
    end: int


def argument_names(data: bytes, path: str) -> tuple[Source, list[_ArgumentName]]:
    """Return the text of a launch file, and the names of arguments in it.

    The names are in the order of the text.
    """
    if path.endswith(".py"):
        code = parse(data, path)
        names = list(_in_python(code)) if isinstance(code, Code) else []
        return code.source, sorted(names, key=lambda argument: argument.start)
    source = Source.decoded(path, data)
    read = _in_yaml(source) if path.endswith((".yaml", ".yml")) else _in_xml(data, source)
    names = list(read)
    return source, sorted(names, key=lambda argument: argument.start)


def _in_python(code: Code) -> Iterator[_ArgumentName]:
    for node in walk(code.tree):
        if not isinstance(node, ast.Call):
            continue
        called = node.func.attr if isinstance(node.func, ast.Attribute) else None
        if isinstance(node.func, ast.Name):
            called = node.func.id
        if called not in _CALLS:
            continue
        keyword, is_definition = _CALLS[called]
        named = [given.value for given in node.keywords if given.arg == keyword]
        for value in node.args[:1] + named:
            span = _span_of_text(code.source, value)
            if span is not None and isinstance(value, ast.Constant):
                yield _ArgumentName(str(value.value), is_definition, *span)


def _span_of_text(source: Source, value: ast.expr) -> Span | None:
    """Return the offsets of a text without its quotes; None for what is no plain text."""
    if not isinstance(value, ast.Constant) or not isinstance(value.value, str):
        return None
    at = location_in(source, make_position(value))
    opened = _OPENING.match(source.text, source.start_offset(at))
    if not opened:
        return None
    end = opened.end() + len(value.value)
    is_plain = source.text[opened.end() : end] == value.value
    return (opened.end(), end) if is_plain else None


def _in_xml(data: bytes, source: Source) -> Iterator[_ArgumentName]:
    with suppress(XmlFault):
        file = XmlFile(data, source)
        for element in file.root.iter("arg", "let"):
            parent = element.getparent()
            at = file.location(element)
            start = source.start_offset(at)
            name = markup.attribute(source.text, start, "name")
            if name and (parent is None or parent.tag != "include"):
                yield _ArgumentName(source.text[slice(*name.value)], True, *name.value)
    yield from _matches(_VARIABLE, _COMMENT, source, is_defined=False)


def _in_yaml(source: Source) -> Iterator[_ArgumentName]:
    yield from _matches(_YAML_ARGUMENT, _YAML_COMMENT, source, is_defined=True)
    yield from _matches(_VARIABLE, _YAML_COMMENT, source, is_defined=False)


def _matches(
    names: re.Pattern[str], comments: re.Pattern[str], source: Source, *, is_defined: bool
) -> Iterator[_ArgumentName]:
    """Yield the names that a pattern finds outside of comments."""
    text = comments.sub(blanked, source.text)
    for match in names.finditer(text):
        yield _ArgumentName(match[1], is_defined, *match.span(1))
