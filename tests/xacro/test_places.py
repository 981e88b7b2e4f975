"""Each expanded element has its place in the source: file, line, column, and the macro calls that led to it."""

import json
from pathlib import Path

import pytest

from grader.base.source import Location
from tests.command_line import run
from tests.xacro import grammar
from tests.xacro.comparing import expand
from tests.xacro.documents.document import Document, named, part, robot

pytestmark = pytest.mark.slow

MACRO = (
    '<xacro:macro name="wheel" params="side *origin">\n'
    '<link name="${side}_wheel"><xacro:insert_block name="origin"/><xacro:mass/></link>\n'
    "</xacro:macro>"
)
MASS = '<xacro:macro name="mass" params="">\n\n <mass value="${kg}"/></xacro:macro>'
NESTED = Document(
    robot(
        f'<xacro:include filename="mass.xacro"/>\n{named("kg", "2")}\n{MACRO}\n'
        '<xacro:wheel side="left">\n  <origin xyz="${1/2} 0 0"/>\n</xacro:wheel>'
    ),
    {"urdf/mass.xacro": part(MASS)},
)


def text_at(document: Document, location: Location) -> str:
    """Return the text of a document from a location on."""
    files = {document.path: document.text, **document.files}
    content = files[location.path]
    text = content if isinstance(content, str) else content.decode()
    return "\n".join(text.split("\n")[location.line - 1 :])[location.column - 1 :]


def test_every_element_is_where_it_is_written() -> None:
    """On random documents, each element's place is a tag of its name, or one that makes an element with a computed name."""
    count = 0
    for seed in range(150):
        document = grammar.document(seed)
        found = expand(document)
        for index, element in enumerate(found.root.iter()):
            text = text_at(document, found.source.tag(index))
            assert text.startswith((f"<{element.tag}", "<xacro:element")), (
                seed,
                element.tag,
                text[:40],
            )
            count += 1
    assert count > 1_000


def test_the_macro_calls_that_led_to_an_element() -> None:
    """An element of a macro names the calls, outermost first; one that a call gives is at the call."""
    found = expand(NESTED)
    places = {
        element.tag: found.source.tag(index) for index, element in enumerate(found.root.iter())
    }
    assert text_at(NESTED, places["link"]).startswith('<link name="${side}_wheel">')
    assert [macro for macro, _ in places["link"].calls] == ["wheel"]
    assert text_at(NESTED, places["link"].calls[0][1]).startswith('<xacro:wheel side="left">')
    assert text_at(NESTED, places["origin"]).startswith('<origin xyz="${1/2} 0 0"/>')
    assert places["origin"].calls == ()
    assert places["mass"].path == "urdf/mass.xacro"
    assert [macro for macro, _ in places["mass"].calls] == ["wheel", "mass"]
    assert text_at(NESTED, places["mass"].calls[1][1]).startswith("<xacro:mass/>")


def test_reports_name_the_calls(tmp_path: Path) -> None:
    """The terminal, Markdown, JSON and inspect show the calls that led to a failure."""
    wheel = (
        '<link name="${side}_wheel"><visual><geometry><box size="1 1"/></geometry></visual></link>'
    )
    text = robot(
        f'<xacro:macro name="wheel" params="side">{wheel}</xacro:macro>\n<xacro:wheel side="left"/>'
    )
    (tmp_path / "my_robot.urdf.xacro").write_text(text)
    column = text.split("\n")[2].index("size=") + 1
    place = f"my_robot.urdf.xacro:3:{column}, in macro wheel, called at my_robot.urdf.xacro:4"
    for options in (("--verbose",), ("--format", "markdown")):
        done = run(("grade", tmp_path / "my_robot.urdf.xacro", *options))
        assert place in " ".join(done.stdout.decode().split()), options
    problem = json.loads(
        run(("inspect", tmp_path / "my_robot.urdf.xacro", "--format", "json")).stdout
    )["robots"][0]["problems"][0]
    called = {"path": "my_robot.urdf.xacro", "line": 4, "column": 1, "end_line": 4}
    called["end_column"] = 1 + len('<xacro:wheel side="left"/>')
    assert problem["location"]["calls"] == [{"macro": "wheel", "location": called}]
    concise = run(("inspect", tmp_path / "my_robot.urdf.xacro", "--format", "concise"))
    assert (
        " in macro wheel, called at my_robot.urdf.xacro:4: cannot read" in concise.stdout.decode()
    )
