"""The tags and comments of a text that may not be XML, and how far a parser reads it: TinyXML2, or a strict one."""

import re
from typing import Literal, NamedTuple

from grader.xml.tinyxml2.tags import REFERENCE, MalformedTagError, read_tag
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, PARTS, REQUIRED

_MAX_TAG = 2000  # characters: what is longer is no tag
_MAX_DEPTH = 500
ENDS = {"<!--": "-->", "<![CDATA[": "]]>", "<?": "?>", "<!": ">"}
# A malformed tag: to its >, or before the next tag; a comment in it is part of it.
_EXTENT = re.compile(r"<[<\s]*(?:[^<>]|<!--.*?-->)*>?", re.DOTALL)
_LOST = re.compile(rf"(?<![<\w/:.\-\"'=])(/?)({'|'.join(sorted(ATTRIBUTES, key=len, reverse=True))})\b(?=[^<>]*>)")
_NO_NUMBERS = re.compile(r"[^-+0-9.,eE\s]")
_DECLARATION = re.compile(r"""<\?xml\s+version\s*=\s*["']1\.[0-9]["']\s*(encoding\s*=\s*["'][^"']*["']\s*)?\?>""")


class Piece(NamedTuple):
    """A tag, or a comment, declaration or CDATA section (`other`), between two offsets. `error` is where the parser stops in it.

    `faults` counts the attributes that urdfdom does not know, needs, or cannot read as numbers.
    """

    start: int
    end: int
    name: str
    form: Literal["open", "close", "empty", "other", "text"]
    error: int | None = None
    has_attributes: bool = False
    faults: int = 0


class Open(NamedTuple):
    """An open tag, and those around it."""

    piece: Piece
    outer: "Open | None"
    depth: int = 1


class Rules(NamedTuple):
    """How a text is read: as a URDF or as any XML, by TinyXML2 or strictly; `is_wary` stops also at what only looks like an error."""

    is_urdf: bool
    is_strict: bool
    is_wary: bool = False


class Mark(NamedTuple):
    """A place between two pieces: the tags that are open there, and whether the root is before it."""

    position: int = 0
    opened: Open | None = None
    has_root: bool = False


class Scan(NamedTuple):
    """How far a text is read: `why` it stops there, and at what; `marks` are the places before the `pieces` that were read."""

    pieces: list[Piece]
    marks: list[Mark]
    at: int
    why: str
    wrong: Piece | None
    opened: Open | None
    faults: int


def scan(text: str, rules: Rules, mark: Mark | None = None, limit: int | None = None) -> Scan:
    """Read a text from a mark to its first error, or until a limit."""
    mark, limit = mark or Mark(), len(text) + 1 if limit is None else limit
    pieces: list[Piece] = []
    marks: list[Mark] = []
    faults, why, wrong = 0, "", None
    while mark.position < limit:
        found = _piece(text, mark.position, rules)
        end = found.start if found is not None else len(text)
        why, wrong = _gap(text, mark, end, rules, is_last=found is None)
        is_text = mark.opened is not None and mark.opened.piece.name in CHILDREN and text[mark.position : end].strip()
        faults += bool(is_text and rules.is_urdf)
        if why or found is None:
            break
        pieces.append(found)
        marks.append(mark)
        why = _why(text, found, mark, rules, pieces)
        if why:
            wrong = found
            break
        faults += _faults(found, mark.opened) if rules.is_urdf else 0
        opened = mark.opened
        if found.form == "open":
            opened = Open(found, opened, opened.depth + 1 if opened else 1)
        elif found.form == "close":
            opened = opened.outer if opened else None
        mark = Mark(found.end, opened, mark.has_root or found.form != "other")
    at = limit if not why else wrong.error if wrong and wrong.error is not None else wrong.start if wrong else len(text)
    return Scan(pieces, marks, min(at, limit), why, wrong, mark.opened, faults)


def _gap(text: str, mark: Mark, end: int, rules: Rules, *, is_last: bool) -> tuple[str, Piece | None]:
    """Return what is wrong with the text before a piece, or before the end of the file."""
    if text[mark.position : end].strip(" \t\r\n\ufeff"):
        start = mark.position + len(text[mark.position : end]) - len(text[mark.position : end].lstrip())
        if not mark.opened and (mark.has_root and is_last or rules.is_strict):
            return "text", Piece(start, end, "", "text")
        if rules.is_wary and mark.opened and mark.opened.piece.name in CHILDREN:
            lost = _LOST.search(text, start, end)
            if lost:
                return "bracket", Piece(lost.start(), end, lost[2], "text")
        reference = REFERENCE.search(text, start, end) if rules.is_strict else None
        if reference:
            return "reference", Piece(*reference.span(), "&", "text")
    return ("end", None) if is_last and (mark.opened or not mark.has_root) else ("", None)


