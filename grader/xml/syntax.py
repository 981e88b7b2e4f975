"""Edits after which a broken XML text can be read: a search over few operations near the place where the parser stops."""

import re
from collections import Counter
from collections.abc import Iterator
from itertools import islice, takewhile
from typing import NamedTuple

from grader import markup
from grader.edits import Proposal, composed
from grader.names import closest
from grader.source import Edit, Source
from grader.xml.pieces import Mark, Piece, Rules, Scan, scan, without_bracket
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, TAGS

_MAX_ERRORS = 40  # of one text
_MAX_TRIES = 400  # at one error
_MAX_WAYS = 4  # at one error that grading decides among
_MAX_KEPT = 40  # at one error, each with its text
_MAX_FOUND = 8
_MAX_READ = 3_000_000  # characters
_MAX_LOOKED = 2_000  # characters of a comment
_WINDOW = 400  # characters after an error that must be read
_CURLY = "\u201c\u201d\u201e\u2018\u2019\u201a\u00ab\u00bb\u2033\u2032\u00b4`"
_QUOTES = f"\"'{_CURLY}"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_HEAD = re.compile(r"[<\s]*([\\/]?)\s*([A-Za-z_][\w.:\-]*)")
_DASHES = "-\u2013\u2014!"
_NEAR = re.compile(r"[-\u2013\u2014]+[\s!]*>|[-\u2013\u2014]{2,}(?=\s*\n)")  # the end of a comment
_XML = '<?xml version="1.0"?>'
# What is wrong, and what to do; in a tag by the characters that are removed (-) or added (+).
_WAYS = {
    "-\\": ("a backslash in a tag", "replace the backslash with /"),
    f"-{_CURLY}": ("typographic quotes", "write straight quotes"),
    "-,;": ("a comma between attributes", "separate the attributes with spaces"),
    "-!": ("a comment inside a tag", "remove the comment from the tag"),
    "+>": ("a tag without its >", "end the tag with >"),
    "+<": ("the < of a tag is missing", "begin the tag with <"),
    "+abcdefghijklmnopqrstuvwxyz": ("the name of an attribute is missing", "name the attribute"),
    "+=": ("the equals sign is missing", "write = before the value"),
    "+\"'": ("a quote is missing", "add the quote"),
    "+/": ("the / of a tag without content is missing", "end the tag with />"),
    "-<>/=\"' ": ("an extra character in a tag", "remove the character"),
    "+ ": ("a space in a tag is missing", "add the space"),
    "tag": ("the name of a tag", "correct the name of the tag"),
    "twice": ("a duplicate attribute", "rename or remove one of the two attributes"),
    "close": ("a closing tag is missing", "add the closing tag"),
    "open": ("a tag is missing", "add the tag"),
    "begin": ("the / of a tag with content is too much", "remove the /"),
    "slash": ("the / of a closing tag is missing", "add the /"),
    "extra": ("an extra closing tag", "remove the closing tag"),
    "name": ("the name of a closing tag", "correct the closing tag"),
    "drop": ("a tag that is not closed", "remove the tag"),
    "early": ("a closing tag before the end of its element", "move the closing tag to the end"),
    "text": ("text that is no XML", "remove the text"),
    "comment": ("a malformed comment", "write the comment as <!-- ... -->"),
    "version": ("a malformed XML declaration", f"write {_XML}"),
    "misplaced": ("an XML declaration that is not at the top", "remove the XML declaration"),
    "reference": ("an & that is not escaped", "write &amp; for &"),
}

_LOSSY = ("drop", "text")

Change = tuple[int, int, str]


class Way(NamedTuple):
    """What is wrong, the changes of a text that correct it, each from an offset to another one, and the text after them."""

    name: str
    changes: list[Change]
    after: str


def proposals(source: Source, *, is_urdf: bool, is_strict: bool) -> Iterator[Proposal]:
    """Yield edits after which a text can be read, the most plausible first; nothing where none brings the parser further."""
    search = _Search(Rules(is_strict, is_urdf))
    first = list(search.steps(source.text))
    if first:
        yield _joined(source, [ways[0] for ways in first])
    others = ((index, way) for index in reversed(range(len(first))) for way in first[index][1:])
    for index, way in islice(others, _MAX_FOUND):
        yield _joined(
            source, [*(ways[0] for ways in first[:index]), way, *(ways[0] for ways in search.steps(way.after))]
        )


