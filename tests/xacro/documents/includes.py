"""Included files: relative paths, packages, namespaces, patterns, optional files."""

from tests.xacro.documents.document import Document, Documents, bodies, merged, named, part, robot, shown

_MACRO = "<xacro:macro name='wheel' params='side'><link name='${side}_wheel'/></xacro:macro>"
_FILES: dict[str, str | bytes] = {
    "urdf/wheel.xacro": part(_MACRO),
    "urdf/values.xacro": part(named("radius", "0.1") + named("diameter", "${2 * radius}")),
    "urdf/parts/arm.xacro": part('<xacro:include filename="hand.xacro"/><arm/>'),
    "urdf/parts/hand.xacro": part('<xacro:include filename="../finger.xacro"/><hand/>'),
    "urdf/finger.xacro": part("<finger/>"),
    "urdf/a1.xacro": part("<a1/>"),
    "urdf/a2.xacro": part("<a2/>"),
    "urdf/a10.xacro": part("<a10/>"),
    "urdf/late.xacro": part(shown("${late}")),
    "urdf/broken.xacro": part("<a>"),
    "urdf/refused.xacro": part(shown("${missing}")),
    "urdf/empty.xacro": "",
    "urdf/loop.xacro": part('<xacro:include filename="loop.xacro"/>'),
    "urdf/first.xacro": part('<xacro:include filename="second.xacro"/>'),
    "urdf/second.xacro": part('<xacro:include filename="first.xacro"/>'),
    "urdf/no_prefix.xacro": "<robot><xacro:property name='a' value='1'/></robot>",
    "urdf/plain.xacro": "<robot><plain/></robot>",
    "urdf/named.xacro": '<robot name="other" version="2"><plain/></robot>',
    "urdf/other_root.xacro": "<anything><plain/></anything>",
    "urdf/gazebo.xacro": '<robot xmlns:g="urn:g"><g:plain/></robot>',
    "urdf/text.xacro": part("text ${1 + 1} <a/>"),
    "urdf/declared.xacro": "<?xml version='1.0' encoding='utf-8'?>\n<!-- about -->\n" + part("<!-- c --><plain/>"),
    "urdf/argument.xacro": part('<xacro:arg name="size" default="3"/>' + shown("$(arg size)")),
    "urdf/ns.xacro": part(
        named("a", "1") + named("b", "${a + 1}") + "<xacro:macro name='m' params=''>" + shown("${a} ${b}") + "</xacro:macro>"
    ),
    "urdf/ns_outer.xacro": part('<xacro:include filename="ns.xacro" ns="inner"/>' + shown("${inner.a}")),
    "urdf/ns_parent.xacro": part(
        "<xacro:macro name='m' params=''>" + named("p", "5", 'scope="parent"') + named("g", "6", 'scope="global"') + "</xacro:macro>"
    ),
    "urdf/ns_uses.xacro": part(shown("${outside}") + named("outside", "9") + shown("${outside}")),
    "urdf/spaced name.xacro": part("<spaced/>"),
    "urdf/b[1].xacro": part("<bracket/>"),
    "common/materials.xacro": part('<material name="gray"><color rgba="0.7 0.7 0.7 1"/></material>'),
    "common/bom.xacro": b"\xef\xbb\xbf" + part("<bom/>").encode(),
    "common/latin.xacro": b"<?xml version='1.0' encoding='latin-1'?><robot><l name='\xe9'/></robot>",
    "common/utf.xacro": "<?xml version='1.0' encoding='latin-1'?><robot><l name='é'/></robot>",
    "parts/arm.xacro": part('<xacro:include filename="$(find my_robot)/common/materials.xacro"/><arm_part/>'),
}  # fmt: skip


def include(name: str, more: str = "") -> str:
    """Return an include."""
    return f'<xacro:include filename="{name}" {more}/>'


