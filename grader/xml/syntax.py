"""Edits after which a broken XML text can be read: a search over few operations near the place where the parser stops."""

import re
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

from grader import markup
from grader.edits import Proposal, composed
from grader.names import closest
from grader.source import Edit, Source
from grader.xml.pieces import Mark, Piece, Rules, Scan, scan
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, TAGS

_MAX_ERRORS = 40  # of one text
_MAX_TRIES = 400  # at one error
_MAX_WAYS = 4  # at one error that grading decides among
_MAX_FOUND = 8
_MAX_READ = 3_000_000  # characters
_MAX_LOOKED = 2_000  # characters of a line or comment
_WINDOW = 400  # characters after an error that must be read
_CURLY = "\u201c\u201d\u201e\u2018\u2019\u201a\u00ab\u00bb\u2033\u2032\u00b4`"
_QUOTES = f"\"'{_CURLY}"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_HEAD = re.compile(r"[<\s]*([\\/]?)\s*([A-Za-z_][\w.:\-]*)")
_DASHES = "-\u2013\u2014!"
_NEAR = re.compile(r"[-\u2013\u2014]+[\s!]*>|[-\u2013\u2014]{2,}(?=\s*\n)")  # the end of a comment
_XML = '<?xml version="1.0"?>'
# What is wrong with a tag, and what to do: by the characters that are removed (-) or added (+).
_SAID = (
    ("-\\", "a backslash in a tag", "replace the backslash with /"),
    (f"-{_CURLY}", "typographic quotes", "write straight quotes"),
    ("-,;", "a comma between attributes", "separate the attributes with spaces"),
    ("-!", "a comment inside a tag", "remove the comment from the tag"),
    ("+>", "a tag without its >", "end the tag with >"),
    ("+<", "the < of a tag is missing", "begin the tag with <"),
    ("+abcdefghijklmnopqrstuvwxyz", "the name of an attribute is missing", "name the attribute"),
    ("+=", "the equals sign is missing", "write = before the value"),
    ("+\"'", "a quote is missing", "add the quote"),
    ("+/", "the / of a tag without content is missing", "end the tag with />"),
    ("-<>/=\"' ", "an extra character in a tag", "remove the character"),
    ("+ ", "a space in a tag is missing", "add the space"),
    ("", "a malformed tag", "correct the tag"),
)
_WAYS = {
    "close": ("a closing tag is missing", "add the closing tag"),
    "open": ("a tag is missing", "add the tag"),
    "empty": ("the / of a tag without content is missing", "end the tag with />"),
    "begin": ("the / of a tag with content is too much", "remove the /"),
    "slash": ("the / of a closing tag is missing", "add the /"),
    "extra": ("an extra closing tag", "remove the closing tag"),
    "name": ("the name of a closing tag", "correct the closing tag"),
    "tag": ("the name of a tag", "correct the name of the tag"),
    "drop": ("a tag that is not closed", "remove the tag"),
    "end": ("the file is truncated", "close all open tags"),
    "early": ("a closing tag before the end of its element", "move the closing tag to the end"),
    "bracket": ("the < of a tag is missing", "begin the tag with <"),
    "text": ("text that is no XML", "remove the text"),
    "comment": ("a malformed comment", "write the comment as <!-- ... -->"),
    "version": ("a malformed XML declaration", f"write {_XML}"),
    "misplaced": ("an XML declaration that is not at the top", "remove the XML declaration"),
    "reference": ("an & that is not escaped", "write &amp; for &"),
    "prefix": ("the namespace of xacro is missing", "declare xmlns:xacro"),
}

Change = tuple[int, int, str]


class Way(NamedTuple):
    """Changes of a text, each from an offset to another one; what is wrong, and what to do."""

    changes: list[Change]
    cause: str
    action: str

    def applied(self, text: str) -> str:
        """Return the text after the changes."""
        for start, end, new in reversed(self.changes):
            text = text[:start] + new + text[end:]
        return text


