"""Finds recordings among files, and reads them.

A recording is the files of one folder: those that its metadata.yaml names, or those whose names
differ in a last number only. metadata.yaml is a hint: it may be missing, old or wrong.
"""

import posixpath
import re
from collections.abc import Iterator, Sequence
from contextlib import closing, suppress
from functools import lru_cache
from tempfile import TemporaryFile
from typing import IO, NamedTuple

from grader.base.errors import InputError, RecordingError
from grader.base.grouping import distinct, group_values
from grader.base.patterns import on_use
from grader.base.text import enumerated, printable_path
from grader.files import limits
from grader.files.tree import File, Tree
from grader.ros.recording import database, mcap
from grader.ros.recording.compression import is_zstd, unpack_file
from grader.ros.recording.recorded import Collector, Note
from grader.ros.recording.recording import Recording

_OF_ROSBAG = b"rosbag2_bagfile_information"
_NAMED = on_use(r"^[ \t]*relative_file_paths:[ \t]*\n((?:[ \t]*-[^\n]*(?:\n|\Z))*)", re.MULTILINE)
_PART = on_use(r"_\d+$")  # behind the name of a file that was split
_LFS = b"version https://git-lfs"
_MAX_LISTED = 4
MAX_RECORDINGS = 4  # of a folder that are read


class RecordingFiles(NamedTuple):
    """The files of one recording, in order, and what metadata.yaml says beside.

    `path` is that of the folder if metadata.yaml is there or several files are, else of the file.
    """

    path: str
    files: tuple[File, ...]
    notes: tuple[Note, ...] = ()


def find_recordings(tree: Tree) -> tuple[RecordingFiles, ...]:
    """Return the recordings among some files, in alphabetical order."""
    folders: dict[str, list[File]] = {}
    for path, file in tree.files.items():
        is_metadata = file.name == limits.METADATA
        if limits.is_recording(path) or (is_metadata and _OF_ROSBAG in _read_metadata(file)):
            folders.setdefault(posixpath.dirname(path), []).append(file)
    recordings: list[RecordingFiles] = []
    for folder, files in sorted(folders.items()):
        recordings += _group_files(tree, folder, files)
    return tuple(recordings)


def _read_metadata(file: File) -> bytes:
    try:
        return file.read(limits.MAX_METADATA_SIZE)
    except InputError:
        return b""


def _group_files(tree: Tree, folder: str, files: Sequence[File]) -> Iterator[RecordingFiles]:
    """Yield the recordings in a folder: one if metadata.yaml is there, else one a stem."""
    name = folder or tree.name
    data = sorted((file for file in files if file.name != limits.METADATA), key=_order_by_number)
    notes = []
    for file in data:
        log = tree.files.get(f"{file.path}-wal")
        if log and log.size:
            notes.append(Note("unclosed", f"the last messages of {file.name} are in {log.name}"))
    if len(data) < len(files):
        metadata = next(file for file in files if file.name == limits.METADATA)
        notes += _compare_names(_list_named(metadata), [file.name for file in data])
        yield RecordingFiles(name, tuple(data), tuple(notes))
        return
    notes.append(Note("no metadata", f"there is no {limits.METADATA}"))
    stems = group_values((_PART.sub("", file.name.partition(".")[0]), file) for file in data)
    for group in stems.values():
        path = group[0].path if len(group) == 1 else name
        yield RecordingFiles(path, tuple(group), tuple(notes))


def _compare_names(named: Sequence[str], names: Sequence[str]) -> Iterator[Note]:
    """Yield what metadata.yaml says of files that are not there: they may have been renamed."""
    missing = [one for one in named if one not in names]
    listed = enumerated(missing, _MAX_LISTED)
    if missing and len(names) >= len(named):
        yield Note("renamed", f"{limits.METADATA} names {listed}")
    elif missing:
        yield Note("missing", f"{listed} {'is' if len(missing) == 1 else 'are'} missing")


def _order_by_number(file: File) -> list[tuple[int, str]]:
    parts = re.split(r"(\d{1,15})", file.name)
    return [(int(part), "") if part.isdecimal() else (0, part) for part in parts]


def _list_named(metadata: File) -> list[str]:
    """Return the names of the files that metadata.yaml lists."""
    match = _NAMED.search(_read_metadata(metadata).decode(errors="replace").replace("\r", ""))
    lines = match[1].splitlines() if match else ()
    paths = [line.strip().removeprefix("-").strip().strip("\"'") for line in lines]
    return [printable_path(posixpath.basename(path)) for path in paths]


@lru_cache(maxsize=2)  # the same files are graded many times for hints
def read_recording(files: RecordingFiles) -> Recording:
    """Read a recording; raises RecordingError if nothing of it can be read."""
    if not files.files:
        raise RecordingError(
            f"{files.path} has a metadata.yaml, but no .mcap or .db3 file: is it too large, or "
            "ignored by git?"
        )
    if sum(file.size for file in files.files) > limits.MAX_RECORDING_SIZE:
        raise RecordingError(f"{files.path} is larger than 1 GiB", is_limit=True)
    collector = Collector()
    errors = []
    for file in files.files:
        try:
            with closing(file.stream()) as stream:
                _read_file(file, stream, collector)
        except RecordingError as error:
            errors.append(error)
            collector.note("limit" if error.is_limit else "damaged", f"{file.name}: {error}")
        except InputError as error:
            raise RecordingError(str(error), is_limit=True) from None
    if errors and not any(channel.times for channel in collector.channels.values()):
        raise errors[0]
    notes = distinct(files.notes + collector.notes)
    return Recording(files.path, tuple(collector.channels.values()), notes)


def read_longest_recording(tree: Tree) -> Recording | None:
    """Return the recording with most messages among some files; None without a message."""
    recordings = []
    for files in find_recordings(tree)[:MAX_RECORDINGS]:
        with suppress(RecordingError):
            recordings.append(read_recording(files))
    longest = max(recordings, key=lambda recording: recording.count, default=None)
    return longest if longest and longest.count else None


def _read_file(file: File, stream: IO[bytes], collector: Collector) -> None:
    start = stream.read(len(_LFS))
    stream.seek(0)
    if is_zstd(start):
        with TemporaryFile() as unpacked:
            unpack_file(stream, unpacked, limits.MAX_RECORDING_UNPACKED)
            collector.spend(unpacked.seek(0, 2))
            unpacked.seek(0)
            _read_plain(file, unpacked, collector)
    else:
        _read_plain(file, stream, collector)


def _read_plain(file: File, stream: IO[bytes], collector: Collector) -> None:
    start = stream.read(len(_LFS))
    if start.startswith(mcap.MAGIC):
        stream.seek(len(mcap.MAGIC))
        mcap.read_mcap(stream, collector)
    elif start.startswith(database.MAGIC):
        stream.seek(0)
        database.read_database(stream, collector)
    elif start == _LFS:
        raise RecordingError(
            f"{file.path} is a Git LFS pointer, not the recording: submit the file itself"
        )
    else:
        what = "is no recording in MCAP or SQLite" if start else "is empty"
        raise RecordingError(f"{file.path} {what}")
