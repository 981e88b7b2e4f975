"""Rubrics are loaded strictly: all mistakes are reported at once, each with its line; points are exact."""

import os
from dataclasses import replace
from decimal import Decimal
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from grader.checks.appearance import shows_box
from grader.errors import GraderError, InputError, RubricError
from grader.grading.criterion import Part
from grader.grading.rubric import Rubric, find_rubric, load_rubric, shipped_rubrics
from tests.examples import examples

GOOD = """\
id = "lab0"
title = "Lab 0"
[[part]]
id = "a"
title = "Part A"
[[criterion]]
id = "loads"
part = "a"
title = "It loads"
points = 1
check = "urdf_loads"
"""


def write(folder: Path, text: str | bytes) -> str:
    """Return the path of a rubric with this content."""
    path = folder / "rubric.toml"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return str(path)


def complaints(folder: Path, text: str | bytes) -> list[str]:
    """Return the mistakes of a rubric, without the file's name."""
    path = write(folder, text)
    with pytest.raises(RubricError) as caught:
        load_rubric(path)
    assert str(caught.value) == "\n".join(caught.value.complaints)
    assert all(line.startswith(f"{path}:") for line in caught.value.complaints)
    return [line.removeprefix(f"{path}:") for line in caught.value.complaints]


def announced(text: str) -> list[str]:
    """Return the complaints that a text announces in comments, each after `!!` on its expected line."""
    found = enumerate(text.split("\n"), 1)
    return [
        f"{number}: {text.strip()}" for number, line in found for text in line.partition("# !!")[2].split("!!") if text
    ]


def loaded(folder: Path, text: str) -> Rubric:
    """Return the rubric in a text without mistakes."""
    return load_rubric(write(folder, text))


# --- What a good rubric is --------------------------------------------------------------------------------------------


def test_a_rubric_keeps_its_values(tmp_path: Path) -> None:
    """Every key has its value, criteria are in the order of the file, arguments have the types of the check."""
    text = """
id = "lab0"
title = "Lab 0"
reference = "solution"
urdf = "urdf/robot.urdf"
folders = ["Lab 0", "lab-zero"]
points = 7.5

[[part]]
id = "a"
title = "Part A"
needs = "urdf"
points = 7.5

[[part]]
id = "b"
title = "Part B"
points = 0

[[criterion]]
id = "loads"
part = "a"
title = "It loads"
points = 2
check = "urdf_loads"

[[criterion]]
id = "box"
part = "a"
about = "The base"
title = "It is a box"
points = 5.5
check = "shows_box"
with = { link = "base", size = [1, 2.5, 3], tolerance = 0.002 }
requires = ["loads"]
feedback = "Look at its size."
"""
    rubric = loaded(tmp_path, text)
    assert (rubric.id, rubric.title, rubric.reference, rubric.urdf) == ("lab0", "Lab 0", "solution", "urdf/robot.urdf")
    assert rubric.folders == ("Lab 0", "lab-zero")
    assert rubric.parts == (Part("a", "Part A", "urdf"), Part("b", "Part B", "urdf"))
    assert rubric.points == Decimal("7.5")
    assert len(rubric.sha256) == 64
    loads, box = rubric.criteria
    assert (loads.id, loads.arguments, loads.requires, loads.feedback, loads.about) == ("loads", {}, (), "", "")
    assert (box.id, box.part, box.about, box.title) == ("box", "a", "The base", "It is a box")
    assert (box.points, box.requires, box.feedback) == (Decimal("5.5"), ("loads",), "Look at its size.")
    assert box.check.function is shows_box
    assert box.arguments == {"link": "base", "size": (1.0, 2.5, 3.0), "tolerance": 0.002}
    assert [type(number) for number in box.arguments["size"]] == [float] * 3


def test_optional_keys_have_defaults(tmp_path: Path) -> None:
    """A rubric needs ids, titles, points and checks; everything else has a default."""
    rubric = loaded(tmp_path, GOOD)
    assert (rubric.urdf, rubric.reference, rubric.folders) == ("robot.urdf", "", ())
    assert rubric.part("a") == Part("a", "Part A", "urdf")