def proposals(source: Source, *, is_urdf: bool, is_strict: bool) -> Iterator[Proposal]:
    """Yield edits after which a text can be read, the most plausible first; nothing where none brings the parser further."""
    search = _Search(Rules(is_strict, is_urdf))
    first = list(search.steps(source.text))
    if first:
        yield _joined(source, first)
    others = ((index, way) for index in reversed(range(len(first))) for way in first[index][1][1:])
    for index, way in islice(others, _MAX_FOUND):
        text = first[index][0]
        yield _joined(source, [*first[:index], (text, [way]), *search.steps(way.applied(text))])


def _joined(source: Source, steps: list[tuple[str, list[Way]]]) -> Proposal:
    edits: tuple[Edit, ...] = ()
    for text, (way, *_) in steps:
        own = Source(source.path, text)
        edits = composed(source.text, source.path, edits, [own.edit(*change) for change in way.changes])
    causes, actions = (dict.fromkeys(ways[0][index] for _, ways in steps) for index in (1, 2))
    return Proposal(edits, " and ".join(map(str, causes)), " and ".join(map(str, actions)))


class _Search:
    """A search, whose work is bounded."""

    def __init__(self, rules: Rules) -> None:
        self.rules, self.left = rules, _MAX_READ

    def steps(self, text: str) -> Iterator[tuple[str, list[Way]]]:
        """Yield a text with an error and the ways to bring the parser further, the best first, until the text can be read."""
        for _ in range(_MAX_ERRORS if self.left > 0 else 0):
            ways: list[Way] = []
            for rules in dict.fromkeys((self.rules, self.rules._replace(is_urdf=False))):
                self.left -= len(text)
                stop = scan(text, rules)
                ways = ways or (self._ways(text, stop, rules) if stop.why else [])
            if not ways:
                return
            yield text, ways
            text = ways[0].applied(text)

    def _ways(self, text: str, stop: Scan, rules: Rules) -> list[Way]:
        found: list[tuple[tuple[int, bool, int], Way]] = []
        operations = _Operations(text, stop, self.rules.is_urdf)
        for stage in (operations.likely(), operations.characters()):
            for way in islice(stage, _MAX_TRIES):
                rank = self._rank(text, stop, rules, way) if self.left > 0 and way.changes else None
                found += [(rank, way)] if rank is not None else []
            if any(not faults for (_, _, faults), _ in found):
                break
        best = [way for _, way in sorted(found, key=lambda pair: pair[0])]
        unique = list({way.applied(text): way for way in best[3 * _MAX_WAYS :: -1]}.values())[: -_MAX_WAYS - 1 : -1]
        return unique + [way for way in best if _is_lossy(way) and way not in unique][:1]

    def _rank(self, text: str, stop: Scan, rules: Rules, way: Way) -> tuple[int, bool, int] | None:
        """Return how far the parser is from the end, whether text is lost, and the faults for urdfdom; None if no further."""
        new = way.applied(text)
        mark = next((mark for mark in reversed(stop.marks) if mark.position <= way.changes[0][0]), Mark())
        limit = min(stop.at + _WINDOW + max(len(new) - len(text), 0), len(new) + 1)
        self.left -= limit - mark.position
        after = scan(new, rules, mark, limit)
        if len(new) - after.at >= len(text) - stop.at:
            return None
        return len(new) - after.at if after.at < limit else -1, _is_lossy(way), after.faults


def _is_lossy(way: Way) -> bool:
    return way[1:] in (_WAYS["drop"], _WAYS["text"])


