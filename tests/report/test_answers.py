"""Written answers are shown without the signs of Markdown, wherever a person reads them."""

import json
from pathlib import Path

import pytest

from grader.report.answers import plain_lines
from tests.classroom.gradebooks import grader, lab_text

MARKDOWN = """### Step 1

The **robot** is gone: see `base_link` and [the docs](https://docs.ros.org).
> 5 mm
![a screen](screen.png)
```xml
# not **a** heading
```
- 2 * 3 * 4, `a*b*c`
"""
PLAIN = (
    "Step 1",
    "The robot is gone: see base_link and the docs (https://docs.ros.org).",
    "> 5 mm",
    "[picture: a screen]",
    "# not **a** heading",
    "- 2 * 3 * 4, a*b*c",
)
# Each is the text of a line, and what is shown of it.
LINES = {
    "## Step 2": "Step 2",
    "~~~ 5 mm": "~~~ 5 mm",
    "``` it vanishes ```": "``` it vanishes ```",
    "*/*.urdf and */*.xacro": "*/*.urdf and */*.xacro",
    "**/*.urdf and **/*.xacro": "**/*.urdf and **/*.xacro",
    "a[i](j)": "a[i](j)",
    "-----": "-----",
    "###Step 2": "Step 2",
    "#!/bin/sh": "#!/bin/sh",
    "C# and F#": "C# and F#",
    "**`code`**": "code",
    "**kwargs and *args": "**kwargs and *args",
    "2*3*4 and 2 ** 3": "2*3*4 and 2 ** 3",
    "__init__.py, _private_": "__init__.py, _private_",
    r"C:\new": r"C:\new",
    "``a`b`` `": "``a`b`` `",
    "<link name='base_link'/>": "<link name='base_link'/>",
}


def test_signs_that_are_not_markdown_stay() -> None:
    """Only headings, bold text, links, pictures and code lose their signs."""
    assert {line: plain_lines(line) for line in LINES} == {line: [plain] for line, plain in LINES.items()}
    assert plain_lines("\n\na\n\nb\n\n") == ["a", "", "b"]
    assert plain_lines("") == plain_lines("```\n```\n") == []


def test_signs_without_a_partner_take_linear_time() -> None:
    """A student can write the longest answer of nothing but openings."""
    for signs in (" *a", "*a*a ", "` a", "[a", "![a](", "[a](b", "> ", "#", "- "):
        assert plain_lines("x" + signs * (32_000 // len(signs)))


@pytest.mark.parametrize("kind", ["terminal", "markdown", "html"])
def test_reports_and_the_review_show_plain_text(tmp_path: Path, kind: str) -> None:
    """In JSON the answer is as the student wrote it."""
    (tmp_path / "small.toml").write_text(lab_text(), encoding="utf-8")
    (tmp_path / "class/anna").mkdir(parents=True)
    (tmp_path / "class/anna/answers.md").write_text(MARKDOWN, encoding="utf-8")
    anna = ("grade", tmp_path / "class/anna", "--rubric", tmp_path / "small.toml", "--format")
    shown = grader(*anna, kind, "--verbose", COLUMNS="200").stdout
    texts = [line.replace("<", "&lt;").replace(">", "&gt;") if kind == "html" else line for line in PLAIN]
    assert [line for line in texts if line not in shown] == []
    assert "# Step 1" not in shown
    results = json.loads(grader(*anna, "json").stdout)["results"]
    assert [result["measured"] for result in results if result["id"] == "essay"] == [MARKDOWN.strip()]
    book = tmp_path / "book.db"
    assert grader("batch", tmp_path / "class", "--rubric", tmp_path / "small.toml", "--gradebook", book).returncode == 0
    review = grader("review", "--gradebook", book, stdin="q\n", COLUMNS="200").stdout
    assert "Found:\n" + "".join(f"  {line}\n" for line in PLAIN) in review


def test_a_model_answer_of_several_lines(tmp_path: Path) -> None:
    """The overview of a rubric shows it in one paragraph, the review line by line, both without signs of Markdown."""
    answer = '"""\n# Roots\n\n- **two** roots\n"""'
    (tmp_path / "small.toml").write_text(lab_text().replace('"Because of the roots."', answer), encoding="utf-8")
    shown = grader("rubric", "show", tmp_path / "small.toml", "--answers", tmp_path / "small.toml").stdout
    assert "    Model answer: Roots - two roots\n" in shown