def test_the_digest_is_of_the_bytes(tmp_path: Path) -> None:
    """Two files with the same meaning but different bytes are different rubrics."""
    one, other = loaded(tmp_path, GOOD), loaded(tmp_path, GOOD + "# a comment\n")
    assert one.sha256 != other.sha256
    assert one.criteria == other.criteria


@pytest.mark.parametrize("name", sorted(shipped_rubrics()))
def test_shipped_rubrics_load(name: str) -> None:
    """Every shipped rubric loads by its id, which is the name of its file."""
    rubric = load_rubric(name)
    assert rubric.id == name
    assert rubric.points > 0
    assert replace(load_rubric(str(shipped_rubrics()[name])), solution=rubric.solution) == rubric


def test_a_part_is_found_by_its_id(tmp_path: Path) -> None:
    """For an unknown part the error suggests a similar one or lists all."""
    rubric = loaded(tmp_path, GOOD.replace('"a"', '"task1"'))
    assert rubric.part("task1").title == "Part A"
    with pytest.raises(InputError, match="the rubric lab0 has no part 'task2'; did you mean 'task1'"):
        rubric.part("task2")
    with pytest.raises(InputError, match="the rubric lab0 has no part 'zzz'; it has: task1"):
        rubric.part("zzz")


def test_an_id_is_one_word_and_a_title_one_line(tmp_path: Path) -> None:
    """An id with spaces or control characters is refused; a title may be broken in the file, but not in reports."""
    for bad in ("a b", "a\\u001b", "a\\nb"):
        (reported,) = complaints(tmp_path, GOOD.replace('id = "loads"', f'id = "{bad}"'))
        assert "id must be one printable word" in reported
    rubric = loaded(tmp_path, GOOD.replace('title = "Part A"', 'title = """Part\n  A"""'))
    assert rubric.parts[0].title == "Part A"


# --- Many mistakes at once --------------------------------------------------------------------------------------------

NAMES = "a list of names of folders, each with a letter or digit and without a slash"
EVERY_KIND_OF_MISTAKE = """\
id = ""  # !! id must be one printable word, not ''
titel = "Lab 0"  # !! a rubric has no key 'titel'; did you mean 'title'?
urdf = 3  # !! urdf must be a string, not 3
title = "Lab 0"

[[part]]
id = "task1"
title = "Task 1"
needs = "udrf"  # !! needs must be one of urdf, package, files, not 'udrf'
colour = "red"  # !! a part has no key 'colour'; it has: id, title, needs, points

[[part]]  # !! this part has no title
id = "task1"  # !! the part 'task1' is already used

[[criterion]]
id = "one"
part = "task1"
title = "One"
points = 2
check = "shows_boxx"  # !! there is no check 'shows_boxx'; did you mean 'shows_box'?

[[criterion]]  # !! this criterion has no title !! this criterion has no points !! this criterion has no check
id = "two"
part = "taks1"  # !! there is no part 'taks1'; did you mean 'task1'?

[[criterion]]
id = "three"
part = "task1"
title = "Three"
points = "2"  # !! points must be a number, not '2'
check = "shows_box"
with = { link = "base", sise = [1, 2, 3], tolerance = "a" }  # !! the check shows_box takes no 'sise'; did you mean 'size'?\
 !! tolerance of shows_box must be a number, not 'a' !! the check shows_box needs size: 3 numbers

[[criterion]]
id = "three"  # !! the criterion 'three' is already used
part = "task1"
title = " "  # !! title must be a non-empty string, not ' '
points = -1  # !! points must be a number from 0 to 1000000, not -1
check = "urdf_loads"
requires = ["on"]  # !! requires 'on', which does not exist; did you mean 'one'?

[[criterion]]
id = "four"
part = "task1"
title = "Four"
points = 1
check = "urdf_loads"
requires = ["five", "one", 3]  # !! requires must be a list of strings, not ['five', 'one', 3] !! requires 'five', which is below:\
 a criterion can only require those above it
feedback = ["a"]  # !! feedback must be a string, not ['a']
about = true  # !! about must be a string, not true
choices = { "short" = 1 }  # !! choices must be a table of at most 9 comments without a\
 semicolon, each with points below 0, not { short = 1 }

[[criterion]]
id = "five"
part = "task1"
title = "Five"
points = 7.5
check = "urdf_loads"
with = { link = "base" }  # !! the check urdf_loads takes no 'link'; it takes: nothing
pints = 3  # !! a criterion has no key 'pints'; did you mean 'points'?
choices = { "one; two" = -1 }  # !! choices must be a table of at most 9 comments without a\
 semicolon, each with points below 0, not { one; two = -1 }
"""


