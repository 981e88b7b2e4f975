"""The reader never raises, reports every problem at its exact location, and reads any file in linear time."""

from collections.abc import Callable
from itertools import pairwise

import pytest
from hypothesis import example, given
from hypothesis import strategies as st

from grader.base.errors import MissingElement
from grader.ros.urdf.kinematics import Configuration
from grader.ros.urdf.model import Origin
from grader.ros.urdf.reader import Reading, read_urdf
from grader.ros.urdf.urdf_problems import CATALOGUE
from tests.examples import examples, spread
from tests.urdf.builders import joint, links, robot
from tests.urdf.problem_samples import SAMPLES, ProblemSample
from tests.urdf.random_text import data
from tests.work import limited_work

_AT_THE_TOP = ("URDF003", "URDF005", "URDF008")  # kinds that are about the beginning of the file
_EFFECTS = {"rejects": "rejected", "drops": "degraded", "loads": "clean"}


def codes(read: Reading) -> list[str]:
    """Return the codes of all problems."""
    return [problem.code for problem in read.problems]


def message(read: Reading, code: str) -> str:
    """Return the message of the only problem of this code."""
    (found,) = [problem.message for problem in read.problems if problem.code == code]
    return found


# --- Any bytes --------------------------------------------------------------------------------------------------------


@pytest.mark.slow
@examples(60)
@given(raw=data | st.binary(max_size=100))
@example(raw=b"")
@example(raw=b"\xff")
@example(raw=b"\xef\xbb\xbf")
@example(raw=b"<robot name='\xff'><link name='\xff'/></robot>")
@example(raw=b"<robot name='r'><link name='a'/><\xff \xfe='1' \xfe='2'/></robot>")
def test_nothing_is_raised(raw: bytes) -> None:
    """Any bytes give a verdict that fits the problems; each problem has a printable message and a location."""
    read = read_urdf(raw, "random.urdf")
    effects = {problem.kind.effect for problem in read.problems}
    expected = next((verdict for effect, verdict in _EFFECTS.items() if effect in effects), "clean")
    assert read.verdict == expected
    assert read.robot is not None or read.verdict == "rejected"
    rows = raw.decode("utf-8", "surrogateescape").split("\n")
    for problem in read.problems:
        at = problem.location
        assert at.path == "random.urdf"
        assert 1 <= at.line <= len(rows)
        assert 1 <= at.column <= len(rows[at.line - 1]) + 1
        assert problem.message
        assert problem.message.encode()
    locations = [(problem.location.line, problem.location.column) for problem in read.problems]
    assert locations == sorted(locations)


@examples(30)
@given(raw=data)
@example(robot(links("a", "b", "c") + joint("b", "c") + joint("c", "b", "k")).encode())
def test_every_link_has_a_pose_or_a_reason(raw: bytes) -> None:
    """Every link of a robot that was read has a pose or a reason for having none."""
    read = read_urdf(raw)
    if read.robot is None:
        return
    configuration = Configuration(read.robot)
    for link in read.robot.links:
        try:
            configuration.pose(link.name)
        except MissingElement as missing:
            assert str(missing)


# --- Every kind of problem --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("sample", SAMPLES, ids=lambda sample: f"{sample.code}-{sample.name}")
def test_a_problem_has_its_location(sample: ProblemSample) -> None:
    """Its line and column are those of its attribute or tag, and there are no other problems."""
    read = read_urdf(sample.data, "sample.urdf", (sample.distro,))
    locations = [
        (problem.location.line, problem.location.column)
        for problem in read.problems
        if problem.code == sample.code
    ]
    assert sample.location in locations, [
        (problem.code, problem.message, problem.location) for problem in read.problems
    ]
    assert set(codes(read)) == {sample.code, *sample.also.split()}


@pytest.mark.parametrize(
    "sample",
    [
        sample
        for sample in SAMPLES
        if sample.code not in _AT_THE_TOP and "<?xml" not in sample.marked[:6]
    ],
    ids=lambda sample: f"{sample.code}-{sample.name}",
)
def test_a_problem_moves_with_its_line(sample: ProblemSample) -> None:
    """Three lines of comment before it, with CR LF, move it by three lines and change nothing else."""
    moved = b"<!--\r\n\r\n-->\r\n" + sample.data.replace(b"\n", b"\r\n")
    first, second = (
        read_urdf(data, releases=(sample.distro,)).problems for data in (sample.data, moved)
    )
    assert [
        (problem.code, problem.location.line - 3, problem.location.column) for problem in second
    ] == [(problem.code, problem.location.line, problem.location.column) for problem in first]


