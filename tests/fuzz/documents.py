"""Harnesses of what is read of other files: archives, written answers, pictures and their names, downloads of a class."""

import io
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from grader.base.errors import InputError
from grader.classroom.intake.submissions import read_class
from grader.files.archive import read_archive
from grader.files.opening import archive_kind, with_inner
from grader.files.tree import Tree, make_tree
from grader.lab.documents.answers import find_answer
from grader.lab.documents.collection import DocumentCollection, TextDocument
from grader.lab.documents.evidence import DOCUMENTS, find_evidence, read_labelled_files
from grader.lab.documents.pictures import EmbeddedPicture, read_picture
from tests.checks.submissions import file_of, gif, jpeg, png
from tests.files.archives import FILES, MAKERS, LinkMember, make_tar, make_zip
from tests.fuzz.harness import GUARD, check_location, check_message, decoded, user_errors

_MAX_READ = 256 * 1024  # bytes of one file
_ENDINGS = (".md", ".txt", ".docx", ".pdf")
_QUESTIONS = (
    (
        "What happens if you start it now, and why?",
        ["task 1 step 15", "step 15", "required question 1 of 2", "question 1 of 2"],
    ),
    ("Name some nodes, and what they do.", ["task 2 step 2", "question 2 of 2", "nodes"]),
)
_EVIDENCE = (
    ["task 1 step 8"],
    ["task 1 step 18"],
    ["task 2 step 6"],
    ["task 3 step 3", "task 3", "webcam", "camera"],
)


def archive(data: bytes) -> None:
    """An archive is refused, or its files are below it, are read up to their limits."""
    kind = archive_kind(data[:512])
    if kind is None:
        return
    with user_errors():
        tree = with_inner(read_archive(io.BytesIO(data), kind, "lab6.zip"))
        _check_tree(tree)


def _check_tree(tree: Tree) -> None:
    for path, file in tree.files.items():
        assert path == file.path
        assert not path.startswith("/")
        assert not {"", ".", ".."} & {*path.split("/")}, path
        assert "\0" not in path
        with suppress(InputError):
            start = file.read(100, first=True)
            assert file.read(_MAX_READ).startswith(start)
    for ignored in tree.ignored:
        check_message(str(ignored))


def archives() -> Iterator[bytes]:
    """Yield small archives of every kind, with links, and one in another."""
    links = (
        LinkMember("l", "my_robot/urdf/my_robot.urdf"),
        LinkMember("m/n", "../my_robot"),
        LinkMember("up", "../../etc"),
    )
    yield from (make() for make in MAKERS.values())
    yield from (make_zip(links=links), make_tar(links=links), make_tar(links=links, kind="gz"))
    yield make_zip({"inner.tar.gz": make_tar(FILES, kind="gz"), "a.txt": b"a"})


def class_zip(data: bytes) -> None:
    """A class in a zip is refused, or each submission has a student and paths in it."""
    path = Path(GUARD.folder, "class.zip")
    path.write_bytes(data)
    with user_errors():
        intake = read_class([path], None, "auto", "", "lab6", ("lab6",))
        keys = [submission.student.key for submission in intake.submissions]
        assert len({*keys}) == len(keys)
        assert all(keys)
        for note in intake.notes:
            check_message(note)


def classes() -> Iterator[bytes]:
    """Yield zips as the layouts of a class make them."""
    urdf = b"<robot name='r'><link name='a'/></robot>"
    names = (
        ("ash/robot.urdf", "birch/robot.urdf"),
        (
            "ashann_101_9001_robot.urdf",
            "birchbo_LATE_102_9002_robot-1.urdf",
            "ashann_101_9003_answers.md",
        ),
        (
            "Ann Ash_5001_assignsubmission_file_/robot.urdf",
            "Bo Birch_5002_assignsubmission_file_/robot.urdf",
        ),
        ("submitted/ash/lab6/robot.urdf", "submitted/birch/lab6/robot.urdf"),
        ("team-1/ash/robot.urdf", "team-1/birch/robot.urdf", "team-2/cedar/robot.urdf"),
    )
    yield from (make_zip(dict.fromkeys(paths, urdf)) for paths in names)


