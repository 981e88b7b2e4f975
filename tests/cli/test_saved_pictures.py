"""Pictures that are saved beside a Markdown report are shown in it."""

from pathlib import Path
from urllib.parse import unquote

import pytest

from tests.command_line import ROOT, run
from tests.report.readers import read_as_github, read_markdown

BURIED = ROOT / "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf"


def image(markdown: Path) -> str:
    """Return the address of the one image that GitHub shows of a file."""
    text = markdown.read_text(encoding="utf-8")
    ((src, alt),) = ((image.get("src"), image.get("alt")) for image in read_as_github(text).iter("img"))
    assert len([token for token in read_markdown(text) if token.type == "image"]) == 1
    assert text.index("![") < text.index("## Failed")
    assert alt.startswith("Top, side and front view of the robot. 1: lidar: 8 points lost")
    return str(src)


@pytest.mark.parametrize(
    ("markdown", "picture", "address"),
    [
        ("r.md", "r.svg", "r.svg"),
        ("r.md", "a b/x)[(y.svg", "a%20b/x%29%5B%28y.svg"),
        ("md/r.md", "svg/r.svg", "../svg/r.svg"),
    ],
)
def test_markdown_shows_the_picture_beside_it(tmp_path: Path, markdown: str, picture: str, address: str) -> None:
    """By a relative link that leads to the file, with what is to be seen in words, before the first failure."""
    report, drawing = tmp_path / markdown, tmp_path / picture
    for file in (report, drawing):
        file.parent.mkdir(exist_ok=True)
    run(("grade", BURIED, "--save", f"markdown={report}", "--save", f"svg={drawing}"))
    assert image(report) == address
    assert (report.parent / unquote(address)).resolve() == drawing.resolve()


def test_reports_of_a_class_show_the_pictures_beside_them(tmp_path: Path) -> None:
    """NAME.md shows NAME.svg, also where the name has characters that mean something in Markdown."""
    for name in ("Ash", "Birch (1) [x]"):
        (tmp_path / "class" / name).mkdir(parents=True)
        (tmp_path / "class" / name / "my_robot.urdf").write_bytes(BURIED.read_bytes())
    formats = ("--report-format", "markdown", "--report-format", "svg", "--reports", tmp_path / "reports")
    run(("batch", tmp_path / "class", "--gradebook", tmp_path / "book", *formats))
    found = sorted((tmp_path / "reports").glob("*.md"))
    assert [file.parent / unquote(image(file)) for file in found] == [file.with_suffix(".svg") for file in found]
    assert len(found) == 2