def test_every_kind_of_problem_has_a_sample() -> None:
    """Some file causes every kind in the catalogue."""
    assert {sample.code for sample in SAMPLES} == {kind.code for kind in CATALOGUE}


def test_locations_count_characters() -> None:
    """A column is one more than the number of characters before it, including tabs and non-ASCII letters."""
    read = read_urdf(
        "<robot name='r'>\n\t<!-- \u00fc\U0001f916 --><link name='a'/><link  name='a'/></robot>".encode()
    )
    (problem,) = read.problems
    assert (problem.location.line, problem.location.column) == (2, 36)


def test_the_attribute_is_found_among_similar_text() -> None:
    """Neither an attribute that ends in the same name, nor text in another's value."""
    read = read_urdf(
        b"<robot name='r'><link my_name='name=' alt=\"name='b'\" name='a'/><link  x-name='a' name='a'/></robot>"
    )
    (problem,) = read.problems
    assert problem.code == "URDF031"
    assert problem.location.column == 82


# --- What the messages say --------------------------------------------------------------------------------------------


def test_all_roots_are_named() -> None:
    """ROS 2 names two roots; the grader names all."""
    read = read_urdf(robot(links("a", "b", "c", "d", "e") + joint("a", "b")).encode())
    text = message(read, "URDF080")
    assert text.startswith(
        "'c', 'd' and 'e' are not connected to the robot: no joint has them as its child"
    )
    assert "roots are 'a', 'c', 'd', 'e'" in text


def test_a_single_detached_link_is_named() -> None:
    """The message names the small part, not the robot."""
    read = read_urdf(robot(links("loose", "a", "b") + joint("a", "b")).encode())
    assert message(read, "URDF080").startswith(
        "'loose' is not connected to the robot: no joint has it as its child"
    )


@pytest.mark.parametrize(
    ("ends", "code", "spelt"),
    [
        ("ab bc ca", "URDF081", "'a' -> 'b' -> 'c' -> 'a'"),
        ("aa", "URDF081", "'a' -> 'a'"),
        ("ab bc cd db", "URDF082", "'b' -> 'c' -> 'd' -> 'b'"),
        ("ab bb", "URDF082", "'b' -> 'b'"),
        ("xy ab ba", "URDF083", "'a' -> 'b' -> 'a'"),
    ],
)
def test_loops_are_listed_link_by_link(ends: str, code: str, spelt: str) -> None:
    """Each link of the loop in order, back to the first, and the joints by name."""
    names = dict.fromkeys(ends.replace(" ", ""))
    pairs = ends.split()
    read = read_urdf(
        robot(
            links(*names) + "".join(joint(pair[0], pair[1], f"j_{pair}") for pair in pairs)
        ).encode()
    )
    text = message(read, code)
    assert spelt in text
    around = spelt.replace("'", "").split(" -> ")
    for one, other in pairwise(around):
        assert f"'j_{one}{other}'" in text


def test_every_separate_loop_is_found() -> None:
    """Two loops are two problems."""
    pairs = ("ab", "ba", "cd", "de", "ec")
    read = read_urdf(
        robot(links(*"xabcde") + "".join(joint(pair[0], pair[1], pair) for pair in pairs)).encode()
    )
    assert codes(read).count("URDF083") == 2


def test_cyclic_mimics_are_listed() -> None:
    """The names of the joints that follow each other."""
    followers = joint("a", "b", "one", body='<mimic joint="two"/>') + joint(
        "a", "c", "two", body='<mimic joint="one"/>'
    )
    text = message(read_urdf(robot(links("a", "b", "c") + followers).encode()), "URDF076")
    assert "'one' -> 'two' -> 'one'" in text


