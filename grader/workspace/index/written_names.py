"""Where exactly a name is written: its own characters, or the expression that it is made of.

A fact is at the tag, value or call that a finding is about. An editor needs the name in it.
"""

import re
from collections.abc import Callable, Iterator
from typing import Literal, NamedTuple

from grader.base import markup
from grader.base.extents import end_offset
from grader.base.patterns import on_use
from grader.base.source import Location, Source, SourceOf

Role = Literal["definition", "use"]
Span = tuple[int, int]  # the offsets of the first character and after the last one


class WrittenName(NamedTuple):
    """A name at the place where a file defines or uses it, with its end.

    The text there is the name, but where `is_made`: then it is an expression, such as
    `${side}_wheel`, an f-string or a call, that a rename cannot change. Names of one kind are the
    same within one owner only: a robot, a launch file, a macro.

    >>> at = Location("a.urdf", 2, 15, end_line=2, end_column=19)
    >>> WrittenName("link", "base", "definition", at, "a.urdf").covers("a.urdf", 2, 16)
    True
    """

    kind: str
    name: str
    role: Role
    location: Location
    owner: str = ""
    is_made: bool = False

    def covers(self, path: str, line: int, column: int) -> bool:
        """Return whether a place of a file is in the name, or just after it."""
        at = self.location
        start = (at.line, at.column)
        end = (at.end_line, at.end_column)
        if start == end:
            return False  # a whole file
        return at.path == path and start <= (line, column) <= end


WrittenNames = Iterator[WrittenName]


def written_name(
    source: Source, span: Span, kind: str, name: str, role: Role, owner: str = ""
) -> WrittenName:
    """Return a name at a span of a text; it is made if the text is another one."""
    start = source.at(span[0])
    end = source.at(span[1])
    location = start._replace(end_line=end.line, end_column=end.column)
    is_made = source.text[slice(*span)] != name
    return WrittenName(kind, name, role, location, owner, is_made)


_MAX_CALL = 8_000  # characters of a call in which a name is searched
_MAX_KEY = 40  # characters between a key of a table in Python and its value
_MAX_LINES = 400  # above a value, among which its keys are
# A node that a launch file starts: its name is in `name`, and nothing else that is called the same.
_STARTED = "started node"
# The attribute, argument or key that usually has a name of a kind.
_USUAL = {
    _STARTED: ("name",),
    "controller": ("arguments", "args"),
    "frame": ("arguments", "args"),
    "launch argument": ("launch_arguments",),
    "package": ("package", "pkg"),
    "program": ("executable", "exec"),
    "plugin": ("plugin",),
}
_IN_XML = ("name", "reference", "link", "joint", "link1", "link2", "value")
_ATTRIBUTE_START = on_use(r"""[^\s=<>"'/]++\s*+=\s*+(["'])""")
_TOKEN_OF_CALL = on_use(
    r'''(?P<text>(?i:[rbuf]{0,2})(?:"""(?s:(?:[^\\]|\\.)*?)"""|"(?:[^"\\\n]|\\.)*"|'(?:[^'\\\n]|\\.)*'))'''
    r"|(?P<open>[\[({])|(?P<close>[\])}])|(?P<keyword>(?<!\w)\w++)\s*+=(?!=)|(?P<comment>#[^\n]*|//[^\n]*)|;"
)
_WORD = on_use(r"\b[A-Za-z_]\w*+")
_LINE = on_use(r"(?P<indent> *)(?P<dash>- )?[^\s#]")  # of YAML, that is no comment
_EXPRESSION = on_use(r"\$\{[^{}]*\}|\$\([^()]*\)|\{[^{}]*\}")
_QUOTES = on_use(r'''(?i:[rbuf]{0,2}|u8)("""|\'\'\'|"|')''')


def span_of_name(source: Source, where: Location, kind: str, name: str, role: Role) -> Span | None:
    """Return the span of a name, or of the expression that makes it, in what begins at a place.

    The result is None where the name is not written there.
    """
    if (kind, role) == ("node", "definition"):
        kind = _STARTED
    start = source.start_offset(where)
    if not 0 <= start < len(source.text):
        return None
    if source.path.endswith((".yaml", ".yml", ".rviz")):
        return _in_yaml(source, start, name)
    if source.path.endswith((".py", ".cpp", ".hpp", ".cc", ".h", ".cxx")):
        return _in_code(source, start, kind, name)
    return _in_markup(source, start, kind, name)


