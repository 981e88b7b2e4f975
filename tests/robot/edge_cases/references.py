"""Entities and character references: which ones TinyXML2 decodes, and what it makes of the others."""

from tests.robot.edge_cases.case import (
    clean,
    degraded,
    geometry,
    links,
    one_joint,
    one_link,
    reference,
    rejected,
    robot,
    visual,
    with_bytes,
)

_ATTRIBUTE = "an attribute is a name, = and a quoted value"
_KNOWN = "five entities are known"
_LITERAL = "an unknown entity or a bare & stays as it is"
_STALE = "after a decoded entity a bare & becomes the byte that stood in its new place"
_NUMERIC = "&# and digits, or &#x and hex digits, decode up to U+10FFFF"
_MALFORMED = "a malformed character reference stays as it is"
_BACKWARDS = "&# reaches to the next ;, and its digits back to the last # or x"
_BEYOND = "TinyXML2 10 encodes up to U+1FFFFF and drops what is beyond"
_NUL = "a reference without value is NUL, which ends the value"
_ONCE = "a value is decoded once"
_NUMBER = "a number is read after decoding"
_RAW = "a decoded line end or tab is not normalised"

ENTITIES = (
    clean("entity-amp", _KNOWN, reference("b&amp;c", "b&c")),
    clean("entity-lt", _KNOWN, reference("b&lt;c", "b<c")),
    clean("entity-gt", _KNOWN, reference("b&gt;c", "b>c")),
    rejected("entity-in-capitals", _LITERAL, reference("b&AMP;c", "b&amp;c")),
    rejected("entity-nbsp", _LITERAL, reference("b&nbsp;c", "b\u00a0c")),
    clean("entity-nbsp-is-literal", _LITERAL, reference("b&nbsp;c", "b&amp;nbsp;c")),
    clean("ampersand-twice", _LITERAL, reference("b&&c", "b&#38;&#38;c")),
    clean("ampersand-in-robot-name", _LITERAL, robot(links("a"), 'name="R&D"')),
    clean("ampersand-in-url", _LITERAL, geometry('<mesh filename="a?b=c&d=e"/>')),
    clean("ampersand-in-text", _LITERAL, one_link("R&D &nope; &")),
    clean("ampersand-in-comment", _LITERAL, one_link("<!-- R&D &nope; &#0; -->")),
    rejected("ampersand-in-tag", "a tag name is made of name characters", one_link("<a&b/>")),
    rejected("entity-as-quote", "attributes are quoted", robot("<link name=&quot;a&quot;/>")),
    rejected("entity-as-angle", "no links", robot('&lt;link name="a"/>')),
    clean("ampersand-after-entity", _STALE, reference("&lt;&c", "&lt;lc")),
    rejected("ampersand-after-entity-is-no-ampersand", _STALE, reference("&lt;&c", "&lt;&amp;c")),
    clean("ampersand-after-reference", _STALE, reference("&#98;&c", "b#c")),
    clean("ampersand-before-entity", _STALE, reference("b&c&lt;", "b&amp;c&lt;")),
    rejected("entity-decoded-once", _ONCE, reference("b&amp;lt;c", "b&lt;c")),
    clean("entity-decoded-once-is-literal", _ONCE, reference("b&amp;lt;c", "b&#38;lt;c")),
    rejected("duplicate-link-by-reference", "a link name must not be used twice", robot(links("a", "&#97;"))),
    clean("type-by-reference", "any value is decoded", one_joint().replace("fixed", "&#102;ixed")),
    clean("version-by-reference", "any value is decoded", robot(links("a"), 'name="r" version="&#49;.0"')),
)