@pytest.mark.parametrize(
    ("text", "code", "guess"),
    [
        (
            robot(links("base_link", "lidar") + joint("base_link", "lidr")),
            "URDF071",
            "did you mean 'lidar'?",
        ),
        (
            robot(links("base_link", "lidar") + joint("Base_Link", "lidar")),
            "URDF071",
            "did you mean 'base_link'?",
        ),
        (
            robot(links("a", "b") + joint("a", "b", kind="continous")),
            "URDF061",
            "did you mean 'continuous'?",
        ),
        (robot(links("a", "b") + joint("a", "b", kind="Fixed")), "URDF061", "write 'fixed'"),
        (robot(links("a", "b") + joint("a", "b", kind=" fixed")), "URDF061", "write 'fixed'"),
        (
            robot('<link name="a"><visual><geometry><cilinder/></geometry></visual></link>'),
            "URDF041",
            "did you mean 'cylinder'?",
        ),
        (robot('<link name="a"><visul/></link>'), "URDF091", "did you mean <visual>?"),
        (robot('<link nam="a"/>'), "URDF091", "did you mean 'name'?"),
        (
            robot(links("a", "b") + joint("a", "b", "first", body='<mimic joint="frist"/>')),
            "URDF076",
            "did you mean 'first'?",
        ),
        (
            robot(
                '<material name="gray"><color rgba="0 0 0 1"/></material>'
                '<link name="a"><visual><geometry><sphere radius="1"/></geometry><material name="grey"/></visual></link>'
            ),
            "URDF051",
            "did you mean 'gray'?",
        ),
    ],
)
def test_misspelt_names_have_suggestions(text: str, code: str, guess: str) -> None:
    """The message suggests a similar name."""
    assert guess in message(read_urdf(text.encode()), code)


def test_places_do_not_count_in_comparisons() -> None:
    """A robot that is written elsewhere in a file is equal to another one, in its hash and its representation, too."""
    text = robot(links("a", "b"), joint("a", "b"))
    one, other = (
        read_urdf(raw.encode(), path).robot
        for raw, path in ((text, "a"), (text.replace("<", "\n<"), "b"))
    )
    assert one is not None
    assert one == other != read_urdf(robot(links("a")).encode(), "a").robot
    assert (one.joints, hash(one), repr(one)) == (other.joints, hash(other), repr(other))
    assert one.joints[0].origin == Origin() != Origin((1.0, 0.0, 0.0))


def test_one_run_finds_all_problems() -> None:
    """Unrelated problems are all reported, in file order."""
    text = robot(
        '<material name="m"><color rgba="255 0 0 1"/></material>\n'
        '<link name="a"><visual/></link>\n'
        '<link name="a"/>\n'
        '<joint name="j" type="fixd"><parent link="a"/><child link="x"/><origin xyz="1,2,x"/></joint>'
    )
    assert codes(read_urdf(text.encode())) == [
        "URDF052",
        "URDF041",
        "URDF031",
        "URDF061",
        "URDF071",
        "URDF062",
    ]


def test_several_malformed_tags_are_found_in_one_run() -> None:
    """A broken tag does not hide the next one."""
    text = robot('\n<link name=a/>\n<link name="b", c="d"/>\n<parent="x"/>\n<link name="e"/>\n')
    read = read_urdf(text.encode())
    assert [(it.code, it.location.line) for it in read.problems if it.code != "URDF015"] == [
        ("URDF001", 2),
        ("URDF001", 3),
        ("URDF001", 4),
    ]


# --- Safety -----------------------------------------------------------------------------------------------------------

_LINK = '<link name="a"/>'
_MEGABYTE = 2**20


def test_external_entities_are_not_opened() -> None:
    """No file is read: the entity stays as it is written, and the DOCTYPE is a problem."""
    text = f'<!DOCTYPE r [<!ENTITY e SYSTEM "file:///etc/passwd">]><robot name="&e;">{_LINK}&e;</robot>'
    read = read_urdf(text.encode())
    assert "URDF010" in codes(read)
    assert read.robot is not None
    assert read.robot.name == "&e;"


