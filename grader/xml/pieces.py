"""The tags and comments of a text that may not be XML, and how far a parser reads it: TinyXML2, or a strict one."""

import re
from collections.abc import Iterable, Mapping
from typing import NamedTuple

from grader.xml.tinyxml2.tags import REFERENCE, MalformedTagError, read_tag
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, PARTS, REQUIRED

_ENDS = {"<!--": "-->", "<![CDATA[": "]]>", "<?": "?>", "<!": ">"}
_MAX_TAG = 2000  # characters: what is longer is no tag
# A malformed tag: to its >, or before the next tag; a comment in it is part of it.
_EXTENT = re.compile(r"<[<\s]*(?:[^<>]|<!--.*?-->)*>?", re.DOTALL)


class Piece(NamedTuple):
    """What is between two offsets: open, close, empty (tags), other, text, end (of the text). `at` is where the parser stops in it."""

    start: int
    end: int
    name: str
    form: str
    at: int | None = None
    attributes: Mapping[str, str] = {}


class Rules(NamedTuple):
    """How a text is read: strictly or as by TinyXML2; as a URDF or as any XML: `is_urdf` stops also where a tag is lost as text."""

    is_strict: bool = False
    is_urdf: bool = False


class Mark(NamedTuple):
    """A place between two pieces: the innermost tag that is open there, with the mark before it; whether a tag was before."""

    position: int = 0
    opened: "tuple[Piece, Mark] | None" = None
    is_late: bool = False


class Scan(NamedTuple):
    """How far a text is read: `why` it stops, and at what; `marks` are the places before the `pieces` and after the last one.

    The `faults` are what urdfdom does not know, misses, or cannot read as numbers.
    """

    pieces: list[Piece]
    marks: list[Mark]
    why: str
    wrong: Piece
    at: int
    faults: int


def without_bracket(names: Iterable[str]) -> re.Pattern[str]:
    """Return the pattern of a tag of one of these names without its <."""
    words = "|".join(map(re.escape, sorted(names, key=len, reverse=True)))
    return re.compile(rf"(?<![<\w/:.\-\"'=])/?(?:{words})\b(?=[^<>]{{0,300}}>)")


_LOST = without_bracket(ATTRIBUTES)


def scan(text: str, rules: Rules, mark: Mark | None = None, limit: int | None = None) -> Scan:
    """Read a text from a mark to its first error, or until a limit."""
    limit = len(text) + 1 if limit is None else limit
    pieces: list[Piece] = []
    marks = [mark or Mark()]
    faults = 0
    while (mark := marks[-1]).position < limit:
        piece = _piece(text, mark.position, rules)
        why, wrong = _why(text, mark, piece, rules)
        pieces += [piece] if wrong is piece else []
        if rules.is_urdf and mark.opened and wrong is piece:
            faults += _faults(piece, mark.opened[0].name) + bool(text[mark.position : piece.start].strip())
        if why:
            return Scan(pieces, marks, why, wrong, min(wrong.start if wrong.at is None else wrong.at, limit), faults)
        outer = mark.opened[1] if mark.opened and piece.form == "close" else mark
        opened = (piece, mark) if piece.form == "open" else outer.opened
        marks.append(Mark(piece.end, opened, mark.is_late or piece.form != "other"))
    return Scan(pieces, marks, "", Piece(limit, limit, "", "end"), limit, faults)


def _why(text: str, mark: Mark, piece: Piece, rules: Rules) -> tuple[str, Piece]:
    """Return why the parser stops at a piece, or at the text before it, and at which of the two."""
    parent = mark.opened[0].name if mark.opened else ""
    start = piece.start - len(text[mark.position : piece.start].lstrip(" \t\r\n\ufeff"))
    if start < piece.start:
        before = Piece(start, piece.start, "", "text")
        if not parent and (rules.is_strict or (piece.form == "end" and mark.is_late)):
            return "text", before
        if rules.is_urdf and parent in CHILDREN and (lost := _LOST.search(text, start, piece.start)):
            return "bracket", before._replace(start=lost.start())
        if rules.is_strict and (reference := REFERENCE.search(text, start, piece.start)):
            return "reference", before._replace(start=reference.start())
    why = ""
    if piece.form == "end":
        why = "end" if mark.opened or not mark.is_late else ""
    elif piece.at is not None:
        why = "comment" if piece.form == "other" else "tag"
    elif piece.name == "<!--":
        inner = "--" if rules.is_strict else "<!--" if rules.is_urdf else "\0"
        why = "comment" if inner in text[piece.start + 4 : piece.end - 3] else ""
    elif piece.name == "<?" and not text.startswith("<?xml-", piece.start):
        is_blank = start == piece.start and (not mark.position or text.endswith("?>", 0, mark.position))
        is_first = piece.start == text.startswith("\ufeff") if rules.is_strict else is_blank
        is_right = not rules.is_strict or "<" not in text[piece.start + 1 : piece.end]
        why = "misplaced" if not is_first else "" if is_right else "version"
    elif piece.form == "close":
        why = "close" if piece.name != parent else ""
    elif piece.form != "other" and not parent and mark.is_late:
        why = "second" if rules.is_strict or (rules.is_urdf and piece.name in ATTRIBUTES) else ""
    elif piece.form != "other" and not parent and rules.is_urdf and piece.name != "robot":
        why = "root"
    return why, piece


def _piece(text: str, position: int, rules: Rules) -> Piece:
    """Return the next tag, comment or declaration, or the end; a malformed tag ends at its >, or before the next tag."""
    start = text.find("<", position)
    if start < 0:
        return Piece(len(text), len(text) + 1, "", "end")
    if opening := next((opening for opening in _ENDS if text.startswith(opening, start)), ""):
        end = text.find(_ENDS[opening], start + len(opening))
        at, end = (start, len(text)) if end < 0 else (None, end + len(_ENDS[opening]))
        return Piece(start, end, opening, "other", at)
    notes: list[int] = []
    try:
        tag, end = read_tag(text, start, lambda _kind, _what, offset: notes.append(offset))
    except MalformedTagError as error:
        body = _EXTENT.match(text, start, start + _MAX_TAG)
        return Piece(start, start + len(body[0].rstrip() if body else "<"), "", "open", error.offset)
    return Piece(start, end, tag.name, tag.form, notes[0] if notes and rules.is_strict else None, tag.attributes)


def _faults(piece: Piece, parent: str) -> int:
    """Return what urdfdom does not know, misses, or cannot read as numbers in a tag in an element."""
    if parent not in ATTRIBUTES or piece.form not in ("open", "empty"):
        return 0
    known = ATTRIBUTES.get(piece.name, piece.attributes)
    faults = sum(key not in piece.attributes for key in REQUIRED.get(piece.name, ()))
    for key, value in piece.attributes.items():
        is_number = bool(PARTS.get(key)) and "$" not in value
        faults += (key not in known and ":" not in key) or (is_number and len(value.split()) != len(PARTS[key]))
    return faults + (piece.name not in CHILDREN.get(parent, ()) and (parent != "robot" or piece.name in ATTRIBUTES))


def remaining(text: str, *, is_urdf: bool = False) -> int:
    """Return how many characters of a text TinyXML2 does not read because of an error; -1 if there is none."""
    return len(text) - scan(text, Rules(is_urdf=is_urdf)).at
