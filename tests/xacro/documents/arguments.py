"""Arguments and `$(...)`: defaults, the command line, `$(eval ...)`, the environment."""

from tests.xacro.documents.document import Documents, bodies, merged, named, shown

_A = '<xacro:arg name="a" default="1"/>'

_DEFAULTS = bodies(
    default=_A + shown("$(arg a)"),
    default_in_text=_A + shown("x$(arg a)y $(arg a)"),
    default_expression='<xacro:arg name="a" default="${1 + 1}"/>' + shown("$(arg a)"),
    default_uses_property=named("p", "x") + '<xacro:arg name="a" default="${p}y"/>' + shown("$(arg a)"),
    default_uses_argument=_A + '<xacro:arg name="b" default="$(arg a)2"/>' + shown("$(arg b)"),
    default_undefined='<xacro:arg name="a" default="${missing}"/>',
    default_empty='<xacro:arg name="a" default=""/>' + shown("[$(arg a)]"),
    default_empty_alone='<xacro:arg name="a" default=""/>' + shown("$(arg a)"),
    first_default_counts=_A + '<xacro:arg name="a" default="2"/>' + shown("$(arg a)"),
    used_before=shown("$(arg a)") + _A,
    without_default='<xacro:arg name="a"/>' + "<b/>",
    without_name='<xacro:arg default="1"/>',
    value_instead_of_default='<xacro:arg name="a" value="1"/>',
    unknown_attribute='<xacro:arg name="a" default="1" doc="b"/>' + shown("$(arg a)"),
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
    spaces=_A + shown("$( arg  a )"),
    two_names=_A + shown("$(arg a b)"),
    no_name=shown("$(arg)"),
    no_command=shown("$()"),
    only_space=shown("$( )"),
    unknown_command=shown("$(argument a)"),
    capital_command=_A + shown("$(Arg a)"),
    unclosed=_A + shown("$(arg a"),
    nested_brackets=_A + shown("$(arg (a))"),
    nested_dollar=_A + shown("$(arg $(arg a))"),
    closed_twice=_A + shown("$(arg a))"),
    literal_dollar=_A + shown("$ (arg a)", "5 $"),
    empty_tag="<xacro:arg/>",
    child_elements='<xacro:arg name="a" default="1"><b/></xacro:arg>' + shown("$(arg a)"),
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
    eval_given=shown("$(eval a + 1)", "$(eval number * 2)", "$(eval text)", "$(eval not flag)"),
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
    undeclared_in_eval=shown("$(eval a)"),
)

_EVAL = bodies(
    eval_number=shown("$(eval 1 + 2)", "$(eval 1 / 2)", "$(eval 2 ** 3)"),
    eval_in_text=shown("a $(eval 1 + 2) b"),
    eval_two=shown("$(eval 1)$(eval 2)"),
    eval_pi=shown("$(eval pi)", "$(eval pi / 2)"),
    eval_string=shown("$(eval 'a' + 'b')"),
    eval_list=shown("$(eval [1, 2][0])"),
    eval_argument=_A + shown("$(eval a + 1)"),
    eval_argument_is_converted='<xacro:arg name="a" default="1.50"/>' + shown("$(eval a)"),
    eval_argument_boolean='<xacro:arg name="a" default="TRUE"/>' + shown("$(eval a)", "$(eval not a)"),
    eval_argument_text='<xacro:arg name="a" default="b c"/>' + shown("$(eval a)", "$(eval a == 'b c')"),
    eval_argument_hides='<xacro:arg name="pi" default="3"/>' + shown("$(eval pi)"),
    eval_property=named("p", "2") + shown("$(eval p + 1)"),
    eval_expression_inside=named("p", "2") + shown("$(eval ${p} + 1)"),
    eval_argument_inside=_A + shown("$(eval $(arg a) + 1)"),
    eval_call=shown("$(eval sqrt(4))"),
    eval_brackets=shown("$(eval (1 + 2) * 3)"),
    eval_empty=shown("$(eval )"),
    eval_without_space=shown("$(eval)"),
    eval_error=shown("$(eval 1 / 0)"),
    eval_undefined=shown("$(eval missing_name)"),
    eval_true=shown("$(eval true)", "$(eval True and false)"),
    eval_condition='<xacro:if value="$(eval 1 &lt; 2)"><b/></xacro:if>',
    eval_condition_number='<xacro:if value="$(eval 2 - 2)"><b/></xacro:if><a/>',
    eval_condition_fraction='<xacro:if value="$(eval 0.5)"><b/></xacro:if>',
    eval_in_property=named("p", "$(eval 3)") + shown("${p + 1}"),
    eval_in_expression=shown("${$(eval 3) + 1}"),
    eval_double_underscore=shown("$(eval 'a__b')"),
    eval_leading_spaces=shown("$( eval 1)"),
    eval_attribute=shown("$(eval 'a'.upper)"),
    eval_conditional=_A + shown("$(eval 'x' if a == 1 else 'y')"),
    eval_comparison_chain=shown("$(eval 1 < 2 < 3)"),
    eval_none=shown("$(eval None)"),
    dirname=shown("$(dirname)"),
    dirname_in_text=shown("$(dirname)/a.stl"),
    anon=shown("$(anon a)"),
    env_without_name=shown("$(env)"),
    optenv_without_name=shown("$(optenv)"),
)
_EVAL["eval-attribute"] = _EVAL["eval-attribute"]._replace(undetermined="perhaps")  # shows an address in memory
for _name in ("eval-undefined", "eval-property"):  # the launch file can give an argument of this name
    _EVAL[_name] = _EVAL[_name]._replace(undetermined="perhaps")

_ENVIRONMENT = bodies(
    "always",
    env=shown("$(env HOME)"),
    env_missing=shown("$(env ROBOT)") + '<link name="a"/>',
    env_in_expression="<xacro:if value=\"${'$(env HOME)' == 'x'}\"><a/></xacro:if>",
    optenv=shown("$(optenv HOME a)"),
    optenv_missing=shown("$(optenv ROBOT a b  c)"),
    optenv_empty=shown("[$(optenv ROBOT)]"),
    optenv_property=named("type", "$(optenv ROBOT burger)") + shown("${type}"),
    optenv_include='<xacro:include filename="$(optenv ROBOT a).xacro"/><link name="b"/>',
    cwd=shown("$(cwd)"),
    cwd_in_text=shown("file://$(cwd)/a.stl"),
)
_ENVIRONMENT |= bodies("perhaps", env_two_names=shown("$(env A B)"), cwd_with_space=shown("$(cwd )"))

DOCUMENTS: Documents = merged(
    {name: document for name, document in _DEFAULTS.items() if name not in _UNDECLARED_ASKED},
    _GIVEN, _UNDECLARED, _UNDECLARED_ASKED, _EVAL, _ENVIRONMENT,
)  # fmt: skip
