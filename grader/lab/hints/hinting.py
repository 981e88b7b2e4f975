"""Reports with hints, in the words of each level, and submissions with the edits of all hints."""

from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from decimal import Decimal
from functools import partial
from itertools import chain, takewhile
from typing import TYPE_CHECKING, cast

from grader.base.errors import InputError
from grader.base.records import Named
from grader.base.source import Edit, Edits, Location, Source
from grader.base.text import counted, enumerated
from grader.files.limits import ROBOT_ENDINGS
from grader.lab.grading.grade import grade
from grader.lab.grading.report import Hint, Report, Result
from grader.lab.hints.edits import MAX_IN_HINT, FoundHint
from grader.lab.hints.robot_draft import Draft
from grader.lab.hints.search import HintSearch, Trials, hints_on_slips, judged_results, sum_costs
from grader.lab.rubric.hint_levels import HintLevel
from grader.lab.rubric.rubric import ReferenceSolution
from grader.lab.submission.edited import edited_files, text_of, with_files
from grader.lab.submission.submission import Submission
from grader.ros.package.robot_file import Read

if TYPE_CHECKING:
    from grader.ros.package.package import Package
    from grader.ros.xacro.expansion import ExpandedSource


_MAX_LINES = 6
_IMPORTS = ("import ", "from ")
_MAX_TEXT = 240  # characters of a changed text
_Shown = Mapping[Edits, str]  # the criteria that show edits


class _HintedReport(Named):
    """A report with hints, and the edits of all that fit together.

    It also has the types of exceptions that cost other hints.
    """

    report: Report
    edits: Edits
    faults: list[str]


class FixedFiles(Named):
    """The files of a submission that all proven edits change, and the report on the result.

    A file that is gone is None.

    `why_nothing` says why there are none.
    """

    files: Mapping[str, bytes | None]
    report: Report
    why_nothing: str = ""


def hinted(report: Report, submission: Submission, level: HintLevel) -> _HintedReport:
    """Return a report with proven hints for criteria that failed.

    It has none where the search would take long.
    """
    if submission.is_costly:
        return _HintedReport(report, (), [])
    results = {result.criterion.id: result for result in report.results}
    solution = report.rubric.solution
    trials = Trials(report.rubric, submission, judged_results(report))
    reference = _draft(solution), partial(_package, solution)
    slips = hints_on_slips(report)
    search = HintSearch(trials, *reference, report.by_convention, slips).run()
    costs = sum_costs(results)
    # Of several hints with which a criterion passes, it shows the first.
    shown: dict[str, FoundHint] = {}
    for found_hint in reversed(search.found):
        shown |= dict.fromkeys(found_hint.gains, found_hint)
    showing = [found_hint for found_hint in search.found if found_hint.gains]
    entries = {
        found_hint.edits: _entry(found_hint, shown, results, costs) for found_hint in showing
    }
    hints = {}
    for name, found_hint in {**search.missing, **shown}.items():
        if found_hint in slips and found_hint.words:
            continue  # the message says what is missing, and the student writes it
        with trials.isolated():
            hints[name] = _hint_for(name, found_hint, entries, results, level, submission)
    shown_at = {*hints, *entries.values()}
    others = [results[name] for name in costs if name not in shown_at]
    with trials.isolated():
        hints |= _hints_of_others(others, search, entries)
    with_hints = [result._replace(hint=hints.get(result.criterion.id)) for result in report.results]
    report = report._replace(results=tuple(with_hints), hints_complete=search.is_complete)
    edits = chain.from_iterable(found_hint.edits for found_hint in _written(search.found))
    return _HintedReport(report, tuple(edits), trials.faults)


