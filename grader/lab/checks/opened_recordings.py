"""The recordings of a submission as checks need them: read, and asked one by one."""

from collections.abc import Callable
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from grader.base.errors import MissingElement, NotDecided, RecordingError
from grader.base.names import last_part
from grader.base.text import enumerated
from grader.lab.checks.outcome import Outcome, pending
from grader.lab.submission.submission import Submission

if TYPE_CHECKING:
    from grader.ros.api import RecordedTopic, Recording, RecordingFiles

_MAX_LISTED = 4


def ask_recordings(
    submission: Submission, name: str, judge: "Callable[[Recording], Outcome]"
) -> Outcome:
    """Return what is found in the recording with a name, or in the only one.

    Of several, those that have messages count. If they say different things, a person decides.
    Raises MissingElement without a recording, NotDecided for one that exceeds a limit.
    """
    findings: dict[str, Outcome | MissingElement] = {}
    for recording in _read_recordings(submission, name):
        try:
            findings[recording.path] = judge(recording)
        except MissingElement as missing:
            findings[recording.path] = missing
    outcomes = [one for one in findings.values() if isinstance(one, Outcome)]
    if not outcomes:
        raise next(one for one in findings.values() if isinstance(one, MissingElement))
    if len(outcomes) == len(findings) and len({one.status for one in outcomes}) == 1:
        return outcomes[0]
    told = [
        f"{path}: {one.message if isinstance(one, Outcome) else one}"
        for path, one in findings.items()
    ]
    return pending(f"the recordings differ; needs manual grading: {'; '.join(told)}", "they differ")


def weigh_losses(outcome: Outcome, recording: "Recording", *, mistake: str, cause: str) -> Outcome:
    """Return a failure with its mistake and cause; pending if messages that are lost may be why."""
    if recording.losses:
        message = f"{outcome.message}, but {recording.losses[0].text}; needs manual grading"
        return pending(message, "the recording is not complete")
    return outcome._replace(mistake=mistake, cause=cause)


def need_topic(recording: "Recording", topic: str) -> "RecordedTopic":
    """Return a topic with messages; raises MissingElement, which costs once for all criteria."""
    full = f"/{topic.lstrip('/')}"
    recorded = recording.topics.get(full)
    if recorded and recorded.count:
        return recorded
    if recorded:
        detail = ": it has no messages"
    else:
        last = last_part(full)
        others = [each for each in recording.topics if last_part(each) == last]
        detail = f"; {others[0]} was" if others else ""
    raise MissingElement(
        "recorded topic",
        full,
        message=f"{full} was not recorded",
        detail=detail,
        costs_once=True,
    )


def _read_recordings(submission: Submission, name: str) -> "list[Recording]":
    """Return the recordings with messages; raises what explains that there is none."""
    from grader.ros.api import read_recording  # late: few rubrics ask

    read = []
    errors: list[MissingElement | NotDecided] = []
    for files in _find_named(submission, name):
        try:
            recording = read_recording(files)
        except RecordingError as error:
            if error.is_limit:
                errors.append(NotDecided(f"{files.path!r} cannot be read: {error}", "a limit"))
            else:
                errors.append(MissingElement("recording", name, message=str(error)))
            continue
        if recording.count:
            read.append(recording)
        else:
            message = "the recording has no messages: were the topics published while it ran?"
            if recording.losses:
                message = f"no message of {recording.path} can be read: {recording.losses[0].text}"
            errors.append(MissingElement("recording", name, message=message))
    if not read:
        raise errors[0]
    return read


def _find_named(submission: Submission, name: str) -> "tuple[RecordingFiles, ...]":
    from grader.ros.api import MAX_RECORDINGS, find_recordings

    every = find_recordings(submission.tree)
    named = [files for files in every if not name or _is_named(files.path, name)]
    if len(named) > MAX_RECORDINGS:
        raise NotDecided(f"there are {len(named)} recordings", "there are many recordings")
    if not named:
        submission.refuse_unopened("recording")
        paths = enumerated([files.path for files in every], _MAX_LISTED)
        message = f"no recording is named {name!r}" if every else "no recording was submitted"
        detail = f"; there is {paths}" if every else ""
        raise MissingElement("recording", name, message=message, detail=detail)
    return tuple(named)


def _is_named(path: str, name: str) -> bool:
    """Return whether a pattern fits a part of a path, or the beginning of a file's name."""
    *folders, last = path.split("/")
    return any(fnmatchcase(part, name) for part in (*folders, last, last.partition(".")[0]))