def test_every_mistake_is_reported_at_once(tmp_path: Path) -> None:
    """All mistakes are reported in the order of the file, each with its line."""
    found = complaints(tmp_path, EVERY_KIND_OF_MISTAKE)
    assert found == announced(EVERY_KIND_OF_MISTAKE)
    assert len(found) >= 25


def instead(old: str, new: str) -> str:
    """Return a rubric with another line, or with one before its first."""
    assert not old or old in GOOD
    return GOOD.replace(old, new) if old else f"{new}\n{GOOD}"


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ('check = "urdf_loads"\n', 'check = "urdf_loads"\nwith = 3  # !! with must be a table, not 3'),
        ('check = "urdf_loads"\n', 'check = "urdf_loads"\nwith = []  # !! with must be a table, not []'),
        ('part = "a"', "part = \"a\"\nrequires = 'loads'  # !! requires must be a list of strings, not 'loads'"),
        ("points = 1", "points = true  # !! points must be a number, not true"),
        ("points = 1", "points = 07:32:00  # !! points must be a number, not 07:32:00"),
        ("points = 1", "points = -0.5  # !! points must be a number from 0 to 1000000, not -0.5"),
        ("points = 1", "points = inf  # !! points must be a number, not Infinity"),
        ("points = 1", "points = -nan  # !! points must be a number, not -NaN"),
        ("points = 1", "points = 0.00001  # !! points must be a number with at most 4 decimals, not 0.00001"),
        ('id = "loads"', "id = [\"loads\"]  # !! id must be a string, not ['loads']"),
        ('id = "loads"', "id = \"\\t \"  # !! id must be one printable word, not '\\t '"),
        ("", "folders = \"Lab0\"  # !! folders must be a list of strings, not 'Lab0'"),
        ("", "folders = []  # !! folders must be a list of strings, not []"),
        ("", "folders = ['Lab0', 3]  # !! folders must be a list of strings, not ['Lab0', 3]"),
        ("", f"folders = ['Lab0', '-']  # !! folders must be {NAMES}, not ['Lab0', '-']"),
        ("", f"folders = ['labs/Lab0']  # !! folders must be {NAMES}, not ['labs/Lab0']"),
        ('check = "urdf_loads"', "check = 3  # !! check must be a string, not 3"),
        ('title = "Part A"', 'title = "A"\nneeds = 3  # !! needs must be one of urdf, package, files, not 3'),
        ('title = "Part A"', 'title = "A"\npoints = "1"  # !! points must be a number, not \'1\''),
    ],
)
def test_a_value_of_the_wrong_type_is_reported(tmp_path: Path, old: str, new: str) -> None:
    """The complaint names the actual and the expected type, on the line of the key."""
    assert complaints(tmp_path, instead(old, new)) == announced(instead(old, new))


@pytest.mark.parametrize("number", [1, 2, 4, 5, 7, 8, 9, 10, 11])
def test_every_key_is_needed(tmp_path: Path, number: int) -> None:
    """What is missing at the top level is reported for the first line, else for the header of its table."""
    lines = GOOD.split("\n")
    key = lines.pop(number - 1).partition(" ")[0]
    where = "1: this rubric" if number < 3 else "3: this part" if number < 6 else "6: this criterion"
    assert complaints(tmp_path, "\n".join(lines))[0] == f"{where} has no {key}"