_PATHS = bodies(
    files=_FILES,
    macro=include("wheel.xacro") + '<xacro:wheel side="left"/>',
    properties=include("values.xacro") + shown("${diameter}"),
    nested_folders=include("parts/arm.xacro"),
    dot=include("./finger.xacro"),
    found=include("$(find my_robot)/common/materials.xacro"),
    found_urdf=include("$(find my_robot)/urdf/parts/arm.xacro"),
    found_other_part=include("$(find arm_parts)/arm.xacro"),
    found_without_slash=include("$(find my_robot)urdf/finger.xacro"),
    found_without_name=include("$(find)/urdf/finger.xacro"),
    found_two_names=include("$(find my_robot arm_parts)/finger.xacro"),
    found_by_property=named("package", "my_robot") + include("$(find ${package})/urdf/finger.xacro"),
    by_property=named("which", "finger") + include("${which}.xacro"),
    by_whole_property=named("which", "finger.xacro") + include("${which}"),
    by_argument='<xacro:arg name="which" default="finger"/>' + include("$(arg which).xacro"),
    by_undefined=include("${which}.xacro"),
    twice_macro=include("wheel.xacro") + include("wheel.xacro") + '<xacro:wheel side="left"/>',
    missing=include("missing.xacro"),
    missing_then_more=include("missing.xacro") + '<link name="a"/>',
    folder=include("parts"),
    without_filename="<xacro:include/>",
    file_attribute='<xacro:include file="finger.xacro"/>',
    without_prefix='<include filename="finger.xacro"/>',
    broken=include("broken.xacro"),
    refused=include("refused.xacro"),
    empty_file=include("empty.xacro"),
    loop=include("loop.xacro"),
    loop_of_two=include("first.xacro"),
    of_itself=include("robot.urdf.xacro"),
    sees_outer_property=named("late", "2") + include("late.xacro"),
    sees_no_later_property=include("late.xacro") + named("late", "2"),
    text=f"<v>{include('text.xacro')}</v>",
    argument_in_file=include("argument.xacro") + shown("$(arg size)"),
    in_macro="<xacro:macro name='n' params='f'>" + include("${f}.xacro") + "</xacro:macro><xacro:n f='finger'/>",
    in_macro_is_local="<xacro:macro name='n' params=''>" + include("values.xacro") + "</xacro:macro><xacro:n/>" + shown("${radius}"),
    in_block=f'<xacro:property name="b">{include("finger.xacro")}</xacro:property><xacro:insert_block name="b"/>',
    in_macro_of_other_folder=include("parts/macro.xacro") + "<xacro:load/>",
    latin_bytes=include("../common/latin.xacro"),
)  # fmt: skip

_OPTIONAL = bodies(
    files=_FILES,
    optional_missing=include("missing.xacro", 'optional="true"') + "<a/>",
    optional_there=include("finger.xacro", 'optional="true"') + "<a/>",
    optional_false=include("missing.xacro", 'optional="false"') + "<a/>",
    optional_one=include("missing.xacro", 'optional="1"') + "<a/>",
    optional_expression=include("missing.xacro", 'optional="${1 == 1}"') + "<a/>",
    optional_broken=include("broken.xacro", 'optional="true"') + "<a/>",
    optional_refused=include("refused.xacro", 'optional="true"') + "<a/>",
    optional_nonsense=include("finger.xacro", 'optional="perhaps"'),
    optional_undefined_package=include("${missing}", 'optional="true"') + "<a/>",
)  # fmt: skip
_PATTERNS = bodies(
    files=_FILES,
    pattern=include("a*.xacro"),
    pattern_question=include("a?.xacro"),
    pattern_nothing=include("z*.xacro") + "<a/>",
    pattern_of_literal_brackets=include("b[1].xacro") + "<a/>",
)  # fmt: skip

