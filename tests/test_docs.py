"""The documentation matches the code, and its commands and links work."""

import inspect
import json
import re
import runpy
import tomllib
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import Any

import pytest
import yaml
from typer.main import get_command

from grader import __version__
from grader.app.cli import app, ending
from grader.app.cli.app import COMMANDS, make_app
from grader.app.cli.batch import batch
from grader.files import limits
from grader.lab.authoring import rubric_test
from grader.lab.documents import collection, converter, pictures
from grader.lab.rubric.rubric import load_rubric, shipped_rubrics
from grader.ros.package import finding, package
from grader.ros.python import budget, expressions, values
from grader.ros.urdf import diagnostics
from grader.workers import pool
from tests.command_line import ROOT, run

MIB = 1024 * 1024
BESIDE = [
    ROOT / "docs/schemas/README.md",
    *(ROOT / "rubrics").glob("*/README.md"),
    *(ROOT / "tests").glob("*.md"),
    ROOT / "benchmarks/README.md",
]
PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *BESIDE])
GENERATED = runpy.run_path(str(ROOT / "docs" / "make.py"))["pages"]()


@pytest.mark.parametrize("name", GENERATED)
def test_a_generated_page_is_current(name: str) -> None:
    """The page is what docs/make.py writes now."""
    assert (ROOT / "docs" / name).read_text(encoding="utf-8") == GENERATED[name], (
        "run python docs/make.py"
    )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_links_are_files(page: Path) -> None:
    """Every relative link of a page is a file of the project."""
    for target in re.findall(r"\]\(([^)#]+)", page.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert (page.parent / target).exists(), f"{page.name}: {target}"


def anchors(page: Path) -> set[str]:
    """Return the anchors that GitHub gives the headings of a page."""
    text = re.sub(
        r"^```.*?^```$", "", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE
    )
    headings = re.findall(r"^#+ (.*)$", text, re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_anchors_are_headings(page: Path) -> None:
    """Every link to a section of a page leads to a heading of that page."""
    for target, anchor in re.findall(r"\]\(([^)#]*)#([^)]+)\)", page.read_text(encoding="utf-8")):
        if not target.startswith("http"):
            assert anchor in anchors(page.parent / target if target else page), (
                f"{page.name}: {target}#{anchor}"
            )


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_codes_and_criteria_exist(page: Path) -> None:
    """Every problem code on a page is in the catalogue."""
    codes = set(
        re.findall(r"(?:URDF|XACRO|PKG|LCH|RVZ|REF|IGN)\d{3}", page.read_text(encoding="utf-8"))
    )
    assert all(f"\n## {code}\n" in GENERATED["problems.md"] for code in codes)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_code_blocks_can_be_parsed(page: Path) -> None:
    """Every block of YAML or TOML is valid, so it was not wrapped like prose; some generated ones are wrong on purpose."""
    if page.name == "problems.md":
        return
    for kind, block in re.findall(
        r"^ *```(yaml|toml)\n(.*?)^ *```", page.read_text(encoding="utf-8"), re.S | re.M
    ):
        (yaml.safe_load if kind == "yaml" else tomllib.loads)(block)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_programs_of_the_project_exist(page: Path) -> None:
    """Each module and file that `python` or `pytest` is to run is one of the project."""
    text = page.read_text(encoding="utf-8")
    found = re.findall(
        r"-m ((?:tests|benchmarks)[\w.]*)|(?:python|pytest)[^`\n]* ((?:tests|benchmarks|docs)/[\w/.]+)",
        text,
    )
    for module, file in found:
        path = file.removesuffix("/") or module.rstrip(".").replace(".", "/")
        assert (ROOT / path).exists() or (ROOT / f"{path}.py").exists(), path


def commands(command: Any, name: str) -> Iterator[tuple[str, set[str]]]:
    """Yield each command below this one with its options."""
    below = getattr(command, "commands", {})
    for word, subcommand in below.items():
        yield from commands(subcommand, f"{name} {word}")
    if not below:
        yield (
            name,
            {
                option
                for parameter in command.params
                for option in parameter.opts
                if option.startswith("--")
            },
        )


def test_every_command_and_option_is_in_the_reference() -> None:
    """Each command has a synopsis with its options, and no other ones."""
    page = (ROOT / "docs" / "command-line.md").read_text(encoding="utf-8")
    block = re.search(r"^```text\n(.*?)^```", page, re.DOTALL | re.MULTILINE)
    assert block is not None
    shown = re.split(r"\n(?=grader )", block[1].strip())
    expected = dict(commands(get_command(make_app(COMMANDS)), "grader"))
    assert len(shown) == len(expected)
    for name, options in expected.items():
        [synopsis] = [synopsis for synopsis in shown if f"{synopsis} ".startswith(f"{name} ")]
        assert set(re.findall(r"--[a-z-]+", synopsis)) == options, name


@pytest.mark.parametrize("name", ["report", "inspect", "graph", "class", "diff", "rubric-test"])
def test_every_key_of_json_is_in_the_reference(name: str) -> None:
    """Each key of each schema is on the page beside the schemas."""
    page = (ROOT / "docs" / "schemas" / "README.md").read_text(encoding="utf-8")
    shown = set(re.findall(r"\w+", " ".join(re.findall(r"`[^`\n]+`", page))))
    assert set(keys(json.loads(run(("schema", name)).stdout))) <= shown


def keys(schema: Any) -> Iterator[str]:
    """Yield the names of all properties in a JSON Schema."""
    if isinstance(schema, dict):
        yield from schema.get("properties", {})
    for part in (
        schema.values() if isinstance(schema, dict) else schema if isinstance(schema, list) else ()
    ):
        yield from keys(part)


def test_every_dependency_has_a_reason_and_a_licence() -> None:
    """Each package in pyproject.toml has a line in docs/dependencies.md, and one of users its licence, too."""
    whole = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    project, extras = whole["project"], whole["project"]["optional-dependencies"]
    of_users = [*project["dependencies"], *extras["documents"], *extras["cluster"]]
    of_developers = chain(*extras.values(), *whole["dependency-groups"].values())
    reasons, licences = (
        (ROOT / "docs" / "dependencies.md").read_text(encoding="utf-8").split("## Licences")
    )
    for text, needed in ((reasons, [*of_users, *of_developers]), (licences, of_users)):
        names = {re.split(r"[<>=,;\[]", requirement)[0] for requirement in needed}
        assert [
            name for name in sorted(names) if not re.search(rf"\| .*\b{name}\b.*\|", text)
        ] == []


LIMITS: dict[str, dict[str, tuple[float, ...]]] = {
    "packages.md": {
        "| files, and folders, of a submission | {:,} |": (limits.MAX_FILES,),
        "| one file | {} MiB |": (limits.MAX_FILE_SIZE / MIB,),
        "| {} MiB, and {} times the size of the archive beyond {} MiB |": (
            limits.MAX_UNPACKED_SIZE / MIB,
            limits.MAX_RATIO,
            limits.HARMLESS_SIZE / MIB,
        ),
        "| {} GiB; the ratio above |": (limits.MAX_ARCHIVE_SIZE / MIB / 1024,),
        "| {} deep, {} in all, 64 MiB each |": (limits.MAX_NESTED, limits.MAX_ARCHIVES),
        "| `setup.py`, a launch file | {} KiB |": (budget.PYTHON_LIMIT / 1024,),
        "| 1 MiB, and its first {:,} lines |": (collection.MAX_LINES,),
        "| its first {} pages |": (converter.MAX_PAGES,),
        "| {:,} elements; {:,} texts, {} MiB |": (
            converter._MAX_ELEMENTS,
            converter._MAX_PIECES,
            converter._MAX_CONTENT / MIB,
        ),
        "| {} s of processor time; {} MiB of memory |": (
            collection.MAX_SECONDS,
            converter._MAX_MEMORY / MIB,
        ),
        "| `package.xml`; an RViz file | {} KiB; {} KiB |": (
            finding._MAX_MANIFEST_SIZE / 1024,
            package._RVIZ_LIMIT / 1024,
        ),
        "| {} s; {} s of processor time, or what `ulimit -t` allows; {} GiB of memory |": (
            app._LIMITED["grade"],
            app._LIMITED["inspect"],
            ending._MEMORY / MIB / 1024,
        ),
        "| problems of a URDF; links that `inspect` prints | {:,}; 500 |": (
            diagnostics._MAX_PROBLEMS,
        ),
        "{} s of processor time (`--timeout`); {} GiB of memory | graded again": (
            inspect.signature(batch).parameters["timeout"].default,
            pool.MAX_MEMORY / MIB / 1024,
        ),
    },
    "xacro.md": {
        "| work to read one submission | {:,} parts |": (budget.READING,),
        "| {:,}; {:,} |\n| parts of a list or dict, with everything in it | {:,} |": (
            expressions._MAX_LENGTH,
            values.MAX_TEXT,
            values.MAX_PARTS,
        ),
    },
    "rubric-test.md": {"a sample of {} is graded": (rubric_test._MAX_MUTANTS,)},
    "grade-a-class.md": {
        "up to {} MiB": (pictures.MAX_BYTES / MIB,),
    },
}


@pytest.mark.parametrize(
    ("page", "phrase"), [(page, phrase) for page, phrases in LIMITS.items() for phrase in phrases]
)
def test_limits_are_those_of_the_code(page: str, phrase: str) -> None:
    """The figures on the pages are the constants of the code."""
    figures = (int(figure) for figure in LIMITS[page][phrase])
    assert phrase.format(*figures) in (ROOT / "docs" / page).read_text(encoding="utf-8")


def test_points_are_those_of_the_rubrics() -> None:
    """The pages of the labs have the points of each part, and the README those of Lab 6."""
    for path in shipped_rubrics().values():
        rubric = load_rubric(str(path))
        page = path.with_name("README.md").read_text(encoding="utf-8")
        for part in rubric.parts:
            points = sum(
                criterion.points for criterion in rubric.criteria if criterion.part == part.id
            )
            assert re.search(
                rf"^\| `{part.id}` \|.*\| {points}(, manual)? \|$", page, re.MULTILINE
            ), part
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    assert "all 90 automatic points; 10 more need manual grading" in readme
    assert "the score, 64/70." in (ROOT / "docs/index.md").read_text(encoding="utf-8")
    assert "\n64/70  " in GENERATED["grade-one-submission.md"]


def test_the_lab_page_names_every_criterion() -> None:
    """Each criterion of the rubric has a row; the two wheels share rows."""
    text = (ROOT / "rubrics/lab6/README.md").read_text(encoding="utf-8")
    for criterion in load_rubric("lab6").criteria:
        name = re.sub(r"^(left|right)(?=-wheel)", "…", criterion.id)
        assert f"| `{name}`" in text, criterion.id


def test_pictures_of_a_page_show_what_the_first_command_prints() -> None:
    """Their descriptions have the points of the sample that the README's first command grades."""
    readme = (ROOT / "README.md").read_text(encoding="utf-8")
    found = re.search(r"grader grade (submissions/\S+)", readme)
    assert found is not None
    result = run(("grade", ROOT / found[1])).stdout.decode().splitlines()[1]
    points = result.partition(":")[0]
    for text in (readme, (ROOT / "docs/grade-one-submission.md").read_text(encoding="utf-8")):
        (described,) = re.findall(r"!\[(.*)\]\([\w/]*screenshots/student\.png\)", text)
        assert f": {points}, " in described


def test_the_readme_has_two_commands_first() -> None:
    """The first code blocks are the command that grades a sample and the one that runs the tests."""
    blocks = re.findall(
        r"```sh\n(.*?)```", (ROOT / "README.md").read_text(encoding="utf-8"), re.DOTALL
    )
    assert [block.count("\n") for block in blocks[:2]] == [1, 1]
    assert "grader grade submissions/" in blocks[0]
    assert "-m pytest" in blocks[1]


def test_the_changelog_knows_the_version() -> None:
    """The changelog lists the version, or has changes under Unreleased."""
    text = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    assert f"## [{__version__}]" in text or "## [Unreleased]" in text


def test_every_test_that_the_table_of_attacks_names_exists() -> None:
    """Each row names tests, files of tests, or tables of the corpus; `::name` is in the file that is named before."""
    text = (ROOT / "tests" / "security.md").read_text(encoding="utf-8")
    named = re.findall(r"`(?=::|\w+/)([\w/]+/test_\w+\.py)?(?:::(\w+))?`", text)
    tables = re.findall(r"`(corpus/[\w/-]+\.toml)`", text)
    assert [table for table in tables if not (ROOT / "tests" / table).is_file()] == []
    assert len(named) + len(tables) > 70
    tests = ""
    for file, function in named:
        tests = (ROOT / "tests" / file).read_text(encoding="utf-8") if file else tests
        assert f"def {function or 'test_'}" in tests, (file, function)


def test_the_pages_stay_short() -> None:
    """The README has at most 700 words, and all pages but the long generated ones have at most 26,000."""
    long_generated = (
        *("problems.md", "checks.md", "misconfigurations.md"),
        *("rubric-reference.md", "known-parameters.md"),
    )
    words = {
        page: len(page.read_text(encoding="utf-8").split())
        for page in [
            *(ROOT / name for name in ("README.md", "CONTRIBUTING.md", "docs/handout/answers.md")),
            *(ROOT / "docs").glob("*.md"),
        ]
    }
    assert words[ROOT / "README.md"] <= 700
    assert sum(words[page] for page in words if page.name not in long_generated) <= 26_000
