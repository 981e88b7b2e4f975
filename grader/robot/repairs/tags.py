"""Malformed tags, written as a URDF has them: <parent="base_link"/> becomes <parent link="base_link"/>."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from grader.edits import Proposal
from grader.names import closest
from grader.robot.repairs.pieces import LEAVES, Piece, pieces_of
from grader.source import Source
from grader.xml.urdf_format import ATTRIBUTES

_QUOTES = "\"'\u201c\u201d\u201e\u2018\u2019\u201a\u00ab\u00bb\u2033\u2032\u00b4`"
_CURLY = re.compile(f"[{_QUOTES[2:]}]")
_BETWEEN = " \t\r\n,;"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_DASHES = re.compile(r"<[-\u2013\u2014!]+(.*?)[-\u2013\u2014]*>", re.DOTALL)
_NAME = re.compile(r"[<\s]*([\\/]?)\s*([A-Za-z_][\w.:\-]*)")
_TAIL = re.compile(r"[\s?\\/>]*$")
# The first attribute of each tag that has one: the one that is meant where a value has no name.
_FIRST = {
    "origin": ("xyz", "rpy"),
    "cylinder": ("radius", "length"),
    "joint": ("name", "type"),
    "robot": ("name",),
    "color": ("rgba",),
    "mesh": ("filename", "scale"),
}
# What is wrong with a tag, and what to do: the first whose pattern is found in it.
_CAUSES = (
    (re.compile(r"^<\s*(?:/\s|<|\s|/?\s*/\s*/)"), "the start of a tag", "correct the start of the tag"),
    (_CURLY, "typographic quotes", "write straight quotes"),
    (re.compile(r"<!--"), "a comment inside a tag", "remove the comment from the tag"),
    (re.compile(r"[^/?]\s*$(?<!>)"), "a tag without its >", "end the tag with >"),
    (re.compile(r"/\s*$(?<!>)"), "a tag without its >", "end the tag with >"),
    (re.compile(r"\\"), "a backslash in a tag", "replace the backslash with /"),
    (re.compile(r"""["']\s*[,;]"""), "a comma between attributes", "separate the attributes with spaces"),
    (re.compile(r"""^<\s*[\w.]+\s*="""), "the name of an attribute is missing", "name the attribute"),
    (re.compile(r"""^[^"']*(?:(?:"[^"]*"|'[^']*')[^"']*)*["'][^"']*$"""), "a quote is missing", "add the quote"),
    (re.compile(r"""=\s*[^\s"'=]"""), "the quotes, which are missing", "put the value in quotes"),
    (re.compile(r"""^[^=]*$|["']\s+[a-z]+\s*["']|^<\w+\s+\w+\s*["']"""), "the equals sign is missing", "write = before the value"),
)  # fmt: skip


class Rewrite(NamedTuple):
    """A tag as it should be written, what is wrong with it, and what to do."""

    new: str
    cause: str
    action: str


def tag_proposals(source: Source) -> Iterator[Proposal]:
    """Yield edits of the first malformed tag, each together with all tags that have the same mistake."""
    text = source.text
    broken = [piece for piece in pieces_of(text) if piece.error is not None and piece.form != "other"]
    if not broken:
        return
    ways = [list(rewrites(text, piece)) for piece in broken]
    for first in ways[0]:
        alike = [
            (piece, next((way for way in found if way.cause == first.cause), None))
            for piece, found in zip(broken, ways, strict=True)
        ]
        edits = [source.edit(*_span(text, piece), way.new) for piece, way in alike if way is not None]
        for chosen in (edits, edits[:1]) if len(edits) > 1 else (edits,):
            yield Proposal(tuple(chosen), first.cause, first.action)


def _span(text: str, piece: Piece) -> tuple[int, int]:
    """Return the extent of a malformed tag; a second < or > beside it is part of it."""
    end = piece.end
    return piece.start, end + 1 if text[end : end + 1] == ">" else end