def _hint_for(
    name: str,
    found_hint: FoundHint,
    entries: _Shown,
    results: Mapping[str, Result],
    level: HintLevel,
    submission: Submission,
) -> Hint:
    """Return the hint of a criterion in the words of a level.

    `entries` are the criteria that show the hints with these edits.
    """
    entry = entries.get(found_hint.edits, name)
    earlier = _list_entries(found_hint.after, entries)
    # A hint that is shown at a skipped criterion is not where a reader would look for it.
    named = [shown for shown in earlier if results[shown].outcome.status == "failed"]
    in_order = _first_at(found_hint, results[entry].outcome.location)
    text = message(in_order, level, submission, named)
    keeps_edits = level == "edit" and not found_hint.words
    if keeps_edits and any(map(_loses_expression, in_order.edits)):
        # The student writes an expression, which no program has graded.
        keeps_edits = False
        in_order = in_order._replace(gains={})
    hint = _hint(in_order, text, entry, results[name], keeps_edits=keeps_edits)
    return hint._replace(after=earlier)


def _hints_of_others(
    results: Iterable[Result], search: HintSearch, entries: _Shown
) -> dict[str, Hint]:
    """Return the hints of criteria that pass only after several edits, which other ones show.

    A criterion that costs no more than the first of these is listed below it.
    """
    hints = {}
    for result in results:
        name = result.criterion.id
        if name in search.results and not search.results[name].is_lost:
            edited = _list_entries(search.edits_needed_for(name), entries)
            if edited:
                text = f"Fixed with {enumerated(edited, MAX_IN_HINT)}."
                at = result.outcome.location or Location("", 1, 1)
                first = search.results[edited[0]].criterion
                is_below = result.criterion.points <= first.points
                shown_by = first.id if is_below else ""
                hints[name] = Hint(text, at, {}, shown_by=shown_by, fixed_with=edited)
    return hints


def _list_entries(hints_edits: Iterable[Edits], entries: _Shown) -> Sequence[str]:
    """Return the criteria that show the hints with these edits, each once."""
    return tuple(dict.fromkeys(entries[edits] for edits in hints_edits if edits in entries))


def _written(hints: Sequence[FoundHint]) -> list[FoundHint]:
    """Return the hints whose edits may be written.

    None of them is left to words, and none needs such a hint.
    """
    kept = []
    cut: set[Edits] = set()
    for one in hints:
        is_left_to_words = bool(one.words) or any(map(_loses_expression, one.edits))
        if is_left_to_words or not cut.isdisjoint(one.after):
            cut.add(one.edits)
        else:
            kept.append(one)
    return kept


def _loses_expression(edit: Edit) -> bool:
    """Return whether an edit writes a value in place of an expression of xacro.

    Which one is better, a person knows.
    """
    if not edit.new or not edit.path.endswith(ROBOT_ENDINGS):
        return False
    return edit.old.count("$") > edit.new.count("$")


def fixed(hinted_report: _HintedReport, submission: Submission) -> FixedFiles:
    """Return the files with all proven edits that fit together, graded again."""
    report = hinted_report.report
    why_nothing = "no edit that was tried gains points"
    if not report.hints_complete:
        why_nothing = "the search for edits ended at its limit before it found one"
    if hinted_report.faults:
        why_nothing = "the search for edits failed"
    if submission.is_costly:
        why_nothing = "the submission is too large to search for edits"
    files = edited_files(submission, hinted_report.edits) or {}
    after = with_files(submission, files) if files else submission
    return FixedFiles(
        files,
        grade(report.rubric, after, report.parts, is_one_of_class=not submission.is_single),
        why_nothing,
    )


def _entry(
    hint: FoundHint,
    shown: Mapping[str, FoundHint],
    results: Mapping[str, Result],
    costs: Mapping[str, Decimal],
) -> str:
    """Return the criterion that shows a hint in a report.

    This is the one at the line that is edited, else the costliest.
    """

    def rank(name: str) -> tuple[bool, bool, bool, Decimal]:
        where = results[name].outcome.location
        edit = hint.edits[0]
        is_there = where is not None and (where.path, where.line) == (edit.path, edit.line)
        is_of_robot = results[name].criterion.check.subject != "urdf"
        cost = costs.get(name, hint.gains[name])
        return name not in costs, not is_there, is_of_robot, -cost

    showing = [name for name in hint.gains if shown.get(name) is hint]
    return min(showing or hint.gains, key=rank)


