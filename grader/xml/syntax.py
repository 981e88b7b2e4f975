"""A generic search for edits after which a broken XML text can be read: each brings the parser further.

The edits are few operations near the place where the parser stops: write a malformed tag as its words tell, insert or remove one
character, close, rename or remove a tag, end a comment. The format of a URDF, where it is known, orders them.
"""

import re
from collections import Counter
from collections.abc import Iterator
from itertools import islice
from typing import NamedTuple

from grader import markup
from grader.edits import Proposal, composed, edited
from grader.names import closest
from grader.source import Edit, Source
from grader.xml.pieces import ENDS, Open, Piece, Rules, Scan, scan
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN, TAGS

_MAX_ERRORS = 40  # of one text
_MAX_TRIES = 400  # at one error
_MAX_WAYS = 4  # at one error that grading decides among
_MAX_FOUND = 8
_MAX_READ = 3_000_000  # characters
_WINDOW = 400  # characters after an error that must be read
_QUOTES = "\"'\u201c\u201d\u201e\u2018\u2019\u201a\u00ab\u00bb\u2033\u2032\u00b4`"
_COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
_HEAD = re.compile(r"[<\s]*([\\/]?)\s*([A-Za-z_][\w.:\-]*)(.*?)([\s?\\/>]*)\Z", re.DOTALL)
_DASHES = re.compile(r"<[-\u2013\u2014!]+(.*?)[-\u2013\u2014]*>", re.DOTALL)
_PLACE = re.compile(r"\b|(?<=\W)(?=\W)")
_XML = '<?xml version="1.0"?>'
_XACRO = ' xmlns:xacro="http://www.ros.org/wiki/xacro"'
# What is wrong with a tag, and what to do: by the characters that are added (+) or removed (-).
_BY_CHARACTER = (
    ("-\\", "a backslash in a tag", "replace the backslash with /"),
    ("-\u201c\u201d\u201e\u2018\u2019\u201a\u00ab\u00bb\u2033\u2032\u00b4`", "typographic quotes", "write straight quotes"),
    ("-,;", "a comma between attributes", "separate the attributes with spaces"),
    ("+>", "a tag without its >", "end the tag with >"),
    ("+<", "the < of a tag is missing", "begin the tag with <"),
    ("+abcdefghijklmnopqrstuvwxyz", "the name of an attribute is missing", "name the attribute"),
    ("+=", "the equals sign is missing", "write = before the value"),
    ("+\"'", "a quote is missing", "add the quote"),
    ("+/", "the / of a tag without content is missing", "end the tag with />"),
    ("-<>/=\"' ", "an extra character in a tag", "remove the character"),
    ("+ ", "the space after the name of a tag is missing", "add the space"),
)  # fmt: skip
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
    "<!--": ("the end of a comment is missing", "write --> at the end of a comment"),
    "comment": ("-- inside a comment", "write - for --"),
    "<?": ("the end of the XML declaration is missing", "write ?> at the end of the XML declaration"),
    "version": ("the XML declaration", f"write {_XML}"),
    "declaration": ("an XML declaration that is not at the top", "remove the XML declaration"),
    "top": ("the place of the XML declaration", "move the XML declaration to the top"),
    "reference": ("an & that is not escaped", "write &amp; for &"),
    "prefix": ("the namespace of xacro is missing", "declare xmlns:xacro"),
    "dashes": ("the start of a comment", "begin the comment with <!--"),
}
_LOSSY = (_WAYS["drop"][1], _WAYS["text"][1])


class Way(NamedTuple):
    """Changes of a text, each from an offset to another one, in order; what is wrong, and what to do."""

    changes: tuple[tuple[int, int, str], ...]
    cause: str
    action: str


