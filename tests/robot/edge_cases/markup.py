"""Tags, attributes, comments, CDATA and depth as TinyXML2 reads them."""

from tests.robot.edge_cases.case import clean, geometry, joint, links, one_joint, one_link, reference, rejected, robot

_NAME = "a tag name starts with a letter, _, : or a byte from 128"
_SPACE = "white space may follow < but not </"
_CLOSING = "a closing tag may have attributes"
_SELF_CLOSED = "a self-closed closing tag is an element"
_NESTING = "tags must nest"
_END = "a tag must end"
_PREFIX = "a prefix is part of the name and needs no declaration"
_QUOTES = "attributes are quoted"
_REPEATED = "attributes must not be repeated"
_ATTRIBUTE = "an attribute is a name, = and a quoted value"
_APART = "nothing is needed between attributes"
_HIGH = "bytes from 128 are part of a name"
_IN_VALUE = "a value holds anything but its quote"
_WHITE = "TinyXML2 keeps white space in values; only line ends become LF"
_COMMENT = "a comment ends at the first -->"
_CDATA = "CDATA is text up to the first ]]>"
_UNKNOWN = "<! up to > is skipped"
_TEXT = "text among elements is ignored"
_DEPTH = "498 elements may be open at once, counting the robot; a self-closed one does not count"
_CUT = "a file cut short does not load"

