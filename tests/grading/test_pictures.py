"""The pictures of a criterion: files and pictures in documents, of the heading or answer that it is about."""

import io
import zlib
from dataclasses import replace
from decimal import Decimal
from typing import Any

import pytest

from grader.checks.manual import answered, evidence_shown
from grader.checks.outcome import Outcome
from grader.checks.registry import own_checks
from grader.checks.tree import urdf_loads
from grader.documents.pictures import EmbeddedPicture
from grader.grading.criterion import Criterion
from grader.grading.pictures import may_have_pictures, pictures_of
from grader.grading.report import Result
from grader.source import Location
from grader.submission.submission import Opening
from tests.checks.submissions import Submitted, gif, png
from tests.conversion import convert_here


@pytest.fixture(autouse=True)
def _convert_here(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("grader.documents.collection.DocumentCollection._run", convert_here)


STEP_8, STEP_18 = png(8, 8), png(18, 18)
CHECKS = {check.function: check for check in own_checks()}


def shown(files: dict[str, bytes], names: list[str]) -> list[str]:
    """Return the pictures of the evidence with these labels, as words."""
    submission = Submitted(files).submission
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[evidence_shown], {"names": names})
    found = pictures_of(Result(criterion, evidence_shown(submission, names=names)), submission)
    return [one.words if isinstance(one, EmbeddedPicture) else str(one) for one in found]


def in_answer(files: dict[str, bytes], place: str) -> list[str]:
    """Return the pictures of the answer at a place, as words."""
    submission = Submitted(files).submission
    arguments = {"question": "Why?", "places": [place]}
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[answered], arguments)
    outcome = answered(submission, question="Why?", places=[place])
    found = pictures_of(Result(criterion, outcome), submission)
    return [one.words if isinstance(one, EmbeddedPicture) else str(one) for one in found]


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


def image(width: int, samples: bytes, colours: str, more: str = "/Filter/FlateDecode", bits: int = 8) -> bytes:
    """Return the object of an image of one row in a PDF."""
    head = f"<</Type/XObject/Subtype/Image/Width {width}/Height 1/ColorSpace{colours}/BitsPerComponent {bits}{more}"
    return f"{head}/Length {len(samples)}>>\nstream\n".encode() + samples + b"\nendstream"


def pages(*images: bytes, texts: tuple[str, ...] = ()) -> bytes:
    """Return a PDF with a page for each image; each has a text above it."""
    objects = [b"<</Type/Catalog/Pages 2 0 R>>", b"", b"<</Type/Font/Subtype/Type1/BaseFont/Helvetica>>"]
    kids = []
    for number, data in enumerate(images):
        at = len(objects) + 1
        kids.append(f"{at} 0 R")
        content = (
            f"BT /F1 12 Tf 50 800 Td ({texts[number] if texts else 'Page'}) Tj ET q 9 0 0 9 9 9 cm /Im1 Do Q".encode()
        )
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
    files = {"Task1_Step8.png": STEP_8, "Task1_Step8 (1).gif": gif(32, 24), "Task1_Step8.jpg": b"<svg onload='x'/>"}
    assert shown({**files, "Task1_Step18.png": STEP_18}, ["task 1 step 8"]) == [
        "Task1_Step8 (1).gif (32 x 24 pixels)",
        "Task1_Step8.jpg: its content is SVG, which can contain scripts: open it yourself, with care",
        "Task1_Step8.png (8 x 8 pixels)",
    ]


def test_pictures_below_a_heading_of_a_word_file() -> None:
    """Those of other steps are not shown; where no heading names a step, all are, because any may be meant."""
    report = word("# Task 1: Step 8", STEP_8, "# Task 1: Step 18", "text", STEP_18, gif(3, 4) + b"\0;")
    assert shown({"lab.docx": report}, ["task 1 step 8"]) == ["picture 1 in lab.docx (8 x 8 pixels)"]
    assert shown({"lab.docx": report}, ["task 1 step 18"]) == [
        "picture 2 in lab.docx (18 x 18 pixels)",
        "picture 3 in lab.docx (3 x 4 pixels)",
    ]
    loose = word("My lab", STEP_8, STEP_18)
    assert shown({"lab.docx": loose}, ["task 1 step 18"]) == [
        "picture 1 in lab.docx (8 x 8 pixels)",
        "picture 2 in lab.docx (18 x 18 pixels)",
    ]