def proposals(source: Source, *, is_urdf: bool, is_strict: bool) -> Iterator[Proposal]:
    """Yield edits after which a text can be read, the most plausible ones first; nothing where none brings the parser further."""
    search = _Search(source.path, Rules(is_urdf, is_strict, is_wary=True))
    first = list(search.steps(source.text))
    others = ((index, way) for index, step in reversed(list(enumerate(first))) for way in step.ways[1:])
    if first:
        yield _joined(source, first)
    for index, way in islice(others, _MAX_FOUND):
        step = first[index]
        begun = [*first[:index], step._replace(ways=[way])]
        yield _joined(source, [*begun, *search.steps(_applied(step.text, way))])


class _Step(NamedTuple):
    """A text with an error, and the ways to bring the parser further, the best first."""

    text: str
    ways: list[Way]


def _joined(source: Source, steps: list[_Step]) -> Proposal:
    edits: tuple[Edit, ...] = ()
    for text, ways in steps:
        own = Source(source.path, text)
        edits = composed(source.text, source.path, edits, [own.edit(*change) for change in ways[0].changes])
    causes, actions = (dict.fromkeys(step.ways[0][index] for step in steps) for index in (1, 2))
    return Proposal(edits, " and ".join(map(str, causes)), " and ".join(map(str, actions)))


def _applied(text: str, way: Way) -> str:
    for start, end, new in reversed(way.changes):
        text = text[:start] + new + text[end:]
    return text


class _Search:
    """The search in one text, whose work is bounded."""

    def __init__(self, path: str, rules: Rules) -> None:
        self.path, self.rules, self.left = path, rules, _MAX_READ

    def steps(self, text: str) -> Iterator[_Step]:
        """Yield one step after the other until the text can be read."""
        for _ in range(_MAX_ERRORS):
            ways: list[Way] = []
            for rules in dict.fromkeys((self.rules, self.rules._replace(is_wary=False))):
                self.left -= len(text)
                stop = scan(text, rules)
                ways = self._ways(text, stop, rules) if stop.why and not ways else ways
            if not ways:
                return
            yield _Step(text, ways)
            text = _applied(text, ways[0])

    def _ways(self, text: str, stop: Scan, rules: Rules) -> list[Way]:
        """Return the ways which bring the parser further, the best first."""
        found: list[tuple[tuple[int, bool, int], Way]] = []
        tries = _Ways(text, stop, rules)
        for stage in (tries.likely(), tries.characters()):
            for way in islice(stage, _MAX_TRIES):
                rank = self._rank(text, stop, rules, way)
                if rank is not None and self.left > 0:
                    found.append((rank, way))
            if any(faults == 0 for (_, _, faults), _ in found):
                break
        found.sort(key=lambda pair: pair[0])
        unique = {_applied(text, way): way for _, way in reversed(found)}
        best = list(reversed(unique.values()))
        return best[:_MAX_WAYS] + [way for way in best[_MAX_WAYS:] if way.action in _LOSSY][:1]

    def _rank(self, text: str, stop: Scan, rules: Rules, way: Way) -> tuple[int, bool, int] | None:
        """Return how far the parser comes from its end, with how many faults; None if no further, or what is lost is too much."""
        start = way.changes[0][0]
        mark = next((mark for mark in reversed(stop.marks) if mark.position <= start), None)
        new = _applied(text, way)
        limit = min(stop.at + _WINDOW + max(len(new) - len(text), 0), len(new) + 1)
        after = scan(new, rules, mark, limit)
        self.left -= limit - (mark.position if mark else 0)
        rest = len(new) - after.at
        if rest >= len(text) - stop.at:
            return None
        return rest if after.at < limit else -1, way.action in _LOSSY, after.faults


