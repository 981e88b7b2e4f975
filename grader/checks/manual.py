"""Checks that need manual grading: the grader finds answers and pictures, and a person marks them."""

from grader.checks.outcome import Outcome, pending
from grader.submission.submission import Submission
from grader.text import enumerated

_DOCUMENTS = ("*.md", "*.txt", "*.docx", "*.pdf", "*.rst", "*.doc", "*.odt", "*.rtf", "*.pages", "*.ipynb")
_MAX_LISTED = 6  # files in one message


def answered(
    submission: Submission, *, question: str, places: list[str], files: tuple[str, ...] = _DOCUMENTS, answer: str = ""
) -> Outcome:
    """A question is answered in writing; needs manual grading.

    Always pending. `places` are labels of the passage with the answer, such as "task 1 step 15" or "question 15"; `files` are
    patterns for the names of documents. `answer` is the model answer, which `grader review` and `--answers` show: the rubric
    keeps it here or in a separate file.
    """
    del answer  # students read outcomes, so they do not contain it
    from grader.documents.answers import find_answer  # a URDF on its own has no answers

    if submission.no_documents:
        return pending(f"{question} The documents cannot be read: {submission.no_documents}; needs manual grading")
    found = find_answer(submission.documents, files, places)
    unread = f" (not read: {'; '.join(found.unread[:4])})" if found.unread else ""
    if found.passage is None:
        searched = f" in {enumerated(found.read, _MAX_LISTED)}" if found.read else ""
        labels = enumerated([repr(label) for label in places[:3]], word="or")
        return pending(f"{question} No answer was found under {labels}{searched}; needs manual grading{unread}")
    at = found.passage.location
    message = f"{question} The answer in {at.path}, from line {at.line}, needs manual grading{unread}"
    return Outcome("pending", message, found.passage.text, location=at)


def evidence_shown(submission: Submission, *, names: list[str]) -> Outcome:
    """A picture or PDF shows what the lab asks for; needs manual grading.

    Always pending. `names` are labels in the file's name, in any spelling: "task 3 step 3", or words such as "webcam".
    """
    from grader.documents.evidence import find_evidence

    found = find_evidence(submission.proofs, names)
    if found:
        listed = enumerated([exhibit.words for exhibit in found], _MAX_LISTED)
        return Outcome("pending", f"needs manual grading: {listed}", tuple(exhibit.path for exhibit in found))
    paths = [proof.file.path for proof in submission.proofs]
    others = enumerated(paths, _MAX_LISTED) or "no pictures"
    labels = enumerated([repr(name) for name in names[:3]], word="or")
    return pending(f"no picture or PDF is named {labels}; the submission has {others}; needs manual grading")


MANUAL_CHECKS = (answered, evidence_shown)
