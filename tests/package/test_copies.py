"""Packages with one name: colcon refuses them where it finds them below one folder src."""

import pytest

from grader.files.tree import make_tree, overlaid
from grader.ros.package.finding import read_packages

_MANIFEST = b"<package format='3'><name>arm</name></package>"


@pytest.mark.parametrize(
    ("folders", "others", "copies"),
    [
        (["src/arm", "src/old/arm"], [], ("src/old/arm", "src/arm")),
        (["src/arm_old", "src/robots/arm"], [], ("src/arm_old", "src/robots/arm")),
        (["ws/src/one/src/arm", "ws/src/arm"], [], ("ws/src/one/src/arm", "ws/src/arm")),
        (["src/arm", "src/a", "src/b"], [], ("src/b", "src/arm", "src/a")),
        (["src/arm", "src/arm/arm"], [], ()),  # colcon does not search in a package
        (["lab6/src/arm", "lab7/src/arm"], [], ()),  # two workspaces
        (["ann/arm", "ben/arm"], [], ()),
        (["src/arm", "src/old/arm"], ["src/old/COLCON_IGNORE"], ()),
    ],
)
def test_copies(folders: list[str], others: list[str], copies: tuple[str, ...]) -> None:
    """The one that seems to be kept of earlier work is first; each of the packages names all."""
    files = {f"{folder}/package.xml": _MANIFEST for folder in folders} | dict.fromkeys(others, b"")
    packages = read_packages(overlaid(make_tree("work", (), ()), files), "", most=9)
    assert {package.folder: package.copies for package in packages} == dict.fromkeys(
        folders, copies
    )
