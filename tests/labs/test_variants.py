"""Variants of the labs of whole packages: their edits apply, and what they write can be parsed."""

import ast
from pathlib import Path

import pytest
import yaml
from lxml import etree

from tests.labs.variants import FOLDER, LABS, make_variant, variants_of

pytestmark = pytest.mark.slow

VARIANTS = [(lab, name) for lab in LABS for name in ("solution", *variants_of(lab))]
FAMILIES = {
    *("files", "frames", "controllers", "parameters", "arguments"),
    *("programs", "topics", "dependencies", "value", "structure"),
    *("services", "interfaces", "code"),
}
KEYS = (
    {"file", "old", "new"},
    {"file", "text"},
    {"file", "remove"},
    {"file", "move_to"},
    {"file", "move_to", "text"},
    {"file", "new_file", "text"},
)
XML_FILES = {".xml", ".xacro", ".sdf"}
YAML_FILES = {".yaml", ".rviz"}


def parse(path: Path) -> None:
    """Parse a file by its ending, as far as a parser is at hand."""
    text = path.read_text(encoding="utf-8")
    if path.suffix in XML_FILES:
        etree.fromstring(text.encode())
    elif path.suffix in YAML_FILES:
        assert yaml.safe_load(text)
    elif path.suffix == ".py":
        ast.parse(text)


def contents(folder: Path) -> dict[str, str]:
    """Return the text of each file below a folder by its path."""
    files = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8") for path in files}


@pytest.mark.parametrize(("lab", "name"), VARIANTS)
def test_a_variant_can_be_written_and_parsed(lab: str, name: str, tmp_path: Path) -> None:
    """Every edit applies, and every XML, YAML and Python file of a variant and of a solution parses."""
    workspace = make_variant(lab, name, tmp_path)
    for path in contents(workspace):
        parse(workspace / path)


@pytest.mark.parametrize(
    ("lab", "name"), [(lab, name) for lab, name in VARIANTS if name.startswith("w")]
)
def test_a_wrong_variant_differs_in_one_file(lab: str, name: str, tmp_path: Path) -> None:
    """A wrong variant has the files of the solution, of which one has another text."""
    before, after = contents(FOLDER / lab / "solution"), contents(make_variant(lab, name, tmp_path))
    assert before.keys() == after.keys()
    assert len([path for path in before if before[path] != after[path]]) == 1


@pytest.mark.parametrize("lab", LABS)
def test_a_lab_has_its_variants(lab: str) -> None:
    """A lab has twelve wrong variants or more, which say what breaks and in which family, and four correct ones or more."""
    variants = variants_of(lab).values()
    wrong = [variant for variant in variants if variant.kind == "wrong"]
    assert len(wrong) >= 12
    rights = len(variants) - len(wrong)
    assert rights >= 4
    assert [variant.name[0] for variant in variants] == ["w"] * len(wrong) + ["r"] * rights
    assert [variant.kind for variant in variants] == ["wrong"] * len(wrong) + ["right"] * rights
    assert all(variant.about and bool(variant.breaks) == (variant in wrong) for variant in variants)
    assert {variant.family for variant in wrong} <= FAMILIES
    assert all(edit.keys() in KEYS for variant in variants for edit in variant.edits)
