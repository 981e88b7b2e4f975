"""A copy of lab6 whose hints may show edits, which those of lab6 may not."""

import shutil
from pathlib import Path

LAB = Path(__file__).parent.parent / "rubrics/lab6"


def copy_with_edits(folder: Path) -> Path:
    """Copy lab6 into a folder and return the rubric."""
    shutil.copytree(LAB, folder)
    rubric = folder / "rubric.toml"
    text = rubric.read_text(encoding="utf-8")
    assert 'hints = "cause" ' in text
    rubric.write_text(text.replace('hints = "cause" ', 'hints = "edit"  '), encoding="utf-8")
    return rubric
