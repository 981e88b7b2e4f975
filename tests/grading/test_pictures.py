"""The pictures of a criterion: files and pictures in documents, of the heading or answer that it is about."""

import io
from dataclasses import replace
from decimal import Decimal

import pytest

from grader.base.source import Location
from grader.lab.checks.loading import urdf_loads
from grader.lab.checks.manual import answered, evidence_shown
from grader.lab.checks.outcome import Outcome
from grader.lab.checks.registry import own_checks
from grader.lab.documents.pictures import EmbeddedPicture
from grader.lab.grading.criterion_pictures import find_pictures, may_have_pictures
from grader.lab.grading.report import Result
from grader.lab.rubric.criterion import Criterion
from grader.lab.submission.submission import Opening
from tests.checks.submissions import Submitted, gif, png
from tests.conversion import convert_here

pytestmark = pytest.mark.slow


@pytest.fixture(autouse=True)
def _convert_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.lab.documents.collection.DocumentCollection._run", convert_here)


STEP_8, STEP_18 = png(8, 8), png(18, 18)
CHECKS = {check.function: check for check in own_checks()}


def shown(files: dict[str, bytes], names: list[str]) -> list[str]:
    """Return the pictures of the evidence with these labels, as words."""
    submission = Submitted(files).submission
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[evidence_shown], {"names": names})
    found = find_pictures(Result(criterion, evidence_shown(submission, names=names)), submission)
    return [one.where if isinstance(one, EmbeddedPicture) else str(one) for one in found]


def in_answer(files: dict[str, bytes], place: str) -> list[str]:
    """Return the pictures of the answer at a place, as words."""
    submission = Submitted(files).submission
    arguments = {"question": "Why?", "places": [place]}
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[answered], arguments)
    outcome = answered(submission, question="Why?", places=[place])
    found = find_pictures(Result(criterion, outcome), submission)
    return [one.where if isinstance(one, EmbeddedPicture) else str(one) for one in found]


def word(*paragraphs: str | bytes) -> bytes:
    """Return a Word file; bytes are pictures."""
    document = pytest.importorskip("docx").Document()
    for text in paragraphs:
        if isinstance(text, bytes):
            document.add_paragraph().add_run().add_picture(io.BytesIO(text))
        elif text.startswith("#"):
            document.add_heading(text.lstrip("# "), 1)
        else:
            document.add_paragraph(text)
    data = io.BytesIO()
    document.save(data)
    return data.getvalue()


def image(
    width: int, samples: bytes, colours: str, more: str = "/Filter/FlateDecode", bits: int = 8
) -> bytes:
    """Return the object of an image of one row in a PDF."""
    head = f"<</Type/XObject/Subtype/Image/Width {width}/Height 1/ColorSpace{colours}/BitsPerComponent {bits}{more}"
    return f"{head}/Length {len(samples)}>>\nstream\n".encode() + samples + b"\nendstream"


def pages(*images: bytes, texts: tuple[str, ...] = ()) -> bytes:
    """Return a PDF with a page for each image; each has a text above it."""
    objects = [
        b"<</Type/Catalog/Pages 2 0 R>>",
        b"",
        b"<</Type/Font/Subtype/Type1/BaseFont/Helvetica>>",
    ]
    kids = []
    for number, data in enumerate(images):
        at = len(objects) + 1
        kids.append(f"{at} 0 R")
        content = f"BT /F1 12 Tf 50 800 Td ({texts[number] if texts else 'Page'}) Tj ET q 9 0 0 9 9 9 cm /Im1 Do Q".encode()
        resources = f"/Font<</F1 3 0 R>>/XObject<</Im1 {at + 2} 0 R>>"
        page = f"<</Type/Page/Parent 2 0 R/MediaBox[0 0 595 842]/Resources<<{resources}>>/Contents {at + 1} 0 R>>"
        stream = f"<</Length {len(content)}>>\nstream\n".encode() + content + b"\nendstream"
        objects += [page.encode(), stream, data]
    objects[1] = f"<</Type/Pages/Kids[{' '.join(kids)}]/Count {len(kids)}>>".encode()
    text, offsets = b"%PDF-1.4\n", []
    for number, data in enumerate(objects, start=1):
        offsets.append(len(text))
        text += f"{number} 0 obj\n".encode() + data + b"\nendobj\n"
    table = "".join(f"{offset:010} 00000 n \n" for offset in offsets)
    end = f"trailer\n<</Size {len(objects) + 1}/Root 1 0 R>>\nstartxref\n{len(text)}\n%%EOF\n"
    return text + f"xref\n0 {len(objects) + 1}\n0000000000 65535 f \n{table}{end}".encode()


