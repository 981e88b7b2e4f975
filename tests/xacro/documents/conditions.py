"""Conditions: every text that is a boolean, and where a condition stands."""

from tests.xacro.documents.document import Document, Documents, bodies, merged, named, robot, shown


def condition(value: str) -> str:
    """Return an element that is kept if the value is true, and one that is kept if it is false."""
    return f'<xacro:if value="{value}"><yes/></xacro:if><xacro:unless value="{value}"><no/></xacro:unless>'


_VALUES = (
    "true", "True", "TRUE", "tRue", "false", "False", "FALSE", "1", "0", "2", "-1", "00", "01", "1.0", "0.0", "1.5", "", " ", " 1 ",
    " true", "yes", "no", "on", "off", "none", "None", "1_0", "0x1", "'true'", '""'.replace('"', "'"), "1 2", "٣",
    "${true}", "${True}", "${False}", "${1}", "${0}", "${0.0}", "${0.1}", "${-1}", "${''}", "${'a'}", "${'true'}", "${'false'}",
    "${'0'}", "${'1'}", "${[]}", "${[0]}", "${None}", "${dict()}", "${1 == 1}", "${1 == 2}", "${1 &lt; 2}", "${not 1}",
    "${1 and 0}", "${1 or 0}", "${'a' in 'abc'}", "${'x' == 'x'}", "${1}0", "${0}0", "${True}1", "${1 if 2 else 0}", "${nan}",
    "${missing}", "${1 +}", "${bool('false')}", "${'True'}", "${1}${0}", "tru${'e'}", "${sin}", "${math}", "${str(0)}",
)  # fmt: skip
_TEXTS = {f"value-{value}": Document(robot(condition(value))) for value in _VALUES}

_PROPERTIES = {
    f"property-{value}": Document(robot(named("a", value) + condition("${a}") + condition("${not a}")))
    for value in ("true", "false", "True", "1", "0", "0.0", "yes", "", "'true'", "'0'", "${1 > 2}", "${True}", "0 0 0")
}
_ASKED = '<xacro:arg name="a" default="false"/>' + condition("$(arg a)") + condition("${'$(arg a)' == 'true'}")
_ARGUMENTS = {
    f"argument-{value}": Document(robot(_ASKED), arguments={"a": value})
    for value in ("true", "false", "True", "1", "0", "yes", "1.0", "")
}

_PLACES = bodies(
    several='<xacro:if value="1"><a/><b/>text</xacro:if>',
    false_is_not_evaluated='<xacro:if value="0">' + shown("${missing}") + "<xacro:nothing/></xacro:if><a/>",
    true_is_evaluated='<xacro:if value="1">' + shown("${missing}") + "</xacro:if>",
    unless_is_evaluated='<xacro:unless value="0"><xacro:nothing/></xacro:unless>',
    without_value="<xacro:if><a/></xacro:if>",
    unless_without_value="<xacro:unless><a/></xacro:unless>",
    unknown_attribute='<xacro:if value="1" test="2"><a/></xacro:if>',
    else_is_unknown='<xacro:if value="1"><a/></xacro:if><xacro:else><b/></xacro:else>',
    elif_is_unknown='<xacro:if value="1"><a/></xacro:if><xacro:elif value="1"><b/></xacro:elif>',
    if_without_prefix='<if value="0"><a/></if>',
    if_around_include_false='<xacro:if value="0"><xacro:include filename="missing.xacro"/></xacro:if><a/>',
    if_with_property_inside='<xacro:if value="1">' + named("a", "1") + '</xacro:if><xacro:if value="${a}"><b/></xacro:if>',
    if_with_property_not_inside='<xacro:if value="0">' + named("a", "1") + "</xacro:if>" + shown("${a}"),
    if_in_inertial='<link name="l"><inertial><xacro:if value="${1 &gt; 0}"><mass value="1"/></xacro:if></inertial></link>',
    if_in_attribute=shown("${1 if True else 2}", "${'a' if 0 else 'b'}"),
    comment_before='<!-- gone --><xacro:if value="1"><a/></xacro:if>',
    string_comparison=named("type", "diff") + "<xacro:if value=\"${type == 'diff'}\"><a/></xacro:if>"
    "<xacro:if value=\"${type == 'omni'}\"><b/></xacro:if>",
    quoted_string_comparison=named("type", "'diff'") + "<xacro:if value=\"${type == 'diff'}\"><a/></xacro:if>",
    greater=named("n", "3") + '<xacro:if value="${n > 2 and n &lt;= 3}"><a/></xacro:if>',
    escaped_condition=named("a", "1") + '<xacro:if value="$${a}"><b/></xacro:if>',
    mixed_types='<xacro:if value="${1 &lt; \'a\'}"><b/></xacro:if>',
)  # fmt: skip

DOCUMENTS: Documents = merged(_TEXTS, _PROPERTIES, _ARGUMENTS, _PLACES)
