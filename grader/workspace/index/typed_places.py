"""What is around the place where one types, and what of a name is typed there.

A file is often broken while it is typed: it is read by its marks up to the place, so that calls,
elements and tables that are not closed are those around it.
"""

import re
from typing import NamedTuple

from grader.base.patterns import on_use
from grader.workspace.model.text_files import CPP_ENDINGS

KEY, _ELEMENT, FIELD = "=", "<", "."  # slots that are no attribute, argument or key
_BRACKETS = ("(", "[", "{")
_MAX_TEXT = 200_000  # characters before a place
_MAX_OWNER = 300  # characters before a place, in which a name is that is typed
_ENDINGS = {
    "python": (".py",),
    "cpp": CPP_ENDINGS,
    "yaml": (".yaml", ".yml", ".rviz"),
    "cmake": ("CMakeLists.txt", ".cmake"),
    "xml": (".xml", ".urdf", ".xacro", ".sdf", ".srdf", ".world", ".launch", ".gazebo"),
}


class _Level:
    """An element, a call, a command or a table that is around a place.

    `slot` is the attribute, argument or key whose value is typed; the number of an argument counts
    from 0. It is `KEY` where the name of an attribute or key is typed, `_ELEMENT` for an element
    or command, `FIELD` for a field of a value, and empty for the text of an element. A bracket
    that is not that of a call has the bracket as its name. `given` are the other attributes,
    arguments or keys.
    """

    def __init__(self, name: str, slot: str = "", given: dict[str, str] | None = None) -> None:
        self.name = name
        self.slot = slot
        self.start = 0
        self.given = given if given is not None else {}

    def end(self, value: str) -> None:
        """End an argument; the words behind a keyword of CMake are one."""
        before = self.given.get(self.slot, "")
        self.given[self.slot] = f"{before} {value}".strip("\"' \n")
        if not self.slot.isupper():
            self.slot = str(len(self.given) - int("<" in self.given))


class TypedPlace(NamedTuple):
    """A place where one types: `read_typed_place` makes it, for what an editor offers there.

    >>> place = read_typed_place("a.urdf", '<joint name="arm"><parent link="ba', 34)
    >>> place.holder.name, place.holder.slot, place.typed
    ('parent', 'link', 'ba')
    """

    language: str  # a key of _ENDINGS
    path: str
    text: str  # the whole file
    offset: int
    typed: str  # of the name, up to the place
    levels: tuple[_Level, ...]  # the innermost first
    is_text: bool = True  # whether it is a value, and no expression of a program
    before: str = ""  # what stands in the name before what is offered: folders, or a namespace

    @property
    def holder(self) -> _Level:
        """The innermost level that is no bracket."""
        named = (level for level in self.levels if level.name not in _BRACKETS)
        return next(named, _Level(""))

    @property
    def part(self) -> str:
        """Where the place is in the brackets inside of the holder; empty without any."""
        inner = self.levels[0]
        return inner.slot if inner.name in _BRACKETS else ""

    def given(self, *names: str) -> str:
        """Return what the innermost level has that has one of some attributes or arguments."""
        for level in self.levels:
            for name in names:
                if level.given.get(name):
                    return level.given[name]
        return ""


def read_typed_place(path: str, text: str, offset: int) -> TypedPlace | None:
    """Return what is around a place of a file; None where no name is typed, as in a comment."""
    languages = (language for language, ends in _ENDINGS.items() if path.endswith(ends))
    language = next(languages, "")
    if not language or offset > _MAX_TEXT:
        return None
    place = TypedPlace(language, path, text, offset, "", ())
    around = _read_yaml(place) if language == "yaml" else _read_marks(place)
    return _cut(_read_reference(around)) if around else None


_REFERENCE = on_use(
    r"(?:\$\(find(?:-pkg-share)?\s{1,50}+(?P<found>[\w.-]{1,200}+)\s{0,50}+\)"
    r"|package://(?P<package>[\w.-]{1,200}+))"
    r"/(?P<file>[^\s\"'<>]{0,500}+)\Z"
    r"|(?:package://|\$\((?P<call>[\w-]{1,50}+)\s{1,50}+)(?P<argument>[\w.-]{0,200}+)\Z"
    r"|\$\{(?:[^{}]*[^\w{}])?(?P<name>\w*+)\Z"
)


def _read_reference(place: TypedPlace) -> TypedPlace:
    """Return a place in a reference to a file, package, argument or property as one of its own."""
    match = _REFERENCE.search(place.typed)
    if not match:
        return place
    level = _Level("${")
    if match["file"] is not None:
        level = _Level("$(find)", "file", {"package": match["found"] or match["package"]})
    elif match["argument"] is not None:
        level = _Level("$(", match["call"] or "find")
    typed = match["file"] or match["argument"] or match["name"] or ""
    return place._replace(typed=typed, levels=(level, *place.levels))