_NAMESPACES = bodies(
    files=_FILES,
    ns=include("ns.xacro", 'ns="n"') + shown("${n.a} ${n.b}") + "<xacro:n.m/>",
    ns_hides=include("ns.xacro", 'ns="n"') + shown("${a}"),
    ns_hides_macro=include("ns.xacro", 'ns="n"') + "<xacro:m/>",
    ns_by_property=named("which", "n") + include("ns.xacro", 'ns="${which}"') + shown("${n.a}"),
    ns_undefined_property=include("ns.xacro", 'ns="n"') + shown("${n.z}"),
    ns_undefined_macro=include("ns.xacro", 'ns="n"') + "<xacro:n.z/>",
    ns_undefined="<xacro:n.m/>",
    ns_nested=include("ns_outer.xacro", 'ns="o"') + shown("${o.inner.a}") + "<xacro:o.inner.m/>",
    ns_two=include("ns.xacro", 'ns="n"') + include("ns.xacro", 'ns="o"') + shown("${n.a + o.a}"),
    ns_sees_outside=named("outside", "4") + include("ns_uses.xacro", 'ns="n"') + shown("${outside} ${n.outside}"),
    ns_finds_outside_too=named("outside", "4") + include("ns.xacro", 'ns="n"') + shown("${n.outside}"),
    ns_scopes=include("ns_parent.xacro", 'ns="n"') + "<xacro:n.m/>" + shown("${p} ${g}"),
    ns_call=include("ns.xacro", 'ns="n"') + '<xacro:call macro="n.m"/>',
    ns_like_property=named("n", "1") + include("ns.xacro", 'ns="n"') + shown("${n.a}"),
    ns_empty=include("ns.xacro", 'ns=""') + shown("${a}"),
    ns_of_math=include("ns.xacro", 'ns="math"') + shown("${math.a} ${math.pi}"),
    ns_index=include("ns.xacro", 'ns="n"') + shown("${n['a']}"),
    ns_like_macro=include("ns.xacro", 'ns="n"') + "<xacro:macro name='n' params=''/>",
    ns_like_earlier_macro="<xacro:macro name='n' params=''/>" + include("ns.xacro", 'ns="n"') + "<xacro:n/>",
    ns_like_inner_macro=include("ns.xacro", 'ns="n"')
    + "<xacro:macro name='go'><xacro:macro name='n'><link name='q'/></xacro:macro><xacro:n/></xacro:macro><xacro:go/><xacro:n.m/>",
    ns_hidden_by_inner_macro=include("ns.xacro", 'ns="n"')
    + "<xacro:macro name='go'><xacro:macro name='n'/><xacro:n.m/></xacro:macro><xacro:go/>",
    ns_is_true=include("ns.xacro", 'ns="n"') + shown("${not n}"),
    ns_list=named("which", "${[1]}") + include("ns.xacro", 'ns="${which}"'),
    ns_with_dot=include("ns.xacro", 'ns="n.o"') + shown("1"),
)  # fmt: skip

_OUTSIDE = merged(
    bodies(
        "always",
        _FILES,
        other_package=include("$(find other_robot_description)/urdf/a.xacro") + '<link name="a"/>',
        other_package_optional=include("$(find other_robot_description)/urdf/a.xacro", 'optional="true"') + "<a/>",
        other_package_in_mesh='<mesh filename="$(find other_robot_description)/meshes/a.stl"/>',
    ),
    bodies(
        "perhaps",
        _FILES,
        found_in_text=shown("$(find my_robot)/meshes/a.stl"),
        found_twice=shown("$(find my_robot) $(find arm_parts)"),
        found_in_property=named("folder", "$(find my_robot)/urdf") + include("${folder}/finger.xacro"),
        found_in_expression=include("${'$(find my_robot)' + '/urdf/finger.xacro'}"),
        abs_filename=include("${xacro.abs_filename('finger.xacro')}"),
        ns_without_names=include("plain.xacro", 'ns="o"') + shown("${not o}"),
        ns_made_true_by_an_expression=include("text.xacro", 'ns="o"') + shown("${not o}"),
    ),
)

_PLACES: Documents = {
    "macro-includes-relative-to-its-caller": Document(
        robot(include("parts/macro.xacro") + "<xacro:load/>"),
        {
            "urdf/parts/macro.xacro": part(
                "<xacro:macro name='load' params=''>" + include("one.xacro") + "</xacro:macro>"
            ),
            "urdf/parts/one.xacro": part("<in_parts/>"),
            "urdf/one.xacro": part("<in_urdf/>"),
        },
    ),
}

DOCUMENTS: Documents = merged(_PATHS, _OPTIONAL, _PATTERNS, _NAMESPACES, _OUTSIDE, _PLACES)
for _name in ("loop", "loop-of-two", "of-itself", *_PATTERNS):  # Python's stack ends; patterns are not supported
    DOCUMENTS[_name] = DOCUMENTS[_name]._replace(undetermined="perhaps")