def find_written(
    source: Source | None, where: Location, kind: str, name: str, role: Role, owner: str = ""
) -> WrittenNames:
    """Yield a name, or the expression that makes it, if what begins at a place has it."""
    span = span_of_name(source, where, kind, name, role) if source else None
    if source and span is not None:
        yield written_name(source, span, kind, name, role, owner)


def _part(text: str, span: Span, name: str) -> Span | None:
    """Return the part of a written value that is a name, or all of it where it makes the name."""
    start, end = span
    written = text[start:end]
    if written == name:
        return span
    bare = name.strip("/")
    if "$" in written or "{" in written:
        plain = _EXPRESSION.sub(lambda expression: "$" * len(expression[0]), written)
        alone = re.search(rf"(?<!\S)/?({re.escape(bare)})(?!\S)", plain) if bare else None
        if not alone:
            return span
        return start + alone.start(1), start + alone.end(1)
    match = re.search(rf"(?<![\w.-]){re.escape(bare)}(?![\w-]|\.\w)", written) if bare else None
    if not match:
        return None
    slash = name.startswith("/") and written.startswith("/", max(0, match.start() - 1))
    return start + match.start() - int(slash and match.start() > 0), start + match.end()


# --- XML


def _in_markup(source: Source, start: int, kind: str, name: str) -> Span | None:
    text = source.text
    if text[start] == "<":
        return _in_tag(text, start, kind, name)
    opened = _ATTRIBUTE_START.match(text, start)
    if not opened:
        return _part(text, (start, end_offset(source, start)), name)
    end = text.find(opened[1], opened.end())
    return _part(text, (opened.end(), end), name) if end >= 0 else None


def _in_tag(text: str, start: int, kind: str, name: str) -> Span | None:
    """Return where a name is in an element.

    It is in an attribute, in its text, or in an argument that an include passes.
    """
    values = _values_in_tag(text, start, kind)
    for span in values:
        if text[slice(*span)] == name:
            return span
    if kind == "launch argument":
        return _passed_in_element(text, start, name)
    for span in values:
        part = _part(text, span, name)
        if part is not None:
            return part
    return None


def _values_in_tag(text: str, start: int, kind: str) -> list[Span]:
    """Return the values of an element in which a name may be, the usual attributes first."""
    spans = {attribute.name: attribute.value for attribute in markup.attributes(text, start)}
    if kind == _STARTED:
        values = [spans["name"]] if "name" in spans else []
    else:
        order = [key for key in _USUAL.get(kind, ()) + _IN_XML if key in spans]
        values = [spans[key] for key in dict.fromkeys([*order, *spans])]
    head, is_empty = markup.head_end(text, start)
    if not is_empty:
        content = re.compile(r"\s*([^<]*?)\s*(?=<)").match(text, head)
        if content and content[1]:
            values.append(content.span(1))
    return values


def _passed_in_element(text: str, start: int, name: str) -> Span | None:
    end = min(markup.element_end(text, start), start + _MAX_CALL)
    passed = re.compile(rf"<arg\b[^<>]*?\bname\s*=\s*[\"']({re.escape(name)})[\"']")
    match = passed.search(text, start, end)
    return match.span(1) if match else None


# --- YAML


def _in_yaml(source: Source, start: int, name: str) -> Span | None:
    text = source.text
    end = end_offset(source, start)
    span = _without_quotes(text, (start, end))
    if text[slice(*span)] == name:
        return span
    key = _key_above(text, start, name)
    if key is not None:
        return key
    return _part(text, span, name)


def _without_quotes(text: str, span: Span) -> Span:
    opened = _QUOTES.match(text, span[0])
    if not opened or opened.end() > span[1]:
        return span
    width = len(opened[1])
    is_closed = text.endswith(opened[1], opened.end(), span[1])
    return opened.end(), span[1] - width * int(is_closed)


def _key_above(text: str, start: int, name: str) -> Span | None:
    """Return the key of this name whose value is at an offset, or has it in its mapping."""
    key = re.compile(rf"(?:- +)*([\"']?)({re.escape(name)})\1\s*:(?=\s|$)")
    line_start = text.rfind("\n", 0, start) + 1
    around, is_item = start - line_start, False  # how far a line around is indented at most
    for _ in range(_MAX_LINES):
        line = _LINE.match(text, line_start)
        if line and len(line["indent"]) <= around:
            is_beside = is_item and line["dash"] and len(line["indent"]) == around
            match = key.match(text, line.end("indent"))
            if match and match.end() <= start and not is_beside:
                return match.span(2)
            if not is_beside:
                is_item = bool(line["dash"])
                around = len(line["indent"]) - int(not is_item)
        if line_start == 0 or around < 0:
            return None
        line_start = text.rfind("\n", 0, line_start - 1) + 1
    return None


