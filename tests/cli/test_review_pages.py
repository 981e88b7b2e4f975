"""What the page of a review shows to judge by: the robot, the lines of the file, documents, and the list of students."""

import re
import shutil
import stat
import webbrowser
from collections.abc import Callable, Iterator
from pathlib import Path
from threading import Event
from urllib.parse import unquote, urlsplit

import pytest

from grader.report.open_browser import opened_in_browser
from tests.checks.submissions import png
from tests.classroom.gradebooks import grader
from tests.command_line import HANG_TIMEOUT
from tests.review_server import Review, marks_in, rows_of, running
from tests.samples import ROOT

PACKAGE = ROOT / "submissions/lab6/reference/roscourse_sim_ws/src/my_robot"
URDF, SETUP = "urdf/my_robot.urdf", "setup.py"
NAMES = {"ash": "Ada Ash", "birch": "Ben Birch", "cedar": "Zebulon Cedar", "dogwood": "Dan Dogwood"}


def _unknown_size(package: Path) -> None:
    """Make a size of the robot depend on the machine."""
    text = (package / URDF).read_text().replace('size="0.6 0.4 0.2"', 'size="$(env SIDE) 0.4 0.2"')
    (package / URDF).unlink()
    text = text.replace("<robot ", '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" ')
    (package / f"{URDF}.xacro").write_text(text)


def _unknown_build(package: Path) -> None:
    """Make what setup.py installs depend on the machine."""
    text = (package / SETUP).read_text()
    (package / SETUP).write_text(
        text.replace("setup(", "import os\n\nfiles = os.popen('ls').read()\nsetup(\n    *files,", 1)
    )


def _no_package(package: Path) -> None:
    """Leave a robot and a picture, and an answer without a heading."""
    for path in package.iterdir():
        if path.name != "urdf":
            shutil.rmtree(path) if path.is_dir() else path.unlink()
    (package.parent / "Task2_Step6.png").write_bytes(png(640, 400))
    (package.parent / "answers.md").unlink()
    (package.parent / "answers.txt").write_text("Zebulon's words\n\nThe link lidar vanishes.\n")


def _change_nothing(package: Path) -> None:
    """Leave the package as it is."""
    assert package.is_dir()