def test_a_rubric_has_parts_and_criteria(tmp_path: Path) -> None:
    """Without a part or a criterion there is nothing to grade; a single table is not an array of them."""
    missing = ["1: this rubric has no part", "1: this rubric has no criterion"]
    assert complaints(tmp_path, 'id = "r"\ntitle = "R"\n') == missing
    for empty in ("", "\n\n", "# only a comment\n"):
        named = ["1: this rubric has no id", "1: this rubric has no title"]
        assert complaints(tmp_path, empty) == named + missing, empty
    single = 'id = "r"\ntitle = "R"\n[part]\nid = "a"\n[criterion]\nid = "c"\n'
    assert complaints(tmp_path, single) == [
        "3: part must be one or more [[part]] tables, not { id = 'a' }",
        "5: criterion must be one or more [[criterion]] tables, not { id = 'c' }",
    ]
    assert complaints(tmp_path, 'id = "r"\ntitle = "R"\npart = [1]\ncriterion = []\n') == [
        "3: part must be one or more [[part]] tables, not [1]",
        "4: criterion must be one or more [[criterion]] tables, not []",
    ]


# --- Arguments --------------------------------------------------------------------------------------------------------


def checked(check: str, given: str) -> str:
    """Return a rubric with one check and its arguments, on line 12."""
    return GOOD.replace("urdf_loads", check) + given


BOX = 'link = "base", size = [1, 1, 1], tolerance = 0.1'
BOTTOMS = 'links = ["a"], relative_to = "b", height = 0, tolerance = 1'


LINKS = "links of bottoms_at_height must be "
CENTRE = 'link = "a", relative_to = "b", xyz = [0, 0, 0], tolerance = 1'
TYPED = (
    ("shows_box", BOX.replace("[1, 1, 1]", "[1, 1]"), "size of shows_box must be 3 numbers, not [1, 1]"),
    ("shows_box", BOX.replace("[1, 1, 1]", "[1, 1, 1, 1]"), "size of shows_box must be 3 numbers, not [1, 1, 1, 1]"),
    ("shows_box", BOX.replace("[1, 1, 1]", "1"), "size of shows_box must be 3 numbers, not 1"),
    ("shows_box", BOX.replace("[1, 1, 1]", f"[1, 1, -1{'0' * 400}]"), "size of shows_box must be "),
    ("shows_box", BOX.replace('"base"', "3"), "link of shows_box must be a string, not 3"),
    ("shows_box", BOX.replace('"base"', f'["{"a" * 999}"]'), "link of shows_box must be "),
    ("shows_box", BOX.replace("0.1", '"0.1"'), "tolerance of shows_box must be a number, not '0.1'"),
    ("shows_box", BOX.replace("0.1", "true"), "tolerance of shows_box must be "),
    ("shows_box", BOX.replace("0.1", "1979-05-27"), "tolerance of shows_box must be "),
    ("shows_box", BOX.replace("0.1", "nan"), "tolerance of shows_box must be a number, not NaN"),
    ("shows_box", BOX.replace("0.1", "inf"), "tolerance of shows_box must be a number, not Infinity"),
    ("shows_box", BOX.replace("0.1", "1e400"), "tolerance of shows_box must be "),
    ("shows_box", BOX.replace("0.1", f"1{'0' * 400}"), "tolerance of shows_box must be "),
    ("shows_box", BOX.replace(", tolerance = 0.1", ""), "the check shows_box needs tolerance: a number"),
    ("shows_box", BOX + ", links = 3", "the check shows_box takes no 'links'; it takes: link, size, tolerance"),
    ("bottoms_at_height", BOTTOMS.replace('["a"]', '"a"'), f"{LINKS}a list of strings, not 'a'"),
    ("bottoms_at_height", BOTTOMS.replace('["a"]', "[]"), f"{LINKS}a list of strings, not []"),
    ("bottoms_at_height", BOTTOMS.replace('["a"]', '["a", 1]'), LINKS),
    ("joints_named", 'parent = "a", joints = ["j"]', "joints of joints_named must be a table of strings, not ['j']"),
    ("joints_named", 'parent = "a", joints = { j = true, k = [nan] }',
     "joints of joints_named must be a table of strings, not { j = true, k = [NaN] }"),
    ("joints_named", 'parent = "a", joints = {}', ""),
    ("centre_at", f"{CENTRE}, rigid = 1", "rigid of centre_at must be "),
    ("shows_colour", 'link = "a", colour = [0, 1], tolerance = 0', ""),
    ("shows_colour", 'link = "a", colour = [0, 1, 0, 1, 1], tolerance = 0', ""),
)  # fmt: skip


