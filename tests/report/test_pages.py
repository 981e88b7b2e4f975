"""What every HTML page has in common: escaped text, one file, a policy that allows its own script and style only."""

import hashlib
import re
import subprocess
import sys
from base64 import b64encode
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import html

from grader.base.text import without_commands
from grader.report.formats import Format, render
from grader.report.pages.shell import Assets, render_page, shortened, shortened_style
from tests.command_line import ROOT, run_with_input
from tests.samples import SAMPLES

FILES = ROOT / "grader" / "report" / "pages" / "files"
VALUES = {"version": "1", "title": "A page"}


def page(data: dict[str, object] | None = None, **values: str) -> str:
    return render_page("base.html", VALUES | values, data or {}, Assets())


@pytest.mark.parametrize("name", ["several-mistakes", "reference", "centimetres"])
def test_page_of_a_wheeled_base_is_small(name: str) -> None:
    """With the robot in 3-D and the names of its links it has at most 93 KB."""
    assert len(render(SAMPLES[name].grade(), Format.HTML).encode()) <= 93_000


def test_policy_allows_what_the_page_has_and_nothing_else() -> None:
    """Everything is forbidden but the inline style, by its hash."""
    text = page()
    policy = dict(
        part.split(" ", 1)
        for part in re.findall('Security-Policy" content="([^"]*)"', text)[0]
        .replace("&#39;", "'")
        .split("; ")
    )
    assert policy["default-src"] == "'none'"
    style = re.findall("<style>(.*?)</style>", text, re.DOTALL)[0]
    assert (
        policy["style-src"]
        == f"'sha256-{b64encode(hashlib.sha256(style.encode()).digest()).decode()}'"
    )
    assert policy["script-src"] == policy["base-uri"] == policy["form-action"] == "'none'"


@given(st.text())
def test_text_stays_text(text: str) -> None:
    """Text never becomes markup, and has no control characters."""
    found = html.fromstring(page(title=f"x{text}x"))
    title = found.findtext(".//title")
    assert title is not None
    assert title.isprintable()
    assert len(found.findall(".//*")) == len(html.fromstring(page()).findall(".//*"))


def test_unknown_values_are_an_error() -> None:
    """A template that names a value it does not get fails; NaN is no JSON."""
    with pytest.raises(Exception, match="title"):
        render_page("base.html", {"version": "1"}, {}, Assets())
    with pytest.raises(ValueError, match="JSON"):
        render_page("base.html", VALUES, {"x": float("nan")}, Assets())


@pytest.mark.slow
def test_grade_without_html_imports_nothing_of_it() -> None:
    """A cold `grade` loads neither the templates nor the pages."""
    program = """
import sys
from grader.app.cli.app import run
assert run(["grade", "submissions/lab6/axis-negated", "--save", "markdown=/dev/null", "--save", "json=/dev/null"]) == 1
loaded = [name for name in sys.modules if name.startswith(("jinja2", "markupsafe", "grader.report.pages", "grader.report.drawing"))]
assert not loaded, loaded
"""
    subprocess.run([sys.executable, "-c", program], check=True, cwd=ROOT, stdout=subprocess.DEVNULL)


@pytest.mark.parametrize("file", sorted(FILES.iterdir()), ids=lambda file: file.name)
def test_own_files_are_not_changed_for_ci(file: Path) -> None:
    """No line of a script or style looks like a command of a CI system: a changed one would not match its hash."""
    text = file.read_text(encoding="utf-8")
    assert without_commands(text) == text


@pytest.mark.parametrize("name", ["several-mistakes", "pictures-only"])
def test_policy_names_the_scripts_of_the_students_page(name: str) -> None:
    """The hashes in the policy are those of the scripts and styles as they are printed."""
    text = render(SAMPLES[name].grade(), Format.HTML)
    named = re.findall(
        "'sha256-([^']+)'", text.partition('Policy" content="')[2].replace("&#39;", "'")
    )
    inline = re.findall("<style>(.*?)</style>|<script>(.*?)</script>", text, re.DOTALL)
    hashes = [
        b64encode(hashlib.sha256("".join(pair).encode()).digest()).decode() for pair in inline
    ]
    assert named == hashes
    assert len(hashes) == 2


