"""The tags and comments of a text that may not be XML, and how far a parser reads it: TinyXML2, or a strict one."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from grader.xml.tinyxml2.tags import REFERENCE, MalformedTagError, read_tag
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN

_ENDS = {"<!--": "-->", "<![CDATA[": "]]>", "<?": "?>", "<!": ">"}
_MAX_DEPTH = 500  # of TinyXML2
_MAX_TAG = 2000  # characters: what is longer is no tag
# A malformed tag: to its >, or before the next tag; a comment in it is part of it.
_EXTENT = re.compile(r"<[<\s]*(?:[^<>]|<!--.*?-->)*>?", re.DOTALL)
_VALUE = r"""\s+[\w:.\-]+\s*=\s*(?:"[^"<>]*"|'[^'<>]*')\s*"""
# A tag without its <: link name="base"> and /link>.
_LOST = re.compile(rf"""(?<![<\w/:.\-"'=])/?[A-Za-z_][\w:.\-]*(?:{_VALUE})*/?>""")


class TextPiece(NamedTuple):
    """What is between two offsets: open, close, empty (tags), other, text, end. The parser stops in it at `at`."""

    start: int
    end: int
    name: str
    form: str
    at: int | None = None
    attributes: Mapping[str, str] = {}


class Rules(NamedTuple):
    """How to read a text: strictly or as TinyXML2; with `is_urdf`, reading stops also where a tag is lost as text."""

    is_strict: bool = False
    is_urdf: bool = False


class ParserMark(NamedTuple):
    """A place after a piece: the tags that are open there, and whether a tag was before."""

    position: int = 0
    opened: tuple[TextPiece, ...] = ()
    is_late: bool = False
    piece: TextPiece | None = None


class PieceScan(NamedTuple):
    """How far a text is read: the places after its pieces, what is wrong there, and where the parser stops.

    The `faults` are what urdfdom does not know.
    """

    marks: list[ParserMark]
    wrong: TextPiece | None
    at: int
    faults: int


def scan(text: str, rules: Rules, mark: ParserMark | None = None, limit: int | None = None) -> PieceScan:
    """Read a text from a mark to its first error, or until a limit."""
    limit = len(text) + 1 if limit is None else limit
    marks = [mark or ParserMark()]
    faults = 0
    while (mark := marks[-1]).position < limit:
        piece = _piece(text, mark.position, rules)
        wrong = _wrong_text(text, mark, piece, rules) or (piece if _is_wrong(text, mark, piece, rules) else None)
        if rules.is_urdf and mark.opened and wrong in (None, piece):
            faults += _faults(piece, mark.opened[-1].name) + bool(text[mark.position : piece.start].strip())
        if wrong:
            return PieceScan(marks, wrong, min(wrong.start if wrong.at is None else wrong.at, limit), faults)
        opened = mark.opened[:-1] if piece.form == "close" else mark.opened
        inside = (*opened, piece) if piece.form == "open" else opened
        marks.append(ParserMark(piece.end, inside, mark.is_late or piece.form != "other", piece))
    return PieceScan(marks, None, limit, faults)


def _wrong_text(text: str, mark: ParserMark, piece: TextPiece, rules: Rules) -> TextPiece | None:
    """Return the text before a piece from where the parser stops in it; None if it does not."""
    start = piece.start - len(text[mark.position : piece.start].lstrip(" \t\r\n\ufeff"))
    parent = mark.opened[-1].name if mark.opened else ""
    patterns = [_LOST] * (parent in CHILDREN if rules.is_urdf else rules.is_strict) + [REFERENCE] * rules.is_strict
    found = (pattern.search(text, start, piece.start) for pattern in patterns if parent)
    at = next((one.start() for one in found if one), piece.start)
    is_end = piece.form == "end"
    if not parent and ((rules.is_strict and not is_end) or (mark.is_late and (rules.is_strict or is_end))):
        at = start
    return TextPiece(at, piece.start, "", "text") if at < piece.start else None


def _is_wrong(text: str, mark: ParserMark, piece: TextPiece, rules: Rules) -> bool:
    """Return whether the parser stops at a piece."""
    parent = mark.opened[-1].name if mark.opened else ""
    if piece.at is not None or len(mark.opened) > _MAX_DEPTH:
        return True
    match piece.form:
        case "end":
            return bool(mark.opened) or not mark.is_late
        case "close":
            return piece.name != parent
        case "other":
            return _is_wrong_markup(text, piece, rules)
    if parent:
        return False
    is_known = rules.is_urdf and piece.name in ATTRIBUTES
    return (rules.is_strict or is_known) if mark.is_late else rules.is_urdf and piece.name != "robot"


def _is_wrong_markup(text: str, piece: TextPiece, rules: Rules) -> bool:
    """Return whether the parser stops at a comment, for what is in it, or at a declaration that is not the first."""
    if piece.name == "<!--":
        inner = "--" if rules.is_strict else "<!--" if rules.is_urdf else "\0"
        return inner in text[piece.start + 4 : piece.end - 3]
    before = text[: piece.start].strip("\ufeff" if rules.is_strict else " \t\r\n\ufeff")
    return piece.name == "<?" and text.startswith("<?xml ", piece.start) and bool(before)


def _piece(text: str, position: int, rules: Rules) -> TextPiece:
    """Return the next tag, comment or declaration, or the end; a malformed tag ends at its > or the next tag."""
    start = text.find("<", position)
    if start < 0:
        return TextPiece(len(text), len(text) + 1, "", "end")
    if opening := next((opening for opening in _ENDS if text.startswith(opening, start)), ""):
        end = text.find(_ENDS[opening], start + len(opening))
        is_whole = end >= 0 and (opening != "<?" or "<" not in text[start + 1 : end])
        at, end = (None, end + len(_ENDS[opening])) if is_whole else (start, len(text))
        return TextPiece(start, end, opening, "other", at)
    notes: list[int] = []
    try:
        tag, end = read_tag(text, start, lambda _kind, _what, offset: notes.append(offset))
    except MalformedTagError as error:
        body = _EXTENT.match(text, start, start + _MAX_TAG)
        return TextPiece(start, start + len(body[0].rstrip() if body else "<"), "", "open", error.offset)
    return TextPiece(start, end, tag.name, tag.form, notes[0] if notes and rules.is_strict else None, tag.attributes)


def _faults(piece: TextPiece, parent: str) -> int:
    """Return what urdfdom does not know of a tag in an element."""
    if parent not in ATTRIBUTES or piece.form not in ("open", "empty"):
        return 0
    known = ATTRIBUTES.get(piece.name, piece.attributes)
    is_child = piece.name in CHILDREN.get(parent, ()) or (parent == "robot" and piece.name not in ATTRIBUTES)
    return sum(key not in known and ":" not in key for key in piece.attributes) + (not is_child)


def remaining(text: str, *, is_urdf: bool = False) -> int:
    """Return how many characters of a text TinyXML2 does not read because of an error; -1 if there is none."""
    return len(text) - scan(text, Rules(is_urdf=is_urdf)).at