class _Operations:
    """The operations at one error."""

    def __init__(self, text: str, stop: Scan, is_urdf: bool) -> None:
        self.text, self.stop, self.is_urdf = text, stop, is_urdf
        self.line = "\r\n" if "\r\n" in text else "\n"
        self.open: list[Piece] = []  # the innermost first
        opened = stop.marks[-1].opened
        while opened:
            self.open.append(opened[0])
            opened = opened[1].opened

    def likely(self) -> Iterator[Way]:
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
            yield _way("version", (start, text.find(">", start) + 1 or end, _XML))
        elif why == "bracket":
            yield _way("bracket", (start, start, "<"))
        elif why == "reference":
            yield _way("reference", (start, start + 1, "&amp;"))
        elif why == "prefix":
            at = markup.name_end(text, (tags or [wrong])[0].start)
            yield _way("prefix", (at, at, ' xmlns:xacro="http://www.ros.org/wiki/xacro"'))
        elif why == "misplaced":
            yield _way("misplaced", self._removed(wrong))
            yield _way("text", (int(text.startswith("\ufeff")), start, ""))
        elif why == "root":
            name, last = markup.name_end(text, start), text.rfind(f"</{wrong.name}") + 2
            if wrong.name not in ATTRIBUTES:
                change = (name - len(wrong.name), name, "robot")
                yield _way("tag", change, *([(last, last + len(wrong.name), "robot")] if last > start else []))
            closing = "" if "</robot" in text else f"{self.line}</robot>"
            yield _way("open", (start, start, f"<robot>{self.line}"), (end, end, closing))
        elif why in ("second", "text"):
            if tags and wrong.form != "text":
                early = self._begun(tags[0]) if tags[0].form == "empty" else self._removed(tags[-1])
                yield _way("early", early)
                yield _way("early", early, (end, end, f"{self.line}</{tags[0].name}>"))
            if tags:
                yield _way("text", (start, min(end, wrong.end), ""))

    def characters(self) -> Iterator[Way]:
        """Yield the insertion or deletion of one character near the error, and the removal of what is wrong."""
        wrong, text = self.stop.wrong, self.text
        if wrong.form in ("other", "text"):
            return
        yield _way("text", (wrong.start, wrong.end, ""))
        places = {found.start() for found in re.finditer(r"\b|(?<=\W)(?=\W)", text[wrong.start : wrong.end + 1])}
        for at, old in enumerate(text[wrong.start : wrong.end + 1], wrong.start):
            for new in ('"', ">", "/>", "<", "=", "/", "'", " ") if at - wrong.start in places else " ":
                yield Way([(at, at, new)], *_said("", new))
            if not old.isalnum():
                yield Way([(at, at + 1, "")], *_said(old, ""))

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
        end = len(self.text[:offset].rstrip())
        new = ""
        for piece in opened:
            is_line = "\n" in self.text[piece.start : end]
            new += (
                f"{self.line}{markup.indentation(self.text, piece.start)}</{piece.name}>"
                if is_line
                else f"</{piece.name}>"
            )
        return end, end, new

    def _unclosed(self, tags: list[Piece], closing: Piece) -> Iterator[Way]:
        """Yield what may be wrong with a closing tag or the end of the file, or with the tags that are open there."""
        text, end, names = self.text, len(self.text[: closing.start].rstrip()), [piece.name for piece in self.open]
        is_end, top = closing.form != "close", self.open[0] if self.open else None
        near = "|".join(re.escape(piece.name) for piece in (top, closing) if piece and piece.name)
        lost = re.compile(rf"(?<![<\w/\"'=])/?(?:{near})\b(?=[^<>]{{0,300}}>)").finditer(
            text, top.end if top else 0, end
        )
        yield from (_way("bracket", (found.start(), found.start(), "<")) for found in islice(lost, 3 if near else 0))
        is_outer = is_end or closing.name in names[1:]
        if top and not is_outer:
            yield _way("name", (closing.start, closing.end, f"</{top.name}>"))
        if top and not is_end and (not self.is_urdf or top.name not in ATTRIBUTES):
            name = markup.name_end(text, top.start)
            yield _way("tag", (name - len(top.name), name, closing.name))
        if top and is_outer:
            inner = self.open if is_end else self.open[: names.index(closing.name)]
            line = text[top.end : top.end + _MAX_LOOKED].partition("\n")[0].rstrip()
            blank = " " if text.count('" />') >= max(text.count('"/>'), 1) else ""
            if not line or "<" in line:
                yield _way("empty", (top.end - 1, top.end, f"{blank}/>"))
            for piece in [piece for piece in self.open[:-1] if not piece.has_attributes][:3]:
                yield _way("slash", (piece.start, piece.end, f"</{piece.name}>"))
            yield self._places(tags, end, inner)
            if line and "<" not in line:
                yield _way("close", self._closed(top.end + len(line), inner[:1]), self._closed(end, inner[1:]))
            yield _way("end" if is_end else "close", self._closed(end, inner))
            yield from (_way("drop", self._removed(piece)) for piece in self.open[:3])
        if not is_end:
            inside, below = [piece for piece in tags if not top or piece.start >= top.end], _descendants(closing.name)
            empty = [piece for piece in inside if piece.form == "empty" and piece.name == closing.name]
            yield from (_way("begin", self._begun(piece)) for piece in empty[-1:])
            after = max((piece.start for piece in inside if piece.name not in below), default=-1)
            first = [piece for piece in inside if piece.start > after and piece.name in CHILDREN.get(closing.name, ())]
            yield from (_way("open", (piece.start, piece.start, f"<{closing.name}>")) for piece in first[:1])
            yield _way("extra", self._removed(closing))
            if top and is_outer:
                yield _way("name", (closing.start, closing.end, f"</{top.name}>"))

    def _places(self, tags: list[Piece], end: int, inner: list[Piece]) -> Way:
        """Return the closing of what is open before the first tags that may not be in it, as the format or the indentation tells."""
        changes: list[Change] = []
        stack: list[Piece] = []
        for piece in tags:
            inside = stack[self._around(piece, stack) :] if piece.form != "close" else []
            if inside and all(one in self.open for one in inside):
                changes.append(self._closed(piece.start, inside[::-1]))
                del stack[-len(inside) :]
            if piece.form == "open":
                stack.append(piece)
            elif piece.form == "close" and stack:
                stack.pop()
        return _way("close", *changes, self._closed(end, [piece for piece in inner if piece in stack]))

    def _around(self, piece: Piece, stack: list[Piece]) -> int:
        """Return how many of the open tags a tag may be in."""
        if self.is_urdf:
            places = (at for at in range(len(stack), 0, -1) if piece.name in CHILDREN.get(stack[at - 1].name, ()))
            return next(places, len(stack))
        indent = markup.indentation(self.text, piece.start)
        is_first = self.text.startswith("\n", piece.start - len(indent) - 1)
        return sum(markup.indentation(self.text, one.start) < indent for one in stack) if is_first else len(stack)

    def _comment(self, piece: Piece) -> Iterator[Way]:
        """Yield the ends of a comment: what looks like one, the end of its line, before the next tag; or without -- in it."""
        text, start, end = self.text, piece.start + 4, piece.end if piece.at is not None else piece.end - 3
        limit = text.find("<", start) if text.find("<", start) >= 0 else len(text)
        if piece.at is None and limit > end:
            yield _way(
                "comment",
                *((start + dash.start(), start + dash.end(), "-") for dash in re.finditer("--+", text[start:end])),
            )
        near = _NEAR.search(text, start, min(limit, start + _MAX_LOOKED))
        line = text.find("\n", start, limit)
        ends = [near.span()] if near else []
        ends += [(at, at) for at in (len(text[:stop].rstrip()) for stop in (line, limit) if stop >= 0)]
        yield from (_way("comment", (*span, "-->" if span[0] < span[1] else " -->")) for span in ends)

    def _rewritten(self, piece: Piece) -> Iterator[Way]:
        """Yield the ways to write a malformed tag with the words that it has."""
        end = piece.end + (self.text[piece.end : piece.end + 1] == ">")
        body = self.text[piece.start : end]
        if body[1:2] in tuple(_DASHES):
            yield _way("comment", (piece.start, end, f"<!-- {body.strip(f'<>{_DASHES} ')} -->"))
        plain = _COMMENT.sub("", body)
        head = _HEAD.match(plain)
        if head is None:
            return
        (slash, name), inner = head.groups(), plain[head.end() :]
        rest = inner.rstrip("?\\/> \t\r\n")
        tail = inner[len(rest) :]
        if name.lower() == "xml" and not slash:
            yield _way("version", (piece.start, end, _XML))
        quote = "'" if self.text.count("='") > self.text.count('="') else '"'
        is_empty = (
            "/" in tail or "\\" in tail or (not body.endswith(">") and name in ATTRIBUTES and name not in CHILDREN)
        )
        written = [
            "".join(f" {key}={quote}{value}{quote}" for key, value in pairs.items())
            for pairs in _attributes(name, rest)
        ]
        forms = [
            f"<{name}{values}{' ' if tail[:1].isspace() and tail.strip() else ''}{'/' * empty}>"
            for values in written
            for empty in (is_empty, not is_empty)
        ]
        for form in [f"</{name}>"] if slash else forms:
            yield Way([(piece.start, end, form)], *_said(body, form))


