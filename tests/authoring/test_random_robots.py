"""Rubrics of random robots: each loads, and its reference gets full marks."""

import tomllib
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from tests.command_line import run
from tests.examples import examples

pytestmark = pytest.mark.slow

numbers = st.floats(-3, 3).map(lambda value: f"{value:.6g}") | st.sampled_from(
    ("0", "1.57", "-3.14", "1e-3", ".5")
)
sizes = st.floats(0.005, 2).map(lambda value: f"{value:.5g}") | st.just("-0.2")
vectors = st.tuples(numbers, numbers, numbers).map(" ".join)
axes = st.sampled_from(("0 0 1", "0 -1 0", "2 0 0", "1 1 1", "0.3 -0.2 0.9"))
channels = st.floats(0, 1).map(lambda value: f"{value:.3g}")
origins = st.builds('<origin xyz="{}" rpy="{}"/>'.format, vectors, vectors) | st.just("")
shapes = st.one_of(
    st.builds('<box size="{} {} {}"/>'.format, sizes, sizes, sizes),
    st.builds('<cylinder radius="{}" length="{}"/>'.format, sizes, sizes),
    st.builds('<sphere radius="{}"/>'.format, sizes),
    st.builds('<mesh filename="package://ash/{}.stl"/>'.format, st.sampled_from(("a", "b"))),
).map("<geometry>{}</geometry>".format)
colours = st.builds(
    '<material name=""><color rgba="{} {} {} 1"/></material>'.format, channels, channels, channels
)
visuals = st.builds("<visual>{}{}{}</visual>".format, origins, shapes, colours | st.just(""))
collisions = st.builds("<collision>{}{}</collision>".format, origins, shapes)
inertials = st.builds(
    '<inertial>{}<mass value="{}"/><inertia ixx="{}" ixy="0" ixz="0" iyy="{}" iyz="0" izz="{}"/></inertial>'.format,
    origins,
    sizes,
    sizes,
    sizes,
    sizes,
)
ends = st.integers(-30, 30).map(
    lambda tenths: f"{tenths / 10}"
)  # a range below the usual tolerance is warned of
limits = st.builds(
    '<limit lower="{}" upper="{}" effort="{}" velocity="{}"/>'.format, ends, ends, sizes, sizes
)
dynamics = st.builds('<dynamics damping="{}" friction="{}"/>'.format, sizes, sizes)
kinds = st.sampled_from(("fixed", "continuous", "revolute", "prismatic", "planar", "floating"))


@st.composite
def urdfs(draw: st.DrawFn) -> str:
    """Return a robot of up to six links, in a random order, some of whose joints mimic the first."""
    parts, first = [], ""
    for index in range(draw(st.integers(1, 6))):
        inside = draw(st.lists(visuals, max_size=2)) + draw(
            st.lists(collisions | inertials, max_size=1)
        )
        parts.append(f'<link name="l{index}">{"".join(inside)}</link>')
        if index:
            kind = draw(kinds)
            ends = f'<parent link="l{draw(st.integers(0, index - 1))}"/><child link="l{index}"/>'
            more = draw(limits) if kind in ("revolute", "prismatic") else ""
            more += draw(dynamics | st.just("")) + draw(origins)
            more += f'<axis xyz="{draw(axes)}"/>' if kind != "fixed" else ""
            if first and kind in ("revolute", "prismatic") and draw(st.booleans()):
                more += f'<mimic joint="{first}" multiplier="{draw(numbers)}"/>'
            elif kind in ("revolute", "prismatic"):
                first = first or f"j{index}"
            parts.append(f'<joint name="j{index}" type="{kind}">{ends}{more}</joint>')
    return f'<robot name="ash">{"".join(draw(st.permutations(parts)))}</robot>'


_TINY = (
    '<robot name="ash"><link name="l0"/><link name="l1"/><link name="l2"/>'
    '<joint name="j1" type="revolute"><parent link="l0"/><child link="l1"/>'
    '<limit lower="0" upper="1" effort="1" velocity="1"/></joint>'
    '<joint name="j2" type="revolute"><parent link="l0"/><child link="l2"/>'
    '<limit lower="0" upper="1" effort="1" velocity="1"/>'
    '<mimic joint="j1" multiplier="4.9894e-217"/></joint></robot>'
)

# A title that ends within a number, and a radius that the check of collisions does not take.
_LONG_TITLE = (
    '<robot name="ash"><link name="l5"><visual>'
    '<origin xyz="-1.34071 -0.52713 2.70275" rpy="0 -1.50812 1.73022"/>'
    '<geometry><cylinder radius="0.68672" length="0.005"/></geometry></visual></link></robot>'
)
_NEGATIVE_RADIUS = (
    '<robot name="ash"><link name="l1"><visual><geometry><sphere radius="-0.2"/></geometry></visual>'
    '<collision><geometry><sphere radius="-0.2"/></geometry></collision></link></robot>'
)


@examples(8)
@given(text=urdfs())
@example(text=_TINY)
@example(text=_LONG_TITLE)
@example(text=_NEGATIVE_RADIUS)
def test_a_random_reference_gets_full_marks(text: str) -> None:
    """Every rubric loads without a warning and gives its reference all points; it tests each link's frame and joint."""
    with TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "robot.urdf").write_text(text)
        done = run(("rubric", "new", folder / "lab.toml", "--from", folder / "robot.urdf"))
        assert (done.returncode, done.stderr) == (0, b"")
        checked = run(("rubric", "check", folder / "lab.toml"))
        assert checked.stdout.decode().endswith("its reference gets full marks\n"), checked.stderr
        assert checked.stderr == b""
        assert (
            run(("grade", folder / "robot.urdf", "--rubric", folder / "lab.toml")).returncode == 0
        )
        rows = tomllib.loads((folder / "lab.toml").read_text())["criterion"]
        links = {f"l{index}" for index in range(1, text.count("<link "))}
        for check in ("frame_at", "held_by"):
            assert {row["with"]["link"] for row in rows if row["check"] == check} == links