def _first_at(hint: FoundHint, where: Location | None) -> FoundHint:
    """Return a hint with the edits in the line of the failure first, and imports last."""
    place = (where.path, where.line) if where else None

    def rank(edit: Edit) -> tuple[bool, bool, str, int, int]:
        is_import = not edit.old and edit.new.startswith(_IMPORTS)
        is_elsewhere = (edit.path, edit.line) != place
        return is_import, is_elsewhere, edit.path, edit.line, edit.column

    edits = sorted(hint.proposal.edits, key=rank)
    return hint._replace(proposal=hint.proposal._replace(edits=tuple(edits)))


def _hint(hint: FoundHint, text: str, shown_by: str, result: Result, *, keeps_edits: bool) -> Hint:
    at = result.outcome.location or Location("", 1, 1)
    if hint.edits:  # of two alternatives, there are none
        first = hint.edits[0]
        where = result.outcome.location
        # A line that is missing has no place of its own.
        is_line = "\n" in first.new and not first.old and not first.path.endswith(ROBOT_ENDINGS)
        if not (is_line and where and where.path == first.path):
            at = first.location
    shown = (hint.edits, hint.proposal.cause) if keeps_edits else ((), "")
    return Hint(text, at, hint.gains, *shown, shown_by, hint.certainty)


def _draft(reference: ReferenceSolution | None) -> Draft | None:
    """Return the robot of the reference solution."""
    if not reference:
        return None
    with suppress(InputError):
        return Draft.of(reference.reading)
    return None


def _package(reference: ReferenceSolution | None, name: str) -> "Package | None":
    """Return the package of the reference solution.

    If the rubric has several, it is the one of this name.
    """
    if not reference:
        return None
    with suppress(InputError):
        if name:
            return reference.submission.with_package(name).package
        return reference.submission.package
    return None


def message(
    hint: FoundHint, level: HintLevel, submission: Submission, earlier: Sequence[str]
) -> str:
    """Return the hint in a sentence, which need not name the URDF.

    `earlier` are criteria whose hints come first.
    """
    text = _clause(hint, level, submission)
    if hint.equal:
        other = _clause(FoundHint(hint.equal, {}), level, submission)
        if other != text:
            text = f"{text}; or {other}"
    if earlier:
        edits = "edits" if len(earlier) > 1 else "edit"
        return f"After the {edits} for {enumerated(earlier, MAX_IN_HINT)}, {text}."
    return f"{text[0].upper()}{text[1:]}."


def _clause(hint: FoundHint, level: HintLevel, submission: Submission) -> str:
    if hint.words:
        words = {"edit": hint.words, "cause": hint.proposal.cause}
        return words.get(level, "a part is missing")
    if hint.alternative:
        first = _clause(hint._replace(alternative=None), level, submission)
        other_found = hint._replace(proposal=hint.alternative, alternative=None)
        second = _clause(other_found, level, submission)
        if first == second:
            return first
        return f"{first}, or {second}: both work, so look which one is meant"
    if level == "edit":
        return _changes(hint.edits, submission)
    if level == "cause":
        return f"check {_places(hint.edits, submission)}: {hint.proposal.cause}"
    return f"check {_texts_to_check(hint.edits, submission)}"


def _changes(edits: Edits, submission: Submission) -> str:
    """Return the edits in words, and where a macro is called that one of them changes."""
    changes = _moves(edits, submission) or _indents(edits, submission)
    if not changes:
        changes = [_change(edit, submission) for edit in edits[:MAX_IN_HINT]]
    if len(edits) > len(changes) == MAX_IN_HINT:
        changes.append(counted(len(edits) - MAX_IN_HINT, "more edit"))
    text = enumerated(changes, MAX_IN_HINT + 1)
    source = submission.urdf.reading.source if isinstance(submission.urdf, Read) else None
    if source and source.is_expanded:
        text += _calls(edits, cast("ExpandedSource", source), submission.path)
    return text


