"""What the reports of a class keep for the next time, in `reports.jsonl`.

These are the hints that were found in a submission, and the files that were written.

Robots that are equal share their hints. The file may be deleted: then hints are searched again, and
all reports written again.
"""

from collections.abc import Collection, Mapping
from contextlib import suppress
from decimal import Decimal
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from grader.base.errors import InputError, OutOfTime
from grader.base.source import Edit, Location
from grader.classroom.results.results import hash_values, is_whole, json_line, values_in
from grader.files.limits import MAX_FILE_SIZE
from grader.files.reading import hash_bytes
from grader.lab.grading.report import Hint, Report
from grader.lab.hints.hinting import hinted
from grader.lab.submission.edited import content
from grader.lab.submission.submission import Submission
from grader.report.writing import save_bytes

if TYPE_CHECKING:
    from grader.report.drawing.still import Still

_FILE = "reports.jsonl"
_PRIVATE = 0o600
_OWN = "\0"  # in place of the path of the URDF, which may have the name of a student
_Values = Mapping[str, Any]  # of JSON


class WrittenReport(NamedTuple):
    """A file that was written.

    It has what the file shows, the hash of its bytes, the key of its hints, and the small picture
    of the robot for the class's page.
    """

    shows: str
    sha256: str
    hints: str
    still: "Still" = ()


class KeptReports:
    """What is kept in the folder of a gradebook. A worker adds the hints that it finds to `new`."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / _FILE
        self._hints = {}
        self.written = {}  # by the path of the file
        self.new: dict[str, _Values] = {}
        self.used = ""  # the key of the hints that were asked for last
        self.is_lost = False  # whether their search failed
        if not self._file.is_file():
            return
        for line in self._file.read_bytes().splitlines(keepends=True):
            if not is_whole(line):
                continue
            values = values_in(line)
            if "hints_of" in values:
                self._hints[values["hints_of"]] = values
            else:
                path = values.pop("path")
                still = tuple((fill, data) for fill, data in values.pop("still", ()))
                self.written[path] = WrittenReport(**values, still=still)

    def with_hints(self, report: Report, submission: Submission, context: str) -> Report:
        """Return a report with its hints, which are searched unless they are kept.

        Args:
            report: The report without hints.
            submission: What was graded.
            context: The hash of all that hints depend on besides the submission.
        """
        self.used = key = hash_values(context, _digest_of_content(submission))
        values = self._hints.get(key) or self.new.get(key)
        if values is not None:
            return _restored(report, values)
        try:
            hinted_report = hinted(report, submission, report.rubric.hints)
        except (Exception, OutOfTime):  # noqa: BLE001  a fault of the search must not cost the report
            self.is_lost = True
            return report
        if hinted_report.faults:
            self.is_lost = True
        else:
            self.new[key] = _list_hints(hinted_report.report, key)
        return hinted_report.report

    def is_current(self, path: Path, shows: str) -> bool:
        """Return whether a file is still there as it was written, and shows this."""
        entry = self.written.get(str(path))
        if not entry or entry.shows != shows or not path.is_file():
            return False
        return hash_bytes(path.read_bytes()) == entry.sha256

    def save(self, new: Mapping[str, _Values], roots: Collection[Path]) -> None:
        """Write what the files that are there show, and the hints on them."""
        there = {path: entry for path, entry in self.written.items() if Path(path).is_file()}
        lines = [json_line({"path": path, **entry._asdict()}) for path, entry in there.items()]
        hints = {**self._hints, **new}
        for key in dict.fromkeys(entry.hints for entry in there.values()):
            if key in hints:
                lines.append(json_line({**hints[key], "hints_of": key}))
        with suppress(InputError):  # without it only time is lost
            save_bytes(self._file, b"".join(lines), tuple(roots), _PRIVATE)


def _digest_of_content(submission: Submission) -> str:
    """Return the hash of all files of a submission; a URDF on its own has no path."""
    if submission.is_single:
        return hash_bytes(content(submission, submission.path or "") or b"")
    tree = submission.whole_tree
    facts = [submission.path, submission.opening.no_documents, sorted(tree.folders)]
    for path, file in tree.files.items():
        facts += [path, hash_bytes(file.read(MAX_FILE_SIZE, first=True))]
    return hash_values(*facts)


def _list_hints(report: Report, key: str) -> _Values:
    """Return the hints of a report as plain values."""
    own_path = report.submission.path
    hints = {}
    for result in report.results:
        if not result.hint:
            continue
        values = result.hint._asdict()
        values["at"] = _without_path(result.hint.at, own_path)
        values["edits"] = [_without_path(edit, own_path) for edit in result.hint.edits]
        values["gains"] = {name: str(points) for name, points in result.hint.gains.items()}
        hints[result.criterion.id] = values
    return {"hints_of": key, "is_complete": report.hints_complete, "found": hints}


def _without_path(place: Location | Edit, own_path: str | None) -> list[Any]:
    path, *rest = place
    return [_OWN if path == own_path else path, *rest]


def _restored(report: Report, values: _Values) -> Report:
    """Return a report with hints that were kept."""
    own_path = report.submission.path or ""
    hints = {name: _read_hint(kept, own_path) for name, kept in values["found"].items()}
    results = [result._replace(hint=hints.get(result.criterion.id)) for result in report.results]
    return report._replace(results=tuple(results), hints_complete=values["is_complete"])


def _read_hint(values: _Values, own_path: str) -> Hint:
    """Return a hint of plain values, for a submission whose URDF has this path."""
    path, line, column, calls, *_ = _with_path(values["at"], own_path)
    at = Location(path, line, column, tuple(calls))
    edits = tuple(Edit(*_with_path(edit, own_path)) for edit in values["edits"])
    gains = {name: Decimal(points) for name, points in values["gains"].items()}
    after = tuple(values["after"])
    return Hint(**{**values, "at": at, "edits": edits, "gains": gains, "after": after})


def _with_path(place: list[Any], own_path: str) -> list[Any]:
    path, *rest = place
    return [own_path if path == _OWN else path, *rest]
