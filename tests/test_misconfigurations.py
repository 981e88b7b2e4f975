"""The kinds of misconfiguration that the page of the docs says are found, are found."""

import json
import runpy
from pathlib import Path
from typing import Any

import pytest

from tests.command_line import ROOT, run
from tests.test_catalogue_examples import CODES, KINDS, files_of
from tests.workspace.rule_examples import EXAMPLES, files_of_example

FOUND = {name: entry for name, entry in KINDS.items() if "codes" in entry}
LEAST = 41  # of the kinds that files show


def inspected(folder: Path) -> list[dict[str, Any]]:
    """Return what `grader inspect` reports in a folder, with the release that the examples are for."""
    data = json.loads(run(("inspect", folder, "--format", "json", "--distro", "jazzy")).stdout)
    return [*data["problems"], *(it for robot in data["robots"] for it in robot["problems"])]


def test_the_kinds_are_those_of_the_study() -> None:
    """There are 50 in 12 categories, of which files show 45 and the tools of the study find 23; each is found, or has a reason."""
    assert len(KINDS) == 50
    assert len({name.partition(": ")[0] for name in KINDS}) == 12
    assert sum(entry.get("in_files", True) for entry in KINDS.values()) == 45
    assert sum(entry.get("tools", False) for entry in KINDS.values()) == 23
    assert len(FOUND) >= LEAST
    for name, entry in KINDS.items():
        found = {"codes", "source", "scope"}.intersection(entry)
        assert found == (set() if "reason" in entry else {"codes", "source", "scope"}), name
        assert entry.get("in_files", True) or name not in FOUND, name
        assert set(entry.get("codes", ())) <= set(CODES), name


@pytest.mark.parametrize("name", FOUND)
def test_an_example_of_a_kind_is_found(name: str, tmp_path: Path) -> None:
    """Its first code is reported at a line of the wrong example, and neither it nor an error in the right one."""
    code = FOUND[name]["codes"][0]
    shown = EXAMPLES.get(FOUND[name].get("rule", ""), FOUND[name])
    found: dict[str, list[dict[str, Any]]] = {}
    for side in ("wrong", "right"):
        if "wrong" in shown:
            example = files_of_example(shown, side)
            files = {path: text.encode() for path, text in example.files.items()}
            path, lines = example.path, example.lines
        else:
            files, lines = files_of(code, side)
            path = next(iter(files))
        for file, data in files.items():
            (tmp_path / side / file).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / side / file).write_bytes(data)
        found[side] = inspected(tmp_path / side)
        if side == "wrong":
            places = [it["location"] for it in found["wrong"] if it["code"] == code]
            if shown.get("at"):
                assert shown["at"] in [it["path"] for it in places], found["wrong"]
            else:
                assert any(it["path"] == path and it["line"] in lines for it in places), found
    right = [it for it in found["right"] if it["code"] == code or it["severity"] == "error"]
    assert right == []


@pytest.mark.slow
def test_the_page_names_every_kind() -> None:
    """docs/make.py makes a row of each kind, and a section with an example of each that is found."""
    page = runpy.run_path(str(ROOT / "docs/make.py"))["pages"]()["misconfigurations.md"]
    assert f"finds {len(FOUND)} of the 45 kinds that files can show" in page
    for name, entry in KINDS.items():
        assert page.count(f"| {entry['explanation']} |") == 1, name
        assert page.count(f"\n## {name}\n") == (name in FOUND), name
