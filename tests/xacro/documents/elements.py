"""Elements and text: `element`, `attribute`, escapes, comments, CDATA, namespaces, and XML that is not well-formed."""

from tests.xacro.documents.document import Document, Documents, bodies, merged, named, robot, shown

_ELEMENT = bodies(
    element='<xacro:element xacro:name="link" name="a"/>',
    element_by_property=named("n", "sphere") + '<xacro:element xacro:name="${n}" radius="${1 / 2}"/>',
    element_by_text=named("n", "base") + '<xacro:element xacro:name="${n}_link"/>',
    element_with_content='<xacro:element xacro:name="a">text<b x="${1 + 1}"/></xacro:element>',
    element_empty_name='<xacro:element xacro:name=""/>',
    element_without_name='<xacro:element name="a"/>',
    element_empty_expression='<xacro:element xacro:name="${\'\'}"/>',
    element_undefined='<xacro:element xacro:name="${n}"/>',
    element_becomes_if='<xacro:element xacro:name="xacro:if" value="0"><a/></xacro:element>',
    element_becomes_macro="<xacro:macro name='m' params='a'>" + shown("${a}") + '</xacro:macro><xacro:element xacro:name="xacro:m" a="1"/>',
    element_becomes_property='<xacro:element xacro:name="xacro:property" name="a" value="1"/>' + shown("${a}"),
    element_in_element='<xacro:element xacro:name="a"><xacro:element xacro:name="b"/></xacro:element>',
    element_in_macro="<xacro:macro name='m' params='n'><xacro:element xacro:name='${n}'/></xacro:macro><xacro:m n='a'/><xacro:m n='b'/>",
    element_of_number='<xacro:element xacro:name="${1}"/>',
    element_of_bad_name='<xacro:element xacro:name="a b"/>',
    element_with_unknown_prefix='<xacro:element xacro:name="g:a"/>',
    attribute='<link><xacro:attribute name="name" value="a"/></link>',
    attribute_by_property=named("n", "name") + '<link><xacro:attribute name="${n}" value="${n}_b"/></link>',
    attribute_replaces='<link name="a"><xacro:attribute name="name" value="b"/></link>',
    attribute_number='<link><xacro:attribute name="size" value="${1 + 1}"/></link>',
    attribute_number_as_text='<link><xacro:attribute name="size" value="${str(1 + 1)}"/></link>',
    attribute_number_in_text='<link><xacro:attribute name="size" value="${1 + 1} m"/></link>',
    attribute_empty_name='<link><xacro:attribute name="" value="a"/></link>',
    attribute_without_name='<link><xacro:attribute value="a"/></link>',
    attribute_without_value='<link><xacro:attribute name="a"/></link>',
    attribute_bad_name='<link><xacro:attribute name="a b" value="c"/></link>',
    attribute_in_if='<link><xacro:if value="1"><xacro:attribute name="name" value="b"/></xacro:if></link>',
    attribute_in_macro="<xacro:macro name='m' params='n'><xacro:attribute name='name' value='${n}'/></xacro:macro>"
    '<link><xacro:m n="a"/></link>',
    attribute_is_not_evaluated_again='<link><xacro:attribute name="name" value="$${b}"/></link>',
    attribute_in_block="<xacro:macro name='m' params='*b'><xacro:insert_block name='b'/></xacro:macro>"
    '<xacro:m><link><xacro:attribute name="name" value="a"/></link></xacro:m>',
    attribute_in_element='<xacro:element xacro:name="link"><xacro:attribute name="name" value="a"/></xacro:element>',
    attribute_of_xacro='<link><xacro:attribute name="xacro:note" value="a"/></link>',
)  # fmt: skip

