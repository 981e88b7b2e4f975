"""`load_yaml`: values of a file in the submission, dotted access, units."""

from tests.xacro.documents.document import Documents, bodies, merged, named, part, shown

_YAML = """\
# sizes of the robot
wheel: {radius: 0.1, length: 5.0e-2, name: left, "quoted": "1"}
base:
  size: [0.6, 0.4, 0.2]
  mass: 5
  color:
    rgba: 0 0.6 0 1
    known: yes
    missing: null
    also_missing: ~
  parts: [{name: a, x: 1}, {name: b, x: 2}]
angle: !degrees 90
height: !millimeters 200
width: !inches 10
plain: !meters 0.5
text: |
  two
  lines
hex: 0x10
exponent: 1e-3
true_text: "true"
truth: true
list-key: 1
1: one
copied: &c {k: v}
again: *c
"""
_FILES: dict[str, str | bytes] = {
    "config/robot.yaml": _YAML,
    "urdf/unit_of_list.yaml": "a: !degrees [1, 2]\n",
    "urdf/anchor_twice.yaml": "a: &x 1\nb: &x 2\n",
    "urdf/date.yaml": "a: 2020-01-02\n",
    "urdf/octal.yaml": "a: 010\n",
    "urdf/merged.yaml": "a: &a {k: v}\nb: {<<: *a, l: w}\n",
    "urdf/sexagesimal.yaml": "a: 1:30\n",
    "urdf/underscore.yaml": "a: 1_000\n",
    "urdf/units.yaml": "turn: !radians pi/2\ndepth: !foot 1 + 1\nnegative: !degrees -45.5\n",
    "urdf/near.yaml": "a: 1\n",
    "urdf/list.yaml": "- 1\n- {b: 2}\n- [3, 4]\n",
    "urdf/number.yaml": "3.5\n",
    "urdf/text.yaml": "hello\n",
    "urdf/empty.yaml": "",
    "urdf/broken.yaml": "a: [1\n",
    "urdf/tabs.yaml": "a:\n\tb: 1\n",
    "urdf/two.yaml": "a: 1\n---\nb: 2\n",
    "urdf/unknown_tag.yaml": "a: !furlong 1\n",
    "urdf/bad_unit.yaml": "a: !degrees ninety\n",
    "urdf/bad_unit_syntax.yaml": "a: !degrees 1 +\n",
    "urdf/python_tag.yaml": "a: !!python/object/apply:os.getcwd []\n",
    "urdf/twice.yaml": "a: 1\na: 2\n",
    "urdf/expression.yaml": "a: ${1 + 1}\nb: 1 + 1\n",
    "urdf/latin.yaml": b"a: \xe9\n",
    "urdf/parts/loads.xacro": part(named("inner", "${xacro.load_yaml('inner.yaml')}") + shown("${inner['v']}")),
    "urdf/parts/inner.yaml": "v: 7\n",
    "urdf/keys.yaml": "keys: 1\nitems: [2]\nget: 3\n",
    "urdf/nested.yaml": "a: {b: {c: {d: 4}}}\n",
    "parts/found.yaml": "v: 8\n",
}


def loaded(*texts: str, file: str = "../config/robot.yaml") -> str:
    """Return elements that show values of a YAML file, which is the property `y`."""
    return named("y", f"${{xacro.load_yaml('{file}')}}") + shown(*texts)


def near(name: str, *texts: str) -> str:
    """Return elements that show values of a YAML file beside the document."""
    return loaded(*texts, file=name + ".yaml")


