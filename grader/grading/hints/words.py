"""What a hint says, at each level: nothing, where to look, what is wrong there, or the edit."""

from collections.abc import Mapping
from decimal import Decimal

from grader.grading.hints.search import Found
from grader.grading.levels import Level
from grader.source import Edit, Location, Source
from grader.submission.submission import Submission
from grader.submission.urdf import Read
from grader.text import counted_points, enumerated

_MAX_NAMED = 4  # criteria and edits that are named
_MAX_TEXT = 240  # characters of a changed text


def message(found: Found, level: Level, submission: Submission) -> str:
    """Return the hint in one line; the name of the URDF needs no mention."""
    main = submission.path
    source = submission.urdf.reading.source if isinstance(submission.urdf, Read) else None
    own = _own_edits(found)
    gains = {
        name: points for name, points in found.gains.items() if own or not any(name in one.gains for one in found.after)
    }
    if not own:
        text = f"The edits for {_after(found)} together"
    elif level == "edit":
        changes = _moves(own, main) or [_change(edit, submission) for edit in own[:_MAX_NAMED]]
        changes += [f"{len(own) - _MAX_NAMED} more edits"] * (len(own) > _MAX_NAMED)
        text = enumerated(changes, _MAX_NAMED + 1)
    else:
        text = f"look at {found.proposal.named if level == 'cause' else _quoted(own[0].old) or 'this place'} ({_where(own[0], main)})"
    text = text[0].upper() + text[1:]
    if own and found.after:
        text += f", with the edits for {_after(found)}"
    corrected = " with this corrected," if own and level != "edit" else ""
    called = _calls(own, source) if source is not None else ""
    return f"{text}{called}:{corrected} {_outcome(gains)}."


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


def _after(found: Found) -> str:
    """Return earlier hints, each named by the criterion with most points that it makes pass."""
    names = dict.fromkeys(max(before.gains, key=lambda name: before.gains[name]) for before in found.after)
    return enumerated(list(names), _MAX_NAMED)


def _outcome(gains: Mapping[str, Decimal]) -> str:
    names = sorted(gains, key=lambda name: -gains[name])
    points = sum(gains.values(), Decimal(0))
    gain = f", +{counted_points(points)}" if points else ""
    return f"{enumerated(names, _MAX_NAMED)} {'passes' if len(names) == 1 else 'pass'}{gain}"


def _moves(edits: list[Edit], main: str | None) -> list[str]:
    """Return the change in words if a text is moved: removed at one place, and inserted at another one."""
    texts = {" ".join((edit.old + edit.new).split()) for edit in edits}
    if len(edits) != 2 or len(texts) > 1 or {bool(edit.old) for edit in edits} != {True, False}:
        return []
    old, new = sorted(edits, key=lambda edit: not edit.old)
    return [f"move {_quoted(old.old)} ({_where(old, main)}) to the place after {_where(new, main)}"]


def _change(edit: Edit, submission: Submission) -> str:
    old, new, where = _quoted(edit.old), _quoted(edit.new), _where(edit, submission.path)
    if edit.renamed:
        return f"rename `{edit.path}` to `{edit.renamed}`"
    if edit.path != submission.path and edit.path not in submission.everything.files:
        return f"create `{edit.path}` (--fix writes it)"
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