def _joined(source: Source, ways: list[Way]) -> Proposal:
    edits: tuple[Edit, ...] = ()
    text = source.text
    for way in ways:
        own = Source(source.path, text)
        edits = composed(source.text, source.path, edits, [own.edit(*change) for change in way.changes])
        text = way.after
    causes, actions = zip(*dict.fromkeys(_WAYS[way.name] for way in ways), strict=True)
    return Proposal(edits, " and ".join(causes), " and ".join(dict.fromkeys(actions)))


class _Search:
    """A search, whose work is bounded."""

    def __init__(self, rules: Rules) -> None:
        self.rules, self.left = rules, _MAX_READ

    def steps(self, text: str) -> Iterator[list[Way]]:
        """Yield the ways to bring the parser further, the best first, until the text can be read."""
        for _ in range(_MAX_ERRORS):
            if not (ways := self._ways(text)):
                return
            yield ways
            text = ways[0].after

    def _ways(self, text: str) -> list[Way]:
        self.left -= len(text)
        stop = scan(text, self.rules)
        if not stop.why or self.left < 0:
            return []
        found: dict[str, tuple[tuple[int, bool, int], Way]] = {}
        operations = _Operations(text, stop, self.rules.is_urdf)
        for stage in (operations.likely(), operations.characters()):
            for name, *changes in islice(stage, _MAX_TRIES):
                way = _way(text, name, changes)
                rank = self._rank(text, stop, way) if self.left > 0 and way.after not in found else None
                if rank is not None:
                    found[way.after] = rank, way
                if len(found) > _MAX_KEPT:
                    del found[max(reversed(found), key=lambda after: found[after][0])]
            if any(not faults for (_, _, faults), _ in found.values()):
                break
        return [way for _, way in sorted(found.values(), key=lambda pair: pair[0])][:_MAX_WAYS]

    def _rank(self, text: str, stop: Scan, way: Way) -> tuple[int, bool, int] | None:
        """Return how far the parser is from the end, whether text is lost, and the faults for urdfdom; None if no further."""
        if way.after == text:
            return None
        mark = next((mark for mark in reversed(stop.marks) if mark.position <= way.changes[0][0]), Mark())
        limit = min(stop.at + _WINDOW + max(len(way.after) - len(text), 0), len(way.after) + 1)
        self.left -= limit - mark.position
        after = scan(way.after, self.rules, mark, limit)
        if len(way.after) - after.at >= len(text) - stop.at:
            return None
        return len(way.after) - after.at if after.at < limit else -1, way.name in _LOSSY, after.faults


def _way(text: str, name: str, changes: list[Change]) -> Way:
    changes = sorted((change for change in changes if change[0] < change[1] or change[2]), key=lambda change: change[0])
    after = text
    for start, end, new in reversed(changes):
        after = after[:start] + new + after[end:]
    return Way(name, changes, after)