REFERENCES = (
    clean("reference-decimal", _NUMERIC, reference("&#98;", "b")),
    clean("reference-hex", _NUMERIC, reference("&#x62;", "b")),
    clean("reference-control", _NUMERIC, reference("&#1;", "\x01")),
    clean("reference-noncharacter", _NUMERIC, reference("&#xFFFE;", "\ufffe")),
    clean("reference-last-code-point-decimal", _NUMERIC, reference("&#1114111;", "\U0010ffff")),
    clean("reference-surrogate", _NUMERIC, with_bytes(reference("&#xD800;", "@"), b"\xed\xa0\x80")),
    clean("reference-beyond-last-code-point", _BEYOND, with_bytes(reference("&#1114112;", "@"), b"\xf4\x90\x80\x80")),
    clean("reference-beyond-last-code-point-agrees", _BEYOND, reference("&#1114112;", "&#x110000;")),
    clean("reference-beyond-four-bytes", _BEYOND, reference("b&#2097152;c", "bc")),
    rejected("reference-beyond-in-vector", _NUMBER, one_joint('<origin xyz="&#1114112; 0 0"/>')),
    clean("reference-upper-x", _MALFORMED, reference("&#X62;", "&amp;#X62;")),
    clean("reference-hex-digits-without-x", _MALFORMED, reference("&#6A;", "&amp;#6A;")),
    clean("reference-letter-beyond-hex", _MALFORMED, reference("&#x6G;", "&amp;#x6G;")),
    clean("reference-without-semicolon", _MALFORMED, reference("&#98", "&amp;#98")),
    clean("reference-only-started", "a final &# loses its &", reference("b&#", "b#")),
    clean("reference-swallowed", _BACKWARDS, reference("&#98 &#99;", "c")),
    clean("reference-swallowed-hex", _BACKWARDS, reference("&#x41 text &#x42;", "B")),
    clean("reference-swallowed-by-empty-one", _BACKWARDS, reference("b&#98 &#;c", "b")),
    clean("reference-decimal-before-hex-is-kept", _BACKWARDS, reference("&#65 &#x42;", "&amp;#65 B")),
    clean("reference-swallowed-in-vector", _BACKWARDS, one_joint('<origin xyz="0 0 &# x &#49;"/>')),
    clean("reference-zero", _NUL, reference("b&#0;c", "b")),
    clean("reference-zero-hex", _NUL, reference("b&#x0;c", "b")),
    clean("reference-empty", _NUL, reference("b&#;c", "b")),
    clean("reference-empty-hex", _NUL, reference("b&#x;c", "b")),
    rejected("reference-zero-makes-names-equal", _NUL, robot(links("a", "a&#0;b"))),
    rejected("reference-zero-makes-name-empty", _NUL, reference("&#0;b", "&#0;b")),
    clean("reference-in-vector", _NUMBER, one_joint('<origin xyz="&#x31; &#50; &#51;"/>')),
    clean("reference-space-parts-vector", _NUMBER, one_joint('<origin xyz="0&#32;0&#x20;0"/>')),
    clean("reference-zero-ends-vector", _NUL, one_joint('<origin xyz="0 0 0&#0; x"/>')),
    rejected("reference-zero-ends-vector-early", _NUL, one_joint('<origin xyz="0 0 &#0;0"/>')),
    rejected("reference-tab-after-number", _NUMBER, one_joint('<origin xyz="0&#9;0 0"/>')),
    rejected("reference-tab-after-vector", _NUMBER, one_joint('<origin xyz="0 0 0&#x9;"/>')),
    rejected("entity-minus-in-vector", _LITERAL, one_joint('<origin xyz="&minus;1 0 0"/>')),
    rejected("reference-without-semicolon-in-vector", _MALFORMED, one_joint('<origin xyz="&#49 0 0"/>')),
    degraded("reference-upper-x-in-visual", _MALFORMED, one_link(visual('<origin xyz="&#X31; 0 0"/>'))),
    clean("reference-newline-agrees-with-raw", _RAW, reference("b&#10;c", "b\nc")),
    rejected("reference-carriage-return-differs-from-raw", _RAW, reference("b&#13;c", "b\rc")),
    rejected("reference-crlf-differs-from-raw", _RAW, reference("b&#13;&#10;c", "b\r\nc")),
    clean("reference-tab-agrees-with-raw", _RAW, reference("b&#9;c", "b\tc")),
)

CASES = ENTITIES + REFERENCES
