"""Macros: parameters, defaults, forwarded properties, blocks, nesting, recursion, names and calls."""

from tests.xacro.documents.document import Documents, bodies, merged, named, shown


def macro(params: str, body: str, name: str = "m") -> str:
    """Return a macro."""
    return f"<xacro:macro name='{name}' params=\"{params}\">{body}</xacro:macro>"


_AB = shown("${a}", "${b}")

_PARAMETERS = bodies(
    none=macro("", shown("1")) + "<xacro:m/>",
    no_params_attribute="<xacro:macro name='m'><a/></xacro:macro><xacro:m/>",
    one=macro("a", shown("${a}")) + '<xacro:m a="1"/><xacro:m a="b c"/>',
    two=macro("a b", _AB) + '<xacro:m b="1" a="2"/>',
    spread_over_lines=macro("a\n  b\t c:=3  ", _AB + shown("${c}")) + '<xacro:m b="1" a="2"/>',
    line_reference_after_default=macro("a:=1&#10;b c", _AB) + '<xacro:m b="1"/>',
    line_reference=macro("a&#10;b", _AB) + '<xacro:m a="1" b="2"/>',
    missing=macro("a b", _AB) + '<xacro:m a="1"/>',
    missing_all=macro("a b", _AB) + "<xacro:m/>",
    unknown=macro("a", shown("${a}")) + '<xacro:m a="1" c="2"/>',
    twice=macro("a a", shown("${a}")) + '<xacro:m a="1"/>',
    twice_with_default=macro("a:=1 a:=2", shown("${a}")) + '<xacro:m a="3"/><xacro:m/>',
    twice_with_one_default=macro("a a:=2", shown("${a}")) + '<xacro:m a="3"/><xacro:m/>',
    twice_without_last_default=macro("a:=1 a:= b", shown("${a}")) + '<xacro:m b="3"/>',
    value_is_typed=macro("a", shown("${a + 1}")) + '<xacro:m a="${1 + 1}"/>',
    value_is_literal=macro("a", shown("${a + 1}")) + '<xacro:m a="2"/>',
    value_is_text=macro("a", shown("${a + 1}")) + '<xacro:m a="two"/>',
    value_is_boolean=macro("a", '<xacro:if value="${a}"><b/></xacro:if>') + '<xacro:m a="true"/><xacro:m a="false"/>',
    value_in_callers_scope=named("r", "3") + macro("a", named("r", "4") + shown("${a}")) + '<xacro:m a="${r}"/>',
    value_not_evaluated_twice=macro("a", shown("${a}")) + '<xacro:m a="$${b}"/>',
    value_uses_other_parameter=macro("a b", _AB) + '<xacro:m a="1" b="${a}"/>',
    list_value=macro("a", shown("${a[0]} ${len(a)}")) + '<xacro:m a="${[1, 2]}"/>',
    vector_value=macro("a", '<origin xyz="${a}"/>') + '<xacro:m a="0 0 1"/>',
    split_value=macro("a", shown("${a.split()[1]}")) + '<xacro:m a="0 5 1"/>',
    text_of_body=macro("a", "<c>x ${a} y</c>") + '<xacro:m a="1"/>',
    parameter_used_for_name=macro("prefix", '<link name="${prefix}_link"/>') + '<xacro:m prefix="left"/><xacro:m prefix="right"/>',
    prefix_attribute=macro("a", shown("${a}")) + '<xacro:m a="1" xmlns:b="urn:b"/>',
    named_like_function=macro("max min", shown("${max - min}")) + '<xacro:m max="3" min="1"/>',
    named_like_keyword=macro("if", shown("1")) + '<xacro:m if="3"/>',
    nested_call_in_value=macro("a", shown("${a}")) + macro("a", '<xacro:m a="${a * 2}"/>', "n") + '<xacro:n a="4"/>',
    comma_between=macro("a, b", "<c/>") + '<xacro:m a="1" b="2"/>',
    parameter_with_comma_name=macro("a,b", "<c/>") + '<xacro:m a="1"/>',
)  # fmt: skip