class _Operations:
    """The operations at one error: each a name and changes."""

    def __init__(self, text: str, stop: Scan, is_urdf: bool) -> None:
        self.text, self.stop, self.is_urdf = text, stop, is_urdf
        self.line = "\r\n" if "\r\n" in text else "\n"
        self.open: list[Piece] = []  # the innermost first
        opened = stop.marks[-1].opened
        while opened and len(self.open) < _MAX_TRIES:
            self.open.append(opened[0])
            opened = opened[1].opened

    def likely(self) -> Iterator[tuple[str, *tuple[Change, ...]]]:
        """Yield what is usual for the error."""
        wrong, text, why, end = self.stop.wrong, self.text, self.stop.why, len(self.text.rstrip())
        start, tags = wrong.start, [piece for piece in self.stop.pieces if piece.form != "other" and piece is not wrong]
        if why == "tag":
            yield from self._rewritten(wrong)
        elif why in ("close", "end"):
            yield from self._unclosed(tags, wrong)
        elif why == "comment" and wrong.name == "<!--":
            yield from self._comment(wrong)
        elif why in ("comment", "version"):
            yield "version", (start, text.find(">", start) + 1 or end, _XML)
        elif why == "bracket":
            yield "+<", (start, start, "<")
        elif why == "reference":
            yield "reference", (start, start + 1, "&amp;")
        elif why == "misplaced":
            yield "misplaced", self._removed(wrong)
            yield "text", (int(text.startswith("\ufeff")), start, "")
        elif why == "root":
            if wrong.name not in ATTRIBUTES:
                yield "tag", self._named(wrong, "robot")
            yield "open", (start, start, f"<robot>{self.line}")
        elif tags and why in ("second", "text"):
            if wrong.form != "text":
                yield "early", self._begun(tags[0]) if tags[0].form == "empty" else self._removed(tags[-1])
            yield "text", (start, min(end, wrong.end), "")

    def characters(self) -> Iterator[tuple[str, *tuple[Change, ...]]]:
        """Yield the insertion or deletion of one character near the error."""
        wrong, text = self.stop.wrong, self.text
        if wrong.form not in ("open", "close", "empty"):
            return
        for at, old in enumerate(text[wrong.start : wrong.end + 1], wrong.start):
            for new in " " if old.isalnum() and text[at - 1].isalnum() else ('"', ">", "/>", "<", "=", "/", "'", " "):
                yield _said("", new), (at, at, new)
            if not old.isalnum():
                yield _said(old, ""), (at, at + 1, "")

    def _named(self, piece: Piece, name: str) -> Change:
        end = markup.name_end(self.text, piece.start)
        return end - len(piece.name), end, name

    def _removed(self, piece: Piece) -> Change:
        """Return the removal of a tag, with its line where nothing else is on it."""
        start = piece.start - len(markup.indentation(self.text, piece.start))
        line = re.compile(r"\r?\n").match(self.text, piece.end)
        is_alone = line and self.text[start - 1 : start] in ("", "\n")
        return (start, line.end(), "") if line and is_alone else (piece.start, piece.end, "")

    def _begun(self, piece: Piece) -> Change:
        return len(self.text[: self.text.rindex("/", piece.start, piece.end)].rstrip()), piece.end, ">"

    def _closed(self, offset: int, opened: list[Piece]) -> Change:
        """Return the closing of tags after what is before an offset."""
        end, new = len(self.text[:offset].rstrip()), ""
        for piece in opened:
            is_line = "\n" in self.text[piece.start : end]
            new += f"{self.line}{markup.indentation(self.text, piece.start)}" * is_line + f"</{piece.name}>"
        return end, end, new

    def _unclosed(self, tags: list[Piece], closing: Piece) -> Iterator[tuple[str, *tuple[Change, ...]]]:
        """Yield what may be wrong with a closing tag or the end of the file, or with the tags that are open there."""
        is_end, top = closing.form == "end", self.open[0] if self.open else closing
        near = without_bracket({top.name, closing.name} - {""}).finditer(self.text, top.end, closing.start)
        yield from (("+<", (found.start(), found.start(), "<")) for found in islice(near, 3))
        names = [piece.name for piece in self.open]
        inner = self.open if is_end else self.open[: names.index(closing.name)] if closing.name in names else []
        if inner:
            yield "+/", (top.end - 1, top.end, "/>")
            if not top.attributes:
                yield "slash", (top.start, top.end, f"</{top.name}>")
            yield "close", *self._places(tags, closing.start, inner)
            yield "close", self._closed(closing.start, inner)
            yield "drop", self._removed(top)
        if is_end:
            return
        last, every = self.stop.marks[-1].opened, zip(self.stop.pieces, self.stop.marks, strict=True)
        inside = [piece for piece, mark in every if mark.opened is last and piece.form in ("open", "empty")][::-1]
        for piece in [piece for piece in inside if piece.form == "empty" and piece.name == closing.name][:1]:
            yield "begin", self._begun(piece)
        for piece in list(takewhile(lambda piece: piece.name in CHILDREN.get(closing.name, ()), inside))[-1:]:
            yield "open", (piece.start, piece.start, f"<{closing.name}>")
        yield "extra", self._removed(closing)
        if self.open and not inner:
            yield "name", (closing.start, closing.end, f"</{top.name}>")
            yield "tag", self._named(top, closing.name)

    def _places(self, tags: list[Piece], end: int, inner: list[Piece]) -> Iterator[Change]:
        """Yield the closing of what is open before the first tags that may not be in it, as the format or the indentation tells."""
        stack: list[Piece] = []
        for piece in tags:
            places = (at for at in range(len(stack), 0, -1) if self._fits(piece, stack[at - 1]))
            inside = stack[next(places, len(stack)) :] if piece.form != "close" else []
            if inside and all(one in self.open for one in inside):
                yield self._closed(piece.start, inside[::-1])
                del stack[-len(inside) :]
            if piece.form == "open":
                stack.append(piece)
            elif piece.form == "close" and stack:
                stack.pop()
        yield self._closed(end, [piece for piece in inner if piece in stack])

    def _fits(self, piece: Piece, outer: Piece) -> bool:
        """Return whether a tag may be in another one."""
        if self.is_urdf and piece.name in ATTRIBUTES and outer.name in ATTRIBUTES:
            return piece.name in CHILDREN.get(outer.name, ())
        indent = markup.indentation(self.text, piece.start)
        is_first = self.text.startswith("\n", piece.start - len(indent) - 1)
        return not is_first or markup.indentation(self.text, outer.start) < indent

    def _comment(self, piece: Piece) -> Iterator[tuple[str, *tuple[Change, ...]]]:
        """Yield the ends of a comment: what looks like one, or before the next tag; or without -- in it."""
        text, start, end = self.text, piece.start + 4, piece.end if piece.at is not None else piece.end - 3
        limit = text.find("<", start) if text.find("<", start) >= 0 else len(text)
        if piece.at is None and limit > end:
            dashes = re.finditer("--+", text[start:end])
            yield "comment", *((start + dash.start(), start + dash.end(), "-") for dash in dashes)
        if near := _NEAR.search(text, start, min(limit, start + _MAX_LOOKED)):
            yield "comment", (*near.span(), "-->")
        last = len(text[:limit].rstrip())
        yield "comment", (last, last, " -->")

    def _rewritten(self, piece: Piece) -> Iterator[tuple[str, *tuple[Change, ...]]]:
        """Yield the ways to write a malformed tag with the words that it has."""
        end = piece.end + (self.text[piece.end : piece.end + 1] == ">")
        body = self.text[piece.start : end]
        if body[1:2] in tuple(_DASHES):
            yield "comment", (piece.start, end, f"<!-- {body.strip(f'<>{_DASHES} ')} -->")
        plain = _COMMENT.sub("", body)
        head = _HEAD.match(plain)
        if head is None:
            return
        (slash, name), inner = head.groups(), plain[head.end() :]
        rest = inner.rstrip("?\\/> \t\r\n")
        tail = inner[len(rest) :]
        if name.lower() == "xml" and not slash:
            yield "version", (piece.start, end, _XML)
        is_empty = "/" in tail or "\\" in tail
        blank = " " if tail[:1].isspace() and tail.strip() else ""
        values = "".join(f' {key}="{value}"' for key, value in _attributes(name, rest).items())
        forms = (f"<{name}{values}{blank}{'/' * empty}>" for empty in (is_empty, not is_empty))
        for form in [f"</{name}>"] if slash else forms:
            yield _said(body, form), (piece.start, end, form)


