"""Labs of whole packages: a sheet, a solution, and variants of it as edits, written before the grader had read any of them."""

import tomllib
from functools import cache
from pathlib import Path
from shutil import copytree
from typing import Any, NamedTuple

FOLDER = Path(__file__).parent
LABS = sorted(path.parent.name for path in FOLDER.glob("*/variants.toml"))


class Variant(NamedTuple):
    """A variant of a lab's solution: `breaks` says what fails in ROS 2, `family` what kind of name or value is wrong."""

    lab: str
    name: str
    kind: str
    about: str
    breaks: str
    family: str
    edits: tuple[dict[str, Any], ...]


@cache
def variants_of(lab: str) -> dict[str, Variant]:
    """Return the variants of a lab by their ids."""
    rows = tomllib.loads((FOLDER / lab / "variants.toml").read_text(encoding="utf-8"))["variant"]
    variants = [
        Variant(
            lab,
            row["id"],
            row["kind"],
            row["about"],
            row.get("breaks", ""),
            row.get("family", ""),
            tuple(row["edit"]),
        )
        for row in rows
    ]
    assert len({variant.name for variant in variants}) == len(variants)
    return {variant.name: variant for variant in variants}


def make_variant(lab: str, name: str, folder: Path) -> Path:
    """Write a variant of a lab below a folder and return the folder of its packages; `solution` is the solution itself."""
    workspace = folder / lab
    copytree(FOLDER / lab / "solution", workspace)
    for edit in variants_of(lab)[name].edits if name != "solution" else ():
        apply_edit(edit, workspace)
    return workspace


def apply_edit(edit: dict[str, Any], workspace: Path) -> None:
    """Replace a text that occurs once, or write, move or remove a file, which must exist if it is not new."""
    file = workspace / edit["file"]
    if edit.get("new_file"):
        assert not file.exists()
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(edit["text"], encoding="utf-8")
        return
    text = file.read_text(encoding="utf-8")
    if "old" in edit:
        assert text.count(edit["old"]) == 1, (
            f"{edit['file']}: {edit['old']!r} occurs {text.count(edit['old'])} times"
        )
        text = text.replace(edit["old"], edit["new"])
    changed = edit.get("text", text)
    if edit.get("remove") or "move_to" in edit:
        file.unlink()
    if not edit.get("remove"):
        target = workspace / edit.get("move_to", edit["file"])
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(changed, encoding="utf-8")