_DEFAULTS = bodies(
    default=macro("a:=1", shown("${a + 1}")) + '<xacro:m/><xacro:m a="2"/>',
    default_equals=macro("a=1", shown("${a + 1}")) + "<xacro:m/>",
    default_with_spaces=macro("a := 1 b = 2", _AB) + "<xacro:m/>",
    default_quoted=macro("a:='x y' b:=2", _AB) + "<xacro:m/>",
    default_number_quoted=macro("a:='1'", shown("${a}", "${[a]}")) + "<xacro:m/>",
    default_expression=named("r", "4") + macro("a:=${r * 2}", shown("${a}")) + "<xacro:m/>",
    default_expression_with_spaces=macro("a:=${1 + 1} b:=${ [1, 2][0] }", _AB) + "<xacro:m/>",
    default_in_callers_scope=macro("a:=${r}", shown("${a}")) + macro("r", "<xacro:m/>", "n") + '<xacro:n r="5"/>',
    default_undefined=macro("a:=${r}", shown("${a}")) + "<xacro:m/>",
    default_undefined_unused=macro("a:=${r}", shown("${a}")) + '<xacro:m a="1"/>',
    default_of_other_parameter=macro("a b:=${a}", _AB) + '<xacro:m a="1"/>',
    default_of_other_and_property=named("a", "7") + macro("a b:=${a}", _AB) + '<xacro:m a="1"/>',
    default_empty=macro("a:=", "<c/>") + "<xacro:m/>",
    default_empty_quoted=macro("a:=''", shown("[${a}]")) + "<xacro:m/>",
    default_two_words=macro("a:=1 2 b:=3", "<c/>") + "<xacro:m/>",
    default_true=macro("a:=true", '<xacro:unless value="${a}"><b/></xacro:unless>') + '<xacro:m/><xacro:m a="0"/>',
    default_argument='<xacro:arg name="x" default="9"/>' + macro("a:=$(arg x)", shown("${a + 1}")) + "<xacro:m/>",
    default_argument_undefined=macro("a:=${'$(arg x)'}", shown("1")) + '<xacro:m a="2"/>',
    default_vector=macro("a:='0 0 ${1 + 1}'", shown("${a}")) + "<xacro:m/>",
    default_path=macro("a:=package://b/c.stl", shown("${a}")) + "<xacro:m/>",
    default_mixed_quotes=macro("a:=x'y z'w", shown("${a}")) + "<xacro:m/>",
    default_colon=macro("a:b", "<c/>") + "<xacro:m/>",
    default_none=macro("a:=${None}", shown("${a}")) + "<xacro:m/>",
    default_dict=macro("a:=${dict(x=1)}", shown("${a['x']}")) + "<xacro:m/>",
    forward=named("a", "3") + macro("a:=^", shown("${a}")) + '<xacro:m/><xacro:m a="1"/>',
    forward_equals=named("a", "3") + macro("a=^", shown("${a}")) + "<xacro:m/>",
    forward_undefined=macro("a:=^", shown("${a}")) + "<xacro:m/>",
    forward_undefined_unused=macro("a:=^", shown("${a}")) + '<xacro:m a="1"/>',
    forward_default=macro("a:=^|5", shown("${a}")) + "<xacro:m/>" + named("a", "6") + "<xacro:m/>",
    forward_default_expression=macro("a:=^|${2 * 3}", shown("${a}")) + "<xacro:m/>",
    forward_default_quoted=macro("a:=^|'b c' d:=1", shown("${a}")) + "<xacro:m/>",
    forward_default_empty=macro("a:=^|", shown("${a}")) + "<xacro:m/>",
    forward_default_empty_quoted=macro("a:=^|''", shown("[${a}]")) + "<xacro:m/>",
    forward_block='<xacro:property name="a"><b/></xacro:property>' + macro("a:=^", '<xacro:insert_block name="a"/>') + "<xacro:m/>",
    forward_name=named("b", "1") + macro("a:=^b", shown("${a}")) + "<xacro:m/>",
    forward_in_callers_scope=named("a", "1")
    + macro("a:=^", shown("${a}"))
    + macro("a", "<xacro:m/>", "n")
    + '<xacro:n a="2"/><xacro:m/>',
    forward_two=named("a", "1") + macro("a:=^ b:=^|2", _AB) + "<xacro:m/>",
    forward_global_symbol=macro("pi:=^", shown("${pi}")) + "<xacro:m/>",
    forward_lazy=named("a", "${b}") + named("b", "8") + macro("a:=^", shown("${a}")) + "<xacro:m/>",
)  # fmt: skip

