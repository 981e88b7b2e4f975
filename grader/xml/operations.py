"""The operations that may correct a text where a parser stops: insert, remove or rename a tag, quote or bracket."""

import re
from collections.abc import Iterator
from itertools import islice, product

from grader import markup
from grader.xml.pieces import PieceScan, TextPiece
from grader.xml.urdf_format import ATTRIBUTES, CHILDREN

_XML = '<?xml version="1.0"?>'
# What is wrong, and what to do: where characters are added, a tag gets another form (from, to), or something else.
WAYS = {
    '"': ("a quote is missing", "add the quote"),
    ">": ("a tag without its >", "end the tag with >"),
    "/>": ("the / of a tag without content is missing", "end the tag with />"),
    "<": ("the < of a tag is missing", "begin the tag with <"),
    "=": ("the equals sign is missing", "write = before the value"),
    " ": ("a space in a tag is missing", "add the space"),
    "name": ("the name of an attribute is missing", "name the attribute"),
    "value": ("a value without a name", "remove the value"),
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
_MAX_NEAR = 20  # tags before an error
_NAMELESS = re.compile(r"""<[\w:.-]+(\s*=\s*(?:"[^"]*"|'[^']*'))""")  # <origin="0 0 1"/>


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


class Operations:
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
            for new in " " * is_name if is_split else list(WAYS)[:6]:
                if ">" not in new or "=" not in body[at:]:
                    yield new, at, at, new
            if not old.isalnum() and not (old == "<" and body[at + 1 : at + 2].isalpha()):
                yield "less", at, at + 1, ""
            for name in free if old in "=\"'" else ():
                yield from (("name", at, at, new) for new in (name, f" {name}", f"{name}="))
        if value := _NAMELESS.match(body):
            yield "value", *value.span(1), ""

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
        """Yield the closing of tags before the first tags that may not be in them, and in the one that is closed."""
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
