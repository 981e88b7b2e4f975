"""What a person reads for a criterion.

These are the pictures and PDF files of its evidence, and of a written answer.

The documents that may hold an answer for which no heading was found are among them.
"""

from collections.abc import Iterable, Iterator, Sequence

from grader.base.grouping import Strings
from grader.base.text import first_lines
from grader.files.tree import File
from grader.lab.checks.manual import NO_ANSWER, answered, evidence_shown
from grader.lab.documents.collection import CONVERTED, DocumentCollection, TextDocument
from grader.lab.documents.converter import PICTURE
from grader.lab.documents.evidence import EvidenceFile, headed
from grader.lab.documents.pictures import EmbeddedPicture, NotShown, pictures_in_word, read_picture
from grader.lab.grading.report import Report, Result
from grader.lab.submission.submission import Submission

_PICTURE = "[picture]"  # in a written answer: there is one
_MAX_PICTURES, _MAX_BYTES, _MAX_LINES = 40, 96 * 1024 * 1024, 2000  # of one criterion
# The names of documents that may hold an answer without its heading.
_DOCUMENTS = (
    *(
        "*.md",
        "*.markdown",
        "*.txt",
        "*.rst",
        "*.adoc",
        "*.org",
        "*.tex",
        "*.html",
        "*.htm",
        "readme",
        "answers",
    ),
    *("*.docx", "*.doc", "*.odt", "*.rtf", "*.pages", "*.ipynb", "*.pptx", "*.odp"),
)
_Picture = EmbeddedPicture | NotShown


def find_pictures(result: Result, submission: Submission) -> tuple[_Picture, ...]:
    """Return the pictures and PDF files of a criterion that needs manual grading.

    Also return the files that are not shown.

    Of a Word file these are all of its pictures; a PDF opens on the page of the evidence or the
    answer. If no file is named for the evidence, all files of evidence are searched; if no answer
    was found, all PDF files, and Word files.
    """
    paths = _shown_files(result) or _searched_files(result, submission)
    loose, _ = _loose_documents(result, submission)
    paths += tuple(
        one.file.path for one in loose if one.file.suffix == ".docx" and one.has_picture()
    )
    return tuple(
        _limit_pictures(
            picture for path in paths for picture in _read_pictures(path, result, submission)
        )
    )


def _searched_files(result: Result, submission: Submission) -> Strings:
    """Return the files that are shown if none is named: of a question only the PDF files."""
    return tuple(
        labelled.file.path
        for labelled in submission.labelled_files
        if _is_evidence(result) or (_is_question(result) and labelled.file.suffix == ".pdf")
    )


def may_have_pictures(result: Result) -> bool:
    """Return whether pictures of the submission may belong to a criterion."""
    without_file = _is_question(result) and (not result.outcome.location or _has_no_answer(result))
    return bool(_shown_files(result)) or _is_evidence(result) or without_file


def is_empty(result: Result, report: Report) -> bool:
    """Return whether there is nothing to read for a criterion.

    There is no answer, no document and no picture that may be one.

    Of evidence, there is no file that may be it.
    """
    if (
        not (_is_evidence(result) or _is_question(result))
        or result.outcome.problem not in NO_ANSWER
    ):
        return False
    if _is_question(result):
        return not (_loose_files(report) or any(_loose_documents(result, report.submission)))
    return not any(
        (
            report.other_pictures,
            *(files for one in report.evidence for files in (one.files, one.possible)),
        )
    )


def find_content(result: Result, report: Report) -> str:
    """Return the written answer without empty lines, if it is all that there is to read.

    Else return an empty text.

    Without an answer it is the text of the documents that may hold one.
    """
    content = result.outcome.measured
    is_certain = not result.outcome.problem
    if _has_no_answer(result):
        documents, unread = _loose_documents(result, report.submission)
        content = "\n".join(line for one in documents for line in _list_lines(one))
        is_certain = not unread
    if not (_is_question(result) and isinstance(content, str) and is_certain) or _loose_files(
        report
    ):
        return ""
    is_whole = not any(sign in content for sign in (_PICTURE, "![", "]("))
    return "\n".join(filter(None, map(str.rstrip, content.splitlines()))) if is_whole else ""