_ORIGIN = '<origin xyz="${1 + 1} 0 0"/>'
_BLOCKS = bodies(
    block=macro("*o", '<v><xacro:insert_block name="o"/></v>') + f"<xacro:m>{_ORIGIN}</xacro:m>",
    block_keeps_its_element=macro("*o", '<xacro:insert_block name="o"/>') + "<xacro:m><group><a/><b/></group></xacro:m>",
    block_content=macro("**o", '<v><xacro:insert_block name="o"/></v>') + "<xacro:m><group><a/><b/></group></xacro:m>",
    block_content_of_text=macro("**o", '<v><xacro:insert_block name="o"/></v>') + "<xacro:m><g>text ${1+1}</g></xacro:m>",
    block_and_parameter=macro("a *o", '<v x="${a}"><xacro:insert_block name="o"/></v>') + f'<xacro:m a="1">{_ORIGIN}</xacro:m>',
    block_before_parameter=macro("*o a", '<v x="${a}"><xacro:insert_block name="o"/></v>') + f'<xacro:m a="1">{_ORIGIN}</xacro:m>',
    block_two=macro("*o *p", '<xacro:insert_block name="p"/><xacro:insert_block name="o"/>') + "<xacro:m><a/><b/></xacro:m>",
    block_both_kinds=macro("*o **p", '<xacro:insert_block name="p"/><xacro:insert_block name="o"/>') + "<xacro:m><a/><g><b/></g></xacro:m>",
    block_missing=macro("*o", '<xacro:insert_block name="o"/>') + "<xacro:m/>",
    block_missing_second=macro("*o *p", "<c/>") + "<xacro:m><a/></xacro:m>",
    block_unused=macro("*o", '<xacro:insert_block name="o"/>') + "<xacro:m><a/><b/></xacro:m>",
    block_without_parameter=macro("", "<c/>") + "<xacro:m><a/></xacro:m>",
    block_not_inserted=macro("*o", "<c/>") + "<xacro:m><a/></xacro:m>",
    block_text_between=macro("*o", '<xacro:insert_block name="o"/>') + "<xacro:m> text <a/> more </xacro:m>",
    block_in_callers_scope=named("c", "1") + macro("*o", named("c", "2") + '<xacro:insert_block name="o"/>') + f'<xacro:m>{shown("${c}")}</xacro:m>',
    block_sees_no_parameter=macro("a *o", '<xacro:insert_block name="o"/>') + f'<xacro:m a="1">{shown("${a}")}</xacro:m>',
    block_evaluated_twice=macro("a *o", '<xacro:insert_block name="o"/>') + f'<xacro:m a="1">{shown("$${a}")}</xacro:m>',
    block_passed_on=macro("*o", '<v><xacro:insert_block name="o"/></v>')
    + macro("*q", '<xacro:m><xacro:insert_block name="q"/></xacro:m>', "n") + f"<xacro:n>{_ORIGIN}</xacro:n>",
    block_content_passed_on=macro("**o", '<v><xacro:insert_block name="o"/></v>')
    + macro("**q", '<xacro:m><g><xacro:insert_block name="q"/></g></xacro:m>', "n") + f"<xacro:n><h>{_ORIGIN}</h></xacro:n>",
    block_is_macro_call=macro("a", shown("${a}"), "n") + macro("*o", '<xacro:insert_block name="o"/>') + '<xacro:m><xacro:n a="1"/></xacro:m>',
    block_is_if=macro("*o", '<xacro:insert_block name="o"/>') + '<xacro:m><xacro:if value="1"><a/></xacro:if></xacro:m>',
    block_is_if_not=macro("*o", '<xacro:insert_block name="o"/>') + '<xacro:m><xacro:if value="0"><a/></xacro:if></xacro:m>',
    block_is_property=macro("*o", '<xacro:insert_block name="o"/>') + f'<xacro:m>{named("c", "1")}<a x="${{c}}"/></xacro:m>' + shown("${c}"),
    block_chosen_by_if=macro("a *o", '<xacro:if value="${a}"><xacro:insert_block name="o"/></xacro:if>')
    + '<xacro:m a="1"><b/></xacro:m><xacro:m a="0"><c/></xacro:m>',
    block_hides_property='<xacro:property name="o"><a/></xacro:property>' + macro("*o", '<xacro:insert_block name="o"/>') + "<xacro:m><b/></xacro:m>",
    block_as_value=macro("*o", shown("${o}")) + "<xacro:m><b/></xacro:m>",
    block_default=macro("*o:=1", '<xacro:insert_block name="o"/>') + "<xacro:m/>",
    block_default_given=macro("*o:=^", '<xacro:insert_block name="o"/>') + "<xacro:m><b/></xacro:m>",
    block_name_insert_with_star=macro("*o", '<xacro:insert_block name="*o"/>') + "<xacro:m><b/></xacro:m>",
    block_three_stars=macro("***o", '<xacro:insert_block name="*o"/>') + "<xacro:m><g><b/></g></xacro:m>",
    block_with_attribute_element=macro("*o", '<xacro:insert_block name="o"/>')
    + '<xacro:m><v><xacro:attribute name="k" value="x"/></v></xacro:m>',
    block_insert_attribute=macro("**o", '<v><xacro:insert_block name="o"/></v>')
    + '<xacro:m><g><xacro:if value="1"><b/></xacro:if></g></xacro:m>',
)  # fmt: skip