def _texts_to_check(edits: Edits, submission: Submission) -> str:
    """Return the texts to look at, each with its line."""
    texts = [f"{_quote(edit.old)} ({_where(edit, submission)})" for edit in edits if edit.old]
    if texts:
        return enumerated(texts, MAX_IN_HINT)
    return _places(edits, submission)


def _places(edits: Edits, submission: Submission) -> str:
    """Return the lines to look at: lines 65 and 73; of another file with its name."""
    files: dict[str, list[int]] = {}
    for edit in edits:
        files.setdefault(edit.path, []).append(edit.line)
    texts = []
    for path, lines in files.items():
        named = _lines(sorted(set(lines)))
        texts.append(named if path == submission.path else f"{path}, {named}")
    return "; ".join(texts)


def _lines(numbers: Sequence[int]) -> str:
    """Return lines in words: lines 65 and 73."""
    texts = [str(number) for number in numbers]
    return f"{'lines' if len(texts) > 1 else 'line'} {enumerated(texts, _MAX_LINES)}"


def _calls(edits: Edits, source: "ExpandedSource", main: str | None) -> str:
    """Return where the macros of xacro that edits are in are called, if that is more than once."""
    from grader.ros.xacro.rewriting import ExpandedEdits  # late: most robots are not xacro

    expanded = ExpandedEdits(source)
    texts = {}
    for edit in edits:
        for macro, calls in expanded.calls(edit).items():
            if len(calls) > 1:
                places = enumerated([_at(call, main) for call in calls], MAX_IN_HINT)
                texts[macro] = f"the macro {macro} is called in {places}"
    if not texts:
        return ""
    return f" ({'; '.join(texts.values())})"


def _at(place: Location | Edit, main: str | None) -> str:
    if place.path == main:
        return f"line {place.line}"
    return f"line {place.line} of {place.path}"


def _moves(edits: Edits, submission: Submission) -> list[str]:
    """Return two changes in words if they belong together.

    They exchange texts, or a text is removed at one place and added at another.
    """
    if len(edits) != 2:
        return []
    first, second = edits
    if first.old and (first.old, first.new) == (second.new, second.old):
        places = [f"{_quote(edit.old)} ({_where(edit, submission)})" for edit in edits]
        return [f"exchange {' and '.join(places)}"]
    removed, added = sorted(edits, key=lambda edit: not edit.old)
    is_move = bool(removed.old) and not added.old
    texts = {" ".join((edit.old + edit.new).split()) for edit in edits}
    if not is_move or len(texts) > 1:
        return []
    place = _insertion(added, submission)
    return [f"move {_quote(removed.old)} ({_where(removed, submission)}) to {place}"]


def _indents(edits: Edits, submission: Submission) -> list[str]:
    """Return what becomes of the indentation of lines, if nothing else changes."""
    for edit in edits:
        is_text = bool((edit.old + edit.new).strip(" \t"))
        if is_text or edit.column > 1 or edit.old == edit.new:
            return []
    path = edits[0].path
    indent = edits[0].new
    widths = []
    for character, word in (("\t", "tab"), (" ", "space")):
        if character in indent:
            widths.append(counted(indent.count(character), word))
    lines = _lines([edit.line for edit in edits])
    if path != submission.path:
        lines = f"{lines} of {path}"
    return [f"indent {lines} with {' and '.join(widths) or 'nothing'}"]