def rewrites(text: str, piece: Piece) -> Iterator[Rewrite]:
    """Yield the ways to write a malformed tag."""
    body = piece.text_in(text)
    name = _NAME.match(_COMMENT.sub("", body))
    if dashes := _DASHES.fullmatch(body):
        yield Rewrite(f"<!-- {dashes[1].strip()} -->", "the start of a comment", "begin the comment with <!--")
    if name is None:
        return
    inner = _COMMENT.sub("", body)[name.end() :]
    tail = _TAIL.search(inner)
    rest, end = (inner[: tail.start()], tail[0]) if tail else (inner, "")
    cause, action = _cause(body)
    if name[1]:
        yield Rewrite(f"</{name[2]}>", cause, action)
        return
    if name[2].lower() == "xml":
        yield Rewrite(
            '<?xml version="1.0"?>', "the XML declaration", "begin the XML declaration with <? and end it with ?>"
        )
        return
    glued = next((tag for tag in ATTRIBUTES if name[2].removeprefix(tag) in ATTRIBUTES[tag]), "")
    if name[2] not in ATTRIBUTES and glued:
        rest, name_of = f"{name[2].removeprefix(glued)}{rest}", glued
        cause, action = "the space after the name of a tag is missing", "add the space"
    else:
        name_of = name[2]
    if (joined := re.sub(r"\s", "", f"{name[2]}{rest}")) in ATTRIBUTES and rest:
        yield Rewrite(f"<{joined}{end.strip() or '>'}", "a space in the name of a tag", "remove the space")
    is_empty = "/" in end or "\\" in end or (not body.endswith(">") and _is_leaf(text, piece, name_of))
    closing = ("/>" if is_empty else ">") if not end.startswith((" ", "\t")) else (" />" if is_empty else ">")
    quote = "'" if text.count("='") > text.count('="') else '"'
    for attributes in _attributes(name_of, rest):
        if len(dict(attributes)) == len(attributes):
            values = "".join(f" {key}={quote}{value}{quote}" for key, value in attributes)
            yield Rewrite(f"<{name_of}{values}{closing}", cause, action)
        else:
            yield from _without_repetition(name_of, attributes, closing, quote)


def _without_repetition(tag: str, attributes: list[tuple[str, str]], closing: str, quote: str) -> Iterator[Rewrite]:
    """Yield a tag with a repeated attribute named as one that is missing, or omitted."""
    known = _known(tag)
    unique = dict(reversed(attributes))
    missing = [key for key in known if key not in unique]
    renamed: list[tuple[str, str]] = []
    for key, value in attributes:
        is_repeated = key in dict(renamed)
        renamed += [(missing[0], value)] if is_repeated and missing else [] if is_repeated else [(key, value)]
    for found in (renamed, list(unique.items()), list(dict(attributes).items())):
        if len(dict(found)) == len(found):
            values = "".join(f" {key}={quote}{value}{quote}" for key, value in found)
            yield Rewrite(
                f"<{tag}{values}{closing}",
                "a duplicate attribute",
                "rename or remove one of the two attributes",
            )


def _cause(body: str) -> tuple[str, str]:
    found = ((cause, action) for pattern, cause, action in _CAUSES if pattern.search(body))
    return next(found, ("a malformed tag", "correct the tag"))


def _is_leaf(text: str, piece: Piece, tag: str) -> bool:
    return tag in LEAVES and not text[piece.end :].lstrip().startswith(f"</{tag}")


def _known(tag: str) -> tuple[str, ...]:
    """Return the attributes of a tag, or of the one that it is probably meant to be, in their usual order."""
    name = tag if tag in ATTRIBUTES else closest(tag, ATTRIBUTES) or ""
    return _FIRST.get(name) or tuple(sorted(ATTRIBUTES.get(name, ())))


def _attributes(tag: str, rest: str) -> Iterator[list[tuple[str, str]]]:
    """Yield the attributes that the text after the name of a tag may stand for."""
    known = _known(tag)
    words = "|".join(map(re.escape, known)) or "(?!)"
    key = re.compile(
        rf"(?<![\w:.\-])([A-Za-z_][\w:.\-]*)?\s*=+\s*|(?<![\w:.\-{_QUOTES}])({words})\s*:?\s*(?=[{_QUOTES}])"
    )
    keys = list(key.finditer(rest))
    if not keys:
        words_only = re.compile(rf"\b({words})\s+")
        keys = list(words_only.finditer(rest))
    if not keys:
        value = _value(rest)
        yield [(known[0] if known else "name", value)] if value else []
        return
    ends = [*(found.start() for found in keys[1:]), len(rest)]
    named: list[tuple[str, str]] = []
    for found, end in zip(keys, ends, strict=True):
        taken = [name for name, _ in named]
        free = (name for name in known if name not in taken)
        name = found[1] or (found[2] if found.re.groups > 1 else None) or next(free, "name")
        named.append((name, _value(rest[found.end() : end])))
    yield named


def _value(text: str) -> str:
    """Return a value without quotes, and without what is after its second quote."""
    begun = text.strip(_BETWEEN)
    value = begun.lstrip(_QUOTES)
    if value == begun and not any(quote in value for quote in _QUOTES):
        return value
    end = min((at for quote in _QUOTES if (at := value.find(quote)) >= 0), default=len(value))
    return value[:end].strip() if end == len(value) else value[:end]
