"""Edits that make a broken XML text readable: a search over few operations near the place where the parser stops."""

import re
from collections.abc import Iterator
from heapq import nsmallest
from itertools import islice, product
from typing import NamedTuple

from grader import markup
from grader.edits import Proposal, composed
from grader.source import Edit, Source
from grader.xml.pieces import ParserMark, PieceScan, Rules, TextPiece, scan
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN

_MAX_ERRORS = 40  # of one text
_MAX_TRIES = 600  # at one error, of each kind
_MAX_WAYS = 4  # at one error that grading decides among
_MAX_FOUND = 8
_MAX_READ = 3_000_000  # characters
_MAX_NEAR = 20  # tags before an error
_WINDOW = 400  # characters after an error that must be read
_XML = '<?xml version="1.0"?>'
# What is wrong, and what to do: where characters are added, a tag gets another form (from, to), or something else is
# done.
_WAYS = {
    '"': ("a quote is missing", "add the quote"),
    ">": ("a tag without its >", "end the tag with >"),
    "/>": ("the / of a tag without content is missing", "end the tag with />"),
    "<": ("the < of a tag is missing", "begin the tag with <"),
    "=": ("the equals sign is missing", "write = before the value"),
    " ": ("a space in a tag is missing", "add the space"),
    "name": ("the name of an attribute is missing", "name the attribute"),
    "less": ("an extra character in a tag", "remove the character"),
    "twice": ("a duplicate attribute", "rename or remove one of the two attributes"),
    "open empty": ("the / of a tag without content is missing", "end the tag with />"),
    "open close": ("the / of a closing tag is missing", "add the /"),
    "open open": ("the name of a tag", "correct the name of the tag"),
    "open ": ("a tag that is not closed", "remove the tag"),
    "empty open": ("the / of a tag with content is too much", "remove the /"),
    "close close": ("the name of a closing tag", "correct the closing tag"),
    "close ": ("an extra closing tag", "remove the closing tag"),
    "close": ("a closing tag is missing", "add the closing tag"),
    "open": ("a tag is missing", "add the tag"),
    "text": ("text that is no XML", "remove the text"),
    "reference": ("an & that is not escaped", "write &amp; for &"),
    "misplaced": ("an XML declaration that is not at the top", "remove the XML declaration"),
    "comment": ("a malformed comment", "write the comment as <!-- ... -->"),
    "version": ("a malformed XML declaration", f"write {_XML}"),
    "inside": ("a comment inside a tag", "remove the comment from the tag"),
    "curly": ("typographic quotes", "write straight quotes"),
    "backslash": ("a backslash in a tag", "replace the backslash with /"),
    "comma": ("a comma between attributes", "separate the attributes with spaces"),
}
# What is replaced by what in a malformed tag: <- base --> for "comment", <link name=base> and <link name="base> for the
# double quote, <link name: "base"> for "=".
_IN_TAG = {
    "comment": (r"\A<[!\-\u2013\u2014\s]+(.*?)[!\-\u2013\u2014\s]*>?\Z", r"<!-- \1 -->"),
    "version": (r"\A<[\s?]*xml\b.*", _XML),
    "inside": (r"<!--.*?-->\s*", ""),
    "curly": ("[\u201c\u201d\u201e\u2018\u2019\u201a\u00ab\u00bb\u2033\u2032\u00b4`]", '"'),
    "backslash": (r"\\", "/"),
    "comma": (r"(?<=[\"'\w])\s*[,;](?=\s)", ""),
    '"': (r"=\s*[\"']?([^\"'<>=\s][^\"'<>=]*?)[\"']?(?=\s+[\w:.-]+\s*=|\s*/?\s*>?\Z)", r'="\1"'),
    "=": (r"(?<=\w)\s*:\s*(?=[\"'])", "="),
    ">": (r"(?<!>)\Z", ">"),
}

Change = tuple[int, int, str]
Operation = tuple[str, *tuple[Change, ...]]


class Way(NamedTuple):
    """What is wrong, the changes of a text that correct it, each from offset to offset, and the text after them."""

    name: str
    changes: list[Change]
    after: str


def proposals(source: Source, *, is_urdf: bool, is_strict: bool) -> Iterator[Proposal]:
    """Yield edits that make a text readable, the most plausible first; none where none brings the parser further."""
    search = _SyntaxSearch(Rules(is_strict, is_urdf))
    first = list(search.steps(source.text))
    if first:
        yield _joined(source, [ways[0] for ways in first])
    others = ((index, way) for index in reversed(range(len(first))) for way in first[index][1:])
    for number, (index, way) in enumerate(islice(others, _MAX_FOUND), start=1):
        rest = [ways[0] for ways in search.steps(way.after)]
        yield _joined(source, [*(ways[0] for ways in first[:index]), way, *rest])._replace(way=number)


