"""Edits of xacro: each way to give an attribute of an expanded element another value, and nothing else that changes."""

from collections.abc import Iterator
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from grader.base.element_edits import edited
from grader.base.source import Edit
from grader.ros.xacro.rewriting import ExpandedEdits
from tests.examples import examples
from tests.xacro import grammar
from tests.xacro.comparing import expand
from tests.xacro.documents.document import Document, named, part, robot

WHEEL = (
    '<xacro:macro name="wheel" params="side reflect parent:=base_lnk *origin">\n'
    '<joint name="${side}_joint" type="fixed"><parent link="${parent}"/><xacro:insert_block name="origin"/>\n'
    '<axis xyz="0 0 ${reflect*0.1/2}" rpy="0 0 0.025"/></joint>\n</xacro:macro>\n'
    '<xacro:wheel side="left" reflect="1"><origin xyz="-0.15 ${y} 0"/></xacro:wheel>\n'
    '<xacro:wheel side="rihgt" reflect="-1"><origin xyz="-0.15 -0.2 0"/></xacro:wheel>'
)
MOUNT = '<xacro:macro name="mount" params="y"><origin xyz="0 ${y} 0"/></xacro:macro><xacro:mount y="${r / 2}"/>'
SIZES = f"{named('y', '0.2')}\n{named('r', '0.1')}\n{named('height', '${2*r}')}\n{named('size', '0.6 ${y} ${height}')}"


def files_of(document: Document) -> dict[str, str]:
    """Return the texts of a document and the files beside it."""
    files = {document.path: document.text, **document.files}
    return {
        path: text if isinstance(text, str) else text.decode("utf-8", "replace")
        for path, text in files.items()
    }


def edited_files(document: Document, edits: tuple[Edit, ...]) -> dict[str, str]:
    """Return the texts of a document after edits, each of which has to fit."""
    files = files_of(document)
    for path in {edit.path for edit in edits}:
        text = edited(files[path], path, [edit for edit in edits if edit.path == path])
        assert text is not None, edits
        files[path] = text
    return files


def after(document: Document, edits: tuple[Edit, ...]) -> Document:
    """Return a document with edits."""
    files = edited_files(document, edits)
    return document._replace(text=files[document.path], files={**document.files, **files})


def elements(root: Any, tag: str) -> list[tuple[int, Any]]:
    """Return the elements with a tag in document order, each with its index among all."""
    return [(index, element) for index, element in enumerate(root.iter()) if element.tag == tag]


def changes(
    document: Document, tag: str, attribute: str, new: str, which: int = 0
) -> list[list[str]]:
    """Return the new texts of the ways to change an attribute of an expanded element, and check that each is what is read then."""
    found = expand(document)
    index, element = elements(found.root, tag)[which]
    ways = ExpandedEdits(found.source).rewrites(
        attribute, {index: (element.get(attribute, ""), new)}
    )
    return [[edit.new for edit in way] for way in ways]