TAGS = (
    rejected("tag-name-starts-with-digit", _NAME, one_link("<1link/>")),
    rejected("tag-name-blank", _NAME, one_link("< >")),
    rejected("tag-name-is-dollar", _NAME, one_link("<$(arg x)/>")),
    rejected("tag-name-twice-opened", _NAME, robot(f"<{links('a')}")),
    rejected("tag-name-comma", _NAME, one_link("<a,b/>")),
    rejected("tag-name-plus", _NAME, one_link("<a+b/>")),
    clean("tag-name-ends-with-dot", _NAME, one_link("<link./>")),
    clean("tag-name-colon", _NAME, one_link("<:/>")),
    clean("tag-name-two-colons", _NAME, one_link("<a:b:c/>")),
    clean("tag-name-accented", _NAME, one_link("<é/>")),
    clean("tag-name-no-break-space", _NAME, one_link("<\u00a0/>")),
    rejected("tag-name-then-no-break-space", _NAME, robot('<link\u00a0name="a"/>')),
    clean("tag-name-is-not-link", "names are whole", robot(f"{links('a')}<links/><link.a/><link-b/><_link/>")),
    clean("tag-in-capitals", "names are case-sensitive", robot(f"{links('a')}<Link/><LINK/>")),
    rejected("tag-only-in-capitals", "no links", robot('<Link name="a"/>')),
    clean("tag-with-space-in-front", _SPACE, robot('< link name="a"/>')),
    rejected("tag-with-space-in-front-counts", "two roots", robot(f'{links("a")}< link name="b"/>')),
    clean("tag-with-space-after", _SPACE, robot('<link name="a" ></link >')),
    clean("closing-tag-with-space-in-front", _SPACE, robot('<link name="a">< /link>')),
    rejected("closing-tag-with-inner-space", _SPACE, robot('<link name="a"></ link>')),
    rejected("closing-tag-without-name", _SPACE, robot('<link name="a"></>')),
    clean("closing-tag-with-attribute", _CLOSING, robot('<link name="a"></link name="x">')),
    rejected("closing-tag-with-repeated-attribute", _REPEATED, robot('<link name="a"></link x="1" x="2">')),
    rejected("closing-tag-with-unquoted-attribute", _QUOTES, robot('<link name="a"></link x=1>')),
    rejected("closing-tag-with-text", _ATTRIBUTE, robot('<link name="a"></link end>')),
    clean("closing-tag-self-closed-inside", _SELF_CLOSED, robot('<link name="a"></link/></link>')),
    rejected("closing-tag-self-closed-as-end", _SELF_CLOSED, robot('<link name="a"></link/>')),
    clean("closing-tag-self-closed-as-link", _SELF_CLOSED, robot('</link name="a"/>')),
    clean("closing-tag-self-closed-unknown", _SELF_CLOSED, one_link("</a/>")),
    rejected("closing-tag-self-closed-second-link", "two roots", robot(f'{links("a")}</link name="b"/>')),
    rejected("closing-tag-self-closed-robot", _SELF_CLOSED, f'<robot name="r">{links("a")}</robot/>'),
    rejected("closing-tag-twice-slashed", _NAME, robot('<link name="a"><//link>')),
    rejected("closing-tag-of-other-name", _NESTING, robot('<link name="a"></joint>')),
    rejected("closing-tag-of-other-prefix", _NESTING, one_link("<a:b></c:b>")),
    rejected("closing-tag-missing", _NESTING, robot('<link name="a">')),
    rejected("closing-tag-doubled", _NESTING, robot('<link name="a"></link></link>')),
    rejected("closing-tag-after-self-closed", _NESTING, robot(f"{links('a')}</link>")),
    rejected("tags-crossed", _NESTING, one_link("<visual><geometry></visual></geometry>")),
    rejected("robot-end-inside-link", _NESTING, '<robot name="r"><link name="a"></robot></link>'),
    rejected("robot-end-missing", _NESTING, f'<robot name="r">{links("a")}'),
    rejected("robot-end-lacks-slash", _NESTING, f'<robot name="r">{links("a")}<robot>'),
    rejected("slash-then-space", _END, robot('<link name="a"/ >')),
    rejected("slash-in-front", _END, robot('<link / name="a"/>')),
    rejected("backslash-at-end", _END, robot('<link name="a"\\>')),
    rejected("angle-missing", _END, robot('<link name="a" <visual/></link>')),
    rejected("angle-missing-before-closing-tag", _END, robot('<link name="a"></link')),
    clean("angle-doubled", _TEXT, robot('<link name="a"/>>')),
    clean("prefix-undeclared", _PREFIX, robot(f'{links("a")}<xacro:property name="p" value="1"/>')),
    clean("prefix-undeclared-on-attribute", _PREFIX, robot('<link name="a" x:y="z"/>')),
    clean("prefix-undeclared-nested", _PREFIX, robot(f"{links('a')}<a:b><c:d/></a:b>")),
    clean("prefix-declared", _PREFIX, robot(links("a"), 'name="r" xmlns:xacro="http://www.ros.org/wiki/xacro"')),
    clean("prefix-xmlns-empty", _PREFIX, robot(links("a"), 'name="r" xmlns:a=""')),
    rejected("prefix-on-link", _PREFIX, robot('<urdf:link name="a"/>', 'name="r" xmlns:urdf="urn:x"')),
    rejected("prefix-on-name", _PREFIX, robot(links("a"), 'x:name="r"')),
    clean("default-namespace", _PREFIX, robot(links("a"), 'name="r" xmlns="http://www.ros.org"')),
    rejected("attribute-repeated-with-prefix", _REPEATED, robot(links("a"), 'name="r" a:b="1" a:b="2"')),
    clean("same-name-in-two-prefixes", _REPEATED, robot(links("a"), 'name="r" a:b="1" c:b="2"')),
    rejected("xmlns-repeated", _REPEATED, robot(links("a"), 'name="r" xmlns="a" xmlns="a"')),
)