def _joined(source: Source, ways: list[Way]) -> Proposal:
    edits: tuple[Edit, ...] = ()
    text = source.text
    for way in ways:
        own = Source(source.path, text)
        edits = composed(source.text, source.path, edits, [own.edit(*change) for change in way.changes])
        text = way.after
    causes, actions = zip(*dict.fromkeys(_WAYS[way.name] for way in ways), strict=True)
    return Proposal(edits, " and ".join(causes), " and ".join(dict.fromkeys(actions)))


class _SyntaxSearch:
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
        found: list[tuple[tuple[int, int], Way]] = []
        operations = _Operations(text, stop, stop.wrong, self.rules.is_urdf) if stop.wrong else None
        for stage in (operations.likely(), operations.characters()) if operations else ():
            found = nsmallest(4 * _MAX_WAYS, [*found, *self._ranked(text, stop, stage)], key=lambda pair: pair[0])
            if found and not found[0][0][1]:
                break
        return list({way.after: way for _, way in reversed(found)}.values())[::-1][:_MAX_WAYS]

    def _ranked(
        self, text: str, stop: PieceScan, operations: Iterator[Operation]
    ) -> Iterator[tuple[tuple[int, int], Way]]:
        """Yield the ways that bring the parser further, with their distance to the end and the faults for urdfdom."""
        for name, *changes in islice(operations, _MAX_TRIES):
            after = text
            for start, end, new in reversed(changes):
                after = after[:start] + new + after[end:]
            mark = next(
                (mark for mark in reversed(stop.marks) if changes and mark.position <= changes[0][0]), ParserMark()
            )
            limit = min(stop.at + _WINDOW + max(len(after) - len(text), 0), len(after) + 1)
            self.left -= limit - mark.position
            if self.left < 0:
                return
            then = scan(after, self.rules, mark, limit)
            if after != text and len(after) - then.at < len(text) - stop.at:
                yield (len(after) - then.at if then.at < limit else -1, then.faults), Way(name, changes, after)