@pytest.mark.parametrize(("check", "given", "complaint"), TYPED)
def test_wrong_arguments_are_reported(tmp_path: Path, check: str, given: str, complaint: str) -> None:
    """Unknown arguments, missing ones, and those of another type: nothing is converted, nothing is infinite."""
    (found,) = complaints(tmp_path, checked(check, f"with = {{ {given} }}\n"))
    assert found.startswith(f"12: {complaint}")
    assert len(found) < 150
    assert not complaint or complaint.endswith(" ") or found == f"12: {complaint}"


def test_arguments_become_what_the_check_takes(tmp_path: Path) -> None:
    """Integers are accepted as floats; lists become tuples if the check has one; defaults stay with the check."""
    given = 'with = { link = "w", base = "b", forward = [1, 0, 0], tolerance = 1 }'
    (criterion,) = loaded(tmp_path, checked("rolls_forward", given)).criteria
    assert criterion.arguments == {"link": "w", "base": "b", "forward": (1.0, 0.0, 0.0), "tolerance": 1.0}
    assert isinstance(criterion.arguments["forward"], tuple)
    assert isinstance(criterion.arguments["tolerance"], float)


# --- requires ---------------------------------------------------------------------------------------------------------


def row(name: str, *, requires: str = "[]", part: str = "a", points: str = "1") -> str:
    """Return a criterion in seven lines; its requirement is on the last."""
    return (
        f'[[criterion]]\nid = "{name}"\npart = "{part}"\ntitle = "T"\npoints = {points}\ncheck = "urdf_loads"\n'
        f"requires = {requires}\n"
    )


def test_only_earlier_criteria_can_be_required(tmp_path: Path) -> None:
    """File order is run order: a cycle cannot be written."""
    rubric = loaded(tmp_path, GOOD + row("b", requires='["loads"]') + row("c", requires='["b", "loads"]'))
    assert [criterion.requires for criterion in rubric.criteria] == [(), ("loads",), ("b", "loads")]
    assert complaints(tmp_path, GOOD + row("b", requires='["c"]') + row("c", requires='["b"]')) == [
        "18: requires 'c', which is below: a criterion can only require those above it"
    ]


# --- Points -----------------------------------------------------------------------------------------------------------


def worth(*points: str, total: str = "", part: str = "") -> str:
    """Return a rubric with criteria of these points, and the declared totals."""
    declared = f"points = {total}\n" if total else ""
    own = f"points = {part}\n" if part else ""
    head = f'id = "r"\ntitle = "R"\n{declared}[[part]]\nid = "a"\ntitle = "A"\n{own}'
    return head + "".join(row(f"c{index}", points=value) for index, value in enumerate(points))


@pytest.mark.parametrize(
    ("points", "total"),
    [
        (("0.1", "0.2"), "0.3"),
        (("0.1",) * 10, "1"),
        (("0.33", "0.33", "0.34"), "1.0"),
        (("1e-3", "0.999"), "1"),
        (("1", "2", "0"), "3"),
        (("0.1", "0.7"), "8e-1"),
        (("1_000.5", "0.5"), "1_001"),
        (("0.0001", "1"), "1.0001"),
        (("0.50000", "0.5"), "1"),
    ],
)
def test_points_are_exact(tmp_path: Path, points: tuple[str, ...], total: str) -> None:
    """Points add up as on paper, not as floats do."""
    rubric = loaded(tmp_path, worth(*points, total=total, part=total))
    assert rubric.points == Decimal(total)
    assert [criterion.points for criterion in rubric.criteria] == [Decimal(value) for value in points]
    assert all(isinstance(criterion.points, Decimal) for criterion in rubric.criteria)


@examples(10)
@given(cents=st.lists(st.integers(0, 10_000), min_size=1, max_size=20))
def test_any_points_in_hundredths_add_up(tmp_path_factory: pytest.TempPathFactory, cents: list[int]) -> None:
    """However many criteria share the points, the declared total is their exact sum, and one cent more is refused."""
    folder = tmp_path_factory.getbasetemp()
    points = [f"{cent // 100}.{cent % 100:02d}" for cent in cents]
    total, wrong = (f"{cent // 100}.{cent % 100:02d}" for cent in (sum(cents), sum(cents) + 1))
    assert loaded(folder, worth(*points, total=total, part=total)).points * 100 == sum(cents)
    assert len(complaints(folder, worth(*points, total=wrong, part=wrong))) == 2


