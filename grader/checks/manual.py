"""Checks of what a person has to judge: the answers and pictures are found and shown, the mark is given by a person."""

from grader.checks.outcome import Outcome
from grader.submission.submission import Submission

_DOCUMENTS = ("*.md", "*.txt", "*.docx", "*.pdf", "*.rst", "*.doc", "*.odt", "*.rtf", "*.pages", "*.ipynb")


def answered(
    submission: Submission, *, question: str, places: list[str], files: tuple[str, ...] = _DOCUMENTS, answer: str = ""
) -> Outcome:
    """A question is answered in writing, as a person judges.

    `answer` is the model answer: the rubric keeps it for `grader review` and `--answers`, or in a file of its own. `places` says how the passage is marked, such as "task 1 step
    15" or "question 15"; `files` are patterns for the names of documents. Always pending.
    """
    del answer  # no outcome holds it: students read outcomes
    from grader.documents.answers import find_answer  # a URDF on its own has no answers

    if submission.no_documents:
        message = f"{question} The documents could not be read: {submission.no_documents}; needs manual grading"
        return Outcome("pending", message)
    found = find_answer(submission.documents, files, places)
    if found.passage is not None:
        place = found.passage.location
        message = f"{question} The answer in {place.path}, from line {place.line}, is for a person to mark"
        text: str | None = found.passage.text
    else:
        looked = f"; looked through {', '.join(found.read[:8])}" if found.read else ""
        message = f"{question} No answer was found under {' or '.join(map(repr, places[:3]))}{looked}; a person decides"
        place, text = None, None
    if found.unread:
        message += f" (not read: {'; '.join(found.unread[:4])})"
    return Outcome("pending", message, text, location=place)


def evidence_shown(submission: Submission, *, names: list[str]) -> Outcome:
    """A picture or PDF shows what was asked for, as a person judges.

    `names` says how the file is named, however it is spelt: "task 3 step 3", or plain words such as "webcam". Always pending.
    """
    from grader.documents.evidence import find_evidence

    found = find_evidence(submission.proofs, names)
    if found:
        listed = ", ".join(exhibit.words for exhibit in found[:6])
        return Outcome("pending", f"a person looks at {listed}", tuple(exhibit.path for exhibit in found))
    others = [proof.file.path for proof in submission.proofs]
    there = (
        f"; there {'are' if len(others) > 1 else 'is'} {', '.join(others[:6])}"
        if others
        else "; there are no pictures at all"
    )
    return Outcome(
        "pending", f"no picture or PDF named as {' or '.join(map(repr, names[:3]))} was found{there}; a person decides"
    )


# Always pending, whatever was handed in.
MANUAL_CHECKS = (answered, evidence_shown)