@pytest.fixture(scope="module")
def graded(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a class of four: no package, an unknown size, an unknown build, and nothing unusual."""
    top = tmp_path_factory.mktemp("pages")
    changes: dict[str, Callable[[Path], None]] = {
        "ash": _unknown_size,
        "birch": _unknown_build,
        "cedar": _no_package,
        "dogwood": _change_nothing,
    }
    for key, change in changes.items():
        package = Path(shutil.copytree(PACKAGE, top / "class" / key / "my_robot"))
        (package.parent / "answers.md").write_text(
            f"# Task 1 Step 15\n\nOf {key}\n\n# Task 2 Step 2\n\nOf {key}\n"
        )
        change(package)
    rows = [f"{key},{name},{number}\n" for number, (key, name) in enumerate(NAMES.items(), 100)]
    (top / "roster.csv").write_text("".join(["id,name,moodle id\n", *rows]))
    done = grader(
        "batch",
        top / "class",
        "--roster",
        top / "roster.csv",
        "--gradebook",
        top / "book",
        "--jobs",
        2,
    )
    assert done.returncode == 0, done.stderr
    return top


@pytest.fixture
def book(graded: Path, tmp_path: Path) -> Path:
    """Return a copy of the gradebook, beside its class."""
    return Path(shutil.copytree(graded, tmp_path / "copy"), "book")


@pytest.fixture
def review(book: Path) -> Iterator[Review]:
    """Yield a review of the class."""
    with running(book) as served:
        yield served


def addresses(review: Review) -> dict[tuple[str, str], str]:
    """Return the address of each item that is shown, by its student and its first criterion."""
    found, address = {}, review.post("end", {"do": "again"}).json["go"]
    while address != "end":
        page = review.get(address).text
        found[who(page), what(page)] = address
        address = review.post(address, {"do": "next"}).json["go"]
    return found


def who(page: str) -> str:
    """Return the student of a page, of several the first."""
    names = re.findall(r'(?s)<ul class="members">\n<li>(.*?)</li>', page) or re.findall(
        r"<h1>(.*)</h1>", page
    )
    return str(names[0]).partition(" ")[0]


def what(page: str) -> str:
    """Return the first criterion of a page."""
    return str(re.findall(r'<code class="id">(.*?)</code>', page)[0])


@pytest.mark.slow
def test_criteria_that_are_open_for_one_reason_are_one_item(review: Review) -> None:
    """Of one student, as those that need the size, the build or the package; each question is an item of its own."""
    shown = {key for key in addresses(review) if not key[1].startswith(("answer", "evidence"))}
    assert shown >= {("Ada", "urdf-loads"), ("Ben", "setup-imports"), ("Zebulon", "package-found")}
    assert (
        [name for name, _ in shown].count("Ada")
        == [name for name, _ in shown].count("Zebulon")
        == 1
    )


@pytest.mark.slow
def test_a_robot_is_seen_with_the_lines_that_decide(review: Review) -> None:
    """The three views, the message, the file around the place: of the URDF, of setup.py; without a file, the pictures."""
    found = addresses(review)
    size = review.get(found["Ada", "urdf-loads"]).text
    for text in (
        "The environment variable SIDE is known only at run time",
        "side (from -y)",
        "my_robot.urdf.xacro:",
    ):
        assert text in size, text
    assert re.search(r"<mark>size=&#34;\$\(env SIDE\) 0\.4 0\.2&#34;</mark>", size)
    build = review.get(found["Ben", "setup-imports"]).text
    assert re.search(r'class="line-number">\d+</span>files = <mark>os\.popen</mark>', build)
    assert "side (from -y)" in build
    none = review.get(found["Zebulon", "package-found"]).text
    assert "side (from -y)" in none and 'class="file"' not in none
    assert none.count("<figure>") == 1


@pytest.mark.slow
def test_a_mark_of_an_item_gives_each_criterion_its_points(review: Review, book: Path) -> None:
    """A word for each; another number of words marks nothing, and `-` for each withdraws all."""
    address = addresses(review)["Ben", "setup-imports"]
    page = review.get(address).text
    most = re.findall(r'<input id="each-([\w-]+)" data-most="(\d+)"', page)
    assert f"0 to {sum(int(value) for _, value in most)} for all {len(most)} criteria" in page
    for wrong in ("7", "", " ".join(["1"] * (len(most) + 1))):
        assert "points are missing" in review.mark(address, wrong)["error"]
    assert (
        "is worth 0 to" in review.mark(address, " ".join(["1"] * (len(most) - 1) + ["9"]))["error"]
    )
    assert rows_of(book) == []
    given = ["0", *(value for _, value in most[1:])]
    assert "go" in review.mark(address, " ".join(given), "seen in the lab")
    assert sorted(marks_in(book)) == sorted(
        ("birch", name, points, "seen in the lab")
        for (name, _), points in zip(most, given, strict=True)
    )
    total = sum(map(int, given))
    assert f"<strong>Marked:</strong> {total} points by Kim" in review.get(address).text
    assert f'"each":{given}'.replace("'", '"').replace(" ", "") in review.get(address).text
    review.mark(address, " ".join(["-"] * len(most)))
    assert marks_in(book) == []


@pytest.mark.slow
def test_an_item_is_marked_as_it_was_shown(review: Review, book: Path) -> None:
    """If one of its criteria is marked elsewhere, nothing is saved, and the item has that one no more."""
    address = addresses(review)["Ben", "setup-imports"]
    seen, page = review.seen(address), review.get(address).text
    names = re.findall(r'<input id="each-([\w-]+)"', page)
    assert (
        grader("mark", "birch", names[-1], "0", "--gradebook", book, "--by", "Lee").returncode == 0
    )
    assert "has changed" in review.mark(address, " ".join(["1"] * len(names)), **seen)["error"]
    assert rows_of(book) == []
    assert re.findall(r'<input id="each-([\w-]+)"', review.get(address).text) == names[:-1]
    assert (
        review.post(
            "end", {"do": "filter", "criterion": names[-1], "section": "", "state": ""}
        ).status
        == 200
    )
    all_marked = review.get(addresses(review)["Ben", names[-1]]).text
    assert 'class="each"' not in all_marked


@pytest.mark.slow
def test_documents_are_shown_where_no_answer_was_found(review: Review) -> None:
    """An answer without the expected heading is read on the page, not searched for in a zip."""
    found = addresses(review)
    page = next(
        review.get(at).text
        for (name, question), at in found.items()
        if name == "Zebulon" and "answer" in question
    )
    assert "<h2>Documents</h2>" in page
    assert (
        "<p>[answers.txt: without a heading of this question]</p>" in page
        and "<p>The link lidar vanishes.</p>" in page
    )


def test_the_list_of_students(review: Review, book: Path) -> None:
    """Each with what is left and the address of an item, of the same question where there is one; of a question only its students."""
    found = addresses(review)
    address = found["Ben", "setup-imports"]
    people = {
        label: (left, to) for label, left, to in review.get(f"{address}/people").json["people"]
    }
    assert list(people) == [
        f"{name} ({key})" for key, name in sorted(NAMES.items(), key=lambda item: item[1])
    ]
    assert people["Ben Birch (birch)"][1] == address
    assert people["Zebulon Cedar (cedar)"][0] > people["Dan Dogwood (dogwood)"][0]
    assert (
        review.post(address, {"do": "go", "to": people["Ada Ash (ash)"][1]}).json["go"]
        == found["Ada", "urdf-loads"]
    )
    assert review.post(address, {"do": "go", "to": "99999"}).status == 400
    assert review.get("99999/people").status == 404
    mark = " ".join(
        ["0"] * len(re.findall("data-most", review.get(address).text.partition("<script")[0]))
    )
    review.mark(address, mark)
    after = {label: left for label, left, _ in review.get("end/people").json["people"]}
    assert after["Ben Birch (birch)"] == people["Ben Birch (birch)"][0] - len(mark.split())
    review.post("end", {"do": "filter", "criterion": "urdf-loads", "section": "", "state": ""})
    assert [label for label, *_ in review.get("end/people").json["people"]] == ["Ada Ash (ash)"]


@pytest.mark.slow
def test_next_question_goes_through_one_student(review: Review) -> None:
    """After the last one comes the first of the next student by name; a mark can be followed by it as well."""
    found, seen = addresses(review), []
    address = found["Ada", "urdf-loads"]
    while address != "end":
        seen.append((who(review.get(address).text), address))
        address = review.post(address, {"do": "question"}).json["go"]
    assert [name for name, _ in seen] == sorted(name for name, _ in seen)
    assert {address for _, address in seen} == {*found.values()}
    assert review.post("end", {"do": "question"}).json == {"go": "end"}
    first, then = [address for name, address in seen if name == "Dan"][:2]
    assert review.mark(first, "0", to="question") == {"go": then}


@pytest.mark.slow
def test_anonymous_items_name_nothing(book: Path) -> None:
    """The views have no names of links and no sentences about them, and there are no lines of files."""
    with running(book, is_anonymous=True) as served:
        pages = [served.get(address).text for address in addresses(served).values()]
        people = served.get("end/people").json["people"]
    assert [label for label, *_ in people] == [f"submission {number}" for number in (1, 2, 3, 4)]
    assert sum("side (from -y)" in page for page in pages) >= 3
    for page in pages:
        shown = page.partition("<main")[2].partition("<script>")[0]  # with the data
        assert "left_wheel" not in shown and 'class="file"' not in shown
        assert not [name for name in ("cedar", "answers.txt", "my_robot.urdf") if name in shown]


def test_the_class_leads_to_its_lms(review: Review) -> None:
    """The end has the command for Moodle, whose ids the roster has."""
    assert "grader export moodle --gradebook " in review.get("end").text


class _Browser(webbrowser.BaseBrowser):
    """A browser that reads the file that it opens."""

    def __init__(self) -> None:
        super().__init__("test")
        self.text, self.mode, self.is_open = "", 0, Event()

    def open(self, url: str, new: int = 0, autoraise: bool = True) -> bool:
        """Read a file."""
        del new, autoraise
        file = Path(unquote(urlsplit(url).path))
        self.text, self.mode = file.read_text(), stat.S_IMODE(file.stat().st_mode)
        self.is_open.set()
        return True


def test_no_process_has_the_secret_as_argument(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The browser gets a private file that leads to the address, and that goes with the review."""
    browser, file = _Browser(), tmp_path / "open-review.html"
    monkeypatch.setattr(webbrowser, "get", lambda *_: browser)
    monkeypatch.setattr(webbrowser, "open", browser.open)
    with opened_in_browser("http://127.0.0.1:1/secret/1", file) as is_open:
        assert is_open
        assert browser.is_open.wait(HANG_TIMEOUT)
    assert "url=http://127.0.0.1:1/secret/1" in browser.text
    assert browser.mode == 0o600
    assert not file.exists()


@pytest.mark.parametrize(
    "found", [webbrowser.GenericBrowser("w3m"), webbrowser.Error("no browser")]
)
def test_a_browser_of_the_terminal_is_not_opened(
    found: object, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It would take the terminal away from the command; the same without any browser."""

    def get() -> object:
        if isinstance(found, Exception):
            raise found
        return found

    monkeypatch.setattr(webbrowser, "get", get)
    monkeypatch.setattr(webbrowser, "open", lambda *_: pytest.fail("opened"))
    with opened_in_browser("http://127.0.0.1:1/secret/1", tmp_path / "open-review.html") as is_open:
        assert not is_open
    assert [*tmp_path.iterdir()] == []
