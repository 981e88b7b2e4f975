"""Properties: when they are evaluated, where they are visible, which literals are numbers, blocks."""

from tests.xacro.documents.document import Document, Documents, bodies, merged, named, robot, shown

_NESTED = '<xacro:macro name="m" params="">{}</xacro:macro>'

_EVALUATION = bodies(
    lazy=named("a", "${b}") + named("b", "1") + shown("${a}"),
    lazy_in_text=named("a", "x ${b} y") + named("b", "1.50") + shown("${a}"),
    lazy_keeps_first_use=named("a", "${b}") + named("b", "1") + shown("${a}") + named("b", "2") + shown("${a} ${b}"),
    lazy_last_definition=named("a", "${b}") + named("b", "1") + named("b", "2") + shown("${a}"),
    eager=named("b", "1") + named("a", "${b}", 'lazy_eval="false"') + named("b", "2") + shown("${a}"),
    eager_before_definition=named("a", "${b}", 'lazy_eval="false"') + named("b", "1") + shown("${a}"),
    eager_by_expression=named("b", "1") + named("a", "${b}", 'lazy_eval="${1 == 2}"') + named("b", "2") + shown("${a}"),
    lazy_by_zero=named("b", "1") + named("a", "${b}", 'lazy_eval="0"') + named("b", "2") + shown("${a}"),
    lazy_by_nonsense=named("a", "1", 'lazy_eval="no"') + shown("${a}"),
    eager_own_redefinition=named("a", "1") + named("a", "${a + 1}", 'lazy_eval="false"') + shown("${a}"),
    lazy_own_redefinition=named("a", "1") + named("a", "${a + 1}") + shown("${a}"),
    circular=named("a", "${b}") + named("b", "${a}") + shown("${a}"),
    circular_by_three=named("a", "${b}") + named("b", "${c + 1}") + named("c", "${a}") + shown("${c}"),
    circular_unused=named("a", "${b}") + named("b", "${a}") + shown("1"),
    undefined_unused=named("a", "${missing}") + shown("1"),
    undefined_used=named("a", "${missing}") + shown("${a}"),
    use_before_definition=shown("${a}") + named("a", "1"),
    redefinition=named("a", "1") + shown("${a}") + named("a", "2") + shown("${a}"),
    chain=named("a", "2") + named("b", "${a * 2}") + named("c", "${b * a}") + shown("${c} ${b} ${a}"),
    two_expressions_join=named("a", "1${1}") + shown("${a + 1}"),
    string_of_number=named("a", "${str(1)}") + shown("${a + 1}"),
    evaluated_twice=named("a", "$${b}") + named("b", "3") + shown("${a}"),
    evaluated_three_times=named("a", "$$${b}") + named("b", "3") + shown("${a}"),
    property_in_property_name=named("n", "wheel") + named("${n}", "7") + shown("${wheel}"),
    property_name_of_two=named("n", "wheel") + named("${n}_radius", "7") + shown("${wheel_radius}"),
    property_name_from_number=named("n", "1") + named("a${n}", "7") + shown("${a1}"),
    property_name_is_number=named("${1}", "7"),
    empty_value=named("a", "") + shown("[${a}]", "${len(a)}"),
    value_with_spaces=named("a", "  b c ") + shown("[${a}]"),
    value_with_line_break="<xacro:property name='a' value='b\n c'/>" + shown("[${a}]"),
    number_with_spaces=named("a", " 5 ") + shown("${a + 1}"),
    vector=named("origin", "0 ${1/2} -0.25") + shown("${origin}"),
    typed=named("a", "${[1, 2, 3]}") + shown("${a[1]} ${a}"),
    typed_dict=named("a", "${dict(x=1, y='b')}") + shown("${a['x']} ${a['y']} ${a}"),
    typed_none=named("a", "${None}") + shown("${a}"),
    expression_gives_expression=named("a", "${'$' + '{b}'}") + named("b", "3") + shown("${a}"),
)

