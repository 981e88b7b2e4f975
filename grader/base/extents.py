"""The end of what begins at a place in a file: a tag, an attribute, a value, a name.

Places are many and most are never shown, so that readers give only their start. The end follows
from the grammar of the file's language; it is searched when it is asked for.
"""

import posixpath
import re

from grader.base.grouping import Span, Strings
from grader.base.source import Location, Source, SourceOf

_Language = Strings  # patterns, of which the first that matches counts

_QUOTED = r"""(?s:"(?:[^"\\]|\\.)*+"|'(?:[^'\\]|\\.)*+')"""
# A tag that is not closed ends with its line, as a comment does: it may be as long as the file.
_XML = (
    r"<!--[^\n]*?(?:-->|(?=\r?$))",
    r"""<[/?]?[^\s=/>"'<]*+(?:"[^"]*"|'[^']*'|[^>"'<])*+>|<[^>\n]*>?""",
    r"""[^\s=<>"'/]+\s*=\s*(?:"[^"<]*"|'[^'<]*'|"[^"\n]*|'[^'\n]*)""",
    r"""(?:\$\{[^{}\n]*\}|\$\([^()\n]*\)|[^\s<>"'])++""",
    r"""["'][^"'\n]*["']?""",
)
_YAML_START = r"(?:[&!][^\s,\[\]{}]*[ ]+)*+"
_YAML_QUOTED = r"""(?s:"(?:[^"\\]|\\.)*+"|'(?:[^']|'')*+')"""
_YAML_BLOCK = (
    _YAML_START + _YAML_QUOTED,
    r"-(?=\s)|[|>][-+\d]*|\[[^\[\]\n]*\]|\{[^{}\n]*\}",
    _YAML_START + r"(?:\$\([^()\n]*\)|:(?=\S)|[ \t]++(?![#\s])|[^\s:])++",
)
_YAML_FLOW = (
    _YAML_START + _YAML_QUOTED,
    r"\[[^\[\]\n]*\]|\{[^{}\n]*\}",
    _YAML_START + r"(?:\$\([^()\n]*\)|:(?=[^\s,\[\]{}])|[ \t]++(?![#\s])|[^\s:,\[\]{}])++",
)
# A path in a text, of which no quote is the start.
_PATH = r"""(?:\w+:/|\$\([^()\n]*\)|~)?/[^\s"'<>]*+"""
_BRACKETED = r"\[[^\[\]\n]*\]|\([^()\n]*\)|\{[^{}\n]*\}"
_PYTHON = (
    r'''(?si:[rbuf]{0,2}(?:"""(?:[^\\]|\\.)*?"""|\'\'\'(?:[^\\]|\\.)*?\'\'\'))''',
    r"(?i:[rbuf]{0,2})" + _QUOTED,
    r"(?:import|from)\s[^\n#;]*|(?:class|(?:async )?def)\s+\w+",
    _PATH,
    r"[@\w]\w*+(?:\.\w++)*",
    _BRACKETED,
)
_CPP = (
    r'(?s:(?:u8|[uUL])?R"([^()\s\\]*)\(.*?\)\1")',
    r"(?:u8|[uUL])?" + _QUOTED,
    r"#[^\n]*",
    r"<[^<>\n]*>",
    _PATH,
    r"~?\w++(?:(?:::~?|\.|->)\w++)*",
    _BRACKETED,
)
_CMAKE = (
    r"(?s:\[(=*)\[.*?\]\1\])",
    _QUOTED,
    r'(?:[^\s()#"\\]|\\.)++',
)
_WORDS = (r"[\w$@/~-]++(?:[.:=]+[\w$@/~-]++)*", _QUOTED)

_PYTHON_ENDINGS = (".py", ".pyi")
_XML_ENDINGS = (".xml", ".urdf", ".xacro", ".sdf", ".srdf", ".world", ".launch", ".gazebo", ".dae")
_YAML_ENDINGS = (".yaml", ".yml", ".rviz", ".repos")
_CPP_ENDINGS = (".cpp", ".cc", ".cxx", ".c", ".hpp", ".hh", ".hxx", ".h", ".ino")
_CMAKE_ENDINGS = ("CMakeLists.txt", ".cmake")

# What decides whether brackets are open in YAML: texts and comments hide them.
_YAML_TOKEN = rf"(?<![^\s,\[{{:])(?:{_YAML_QUOTED})|(?<!\S)#[^\n]*|[][{{}}]"
_MAX_BEFORE = 4_000  # characters, in which a bracket of YAML is searched


def find_end(source: Source, where: Location) -> Span:
    """Return the line and the column after the last character of what begins at a place of a text.

    Both count from 1, columns in characters, as in a Location. It is the place itself where nothing
    begins there, as at the end of a line.
    """
    start = source.start_offset(where)
    end = end_offset(source, start)
    if end <= start:
        return where.line, where.column
    last = source.at(end)
    return last.line, last.column


def end_offset(source: Source, start: int) -> int:
    """Return the offset after what begins at an offset of a text."""
    text = source.text
    if not 0 <= start < len(text):
        return start
    for pattern in _choose_language(source, start):
        match = re.compile(pattern, re.MULTILINE).match(text, start)
        if match:
            return start + len(match[0].rstrip())
    return start + int(not text[start].isspace())


def ended(where: Location, source_of: SourceOf) -> Location:
    """Return a location with its end, and those of the macro calls that led to it.

    Without the file it ends where it begins. An end that is known stays.
    """
    if where.end_line:
        return where
    source = source_of(where.path)
    line, column = (where.line, where.column) if not source else find_end(source, where)
    calls = tuple((macro, ended(at, source_of)) for macro, at in where.calls)
    return where._replace(calls=calls, end_line=line, end_column=column)


def _is_xml(source: Source) -> bool:
    """Return whether a text is XML, by its name or by its first character."""
    return source.path.endswith(_XML_ENDINGS) or source.text.lstrip("\ufeff \t\r\n")[:1] == "<"


def _choose_language(source: Source, start: int) -> _Language:
    """Return the patterns of the language of a text; in YAML those for the place."""
    path = posixpath.basename(source.path)
    if path.endswith(_YAML_ENDINGS):
        return _YAML_FLOW if _is_in_flow(source.text, start) else _YAML_BLOCK
    if path.endswith(_PYTHON_ENDINGS):
        return _PYTHON
    if path.endswith(_CPP_ENDINGS):
        return _CPP
    if path.endswith(_CMAKE_ENDINGS):
        return _CMAKE
    if _is_xml(source):
        return _XML
    return _WORDS


def _is_in_flow(text: str, start: int) -> bool:
    """Return whether an offset of YAML is inside of brackets, where commas separate values.

    No bracket is open where a line begins with a key: it is searched from the last one.
    """
    first = max(0, start - _MAX_BEFORE)
    before = text[first:start]
    key = 0
    for match in re.finditer(r"^[^\s#\[\]{}'\",-]", before, re.MULTILINE):
        key = match.start()
    depth = 0
    for token in re.finditer(_YAML_TOKEN, before[key:]):
        if token[0] in "[{":
            depth += 1
        elif token[0] in "]}":
            depth = max(0, depth - 1)
    return depth > 0