ATTRIBUTES = (
    clean("attribute-in-apostrophes", _QUOTES, robot("<link name='a'/>")),
    rejected("attribute-unquoted", _QUOTES, robot("<link name=a/>")),
    rejected("attribute-unquoted-number", _QUOTES, one_link("<a b=1/>")),
    rejected("attribute-two-apostrophes", _QUOTES, robot("<link name=''a''/>")),
    rejected("attribute-opened-by-other-quote", _QUOTES, robot("<link name=\"a'/>")),
    rejected("attribute-quote-doubled", _QUOTES, robot('<link name="a""/>')),
    rejected("attribute-without-value", _ATTRIBUTE, robot('<link name="a" fixed/>')),
    rejected("attribute-without-value-at-end", _ATTRIBUTE, one_link("<a b></a>")),
    rejected("attribute-with-only-equals", _ATTRIBUTE, robot('<link name="a" b=/>')),
    rejected("attribute-without-name", _ATTRIBUTE, one_joint("").replace('<parent link="a"/>', '<parent="a"/>')),
    rejected("attribute-without-name-on-origin", _ATTRIBUTE, one_joint('<origin="0 0 0"/>')),
    rejected("attribute-only-a-value", _ATTRIBUTE, robot('<link "a"/>')),
    rejected("attribute-two-equals", _ATTRIBUTE, robot('<link name=="a"/>')),
    rejected("attribute-colon-for-equals", _ATTRIBUTE, robot('<link name: "a"/>')),
    rejected("attribute-glued-to-tag-name", _ATTRIBUTE, robot('<linkname="a"/>')),
    rejected("attribute-name-starts-with-digit", _ATTRIBUTE, robot('<link name="a" 1b="c"/>')),
    clean("attribute-name-odd", _ATTRIBUTE, robot('<link name="a" _b.c-1:d="e" :="f"/>')),
    clean("attribute-name-accented", _ATTRIBUTE, robot('<link name="a" é="b"/>')),
    clean("attribute-spaces-about-equals", _ATTRIBUTE, robot('<link name = "a"/>')),
    clean("attributes-parted-by-form-feed", "VT and FF are white space", robot('<link\vname="a"\fb="c"/>')),
    clean("attributes-touch", _APART, robot('<link name="a"b="c"/>')),
    clean("attributes-touch-on-robot", _APART, robot(links("a"), 'name="r"version="1.0"')),
    rejected("attributes-parted-by-comma", _APART, robot('<link name="a", b="c"/>')),
    rejected("attributes-parted-by-semicolon", _APART, robot('<link name="a"; b="c"/>')),
    clean("attributes-parted-by-no-break-space", _HIGH, one_joint('<origin xyz="0 0 0"\u00a0rpy="x"/>')),
    clean("attributes-parted-by-next-line", _HIGH, robot('<link name="a"\u0085b="c"/>')),
    rejected("attributes-parted-by-lone-no-break-space", _ATTRIBUTE, robot('<link name="a" \u00a0 b="c"/>')),
    rejected("attributes-parted-by-comment", _ATTRIBUTE, robot('<link name="a" <!-- c --> b="c"/>')),
    rejected("attribute-repeated", _REPEATED, robot('<link name="a" name="b"/>')),
    rejected("attribute-repeated-apart", _REPEATED, robot('<link name="a" b="c" name="a"/>')),
    rejected("attribute-repeated-unknown", _REPEATED, one_link('<a b="1" b="2"/>')),
    rejected("attribute-repeated-on-robot", _REPEATED, robot(links("a"), 'name="r" name="r"')),
    rejected("attribute-repeated-in-second-robot", _REPEATED, robot(links("a")) + '<robot a="" a=""/>'),
    clean("attribute-repeated-in-other-case", _REPEATED, robot('<link name="a" Name="b" NAME="c"/>')),
    clean("value-with-opening-angle", _IN_VALUE, robot(links("a<b"))),
    clean("value-with-closing-angle", _IN_VALUE, robot(links("a>b"))),
    clean("value-with-comment", _IN_VALUE, robot(links("<!-- a -->"))),
    clean("value-with-cdata", _IN_VALUE, robot(links("<![CDATA[a]]>"))),
    clean("value-with-xacro", _IN_VALUE, robot(links("${prefix}_a"))),
    clean("value-names-agree-with-angle", _IN_VALUE, reference("a<b", "a&lt;b")),
    clean("value-newline-agrees", _WHITE, reference("b\nc", "b\nc")),
    clean("value-crlf-is-newline", _WHITE, reference("b\r\nc", "b\nc")),
    clean("value-lfcrlf-is-two-newlines", _WHITE, reference("b\n\r\nc", "b\n\nc")),
    rejected("value-newline-is-no-space", _WHITE, reference("b\nc", "b c")),
    rejected("value-tab-is-no-space", _WHITE, reference("b\tc", "b c")),
    rejected("value-vertical-tab-is-no-space", _WHITE, reference("b\vc", "b c")),
    rejected("value-tab-is-no-newline", _WHITE, reference("b\tc", "b\nc")),
    rejected("value-spaces-are-kept", _WHITE, reference("b  c", "b c")),
    rejected("value-leading-space-is-kept", _WHITE, reference(" b", "b")),
    rejected("value-trailing-space-is-kept", _WHITE, reference("b ", "b")),
    rejected("value-trailing-newline-is-kept", _WHITE, reference("b\n", "b")),
    clean("value-line-separator-is-kept", _WHITE, reference("b\u2028c", "b\u2028c")),
)