def _cut(place: TypedPlace) -> TypedPlace:
    """Return a place with what is typed behind the folders or the namespace of a name."""
    mark = ""
    if place.holder.name == "$(find)" or (
        place.language == "cpp" and place.holder.name == "import"
    ):
        mark = "/"
    elif place.language == "cpp" and not place.is_text:
        mark = "::"
    elif place.holder.slot == _ELEMENT:
        mark = ":"
    before, cut, typed = place.typed.rpartition(mark) if mark else ("", "", place.typed)
    return place._replace(before=before + cut, typed=typed.rpartition("\n")[2].lstrip())


# --- Python, C++, CMake and XML


_CALL_MARKS = (
    r"|(?P<text>(?i:[rbuf]{0,2})(?:\"\"\".*?\"\"\"|'''.*?'''|\"(?:[^\"\\\n]|\\.)*\"|'(?:[^'\\\n]|\\.)*'))"
    r"|(?P<begun>(?P<quote>\"\"\"|'''|[\"'])(?P<typed>[^\"'\n]*)\Z)"
    r"|(?P<open>(?:(?<!\w)(?P<name>\w++)\s*+(?:<(?P<type>[^;(){}]{0,200})>)?\s*)?\(|[\[{])"
    r"|(?P<close>[\])}])|(?P<comma>,)"
    r"|(?P<keyword>(?<!\w)(?P<word>\w++)\s*+=(?!=))|(?P<colon>(?<!:):(?!:))"
)
_MARKS = {
    "python": on_use(
        r"(?P<comment>\#[^\n]*)|(?P<imported>^[ \t]*+(?:from[ \t]+(?P<module>[\w.]+)[ \t]+import"
        r"[ \t(]+(?:\w+\s*,\s*)*(?P<of_module>\w*)|(?:from|import)[ \t]+(?P<begun_name>[\w.]*))\Z)"
        rf"|(?P<statement>^[ \t]*+(?:def|class|import|from)\b){_CALL_MARKS}",
        re.DOTALL | re.MULTILINE,
    ),
    "cpp": on_use(
        r"(?P<comment>//[^\n]*|/\*.*?(?:\*/|\Z))"
        r"|(?P<imported>^[ \t]*#[ \t]*include[ \t]*[<\"](?P<begun_name>[\w./-]*)\Z)"
        rf"|(?P<statement>;){_CALL_MARKS}",
        re.DOTALL | re.MULTILINE,
    ),
    "cmake": on_use(
        r"(?P<comment>#[^\n]*)|(?P<open>(?<!\w)(?P<name>\w++)\s{0,50}+\()|(?P<close>\))"
        r"|(?P<keyword>\b(?P<word>[A-Z][A-Z_]{2,}+)\s++)|(?P<comma>\s++)"
    ),
    "xml": on_use(
        r"(?P<comment><!--(?:.*?-->|.*))|(?P<close>/>|</(?P<closed>[\w:.-]*+)\s{0,50}+>)|(?P<content>>)"
        r"|(?P<open><(?P<name>[\w:.-]*))|(?P<keyword>(?<![\w:.-])(?P<word>[\w:.-]++)\s{0,50}+=)"
        r"|(?P<text>\"[^\"<]*\"|'[^'<]*')|(?P<begun>(?P<quote>[\"'])(?P<typed>[^\"'<]*)\Z)",
        re.DOTALL,
    ),
}
_BARE = on_use(r"(?<![^\s<>()\"',=])[^\s<>()\"',=]*+\Z")
_WORD = on_use(r"(?<![\w:])[\w:]*+\Z")
_MEMBER = on_use(
    r"(?<![\w.\[\]()>])(?P<owner>[\w.\[\]()]*(?:->[\w.\[\]()]+)*)(?:\.|->)(?P<typed>\w*+)\Z"
)


def _read_marks(place: TypedPlace) -> TypedPlace | None:
    before = place.text[: place.offset]
    rest = place.text[place.offset :]
    stack = [_Level("")]
    last = _read_all(place.language, before, stack, 1)
    groups = last.groupdict() if last and last.end() == place.offset else {}
    if (groups.get("comment") or "-->").endswith(("-->", "*/")) is False:
        return None
    if groups.get("imported") is not None:
        level = _Level("import", groups.get("module") or "")
        typed = groups.get("of_module") or groups["begun_name"] or ""
        return place._replace(typed=typed, levels=(level,))
    if groups.get("begun") is not None:
        around = place._replace(typed=groups["typed"])
        rest = rest.partition(groups["quote"])[2]
    else:
        around = _read_bare(place, before, stack)
    copies = [_Level(each.name, each.slot, each.given) for each in reversed(stack)]
    if place.language in ("xml", "python"):
        _read_all(place.language, rest, stack, len(stack))
    return around._replace(levels=(*around.levels, *copies))


def _read_bare(place: TypedPlace, before: str, stack: list[_Level]) -> TypedPlace:
    """Return a place that is in no text in quotes, with what is typed there."""
    if place.language in ("python", "cpp"):
        member = _MEMBER.search(before, max(0, place.offset - _MAX_OWNER))
        if member and member["owner"]:
            levels = (_Level(member["owner"], FIELD),)
            return place._replace(typed=member["typed"], levels=levels, is_text=False)
        return place._replace(typed=_find_last(_WORD, before), is_text=False)
    typed = _find_last(_BARE, before)
    if place.language == "cmake" and len(stack) == 1:
        stack[0].slot = _ELEMENT
    elif place.language == "xml" and before.endswith(f"<{typed}"):
        given = stack.pop().given
        stack[-1].slot = _ELEMENT
        stack[-1].given = given
    return place._replace(typed=typed)