@pytest.mark.parametrize(
    ("script", "short"),
    [
        ("// why\nlet a = 1; // more\n", "let a=1;"),
        (
            "/** Types.\n * @type {X} */\nconst f = (a) => {\n  return [a, a];\n};",
            "const f=(a)=>{return[a,a];};",
        ),
        (
            'f("// \'no\'", \'a  //  b\', "\\"  //"); // yes',
            'f("// \'no\'",\'a  //  b\',"\\"  //");',
        ),
        (
            "const t = `a  // b\n  ${c ? `: ${d}` : 1}  e`; // f",
            "const t=`a  // b\n  ${c ? `: ${d}` : 1}  e`;",
        ),
        ("a = b + c - -d + +e % f;", "a=b+c- -d+ +e%f;"),
        ("a += b++ + c;\nd = e < !f && -g !== h;", "a+=b++ +c;d=e< !f&&-g!==h;"),
        ("x.replace(/ \"[/ ']\\/ /g, 1); // y", "x.replace(/ \"[/ ']\\/ /g,1);"),
        ("a = b / c; // d / e\nf = g / 2;", "a=b/c;f=g/2;"),
        (
            "a = b - -c;\nif (d) {\n  e();\n} else {\n  f();\n}\ng();",
            "a=b- -c;if(d){e();}else{f();}\ng();",
        ),
        ("a\n  .b()\n  .c();", "a\n.b()\n.c();"),
    ],
)
def test_scripts_are_shortened(script: str, short: str) -> None:
    """Comments, indentation and spaces beside punctuation go; no character of a literal does."""
    assert shortened(script) == f"{short}\n"
    assert shortened(short) == f"{short}\n"


@pytest.mark.parametrize(
    ("style", "short"),
    [
        ("/* why */\na > b,\nc :is(d, e) { f: g; h: 1px; }\n", "a>b,c :is(d,e){f:g;h:1px}"),
        (
            "@media screen and (min-width: 1rem) {\n  a { b: calc(1px + 2px); }\n}",
            "@media screen and (min-width:1rem){a{b:calc(1px + 2px)}}",
        ),
        ('a::before { content: " /* b: c; */ "; }', 'a::before{content:" /* b: c; */ "}'),
    ],
)
def test_styles_are_shortened(style: str, short: str) -> None:
    """Likewise; a space that selects what is inside of an element stays."""
    assert shortened_style(style) == short
    assert shortened_style(short) == short


@pytest.mark.parametrize("file", sorted(FILES.glob("*.js")), ids=lambda file: file.name)
def test_scripts_make_no_markup_and_run_no_text(file: Path) -> None:
    """Text of a submission reaches the page as text only."""
    assert not re.search(
        r"innerHTML|outerHTML|insertAdjacent|document\.write|\beval\b|\bFunction\(|import\(",
        file.read_text(),
    )


@pytest.mark.slow
def test_a_page_of_a_huge_robot_is_bounded() -> None:
    """A browser shows it soon: so many shapes and links are on it, and how many are not."""
    boxes = "".join(
        f"<visual><geometry><box size='1 1 {1 + k % 600}'/></geometry></visual>"
        for k in range(1500)
    )
    parts = "".join(
        f"<link name='l{k}'/><joint name='j{k}' type='continuous'><parent link='a'/><child link='l{k}'/></joint>"
        for k in range(1200)
    )
    urdf = f"<robot name='r'><link name='a'>{boxes}</link>{parts}</robot>"
    text = run_with_input(("inspect", "-", "--format", "html"), urdf.encode()).stdout.decode()
    assert text.count("about 1 0 0") == 499
    for words in ("Not shown: 100 more shapes", "... and 701 more"):
        assert words in text, words
