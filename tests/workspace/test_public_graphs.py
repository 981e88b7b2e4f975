"""The lists of what launch files of public workspaces start, and how much of it a graph has."""

import re
from collections import Counter

from tests.command_line import ROOT
from tests.workspace.public_graphs import (
    Drawn,
    Line,
    counted,
    differences,
    drawn_lines,
    read_lines,
    read_table,
)

_TABLE = read_table()
_LAUNCHES = _TABLE["launch"]
_KINDS = {
    "publisher": "msg",
    "subscription": "msg",
    "service": "srv",
    "client": "srv",
    "action-server": "action",
    "action-client": "action",
}
_LAST_LOOK = 4
_LEAST_RIGHT = 0.97  # of the ends that are drawn as certain


def _lines(look: int = 0) -> list[Line]:
    """Return the lines of a look, or of all."""
    return [
        line
        for launch in _LAUNCHES
        if look in (0, launch["look"])
        for line in read_lines(launch["lines"])
    ]


def _figures(counts: Counter[Drawn]) -> tuple[int, int, int, int]:
    """Return how many ends are certain and there, certain, drawn and there, and there."""
    there = counts.total() - counts["wrong"]
    certain = counts["certain"] + counts["wrong"]
    return counts["certain"], certain, there - counts["missing"], there


def test_each_list_is_of_a_known_commit() -> None:
    """Of at least twenty workspaces; what is not drawn has its reason."""
    commits = {(launch["repository"], launch["commit"]) for launch in _LAUNCHES}
    assert len({repository for repository, _ in commits}) == len(commits) >= 20
    for launch in _LAUNCHES:
        assert re.fullmatch(r"[\w.-]+/[\w.-]+", launch["repository"])
        assert re.fullmatch(r"[0-9a-f]{40}", launch["commit"])
        assert launch["look"] in range(1, _LAST_LOOK + 1)
        lines = [*read_lines(launch["lines"])]
        assert len({line.what for line in lines}) == len(lines), launch["file"]
        assert ("why" in launch) == any(line.drawn == "missing" for line in lines), launch["file"]


def test_an_end_has_a_name_and_a_type_of_its_kind() -> None:
    """A topic has a message, a service a service, an action an action."""
    for line in _lines():
        if line.is_end:
            node, kind, name, message = line.what
            assert node.startswith("/") and name.startswith("/"), line
            assert message.split("/")[1] == _KINDS[kind], line


def test_the_share_that_is_right_is_the_one_that_is_stated() -> None:
    """Of the four looks now, and of the last one at first; the page on graphs has the sums."""
    assert {look: _figures(counted(_lines(look))) for look in range(1, _LAST_LOOK + 1)} == {
        1: (135, 135, 135, 136),
        2: (80, 80, 81, 94),
        3: (55, 55, 56, 57),
        4: (76, 76, 76, 88),
    }
    later = sum(line.is_later for line in _lines(_LAST_LOOK))
    right, certain, drawn, there = _figures(counted(_lines(_LAST_LOOK)))
    assert (right - later, certain - later, drawn - later, there) == (59, 59, 59, 88)
    first = _TABLE["first_look"]
    assert first["right"] <= first["certain"]
    right, certain, drawn, there = _figures(counted(_lines()))
    assert right >= _LEAST_RIGHT * certain
    page = (ROOT / "docs/graph.md").read_text(encoding="utf-8")
    assert f"{drawn} of {there} ends" in page.replace("\n", " ")


_GRAPH = {
    "nodes": [
        {
            "name": "/a",
            "program": "p/a",
            "certain": True,
            "ends": [
                {"kind": "publisher", "name": "/x", "type": "s/msg/S", "certain": True},
                {"kind": "action server", "name": "/y", "type": "", "certain": False},
                {"kind": "action server", "name": "/y", "type": "", "certain": True},
                {"kind": "action server", "name": "/y", "type": "", "certain": False},
            ],
        },
        {
            "name": "",
            "program": "p/b",
            "certain": False,
            "ends": [{"kind": "client", "name": "/z", "type": "s/srv/S", "certain": True}],
        },
        {
            "name": "/controller_manager",
            "program": "c/m",
            "certain": True,
            "ends": [{"kind": "service", "name": "/s", "type": "s/srv/S", "certain": True}],
        },
    ],
    "transforms": [{"parent": "odom", "child": "base"}],
}


def test_a_graph_is_compared_with_a_list() -> None:
    """Each mark that no longer holds is named, and each certain end without a line."""
    drawn = drawn_lines(_GRAPH)
    right = """
        /a publisher /x s/msg/S
        ! /a action-server /y ?
        ~ (p/b) client /z s/srv/S
        + transform odom base
        /controller_manager
        - /c
    """
    assert [*differences([*read_lines(right)], drawn)] == []
    wrong = """
        - /a publisher /x s/msg/S
        (p/b) client /z s/srv/S
        /c
    """
    assert [*differences([*read_lines(wrong)], drawn)] == [
        "/a publisher /x s/msg/S: certain, listed as missing",
        "(p/b) client /z s/srv/S: dashed, listed as certain",
        "/c: missing, listed as certain",
        "/a action-server /y ?: not listed",
    ]