def test_a_late_policy_is_read(tmp_path: Path) -> None:
    """Missing values have their defaults; the deadline keeps its offset."""
    policy = "[late]\ndue = 2026-11-20T23:59:00+01:00\npercent_per_day = 10.5\n"
    late = loaded(tmp_path, worth("1") + policy).late
    assert late is not None
    assert late.due is not None
    assert late.due.isoformat() == "2026-11-20T23:59:00+01:00"
    assert [late.grace_minutes, late.percent_per_day, late.floor_percent] == [Decimal(0), Decimal("10.5"), Decimal(0)]
    assert loaded(tmp_path, worth("1")).late is None


@pytest.mark.parametrize(
    ("line", "complaint"),
    [
        ("percent_per_day = 101", "percent_per_day must be a number from 0 to 100, not 101"),
        ("percent_per_day = nan", "percent_per_day must be a number, not NaN"),
        ("percent_per_day = 1\ngrace_minutes = -1", "grace_minutes must be a number from 0 to 1000000, not -1"),
        ("percent_per_day = 1\nfloor_percent = true", "floor_percent must be a number, not true"),
        ("grace_minutes = 5", "this late policy has no percent_per_day"),
        ("percent_per_day = 1\nper_hour = 1", "a late policy has no key 'per_hour'"),
        ("percent_per_day = 1\ndue = 2026-11-20T23:59:00", "due must be a date and time with its offset"),
    ],
)
def test_mistakes_in_a_late_policy_are_named(tmp_path: Path, line: str, complaint: str) -> None:
    """A policy that cannot be applied is a mistake of the rubric, not of a student."""
    found = complaints(tmp_path, worth("1") + f"[late]\n{line}\n")
    assert len(found) == 1
    assert found[0].split(": ", 1)[1].startswith(complaint)


def test_a_part_is_worth_its_own_criteria(tmp_path: Path) -> None:
    """Points of another part do not count."""
    second = '[[part]]\nid = "b"\ntitle = "B"\npoints = 2\n'
    text = worth("1", total="3", part="1").replace("[[criterion]]", second + "[[criterion]]", 1)
    assert loaded(tmp_path, text + row("last", part="b", points="2")).points == 3
    assert complaints(tmp_path, text + row("last", part="b", points="3")) == [
        "3: the rubric declares 3 points, but its criteria add up to 4",
        "11: part 'b' declares 2 points, but its criteria add up to 3",
    ]