# --- Python and C++


def _in_code(source: Source, start: int, kind: str, name: str) -> Span | None:
    text = source.text
    end = end_offset(source, start)
    if text.startswith("class ", start):
        return None  # a parameter that every node has
    if _QUOTES.match(text, start):
        return _part(text, _without_quotes(text, (start, end)), name)
    if kind == "xacro argument":
        return _given_to_xacro(text, start, name)
    key = re.compile(rf"[\"']({re.escape(name)})[\"']\s*:\s*[\[(]?\Z")
    at = max(0, start - len(name) - _MAX_KEY)
    before = key.search(text[at:start])
    if before:
        return at + before.start(1), at + before.end(1)
    in_call = _in_call(text, start, kind, name)
    return in_call or _constant(source, start, name) or (start, end)


def _constant(source: Source, start: int, name: str) -> Span | None:
    """Return the text of the only constant of a file that is a name and that a call names."""
    used = {*_WORD.findall(source.text, start, max(call_end(source, start), start))}
    defined = re.compile(
        rf"(?m)^[^\n\"'(),#]*?(?:\#define[ ]++)?\b(?P<word>\w++)(?:\[\])?\s*+[={{]?\s*+"
        rf"(?P<text>\"{re.escape(name)}\"|'{re.escape(name)}')"
    )
    spans = [
        (match.start("text") + 1, match.end("text") - 1)
        for match in defined.finditer(source.text)
        if match["word"] in used
    ]
    return spans[0] if len(spans) == 1 else None


def _in_call(text: str, start: int, kind: str, name: str) -> Span | None:
    """Return the text of a call that is a name.

    It is in the usual argument if several are; else it is the first that has it as a word.
    """
    first = None
    word = None
    for keyword, span in _texts_in_call(text, start):
        part = _part(text, span, name)
        if part is None or text[slice(*part)].strip("/") != name.strip("/"):
            continue
        is_whole = text[slice(*span)].strip("/") == name.strip("/")
        if is_whole and keyword in _USUAL.get(kind, ()):
            return part
        if kind == _STARTED:
            continue
        if is_whole:
            first = first or part
        word = word or part
    return first or word


def _given_to_xacro(text: str, start: int, name: str) -> Span | None:
    """Return where a command gives xacro an argument, `name:=`, or a table of arguments has it."""
    given = re.compile(rf"(?<![\w.-]){re.escape(name)}(?=\s*:=)")
    keys = []
    for _, span in _texts_in_call(text, start):
        match = given.search(text, *span)
        if match:
            return match.span()
        keys += [span] if text[slice(*span)] == name else []
    return keys[0] if keys else None


def _texts_in_call(text: str, start: int) -> Iterator[tuple[str, Span]]:
    """Yield the texts in a call, each with the keyword of its argument.

    In C++, it is all up to the end of a statement.
    """
    depth = 0
    keyword = ""
    has_opened = False
    for token in _TOKEN_OF_CALL.finditer(text, start, start + _MAX_CALL):
        if token["text"]:
            yield keyword, _without_quotes(text, token.span())
        elif token["open"]:
            depth = depth + 1
            has_opened = True
        elif token["close"]:
            depth -= 1
        elif token["keyword"] and depth == 1:
            keyword = token["keyword"]
        if token[0] == ";" or depth < 0 or (has_opened and depth == 0):
            return


def call_end(source: Source, start: int) -> int:
    """Return the offset after the call of Python or the element of XML that begins at an offset.

    Without one it is the end of the text.
    """
    text = source.text
    depth = 0
    if text[start : start + 1] == "<":
        return markup.element_end(text, start)
    for token in _TOKEN_OF_CALL.finditer(text, start):
        depth += int(bool(token["open"])) - int(bool(token["close"]))
        if token["close"] and depth <= 0:
            return token.end()
    return len(text)


def make_reader(read: Callable[[str], bytes | None]) -> SourceOf:
    """Return what gives the texts of files by their paths, and reads each file once."""
    known = {}

    def source(path: str) -> Source | None:
        if path not in known:
            data = read(path)
            text = data.decode("utf-8", "replace") if data is not None else ""
            known[path] = Source(path, text) if data is not None else None
        return known[path]

    return source
