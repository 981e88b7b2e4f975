"""The tags and comments of a text that may not be XML, and how far a parser reads it: TinyXML2, or a strict one."""

import re
from typing import NamedTuple

from grader.xml.tinyxml2.tags import REFERENCE, MalformedTagError, read_tag
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, PARTS, REQUIRED

ENDS = {"<!--": "-->", "<![CDATA[": "]]>", "<?": "?>", "<!": ">"}
_MAX_TAG = 2000  # characters: what is longer is no tag
_MAX_DEPTH = 500
# A malformed tag: to its >, or before the next tag; a comment in it is part of it.
_EXTENT = re.compile(r"<[<\s]*(?:[^<>]|<!--.*?-->)*>?", re.DOTALL)
_LOST = re.compile(
    rf"(?<![<\w/:.\-\"'=])/?(?:{'|'.join(sorted(ATTRIBUTES, key=len, reverse=True))})\b(?=[^<>]{{0,300}}>)"
)
_DECLARATION = re.compile(r"""<\?xml\s+version\s*=\s*["']1\.[0-9]["']\s*(encoding\s*=\s*["'][^"']*["']\s*)?\?>""")
_NO_NUMBERS = re.compile(r"[^-+0-9.,eE\s]")


class Piece(NamedTuple):
    """A tag, comment, declaration or text between two offsets: open, close, empty, other, text. `at` is where the parser stops in it.

    `faults` counts the attributes that urdfdom does not know, needs, or cannot read as numbers.
    """

    start: int
    end: int
    name: str
    form: str
    at: int | None = None
    has_attributes: bool = False
    faults: int = 0


class Rules(NamedTuple):
    """How a text is read: strictly or as by TinyXML2; as a URDF or as any XML: `is_urdf` stops also where a tag is lost as text."""

    is_strict: bool = False
    is_urdf: bool = False


class Mark(NamedTuple):
    """A place between two pieces: the innermost tag that is open there, with the mark before it, and how many are open.

    The `stage` is 0 at the start, 1 after declarations, 2 after a comment, and 3 after a tag.
    """

    position: int = 0
    opened: "tuple[Piece, Mark] | None" = None
    depth: int = 0
    stage: int = 0


class Scan(NamedTuple):
    """How far a text is read: `why` it stops, and at what; `marks` are the places before the `pieces` and after the last one."""

    pieces: list[Piece]
    marks: list[Mark]
    why: str
    wrong: Piece
    at: int
    faults: int


def scan(text: str, rules: Rules, mark: Mark | None = None, limit: int | None = None) -> Scan:
    """Read a text from a mark to its first error, or until a limit."""
    limit = len(text) + 1 if limit is None else limit
    pieces: list[Piece] = []
    marks = [mark or Mark()]
    faults, why, wrong = 0, "", Piece(limit, limit, "", "text")
    while marks[-1].position < limit and not why:
        mark = marks[-1]
        piece = _piece(text, mark.position, rules)
        why, wrong = _gap(text, mark, piece, rules)
        if why or piece is None:
            break
        pieces.append(piece)
        parent = mark.opened[0].name if mark.opened else ""
        why, wrong = _why(text, piece, mark, rules), piece
        if rules.is_urdf and parent in ATTRIBUTES:
            is_text = text[mark.position : piece.start].strip() and parent in CHILDREN
            is_tag = piece.form in ("open", "empty") and (parent != "robot" or piece.name in ATTRIBUTES)
            faults += piece.faults + bool(is_text) + (is_tag and piece.name not in CHILDREN.get(parent, ()))
        stage = max(mark.stage, 3 if piece.form != "other" else 1 if piece.name == "<?" else 2)
        if piece.form == "open" and not why:
            marks.append(Mark(piece.end, (piece, mark), mark.depth + 1, stage))
        elif not why:
            outer = mark.opened[1] if mark.opened and piece.form == "close" else mark
            marks.append(Mark(piece.end, outer.opened, outer.depth, stage))
    at = limit if not why else wrong.start if wrong.at is None else wrong.at
    return Scan(pieces, marks, why, wrong, min(at, limit), faults)