def test_files_with_the_label() -> None:
    """Every file that the outcome names; one that is no picture is named with the reason."""
    files = {
        "Task1_Step8.png": STEP_8,
        "Task1_Step8 (1).gif": gif(32, 24),
        "Task1_Step8.jpg": b"<svg onload='x'/>",
    }
    assert shown({**files, "Task1_Step18.png": STEP_18}, ["task 1 step 8"]) == [
        "Task1_Step8 (1).gif",
        "Task1_Step8.jpg: it is not a PNG, JPEG, GIF, WebP or BMP picture, nor a PDF: open it yourself, with care",
        "Task1_Step8.png",
    ]


def test_pictures_of_a_word_file() -> None:
    """All of them, in the order of their names, whatever heading they are below: the text does not say which is which."""
    report = word("# Task 1: Step 8", *(png(width, 8) for width in range(1, 12)))
    names = [f"image{number}.png in lab.docx" for number in range(1, 12)]
    assert shown({"lab.docx": report}, ["task 1 step 8"]) == names
    assert shown({"lab.docx": word("Task 1: Step 8")}, ["task 1 step 8"]) == []


def test_pictures_in_an_answer() -> None:
    """A written answer with a screenshot shows the pictures of the document."""
    report = word("# Step 15", "It vanishes:", STEP_8, "# Step 18", "text")
    assert in_answer({"lab.docx": report}, "step 15") == ["image1.png in lab.docx"]
    assert (
        in_answer({"lab.docx": word("# Step 15", "Two roots.", "# Step 18", STEP_18)}, "step 15")
        == []
    )
    assert in_answer({"lab.md": b"# Step 15\n\nIt [picture] vanishes.\n"}, "step 15") == []


def test_a_pdf_opens_on_the_page_of_its_heading() -> None:
    """It is shown as a whole, by the browser's own viewer."""
    pytest.importorskip("pypdf")
    report = pages(
        *[image(1, b"a", "/DeviceGray", "")] * 3,
        texts=("Task 1: Step 8", "Task 1: Step 18", "Task 3"),
    )
    submission = Submitted({"lab.pdf": report}).submission
    names = ["task 1 step 18"]
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[evidence_shown], {"names": names})
    (found,) = find_pictures(Result(criterion, evidence_shown(submission, names=names)), submission)
    assert isinstance(found, EmbeddedPicture)
    assert (found.where, found.page, found.data) == ("lab.pdf", 2, report)


@pytest.mark.parametrize(
    ("name", "data", "why"),
    [
        (
            "Task1_Step8.pdf",
            b"no PDF",
            "it is not a PNG, JPEG, GIF, WebP or BMP picture, nor a PDF: open it yourself, with care",
        ),
        ("Task1_Step8.docx", b"no zip", "cannot be read as an archive: File is not a zip file"),
        (
            "Task1_Step8.mp4",
            b"\0\0\0\x18ftypisom",
            "it is not a PNG, JPEG, GIF, WebP or BMP picture, nor a PDF: open it yourself, with care",
        ),
    ],
)
def test_what_is_not_shown_is_named(name: str, data: bytes, why: str) -> None:
    """A PDF that is none, a damaged document and a video."""
    assert shown({name: data}, ["task 1 step 8"]) == [f"{name}: {why.replace('lab.pdf', name)}"]


def test_limits_of_one_criterion() -> None:
    """Of very many pictures the first ones are shown, and it is said that there are more."""
    files = {f"Task1_Step8_{number:03}.png": STEP_8 for number in range(45)}
    found = shown(files, ["task 1 step 8"])
    assert len(found) == 41
    assert found[-1] == "more pictures: only the first 40 are shown: open the others yourself"


def test_without_a_name_all_pictures_are_shown() -> None:
    """Where no file is named for the evidence, the person sees all pictures; for another criterion none."""
    submission = Submitted(
        {"a.png": STEP_8, "b.gif": gif(3, 4), "answers.md": b"# Step 1\n\nNo.\n"}
    ).submission
    assert shown({"a.png": STEP_8, "b.gif": gif(3, 4)}, ["webcam"]) == ["a.png", "b.gif"]
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[answered], {})
    result = Result(
        criterion, Outcome("pending", "?", "No.", location=Location("answers.md", 1, 1))
    )
    assert not may_have_pictures(result)
    assert find_pictures(result, submission) == ()


def test_a_file_that_is_gone_is_named() -> None:
    """As after a new run that found another file."""
    submission = Submitted({"a.png": STEP_8}).submission
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[evidence_shown], {"names": ["a"]})
    (found,) = find_pictures(Result(criterion, Outcome("pending", "?", ("b.png",))), submission)
    assert str(found) == "b.png: it is no longer in the submission"


def test_a_document_in_place_of_a_robot_shows_all_its_pictures() -> None:
    """No heading is that of a criterion of the robot; a document that is not read for answers is shown all the same."""
    submission = Submitted({"lab.docx": word("# Task 1: Step 8", STEP_8, STEP_18)}).submission
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[urdf_loads], {})
    result = Result(criterion, Outcome("pending", "?", ("lab.docx",)))
    for opening in (submission.opening, Opening(no_documents="it took long")):
        assert len(find_pictures(result, replace(submission, opening=opening))) == 2
