"""The inputs of a run over a class: the options of the command, else what the gradebook has; their copies in it."""

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from grader.classroom import gradebook_folder as names
from grader.classroom.batch_worker import reference_hashes
from grader.classroom.equal_work import hashes_of
from grader.classroom.gradebook_folder import CLASS_FILE, ClassSettings, read_settings, relative, settings_text
from grader.classroom.lateness import read_time, time_text
from grader.classroom.roster import Roster, read_roster
from grader.classroom.tables import SIZE_LIMIT
from grader.commands.rubrics import DEFAULT_RUBRIC, files_of
from grader.commands.saves import read_arguments
from grader.commands.terminal import Warn
from grader.commands.writing import save, save_bytes
from grader.errors import InputError
from grader.files.reading import read_capped, sha256_of
from grader.grading.rubric import Rubric, load_rubric
from grader.report.formats import Format, OutputFormat
from grader.submission.opening import open_submission
from grader.text import enumerated, printable_path

_PRIVATE = 0o600


@dataclass(frozen=True, slots=True)
class ClassRequest:
    """The options of `grader batch`. `timeout` is in seconds, `max_size` in bytes.

    None stands for what the gradebook keeps of the last run; it keeps no options from `jobs` on.
    """

    paths: Sequence[Path] | None
    gradebook: Path | None
    rubric: str | None
    roster: Path | None
    due: str | None
    layout: str | None
    assignment: str | None
    part: Sequence[str] | None
    arg: Sequence[str] | None
    ignore_file: Sequence[Path] | None
    max_size: int | None
    jobs: int | None
    timeout: float
    force: bool
    cluster: str | None
    reports: Path | None
    report_format: Sequence[Format] | None
    answers: Path | None
    verbose: bool
    output_format: OutputFormat


@dataclass(frozen=True, slots=True)
class ClassInputs:
    """What a run reads: the gradebook and its settings, the rubric as it was named, the roster."""

    folder: Path
    settings: ClassSettings
    rubric: Rubric
    roster: Roster | None

    @property
    def roots(self) -> tuple[Path, ...]:
        """The absolute paths of the submissions."""
        return self.settings.roots(self.folder)

    @property
    def near_roots(self) -> tuple[Path, ...]:
        """The same, relative to the current folder if they are in it."""
        here = Path.cwd()
        return tuple(root.relative_to(here) if root.is_relative_to(here) else root for root in self.roots)


def read_inputs(options: ClassRequest, warn: Warn) -> ClassInputs:
    """Return the inputs of a run; raise InputError and RubricError. Nothing is written."""
    rubric = load_rubric(options.rubric) if options.rubric is not None else None
    folder = options.gradebook or Path(f"{rubric.id if rubric is not None else DEFAULT_RUBRIC}-grades")
    is_new = not names.is_gradebook(folder)
    names.check_free(folder)
    settings = ClassSettings() if is_new else read_settings(folder)
    if rubric is None:
        rubric = load_rubric(DEFAULT_RUBRIC if is_new else folder / settings.rubric)
    elif (recorded := settings.rubric_id) not in ("", rubric.id):
        raise InputError(
            f"{printable_path(folder)} is the gradebook of {recorded}, not of {rubric.id}: name another folder"
        )
    if not (options.paths or settings.submissions):
        raise InputError("name the PATH of the submissions, a folder or the zip of an LMS")
    if options.due is None and (due := settings.deadline(folder)) is not None:
        warn(f"deadline of the last run: {time_text(due, due.tzinfo)} (--due changes it)")
    roster_file = options.roster or (folder / names.ROSTER)
    roster = None
    if options.roster or roster_file.exists():
        roster = read_roster(_read(roster_file), printable_path(roster_file))
    inputs = ClassInputs(folder, _updated(options, settings, folder, rubric), rubric, roster)
    if not options.paths and (gone := [printable_path(root) for root in inputs.near_roots if not root.exists()]):
        raise InputError(
            f"{enumerated(gone)} of the last run cannot be found: name the new PATH; of several sections, name all"
        )
    return inputs