def _way(name: str, *changes: Change) -> Way:
    return Way(
        [change for change in sorted(changes, key=lambda change: change[0]) if change[0] < change[1] or change[2]],
        *_WAYS[name],
    )


def _descendants(tag: str) -> set[str]:
    children = CHILDREN.get(tag, ())
    return set(children).union(*map(_descendants, children))


def _said(old: str, new: str) -> tuple[str, str]:
    """Return what was wrong with a text, and what to do, as the characters that change tell."""
    names = re.findall(r"([\w:.-]+)\s*=", old)
    if len(set(names)) < len(names):
        return "a duplicate attribute", "rename or remove one of the two attributes"
    changed = {"+": Counter(new) - Counter(old), "-": Counter(old) - Counter(new)}
    rows = (row for row in _SAID if not row[0] or any(character in changed[row[0][0]] for character in row[0][1:]))
    return next(rows)[1:]


def _attributes(tag: str, rest: str) -> Iterator[dict[str, str]]:
    """Yield the attributes that the text after the name of a tag may stand for: one that is repeated is renamed, or dropped."""
    known = list(TAGS[tag if tag in TAGS else closest(tag, TAGS) or "geometry"].attributes)
    words = "|".join(map(re.escape, known)) or r"[A-Za-z_][\w:.\-]*"
    key = re.compile(rf"(?<![\w:.\-])([A-Za-z_][\w:.\-]*)?\s*=+\s*|(?<!\S)({words})\s*:?\s*(?=[{_QUOTES}])")
    keys = list(key.finditer(rest)) or list(re.finditer(rf"\b({words})()\s+", rest) if known else ())
    spans = [(found[1] or found[2] or "", found.start(), found.end()) for found in keys] or [("", 0, 0)]
    ends = [*(start for _, start, _ in spans[1:]), len(rest)]
    pairs = [(name, _value(rest[start:end])) for (name, _, start), end in zip(spans, ends, strict=True)]
    free = [name for name in known if name not in [name for name, _ in pairs]]
    named: dict[str, str] = {}
    for name, value in pairs if keys or pairs[0][1] else ():
        named[name if name and name not in named else free.pop(0) if free else name or "name"] = value
    yield named
    if len({name for name, _ in pairs}) < len(pairs):
        yield dict(reversed(pairs))


def _value(text: str) -> str:
    """Return a value without quotes, and without what is after its second quote."""
    begun = text.strip(" \t\r\n,;")
    return re.split(f"[{_QUOTES}]", begun.lstrip(_QUOTES))[0].strip()
