"""Edits of names that do not agree, and of values of parameters.

Names are edited where they are used or where they are defined.
"""

import re
from collections.abc import Mapping, Sequence
from itertools import chain, combinations
from typing import Any, NamedTuple

from grader.base.errors import MissingElement, NotDecided
from grader.base.patterns import on_use
from grader.base.problems import Fix
from grader.base.source import Source
from grader.lab.checks.parameters import find_value, measured
from grader.lab.hints.edits import Proposal, Proposals
from grader.lab.submission.submission import Submission
from grader.ros.package.package import Package
from grader.workspace.rules.name_fixes import NameFixes
from grader.workspace.rules.reading import wrong_names
from grader.workspace.rules.rule_table import Family

_MAX_WRONG = 4  # names of which all combinations are tried
_MAX_REMAPPINGS = 8  # of a file
_REMAPPINGS = on_use(r"\bremappings\s*=\s*\[[^][]*\]")
_PAIR = on_use(r"""\(\s*+(["'][^"'\n]++["'])\s*+,\s*+(["'][^"'\n]++["'])\s*+(?:,\s*+)?\)""")
_FROM_TO = on_use(
    r"""\bfrom\s*+[=:]\s*+(["']?[\w~/]++["']?)\s*+(?:,\s*+)?\bto\s*+[=:]\s*+(["']?[\w~/]++["']?)(?![^\s},>/])"""
)


def name_proposals(submission: Submission, family: Family, reference: Package | None) -> Proposals:
    """Yield the edits with which the names of a family agree.

    This is one for all of them, else one for each.

    Of two names the one is kept that more places write, in the submission or else in the reference;
    if as many do, both ways are proposed. A name that a file puts together from pieces has none.
    """
    workspace = submission.workspace
    name_fixes = NameFixes(workspace)
    spelling = _spelling(submission, name_fixes, family, reference)
    proposals = []
    for wrong in wrong_names(workspace, family, submission.lab_packages.values()):
        proposals.append(list(_ways(name_fixes.guesses(wrong), spelling)))
    yield from chain.from_iterable(proposals)
    if family == "topics":
        yield from chain.from_iterable(map(_exchanged_remappings, name_fixes.sources))
    best = [proposal for proposal in chain.from_iterable(proposals) if proposal.rank == 0]
    counts = range(2, len(proposals) + 1) if len(proposals) <= _MAX_WRONG else [len(proposals)]
    for count in counts:
        for chosen in combinations(best, count):
            edits = dict.fromkeys(chain.from_iterable(proposal.edits for proposal in chosen))
            yield Proposal(tuple(edits), "names that do not agree", rank=count)


def _spelling(
    submission: Submission, name_fixes: NameFixes, family: Family, reference: Package | None
) -> "_Spelling":
    """Return where the names of a family are counted."""
    texts = [source.text for source in name_fixes.sources]
    for known in submission.workspace.robots.known:
        texts += [link.name for link in known.robot.links]
        texts += [joint.name for joint in known.robot.joints]
    packages = reference.packages.values() if reference else ()
    texts_of_reference = [source.text for source in name_fixes.read_sources(packages)]
    # A part of a path is a name of its own, a part of a topic is none.
    if family in ("files", "programs"):
        pattern = r"(?<![\w-]){}(?![\w-])"
    else:
        pattern = r"(?<![\w/.-]){}(?![\w/-])"
    return _Spelling(("\n".join(texts), "\n".join(texts_of_reference)), pattern)


class _Spelling(NamedTuple):
    """The texts of a submission and of the reference in which names are counted."""

    texts: tuple[str, str]
    pattern: str  # {} stands for the name

    def preference(self, new: str, old: str) -> int:
        """Return by how much more often one name is written than the other.

        It is 0 if neither text tells.
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


def _ways(fixes: Sequence[Fix], spelling: _Spelling) -> Proposals:
    """Yield the edits of the fixes of a name: none into the name that fewer places write."""
    for fix in fixes:
        first = fix.edits[0]
        cause = f"the name `{first.old}`"
        preference = spelling.preference(first.new, first.old)
        if fix.is_certain or preference > 0:
            yield Proposal(fix.edits, cause)
        elif preference == 0 and len(fixes) > 1:
            yield Proposal(fix.edits, cause, rank=1)


def _exchanged_remappings(source: Source) -> Proposals:
    """Yield the edits that exchange both names of a remapping in a launch file.

    It may be written backward.
    """
    pairs: list[re.Match[str]] = []
    for remappings in _REMAPPINGS.finditer(source.text):
        pairs += _PAIR.finditer(source.text, *remappings.span())
    pairs += _FROM_TO.finditer(source.text)
    for pair in pairs[:_MAX_REMAPPINGS]:
        edits = (source.edit(*pair.span(1), pair[2]), source.edit(*pair.span(2), pair[1]))
        yield Proposal(edits, "the order of names in a remapping")


def value_proposals(submission: Submission, wanted: Mapping[str, Any]) -> Proposals:
    """Yield the edit that gives a parameter the value that `parameter_is` asks for.

    There is one only where a value is written plainly.
    """
    name = wanted["parameter"]
    meant = wanted.get("value")
    try:
        given = find_value(submission, wanted["node"], name)
        if "measure" in wanted:
            meant = round(measured(submission, wanted["measure"], wanted.get("links", [])), 6)
    except (MissingElement, NotDecided):
        return
    value = given.value
    at = given.location
    source = submission.source(at.path)
    key = re.escape(name.rpartition(".")[2])
    if not source:
        return
    if not isinstance(meant, str | int | float):
        return
    new = str(meant)
    if isinstance(value, float) and type(meant) is int:  # ROS 2 rejects another type
        new = str(float(meant))
    written = re.escape(str(value))
    plain = re.compile(rf"(?<![\w-]){key}[\"']?\s*:\s*[\"']?({written})(?!\w)", re.IGNORECASE)
    offset = source.start_offset(at)
    for place in plain.finditer(source.text):
        if place.end() > offset:
            yield Proposal((source.edit(*place.span(1), new),), f"the value of `{name}`")
            return
