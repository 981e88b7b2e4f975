"""What a hint says, at each level: nothing, where to look, what is wrong there, or the edit."""

from collections.abc import Mapping
from decimal import Decimal

from grader.grading.hints.search import Found
from grader.grading.levels import Level
from grader.source import Edit, Location, Source
from grader.submission.editing import creates
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from grader.text import counted_points, enumerated

_MAX_NAMED = 4  # criteria and edits that are named
_MAX_LINES = 6
_MAX_TEXT = 240  # characters of a changed text


def message(found: Found, level: Level, submission: Submission, costs: Mapping[str, Decimal]) -> str:
    """Return the hint in one or two sentences; the name of the URDF needs no mention.

    `costs` are the points that failed criteria cost: a hint is shown at the costliest one, and named after it.
    """
    own = _own_edits(found)
    before = {name for earlier in found.after for name in earlier.gains}
    more = {name: points for name, points in found.gains.items() if name not in before}
    passes = _outcome(more or found.gains, costs, also=bool(found.after))
    earlier = f"the edit{'s' if len(found.after) > 1 else ''} for {_after(found, costs)}" if found.after else ""
    if not own:
        return f"With {earlier}, {passes}."
    if level != "edit":
        where = _places(own, submission) if level == "cause" else _marked(own, submission)
        cause = f": {found.proposal.cause}" if level == "cause" else ""
        first = f"After {earlier}, check" if earlier else "Check"
        return f"{first} {where}{cause}. Fixing this makes {_outcome(more or found.gains, costs, verb='pass')}."
    changes = _moves(own, submission.path) or [_change(edit, submission) for edit in own[:_MAX_NAMED]]
    changes += [f"{len(own) - _MAX_NAMED} more edits"] * (len(own) > _MAX_NAMED)
    text = enumerated(changes, _MAX_NAMED + 1)
    text = f"After {earlier}, {text}" if earlier else text[0].upper() + text[1:]
    source = submission.urdf.reading.source if isinstance(submission.urdf, Read) else None
    return f"{text}{_calls(own, source) if source is not None else ''}: {passes}."


def _marked(edits: list[Edit], submission: Submission) -> str:
    """Return the texts to look at, each with its line."""
    texts = [f"{_quoted(edit.old)} ({_where(edit, submission.path)})" for edit in edits if edit.old]
    return enumerated(texts, _MAX_NAMED) if texts else _places(edits, submission)


def _places(edits: list[Edit], submission: Submission) -> str:
    """Return the lines to look at: lines 65 and 73; of another file with its name."""
    files: dict[str, list[int]] = {}
    for edit in edits:
        if edit.path == submission.path or edit.path in submission.everything.files:
            files.setdefault(edit.path, []).append(edit.line)
    texts = []
    for path, lines in files.items():
        numbers = sorted(set(lines))
        named = f"line{'s' if len(numbers) > 1 else ''} {enumerated([str(line) for line in numbers], _MAX_LINES)}"
        texts.append(named if path == submission.path else f"{path}, {named}")
    return "; ".join(texts) or "which files are missing"


def _calls(edits: list[Edit], source: Source) -> str:
    """Return where the macros of xacro that edits are in are called, if that is more than once."""
    calls = dict.fromkeys(call for edit in edits for call in source.calls(edit))
    macros = {macro: [_at(place, source.path) for name, place in calls if name == macro] for macro, _ in calls}
    uses = [
        f"the macro {macro} is called in {enumerated(places, _MAX_NAMED)}"
        for macro, places in macros.items()
        if len(places) > 1
    ]
    return f" ({'; '.join(uses)})" if uses else ""


def _at(place: Location, main: str | None) -> str:
    return f"line {place.line}" if place.path == main else f"line {place.line} of {place.path}"


def _own_edits(found: Found) -> list[Edit]:
    """Return the edits that are not those of an earlier hint."""
    if not found.proposal.edits:
        return []
    earlier = {edit for before in found.after for edit in before.edits}
    return [edit for edit in found.edits if edit not in earlier]


def _after(found: Found, costs: Mapping[str, Decimal]) -> str:
    """Return earlier hints, each named by the criterion at which it is shown."""
    names = dict.fromkeys(_ordered(before.gains, costs)[0] for before in found.after)
    return enumerated(list(names), _MAX_NAMED)


def _ordered(gains: Mapping[str, Decimal], costs: Mapping[str, Decimal]) -> list[str]:
    """Return criteria, the one at which a hint is shown first."""
    return sorted(gains, key=lambda name: (name not in costs, -costs.get(name, gains[name])))


def _outcome(gains: Mapping[str, Decimal], costs: Mapping[str, Decimal], *, also: bool = False, verb: str = "") -> str:
    points = sum(gains.values(), Decimal(0))
    gain = f", +{counted_points(points)}" if points else ""
    passes = verb or f"{'also ' if also else ''}{'passes' if len(gains) == 1 else 'pass'}"
    return f"{enumerated(_ordered(gains, costs), _MAX_NAMED)} {passes}{gain}"


def _moves(edits: list[Edit], main: str | None) -> list[str]:
    """Return the change in words if a text is moved: removed at one place, and inserted at another one."""
    texts = {" ".join((edit.old + edit.new).split()) for edit in edits}
    if len(edits) != 2 or len(texts) > 1 or {bool(edit.old) for edit in edits} != {True, False}:
        return []
    old, new = sorted(edits, key=lambda edit: not edit.old)
    return [f"move {_quoted(old.old)} ({_where(old, main)}) to after {_where(new, main)}"]


def _change(edit: Edit, submission: Submission) -> str:
    old, new, where = _quoted(edit.old), _quoted(edit.new), _where(edit, submission.path)
    if edit.renamed:
        return f"rename `{edit.path}` to `{edit.renamed}`"
    if creates(submission, edit):
        return f"create {'' if edit.new else 'the empty file '}`{edit.path}` (--fix writes it)"
    if not edit.old:
        is_line, is_below = edit.new.endswith("\n"), edit.new.lstrip(" \r").startswith("\n")
        return f"insert {new} ({'before ' if is_line else 'after ' if is_below else ''}{where})"
    if not edit.new:
        return f"remove {old} ({where})"
    return f"change {old} to {new} ({where})"


def _where(edit: Edit, main: str | None) -> str:
    return _at(Location(edit.path, edit.line, edit.column), main)


def _quoted(text: str) -> str:
    """Return a text of the file between backticks, in one line."""
    line = " ".join(text.split()).replace("> <", "><")
    if not line:
        return ""
    return f"`{line}`" if len(line) <= _MAX_TEXT else f"`{line[: _MAX_TEXT - 3]}...`"