def loose_lines(result: Result, submission: Submission, *, is_anonymous: bool = False) -> list[str]:
    """Return the lines of the documents that may hold an answer, each below its path.

    These are documents in which no heading was found for it.
    """
    documents, unread = _loose_documents(result, submission)
    lines = []
    for number, one in enumerate(documents, 1):
        name = f"document {number}" if is_anonymous else one.file.path
        lines += [f"[{name}: without a heading of this question]", *_list_lines(one), ""]
    lines += ["[a document that is not shown]" if is_anonymous else f"[{one}]" for one in unread]
    return first_lines(lines, _MAX_LINES)


def _loose_documents(
    result: Result, submission: Submission
) -> tuple[list[TextDocument], Sequence[object]]:
    """Return the documents that may hold an answer, and those that were not read.

    No heading was found for the answer.
    """
    if not _has_no_answer(result):
        return [], ()
    read, unread = submission.documents.named(_DOCUMENTS)
    return [one for one in read if any(map(str.strip, one.lines))], unread


def _list_lines(document: TextDocument) -> list[str]:
    return [_PICTURE if line == PICTURE else line.rstrip() for line in document.lines]


def _has_no_answer(result: Result) -> bool:
    return _is_question(result) and result.outcome.problem in NO_ANSWER


def _loose_files(report: Report) -> tuple[EvidenceFile, ...]:
    """Return the files that may hold a part of an answer.

    These are PDF files, and pictures that are no evidence.
    """
    evidence = (
        result for result in report.results if _is_evidence(result) and not result.outcome.problem
    )
    named = {path for result in evidence for path in evidence_files(result)}
    listed = (
        file for one in report.evidence for files in (one.files, one.possible) for file in files
    )
    others = (file for file in report.other_pictures if file.path not in named)
    return (
        *others,
        *(file for file in (*listed, *report.other_pictures) if file.path.lower().endswith(".pdf")),
    )


def _is_question(result: Result) -> bool:
    return result.criterion.check.function is answered


def _is_evidence(result: Result) -> bool:
    return result.criterion.check.function is evidence_shown


def evidence_files(result: Result) -> Strings:
    """Return the paths of the files of evidence, also where it takes the place of a URDF.

    What other checks measure, such as a vector or names, is no list of files.
    """
    measured = result.outcome.measured
    is_open = result.outcome.status == "pending"
    if not isinstance(measured, tuple | list) or not (_is_evidence(result) or is_open):
        return ()
    return tuple(name for name in measured if isinstance(name, str))


def _shown_files(result: Result) -> Strings:
    """Return the paths of the files that are shown.

    They are files of evidence, the PDF of an answer, or the document with pictures in it.
    """
    if files := evidence_files(result):
        return files
    place = result.outcome.location
    if not place or not _is_question(result) or _has_no_answer(result):
        return ()
    shown = CONVERTED if _PICTURE in str(result.outcome.measured) else (".pdf",)
    if place.path.lower().endswith(shown):
        return (place.path,)
    return ()


def _read_pictures(path: str, result: Result, submission: Submission) -> Iterator[_Picture]:
    file = submission.whole_tree.files.get(path) or submission.tree.files.get(path)
    if not file:
        yield NotShown(path, "it is no longer in the submission")
    elif file.suffix == ".docx":
        yield from pictures_in_word(file)
    else:
        shown = read_picture(file)
        if isinstance(shown, EmbeddedPicture) and file.suffix == ".pdf":
            shown = shown._replace(page=_find_page(file, result, submission.readable_documents))
        yield shown


def _find_page(file: File, result: Result, documents: DocumentCollection | None) -> int:
    """Return the page of a PDF with the answer, or with the heading that names the evidence.

    It is the first page without one.
    """
    document = documents.document(file) if documents else None
    if not documents or not isinstance(document, TextDocument):
        return 1
    outcome = result.outcome
    start = 0
    if isinstance(outcome.measured, str) and outcome.location:
        start = outcome.location.line - 1
    else:
        heads = headed(documents, result.criterion.arguments.get("names", ()))
        start = next((head.start for other, head in heads if other is document), 0)
    return document.page(start) or 1


def _limit_pictures(
    pictures: Iterable[_Picture],
) -> Iterator[_Picture]:
    """Yield pictures up to the limits for one criterion, then a notice that there are more."""
    left = _MAX_BYTES
    for count, one in enumerate(pictures):
        left -= len(one.data) if isinstance(one, EmbeddedPicture) else 0
        if count >= _MAX_PICTURES or left < 0:
            yield NotShown(
                "more pictures", f"only the first {count} are shown: open the others yourself"
            )
            return
        yield one
