"""Checks that need manual grading.

The grader finds answers and pictures, and a person marks them.
"""

import posixpath
import re
from collections.abc import Sequence
from fnmatch import fnmatchcase
from typing import TYPE_CHECKING

from grader.base.grouping import Strings
from grader.base.source import Source
from grader.base.text import capitalised, enumerated
from grader.lab.checks.outcome import Outcome, pending
from grader.lab.submission.submission import Submission

if TYPE_CHECKING:
    from grader.lab.documents.evidence import EvidenceFile

_DOCUMENTS = (
    "*.md",
    "*.txt",
    "*.docx",
    "*.pdf",
    "*.rst",
    "*.doc",
    "*.odt",
    "*.rtf",
    "*.pages",
    "*.ipynb",
)
_MAY_HOLD_PICTURES = frozenset(
    {".docx", ".doc", ".odt", ".pages", ".ipynb", ".pptx", ".odp", ".rtf", ".rar", ".7z"}
)
_MAX_LISTED = 6  # files in one message
_MAX_SHOWN = 256 * 1024  # bytes of a file in which a passage is searched
_NOT_FOUND = "not found"
_ONLY_QUESTION = "only the question is there"
_UNANSWERED = f"not answered yet: {_ONLY_QUESTION}"
NO_ANSWER = (
    _NOT_FOUND,
    _UNANSWERED,
)  # the problems of questions without an answer, if every document was read


def answered(
    submission: Submission,
    *,
    question: str,
    places: list[str],
    files: Strings = _DOCUMENTS,
    answer: str = "",
) -> Outcome:
    """A question is answered in writing; needs manual grading.

    Args:
        question: The question, as the report repeats it.
        places: Labels of the passage with the answer, such as "task 1 step 15" or "question 15";
            they are tried in this order.
        files: Patterns for the names of documents.
        answer: The model answer, which `grader review` and `--answers` show. It can also be in a
            separate file.
    """
    del answer  # students read outcomes, so they do not contain it
    from grader.lab.documents.answers import find_answer  # a URDF on its own has no answers

    if submission.opening.no_documents:
        message = (
            f"{question} The documents cannot be read: {submission.opening.no_documents}; needs "
            "manual grading"
        )
        return pending(
            message, problem=f"the documents cannot be read: {submission.opening.no_documents}"
        )
    found_answer = find_answer(submission.documents, files, places, question)
    unread = f" (not read: {'; '.join(found_answer.unread[:4])})" if found_answer.unread else ""
    doubts = ["not every document was read"] if found_answer.unread else []
    passage = found_answer.passage
    if not passage:
        searched = f" in {enumerated(found_answer.read, _MAX_LISTED)}" if found_answer.read else ""
        labels = enumerated(map(repr, places[:3]), word="or")
        message = (
            f"{question} No answer was found under {labels}{searched}; needs manual grading{unread}"
        )
        outcome = pending(message, problem=", but ".join([_NOT_FOUND, *doubts]))
        heading = f"a heading `{_as_title(places[0])}` in {enumerated(files[:3], word='or')}"
        return outcome if doubts else outcome._replace(expected=heading)
    how = f" ({passage.how})" if passage.how else ""
    problem = ""
    if passage.is_empty:
        problem = _UNANSWERED
        message = (
            f"No answer was found {passage.where}: {_ONLY_QUESTION}{how}; needs manual grading"
        )
    elif passage.is_certain:
        message = f"The answer {passage.where}{how}, needs manual grading"
    else:
        problem = "perhaps"
        message = f"Perhaps the answer {passage.where}{how}; needs manual grading"
    text = passage.text
    for other in found_answer.others:
        text += f"\n\n[Also {other.where}]\n{other.text}"
    if found_answer.others:
        others = [f"another passage is {other.where}" for other in found_answer.others]
        message += f"; {enumerated(others)}"
    outcome = Outcome("pending", f"{question} {message}{unread}", text, location=passage.location)
    if passage.is_empty and not doubts:
        outcome = outcome._replace(expected=f"an answer {passage.where} ({_UNANSWERED})")
    return outcome._replace(problem=", but ".join([problem, *doubts] if problem else doubts))


def evidence_shown(submission: Submission, *, names: list[str]) -> Outcome:
    """A picture or document shows what the lab asks for; needs manual grading.

    Without a file of such a name, the headings of Word and PDF files are searched.

    Args:
        names: Labels in the name of the file, in any spelling: "task 3 step 3", or words such as
            "webcam".
    """
    from grader.lab.documents.evidence import find_evidence

    evidence = find_evidence(submission.labelled_files, names, submission.readable_documents)
    if evidence.files:
        return _pending_pictures("needs manual grading: ", evidence.files)
    labels = enumerated(map(repr, names[:3]), word="or")
    if evidence.possible:
        start = f"no picture or document is certain to be {labels}; needs manual grading, perhaps: "
        return _pending_pictures(start, evidence.possible)._replace(problem="perhaps")
    paths = [labelled.file.path for labelled in submission.labelled_files]
    others = enumerated(paths, _MAX_LISTED) or "no pictures"
    message = (
        f"no picture or PDF is named {labels}; the submission has {others}; needs manual grading"
    )
    has_documents = any(
        file.suffix in _MAY_HOLD_PICTURES for file in submission.tree.files.values()
    )
    outcome = pending(
        message, problem=f"{_NOT_FOUND}, but there are documents" if has_documents else _NOT_FOUND
    )
    return outcome if has_documents else outcome._replace(expected=picture_named(names))


def picture_named(names: Sequence[str]) -> str:
    """Return words for the picture that the first of these labels names.

    An example is a picture named `Task3_Step3.png`.
    """
    return f"a picture named `{picture_name(names)}`"


def picture_name(names: Sequence[str]) -> str:
    """Return a name for a picture that the first of these labels finds: Task3_Step3.png."""
    return re.sub(r" (?=\d)", "", _as_title(names[0])).replace(" ", "_") + ".png"


def _as_title(label: str) -> str:
    """Return a label with capitals: Task 1 Step 15."""
    return " ".join(map(capitalised, label.split()))


def _pending_pictures(start: str, found_files: "tuple[EvidenceFile, ...]") -> Outcome:
    listed = enumerated([file.words for file in found_files], _MAX_LISTED)
    return Outcome(
        "pending", start + listed, tuple(dict.fromkeys(file.path for file in found_files))
    )


def manual(
    submission: Submission, *, question: str, files: list[str] | None = None, passage: str = ""
) -> Outcome:
    """Something that no check decides; needs manual grading.

    Args:
        question: What a person decides, as the report repeats it.
        files: Patterns for the names of the files that it is about, such as `*.cpp`; the first file
            that has the passage is shown.
        passage: Words of the line in it; without them, the first line.
    """
    for path in sorted(submission.tree.files):
        name = posixpath.basename(path)
        if any(fnmatchcase(name, pattern) for pattern in files or ()):
            text = (submission.tree.read(path, _MAX_SHOWN) or b"").decode(errors="replace")
            start = text.find(passage)
            if start >= 0:
                at = Source(path, text).at(start)
                shown = text.splitlines()[at.line - 1].strip() if text else ""
                message = f"{question} Needs manual grading: see {at.file_and_line}"
                return Outcome("pending", message, shown, location=at)
    message = f"{question} Needs manual grading"
    if not files:
        return pending(message)
    searched = f" with {passage!r}" if passage else ""
    return pending(message, problem=f"no {enumerated(files, word='or')}{searched}")


MANUAL_CHECKS = (answered, evidence_shown, manual)