def test_pictures_for_older_versions_of_word() -> None:
    """What Word repeats in an older form is shown once; a picture in the older form only is shown, too."""
    report = pytest.importorskip("docx").Document()
    run = report.add_paragraph().add_run()
    run.add_picture(io.BytesIO(STEP_8))
    other, _ = report.part.get_or_add_image(io.BytesIO(STEP_18))
    (same,) = [name for name, part in report.part.related_parts.items() if getattr(part, "blob", b"") == STEP_8]
    both = ["picture 1 in lab.docx (8 x 8 pixels)", "picture 3 in lab.docx (18 x 18 pixels)"]
    missing = "lab.docx: it has pictures that cannot be extracted: open it yourself"
    for names, expected in (((same, other), both), (("rId99",), [*both, missing])):
        for name in names:
            run._r.append(pict(name))
        data = io.BytesIO()
        report.save(data)
        assert shown({"lab.docx": data.getvalue()}, ["webcam"]) == expected


def pict(name: str) -> Any:
    """Return a picture in the form of older versions of Word."""
    from lxml.etree import fromstring

    spaces = {
        "w": "http://schemas.openxmlformats.org/wordprocessingml/2006/main",
        "v": "urn:schemas-microsoft-com:vml",
        "r": "http://schemas.openxmlformats.org/officeDocument/2006/relationships",
    }
    declared = " ".join(f'xmlns:{prefix}="{space}"' for prefix, space in spaces.items())
    return fromstring(f'<w:pict {declared}><v:shape><v:imagedata r:id="{name}"/></v:shape></w:pict>')


def test_pictures_in_an_answer() -> None:
    """A written answer with a screenshot shows it."""
    report = word("# Step 15", "It vanishes:", STEP_8, "# Step 18", STEP_18)
    assert in_answer({"lab.docx": report}, "step 15") == ["picture 1 in lab.docx (8 x 8 pixels)"]
    assert in_answer({"lab.docx": word("# Step 15", "Two roots.", "# Step 18", STEP_18)}, "step 15") == []
    assert in_answer({"lab.md": b"# Step 15\n\nIt [picture] vanishes.\n"}, "step 15") == []


@pytest.mark.parametrize("separator", ["\u2028", "\u2029", "\x85"])
def test_other_separators_are_no_lines(separator: str) -> None:
    """An answer with separators of Unicode does not show the pictures of the answer below it."""
    answer = separator.join(["It", "vanishes", "at", "once", "again"])
    report = word("# Step 15", STEP_8, answer, "# Step 18", "Two roots.", STEP_18)
    assert in_answer({"lab.docx": report}, "step 15") == ["picture 1 in lab.docx (8 x 8 pixels)"]


def test_pictures_of_a_pdf() -> None:
    """JPEG data is taken as it is; grey, RGB and palettes become PNG; other kinds, such as inverted samples, are named."""
    pytest.importorskip("pypdf")
    jpeg = b"\xff\xd8\xff\xc0\0\x11\x08\0\x02\0\x01\x03" + bytes(9) + b"\xff\xd9"
    kinds = {
        "page 1 of lab.pdf (1 x 2 pixels)": image(1, jpeg, "/DeviceRGB", "/Filter/DCTDecode"),
        "page 2 of lab.pdf (3 x 1 pixels)": image(3, zlib.compress(b"abc"), "/DeviceGray"),
        "page 3 of lab.pdf (2 x 1 pixels)": image(2, zlib.compress(b"abcdef"), "/DeviceRGB"),
        "page 4 of lab.pdf (2 x 1 pixels)": image(2, zlib.compress(b"\0\1"), "[/Indexed/DeviceRGB 1<ff000000ff00>]"),
        "page 5 of lab.pdf (1 x 1 pixels)": image(1, b"a", "/DeviceGray", ""),
        "page 6 of lab.pdf (1 x 1 pixels)": image(1, b"abc", "/DeviceRGB", "/Decode[0 1 0.0 1.0 0 1]"),
        "page 7 of lab.pdf (1 x 1 pixels)": image(1, b"\0", "[/Indexed/DeviceRGB 0<ff0000>]", "/Decode[0 255]"),
    }
    unknown = [
        image(1, zlib.compress(b"abcd"), "/DeviceCMYK"),
        image(9, zlib.compress(b"abc"), "/DeviceRGB"),
        image(1, b"x", "/DeviceRGB", "/Filter/JPXDecode"),
        image(1, jpeg, "/DeviceRGB", "/Filter/DCTDecode/Decode[1 0 1 0 1 0]"),
        image(1, b"a", "/DeviceGray", "/Decode[1 0]"),
        image(1, b"a", "/DeviceGray", "/Decode[0 255]"),
        image(1, b"\0", "[/Indexed/DeviceRGB 1<ff000000ff00>]", "/Decode[1 0]"),
        image(0, b"", "/DeviceRGB", ""),
        image(-1, b"", "/DeviceRGB", ""),
        image(10**9, b"", "/DeviceRGB", ""),
    ]
    found = shown({"lab.pdf": pages(*kinds.values(), *unknown)}, ["webcam"])
    assert found == [*kinds, "lab.pdf"]  # the document itself