COMMENTS = (
    clean("comment-plain", _COMMENT, one_link("<!-- a -->")),
    clean("comment-with-dashes", _COMMENT, one_link("<!-- a -- b -->")),
    clean("comment-ends-in-three-dashes", _COMMENT, one_link("<!-- a --->")),
    clean("comment-with-colon-and-tab", "a trap of ros2 launch, not of the parser", one_link("<!-- a: b\tc -->")),
    rejected("comment-hides-only-link", "no links", robot(f"<!-- {links('a')} -->")),
    rejected("comment-unterminated", _COMMENT, one_link("<!-- a")),
    rejected("comment-unterminated-after-root", _COMMENT, f"{one_link()}<!-- a"),
    rejected("comment-of-three-dashes", _COMMENT, one_link("<!--->")),
    clean("comment-of-three-dashes-goes-on", _COMMENT, one_link("<!---> a -->")),
    clean("comment-short-end-hides-link", _COMMENT, robot(f"{links('a')}<!-->{links('b')}<!-- -->")),
    clean("comment-nested", _COMMENT, one_link("<!-- a <!-- b --> c -->")),
    clean("comment-nested-shows-link", _COMMENT, robot(f"<!-- <!-- --> {links('a')} -->")),
    rejected("comment-nested-after-root", "text after the root must be blank", f"{one_link()}<!-- <!-- --> -->"),
    clean("comment-opened-with-one-dash", _UNKNOWN, one_link("<!- a ->")),
    rejected("comment-with-space-before-bang", _NAME, one_link("< !-- a -->")),
    clean("comment-in-geometry", _COMMENT, geometry('<!-- a --><sphere radius="1"/>')),
    clean("comment-in-value", _IN_VALUE, reference("b<!-- -->", "b<!-- -->")),
    clean("unknown-empty", _UNKNOWN, one_link("<!>")),
    clean("unknown-in-robot", _UNKNOWN, robot(f"{links('a')}<!ELEMENT link ANY>")),
    clean("unknown-conditional", _UNKNOWN, one_link("<![if a]> b <![endif]>")),
    rejected("unknown-unterminated", _UNKNOWN, f"{one_link()}<!a"),
    clean("cdata-plain", _CDATA, one_link("<![CDATA[a]]>")),
    clean("cdata-hides-link", _CDATA, robot(f"{links('a')}<![CDATA[{links('b')}]]>")),
    rejected("cdata-hides-only-link", "no links", robot(f"<![CDATA[{links('a')}]]>")),
    clean("cdata-in-geometry", _CDATA, geometry('<![CDATA[a]]><sphere radius="1"/>')),
    clean("cdata-nested", _CDATA, one_link("<![CDATA[ a <![CDATA[ b ]]> c ]]>")),
    rejected("cdata-lower-case-hides-little", _UNKNOWN, robot(f"{links('a')}<![cdata[ > {links('b')} ]]>")),
    rejected("cdata-unterminated", _CDATA, one_link("<![CDATA[ a")),
    rejected("cdata-unterminated-after-root", _CDATA, f"{one_link()}<![CDATA["),
    rejected("cdata-in-tag", _ATTRIBUTE, robot('<link <![CDATA[name="a"]]>/>')),
    clean("text-with-cdata-end", _TEXT, one_link("]]>")),
    clean("text-of-bare-ampersand", _TEXT, one_link("a & b &c; &#xZZ; &#0;")),
    rejected("text-with-opening-angle", _NAME, one_link("a < 1")),
    rejected("text-like-a-tag", _NESTING, one_link("a <b c")),
)


