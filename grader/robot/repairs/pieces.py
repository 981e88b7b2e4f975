"""The tags and comments of a text that may not be XML, each with its extent, and how far TinyXML2 reads it."""

from collections.abc import Iterator
from typing import Literal, NamedTuple

from grader.xml.tinyxml2.tags import MalformedTagError, read_tag
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN

# Tags that contain nothing, and are closed with />.
LEAVES = frozenset(ATTRIBUTES) - frozenset(CHILDREN)

_MAX_ERRORS = 500
_MAX_TAG = 2000  # characters: what is longer is no tag
_OTHER = {"<!--": "-->", "<![CDATA[": "]]>", "<?": "?>", "<!": ">"}


class Piece(NamedTuple):
    """A tag, or a comment, declaration or CDATA section (`other`), between two offsets. `error` is where TinyXML2 stops in it."""

    start: int
    end: int
    name: str
    form: Literal["open", "close", "empty", "other"]
    error: int | None = None
    has_attributes: bool = False

    def text_in(self, text: str) -> str:
        """Return the text of the tag."""
        return text[self.start : self.end]


def pieces_of(text: str) -> Iterator[Piece]:
    """Yield the tags and comments of a text in order; a malformed tag ends at its >, or before the next tag."""
    position = errors = 0
    while errors < _MAX_ERRORS and (start := text.find("<", position)) >= 0:
        piece = _other(text, start) or _tag(text, start)
        yield piece
        errors += piece.error is not None
        position = max(piece.end, start + 1)


def _other(text: str, start: int) -> Piece | None:
    opening = next((opening for opening in _OTHER if text.startswith(opening, start)), None)
    if opening is None:
        return None
    end = text.find(_OTHER[opening], start + len(opening))
    if end < 0:
        return Piece(start, len(text), opening, "other", start)
    return Piece(start, end + len(_OTHER[opening]), opening, "other")


def _tag(text: str, start: int) -> Piece:
    try:
        tag, end = read_tag(text, start, lambda *_: None)
    except MalformedTagError as error:
        return Piece(start, _extent(text, start), "", "open", error.offset)
    return Piece(start, end, tag.name, tag.form, None, bool(tag.attributes))


def _extent(text: str, start: int) -> int:
    """Return the offset after a malformed tag."""
    position = start + 1
    while text[position : position + 1] in ("<", " "):
        position += 1
    while (comment := text.find("<!--", position)) >= 0 and ">" not in text[position:comment]:
        end = text.find("-->", comment)
        if end < 0 or text.find("<", position) < comment:
            break
        position = end + 3
    limit = position + _MAX_TAG
    closed, opened = text.find(">", position, limit), text.find("<", position, limit)
    if closed >= 0 and (opened < 0 or closed < opened):
        return closed + 1
    body = text[start : opened if opened >= 0 else limit]
    return start + len(body.rstrip())


class Tree(NamedTuple):
    """How far the tags of a text match: the tags that are open there, and the closing tag that does not match, if there is one."""

    pieces: list[Piece]
    open_tags: list[Piece]
    mismatch: Piece | None
    reached: int

    @classmethod
    def of(cls, text: str) -> "Tree":
        """Return the tree of a text up to its first error."""
        pieces = list(pieces_of(text))
        open_tags: list[Piece] = []
        is_begun = False
        for piece in pieces:
            if piece.error is not None:
                return cls(pieces, open_tags, None, piece.error)
            is_begun = is_begun or piece.form != "other"
            if piece.form == "open":
                open_tags.append(piece)
            elif piece.form == "close":
                if not open_tags:
                    break  # TinyXML2 stops here without an error
                if open_tags[-1].name != piece.name:
                    return cls(pieces, open_tags, piece, piece.start)
                open_tags.pop()
        end = pieces[-1].end if pieces else 0
        if open_tags or not is_begun:
            return cls(pieces, open_tags, None, len(text))
        return cls(pieces, [], None, end if text[end:].strip() else len(text) + 1)


def remaining(text: str) -> int:
    """Return how many characters of a text TinyXML2 does not read because of an error; -1 if there is none."""
    return len(text) - Tree.of(text).reached