def _updated(options: ClassRequest, settings: ClassSettings, folder: Path, rubric: Rubric) -> ClassSettings:
    """Return the settings with the options of the command."""
    for name in options.part or ():
        rubric.part(name)
    given: dict[str, Any] = {
        "due": read_time(options.due).isoformat() if options.due else None,
        "layout": options.layout,
        "assignment": options.assignment,
        "parts": tuple(options.part) if options.part else None,
        "arguments": read_arguments(options.arg or ()) or None,
        "max_size": options.max_size,
        "submissions": tuple(relative(path, folder) for path in options.paths or ()) or None,
    }
    settings = replace(settings, **{name: value for name, value in given.items() if value is not None})
    if options.ignore_file or not settings.handed_out:
        own = tuple(_handed_out(options.ignore_file or (), rubric))
        settings = replace(settings, handed_out=(*own, *reference_hashes(rubric.data, str(rubric.path))))
    return settings


def _handed_out(files: Sequence[Path], rubric: Rubric) -> Iterator[str]:
    """Yield the hashes of the work that the course handed out. Raises InputError for a file without any."""
    for path in files:
        hashes = hashes_of(open_submission(str(path), rubric.lab))
        if not hashes:
            raise InputError(f"--ignore-file {printable_path(path)}: there is no URDF in it")
        yield from hashes


def keep_inputs(inputs: ClassInputs, options: ClassRequest, warn: Warn) -> ClassInputs:
    """Write the settings and the copies of the roster and the rubric into the gradebook. Raises InputError."""
    folder, settings, rubric = inputs.folder, inputs.settings, inputs.rubric
    if options.roster is not None:
        data, file = _read(options.roster), folder / names.ROSTER
        _warn_of_edits(file, (settings.roster_hash, sha256_of(data)), options.roster, warn)
        save_bytes(file, data, inputs.roots, _PRIVATE)
        settings = replace(settings, roster_hash=sha256_of(data))
    if options.rubric is not None or not settings.rubric:
        _warn_of_edits(folder / settings.rubric, (settings.rubric_hash, rubric.sha256), rubric.path, warn)
        copy = _copy_rubric(folder, rubric)
        settings = replace(settings, rubric=copy, rubric_id=rubric.id, rubric_hash=rubric.sha256)
    if not (folder / CLASS_FILE).exists() or settings != read_settings(folder):
        save(folder / CLASS_FILE, settings_text(settings), inputs.roots, _PRIVATE)
    return replace(inputs, settings=settings, rubric=load_rubric(folder / settings.rubric))


def _warn_of_edits(file: Path, known: Sequence[str], new: Path, warn: Warn) -> None:
    """Say that a copy which a person has edited is replaced."""
    if file.is_file() and sha256_of(_read(file)) not in known:
        warn(f"{printable_path(file)} was edited: it is replaced by {printable_path(new)}")


def _read(file: Path) -> bytes:
    return read_capped(file, SIZE_LIMIT, advice="")


def _copy_rubric(folder: Path, rubric: Rubric) -> str:
    """Copy a rubric and its reference into a gradebook, placed to each other as before; return where it is."""
    target, own = folder / names.RUBRIC, rubric.path.resolve()
    files = [file for file in files_of(str(rubric.path)) if file.name != rubric.answers and file.exists()]
    near = [file.resolve() for file in files if not Path(rubric.reference).is_absolute() or file == rubric.path]
    base = Path(os.path.commonpath([file.parent for file in near]))
    found = {path for file in near for path in (file, *file.rglob("*")) if path.is_file()} - {own}
    copies = {target / path.relative_to(base): path for path in found if path.parent.name != "__pycache__"}
    copies[target / own.relative_to(base)] = own  # when all that it needs is there
    try:
        for place, path in copies.items():
            place.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
            save_bytes(place, path.read_bytes(), (), _PRIVATE)
        for path in target.rglob("*"):
            if path.is_file() and path not in copies:
                path.unlink()
    except OSError as error:
        raise InputError(f"cannot write {printable_path(target)}: {error.strerror}") from None
    return (target / own.relative_to(base)).relative_to(folder).as_posix()