def test_entities_do_not_expand() -> None:
    """A billion laughs are not expanded."""
    entities = '<!ENTITY l0 "lol">' + "".join(
        f'<!ENTITY l{n} "{f"&l{n - 1};" * 10}">' for n in range(1, 10)
    )
    text = (
        f'<?xml version="1.0"?>\n<!DOCTYPE r [{entities}]>\n<robot name="&l9;">{_LINK}&l9;</robot>'
    )
    with limited_work(6_000):
        read = read_urdf(text.encode())
    assert "URDF010" in codes(read)
    assert read.robot is None or len(read.robot.name) < 100


def repeated(pattern: str, size: int) -> str:
    """Return so many characters of a pattern; a % in it is replaced by a running number."""
    if "%" not in pattern:
        return pattern * (size // len(pattern))
    count = size // (len(pattern) + 4)
    return "".join(pattern.replace("%", str(index)) for index in range(count))


def _filled(frame: str) -> Callable[[int], str]:
    """Return a frame whose {pattern} is repeated up to the maximum file size."""
    head, _, rest = frame.partition("{")
    pattern, _, tail = rest.partition("}")
    return lambda size: head + repeated(pattern, size - len(head) - len(tail)) + tail


def _in_shape(tag: str) -> str:
    return robot(f'<link name="a"><visual><geometry>{tag}</geometry></visual></link>')


def _joints(body: str, kind: str = "fixed") -> str:
    return robot(links("a", "b") + "{" + joint("a", "b", "j%", kind=kind, body=body) + "}")


_FRAMES = {
    "nested": '<robot name="r">{<a>}',
    "open-tags": "{<a }",
    "less-than": "{<}",
    "greater-than": "{>}",
    "ampersands": "{&}",
    "closing-tags": "{</a>}",
    "comments-opened": "{<!--}",
    "declarations": "{<?a?>}",
    "doctypes": "{<!a>}" + robot(_LINK),
    "cdata": robot(_LINK + "{<![CDATA[]]>}"),
    "blank": "{ }",
    "line-breaks": "{\n}" + robot(_LINK),
    "byte-order-marks": "{\ufeff}",
    "nul": "{\0}",
    "declaration-of-spaces": '<?xml{ }version="1.0"?>' + robot(_LINK),
    "ampersands-in-a-value": robot(_LINK, 'name="{&}"'),
    "references-in-a-value": robot(_LINK, 'name="{&#}"'),
    "hex-references-in-a-value": robot(_LINK, 'name="{&#x}"'),
    "entities-in-a-value": robot(_LINK, 'name="{&amp;}"'),
    "comments-in-a-value": robot(_LINK, 'name="{<!--}$"'),
    "returns-in-a-value": robot(_LINK, 'name="{\r}"'),
    "comments-after-the-end": robot(_LINK) + "</x>{<!--}$",
    "comments-with-a-dollar": robot(_LINK + "{<!--$-->}"),
    "dollars": robot(_LINK + "{$}"),
    "attributes": robot(_LINK, 'name="r"{ a%=""}'),
    "attributes-like-name": robot(_LINK, '{ nam%=""}'),
    "attributes-like-version": robot(_LINK, 'name="r"{ version%=""}'),
    "attributes-without-space": robot(_LINK, 'name="r"{a%=""}'),
    "attributes-of-an-inertia": robot(
        '<link name="a"><inertial><inertia{ ix%=""}/></inertial></link>'
    ),
    "namespaces": robot(_LINK, 'name="r"{ xmlns:a%="u"}'),
    "prefixed-tags": robot(_LINK + "{<x:y/>}"),
    "many-prefixes": robot(_LINK + "{<x%:y/>}"),
    "unknown-tags": robot(_LINK + "{<q/>}"),
    "misspelt-tags": robot(_LINK + "{<lnk/>}"),
    "many-misspelt-tags": robot(_LINK + "{<lin%/>}"),
    "long-name": robot(_LINK + "<{x}/>"),
    "digits": _in_shape('<sphere radius="{1}x"/>'),
    "digits-in-a-vector": _in_shape('<box size="{1}x"/>'),
    "numbers-in-a-vector": _in_shape('<box size="{1 }"/>'),
    "spaces-in-a-vector": _in_shape('<box size="1{ }x"/>'),
    "version": robot(_LINK, 'name="r" version="{1.}"'),
    "links": robot('{<link name="l%"/>}'),
    "links-of-one-name": robot("{" + _LINK + "}"),
    "bad-visuals": robot('<link name="a">{<visual/>}</link>'),
    "origins": robot('<link name="a"><visual>{<origin/>}</visual></link>'),
    "shapes": _in_shape('{<sphere radius="1"/>}'),
    "undefined-materials": robot(
        '<link name="a">{<visual><geometry><sphere radius="1"/></geometry><material name="m%"/></visual>}</link>'
    ),
    "materials": robot(_LINK + '{<material name="m%"/>}'),
    "joints-of-unknown-types": _joints("", kind="fixd"),
    "joints-of-unknown-links": robot(_LINK + '{<link name="l%"/>' + joint("k%", "lnk", "j%") + "}"),
    "mimics-of-unknown-joints": _joints('<mimic joint="k%"/>'),
    "mimics-of-themselves": _joints('<mimic joint="j%"/>'),
    "self-joints": robot('{<link name="l%"/>' + joint("l%", "l%", "j%") + "}"),
}


@pytest.mark.slow
@pytest.mark.parametrize("frame", spread(_FRAMES.values(), 2), ids=_FRAMES)
def test_a_megabyte_is_read_in_linear_time(frame: str) -> None:
    """Whatever a megabyte contains, it is read in linear time."""
    raw = _filled(frame)(_MEGABYTE).encode()
    with limited_work(300_000_000):
        read_urdf(raw)


@pytest.mark.slow
def test_many_attributes_are_read_in_linear_time() -> None:
    """An element with 300,000 attributes, of which none is a name, is not searched for a misspelt name."""
    attributes = " ".join(f'a{number}="1"' for number in range(300_000))
    with limited_work(20_000_000):  # a search in each attribute for each other one hangs
        assert (
            read_urdf(
                f'<robot name="r"><link name="a"/><link {attributes}/></robot>'.encode()
            ).verdict
            == "rejected"
        )


def test_deep_nesting() -> None:
    """A hundred thousand levels are refused at the 499th, without recursion."""
    text = f'<robot name="r">{"<a>" * 100_000}{"</a>" * 100_000}</robot>'
    with limited_work(200_000):
        assert codes(read_urdf(text.encode())) == ["URDF007"]


@pytest.mark.parametrize(
    "text",
    [
        robot(f'<link name="{"x" * 30_000}">{"<visual/>" * 3000}</link>'),
        robot(f'<link name="{"x" * 30_000}"/>' + joint("a", "b") * 300),
        robot(
            links(*(f"{index}{'x' * 3000}" for index in range(12)))
            + "".join(joint("p", "q", f"j{n}") for n in range(300))
        ),
        robot(f'<link name="a"/><material name="m"><color rgba="{"1" * 60_000}x"/></material>'),
        robot(f'<link name="a"><visual><origin xyz="{"1" * 60_000}x"/></visual></link>'),
        robot(links("a", "b") + "".join(joint("a", "b", f"j{n}") for n in range(600))),
        robot(links("a", "b") + joint("a", "b", "x" * 50_000, kind="y" * 10_000)),
        robot(links("a") + f'<{"x" * 60_000} {"y" * 3000}="1"/>'),
        f"<{'x' * 60_000}/>",
        f"<robot {'x' * 60_000}/>",
        f'<robot name="r"><{"x" * 30_000}></{"y" * 30_000}></robot>',
        robot("<lnk/>" * 10_000),
        "<!a>" * 10_000 + robot(links("a")),
    ],
    ids=[
        "bad-visuals-of-a-long-name",
        "unknown-links-among-long-names",
        "long-names-to-choose-from",
        "long-colour",
        "long-origin",
        "many-parents",
        "long-joint",
        "long-tag",
        "long-root",
        "long-attribute",
        "long-pair",
        "misspelt-tags",
        "doctypes",
    ],
)
def test_messages_are_not_much_longer_than_the_file(text: str) -> None:
    """Names and values are cut in messages, and the number of problems is limited."""
    read = read_urdf(text.encode())
    assert all(len(problem.message) < 5000 for problem in read.problems)
    assert len(read.problems) <= 1100
    assert sum(len(problem.message) for problem in read.problems) < 2_000_000