_ESCAPES = (
    "$", "a$", "$a", "$ ", "$$", "$$$", "a$$b", "$${", "$$(", "$${a}", "$$(arg a)", "$$${a}", "$$$(a)", "$$$${a}", "a$${b}c", "${'$'}",
    "${'$$'}", "$${${1}}", "${1}$${2}", "${", "$(", "${}", "${ }", "$()", "${1", "${1}}", "{${1}}", "}", "{", "$[a]", "\\${1}", "${'}'}",
    "${dict(a=1)}", "${ {'a': 1}['a'] }", "${'{'}", "${1}${2}", "${1} ${2}", "${1}$(arg b)", "#{1}", "%{1}", "$1", "${'a' 'b'}", "5 $ and ${1}",
    "${1;2}", "${a = 1}", "${1 # comment}", "${\n1 + 1\n}", "${(1 +\n1)}", "${1\n+ 1}", "${ 1 }", "${\t1}", "${'a\\nb'}", "${'\\x41'}",
    '${"double"}', "${'it''s'}", "${u'a'}", "${b'a'}", "${r'\\a'}", "${'é'}", "&lt;${1}&gt;".replace("&lt;", "<").replace("&gt;", ">"),
    "${'<' + '&'}", "${1}&", "${'a\"b'}",
)  # fmt: skip
_ESCAPED = {f"escape-{text}": Document(robot('<xacro:arg name="b" default="2"/>' + shown(text))) for text in _ESCAPES}

_ESCAPED["escape-${b'a'}"] = _ESCAPED["escape-${b'a'}"]._replace(undetermined="perhaps")

_TEXT = bodies(
    text="<a>${1 + 1}</a>",
    tag_with_umlaut="<größe x='${1 + 1}'/>",
    attribute_with_umlaut="<a größe='${1 + 1}'/>",
    dot_instead_of_colon="<xacro.include filename='missing.xacro'/><xacro.property name='a' value='1'/>",
    dash_instead_of_colon="<xacro-if value='0'><a/></xacro-if>",
    control_character_by_expression="<a>${'\\x08'}</a>",
    control_character_in_attribute=shown("${'\\x08'}"),
    nul_by_expression=shown("${'\\x00'}"),
    surrogate_by_expression=shown("${'\\ud800'}"),
    control_character_in_property=named("a", "${'\\x08'}") + shown("1"),
    control_character_in_condition="<xacro:if value=\"${'\\x08' == 'a'}\"><b/></xacro:if>",
    text_mixed="<a>one ${1 + 1} three <b/> four ${2 * 2}</a>",
    text_escape="<a>$${b} $$(c)</a>",
    text_undefined="<a>${missing}</a>",
    text_lone_dollar="<a>5 $</a>",
    text_unclosed="<a>${1</a>",
    text_entities="<a>&lt;${1}&amp;&gt;</a>",
    text_character_reference="<a>&#36;{1 + 1}</a>",
    text_lines="<a>\n  ${1}\n  ${2}\n</a>",
    text_expression_over_lines="<a>${1 +\n 1}</a>",
    text_expression_in_brackets="<a>${(1 +\n 1)}</a>",
    text_around_element="<a>${<b/>}</a>",
    text_in_robot="${1 + 1}",
    text_typed="<a>${[1, 2]}</a>",
    text_none="<a>${None}</a>",
    text_number_format="<a>${0.1 + 0.2}</a>",
    cdata="<a><![CDATA[${1 + 1}]]></a>",
    cdata_undefined="<a><![CDATA[${missing} <b>]]></a>",
    cdata_and_text="<a>${1}<![CDATA[${2}]]>${3}</a>",
    comment_evaluated_undefined="<!-- xacro:eval-comments --><!-- ${missing} --><a/>",
    comment_evaluated_in_between="<!-- xacro:eval-comments -->text<!-- ${missing} --><b/>",
    comment_before_macro_call="<xacro:macro name='m' params=''><a/></xacro:macro><!-- gone --><xacro:m/>",
    white_space_attribute="<shown x='  ${1}  '/>",
    tab_in_attribute="<shown x='a\tb\n${1}'/>",
    expression_in_tag_name="<link_${1}/>",
    expression_in_attribute_name="<link ${1}='a'/>",
    order_of_attributes=named("a", "1") + '<link z="${a}" b="${a}" m="${a}"/>',
    attribute_list=shown("${[1, 'a', None, 1.50]}", "${(1,)}", "${()}"),
    attribute_empty=shown("", "${''}"),
)  # fmt: skip