class _Ways:
    """The operations at one error."""

    def __init__(self, text: str, stop: Scan, rules: Rules) -> None:
        self.text, self.stop, self.rules = text, stop, rules
        self.newline = "\r\n" if "\r\n" in text else "\n"
        self.open: list[Piece] = []
        opened = stop.opened
        while opened is not None:
            self.open.append(opened.piece)
            opened = opened.outer

    def likely(self) -> Iterator[Way]:
        """Yield what is usual for the error."""
        wrong, text, why = self.stop.wrong, self.text, self.stop.why
        if why == "end":
            yield from self._unclosed(len(text.rstrip()), None)
        elif wrong is None:
            return
        elif why == "tag":
            yield from self._rewritten(wrong)
        elif why == "close":
            yield from self._unclosed(wrong.start, wrong)
        elif why in ENDS or why == "comment":
            yield from self._ended(wrong)
        elif why == "bracket":
            yield self._way("bracket", (wrong.start, wrong.start, "<"))
        elif why == "reference":
            yield self._way("reference", (wrong.start, wrong.start + 1, "&amp;"))
        elif why == "version":
            yield self._way("version", (wrong.start, text.index(">", wrong.start) + 1, _XML))
        elif why == "prefix":
            root = next(piece for piece in self.stop.pieces if piece.form != "other")
            end = markup.name_end(text, root.start)
            yield self._way("prefix", (end, end, _XACRO))
        elif why == "declaration":
            yield self._way("declaration", (wrong.start, self._after(wrong), ""))
            start = int(text.startswith("\ufeff"))
            body = text[wrong.start : wrong.end] + self.newline
            if not text[start : wrong.start].strip().startswith("<?"):
                yield self._way("text", (start, wrong.start, ""))
                yield self._way("top", (start, start, body), (wrong.start, self._after(wrong), ""))
        elif why == "root":
            end = len(text.rstrip())
            name_end = markup.name_end(text, wrong.start)
            last = text.rfind(f"</{wrong.name}", 0)
            renamed = (name_end - len(wrong.name), name_end, "robot")
            if wrong.name not in ATTRIBUTES:
                yield self._way(
                    "tag", renamed, *([(last + 2, last + 2 + len(wrong.name), "robot")] if last > wrong.start else [])
                )
                yield self._way("tag", renamed)
            yield self._way(
                "open",
                (wrong.start, wrong.start, f"<robot>{self.newline}"),
                *([] if "</robot" in text else [(end, end, f"{self.newline}</robot>")]),
            )
        elif why in ("second", "text"):
            yield from self._after_root(wrong)

    def characters(self) -> Iterator[Way]:
        """Yield the insertion or deletion of one character near the error, and the removal of what is wrong."""
        wrong = self.stop.wrong
        if wrong is None or wrong.form == "other":
            return
        start = self.stop.marks[-1].position if wrong.form == "close" and self.stop.marks else wrong.start
        end = min(wrong.end + 1, start + 300)
        for place in _PLACE.finditer(self.text, start, end):
            for new in ("<",) if wrong.form == "close" else ('"', ">", "/>", "<", "=", "/", "'", " "):
                yield self._by_character(place.start(), place.start(), new)
        for at in range(start, end):
            if not self.text[at : at + 1].isalnum():
                yield self._by_character(at, at + 1, "")
        yield self._way("text", (wrong.start, wrong.end, ""))

    def _by_character(self, start: int, end: int, new: str) -> Way:
        return Way(((start, end, new),), *_said(self.text[start:end], new))

    def _way(self, name: str, *changes: tuple[int, int, str]) -> Way:
        return Way(tuple(sorted(changes)), *_WAYS[name])

    def _after(self, piece: Piece) -> int:
        """Return the offset after a piece and the end of its line."""
        found = re.compile(r"\r?\n").match(self.text, piece.end)
        return found.end() if found else piece.end

    def _removed(self, piece: Piece) -> tuple[int, int, str]:
        """Return the removal of a tag, with its line where nothing else is on it."""
        start = piece.start - len(markup.indentation(self.text, piece.start))
        is_alone = self.text[start - 1 : start] in ("", "\n") and self._after(piece) > piece.end
        return (start, self._after(piece), "") if is_alone else (piece.start, piece.end, "")

    def _closed(self, offset: int, *opened: Piece) -> tuple[int, int, str]:
        """Return the closing of tags after what is before an offset."""
        end = len(self.text[:offset].rstrip())
        new = ""
        for piece in opened:
            is_one_line = "\n" not in self.text[piece.start : end]
            new += "" if is_one_line else self.newline + markup.indentation(self.text, piece.start)
            new += f"</{piece.name}>"
        return end, end, new

    def _self_closed(self, piece: Piece) -> tuple[int, int, str]:
        blank = " " if self.text.count('" />') >= max(self.text.count('"/>'), 1) else ""
        return piece.end - 1, piece.end, f"{blank}/>"

    def _unclosed(self, end: int, closing: Piece | None) -> Iterator[Way]:
        """Yield what may be wrong with a closing tag, or with the tags that are open there."""
        text, pieces = self.text, self.stop.pieces[: -1 if closing else None]
        top, outer = (self.open[0] if self.open else None), [piece.name for piece in self.open[1:]]
        is_outer = closing is None or closing.name in outer
        names = "|".join(re.escape(piece.name) for piece in (top, closing) if piece)
        lost = re.compile(rf"(?<![<\w/\"'=])/?(?:{names})\b(?=[^<>]*>)").finditer(text, top.end if top else 0, end)
        for found in islice(lost, 3):
            yield self._way("bracket", (found.start(), found.start(), "<"))
        if top is not None:
            if closing is not None and not is_outer:
                renamed = self._way("name", (closing.start, closing.end, f"</{top.name}>"))
                start = markup.name_end(text, top.start)
                tag = self._way("tag", (start - len(top.name), start, closing.name))
                if not self.rules.is_urdf or closing.name not in ATTRIBUTES:
                    yield renamed
                if not self.rules.is_urdf or top.name not in ATTRIBUTES:
                    yield tag
            if top.name in ATTRIBUTES and top.name not in CHILDREN and is_outer:
                yield self._way("empty", self._self_closed(top))
            for piece in [piece for piece in self.open[:-1] if not piece.has_attributes][:3]:
                yield self._way("slash", (piece.start, piece.end, f"</{piece.name}>"))
            if is_outer:
                depth = outer.index(closing.name) + 1 if closing else len(self.open)
                yield from self._places(pieces, end, self.open[:depth])
                if closing is None and len(self.open) > 1:
                    yield self._way("end", self._closed(end, *self.open))
                yield self._way("empty", self._self_closed(top))
                yield self._way("drop", self._removed(top))
                for piece in [piece for piece in self.open[:-1] if piece.name in {*outer[self.open.index(piece) :]}][
                    :3
                ]:
                    yield self._way("drop", self._removed(piece))
            else:
                yield from ()
        if closing is None:
            return
        if not is_outer or top is None:
            same = next(
                (piece for piece in reversed(pieces) if piece.form == "empty" and piece.name == closing.name), None
            )
            if same is not None:
                slash = text.rindex("/", same.start, same.end)
                yield self._way("begin", (len(text[:slash].rstrip()), same.end, ">"))
            before = next(
                (piece for piece in reversed(pieces) if piece.form == "close" and piece.name == closing.name), None
            )
            if top is None and before is not None:
                yield self._way("early", self._removed(before))
            allowed = CHILDREN.get(closing.name, ())
            inner = [piece for piece in pieces if not top or piece.start >= top.end]
            below = _descendants(closing.name)
            after = [p for p in inner if p.form == "other" or p.name not in below]
            first = next((p for p in inner if p.name in allowed and (not after or p.start > after[-1].start)), None)
            if first is not None:
                yield self._way("open", (first.start, first.start, f"<{closing.name}>"))
        if top is not None and not is_outer:
            yield renamed
        yield self._way("extra", self._removed(closing))
        if top is not None and is_outer:
            yield self._way("name", (closing.start, closing.end, f"</{top.name}>"))

    def _places(self, pieces: list[Piece], end: int, inside: list[Piece]) -> Iterator[Way]:
        """Yield where an open tag may be closed: before a tag that may not be in it, at the end of its line, before the end."""
        changes: list[tuple[int, int, str]] = []
        stack: list[Piece] = []
        for piece in pieces if self.rules.is_urdf else ():
            fits = [index for index, one in enumerate(stack) if piece.name in CHILDREN.get(one.name, ())]
            inner = stack[fits[-1] + 1 :] if fits and piece.form in ("open", "empty") else []
            if inner and all(one in self.open for one in inner):
                changes.append(self._closed(piece.start, *reversed(inner)))
                del stack[fits[-1] + 1 :]
            if piece.form == "open":
                stack.append(piece)
            elif piece.form == "close" and stack:
                stack.pop()
        left = [piece for piece in reversed(stack) if piece in inside]
        if changes:
            yield self._way("close", *changes, *([self._closed(end, *left)] if left else []))
        top, *rest = inside
        last = [self._closed(end, *rest)] if rest else []
        indent = len(markup.indentation(self.text, top.start))
        line = re.compile(r"[^<\n]*\S[^<\n]*$", re.MULTILINE).match(self.text, top.end)
        if line:
            yield self._way("close", self._closed(line.end(), top), *last)
        after = (piece for piece in pieces if piece.start > top.end and "\n" in self.text[top.end : piece.start])
        less = next((piece for piece in after if len(markup.indentation(self.text, piece.start)) <= indent), None)
        if less is not None and not self.rules.is_urdf:
            yield self._way("close", self._closed(less.start, top), *last)
        if not last or self.stop.why != "end":
            yield self._way("close", self._closed(end, *inside))

    def _after_root(self, wrong: Piece) -> Iterator[Way]:
        """Yield what may be wrong with something after the root: the root ends early, or this is no part of the robot."""
        text, end = self.text, len(self.text.rstrip())
        tags = [piece for piece in self.stop.pieces if piece.form != "other" and piece is not wrong]
        root, last = tags[0], tags[-1]
        if wrong.form != "text" and root.form == "empty":
            slash = text.rindex("/", root.start, root.end)
            yield self._way("begin", (len(text[:slash].rstrip()), root.end, ">"))
            yield self._way(
                "begin", (len(text[:slash].rstrip()), root.end, ">"), (end, end, f"{self.newline}</{root.name}>")
            )
        elif wrong.form != "text":
            closed = f"{self.newline}</{root.name}>"
            yield self._way("early", self._removed(last))
            yield self._way("early", self._removed(last), (end, end, closed))
        yield self._way("text", (wrong.start, end, ""))

    def _ended(self, piece: Piece) -> Iterator[Way]:
        """Yield the ends of a comment or declaration: what looks like one, the end of its line, before the next tag."""
        text, name = self.text, piece.name
        limit = text.find("<", piece.start + len(name))
        limit = limit if limit >= 0 else len(text)
        if dashes := [match.span() for match in re.finditer("--+", text[piece.start + 4 : piece.end - 3])]:
            if piece.error is None and "<!--" not in text[piece.start + 4 : piece.end]:
                at = piece.start + 4
                yield self._way("comment", *((at + start, at + end, "-") for start, end in dashes))
        near = r"[-\u2013\u2014]+\s*!?\s*>|[-\u2013\u2014]{2,}(?=\s*\n)" if name == "<!--" else r"\s*[/?]?>"
        said = name if name in _WAYS else "<!--"
        found = re.compile(near).search(text, piece.start + len(name), limit)
        if found:
            yield self._way(said, (*found.span(), ENDS[name]))
        line = text.find("\n", piece.start, limit)
        for end in dict.fromkeys(len(text[:at].rstrip()) for at in (line if line >= 0 else limit, limit)):
            yield self._way(said, (end, end, f" {ENDS[name]}" if name == "<!--" else ENDS[name]))

    def _rewritten(self, piece: Piece) -> Iterator[Way]:
        """Yield the ways to write a malformed tag with the words that it has."""
        text = self.text
        end = piece.end + (text[piece.end : piece.end + 1] == ">")
        body = text[piece.start : end]
        plain = _COMMENT.sub("", body)
        head = _HEAD.match(plain)
        if dashes := _DASHES.fullmatch(body):
            yield self._way("dashes", (piece.start, end, f"<!-- {dashes[1].strip()} -->"))
        if head is None:
            return
        name, rest, tail = head[2], head[3], head[4]
        if name.lower() == "xml" and not head[1]:
            yield self._way("version", (piece.start, end, _XML))
        forms = [f"</{name}>"] if head[1] else []
        is_empty = bool({"/", "\\"} & set(tail)) or (
            not body.endswith(">") and name in ATTRIBUTES and name not in CHILDREN
        )
        blank = " " if tail[:1] in (" ", "\t") else ""
        quote = "'" if text.count("='") > text.count('="') else '"'
        for attributes in () if head[1] else _attributes(name, rest):
            values = "".join(f" {key}={quote}{value}{quote}" for key, value in attributes)
            forms += [f"<{name}{values}{blank}{'/' * empty}>" for empty in (is_empty, not is_empty)]
        for form in forms:
            said = (
                ("a duplicate attribute", "rename or remove one of the two attributes") if False else _said(body, form)
            )
            yield Way(
                ((piece.start, end, form),),
                *(("a comment inside a tag", "remove the comment from the tag") if plain != body else said),
            )