_SCOPES = bodies(
    scope_local=_NESTED.format(named("a", "2") + shown("${a}")) + named("a", "1") + "<xacro:m/>" + shown("${a}"),
    scope_local_is_gone=_NESTED.format(named("a", "2")) + "<xacro:m/>" + shown("${a}"),
    scope_parent=_NESTED.format(named("a", "${1 + 1}", 'scope="parent"')) + "<xacro:m/>" + shown("${a}"),
    scope_parent_overrides=named("a", "1")
    + _NESTED.format(named("a", "2", 'scope="parent"'))
    + "<xacro:m/>"
    + shown("${a}"),
    scope_parent_of_two='<xacro:macro name="n" params=""><xacro:m/>'
    + shown("${a}")
    + "</xacro:macro>"
    + _NESTED.format(named("a", "2", 'scope="parent"'))
    + "<xacro:n/>"
    + shown("${a}"),
    scope_global=_NESTED.format(named("a", "${1 + 1}", 'scope="global"')) + "<xacro:m/>" + shown("${a}"),
    scope_global_of_two='<xacro:macro name="n" params=""><xacro:m/></xacro:macro>'
    + _NESTED.format(named("a", "2", 'scope="global"'))
    + "<xacro:n/>"
    + shown("${a}"),
    scope_global_uses_local=_NESTED.format(named("b", "5") + named("a", "${b}", 'scope="global"'))
    + "<xacro:m/>"
    + shown("${a}"),
    scope_parent_at_top=named("a", "1", 'scope="parent"') + shown("${a}"),
    scope_parent_at_top_undefined=named("a", "${b}", 'scope="parent"') + shown("${1}"),
    scope_global_at_top=named("a", "1", 'scope="global"') + shown("${a}"),
    scope_unknown=named("a", "1", 'scope="somewhere"') + shown("${a}"),
    scope_parent_in_if='<xacro:if value="1">' + named("a", "1", 'scope="parent"') + "</xacro:if>" + shown("${a}"),
    property_in_if='<xacro:if value="1">' + named("a", "1") + "</xacro:if>" + shown("${a}"),
    macro_sees_global=_NESTED.format(shown("${a}")) + named("a", "1") + "<xacro:m/>" + named("a", "2") + "<xacro:m/>",
    macro_sees_callers_scope='<xacro:macro name="n" params="a"><xacro:m/></xacro:macro>'
    + _NESTED.format(shown("${a}"))
    + '<xacro:n a="3"/>',
    macro_sees_no_sibling='<xacro:macro name="n" params="a">'
    + shown("${a}")
    + "</xacro:macro>"
    + _NESTED.format(shown("${a}"))
    + '<xacro:n a="3"/><xacro:m/>',
    parameter_hides_property='<xacro:macro name="n" params="a">'
    + shown("${a}")
    + "</xacro:macro>"
    + named("a", "1")
    + '<xacro:n a="3"/>'
    + shown("${a}"),
    lazy_in_macro_uses_callers_scope=named("a", "${b}")
    + '<xacro:macro name="n" params="b">'
    + shown("${a}")
    + "</xacro:macro>"
    + named("b", "1")
    + '<xacro:n b="3"/>',
    global_symbol_redefined=named("pi", "3") + shown("${pi} ${math.pi}"),
    function_redefined=named("sin", "3") + shown("${sin} ${math.sin(0)}"),
    python_survives=named("len", "3") + shown("${len} ${python.len('ab')}"),
)

_DEFAULTS = bodies(
    default_used='<xacro:property name="a" default="1"/>' + shown("${a}"),
    default_unused=named("a", "2") + '<xacro:property name="a" default="1"/>' + shown("${a}"),
    default_twice='<xacro:property name="a" default="1"/><xacro:property name="a" default="2"/>' + shown("${a}"),
    default_lazy='<xacro:property name="a" default="${b}"/>' + named("b", "4") + shown("${a}"),
    default_in_macro=named("a", "2")
    + _NESTED.format('<xacro:property name="a" default="1"/>' + shown("${a}"))
    + "<xacro:m/>",
    default_of_global_symbol='<xacro:property name="pi" default="3"/>' + shown("${pi}"),
    default_and_value='<xacro:property name="a" default="1" value="2"/>',
    default_empty='<xacro:property name="a" default=""/>' + shown("[${a}]"),
    default_with_scope='<xacro:property name="a" default="1" scope="global"/>' + shown("${a}"),
    remove=named("a", "1") + '<xacro:property name="a" remove="true"/>' + shown("${a}"),
    remove_unused=named("a", "1") + '<xacro:property name="a" remove="true"/>' + shown("1"),
    remove_then_define=named("a", "1") + '<xacro:property name="a" remove="1"/>' + named("a", "2") + shown("${a}"),
    remove_then_default=named("a", "1")
    + '<xacro:property name="a" remove="true"/><xacro:property name="a" default="5"/>'
    + shown("${a}"),
    remove_and_value=named("a", "1", 'remove="true"'),
    remove_undefined='<xacro:property name="a" remove="true"/>' + shown("1"),
    remove_undefined_is_block='<xacro:property name="a" remove="true"/><xacro:insert_block name="a"/>' + shown("1"),
    remove_by_expression=named("a", "1") + '<xacro:property name="a" remove="${1 == 1}"/>' + shown("${a}"),
    remove_global_symbol='<xacro:property name="pi" remove="true"/>' + shown("${pi}"),
    remove_in_macro=named("a", "1")
    + _NESTED.format('<xacro:property name="a" remove="true"/>')
    + "<xacro:m/>"
    + shown("${a}"),
    remove_nonsense='<xacro:property name="a" remove="maybe"/>',
)