_XACRO = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
_BODY = '<xacro:property name="a" value="1"/><shown x="${a}"/>'
_ROOTS: Documents = {
    "no-namespace": Document(f'<robot name="r">{_BODY}</robot>'),
    "no-namespace-without-xacro": Document('<robot name="r"><shown x="${1 + 1}"/></robot>'),
    "old-namespace": Document(f'<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">{_BODY}</robot>'),
    "other-uri": Document(f'<robot name="r" xmlns:xacro="urn:x">{_BODY}</robot>'),
    "empty-uri": Document(f'<robot name="r" xmlns:xacro="">{_BODY}</robot>'),
    "other-prefix": Document(
        '<robot name="r" xmlns:x="http://www.ros.org/wiki/xacro"><x:property name="a" value="1"/><x:b y="${1}"/></robot>'
    ),
    "capital-prefix": Document('<robot name="r" xmlns:Xacro="urn:x"><Xacro:property name="a" value="1"/></robot>'),
    "target-namespace": Document(f'<robot name="r" {_XACRO} xacro:targetNamespace="urn:t">{_BODY}</robot>'),
    "other-namespaces": Document(f'<robot name="r" {_XACRO} xmlns:g="urn:g"><g:a b="${{1 + 1}}" g:c="${{2}}"/></robot>'),
    "namespace-with-expression": Document(f'<robot name="r" {_XACRO} xmlns:g="urn:${{1 + 1}}"><g:a/></robot>'),
    "expression-in-name": Document(f'<robot name="${{\'a\' + \'b\'}}" {_XACRO}><link name="l"/></robot>'),
    "property-in-name": Document(f'<robot name="${{a}}" {_XACRO}>{_BODY}</robot>'),
    "argument-in-name": Document(f'<robot name="$(arg a)" {_XACRO}><link name="l"/></robot>', arguments={"a": "given"}),
    "root-is-xacro": Document(f"<xacro:robot {_XACRO}>{_BODY}</xacro:robot>", undetermined="perhaps"),
    "root-is-macro": Document(f"<xacro:macro {_XACRO} name='m' params=''/>", undetermined="perhaps"),
    "empty": Document(""),
    "text-only": Document("robot"),
    "white-space-first": Document("\n" + robot("")),
    "comment-first": Document("<!-- about -->\n" + robot("").partition("\n")[2]),
    "comment-before-declaration": Document("<!-- about -->\n" + robot("")),
    "text-last": Document(robot("<a/>") + "end"),
    "two-roots": Document(f"<robot {_XACRO}/><robot {_XACRO}/>"),
    "byte-order-mark": Document("\ufeff" + robot(_BODY)),
    "carriage-returns": Document(robot(_BODY + "\n<a>b\n</a>").replace("\n", "\r\n")),
    "declaration-without-quotes": Document(robot("<a/>").replace('"1.0"', "1.0")),
    "internal-entity": Document(f'<!DOCTYPE robot [<!ENTITY w "0.5">]><robot {_XACRO}><shown x="&w;"/></robot>', undetermined="perhaps"),
}  # fmt: skip

_MARKUP = bodies(
    mismatched_tag="<link></joint>",
    unclosed_tag='<link name="a">',
    closing_tag_with_attribute='<link></link name="a">',
    tag_without_name='<="a"/>',
    attribute_without_value_in_markup="<link name/>",
    attribute_without_quotes="<link name=a/>",
    attribute_twice='<link name="a" name="b"/>',
    comma_between_attributes='<link name="a", type="b"/>',
    bare_ampersand="<a>b & c</a>",
    bare_less_than='<xacro:if value="${1 < 2}"><a/></xacro:if>',
    unknown_entity="<a>&nbsp;</a>",
    double_dash_in_comment="<!-- a -- b --><a/>",
    unclosed_comment="<!-- a <b/>",
    control_character="<a>\x01</a>",
    missing_quote='<link name="a/><b c="1"/>',
    quote_in_expression='<shown x="${dict["a"]}"/>',
    nul="<a>\x00</a>",
)  # fmt: skip

DOCUMENTS: Documents = merged(_ELEMENT, _ESCAPED, _TEXT, _ROOTS, _MARKUP)