def test_the_pages_below_a_heading_of_a_pdf() -> None:
    """Only pictures on the pages of the step are shown."""
    pytest.importorskip("pypdf")
    image_of = [image(width, bytes(width), "/DeviceGray", "") for width in (1, 2, 3)]
    report = pages(*image_of, texts=("Task 1: Step 8", "Task 1: Step 18", "Task 3: Step 3"))
    assert shown({"lab.pdf": report}, ["task 1 step 18"]) == ["page 2 of lab.pdf (2 x 1 pixels)", "lab.pdf"]


@pytest.mark.parametrize(
    ("name", "data", "why"),
    [
        (
            "Task1_Step8.pdf",
            b"no PDF",
            "it is not a PNG, JPEG, GIF, WebP or BMP picture, nor a PDF: open it yourself, with care",
        ),
        ("Task1_Step8.docx", b"no zip", "lab.pdf cannot be read; it may be damaged: open it yourself"),
        ("Task1_Step8.mp4", b"\0\0\0\x18ftypisom", "its content is a video: open it yourself, with care"),
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
    submission = Submitted({"a.png": STEP_8, "b.gif": gif(3, 4), "answers.md": b"# Step 1\n\nNo.\n"}).submission
    assert shown({"a.png": STEP_8, "b.gif": gif(3, 4)}, ["webcam"]) == ["a.png (8 x 8 pixels)", "b.gif (3 x 4 pixels)"]
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[answered], {})
    result = Result(criterion, Outcome("pending", "?", "No.", location=Location("answers.md", 1, 1)))
    assert not may_have_pictures(result)
    assert pictures_of(result, submission) == ()


def test_a_file_that_is_gone_is_named() -> None:
    """As after a new run that found another file."""
    submission = Submitted({"a.png": STEP_8}).submission
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[evidence_shown], {"names": ["a"]})
    (found,) = pictures_of(Result(criterion, Outcome("pending", "?", ("b.png",))), submission)
    assert str(found) == "b.png: it is no longer in the submission"


def test_a_document_in_place_of_a_robot_shows_all_its_pictures() -> None:
    """No heading is that of a criterion of the robot; a document whose pictures take too long to read is named."""
    submission = Submitted({"lab.docx": word("# Task 1: Step 8", STEP_8, STEP_18)}).submission
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[urdf_loads], {})
    result = Result(criterion, Outcome("pending", "?", ("lab.docx",)))
    assert len(pictures_of(result, submission)) == 2
    assert submission.readable_documents is not None
    submission.readable_documents._seconds = 0.0
    (found,) = pictures_of(result, submission)
    assert str(found).startswith("lab.docx: lab.docx was not read: the Word and PDF files take longer than ")


def test_documents_that_are_not_read_are_named() -> None:
    """Where reading them broke the grading, the person opens them."""
    submission = replace(
        Submitted({"Task1_Step8.docx": word("x")}).submission, opening=Opening(no_documents="it took long")
    )
    criterion = Criterion("it", "It", "task1", Decimal(1), CHECKS[evidence_shown], {"names": ["task 1 step 8"]})
    (found,) = pictures_of(Result(criterion, Outcome("pending", "?", ("Task1_Step8.docx",))), submission)
    assert str(found) == "Task1_Step8.docx: documents of this submission are not read: open it yourself"
