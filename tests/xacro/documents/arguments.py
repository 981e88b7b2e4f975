"""Arguments and `$(...)`: defaults, the command line, the environment."""

from tests.xacro.documents.document import Documents, bodies, merged, named, shown

_A = '<xacro:arg name="a" default="1"/>'

_DEFAULTS = bodies(
    default=_A + shown("$(arg a)"),
    default_in_text=_A + shown("x$(arg a)y $(arg a)"),
    default_expression='<xacro:arg name="a" default="${1 + 1}"/>' + shown("$(arg a)"),
    default_uses_property=named("p", "x") + '<xacro:arg name="a" default="${p}y"/>' + shown("$(arg a)"),
    default_uses_argument=_A + '<xacro:arg name="b" default="$(arg a)2"/>' + shown("$(arg b)"),
    default_undefined='<xacro:arg name="a" default="${missing}"/>',
    default_empty_alone='<xacro:arg name="a" default=""/>' + shown("$(arg a)"),
    first_default_counts=_A + '<xacro:arg name="a" default="2"/>' + shown("$(arg a)"),
    used_before=shown("$(arg a)") + _A,
    without_default='<xacro:arg name="a"/>' + "<b/>",
    without_name='<xacro:arg default="1"/>',
    value_instead_of_default='<xacro:arg name="a" value="1"/>',
    name_is_not_evaluated=named("p", "a") + '<xacro:arg name="${p}" default="1"/>' + "<b/>",
    in_expression=_A + shown("${$(arg a) + 1}"),
    in_quoted_expression=_A + shown("${'$(arg a)' + '1'}"),
    in_property=_A + named("p", "$(arg a)") + shown("${p + 1}"),
    in_property_is_text=_A + named("p", "$(arg a)") + shown("${[p]}"),
    in_text_node=_A + "<b>$(arg a)</b>",
    in_condition=_A + '<xacro:if value="$(arg a)"><b/></xacro:if>',
    in_macro="<xacro:macro name='m' params=''>" + _A + "</xacro:macro><xacro:m/>" + shown("$(arg a)"),
    in_macro_parameter=_A
    + "<xacro:macro name='m' params='p'>"
    + shown("${p * 2}")
    + "</xacro:macro><xacro:m p='$(arg a)'/>",
    in_if_not='<xacro:if value="0">' + _A + "</xacro:if><b/>",
    xacro_arg=_A + shown("${xacro.arg('a')}", "${xacro.arg('a') + '1'}"),
    expression_in_name=_A + named("p", "a") + shown("$(arg ${p})"),
    two_names=_A + shown("$(arg a b)"),
    no_name=shown("$(arg)"),
    no_command=shown("$()"),
    only_space=shown("$( )"),
    capital_command=_A + shown("$(Arg a)"),
    unclosed=_A + shown("$(arg a"),
    nested_brackets=_A + shown("$(arg (a))"),
    nested_dollar=_A + shown("$(arg $(arg a))"),
    literal_dollar=_A + shown("$ (arg a)", "5 $"),
    empty_tag="<xacro:arg/>",
    value_with_expression='<xacro:arg name="a" default="$${b}"/>' + named("b", "4") + shown("$(arg a)"),
)

_GIVEN = bodies(
    arguments={"a": "7", "unused": "8", "text": "b c", "flag": "false", "expression": "${1 + 1}", "number": "0.50"},
    given=_A + shown("$(arg a)"),
    given_without_declaration=shown("$(arg a)"),
    given_text='<xacro:arg name="text" default="x"/>' + shown("$(arg text)"),
    given_flag='<xacro:arg name="flag" default="true"/><xacro:if value="$(arg flag)"><b/></xacro:if>',
    given_flag_in_expression='<xacro:if value="${$(arg flag)}"><b/></xacro:if>',
    given_flag_compared="<xacro:if value=\"${'$(arg flag)' == 'false'}\"><b/></xacro:if>",
    given_expression=shown("$(arg expression)"),
    given_expression_in_property=named("p", "$(arg expression)") + shown("${p}"),
    given_number=shown("$(arg number)", "${$(arg number)}", "${$(arg number) * 2}"),
    given_number_property=named("p", "$(arg number)") + shown("${p}", "${p * 2}"),
    given_in_macro="<xacro:macro name='m' params='p:=$(arg a)'>" + shown("${p}") + "</xacro:macro><xacro:m/>",
    given_by_xacro_arg=shown("${xacro.arg('number')}", "${float(xacro.arg('number'))}"),
    given_in_name="<link name='$(arg text)_link'/>",
    given_case="<link name='$(arg A)'/>" + _A,
)  # fmt: skip
_GIVEN["given-case"] = _GIVEN["given-case"]._replace(undetermined="perhaps")

_UNDECLARED = bodies(
    "always",
    undeclared=shown("$(arg a)") + '<link name="b"/>',
    undeclared_in_eager_property='<xacro:property name="d" value="$(arg a)" lazy_eval="false"/>',
    undeclared_in_global_property="<xacro:property name='d' value=\"${xacro.arg('a')}\" scope='global'/>",
    undeclared_in_unused_parameter="<xacro:macro name='m' params='p'/><xacro:m p='$(arg a)'/>",
    undeclared_in_expression=shown("${$(arg a) + 1}"),
    undeclared_in_condition='<xacro:if value="$(arg a)"><link name="b"/></xacro:if><link name="c"/>',
)
_UNDECLARED_ASKED = bodies(
    "perhaps",
    used_before=shown("$(arg a)") + _A,
    undeclared_by_xacro_arg=shown("${xacro.arg('a')}"),
)

_SUBSTITUTIONS = bodies()
_EVAL = bodies(
    "always",
    eval_number=shown("$(eval 1 + 2)"),
    eval_in_text=shown("a $(eval 1 + 2) b"),
    eval_argument=_A + shown("$(eval a + 1)"),
    eval_condition='<xacro:if value="$(eval 1 &lt; 2)"><b/></xacro:if>',
)

_ENVIRONMENT = bodies(
    "always",
    env=shown("$(env HOME)"),
    env_missing=shown("$(env ROBOT)") + '<link name="a"/>',
    env_in_expression="<xacro:if value=\"${'$(env HOME)' == 'x'}\"><a/></xacro:if>",
    optenv_empty=shown("[$(optenv ROBOT)]"),
    optenv_property=named("type", "$(optenv ROBOT burger)") + shown("${type}"),
    optenv_include='<xacro:include filename="$(optenv ROBOT a).xacro"/><link name="b"/>',
    cwd_in_text=shown("file://$(cwd)/a.stl"),
)
_ENVIRONMENT |= bodies("perhaps", env_two_names=shown("$(env A B)"), cwd_with_space=shown("$(cwd )"))

DOCUMENTS: Documents = merged(
    {name: document for name, document in _DEFAULTS.items() if name not in _UNDECLARED_ASKED},
    _GIVEN, _UNDECLARED, _UNDECLARED_ASKED, _SUBSTITUTIONS, _EVAL, _ENVIRONMENT,
)  # fmt: skip