def _gap(text: str, mark: Mark, piece: Piece | None, rules: Rules) -> tuple[str, Piece]:
    """Return what is wrong with the text before a piece, or at the end of the file."""
    end = piece.start if piece else len(text)
    start = mark.position + len(text[mark.position : end]) - len(text[mark.position : end].lstrip(" \t\r\n\ufeff"))
    if start < end and not mark.opened and (rules.is_strict or (piece is None and mark.stage == 3)):
        return "text", Piece(start, end, "", "text")
    is_robot = rules.is_urdf and mark.opened and mark.opened[0].name in CHILDREN
    if is_robot and (lost := _LOST.search(text, start, end)):
        return "bracket", Piece(lost.start(), end, "", "text")
    if rules.is_strict and (reference := REFERENCE.search(text, start, end)):
        return "reference", Piece(*reference.span(), "&", "text")
    is_end = piece is None and (mark.opened or mark.stage != 3)
    return "end" if is_end else "", Piece(end, end, "", "text")


def _why(text: str, piece: Piece, mark: Mark, rules: Rules) -> str:
    """Return what is wrong with a piece where it is."""
    if piece.at is not None:
        return "comment" if piece.form == "other" else "tag"
    if piece.name == "<!--":
        inner = "--" if rules.is_strict else "<!--" if rules.is_urdf else "\0"
        return "comment" if inner in text[piece.start + 4 : piece.end - 3] else ""
    if piece.name == "<?" and not (rules.is_strict and text.startswith("<?xml-", piece.start)):
        before = text[mark.position : piece.start].lstrip("\ufeff" if rules.is_strict else "\ufeff \t\r\n")
        is_first = not before and mark.stage < (1 if rules.is_strict else 2)
        is_right = not rules.is_strict or _DECLARATION.fullmatch(text, piece.start, piece.end)
        return "misplaced" if not is_first else "" if is_right else "version"
    if piece.form == "close":
        return "" if mark.opened and mark.opened[0].name == piece.name else "close"
    if piece.form == "other":
        return ""
    if not mark.opened and (mark.stage == 3 or rules.is_urdf):
        if mark.stage == 3:
            return "second" if rules.is_strict or (rules.is_urdf and piece.name in ATTRIBUTES) else ""
        return "" if piece.name == "robot" else "root"
    prefix = piece.name.rpartition(":")[0] if rules.is_strict else ""
    is_declared = not prefix or re.compile(rf"xmlns:{re.escape(prefix)}\s*=").search(text, 0, piece.end)
    return "deep" if mark.depth >= _MAX_DEPTH else "" if is_declared else "prefix"


def _piece(text: str, position: int, rules: Rules) -> Piece | None:
    """Return the next tag, comment or declaration; a malformed tag ends at its >, or before the next tag."""
    start = text.find("<", position)
    if start < 0:
        return None
    if opening := next((opening for opening in ENDS if text.startswith(opening, start)), ""):
        end = text.find(ENDS[opening], start + len(opening))
        at, end = (start, len(text)) if end < 0 else (None, end + len(ENDS[opening]))
        return Piece(start, end, opening, "other", at)
    notes: list[int] = []
    try:
        tag, end = read_tag(text, start, lambda _kind, _what, offset: notes.append(offset))
    except MalformedTagError as error:
        body = _EXTENT.match(text, start, start + _MAX_TAG)
        return Piece(start, start + len(body[0].rstrip() if body else "<"), "", "open", error.offset)
    at = notes[0] if notes and rules.is_strict else None
    is_known = rules.is_urdf and tag.form != "close" and tag.name in ATTRIBUTES
    faults = 0
    if is_known:
        faults = sum(key not in tag.attributes for key in REQUIRED[tag.name])
        faults += sum(not _is_right(tag.name, *pair) for pair in tag.attributes.items())
    return Piece(start, end, tag.name, tag.form, at, bool(tag.attributes), faults)


def _is_right(tag: str, key: str, value: str) -> bool:
    parts = PARTS.get(key, ())
    is_read = not parts or "$" in value or (len(value.split()) == len(parts) and not _NO_NUMBERS.search(value))
    return (key in ATTRIBUTES[tag] or ":" in key) and is_read


def remaining(text: str, *, is_urdf: bool = False) -> int:
    """Return how many characters of a text TinyXML2 does not read because of an error; -1 if there is none."""
    return len(text) - scan(text, Rules(is_urdf=is_urdf)).at