class _Operations:
    """The operations at one error: each a name and changes."""

    def __init__(self, text: str, stop: PieceScan, wrong: TextPiece, is_urdf: bool) -> None:
        self.text, self.wrong, self.is_urdf = text, wrong, is_urdf
        self.body = text[wrong.start : wrong.end]
        self.tags = [mark.piece for mark in stop.marks if mark.piece and mark.piece.form != "other"]
        self.open = stop.marks[-1].opened[::-1]
        self.line = "\r\n" if "\r\n" in text else "\n"

    def likely(self) -> Iterator[Operation]:
        """Yield what is usual for the error."""
        start, end = self.wrong.start, min(self.wrong.end, len(self.text.rstrip()))
        if self.wrong.form == "text":
            yield "<", (start, start, "<")
            yield "reference", (start, start + self.body.startswith("&"), "&amp;")
            yield "text", (start, end, "")
        elif self.wrong.name == "<?":
            yield "version", (start, self.text.find(">", start) + 1 or end, _XML)
            yield "misplaced", (start, end, "")
        elif self.wrong.form == "other":
            yield from self._comment(start + len(self.wrong.name))
        elif self.wrong.at is None:
            yield from self._tags()
        else:
            name, body = "", self.body
            for key, (pattern, new) in _IN_TAG.items():
                after = re.sub(pattern, new, body, flags=re.DOTALL)
                name, body = name or key * (after != body), after
                yield name or key, (start, self.wrong.end, body)

    def characters(self) -> Iterator[Operation]:
        """Yield the tag at the error with one character or the name of an attribute more, less or changed."""
        start, end, body = self.wrong.start, self.wrong.end, self.body
        if self.wrong.form in ("open", "close", "empty"):
            yield from ((name, (start, end, body[:at] + new + body[to:])) for name, at, to, new in self._in_tag(body))

    def _in_tag(self, body: str) -> Iterator[tuple[str, int, int, str]]:
        words = list(re.finditer(r"[\w:.-]+(?=\s*(=?))", body))
        free = sorted(ATTRIBUTES.get(words[0][0] if words else "", frozenset()) - {word[0] for word in words})
        for word, name in product(words[:0:-1], free):
            yield "twice" if word[1] else "name", *word.span(), name if word[1] else f'{name}="{word[0]}"'
        for at, old in enumerate(body):
            is_name = not self.is_urdf or body[1:at] in ATTRIBUTES or " " in body[:at]  # before a space that is added
            is_split = old.isalnum() and body[at - 1].isalnum()
            for new in " " * is_name if is_split else list(_WAYS)[:6]:
                if ">" not in new or "=" not in body[at:]:
                    yield new, at, at, new
            if not old.isalnum() and not (old == "<" and body[at + 1 : at + 2].isalpha()):
                yield "less", at, at + 1, ""
            for name in free if old in "=\"'" else ():
                yield from (("name", at, at, new) for new in (name, f" {name}", f"{name}="))

    def _tag(self, piece: TextPiece, form: str, name: str = "") -> Operation:
        """Return a tag in another form, without one removed, or with another name."""
        end = markup.name_end(self.text, piece.start)
        head = f"<{name or piece.name}{self.text[end : piece.end].rstrip('/> ')}"
        new = {"open": f"{head}>", "empty": f"{head}/>", "close": f"</{name or piece.name}>", "": ""}[form]
        return f"{piece.form} {form}", (piece.start, piece.end, new)

    def _tags(self) -> Iterator[Operation]:
        """Yield what may be wrong with the tags that are open at an error, the tag there, or those before it."""
        wrong, tags = self.wrong, self.tags
        for top in self.open[:1]:
            yield self._tag(top, "empty")
            if not top.attributes:
                yield self._tag(top, "close")
            yield "close", *self._closings()
            yield self._tag(top, "")
        if wrong.form == "close":
            yield self._tag(wrong, "")
            like = [piece for piece in tags if piece.name == wrong.name and piece.form == "empty"]
            yield from (self._tag(piece, "open") for piece in like[-1:])
            near = (piece.start for piece in tags[:-_MAX_NEAR:-1] if piece.form != "close")
            yield from (("open", (start, start, f"<{wrong.name}>")) for start in near)
            for top in self.open[:1]:
                yield self._tag(wrong, "close", top.name)
                yield self._tag(top, "open", wrong.name)
        elif tags and not self.open:
            last = [piece for piece in tags if piece.form != "open"][-1]
            yield self._tag(last, "open" if last.form == "empty" else "")
        elif wrong.form != "end":
            yield self._tag(wrong, "open", "robot")
            yield "open", (wrong.start, wrong.start, f"<robot>{self.line}")

    def _closings(self) -> Iterator[Change]:
        """Yield the closing of tags before the first tags that may not be in them, and of those in the closed one."""
        places: dict[int, list[TextPiece]] = {}
        names = [piece.name for piece in self.open]
        inner = self.open[: names.index(self.wrong.name) if self.wrong.name in names else None]
        at = end = self.wrong.start
        for piece in reversed(self.open):
            at = at if piece.start < at else end
            at = next(
                (tag.start for tag in self.tags if piece.end <= tag.start < at and not self._fits(tag, piece)), at
            )
            if at < end or piece in inner:
                places.setdefault(at, []).insert(0, piece)
        for at, pieces in sorted(places.items()):
            end, new = len(self.text[:at].rstrip()), ""
            for piece in pieces:
                is_line = "\n" in self.text[piece.start : end]
                new += f"{self.line}{markup.indentation(self.text, piece.start)}" * is_line + f"</{piece.name}>"
            yield end, end, new

    def _fits(self, piece: TextPiece, outer: TextPiece) -> bool:
        """Return whether a tag may be in another one, as the format or the indentation tells."""
        if piece.form == "close" or outer is self.open[-1]:
            return True
        if self.is_urdf and {piece.name, outer.name} <= ATTRIBUTES.keys():
            return _is_below(piece.name, outer.name)
        indent = markup.indentation(self.text, piece.start)
        is_first = self.text.startswith("\n", piece.start - len(indent) - 1)
        return not is_first or markup.indentation(self.text, outer.start) < indent

    def _comment(self, start: int) -> Iterator[Operation]:
        """Yield a comment without -- in it, and its end before the next tag."""
        dashes = islice(re.finditer("--+", self.text[start : self.wrong.end - 3]), _MAX_NEAR)
        yield "comment", *((start + dash.start(), start + dash.end(), "-") for dash in dashes)
        inside = self.text[start:].partition("<")[0].rstrip()
        last = len(inside.rstrip("-\u2013\u2014!> \t\r\n"))
        yield "comment", (start + last, start + len(inside), " -->")


def _is_below(name: str, outer: str) -> bool:
    return any(name == child or _is_below(name, child) for child in CHILDREN.get(outer, ()))