_COUNT = macro("n", '<c x="${n}"/><xacro:if value="${n > 1}"><xacro:m n="${n - 1}"/></xacro:if>')
_NESTING = bodies(
    nested=macro("a", shown("${a}"), "n") + macro("a", '<v><xacro:n a="${a}"/><xacro:n a="2"/></v>') + '<xacro:m a="1"/>',
    recursion=_COUNT + '<xacro:m n="5"/>',
    recursion_of_two=macro("n", '<xacro:if value="${n}"><a/><xacro:q n="${n - 1}"/></xacro:if>')
    + macro("n", '<xacro:if value="${n}"><b/><xacro:m n="${n - 1}"/></xacro:if>', "q") + '<xacro:m n="4"/>',
    recursion_over_list=macro("l", '<xacro:if value="${len(l) > 0}"><link name="${l[0]}"/><xacro:m l="${l[1:]}"/></xacro:if>')
    + "<xacro:m l=\"${['a', 'b', 'c']}\"/>",
    recursion_without_end=macro("", "<xacro:m/>") + "<xacro:m/>",
    macro_in_macro_is_local=macro("", macro("", "<a/>", "n")) + "<xacro:m/><xacro:n/>",
    macro_in_macro_twice=macro("b", macro("a", shown("${a} ${b}"), "n") + '<xacro:n a="1"/>') + '<xacro:m b="2"/><xacro:m b="3"/>',
    macro_in_if='<xacro:if value="1">' + macro("", "<a/>") + "</xacro:if><xacro:m/>",
    macro_in_if_not='<xacro:if value="0">' + macro("", "<a/>") + "</xacro:if><xacro:m/>",
    redefined_with_other_parameters=macro("a:=1", shown("${a}")) + macro("b:=2", shown("${b}")) + "<xacro:m/>",
    redefined_drops_parameters=macro("a:=1", shown("${a}")) + macro("b:=2", shown("${b}")) + '<xacro:m a="1"/>',
    before_definition="<xacro:m/>" + macro("", "<a/>"),
    unknown_macro="<xacro:wheel/>",
    unknown_with_suggestion=macro("", "<a/>", "wheel") + "<xacro:whell/>",
    unknown_unprefixed=macro("", "<a/>") + "<m/>",
    case_matters=macro("", "<a/>") + "<xacro:M/>",
    unused=macro("a", shown("${missing} ${1 +}")) + "<a/>",
    error_in_body=macro("a", shown("${missing}")) + '<xacro:m a="1"/>',
    name_with_dot="<xacro:macro name='a.b' params=''><a/></xacro:macro>",
    name_call="<xacro:macro name='call' params=''><a/></xacro:macro>",
    name_missing="<xacro:macro params=''><a/></xacro:macro>",
    name_by_expression=named("n", "x") + "<xacro:macro name='${n}' params=''><a/></xacro:macro><xacro:x/>",
    name_like_tag="<xacro:macro name='if' params='value'><a/></xacro:macro><xacro:if value='0'/>",
    name_like_property=named("m", "3") + macro("", shown("${m}")) + "<xacro:m/>",
    name_with_space="<xacro:macro name='left wheel' params=''><a/></xacro:macro><a/>",
    whitespace_in_params="<xacro:macro name='m' params='  '><a/></xacro:macro><a/>",
    text_around="<v>before <xacro:m/> after</v>".join((macro("", "<a/>"), "")),
    text_in_macro=macro("", "inside") + "<v><xacro:m/></v>",
    xacro_attribute_dropped='<link name="a" xacro:note="b"/>',
    sees_later_property=macro("", shown("${late}")) + named("late", "2") + "<xacro:m/>",
)  # fmt: skip

_CALLS = bodies(
    call=macro("a", shown("${a}")) + '<xacro:call macro="m" a="1"/>',
    call_by_property=named("which", "m") + macro("a", shown("${a}")) + '<xacro:call macro="${which}" a="1"/>',
    call_by_text=named("side", "left") + macro("", "<a/>", "left_arm") + '<xacro:call macro="${side}_arm"/>',
    call_with_block=macro("*o", '<xacro:insert_block name="o"/>') + '<xacro:call macro="m"><b/></xacro:call>',
    call_unknown='<xacro:call macro="m"/>',
    call_without_macro="<xacro:call/>",
    call_empty='<xacro:call macro=""/>',
    call_undefined_property='<xacro:call macro="${which}"/>',
    call_missing_parameter=macro("a", shown("${a}")) + '<xacro:call macro="m"/>',
    call_parameter_named_macro=macro("macro", shown("${macro}")) + '<xacro:call macro="m"/>',
    call_in_macro=macro("", "<a/>") + macro("which", '<xacro:call macro="${which}"/>', "n") + '<xacro:n which="m"/>',
    call_with_prefix=macro("", "<a/>") + '<xacro:call macro="xacro:m"/>',
)

DOCUMENTS: Documents = merged(_PARAMETERS, _DEFAULTS, _BLOCKS, _NESTING, _CALLS)
# The first depends on the launch file; the second on how deep Python's stack is.
for _name in ("default-argument-undefined", "recursion-without-end"):
    DOCUMENTS[_name] = DOCUMENTS[_name]._replace(undetermined="perhaps")
