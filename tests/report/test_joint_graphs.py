"""Every format renders every graph of links and joints: loops, several parents, several roots, joints of a link to itself."""

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.report.formats import Format, InspectFormat
from tests.command_line import run
from tests.examples import examples

pytestmark = pytest.mark.slow

LINKS = ("base_footprint", "base_link", "lidar", "left_wheel", "w")
LOOP = [("base_link", "lidar", "fixed"), ("lidar", "base_link", "fixed")]
SHAPE = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'

names = st.sampled_from(LINKS)
joints = st.tuples(names, names, st.sampled_from(("fixed", "continuous", "floating", "")))


def robot(links: dict[str, bool], graph: list[tuple[str, str, str]]) -> str:
    """Return a URDF with these links, some of them with a shape, and a joint for each edge of the graph."""
    parts = [
        f'<link name="{name}">{SHAPE if is_shown else ""}</link>'
        for name, is_shown in links.items()
    ]
    parts += [
        f'<joint name="j{number}" type="{kind}"><parent link="{parent}"/><child link="{child}"/></joint>'
        for number, (parent, child, kind) in enumerate(graph)
    ]
    return f'<robot name="r">{"".join(parts)}</robot>'


@examples(10)
@given(st.dictionaries(names, st.booleans(), min_size=1), st.lists(joints, max_size=6))
@example({"base_link": False, "lidar": False, "w": False}, LOOP)
@example({"base_link": True, "lidar": True, "w": False}, LOOP)
def test_every_format_renders_every_graph(
    links: dict[str, bool], graph: list[tuple[str, str, str]]
) -> None:
    """`grade` saves each format, and `inspect` prints each in the frame of any link, without an error."""
    with TemporaryDirectory() as place:
        urdf = Path(place, "r.urdf")
        urdf.write_text(robot(links, graph))
        files = {kind: Path(place, f"report.{kind.ending}") for kind in Format}
        saves = [f"--save={kind}={file}" for kind, file in files.items()]
        done = run(
            ["grade", urdf, "--hints", "none", *saves]
        )  # the search takes longer than all else
        assert (done.returncode, done.stderr) == (1, b""), done.stderr
        assert all(file.stat().st_size for file in files.values())
        for kind in InspectFormat:
            done = run(["inspect", urdf, "--relative-to", min(links), "--format", kind])
            assert done.returncode in (0, 1)
            is_silent = kind is InspectFormat.CONCISE and done.returncode == 0
            assert (bool(done.stdout) or is_silent, done.stderr) == (True, b"")
