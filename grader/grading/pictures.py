"""The pictures and PDF files for manual grading of a criterion: those of its evidence and of a written answer."""

from collections.abc import Iterable, Iterator

from grader.checks.manual import NO_ANSWER, answered, evidence_shown
from grader.documents.collection import DocumentCollection
from grader.documents.document import CONVERTED, Document
from grader.documents.evidence import headed
from grader.documents.evidence_files import EvidenceFile
from grader.documents.headings import Heading
from grader.documents.pictures import EmbeddedPicture, NotShown, read_picture, verified
from grader.errors import InputError
from grader.files.tree import File
from grader.grading.report import Report, Result
from grader.submission.submission import Submission

PICTURE = "[picture]"  # in a written answer: there is one
_MAX_PICTURES, _MAX_BYTES = 40, 96 * 1024 * 1024  # of one criterion


def pictures_of(result: Result, submission: Submission) -> tuple[EmbeddedPicture | NotShown, ...]:
    """Return the pictures and PDF files of a criterion that needs manual grading, and the files that are not shown.

    In a document, these are the pictures below the heading that names the evidence, or in the answer; without such a
    heading all pictures. If no file is named for the evidence, all files of evidence are searched; if no answer was
    found, all PDF files.
    """
    paths = _files(result) or tuple(
        labelled.file.path
        for labelled in submission.labelled_files
        if _is_evidence(result) or (_is_question(result) and labelled.file.suffix == ".pdf")
    )
    return tuple(_limit(found for path in paths for found in _at(path, result, submission)))


def may_have_pictures(result: Result) -> bool:
    """Return whether pictures of the submission may belong to a criterion."""
    without_file = _is_question(result) and result.outcome.location is None
    return bool(_files(result)) or _is_evidence(result) or without_file


def is_empty(result: Result, report: Report) -> bool:
    """Return whether there is nothing to read for a criterion: no answer, no PDF and no picture that may be one.

    Of evidence: no file that may be it.
    """
    if not (_is_evidence(result) or _is_question(result)) or result.outcome.problem not in NO_ANSWER:
        return False
    if _is_question(result):
        return not _loose_files(report)
    return not any((report.other_pictures, *(files for one in report.evidence for files in (one.files, one.possible))))


def content_of(result: Result, report: Report) -> str:
    """Return the written answer without empty lines, if it is all that there is to read; else an empty text."""
    found, is_certain = result.outcome.measured, not result.outcome.problem
    if not (_is_question(result) and isinstance(found, str) and is_certain) or _loose_files(report):
        return ""
    is_whole = not any(sign in found for sign in (PICTURE, "![", "]("))
    return "\n".join(filter(None, map(str.rstrip, found.splitlines()))) if is_whole else ""


def _loose_files(report: Report) -> tuple[EvidenceFile, ...]:
    """Return the files that may hold a part of an answer: PDF files, and pictures that are no evidence."""
    evidence = (result for result in report.results if _is_evidence(result) and not result.outcome.problem)
    named = {path for result in evidence for path in evidence_files(result)}
    listed = (file for one in report.evidence for files in (one.files, one.possible) for file in files)
    others = (file for file in report.other_pictures if file.path not in named)
    return (*others, *(file for file in (*listed, *report.other_pictures) if file.path.lower().endswith(".pdf")))


def _is_question(result: Result) -> bool:
    return result.criterion.check.function is answered


def _is_evidence(result: Result) -> bool:
    return result.criterion.check.function is evidence_shown


def evidence_files(result: Result) -> tuple[str, ...]:
    """Return the paths of the files of evidence, also where it takes the place of a URDF.

    What other checks measure, such as a vector or names, is no list of files.
    """
    measured, is_open = result.outcome.measured, result.outcome.status == "pending"
    if not isinstance(measured, tuple | list) or not (_is_evidence(result) or is_open):
        return ()
    return tuple(name for name in measured if isinstance(name, str))


