"""Pictures that are saved beside a Markdown report are shown in it; job summaries name them."""

from pathlib import Path
from urllib.parse import unquote

import pytest

from tests.command_line import ROOT, run, run_with_input
from tests.report.readers import read_as_github, read_markdown, read_svg

BURIED = "submissions/lab6/lidar-buried/my_robot/urdf/my_robot.urdf"


def images(markdown: Path) -> list[tuple[str, str]]:
    """Return the address and the alternative text of the images that GitHub shows of a file."""
    text = markdown.read_text(encoding="utf-8")
    found = [(image.get("src"), image.get("alt")) for image in read_as_github(text).iter("img")]
    assert len([token for token in read_markdown(text) if token.type == "image"]) == len(found)
    return found


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
    files = [tmp_path / markdown, tmp_path / picture]
    for file in files:
        file.parent.mkdir(exist_ok=True)
    run(("grade", BURIED, "--save", f"markdown={files[0]}", "--save", f"svg={files[1]}"))
    ((src, alt),) = images(files[0])
    assert src == address
    assert (files[0].parent / unquote(src)).resolve() == files[1].resolve()
    assert alt.startswith(
        "Top, side and front view of the robot. 1: lidar: 8 points lost, lidar-frame and lidar-on-top"
    )
    text = files[0].read_text(encoding="utf-8")
    assert text.index("![") < text.index("## Failed")
    read_svg(files[1].read_text(encoding="utf-8"))


def test_markdown_without_a_file_beside_it_shows_none(tmp_path: Path) -> None:
    """On standard output, without an SVG, without a robot, and where the SVG is written to a device."""
    report, picture = tmp_path / "r.md", tmp_path / "r.svg"
    printed = run(("grade", BURIED, "--format", "markdown", "--save", f"svg={picture}"))
    assert b"![" not in printed.stdout
    run(("grade", BURIED, "--save", f"markdown={report}"))
    assert images(report) == []
    run(("grade", "submissions/lab6/pictures-only", "--save", f"markdown={report}", "--save", f"svg={picture}"))
    assert images(report) == []
    run(("grade", BURIED, "--save", f"markdown={report}", "--save", "svg=/dev/null"))
    assert images(report) == []


def test_name_of_a_link_is_no_markup_in_the_words_of_the_picture(tmp_path: Path) -> None:
    """The words name links that the picture does not show."""
    report = tmp_path / "r.md"
    text = (
        '<robot name="r"><link name="a"/><link name="x](http://e.org)![y](z)&lt;img src=q&gt;"><visual><geometry>'
        '<mesh filename="m.stl"/></geometry></visual></link><joint name="j" type="fixed"><parent link="a"/>'
        '<child link="x](http://e.org)![y](z)&lt;img src=q&gt;"/></joint></robot>'
    )
    run_with_input(("grade", "-", "--save", f"markdown={report}", "--save", f"svg={tmp_path / 'r.svg'}"), text.encode())
    ((src, alt),) = images(report)
    assert src == "r.svg"
    assert "x](http://e.org)![y](z)<img src=q>" in alt


def test_job_summary_names_the_pictures(tmp_path: Path) -> None:
    """GitHub shows no picture there: a line names the files, and no folder outside of the checkout."""
    summary = tmp_path / "summary.md"
    saves = [part for kind in ("svg", "html") for part in ("--save", f"{kind}={tmp_path / f'report.{kind}'}")]
    variables = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(summary)}
    run(("grade", BURIED, *saves), **variables)
    text = summary.read_text(encoding="utf-8")
    assert "Pictures of the robot: `report.svg` and `report.html` (in the artifacts of this run" in text
    assert (str(tmp_path) in text, images(summary)) == (False, [])
    summary.unlink()
    run(("grade", BURIED), **variables)
    assert "as a picture" not in summary.read_text(encoding="utf-8")


def test_reports_of_a_class_show_the_pictures_beside_them(tmp_path: Path) -> None:
    """NAME.md shows NAME.svg, also where the name has characters that mean something in Markdown."""
    for name in ("Ash", "Birch (1) [x]"):
        folder = tmp_path / "class" / name
        folder.mkdir(parents=True)
        (folder / "my_robot.urdf").write_text((ROOT / BURIED).read_text(encoding="utf-8"), encoding="utf-8")
    reports = tmp_path / "reports"
    formats = ("--report-format", "markdown", "--report-format", "svg")
    run(("batch", tmp_path / "class", "--gradebook", tmp_path / "book.db", "--reports", reports, *formats))
    found = sorted(reports.glob("*.md"))
    assert len(found) == 2
    for file in found:
        ((src, _),) = images(file)
        assert (file.parent / unquote(src)) == file.with_suffix(".svg")
        assert file.with_suffix(".svg").exists()