def _descendants(tag: str) -> set[str]:
    children = CHILDREN.get(tag, ())
    return set(children).union(*map(_descendants, children))


def _said(old: str, new: str) -> tuple[str, str]:
    """Return what was wrong with a text, and what to do, as the characters that change tell."""
    added, removed = Counter(new) - Counter(old), Counter(old) - Counter(new)
    for characters, cause, action in _BY_CHARACTER:
        if any(character in (added if characters[0] == "+" else removed) for character in characters[1:]):
            return cause, action
    return "a malformed tag", "correct the tag"


def _attributes(tag: str, rest: str) -> Iterator[list[tuple[str, str]]]:
    """Yield the attributes that the text after the name of a tag may stand for."""
    name = tag if tag in TAGS else closest(tag, TAGS) or ""
    known = list(TAGS[name].attributes) if name else []
    words = "|".join(map(re.escape, known)) or r"[A-Za-z_][\w:.\-]*"
    key = re.compile(
        rf"(?<![\w:.\-])([A-Za-z_][\w:.\-]*)?\s*=+\s*|(?<![\w:.\-{_QUOTES}])({words})\s*:?\s*(?=[{_QUOTES}])"
    )
    keys = list(key.finditer(rest)) or list(re.finditer(rf"\b({words})()\s+", rest) if known else ())
    spans = [(found[1] or found[2] or "", found.start(), found.end()) for found in keys] or [("", 0, 0)]
    ends = [*(start for _, start, _ in spans[1:]), len(rest)]
    pairs = [(key, _value(rest[start:end])) for (key, _, start), end in zip(spans, ends, strict=True)]
    pairs = pairs if keys or pairs[0][1] else []
    given = [name for name, _ in pairs]
    renamed: list[tuple[str, str]] = []
    for name, value in pairs:
        free = [other for other in known if other not in given and other not in dict(renamed)]
        is_free = name and name not in dict(renamed)
        renamed.append((name if is_free else free[0] if free else name or "name", value))
    yield from ([*dict(found).items()] for found in (renamed, list(reversed(renamed))))


def _value(text: str) -> str:
    """Return a value without quotes, and without what is after its second quote."""
    begun = text.strip(" \t\r\n,;")
    value = begun.lstrip(_QUOTES)
    return re.split(f"[{_QUOTES}]", value)[0].strip() if value != begun or re.search(f"[{_QUOTES}]", value) else value
