"""The fixes of names that do not agree: where they are used, or where they are defined."""

import re
from bisect import bisect_left
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import cache, cached_property
from os.path import commonprefix

from grader.base.errors import NotDecided
from grader.base.patterns import on_use
from grader.base.problems import Fix, Fixes
from grader.base.source import Edit, Edits, Location, Source
from grader.base.text import quoted
from grader.files.reading import URDF_LIMIT
from grader.ros.package.package import CMAKE, MANIFEST, Package
from grader.ros.python.call_extents import ends_of_calls
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.dependencies import DEPENDENCY_DECLARED
from grader.workspace.rules.names import Correction, Mismatch
from grader.workspace.rules.word_index import Span, WordIndex

_TEXTS = (".py", ".xml", ".yaml", ".yml", ".xacro", ".urdf", ".sdf", ".txt", ".cfg")
_MAX_KEY = 400  # characters from a key to its value
_MAX_ATTRIBUTE = 40  # characters before a text in which its attribute is
_OF_PACKAGE = on_use(r"\b(?:package|pkg)\s*=\s*[\"']$")
_SEPARATED = on_use(r".*[./:]")
_DEPENDENCY = on_use(r"(?m)^(?P<indent>[ \t]*)<(\w*depend)\b[^<>]*>[^<>]*</\2>[ \t]*\n")
_END = on_use(r"(?m)(?P<indent>)^(?=[ \t]*(?:<export|</package)\b)")
# Files in which a name stands several times for one thing.
_WITH_ALL = (f"/{CMAKE}", f"/{MANIFEST}")
_INDEXED_A_PART = 256  # characters of a text that count as one part of the work


