"""Every format renders every graph of links and joints: loops, several parents, several roots, joints of a link to itself."""

from pathlib import Path
from tempfile import TemporaryDirectory
from zipfile import ZipFile

from hypothesis import example, given
from hypothesis import strategies as st

from grader.report.formats import Format, InspectFormat
from tests.command_line import run
from tests.examples import examples

LINKS = ("base_footprint", "base_link", "lidar", "left_wheel", "w")
LOOP = [("base_link", "lidar", "fixed"), ("lidar", "base_link", "fixed")]
SHAPE = '<visual><geometry><sphere radius="0.1"/></geometry></visual>'

names = st.sampled_from(LINKS)
joints = st.tuples(names, names, st.sampled_from(("fixed", "continuous", "floating", "")))


def robot(links: dict[str, bool], graph: list[tuple[str, str, str]]) -> str:
    """Return a URDF with these links, some of them with a shape, and a joint for each edge of the graph."""
    parts = [f'<link name="{name}">{SHAPE if is_shown else ""}</link>' for name, is_shown in links.items()]
    parts += [
        f'<joint name="j{number}" type="{kind}"><parent link="{parent}"/><child link="{child}"/></joint>'
        for number, (parent, child, kind) in enumerate(graph)
    ]
    return f'<robot name="r">{"".join(parts)}</robot>'


@examples(10)
@given(st.dictionaries(names, st.booleans(), min_size=1), st.lists(joints, max_size=6))
@example({"base_link": False, "lidar": False, "w": False}, LOOP)
@example({"base_link": True, "lidar": True, "w": False}, LOOP)
def test_every_format_renders_every_graph(links: dict[str, bool], graph: list[tuple[str, str, str]]) -> None:
    """`grade` saves each format, and `inspect` prints each in the frame of any link, without an error."""
    with TemporaryDirectory() as place:
        urdf = Path(place, "r.urdf")
        urdf.write_text(robot(links, graph))
        files = {kind: Path(place, f"report.{kind.ending}") for kind in Format}
        saves = [f"--save={kind}={file}" for kind, file in files.items()]
        done = run(["grade", urdf, "--hints", "none", *saves])  # the search takes longer than all else
        assert (done.returncode, done.stderr) == (1, b""), done.stderr
        assert all(file.stat().st_size for file in files.values())
        for kind in InspectFormat:
            done = run(["inspect", urdf, "--relative-to", min(links), "--format", kind])
            assert done.returncode in (0, 1)
            assert (bool(done.stdout), done.stderr) == (True, b"")


def test_a_class_has_the_page_of_a_robot_with_a_loop(tmp_path: Path) -> None:
    """`batch --reports`, the class page and the feedback zip contain the student."""
    folder = tmp_path / "class/Ada Lee_7_assignsubmission_file"
    folder.mkdir(parents=True)
    (folder / "r.urdf").write_text(robot(dict.fromkeys(("base_link", "lidar", "w"), True), LOOP))
    gradebook = ("--gradebook", tmp_path / "g")
    done = run(["batch", folder.parent, *gradebook, "--reports", tmp_path / "reports", "--report-format", "html"])
    assert (done.returncode, len([*(tmp_path / "reports").glob("*7*.html")])) == (0, 1), done.stderr
    done = run(["export", "html", *gradebook, "--output", tmp_path / "pages"])
    assert (done.returncode, len([*(tmp_path / "pages").glob("*7*.html")])) == (0, 1), done.stderr
    worksheet, feedback = tmp_path / "moodle.csv", tmp_path / "feedback.zip"
    worksheet.write_text("Identifier,Full name,Grade,Maximum grade\nParticipant 7,Ada Lee,,100.00\n")
    into = ("--into", worksheet, "--output", tmp_path / "out.csv", "--feedback", feedback)
    assert run(["export", "moodle", *gradebook, *into]).returncode == 0
    with ZipFile(feedback) as pages:
        assert len(pages.namelist()) == 1