def _change(edit: Edit, submission: Submission) -> str:
    if edit.renamed:
        return f"rename `{edit.path}` to `{edit.renamed}`"
    if not edit.path.endswith(ROBOT_ENDINGS):
        edit = _whole_lines(edit, submission)
    old = _quote(edit.old)
    new = _quote(edit.new)
    if not edit.old:
        return f"add {new} {_insertion(edit, submission)}"
    where = _where(edit, submission)
    if _loses_expression(edit):
        return f"correct the expression in {old} ({where}) so that it gives {new}"
    added = edit.new.removeprefix(edit.old).strip()
    if edit.old.startswith("<") and edit.new.startswith(edit.old) and "<" not in added:
        return f"add {_quote(added)} to `{edit.old}>` ({where})"
    if edit.new:
        return f"change {old} to {new} ({where})"
    return f"remove {old} ({where})"


def _whole_lines(edit: Edit, submission: Submission) -> Edit:
    """Return an edit of a part of an expression as one of the lines that it changes."""
    if all(map(_is_whole, (edit.old, edit.new))):
        return edit
    text = text_of(submission, edit.path)
    source = Source(edit.path, text)
    last_line = edit.line + edit.old.count("\n")
    start = source.offset(edit.line, 1)
    end = source.offset(last_line + 1, 1)
    at = source.start_offset(edit)
    before = text[start:end].splitlines(keepends=True)
    text_after = f"{text[start:at]}{edit.new}{text[at + len(edit.old) : end]}"
    after = text_after.splitlines(keepends=True)
    first = _common_start(before, after)
    before = before[first:]
    after = after[first:]
    last = _common_start(before[::-1], after[::-1])
    if last:
        before = before[:-last]
        after = after[:-last]
    return Edit(edit.path, edit.line + first, 1, "".join(before), "".join(after))


def _common_start(one: Sequence[str], other: Sequence[str]) -> int:
    """Return how many lines both begin with."""
    return len(list(takewhile(lambda pair: pair[0] == pair[1], zip(one, other, strict=False))))


def _is_whole(text: str) -> bool:
    """Return whether a text is a whole.

    It has no line break, both brackets and both quotes of each pair, and no comma before it.
    """
    is_balanced = all(text.count(one) == text.count(other) for one, other in ("()", "[]", "{}"))
    is_quoted = text.count("'") % 2 == text.count('"') % 2 == 0
    is_end = text.lstrip().startswith((",", ")", "]", "}")) and text != ","
    return is_balanced and is_quoted and "\n" not in text and not is_end


def _insertion(edit: Edit, submission: Submission) -> str:
    """Return the line before, after or in which a text is added, or at the end of which."""
    line = _line(edit, submission)
    at = _at(edit, submission.path)
    is_line = edit.new.endswith("\n")
    if is_line and not edit.path.endswith(ROBOT_ENDINGS):
        before = edit._replace(line=edit.line - 1)
        if _line(before, submission).strip():
            return f"after {_at(before, submission.path)}"
    if is_line or not line[: edit.column - 1].strip():
        return f"before {at}"
    if line[edit.column - 1 :].strip():
        return f"in {at}"
    if "\n" in edit.new:
        return f"after {at}"
    return f"at the end of {at}"


def _where(edit: Edit, submission: Submission) -> str:
    """Return the line of an edit, and which text in it is meant.

    The latter is there if the text is there several times.
    """
    line = _line(edit, submission)
    place = _at(edit, submission.path)
    number = line.count(edit.old) if edit.old else 0
    if number < 2:
        return place
    nth = line.count(edit.old, 0, edit.column - 1) + 1
    return f"{place}, number {nth} of {number}"


def _line(edit: Edit, submission: Submission) -> str:
    lines = text_of(submission, edit.path).split("\n")
    if 0 < edit.line <= len(lines):
        return lines[edit.line - 1].removeprefix("\ufeff")
    return ""


def _quote(text: str) -> str:
    """Return a text of the file between backticks, in one line."""
    line = " ".join(text.split()).replace("> <", "><")
    if not line:
        return "a space" if text else ""
    if len(line) <= _MAX_TEXT:
        return f"`{line}`"
    return f"`{line[: _MAX_TEXT - 3]}...`"
