"""A workspace of three packages, with changes, and what does not agree in it."""

from collections.abc import Mapping
from functools import cache
from pathlib import Path

from grader.files.tree import make_tree, overlaid
from grader.lab.submission.opening import make_submission
from grader.lab.submission.submission import Lab, Submission
from grader.workspace.rules.names import Agreement, Mismatch
from grader.workspace.rules.reading import read_agreement

Edit = tuple[str, str, str]  # the end of a path, and a text there that occurs once, with a new one
FOLDER = Path(__file__).parent.parent / "corpus" / "given" / "cartkit" / "src"
LAB = Lab("urdf/cart.urdf.xacro")


@cache
def cart_files() -> Mapping[str, str]:
    """Return the texts of the workspace by their paths; in it, everything agrees."""
    paths = [
        path
        for path in sorted(FOLDER.rglob("*"))
        if path.is_file() and "__pycache__" not in path.parts
    ]
    return {path.relative_to(FOLDER).as_posix(): path.read_text(encoding="utf-8") for path in paths}


def edited(*edits: Edit) -> dict[str, str]:
    """Return the texts with edits."""
    texts = dict(cart_files())
    for end, old, new in edits:
        [path] = [it for it in texts if it.endswith(end)]
        assert texts[path].count(old) == 1, (
            f"{old!r} occurs {texts[path].count(old)} times in {path}"
        )
        texts[path] = texts[path].replace(old, new)
    return texts


def cart(texts: Mapping[str, str], lab: Lab = LAB) -> Submission:
    """Return a submission of these files."""
    return make_submission(
        overlaid(make_tree("cart", (), ()), {path: text.encode() for path, text in texts.items()}),
        "cart",
        lab,
    )


def agreement_of(texts: Mapping[str, str]) -> Agreement:
    """Return what does not agree in these files."""
    return read_agreement(cart(texts).workspace)


def sure(found: Agreement) -> list[Mismatch]:
    """Return what certainly fails at run time."""
    return [it for it in found.mismatches if it.is_certain]