def _find_last(pattern: re.Pattern[str], text: str) -> str:
    match = pattern.search(text, max(0, len(text) - _MAX_OWNER))
    return match[0] if match else ""


def _read_all(language: str, text: str, stack: list[_Level], least: int) -> re.Match[str] | None:
    """Open and close what the marks of a text do, and return the last mark.

    It ends where fewer than the `least` are open.
    """
    last = None
    for mark in _MARKS[language].finditer(text):
        last = mark
        match mark.lastgroup:
            case "open":
                name = mark["name"] if mark["name"] is not None else mark[0]
                # A brace of C++ is a block, in which statements are.
                level = _Level("" if language == "cpp" and name == "{" else name, "0")
                level.slot = KEY if language == "xml" or name == "{" else level.slot
                if mark.groupdict().get("type"):
                    level.given["<"] = mark["type"]
                stack.append(level)
            case "close":
                _close(mark.groupdict().get("closed"), stack)
            case "statement":
                while len(stack) > 1 and stack[-1].name:
                    stack.pop()
            case _:
                _read_mark(mark, stack[-1], is_xml=language == "xml")
        if mark.lastgroup not in ("text", "close", "comment"):
            stack[-1].start = mark.end()
        if len(stack) < least:
            break
    return last


def _read_mark(mark: re.Match[str], level: _Level, *, is_xml: bool) -> None:
    """Read a mark that opens and closes nothing."""
    before = mark.string[level.start : mark.start()]
    match mark.lastgroup:
        case "comma":
            level.end(before)
        case "content":
            level.slot = ""
        case "keyword":
            level.slot = mark["word"]
        case "colon" if level.name == "{":
            level.slot = before.strip("\"' \n\t")
        case "text" if is_xml and level.slot not in ("", KEY):
            level.given[level.slot], level.slot = mark[0].strip("\"'"), KEY


def _close(name: str | None, stack: list[_Level]) -> None:
    """Close the last bracket or element, or the last one of a name."""
    names = [level.name for level in stack]
    if not name and len(stack) > 1:
        stack.pop()
    elif name in names:
        del stack[len(names) - 1 - names[::-1].index(name) :]


# --- YAML


_LINE = on_use(
    r"(?P<indent> *(?P<dash>(?:- +)*))"
    r"(?:(?P<key>\"[^\"\n]*\"|[^\s#:\"'\[{&*!-][^#:\n]*+|-\w[^#:\n]*+)\s*+:(?=\s|\Z)[ ]*"
    r"(?P<value>.*))?"
)
_ITEM = on_use(r"(?P<open>.*[\[{,])\s*(?:(?P<key>[\w.]+)\s*:\s+)?(?P<typed>[^\[{,]*)\Z", re.DOTALL)


def _read_yaml(place: TypedPlace) -> TypedPlace | None:
    _, _, rest = place.text[place.offset :].partition("\n")
    rows = place.text[: place.offset].split("\n")
    match = _LINE.match(rows[-1])
    if not match or rows[-1].lstrip().startswith("#"):
        return None
    levels = _tables_around(rows + rest.split("\n"), len(rows) - 1)
    typed = rows[-1][match.end("indent") :]
    if match["key"] is not None:
        item = _ITEM.match(match["value"])
        typed = item["typed"] if item else match["value"]
        levels[0].slot = match["key"].strip()
        if item and "{" in item["open"]:
            levels[0] = _Level(levels[0].slot, item["key"] or KEY)
    elif match["dash"] and len(levels) > 1:
        del levels[0]
    return place._replace(typed=typed.lstrip("\"'"), levels=tuple(levels))


def _tables_around(rows: list[str], number: int) -> list[_Level]:
    """Return the tables around a line, the innermost first; the outermost one has no name."""
    tables: list[_Level] = []  # whose start is how far their keys are indented
    levels: list[_Level] = []
    for count, row in enumerate(rows):
        match = _LINE.match(row)
        if not match or (match["key"] is None and not match["dash"] and count != number):
            continue
        indent = len(match["indent"])
        while tables and tables[-1].start + int(bool(match["dash"])) > indent:
            tables.pop()
        if count > number and len(tables) < len(levels):
            break
        if not tables or tables[-1].start < indent:
            tables.append(_Level(tables[-1].slot if tables else ""))
            tables[-1].start = indent
        if count == number:
            levels = [_Level(each.name, each.slot, each.given) for each in tables]
            levels[-1].slot = KEY
        elif match["key"] is not None:
            tables[-1].slot = match["key"].strip("\" '")
            tables[-1].given[tables[-1].slot] = match["value"].split(" #")[0].strip("\"' ")
    return levels[::-1]