_VALUES = bodies(
    files=_FILES,
    index=loaded("${y['wheel']['radius']}", "${y['base']['size'][1]}"),
    dotted=loaded("${y.wheel.radius}", "${y.base.size[1]}", "${y.base.color.rgba}"),
    mixed=loaded("${y.base['mass'] * 2}", "${y['base'].mass / 2}"),
    exponent=loaded("${y.wheel.length}", "${y.exponent}"),
    text_of_number=loaded("${y.wheel.quoted}", "${y.wheel.quoted + 1}"),
    quoted_number=loaded("${y.wheel.quoted}"),
    booleans=loaded("${y.base.color.known}", "${y.truth}", "${y.true_text}"),
    condition=loaded("1") + '<xacro:if value="${y.base.color.known}"><a/></xacro:if>',
    list_of_dicts=loaded("${y.base.parts[1].x}", "${[p.name for p in y.base.parts]}"),
    list_shown=loaded("${y.base.size}", "${y.base.parts}"),
    dict_shown=loaded("${y.wheel}"),
    degrees=loaded("${y.angle}", "${y.angle == pi / 2}"),
    unit_expressions=near("units", "${y.turn}", "${y.depth}", "${y.negative}"),
    lines=loaded("${y.text}"),
    hex=loaded("${y.hex}"),
    key_with_dash=loaded("${y['list-key']}"),
    key_number=loaded("${y[1]}"),
    missing_key=loaded("${y.nothing}"),
    missing_index=loaded("${y['nothing']}"),
    missing_position=loaded("${y.base.size[9]}"),
    get=loaded("${y.get('nothing', 5)}", "${y.get('wheel')['radius']}"),
    membership=loaded("${'wheel' in y}", "${'x' in y}", "${len(y.wheel)}"),
    keys=loaded("${list(y.wheel.keys())}", "${[k for k in y.wheel]}"),
    aliases=loaded("${y.again.k}"),
    vector=loaded("${' '.join([str(v) for v in y.base.size])}", "${y.base.size[0]} ${y.base.size[1]} 1"),
    in_macro="<xacro:macro name='m' params='v'>" + shown("${v.radius}") + "</xacro:macro>" + loaded("1") + '<xacro:m v="${y.wheel}"/>',
    forwarded="<xacro:macro name='m' params='y:=^'>" + shown("${y.wheel.radius}") + "</xacro:macro>" + loaded("1") + "<xacro:m/>",
    recursion="<xacro:macro name='m' params='l'><xacro:if value='${l}'>"
    + shown("${l[0].x}")
    + "<xacro:m l='${l[1:]}'/></xacro:if></xacro:macro>"
    + loaded("1")
    + '<xacro:m l="${y.base.parts}"/>',
    sum=loaded("${python.sum(y.base.size)}", "${max(y.base.size)}"),
    property_of_it=loaded("1") + named("w", "${y.wheel}") + shown("${w.radius}", "${w['name']}"),
    eager=named("y", "${xacro.load_yaml('near.yaml')}", 'lazy_eval="false"') + shown("${y.a}"),
    name_in_property=named("file", "near.yaml") + named("y", "${xacro.load_yaml(file)}") + shown("${y.a}"),
    old_name=named("y", "${load_yaml('near.yaml')}") + shown("${y['a']}"),
    direct=shown("${xacro.load_yaml('near.yaml').a}"),
    nested=near("nested", "${y.a.b.c.d}", "${y['a']['b']['c']['d']}"),
    of_list=near("list", "${y[0]}", "${y[1].b}", "${y[2][1]}", "${y}"),
    of_number=near("number", "${y + 1}"),
    of_text=near("text", "${y + ' world'}"),
    of_nothing=near("empty", "${y}"),
    key_like_method=near("keys", "${y['keys']}", "${y['get']}"),
    duplicate_key=near("twice", "${y.a}"),
    expression_in_value=near("expression", "${y.a}", "${y.b}"),
    expression_in_value_of_property=near("expression", "1") + named("p", "${y.a}") + shown("${p}"),
    relative_to_the_included_file='<xacro:include filename="parts/loads.xacro"/>',
)  # fmt: skip

_REFUSED = bodies(
    files=_FILES,
    missing_file=near("missing", "${y}"),
    missing_file_unused=near("missing", "1"),
    folder=loaded("${y}", file="parts"),
    broken=near("broken", "${y}"),
    unit_of_list=near("unit_of_list", "${y}"),
    anchor_twice=near("anchor_twice", "${y}"),
    tabs=near("tabs", "${y}"),
    two_documents=near("two", "${y}"),
    without_name=shown("${xacro.load_yaml()}"),
    name_is_number=shown("${xacro.load_yaml(['a'])}"),
    number_has_no_key=near("number", "${y.a}"),
    list_has_no_name=near("list", "${y.a}"),
)

_OUTSIDE = merged(
    bodies(
        "perhaps",
        _FILES,
        date=near("date", "${y}"),
        octal=near("octal", "${y}"),
        merged=near("merged", "${y}"),
        bad_unit=near("bad_unit", "${y}"),
        bad_unit_syntax=near("bad_unit_syntax", "${y}"),
        unknown_tag=near("unknown_tag", "${y}"),
        python_tag=near("python_tag", "${y}"),
        latin=near("latin", "${y}"),
        found=loaded("${y.v}", file="$(find arm_parts)/found.yaml"),
        found_root=loaded("${y.wheel.radius}", file="$(find my_robot)/config/robot.yaml"),
        key_like_method_dotted=near("keys", "${y.keys}"),
    ),
    bodies("always", _FILES, found_elsewhere=loaded("${y.v}", file="$(find other_description)/a.yaml") + '<link name="a"/>'),
)  # fmt: skip

DOCUMENTS: Documents = merged(_VALUES, _REFUSED, _OUTSIDE)