def _nested(depth: int, leaf: str = "") -> str:
    opened = depth - 2
    return one_link("<a>" * opened + leaf + "</a>" * opened)


DEPTHS = (
    clean("depth-250", _DEPTH, _nested(250)),
    clean("depth-257", _DEPTH, _nested(257)),
    rejected("depth-499", _DEPTH, _nested(499)),
    clean("depth-498-self-closed-leaf", _DEPTH, _nested(498, "<b/>")),
    clean("depth-498-self-closed-closing-tag", _DEPTH, _nested(498, "</b/>")),
    clean("depth-498-text-leaf", _DEPTH, _nested(498, "text<!-- a --><![CDATA[b]]>")),
    rejected("depth-outside-robot", _DEPTH, one_link() + "<a>" * 499 + "</a>" * 499),
    clean("depth-outside-robot-allowed", _DEPTH, one_link() + "<a>" * 498 + "</a>" * 498),
    rejected("depth-before-robot", _DEPTH, "<a>" * 499 + "</a>" * 499 + one_link()),
    clean("depth-in-comment", _DEPTH, one_link("<!-- " + "<a>" * 600 + " -->")),
    clean("depth-in-cdata", _DEPTH, one_link("<![CDATA[" + "<a>" * 600 + "]]>")),
    clean("depth-in-value", _DEPTH, robot(links("<a>" * 600))),
    clean("siblings-1000", _DEPTH, one_link("<a></a>" * 1000)),
    clean("siblings-after-depth", _DEPTH, _nested(498) + "<b></b>"),
)

_WHOLE = f"""<?xml version="1.0"?>
<!-- a robot -->
<robot name="r">
  {links("a", "b")}
  {joint("a", "b")}
</robot>"""


def _until(end: str) -> str:
    return _WHOLE[: _WHOLE.index(end) + len(end)]


TRUNCATED = (
    clean("cut-nothing", _CUT, _WHOLE),
    rejected("cut-in-declaration", _CUT, _until("<?xml vers")),
    rejected("cut-after-declaration", _CUT, _until("?>\n")),
    rejected("cut-in-comment", _CUT, _until("<!-- a ro")),
    rejected("cut-after-comment", _CUT, _until("-->\n")),
    rejected("cut-after-angle", _CUT, _until("-->\n<")),
    rejected("cut-in-tag-name", _CUT, _until("<rob")),
    rejected("cut-after-tag-name", _CUT, _until("<robot")),
    rejected("cut-in-attribute-name", _CUT, _until("<robot na")),
    rejected("cut-after-equals", _CUT, _until("<robot name=")),
    rejected("cut-after-quote", _CUT, _until('<robot name="')),
    rejected("cut-after-value", _CUT, _until('<robot name="r"')),
    rejected("cut-after-robot-tag", _CUT, _until('<robot name="r">')),
    rejected("cut-in-slash", _CUT, _until('<link name="b"/')),
    rejected("cut-after-links", _CUT, _until('<link name="b"/>')),
    rejected("cut-in-joint", _CUT, _until('<parent link="a"/>')),
    rejected("cut-after-joint", _CUT, _until("</joint>\n")),
    rejected("cut-in-closing-tag", _CUT, _until("</rob")),
    rejected("cut-before-last-angle", _CUT, _until("</robot")),
)

CASES = TAGS + ATTRIBUTES + COMMENTS + DEPTHS + TRUNCATED