def _said(old: str, new: str) -> str:
    """Return the name of a change of a tag, as the characters that change tell."""
    names = re.findall(r"([\w:.-]+)\s*=", old)
    if len(set(names)) < len(names):
        return "twice"
    changed = {"+": Counter(new) - Counter(old), "-": Counter(old) - Counter(new)}
    return next((key for key in _WAYS if changed.get(key[0], {}).keys() & set(key[1:])), "tag")


def _attributes(tag: str, rest: str) -> dict[str, str]:
    """Return the attributes that the text after the name of a tag may stand for: one that is repeated is renamed."""
    known = list(TAGS[tag if tag in TAGS else closest(tag, TAGS) or "geometry"].attributes)
    words = "|".join(map(re.escape, known)) or r"[A-Za-z_][\w:.\-]*"
    key = re.compile(rf"(?<![\w:.\-])([A-Za-z_][\w:.\-]*)?\s*=+\s*|(?<!\S)({words})\s*:?\s*(?=[{_QUOTES}])")
    spans = [(found[1] or found[2] or "", found.start(), found.end()) for found in key.finditer(rest)] or [("", 0, 0)]
    ends = [*(start for _, start, _ in spans[1:]), len(rest)]
    pairs = [(name, _value(rest[start:end])) for (name, _, start), end in zip(spans, ends, strict=True)]
    free = [name for name in known if name not in [name for name, _ in pairs]]
    named: dict[str, str] = {}
    for name, value in pairs if rest.strip() else ():
        named[name if name and name not in named else free.pop(0) if free else name or "name"] = value
    return named


def _value(text: str) -> str:
    """Return a value without quotes, and without what is after its second quote."""
    begun = text.strip(" \t\r\n,;")
    return re.split(f"[{_QUOTES}]", begun.lstrip(_QUOTES))[0].strip()