@pytest.mark.parametrize(
    ("body", "tag", "attribute", "new", "expected"),
    [
        # a literal piece; the others stay as they are written
        (
            '<origin xyz=" -0.15  ${y} .0"/>',
            "origin",
            "xyz",
            "-0.15 0.2 0.1",
            ['xyz=" -0.15  ${y} 0.1"'],
        ),
        ('<origin xyz="0.15 ${y} 0"/>', "origin", "xyz", "-0.15 0.2 0", ['xyz="-0.15 ${y} 0"']),
        # an expression is replaced as a whole
        ('<origin rpy="${-pi/2} 0 0"/>', "origin", "rpy", "1.5708 0 0", ['rpy="1.5708 0 0"']),
        ('<origin xyz="${y/2} 0 0"/>', "origin", "xyz", "-0.1 0 0", ['xyz="-0.1 0 0"']),
        ('<origin xyz="-${y} 0 0"/>', "origin", "xyz", "0.2 0 0", ['xyz="0.2 0 0"']),
        ('<origin xyz="${y - r/2} 0 0"/>', "origin", "xyz", "0.25 0 0", ['xyz="0.25 0 0"']),
        ('<origin xyz="${y} 0 0"/>', "origin", "xyz", "0.1 0 0", ['value="0.1"']),
        # the number in place of the expression
        ('<origin xyz="${y} 0 0"/>', "origin", "xyz", "0.3 0 0", ['xyz="0.3 0 0"']),
        # the property, also where others are computed from it, and of several numbers
        ('<origin xyz="${y} 0 0"/>', "origin", "xyz", "0.3 0 0", ['value="0.3"']),
        ('<origin xyz="0 0 ${height/2}"/>', "origin", "xyz", "0 0 0.15", ['xyz="0 0 0.15"']),
        ('<box size="${size}"/>', "box", "size", "0.6 0.4 0.2", ['value="0.4"']),
        ('<box size="${size}"/>', "box", "size", "0.8 0.2 0.2", ['size="0.8 0.2 0.2"']),
        ("<a b=\"${dict(white='1 0.1 1')['white']}\"/>", "a", "b", "1 1 1", ['b="1 1 1"']),
        # an argument of a macro, a default, a block, a name with a parameter
        (WHEEL, "axis", "xyz", "0 0 0.1", ['xyz="0 0 0.1"']),
        (WHEEL, "parent", "link", "base_link", ['params="side reflect parent:=base_link *origin"']),
        (WHEEL, "origin", "xyz", "-0.15 0.25 0", ['xyz="-0.15 0.25 0"']),
        (WHEEL, "joint", "name", "left_mount", ['name="${side}_mount"']),
        (WHEEL, "joint", "name", "back_joint", ['side="back"']),
        (WHEEL, "joint", "type", "continuous", ['type="continuous"']),
        # the number from which an argument is computed; the expression in a call, with the other sign or as a value
        (MOUNT, "origin", "xyz", "0 0.2 0", ['value="0.4"']),
        (MOUNT, "origin", "xyz", "0 0.2 0", ['y="0.2"']),
        (MOUNT, "origin", "xyz", "0 -0.05 0", ['y="${-r / 2}"']),
        (f'{named("deg", "90")}<a b="${{-radians(deg)}}"/>', "a", "b", "-0.785398", ['value="45"']),
        # an attribute that an argument of the file gives
        (
            '<xacro:arg name="n" default="0.2"/><a b="$(arg n)"/>',
            "a",
            "b",
            "0.3",
            ['default="0.3"'],
        ),
    ],
)
def test_a_way_to_change_an_attribute(
    body: str, tag: str, attribute: str, new: str, expected: list[str]
) -> None:
    """Every part of the xacro that a value comes from can be edited, and gives the new value."""
    document = Document(robot(f"{SIZES}\n{body}"))
    assert expected in changes(document, tag, attribute, new)
    found = expand(document)
    index, element = elements(found.root, tag)[0]
    for way in ExpandedEdits(found.source).rewrites(
        attribute, {index: (element.get(attribute, ""), new)}
    ):
        value = elements(expand(after(document, way)).root, tag)[0][1].get(attribute)
        assert value == new or all(
            abs(float(one) - float(other)) < 2e-3
            for one, other in zip(value.split(), new.split(), strict=True)
        ), way


def test_an_included_file_is_edited() -> None:
    """The edit of an element or a property that an included file contains is in that file."""
    document = Document(
        robot('<xacro:include filename="part.xacro"/>'),
        {
            "urdf/part.xacro": part(
                f'\n{named("r", "0.1")}\n<cylinder radius="${{r}}" length="0.1"/>'
            )
        },
    )
    found = expand(document)
    [(index, element)] = elements(found.root, "cylinder")
    source, start = found.source.element(index)
    assert source.path == "urdf/part.xacro"
    assert source.text.startswith("<cylinder", start)
    assert {
        edit.path
        for way in ExpandedEdits(found.source).rewrites(
            "radius", {index: (element.get("radius"), "0.2")}
        )
        for edit in way
    } == {"urdf/part.xacro"}