def _files(result: Result) -> tuple[str, ...]:
    """Return the paths of the files of evidence, of the PDF of an answer, or of the document with pictures in it."""
    if files := evidence_files(result):
        return files
    place = result.outcome.location
    if place is None or not _is_question(result):
        return ()
    shown = CONVERTED if PICTURE in str(result.outcome.measured) else (".pdf",)
    return (place.path,) if place.path.lower().endswith(shown) else ()


def _at(path: str, result: Result, submission: Submission) -> Iterator[EmbeddedPicture | NotShown]:
    file = submission.whole_tree.files.get(path) or submission.tree.files.get(path)
    if file is None:
        yield NotShown(path, "it is no longer in the submission")
    elif file.suffix not in CONVERTED:
        yield read_picture(file)
    elif file.suffix == ".pdf":
        yield from _in_pdf(file, result, submission.readable_documents)
    elif submission.readable_documents is None:
        yield NotShown(path, "documents of this submission are not read: open it yourself")
    else:
        yield from _in_document(file, result, submission.readable_documents)


def _in_pdf(file: File, result: Result, documents: DocumentCollection | None) -> Iterator[EmbeddedPicture | NotShown]:
    """Yield the pictures in a PDF that belong to a criterion, and the PDF, which the browser opens on their page."""
    document = documents.document(file) if documents is not None else None
    page = 1
    if documents is not None and isinstance(document, Document):
        has_pictures = _is_evidence(result) or PICTURE in str(result.outcome.measured)
        found = _in_document(file, result, documents) if has_pictures else ()
        yield from (one for one in found if isinstance(one, EmbeddedPicture))
        page = document.page(_spans(document, result, documents)[0][0]) or 1
    shown = read_picture(file)
    yield shown._replace(page=page) if isinstance(shown, EmbeddedPicture) else shown


def _in_document(file: File, result: Result, documents: DocumentCollection) -> Iterator[EmbeddedPicture | NotShown]:
    document = documents.document(file)
    if not isinstance(document, Document):
        yield NotShown(file.path, document.reason if document is not None else "it has no answers")
        return
    numbers = {number for start, end in _spans(document, result, documents) for number in document.pictures(start, end)}
    try:
        found = [found for found in documents.pictures(file) if found[0] in numbers] if numbers else []
    except InputError as error:
        yield NotShown(file.path, str(error))
        return
    for number, data in found:
        if data:  # else a copy of a picture that is shown
            yield verified(data, document.picture_words(number))
    if numbers != {number for number, _ in found} or not numbers:
        reason = "it has pictures that cannot be extracted" if numbers else "no picture was found in it"
        yield NotShown(file.path, f"{reason}: open it yourself")


def _spans(document: Document, result: Result, documents: DocumentCollection) -> list[tuple[int, int]]:
    """Return the ranges of lines whose pictures belong to a criterion: the first line, and the line after the last."""
    criterion, outcome = result.criterion, result.outcome
    if isinstance(outcome.measured, str) and outcome.location is not None:
        start = outcome.location.line - 1
        return [(start, start + len(outcome.measured.split("\n")))]
    heads: list[tuple[Document, Heading]] = []
    if _is_evidence(result):
        heads = headed(documents, criterion.arguments["names"])
    spans = [(head.start, _last(document, head)) for other, head in heads if other is document]
    return spans or [(0, len(document.lines))]


def _last(document: Document, head: Heading) -> int:
    """Return the end of the lines below a heading, without empty lines at the end, which may be on the next page."""
    end = head.end
    while end > head.start + 1 and not document.lines[end - 1].strip():
        end -= 1
    return end


def _limit(found: Iterable[EmbeddedPicture | NotShown]) -> Iterator[EmbeddedPicture | NotShown]:
    """Yield pictures up to the limits for one criterion, then a notice that there are more."""
    left = _MAX_BYTES
    for count, one in enumerate(found):
        left -= len(one.data) if isinstance(one, EmbeddedPicture) else 0
        if count >= _MAX_PICTURES or left < 0:
            yield NotShown("more pictures", f"only the first {count} are shown: open the others yourself")
            return
        yield one