AFTER_TEXTS = r'''feedback = """
[[criterion]]
id = "not a key"
# no comment \
  \""" still "text" """
# [[criterion]] in a comment
[[criterion]]   # a second one
id = 'two' # 'quoted' "in" comment
part = "a"
title = """
"""
requires = [ # [ ] "
  "loads", # one
  'lods', # two ]
]
"points" = -1
'check' = "urdf_load"
'''
ARGUMENTS = '[criterion.with]\nparent = 3\n\n[criterion.with.joints]\n# a joint\nj = "lidar"\nk = 4\n'
OWN_TABLE = '\n# the arguments\n[criterion.with]\nlink = "base"\nsize = [1, 2]\n'
HINTS = "[[criterion.hint]]\nx = 1\n" * 2
# What is added to a rubric, or a whole one, and the beginnings of the complaints.
# What is added to a rubric, or a whole one, and its complaints, of which the end may be omitted.
PLACES = {
    "misspelt argument": (
        checked("shows_box", f"with = {{ {BOX.replace('link', 'lnk')} }}\n"),
        """12: the check shows_box takes no 'lnk'; did you mean 'link'?
           12: the check shows_box needs link: a string""",
    ),
    "no arguments": (
        checked("rolls_forward", ""),
        """6: the check rolls_forward needs link: a string
           6: the check rolls_forward needs base: a string
           6: the check rolls_forward needs tolerance: a number""",
    ),
    "arguments in a table": (
        checked("shows_box", OWN_TABLE),
        """14: the check shows_box needs tolerance: a number
           16: size of shows_box must be 3 numbers, not [1, 2]""",
    ),
    "arguments in two tables": (
        checked("joints_named", ARGUMENTS),
        """13: parent of joints_named must be a string, not 3
           15: joints of joints_named must be a table of strings, not { j = 'lidar', k = 4 }""",
    ),
    "dotted arguments": (
        checked("joints_named", 'with.parent = 3\nwith.joints.j = "lidar"\nwith.jionts = 3\n'),
        """12: parent of joints_named must be a string, not 3
           14: the check joints_named takes no 'jionts'; it takes: parent, joints""",
    ),
    "requires itself": (GOOD + row("b", requires='["b"]'), "18: requires itself"),
    "requires nothing": (
        GOOD + row("b", requires='["load", "zzz", "loads"]'),
        """18: requires 'load', which does not exist; did you mean 'loads'?
           18: requires 'zzz', which does not exist""",
    ),
    "totals": (
        worth("0.1", "0.2", total="0.3001", part="1"),
        """3: the rubric declares 0.3001 points, but its criteria add up to 0.3
           7: part 'a' declares 1 points, but its criteria add up to 0.3""",
    ),
    "points, not totals": (worth("1", '"2"', total="3", part="3"), "19: points must be a number, not '2'"),
    "multi-line values": (
        GOOD + AFTER_TEXTS,
        """21: title must be a non-empty string, not ''
           23: requires 'lods', which does not exist; did you mean 'loads'?
           27: points must be a number from 0 to 1000000, not -1
           28: there is no check 'urdf_load'; did you mean 'urdf_loads'?""",
    ),
    "reserved id": (
        GOOD.replace('"loads"', '"total"'),
        "7: the id 'total' is reserved for final marks: choose another one",
    ),
    "adjusted by a number": (GOOD + "[adjust]\nloads = 3\n", "13: the adjustment of loads must be a table, not 3"),
    "tables in a criterion": (GOOD + HINTS + row("b", points="-1"), "12: a criterion has no key\n20: points must"),
    "quotes before quotes": (
        GOOD + 'feedback = """He said "yes"""" # ["\nrequires = ["""a"""", "[b"]\npints = 1\n',
        "13: requires 'a\"'\n13: requires '[b'\n14: a criterion has no key 'pints'",
    ),
}


@pytest.mark.parametrize("name", PLACES)
def test_every_mistake_has_its_line(tmp_path: Path, name: str) -> None:
    """The line is that of the key, of the table that lacks one, or of the criterion; nothing is repeated."""
    text, expected = PLACES[name]
    found = complaints(tmp_path, text)
    assert len(found) == expected.count("\n") + 1, found
    assert all(line.startswith(start.strip()) for line, start in zip(found, expected.split("\n"), strict=True)), found


@pytest.mark.parametrize(
    ("line", "table", "key"),
    [
        ('"a rubric" = 1', "rubric", "a rubric"), ("'quo.ted' = 1", "rubric", "quo.ted"),
         ("extra.deep = 1", "rubric", "extra"),
        ("[extra]", "", "extra"), ("[extra.deep]", "", "extra"), ("[[extra.deep]]", "", "extra"),
        ("[ 'extra' . deep ] # and more", "", "extra"),
        ("hint.text.more = 1", "criterion", "hint"), ("'hint'.x = 1", "criterion", "hint"),
        ("hint = { a = 1 }", "criterion", "hint"), ("[criterion.hint.deep]", "criterion", "hint"),
    ],
)  # fmt: skip
def test_an_unknown_key_has_its_line(tmp_path: Path, line: str, table: str, key: str) -> None:
    """However an unknown key is written, the complaint has its line."""
    at_the_top = table == "rubric"
    text = GOOD.replace("[[part]]", line + "\n[[part]]") if at_the_top else GOOD + line + "\n"
    (found,) = complaints(tmp_path, text)
    assert found.startswith(f"{3 if at_the_top else 12}: a {table or 'rubric'} has no key {key!r};")


@pytest.mark.parametrize(
    "points",
    ["1e9999999", "9e999999", "1" + "0" * 5000, "0x" + "f" * 5000, "1e-9999999", "1e9999999999999999999"],
    ids=["exponent", "sum", "digits", "hexadecimal", "small", "no-decimal"],
)
def test_huge_numbers_cause_no_crash(tmp_path: Path, points: str) -> None:
    """Huge points are loaded or reported as a mistake in the rubric."""
    try:
        assert loaded(tmp_path, worth(points, points)).points >= 0
    except RubricError as error:
        assert error.complaints