class NameFixes:
    """The fixes of what does not agree in a workspace, in the texts of its files."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._calls: dict[str, Mapping[Span, int]] = {}  # the ends of those in each file
        self._index = cache(self._make_index)
        self._index_of_path = cache(self._read_index)

    @cached_property
    def sources(self) -> list[Source]:
        """The texts in which packages write names. Raises NotDecided."""
        return self.read_sources(self._workspace.packages)

    def read_sources(self, packages: Iterable[Package]) -> list[Source]:
        """Return the texts in which some packages write names. Raises NotDecided."""
        sources: list[Source] = []
        for package in packages:
            sources += self._workspace.texts.read_sources(package, _TEXTS)
        return sources

    def of(self, mismatch: Mismatch) -> Fixes:
        """Return the fixes of a mismatch, one for each of its corrections.

        A correction has none if its old name is not written as a whole where it is used or defined.
        """
        if mismatch.corrections:
            return Fixes(lambda: self._fixes(mismatch, self._edits))
        if mismatch.lacked and mismatch.related:
            names = dict.fromkeys(mismatch.names or (mismatch.lacked,))
            elements = [f"<{mismatch.tag}>{name}</{mismatch.tag}>" for name in names]
            mismatch = mismatch.offering("", "\n".join(elements), mismatch.related)
        if mismatch.offered:
            return Fixes(lambda: self._offered(mismatch.offered, is_certain=mismatch.is_certain))
        return mismatch.fixes

    def _offered(self, corrections: Iterable[Correction], *, is_certain: bool) -> Iterator[Fix]:
        """Yield the fixes that a message names."""
        for at, old, new in corrections:
            index = self._index_of_path(at.path)
            edits = tuple(_edits_behind(index.source, at, old, new)) if index else ()
            if edits:
                yield Fix(edits, f"{quoted(old)} is read as {quoted(new)}", is_certain)

    def guesses(self, mismatch: Mismatch) -> list[Fix]:
        """Return the fixes of a mismatch for hints, which try them.

        A name that is made of parts may also be changed in the only place where packages write it.

        Raises:
            NotDecided: Not all texts are read.
        """
        return self._fixes(mismatch, self._guess)

    def _fixes(self, mismatch: Mismatch, edits_of: Callable[[Correction], Edits]) -> list[Fix]:
        is_certain = mismatch.is_certain and len(mismatch.corrections) == 1
        fixes = []
        for correction in mismatch.corrections:
            edits = edits_of(correction)
            if edits:
                assumption = f"{quoted(correction.old)} is read as {quoted(correction.new)}"
                fixes.append(Fix(edits, assumption, is_certain))
        return fixes

    def _edits(self, correction: Correction) -> Edits:
        return self.edits(correction.location, correction.old, correction.new)

    def _guess(self, correction: Correction) -> Edits:
        return self._edits(correction) or self._only_edit(correction)

    def edits(self, at: Location, old: str, new: str) -> Edits:
        """Return the edits that change a name at a place.

        There are none where the name is not written there as a whole.
        """
        index = self._index_of_path(at.path)
        if not index:
            return ()
        for written, wanted in _as_written(old, new):
            spans = self._spans_at(index, at, written)
            if spans:
                return tuple(index.source.edit(*span, wanted) for span in spans)
        return ()

    def place_of_word(self, mismatch: Mismatch) -> Location | None:
        """Return where the wrong word of a mismatch is, inside of the call or element of its place.

        The result is None where it is not written there as a whole, or the place is the word's.
        """
        at = mismatch.location
        words = [mismatch.word]
        words += [each.old for each in mismatch.corrections if each.location == at]
        index = self._index_of_path(at.path) if any(words) else None
        if not index:
            return None
        of_package = mismatch.rule is DEPENDENCY_DECLARED
        for word in filter(None, words):
            span = self._span_inside(index, at, word.strip("/"), of_package=of_package)
            if span is not None:
                start = index.source.at(span[0])
                end = index.source.at(span[1])
                return start._replace(end_line=end.line, end_column=end.column, calls=at.calls)
        return None

    def _span_inside(
        self, index: WordIndex, at: Location, word: str, *, of_package: bool = False
    ) -> Span | None:
        """Return where a word is in the call of Python, or the start tag, at a place.

        A program may be called as its package: `of_package` says which is meant.
        """
        source = index.source
        spans = index.find(word)
        start = source.start_offset(at)
        end = self.end_of_element(source, at, start)
        inside = spans[bisect_left(spans, (start,)) : bisect_left(spans, (end - len(word) + 1,))]
        if not inside or inside[0][0] <= start + 1:
            return None  # the place is that of the word, or of its quote
        texts = [span for span in inside if _is_whole_text(source.text, span)]
        meant = []
        for span in texts:
            before = source.text[max(0, span[0] - _MAX_ATTRIBUTE) : span[0]]
            if (_OF_PACKAGE.search(before) is not None) == of_package:
                meant.append(span)
        return (meant or texts or inside)[0]

    def end_of_element(self, source: Source, at: Location, start: int) -> int:
        """Return where the call of Python or the start tag at a place ends; else the place."""
        if source.text.startswith("<", start):
            return source.text.find(">", start) + 1
        if not at.path.endswith(".py"):
            return start
        if at.path not in self._calls:
            self._calls[at.path] = ends_of_calls(source)
        return self._calls[at.path].get((at.line, at.column), start)

    def _spans_at(self, index: WordIndex, at: Location, word: str) -> list[Span]:
        """Return the occurrences of a word that a place is about."""
        source = index.source
        spans = index.find(word)
        if f"/{at.path}".endswith(_WITH_ALL):
            return spans
        inside = self._span_inside(index, at, word)
        if inside is not None:
            return [inside]
        return _meant(source.text, word, spans, source.start_offset(at))

    def _make_index(self, source: Source) -> WordIndex | None:
        """Return the words of a text; None if the work that they take is spent."""
        try:
            self._workspace.charge(1 + len(source.text) // _INDEXED_A_PART)
        except NotDecided:
            return None
        return WordIndex(source)

    def _read_index(self, path: str) -> WordIndex | None:
        """Return the words of a file; None if it cannot be read."""
        for urdf in self._workspace.urdfs:
            if urdf.path == path:
                return self._make_index(urdf.source)
        data = self._workspace.tree.read(path, URDF_LIMIT)
        if data is not None:
            return self._make_index(Source.decoded(path, data))
        return None

    def _only_edit(self, correction: Correction) -> Edits:
        """Return the edit of a name in the one place where packages write it."""
        old = correction.old.strip("/")
        new = correction.new.strip("/")
        places = []
        for source in self.sources:
            index = self._index(source)
            if not index:
                return ()
            places += [(source, span) for span in index.find(old)]
        if len(places) != 1:
            return ()
        [(source, span)] = places
        return (source.edit(*span, new),)


def _edits_behind(source: Source, at: Location, old: str, new: str) -> Iterator[Edit]:
    """Yield the edit of a text at a place or soon behind it; the first slash may lack there.

    What Python imports is written where it is used, too. Without an old text, new elements are
    added to a package.xml, behind its last dependency if there is one.
    """
    if not old:
        matches = list(_DEPENDENCY.finditer(source.text)) or list(_END.finditer(source.text))
        for last in matches[-1:]:
            rows = (f"{last['indent']}{element}\n" for element in new.split("\n"))
            yield source.edit(last.end(), last.end(), "".join(rows))
        return
    start = source.start_offset(at)
    is_import = source.line(at.line).lstrip().startswith("from ")
    text = source.text if is_import else source.text[: start + _MAX_KEY]
    for written, wanted in ((old, new), (old.lstrip("/"), new.lstrip("/"))):
        word = re.compile(rf"(?<![\w/]){re.escape(written)}(?!\w)")
        matches = list(word.finditer(text, start))
        for match in matches if is_import else matches[:1]:
            yield source.edit(*match.span(), wanted)
        if matches:
            return


def _is_whole_text(text: str, span: Span) -> bool:
    """Return whether a word is all that stands in its quotes."""
    start, end = span
    return start > 0 and text[start - 1] in "\"'" and text[end : end + 1] == text[start - 1]


def _as_written(old: str, new: str) -> Iterator[tuple[str, str]]:
    """Yield two names as they may be written in a text.

    These are the names without the slash that begins them, and without the folders or tables that
    both are in.
    """
    yield old.strip("/"), new.strip("/")
    shared = _SEPARATED.match(commonprefix((old, new)))  # noqa: RUF071  of names, not of paths
    if shared and len(shared[0]) < min(len(old), len(new)):
        yield old[shared.end() :], new[shared.end() :]


def _meant(text: str, name: str, spans: list[Span], at: int) -> list[Span]:
    """Return the occurrence of a name that a place is about.

    This is its key, else the first behind the place, or the last before it.
    """
    key = re.compile(
        rf"{re.escape(name)}[\"']?\s*+:\s*+(?:\{{?\s*+(?:ros__parameters|type)\s*+:\s*+)?"
    )
    first = bisect_left(spans, (at,))
    before = spans[max(0, first - 1) : first]
    after = spans[first : first + 1]
    if before and at - before[0][0] < _MAX_KEY and key.fullmatch(text, before[0][0], at):
        return before
    return after or before
