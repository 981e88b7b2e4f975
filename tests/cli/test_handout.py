"""`grader rubric show --format markdown`: the table of a lab's handout, for students."""

import re
from html import unescape
from pathlib import Path

import cmarkgfm
import pytest

from grader.grading.rubric import load_rubric, shipped_rubrics
from tests.command_line import run

RUBRIC = r"""
id = "lab0"
title = "Lab 0: <b>wheels</b> & @ash"
[[part]]
id = "a"
title = "The *model*"
[[part]]
id = "b"
title = "Answers"
needs = "files"
[[criterion]]
id = "a|b"
part = "a"
about = "The base | top"
title = "A box | 0.6 x 0.4, `[link](http://a.b)`"
points = 2.5
check = "shows_box"
with = { link = "secret_link", size = [1, 2, 3], tolerance = 0.002 }
feedback = "Secret feedback."
[criterion.carried]
from = ["urdf-loads"]
check = "shows_nothing"
with = { link = "secret_link" }
[[criterion]]
id = "loads"
part = "a"
about = "The base | top"
title = "It loads"
points = 1
check = "urdf_loads"
[[criterion]]
id = "why"
part = "b"
title = "Why?"
points = 4
check = "answered"
with = { question = "Why so?", answer = "Secret answer.", places = ["step 1"] }
"""
EXPECTED = """\
# Lab 0: &lt;b&gt;wheels&lt;/b&gt; &amp; @\u2060ash

7.5 points in total.

## The \\*model\\* (3.5 points)

The URDF is examined.

| criterion | about | what should be true | points |
| --- | --- | --- | ---: |
| `a\\|b` | The base \\| top | A box \\| 0.6 x 0.4, \\`\\[link\\](http\\://a.b)\\` | 2.5 |
| `loads` |  | It loads | 1 |

## Answers (4 points)

All submitted files are examined.

| criterion | what should be true | points |
| --- | --- | ---: |
| `why` | Why? *(graded manually)* | 4 |
"""


@pytest.fixture
def lab(tmp_path: Path) -> Path:
    """Return a file with the rubric above."""
    path = tmp_path / "lab0.toml"
    path.write_text(RUBRIC.replace("urdf-loads", "loads").replace('["loads"]', '["first"]'), encoding="utf-8")
    first = '[[criterion]]\nid = "first"\npart = "a"\nabout = "x"\ntitle = "First"\npoints = 0\ncheck = "urdf_loads"\n'
    text = path.read_text(encoding="utf-8")
    path.write_text(text.replace("[[criterion]]", f"{first}[[criterion]]", 1), encoding="utf-8")
    return path


def test_the_table_of_a_file(lab: Path) -> None:
    """Parts, criteria and points; text of the rubric is never markup, and nothing else of the rubric is shown."""
    done = run(("rubric", "show", lab, "--format", "markdown"))
    assert (done.returncode, done.stderr) == (0, b"")
    text = done.stdout.decode()
    assert text.replace("| `first` | x | First | 0 |\n", "") == EXPECTED
    assert "ecret" not in text
    assert "0.002" not in text


@pytest.mark.parametrize("name", sorted(shipped_rubrics()))
def test_the_table_of_a_shipped_rubric(name: str) -> None:
    """As HTML, the tables have a row for each criterion with its id, title and points."""
    text = run(("rubric", "show", name, "--format", "markdown")).stdout.decode()
    html = cmarkgfm.github_flavored_markdown_to_html(text)
    cells = [
        tuple(unescape(re.sub(r"<[^>]*>|\u2060", "", cell)) for cell in re.findall(r"<td[^>]*>(.*?)</td>", row))
        for row in re.findall(r"<tr>(.*?)</tr>", html, re.DOTALL)
    ]
    rubric = load_rubric(name)
    shown = {row[0]: row[1:] for row in cells if row}
    assert list(shown) == [
        criterion.id for part in rubric.parts for criterion in rubric.criteria if criterion.part == part.id
    ]
    for criterion in rubric.criteria:
        *_, title, points = shown[criterion.id]
        assert title.removesuffix(" (graded manually)") == criterion.title
        assert float(points) == float(criterion.points)
        assert criterion.feedback == "" or criterion.feedback not in text


def test_answers_are_not_for_students(lab: Path) -> None:
    """Both options together are refused."""
    done = run(("rubric", "show", lab, "--format", "markdown", "--answers", lab))
    assert (done.returncode, done.stdout) == (2, b"")
    assert done.stderr == b"grader: --format markdown is for students, so it shows no model answers: omit --answers\n"
