"""Evidence inside documents, and what is listed as perhaps meant."""

from collections.abc import Mapping

import pytest

from grader.lab.documents.evidence import FoundEvidence, find_evidence
from tests.checks.submissions import REFERENCE, URDF, Submitted, png
from tests.documents.files import PICTURE, docx, pdf

pytestmark = pytest.mark.slow

STEP_8 = ["task 1 step 8"]
WEBCAM = ["task 3 step 3", "task 3", "webcam", "camera"]
Files = Mapping[str, str | bytes]


def find(files: Files, names: list[str]) -> FoundEvidence:
    """Return the evidence with one of these names in a submission of some files."""
    submission = Submitted({URDF: REFERENCE.files[URDF], **files}).submission
    return find_evidence(submission.labelled_files, names, submission.readable_documents)


def words(files: Files, names: list[str]) -> tuple[list[str], list[str]]:
    """Return what is found and what is perhaps meant, in words and without sizes."""
    found = find(files, names)
    return tuple([file.words.partition(" (")[0] for file in found_files] for found_files in found)  # type: ignore[return-value]


def test_a_heading_in_a_pdf_is_named_with_its_page() -> None:
    """A heading with a picture on its pages is found; the file and the page are named."""
    data = pdf(
        ["Lab 6"],
        ["Task 1: Step 8", PICTURE, "Task 1: Step 18"],
        [PICTURE, "Task 3 - Step 3", PICTURE],
    )
    assert words({"report.pdf": data}, STEP_8) == (["Task 1: Step 8, page 2 of report.pdf"], [])
    assert words({"report.pdf": data}, ["task 1 step 18"]) == (
        ["Task 1: Step 18, page 2 of report.pdf"],
        [],
    )
    assert words({"report.pdf": data}, WEBCAM) == (["Task 3 - Step 3, page 3 of report.pdf"], [])
    assert words({"report.pdf": data}, ["task 1 step 36"]) == ([], [])
    (file,) = find({"report.pdf": data}, STEP_8).files
    assert (file.path, file.size, file.heading, file.page) == (
        "report.pdf",
        len(data),
        "Task 1: Step 8",
        2,
    )


def test_a_heading_in_a_word_file_is_named() -> None:
    """A heading in a Word file is found, with its page if Word has saved the pages."""
    plain = docx("Task 1", "Step 8", PICTURE, "Step 18", PICTURE)
    assert words({"a.docx": plain}, STEP_8) == (["Step 8 in a.docx"], [])
    paged = docx("Task 1", "Step 8", PICTURE, "\fStep 18", PICTURE)
    assert words({"a.docx": paged}, ["task 1 step 18"]) == (["Step 18, page 2 of a.docx"], [])
    titled = docx("The webcam in RViz", PICTURE)
    assert words({"a.docx": titled}, WEBCAM) == ([], ["a.docx"])


def test_a_heading_of_a_prelab_is_perhaps_meant() -> None:
    """A document that names the pre-lab shows no step of the lab for certain."""
    assert words({"prelab.pdf": pdf(["Task 1: Step 8", PICTURE])}, STEP_8) == (
        [],
        ["Task 1: Step 8, page 1 of prelab.pdf"],
    )


def test_a_heading_without_a_picture_is_perhaps_meant() -> None:
    """A heading without a picture below it may be a table of contents or an answer, and a plain number one of the handout."""
    assert words(
        {"a.docx": docx("Task 1: Step 8", "See below.", "Task 1: Step 18", PICTURE)}, STEP_8
    ) == (
        [],
        ["Task 1: Step 8 in a.docx"],
    )
    contents = pdf(
        ["Task 1: Step 8 ..... 2", "Task 1: Step 18 ..... 3"], ["Task 1: Step 8", PICTURE]
    )
    assert words({"a.pdf": contents}, STEP_8) == (["Task 1: Step 8, page 2 of a.pdf"], [])
    handout = pdf(["Task 1", "18. Put the lidar on the box.", PICTURE])
    assert words({"a.pdf": handout}, ["task 1 step 18"]) == (
        [],
        ["18. Put the lidar on the box., page 1 of a.pdf"],
    )
    mentioned = pdf(
        ["As you can see in the picture of task 1 step 8 it stands.", PICTURE, "Task 1: Step 18"]
    )
    assert words({"a.pdf": mentioned}, STEP_8) == ([], [])


def test_documents_that_cannot_be_searched_are_perhaps_meant() -> None:
    """A document of pictures without a heading, or one that cannot be read, may show anything."""
    assert words({"scan.pdf": pdf([PICTURE], [PICTURE])}, STEP_8) == ([], ["scan.pdf"])
    assert words({"scan.pdf": b"damaged"}, STEP_8) == ([], ["scan.pdf"])
    assert words({"notes.pdf": pdf(["No picture at all."])}, STEP_8) == ([], [])
    assert words({"Task1_Step18.pdf": pdf([PICTURE])}, STEP_8) == ([], [])


def test_a_long_heading_is_cut() -> None:
    """Only the beginning of a long heading is shown."""
    (file,) = find({"a.pdf": pdf(["Task 1: Step 8 " + "x" * 500, PICTURE])}, STEP_8).files
    assert file.words == f"Task 1: Step 8 {'x' * 42}..., page 1 of a.pdf"


# --- Several pieces of evidence -----------------------------------------------------------------------------------------

STEPS = [["task 1 step 8"], ["task 1 step 18"], ["task 2 step 6"], WEBCAM]


def offered(files: Files, names: list[list[str]] = STEPS) -> list[tuple[list[str], list[str]]]:
    """Return for each piece of evidence the files that are found, and those that are perhaps meant."""
    submission = Submitted({URDF: REFERENCE.files[URDF], **files}).submission
    found = [
        find_evidence(submission.labelled_files, one, submission.readable_documents)
        for one in names
    ]
    return [([it.path for it in one.files], [it.path for it in one.possible]) for one in found]


def test_a_file_may_be_meant_for_several_pieces() -> None:
    """A document of pictures for every piece, that of the prelab for none, and a picture for those of its step."""
    scan = pdf([PICTURE], [PICTURE])
    assert (
        offered({"report.pdf": scan, "prelab.pdf": scan, "Lab6 Pre-Lab.pdf": scan})
        == [([], ["report.pdf"])] * 4
    )
    assert offered({"report.pdf": scan, "Task1_Step8.png": png()})[:2] == [
        (["Task1_Step8.png"], []),
        ([], ["report.pdf"]),
    ]
    assert (
        offered({"step8.png": png()}, [["task 1 step 8"], ["task 2 step 8"]])
        == [([], ["step8.png"])] * 2
    )


def test_a_file_whose_headings_name_several_steps_is_offered_for_each() -> None:
    """A document is listed for each step that its headings name."""
    data = pdf(["Task 1: Step 8", PICTURE], ["Task 1: Step 18", PICTURE])
    assert offered({"report.pdf": data})[:2] == [(["report.pdf"], []), (["report.pdf"], [])]
    contents = docx("Task 1: Step 8", "See below.", "Task 1: Step 18", "See below.")
    assert offered({"a.docx": contents})[:2] == [([], ["a.docx"]), ([], ["a.docx"])]