# --- Files ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "text",
    [
        "x = " + "[" * 100_000,
        "x = " + "[" * 5000 + "]" * 5000,
        "x = " + "{a=" * 5000 + "1" + "}" * 5000,
        "[" + ".".join("a" * 5000) + "]\nx = 1\n",
        ".".join("a" * 5000) + " = 1\n",
        "x = '''" + "[" * 100_000 + "'''\n",
    ],
    ids=["open", "arrays", "inline-tables", "header", "dotted", "only-text"],
)
def test_deep_nesting_causes_no_crash(tmp_path: Path, text: str) -> None:
    """Endless brackets are a mistake in the rubric, which is reported."""
    assert complaints(tmp_path, GOOD + text)


def test_windows_line_endings(tmp_path: Path) -> None:
    """A rubric written on Windows loads, and its mistakes have the same lines."""
    windows = GOOD.replace("\n", "\r\n")
    assert loaded(tmp_path, windows).criteria == loaded(tmp_path, GOOD).criteria
    assert complaints(tmp_path, EVERY_KIND_OF_MISTAKE.replace("\n", "\r\n")) == announced(EVERY_KIND_OF_MISTAKE)


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    """What is missing is unreadable input; a folder and a pipe are refused at once, and a huge file is not read."""
    with pytest.raises(InputError, match=r"cannot read .*nothing\.toml: No such file or directory"):
        load_rubric(str(tmp_path / "nothing.toml"))
    (tmp_path / "lab.toml").mkdir()
    for path in (tmp_path, tmp_path / "lab.toml"):
        with pytest.raises(InputError, match=r"cannot read|is not a regular file"):
            load_rubric(str(path))
    os.mkfifo(tmp_path / "pipe.toml")
    with pytest.raises(InputError, match="not a regular file"):
        load_rubric(str(tmp_path / "pipe.toml"))
    with pytest.raises(InputError, match="larger than"):
        load_rubric(write(tmp_path, GOOD + "#" * (1 << 21)))


@pytest.mark.parametrize(
    ("name", "guess"), [("lab", "lab6"), ("lab66", "lab6"), ("LAB6", "lab6"), ("l6", None), ("zzz", None)]
)
def test_an_unknown_id_is_reported_with_a_suggestion(name: str, guess: str | None) -> None:
    """The error suggests a similar id and names the command that lists all."""
    with pytest.raises(RubricError) as caught:
        load_rubric(name)
    (line,) = caught.value.complaints
    assert line.startswith(f"there is no rubric {name!r}")
    assert (f"did you mean {guess!r}?" if guess else f"write ./{name} for a file") in line
    assert line.endswith(" (`grader rubric list` lists the rubrics that come with the grader)")


def test_a_file_is_found_by_its_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A name with a folder or an ending is a path; a bare word is an id, whatever files exist."""
    monkeypatch.chdir(tmp_path)
    Path("lab6").write_text(GOOD)
    Path("mine").write_text(GOOD)
    assert find_rubric("lab6") == shipped_rubrics()["lab6"]
    with pytest.raises(RubricError, match=r"write \./mine for a file"):
        find_rubric("mine")
    assert find_rubric("./mine") == Path("mine")
    assert find_rubric("./lab6") == Path("lab6")
    assert find_rubric("gone.toml") == Path("gone.toml")
    assert load_rubric("./lab6").id == "lab0"


def test_a_path_is_shown_without_control_characters(tmp_path: Path) -> None:
    """A file's name is data: it cannot colour the terminal."""
    path = tmp_path / "a\x1b[31m.toml"
    path.write_text("")
    with pytest.raises(RubricError) as caught:
        load_rubric(str(path))
    assert "\x1b" not in str(caught.value)
    with pytest.raises(GraderError) as other:
        load_rubric(str(tmp_path / "\x1b[31m.toml"))
    assert "\x1b" not in str(other.value)


# --- Lines ------------------------------------------------------------------------------------------------------------
