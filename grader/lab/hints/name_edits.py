"""Edits of names that do not agree, where they are used or where they are defined, and of values of
parameters.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from itertools import chain, combinations
from os.path import commonprefix
from typing import Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.source import Edits, Source
from grader.lab.checks.parameters import measured, value_of
from grader.lab.hints.edits import Proposal
from grader.lab.submission.submission import Submission
from grader.ros.package.package import CMAKE, MANIFEST, Package
from grader.ros.workspace.rules.names import Correction
from grader.ros.workspace.rules.reading import wrong_names
from grader.ros.workspace.rules.rule_table import Family

_MAX_WRONG = 4  # names of which all combinations are tried
_TEXTS = (".py", ".xml", ".yaml", ".yml", ".xacro", ".urdf", ".sdf", ".txt", ".cfg")
_MAX_KEY = 400  # characters from a key to its value
_SEPARATED = re.compile(r".*[./:]")
_MAX_REMAPPINGS = 8  # of a file
_REMAPPINGS = re.compile(r"\bremappings\s*=\s*\[[^][]*\]")
_PAIR = re.compile(r"""\(\s*(["'][^"'\n]+["'])\s*,\s*(["'][^"'\n]+["'])\s*,?\s*\)""")
_FROM_TO = re.compile(
    r"""\bfrom\s*[=:]\s*(["']?[\w~/]+["']?)\s*,?\s*\bto\s*[=:]\s*(["']?[\w~/]+["']?)(?![^\s},>/])"""
)
_WITH_ALL = (
    f"/{CMAKE}",
    f"/{MANIFEST}",
)  # files in which a name stands several times for one thing


def name_proposals(
    submission: Submission, family: Family, reference: Package | None
) -> Iterator[Proposal]:
    """Yield the edits with which the names of a family agree: one for all of them, else one for
    each.

    Of two names the one is kept that more places write, in the submission or else in the reference;
    if as many do, both ways are proposed. A name that a file puts together from pieces has none.
    """
    workspace = submission.workspace
    sources = [
        it for package in workspace.packages for it in workspace.texts.sources_of(package, _TEXTS)
    ]
    spelling = _spelling(submission, sources, family, reference)
    wrong = wrong_names(workspace, family, submission.lab_packages.values())
    proposals = [[*_ways(submission, each.corrections, spelling)] for each in wrong]
    yield from chain.from_iterable(proposals)
    if family == "topics":
        yield from chain.from_iterable(map(_exchanged_remappings, sources))
    best = [it for it in chain.from_iterable(proposals) if it.rank == 0]
    counts = range(2, len(proposals) + 1) if len(proposals) <= _MAX_WRONG else [len(proposals)]
    for count in counts:
        for chosen in combinations(best, count):
            edits = dict.fromkeys(chain.from_iterable(proposal.edits for proposal in chosen))
            yield Proposal(tuple(edits), "names that do not agree", rank=count)


def _spelling(
    submission: Submission, sources: Sequence[Source], family: Family, reference: Package | None
) -> "_Spelling":
    """Return where the names of a family are counted."""
    workspace = submission.workspace
    texts = [source.text for source in sources]
    for found in workspace.robots.known:
        texts += [link.name for link in found.robot.links]
        texts += [joint.name for joint in found.robot.joints]
    texts_of_reference: list[str] = []
    for package in reference.packages.values() if reference is not None else ():
        texts_of_reference += [
            source.text for source in workspace.texts.sources_of(package, _TEXTS)
        ]
    # A part of a path is a name of its own, a part of a topic is none.
    if family in ("files", "programs"):
        pattern = r"(?<![\w-]){}(?![\w-])"
    else:
        pattern = r"(?<![\w/.-]){}(?![\w/-])"
    return _Spelling(sources, ("\n".join(texts), "\n".join(texts_of_reference)), pattern)


class _Spelling(NamedTuple):
    """The files of a submission, and the texts of it and of the reference in which names are
    counted.
    """

    sources: Sequence[Source]
    texts: tuple[str, str]
    pattern: str  # {} stands for the name

    def preference(self, new: str, old: str) -> int:
        """Return by how much more often one name is written than the other; 0 if neither text
        tells.
        """
        text, text_of_reference = self.texts
        count_of_new = self._count(new, text)
        # A name that the submission never writes is not compared with one that it writes.
        if count_of_new:
            difference = count_of_new - self._count(old, text)
            if difference:
                return difference
        return self._count(new, text_of_reference) - self._count(old, text_of_reference)

    def _count(self, name: str, text: str) -> int:
        return len(re.findall(self.pattern.format(re.escape(name)), text))

    def only_edit(self, correction: Correction) -> Edits:
        """Return the edit of a name in the one place where the submission writes it; none where it
        is in several.
        """
        old, new = correction.old.strip("/"), correction.new.strip("/")
        places = [(source, span) for source in self.sources for span in _spans(source, old)]
        if len(places) == 1:
            return tuple(source.edit(*span, new) for source, span in places)
        return ()


def _ways(
    submission: Submission, either: Sequence[Correction], spelling: _Spelling
) -> Iterator[Proposal]:
    """Yield the edits that make a correction, or the reverse one; none into the name that fewer
    places write.
    """
    ways = [correction_edits(submission.source, it) or spelling.only_edit(it) for it in either]
    is_only = len(ways) == 1
    for edits in ways:
        if not edits:
            continue
        cause = f"the name `{edits[0].old}`"
        preference = spelling.preference(edits[0].new, edits[0].old)
        if is_only or preference > 0:
            yield Proposal(edits, cause)
        elif preference == 0 and all(ways):
            yield Proposal(edits, cause, rank=1)


def _exchanged_remappings(source: Source) -> Iterator[Proposal]:
    """Yield the edits that exchange both names of a remapping in a launch file: it may be written
    backward.
    """
    pairs: list[re.Match[str]] = []
    for remappings in _REMAPPINGS.finditer(source.text):
        pairs += _PAIR.finditer(source.text, *remappings.span())
    pairs += _FROM_TO.finditer(source.text)
    for pair in pairs[:_MAX_REMAPPINGS]:
        edits = (source.edit(*pair.span(1), pair[2]), source.edit(*pair.span(2), pair[1]))
        yield Proposal(edits, "the order of names in a remapping")


def value_proposals(submission: Submission, wanted: Mapping[str, Any]) -> Iterator[Proposal]:
    """Yield the edit that gives a parameter the value that `parameter_is` asks for, where one is
    written plainly.
    """
    name, meant = wanted["parameter"], wanted.get("value")
    try:
        given = value_of(submission, wanted["node"], name)
        if "measure" in wanted:
            meant = round(measured(submission, wanted["measure"], wanted.get("links", [])), 6)
    except (MissingElement, NotDecided):
        return
    value, at = given.value, given.location
    source, key = submission.source(at.path), re.escape(name.rpartition(".")[2])
    if source is None:
        return
    if not isinstance(meant, str | int | float):
        return
    new = str(meant)
    if isinstance(value, float) and type(meant) is int:  # ROS 2 rejects another type
        new = str(float(meant))
    written = re.escape(str(value))
    plain = re.compile(rf"(?<![\w-]){key}[\"']?\s*:\s*[\"']?({written})(?!\w)", re.IGNORECASE)
    offset = source.offset(at.line, at.column)
    for place in plain.finditer(source.text):
        if place.end() > offset:
            yield Proposal((source.edit(*place.span(1), new),), f"the value of `{name}`")
            return


def correction_edits(source_of: Callable[[str], Source | None], correction: Correction) -> Edits:
    """Return the edits that make a correction in the text; none where the name is not written there
    as a whole.
    """
    at, source = correction.location, source_of(correction.location.path)
    if source is None:
        return ()
    for old, new in _as_written(correction.old, correction.new):
        spans = _spans(source, old)
        if not f"/{at.path}".endswith(_WITH_ALL):
            spans = _meant(source.text, old, spans, source.offset(at.line, at.column))
        if spans:
            return tuple(source.edit(*span, new) for span in spans)
    return ()


def _spans(source: Source, name: str) -> list[tuple[int, int]]:
    return [
        it.span() for it in re.finditer(rf"(?<![\w-]){re.escape(name)}(?![\w-]|\.\w)", source.text)
    ]


def _as_written(old: str, new: str) -> Iterator[tuple[str, str]]:
    """Yield two names without the slash that begins them, and without the folders or tables that
    both are in.
    """
    yield old.strip("/"), new.strip("/")
    shared = _SEPARATED.match(commonprefix((old, new)))  # noqa: RUF071  of names, not of paths
    if shared is not None and len(shared[0]) < min(len(old), len(new)):
        yield old[shared.end() :], new[shared.end() :]


def _meant(
    text: str, name: str, spans: Sequence[tuple[int, int]], at: int
) -> list[tuple[int, int]]:
    """Return the occurrence of a name that a place is about: its key, else the first behind it, or
    the last before.
    """
    key = re.compile(rf"{re.escape(name)}[\"']?\s*:\s*(?:\{{?\s*(?:ros__parameters|type)\s*:\s*)?")
    before = [span for span in spans if span[0] < at]
    after = [span for span in spans if span[0] >= at]
    if before and at - before[-1][0] < _MAX_KEY and key.fullmatch(text, before[-1][0], at):
        return before[-1:]
    return after[:1] or before[-1:]