def test_the_calls_of_a_macro_that_an_edit_is_in() -> None:
    """An edit in a macro changes all of its calls; one of an argument or outside of macros changes nothing else."""
    document = Document(robot(f"{SIZES}\n{WHEEL}"))
    source = expand(document).source
    lines = [
        line for line, text in enumerate(document.text.split("\n"), 1) if "<xacro:wheel" in text
    ]
    inside, argument = (
        source.edit(document.text.index(text), document.text.index(text) + len(text), "")
        for text in ('type="fixed"', 'reflect="1"')
    )
    assert {
        name: [call.line for call in calls]
        for name, calls in ExpandedEdits(source).calls(inside).items()
    } == {"wheel": lines}
    assert ExpandedEdits(source).calls(argument) == {}


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ('<a b="${heigt}"/>', ['b="${height}"', 'name="heigt"']),
        (
            named("wde", "1") + '<a b="${wide}"/><a c="${wide}"/>',
            ['b="${wde}"', 'name="wide"', 'c="${wde}"'],
        ),
        (
            '<xacro:macro name="whel" params="side"/><xacro:wheel side="left"></xacro:wheel>',
            ["<xacro:whel|</xacro:whel>", 'name="wheel"'],
        ),
        (
            '<xacro:macro name="wheel" params="sde"><a/></xacro:macro><xacro:wheel side="left"/>',
            ['sde="left"', 'params="side"'],
        ),
        (
            '<xacro:macro name="w" params="*orign"><xacro:insert_block name="origin"/></xacro:macro><xacro:w><a/></xacro:w>',
            ['name="orign"', 'params="*origin"'],
        ),
        (
            '<xacro:macro name="w" params="mas:=1"><a b="${mass}"/></xacro:macro><xacro:w/>',
            ['b="${mas}"', 'params="mass:=1"'],
        ),
        ('<xacro:include filename="parts/wheels.xacro"/>', ['filename="parts/wheel.xacro"']),
        ('<a b="${nothing_like_it}"/>', []),
    ],
)
def test_a_name_that_is_not_defined_is_corrected(body: str, expected: list[str]) -> None:
    """A misspelt property, macro, parameter, block or file is corrected where it is used, or where it is defined."""
    document = Document(robot(f"{SIZES}\n{body}"), {"urdf/parts/wheel.xacro": part("<a/>")})
    ways = [
        correction.edits for correction in ExpandedEdits(expand(document).source).corrections(())
    ]
    assert sorted("|".join(edit.new for edit in way) for way in ways) == sorted(expected)
    for way in ways:
        changed = expand(after(document, way))
        assert len(changed.problems) < len(expand(document).problems), way


def values(text: str) -> Iterator[tuple[str, str, str]]:
    """Yield the elements and attributes of an XML text."""
    for index, element in enumerate(etree.fromstring(text.encode()).iter()):
        yield str(index), "", str(element.tag)
        yield from ((str(index), str(name), str(value)) for name, value in element.items())


@pytest.mark.slow
@given(
    seed=st.integers(0, 400),
    which=st.integers(0, 30),
    new=st.sampled_from(("0.3", "-0.5 1 2", "arm_link", "&quot;")),
)
@examples(20)
def test_an_edit_changes_one_attribute_and_nothing_else(seed: int, which: int, new: str) -> None:
    """On random documents, each edit replaces or adds one attribute, and every other byte stays."""
    document = grammar.document(seed)
    found = expand(document)
    attributes = [
        (index, name, value)
        for index, element in enumerate(found.root.iter())
        for name, value in element.items()
    ]
    if not attributes:
        return
    index, name, value = attributes[which % len(attributes)]
    for way in ExpandedEdits(found.source).rewrites(name, {index: (value, new)}):
        before, now = files_of(document), edited_files(document, way)
        for path, text in before.items():
            edits = sorted(
                (edit for edit in way if edit.path == path),
                key=lambda edit: (edit.line, edit.column),
            )
            assert len(now[path]) - len(text) == sum(
                len(edit.new) - len(edit.old) for edit in edits
            )
            if edits and not path.endswith(".yaml"):
                changed = set(values(now[path])) ^ set(values(text))
                assert len({(element, attribute) for element, attribute, _ in changed}) <= len(
                    edits
                )


def test_a_yaml_file_is_not_read_again_for_each_edit() -> None:
    """A value from a YAML file is replaced by the number; reading the file for each edit would take too long."""
    body = (
        f"{named('config', '${xacro.load_yaml(&quot;a.yaml&quot;)}')}<a b=\"${{config['x']}} 0\"/>"
    )
    document = Document(robot(body.replace("&quot;", "'")), {"urdf/a.yaml": "x: 0.5"})
    assert changes(document, "a", "b", "0.3 0") == [['b="0.3 0"']]


def test_hostile_expressions_take_a_bounded_number_of_steps() -> None:
    """Names that double in cost with each of 60 definitions are given up, and the number in place of the expression remains."""
    chain = "".join(named(f"a{n}", f"${{a{n - 1} + a{n - 1}}}") for n in range(1, 61))
    document = Document(
        robot(f'{named("a0", "0.1")}{chain}<a b="${{a60 + a59}}"/><a b="${{a60 - a59}}"/>')
    )
    found = expand(document)
    for index, element in elements(found.root, "a"):
        ways = ExpandedEdits(found.source).rewrites("b", {index: (element.get("b"), "0.3")})
        assert [edit.new for way in ways for edit in way] == ['b="0.3"']