_BLOCKS = bodies(
    block='<xacro:property name="b"><origin xyz="1 0 0"/></xacro:property><xacro:insert_block name="b"/>',
    block_of_two='<xacro:property name="b"><a/><b x="${1+1}"/></xacro:property><v><xacro:insert_block name="b"/></v>',
    block_twice='<xacro:property name="b"><a/></xacro:property><xacro:insert_block name="b"/><xacro:insert_block name="b"/>',
    block_lazy='<xacro:property name="b"><a x="${c}"/></xacro:property>' + named("c", "1") + '<xacro:insert_block name="b"/>',
    block_in_scope='<xacro:property name="b"><a x="${c}"/></xacro:property><xacro:macro name="m" params="c">'
    '<xacro:insert_block name="b"/></xacro:macro><xacro:m c="1"/><xacro:m c="2"/>',
    block_undefined='<xacro:insert_block name="b"/>',
    block_without_name="<xacro:insert_block/>",
    block_is_a_value=named("b", "1") + '<xacro:insert_block name="b"/>',
    block_as_value='<xacro:property name="b"><a/></xacro:property>' + shown("${b}"),
    block_of_text='<xacro:property name="b"> text ${1+2} </xacro:property><v><xacro:insert_block name="b"/></v>',
    block_with_macro='<xacro:macro name="m" params=""><a/></xacro:macro><xacro:property name="b"><xacro:m/></xacro:property>'
    '<xacro:insert_block name="b"/>',
    block_with_property='<xacro:property name="b">' + named("c", "4") + shown("${c}") + "</xacro:property>"
    '<xacro:insert_block name="b"/>' + shown("${c}"),
    block_of_itself='<xacro:property name="b"><xacro:insert_block name="b"/></xacro:property><xacro:insert_block name="b"/>',
    block_global='<xacro:macro name="m" params=""><xacro:property name="b" scope="global"><a/></xacro:property></xacro:macro>'
    '<xacro:m/><xacro:insert_block name="b"/>',
    block_parent='<xacro:macro name="m" params=""><xacro:property name="b" scope="parent"><a/></xacro:property></xacro:macro>'
    '<xacro:m/><xacro:insert_block name="b"/>',
    block_local='<xacro:macro name="m" params=""><xacro:property name="b"><a/></xacro:property></xacro:macro>'
    '<xacro:m/><xacro:insert_block name="b"/>',
    block_conditional='<xacro:property name="b"><xacro:if value="${c}"><a/></xacro:if></xacro:property>'
    + named("c", "false") + '<xacro:insert_block name="b"/>' + named("c", "true") + '<xacro:insert_block name="b"/>',
    block_name_by_expression='<xacro:property name="b"><a/></xacro:property>' + named("n", "b")
    + '<xacro:insert_block name="${n}"/>',
    block_removed='<xacro:property name="b"><a/></xacro:property><xacro:property name="b" remove="true"/>'
    '<xacro:insert_block name="b"/>',
    block_default='<xacro:property name="b"><a/></xacro:property><xacro:property name="b" default="1"/>' + shown("${b}"),
)  # fmt: skip

_LITERALS = (
    "1", "01", "-1", "+1", "1.", ".5", "-.5", "1.0", "1.50", "1e3", "1E-3", "1e-7", "1_000", "1_0.5", "0x10", "1e400", "nan", "inf",
    "-inf", "infinity", "true", "True", "TRUE", "false", "False", "yes", "none", "None", "'1'", "''", "'", "'a b'", "'a' 'b'",
    "''1''", '"1"', "1 2 3", "1,2", "[1, 2]", "1/2", "pi", "a b", "٣", "1000000000000000000000", "0.1", "123456789.123456789",
    "1e16", "1e15", "100000000000000000.0", "0.00001", "-0", "-0.0", "'true'", "'${1 + 1}'", "1 ", "\t1", "1__0", "_1", "1_",
)  # fmt: skip
_LITERAL_DOCUMENTS = {
    f"literal-{text}": Document(robot(named("a", text) + shown("${a}", "${[a]}", "${a == 1}", "${a * 2}", "_${a}_")))
    for text in _LITERALS
}

_NAMES = (
    "a b", "1a", "a-b", "a.b", "", "if", "class", "None", "True", "__a", "_a", "__", "a__", "é", "a()", " a", "a ", "lambda", "(a)",
    "match", "print",
)  # fmt: skip
_NAME_DOCUMENTS = {f"name-{name}": Document(robot(named(name, "1") + shown("1"))) for name in _NAMES}

_ATTRIBUTES = bodies(
    without_name='<xacro:property value="1"/>',
    name_with_undefined=named("${missing}", "1"),
)

DOCUMENTS: Documents = merged(
    _EVALUATION, _SCOPES, _DEFAULTS, _BLOCKS, _LITERAL_DOCUMENTS, _NAME_DOCUMENTS, _ATTRIBUTES
)
DOCUMENTS["block-of-itself"] = DOCUMENTS["block-of-itself"]._replace(undetermined="perhaps")  # Python's stack ends