def answers(data: bytes) -> None:
    """Answers are passages of their documents; the first byte says how the file's name ends."""
    path = f"answers{_ENDINGS[data[0] % len(_ENDINGS)] if data else '.md'}"
    file = file_of(path, data[1:])
    converted = data[1:].decode("utf-8", "replace")  # the text that a converter has written
    documents = DocumentCollection(make_tree("s", [file], ()), {path: converted})
    document = documents.document(file)
    lines = document.lines if isinstance(document, TextDocument) else []
    for question, places in _QUESTIONS:
        found = find_answer(
            documents, ("*.md", "*.txt", "*.docx", "*.pdf"), places, question
        ).passage
        if found is not None:
            check_message(found.where)
            check_location(found.location, {path: "\n".join(lines)})
            assert len(found.text) <= 40_000
    for heading in documents.headings(document) if isinstance(document, TextDocument) else ():
        assert 0 <= heading.start <= heading.end <= len(lines)
    for one in (find_evidence((), names, documents) for names in _EVIDENCE):
        assert {it.path for it in (*one.files, *one.possible)} <= {path}


def documents() -> Iterator[bytes]:
    """Yield answers under headings of many kinds."""
    for first, second in (
        *(
            ("# Task 1 Step 15", "# Task 2 Step 2"),
            ("**REQUIRED Question:**", "**REQUIRED Question:**"),
            ("Q1", "Q2"),
            ("1.", "2."),
        ),
        *(
            ("Task 1\n15)", "Task 2\n2)"),
            ("| Step 15 |", "| Step 2 |"),
            ("Answer to required question 1:", "Answer 2:"),
        ),
    ):
        yield (
            b"\0" + f"{first}\n\nIt has two roots.\n\n{second}\n\nrviz2 shows the robot.\n".encode()
        )
    yield b"\3Task 1 Step 15\nIt has two roots.\n\xef\xbf\xbc\n\x0c\nTask 2 Step 2\nrviz2.\n\xef\xbf\xbc\n"


def names(data: bytes) -> None:
    """Pictures are evidence by their names, and described in words."""
    paths = [line for line in dict.fromkeys(decoded(data).split("\n")[:40]) if line.strip("/.")]
    tree = make_tree("s", [file_of(path, b"") for path in paths], ())
    files = read_labelled_files(tree)
    documents = DocumentCollection(tree)
    documents._named[DOCUMENTS] = ([], [])
    for one in (find_evidence(files, names, documents) for names in _EVIDENCE):
        assert {it.path for it in (*one.files, *one.possible)} <= {*paths}
        for it in one.files:
            check_message(it.words)


def file_names() -> Iterator[bytes]:
    """Yield names of pictures, one in a line."""
    yield b"Task1_Step8.png\nTask 1/step18 (2).jpg\nT2S6.PNG\nwebcm.gif\na/b/camera.pdf\nstep 3.png"


def picture(data: bytes) -> None:
    """A picture has a format and a size, or the reason why it is not shown."""
    found = read_picture(file_of("a.png", data))
    if isinstance(found, EmbeddedPicture):
        assert found.kind.media_type
    else:
        check_message(str(found))


def pictures() -> Iterator[bytes]:
    """Yield the beginnings of pictures of every format."""
    yield from (
        png(),
        gif(),
        jpeg(),
        b"%PDF-1.4\n",
        b"BM" + bytes(12) + b"\x28\0\0\0\2\0\0\0\2\0\0\0" + bytes(30),
    )
    yield (
        jpeg()[:2]
        + b"\xff\xe1\x00\x1aExif\0\0MM\0*\0\0\0\x08\0\1\1\x12\0\3\0\0\0\1\0\6\0\0"
        + jpeg()[2:]
    )
    yield b"II*\0\x08\0\0\0\2\0\0\1\3\0\1\0\0\0\5\0\0\0\1\1\3\0\1\0\0\0\7\0\0\0"
    for chunk in (b"VP8 ", b"VP8L", b"VP8X"):
        yield b"RIFF\x20\0\0\0WEBP" + chunk + b"\x10\0\0\0" + bytes(range(1, 20))
