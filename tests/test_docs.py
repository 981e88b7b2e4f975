"""The documentation matches the code, and its commands and links work."""

import re
import runpy
import tomllib
from pathlib import Path

import pytest
import yaml

from grader import __version__

ROOT = Path(__file__).parent.parent
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])
GENERATED = runpy.run_path(str(ROOT / "docs" / "make.py"))["pages"]()


@pytest.mark.parametrize("name", GENERATED)
def test_a_generated_page_is_current(name: str) -> None:
    """The page is what docs/make.py writes now."""
    assert (ROOT / "docs" / name).read_text(encoding="utf-8") == GENERATED[name], "run python docs/make.py"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_links_are_files(page: Path) -> None:
    """Every relative link of a page is a file of the project."""
    for target in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def anchors(page: Path) -> set[str]:
    """Return the anchors that GitHub gives the headings of a page."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_anchors_are_headings(page: Path) -> None:
    """Every link to a section of a page leads to a heading of that page."""
    for target, anchor in re.findall(r"\]\(([^)#]*)#([^)]+)\)", page.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert anchor in anchors(page.parent / target if target else page), f"{page.name}: {target}#{anchor}"


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_codes_and_criteria_exist(page: Path) -> None:
    """Every problem code on a page is in the catalogue."""
    codes = set(re.findall(r"(?:URDF|PKG|LCH|RVZ)\d{3}", page.read_text(encoding="utf-8")))
    assert all(f"## {code}" in GENERATED["problems.md"] for code in codes)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_code_blocks_can_be_parsed(page: Path) -> None:
    """Every block of YAML or TOML is valid, so it was not wrapped like prose."""
    for kind, block in re.findall(r"^ *```(yaml|toml)\n(.*?)^ *```", page.read_text(encoding="utf-8"), re.S | re.M):
        (yaml.safe_load if kind == "yaml" else tomllib.loads)(block)


def test_the_lab_page_names_every_criterion() -> None:
    """Each criterion of the rubric has a row; the two wheels share rows."""
    from grader.grading.rubric import load_rubric

    text = (ROOT / "docs" / "lab6.md").read_text(encoding="utf-8")
    for criterion in load_rubric("lab6").criteria:
        name = re.sub(r"^(left|right)(?=-wheel)", "…", criterion.id)
        assert f"| `{name}`" in text, criterion.id


def test_every_dependency_has_its_reason() -> None:
    """Each package of pyproject.toml has a line in the decisions."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    decisions = (ROOT / "docs" / "decisions.md").read_text(encoding="utf-8")
    extras = [requirement for group in project["optional-dependencies"].values() for requirement in group]
    for requirement in [*project["dependencies"], *extras]:
        name = re.split(r"[<>=\[ ]", requirement)[0].removesuffix("-stubs").removeprefix("types-")
        assert name in decisions, name


def test_the_readme_has_two_commands_first() -> None:
    """The first code blocks are the command that grades a sample and the one that runs the tests."""
    blocks = re.findall(r"```sh\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL)
    assert [block.count("\n") for block in blocks[:2]] == [1, 1]
    assert "grader grade submissions/" in blocks[0]
    assert "-m pytest" in blocks[1]


def test_the_changelog_knows_the_version() -> None:
    """The changelog lists the version, or has changes under Unreleased."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## [{__version__}]" in text or "## [Unreleased]" in text


def test_every_test_that_the_security_page_names_exists() -> None:
    """Each row names a test, or a file of tests."""
    text = (ROOT / "docs" / "security.md").read_text(encoding="utf-8")
    named = re.findall(r"\| `([\w/]+/test_\w+\.py)(?:::(\w+))?` \|", text)
    assert len(named) > 20
    for file, function in named:
        tests = (ROOT / "tests" / file).read_text(encoding="utf-8")
        assert f"def {function or 'test_'}" in tests, (file, function)