def _why(text: str, piece: Piece, mark: Mark, rules: Rules, pieces: list[Piece]) -> str:
    """Return what is wrong with a piece where it stands."""
    opened, is_known = mark.opened, rules.is_urdf and rules.is_wary
    match piece.form:
        case _ if piece.error is not None:
            return piece.name if piece.form == "other" else "tag"
        case "other" if piece.name == "<?" and not (rules.is_strict and text.startswith("<?xml-", piece.start)):
            before = text[: piece.start].lstrip("\ufeff" if rules.is_strict else "\ufeff \t\r\n")
            is_first = all(other.name == "<?" for other in pieces) and (not before or before.startswith("<?"))
            is_first = is_first and not (before and rules.is_strict)
            is_correct = not rules.is_strict or _DECLARATION.fullmatch(text, piece.start, piece.end)
            return "declaration" if not is_first else "" if is_correct else "version"
        case "other":
            inner = "--" if rules.is_strict else "<!--" if rules.is_wary else "\0"
            return "comment" if piece.name == "<!--" and inner in text[piece.start + 4 : piece.end - 3] else ""
        case "close":
            return "" if opened and opened.piece.name == piece.name else "close"
        case _ if opened is None and mark.has_root:
            return "second" if rules.is_strict or (is_known and piece.name in ATTRIBUTES) else ""
        case _ if opened is None and is_known and piece.name != "robot":
            return "root"
        case _:
            prefix = piece.name.rpartition(":")[0] if rules.is_strict else ""
            is_declared = not prefix or re.search(rf"xmlns:{re.escape(prefix)}\s*=", text[: piece.end])
            return "deep" if opened and opened.depth >= _MAX_DEPTH else "" if is_declared else "prefix"


def _faults(piece: Piece, opened: Open | None) -> int:
    """Return how many faults a tag has for urdfdom where it stands."""
    if piece.form not in ("open", "empty") or opened is None or opened.piece.name not in ATTRIBUTES:
        return piece.faults
    is_extension = opened.piece.name == "robot" and piece.name not in ATTRIBUTES
    return piece.faults + (piece.name not in CHILDREN.get(opened.piece.name, ()) and not is_extension)


def _piece(text: str, position: int, rules: Rules) -> Piece | None:
    start = text.find("<", position)
    if start < 0:
        return None
    opening = next((opening for opening in ENDS if text.startswith(opening, start)), None)
    if opening is not None:
        end = text.find(ENDS[opening], start + len(opening))
        if end < 0:
            return Piece(start, len(text), opening, "other", start)
        return Piece(start, end + len(ENDS[opening]), opening, "other")
    notes: list[int] = []
    try:
        tag, end = read_tag(text, start, lambda _kind, _what, offset: notes.append(offset))
    except MalformedTagError as error:
        body = _EXTENT.match(text, start, start + _MAX_TAG)
        return Piece(start, start + len(body[0].rstrip() if body else "<"), "", "open", error.offset)
    if notes and rules.is_strict:
        return Piece(start, end, tag.name, tag.form, notes[0])
    faults = _wrong_attributes(tag.name, tag.attributes) if rules.is_urdf and tag.form != "close" else 0
    return Piece(start, end, tag.name, tag.form, None, bool(tag.attributes), faults)


def _wrong_attributes(name: str, attributes: dict[str, str]) -> int:
    if name not in ATTRIBUTES:
        return 0
    known = ATTRIBUTES[name]
    unknown = sum(key not in known and ":" not in key for key in attributes)
    unread = (not _is_read(PARTS.get(key, ()), value) for key, value in attributes.items())
    return unknown + sum(key not in attributes for key in REQUIRED[name]) + sum(unread)


def _is_read(parts: tuple[str, ...], value: str) -> bool:
    return not parts or "$" in value or (len(value.split()) == len(parts) and not _NO_NUMBERS.search(value))


def remaining(text: str, *, is_wary: bool = False) -> int:
    """Return how many characters of a text TinyXML2 does not read because of an error; -1 if there is none."""
    return len(text) - scan(text, Rules(is_urdf=is_wary, is_strict=False, is_wary=is_wary)).at
