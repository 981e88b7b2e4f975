"""The fixes of names that do not agree: where they are used, or where they are defined."""

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from functools import cached_property
from os.path import commonprefix

from grader.base.problems import Fix, Fixes
from grader.base.source import Edits, Location, Source
from grader.base.text import quoted
from grader.files.reading import URDF_LIMIT
from grader.ros.package.package import CMAKE, MANIFEST, Package
from grader.ros.python.call_extents import ends_of_calls
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.dependencies import DEPENDENCY_DECLARED
from grader.workspace.rules.names import Correction, Mismatch

_TEXTS = (".py", ".xml", ".yaml", ".yml", ".xacro", ".urdf", ".sdf", ".txt", ".cfg")
_MAX_KEY = 400  # characters from a key to its value
_MAX_ATTRIBUTE = 40  # characters before a text in which its attribute is
_OF_PACKAGE = re.compile(r"\b(?:package|pkg)\s*=\s*[\"']$")
_SEPARATED = re.compile(r".*[./:]")
# Files in which a name stands several times for one thing.
_WITH_ALL = (f"/{CMAKE}", f"/{MANIFEST}")


class NameFixes:
    """The fixes of what does not agree in a workspace, in the texts of its files."""

    def __init__(self, workspace: Workspace) -> None:
        self._workspace = workspace
        self._calls: dict[str, Mapping[tuple[int, int], int]] = {}  # the ends of those in each file

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
        return mismatch.fixes

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
        source = self._source(at.path)
        if source is None:
            return ()
        for written, wanted in _as_written(old, new):
            spans = self._spans_at(source, at, written)
            if spans:
                return tuple(source.edit(*span, wanted) for span in spans)
        return ()

    def place_of_word(self, mismatch: Mismatch) -> Location | None:
        """Return where the wrong word of a mismatch is, inside of the call or element of its place.

        The result is None where it is not written there as a whole, or the place is the word's.
        """
        at, words = mismatch.location, [mismatch.word]
        words += [each.old for each in mismatch.corrections if each.location == at]
        source = self._source(at.path) if any(words) else None
        if source is None:
            return None
        of_package = mismatch.rule is DEPENDENCY_DECLARED
        for word in filter(None, words):
            span = self._span_inside(source, at, word.strip("/"), of_package=of_package)
            if span is not None:
                start, end = source.at(span[0]), source.at(span[1])
                return start._replace(end_line=end.line, end_column=end.column, calls=at.calls)
        return None

    def _span_inside(
        self, source: Source, at: Location, word: str, *, of_package: bool = False
    ) -> tuple[int, int] | None:
        """Return where a word is in the call of Python, or the start tag, at a place.

        A program may be called as its package: `of_package` says which is meant.
        """
        start = source.start_offset(at)
        end = self.end_of_element(source, at, start)
        inside = [span for span in _spans(source, word) if start <= span[0] and span[1] <= end]
        if not inside or inside[0][0] <= start + 1:
            return None  # the place is that of the word, or of its quote
        texts = [span for span in inside if _is_whole_text(source.text, span)]
        meant: list[tuple[int, int]] = []
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

    def _spans_at(self, source: Source, at: Location, word: str) -> list[tuple[int, int]]:
        """Return the occurrences of a word that a place is about."""
        spans = _spans(source, word)
        if f"/{at.path}".endswith(_WITH_ALL):
            return spans
        inside = self._span_inside(source, at, word)
        if inside is not None:
            return [inside]
        return _meant(source.text, word, spans, source.start_offset(at))

    def _source(self, path: str) -> Source | None:
        """Return the text of a file; None if it cannot be read."""
        for urdf in self._workspace.urdfs:
            if urdf.path == path:
                return urdf.source
        data = self._workspace.tree.read(path, URDF_LIMIT)
        if data is not None:
            return Source(path, data.decode("utf-8", "replace"))
        return None

    def _only_edit(self, correction: Correction) -> Edits:
        """Return the edit of a name in the one place where packages write it."""
        old, new = correction.old.strip("/"), correction.new.strip("/")
        places: list[tuple[Source, tuple[int, int]]] = []
        for source in self.sources:
            places += [(source, span) for span in _spans(source, old)]
        if len(places) != 1:
            return ()
        [(source, span)] = places
        return (source.edit(*span, new),)


def _is_whole_text(text: str, span: tuple[int, int]) -> bool:
    """Return whether a word is all that stands in its quotes."""
    start, end = span
    return start > 0 and text[start - 1] in "\"'" and text[end : end + 1] == text[start - 1]


def _spans(source: Source, name: str) -> list[tuple[int, int]]:
    whole = re.compile(rf"(?<![\w-]){re.escape(name)}(?![\w-]|\.\w)")
    return [match.span() for match in whole.finditer(source.text)]


def _as_written(old: str, new: str) -> Iterator[tuple[str, str]]:
    """Yield two names as they may be written in a text.

    These are the names without the slash that begins them, and without the folders or tables that
    both are in.
    """
    yield old.strip("/"), new.strip("/")
    shared = _SEPARATED.match(commonprefix((old, new)))  # noqa: RUF071  of names, not of paths
    if shared is not None and len(shared[0]) < min(len(old), len(new)):
        yield old[shared.end() :], new[shared.end() :]


def _meant(
    text: str, name: str, spans: Sequence[tuple[int, int]], at: int
) -> list[tuple[int, int]]:
    """Return the occurrence of a name that a place is about.

    This is its key, else the first behind the place, or the last before it.
    """
    key = re.compile(
        rf"{re.escape(name)}[\"']?\s*+:\s*+(?:\{{?\s*+(?:ros__parameters|type)\s*+:\s*+)?"
    )
    before = [span for span in spans if span[0] < at]
    after = [span for span in spans if span[0] >= at]
    if before and at - before[-1][0] < _MAX_KEY and key.fullmatch(text, before[-1][0], at):
        return before[-1:]
    return after[:1] or before[-1:]
