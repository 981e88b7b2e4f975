"""Text around the root, and encodings: TinyXML2's rules, not XML's."""

from codecs import BOM_UTF8, BOM_UTF16_BE, BOM_UTF16_LE, BOM_UTF32_LE

from tests.robot.edge_cases.case import (
    clean,
    degraded,
    links,
    one_joint,
    one_link,
    reference,
    rejected,
    robot,
    visual,
    with_bytes,
)

ROBOT = one_link()
DECLARATION = '<?xml version="1.0"?>'
_NAMELESS = f"<robot>{links('a')}</robot>"
DECLARED = f"{DECLARATION}\n{ROBOT}\n"

_ANY_DECLARATION = "a declaration is skipped unread"
_POSITION = "a declaration or processing instruction may follow only its like"
_LABEL = "the declared encoding is ignored"
_BYTES = "bytes need not be UTF-8"
_BOM = "a UTF-8 byte-order mark may come after white space"
_CONTROL = "control characters are text"
_NUL = "NUL ends the input"
_BEFORE = "text before the root is ignored"
_AFTER = "text after the root must be blank"
_ROOTS = "the first top-level robot counts"
_NESTED = "links must be direct children of robot"
_STRAY = "a stray closing tag ends the document"
_LITERAL = "entities of a DTD stay as they are"
_SPELLING = "names are compared byte by byte"
_DOCTYPE = "a DOCTYPE ends at its first >; the rest is markup or text"

DECLARATIONS = (
    clean("declaration-absent", _ANY_DECLARATION, ROBOT),
    clean("declaration-without-version", _ANY_DECLARATION, f'<?xml encoding="utf-8"?>{ROBOT}'),
    clean("declaration-standalone-banana", _ANY_DECLARATION, f'<?xml version="1.0" standalone="banana"?>{ROBOT}'),
    rejected("declaration-without-question-mark", _ANY_DECLARATION, f'<?xml version="1.0">{ROBOT}'),
    rejected("declaration-swallows-root", "no robot", f'<?xml version="1.0">{ROBOT}?>'),
    rejected("declaration-space-in-start", "a tag name must start with a letter", f'< ?xml version="1.0"?>{ROBOT}'),
    clean("declaration-after-space", "white space may precede the declaration", f" {DECLARED}"),
    clean("declaration-after-form-feed", "white space may precede the declaration", f"\v\f{DECLARED}"),
    rejected("declaration-after-text", _POSITION, f"urdf\n{DECLARED}"),
    rejected("declaration-after-no-break-space", _POSITION, f"\u00a0{DECLARED}"),
    rejected("declaration-after-comment", _POSITION, f"<!-- robot -->\n{DECLARED}"),
    rejected("declaration-after-doctype", _POSITION, f"<!DOCTYPE robot>\n{DECLARED}"),
    rejected("declaration-after-cdata", _POSITION, f"<![CDATA[]]>\n{DECLARED}"),
    rejected("declaration-after-element", _POSITION, f"<a/>{DECLARED}"),
    clean("declaration-twice", _POSITION, f"{DECLARATION}\n{DECLARED}"),
    clean("declaration-three-times", _POSITION, f"{DECLARATION}\n{DECLARATION}{DECLARED}"),
    rejected("declaration-comment-declaration", _POSITION, f"{DECLARATION}<!-- x -->{DECLARED}"),
    rejected("declaration-inside-robot", _POSITION, robot(f"{links('a')}{DECLARATION}")),
    rejected("declaration-inside-link", _POSITION, one_link(DECLARATION)),
    rejected("document-pasted-inside", _POSITION, robot(f"{links('a')}\n{DECLARED}")),
    rejected("document-pasted-after", _POSITION, f"{DECLARED}{DECLARED}"),
    clean("instruction-before-declaration", _POSITION, f"<?python eval?>{DECLARED}"),
    clean("instruction-then-comment", _POSITION, f"{DECLARATION}<?a?><!-- b -->{ROBOT}"),
    rejected("instruction-inside-visual", _POSITION, one_link("<visual><?a?></visual>")),
    clean("instruction-in-comment", _POSITION, one_link("<!-- <?a?> -->")),
    clean("instruction-in-cdata", _POSITION, one_link("<![CDATA[<?a?>]]>")),
    clean("instruction-in-attribute", _POSITION, robot(links("a"), 'name="<?a?>"')),
)


def _labelled(encoding: str) -> str:
    return f'<?xml version="1.0" encoding="{encoding}"?>\n{robot(links("é"))}'


ENCODINGS = (
    clean("encoding-utf-8", _LABEL, _labelled("UTF-8")),
    clean("encoding-ascii-label-on-utf-8", _LABEL, _labelled("us-ascii")),
    clean("encoding-latin-1", _LABEL, _labelled("ISO-8859-1").encode("latin-1")),
    clean("encoding-utf-8-label-on-latin-1", _BYTES, _labelled("UTF-8").encode("latin-1")),
    clean("encoding-utf-16-label-on-ascii", _LABEL, f'<?xml version="1.0" encoding="UTF-16"?>{ROBOT}'),
    rejected("utf-16le-with-mark", "UTF-16 is not read", BOM_UTF16_LE + DECLARED.encode("utf-16-le")),
    rejected("utf-16be-with-mark", "UTF-16 is not read", BOM_UTF16_BE + DECLARED.encode("utf-16-be")),
    rejected("utf-32le-with-mark", "UTF-32 is not read", BOM_UTF32_LE + ROBOT.encode("utf-32-le")),
    rejected("utf-7", "no robot", ROBOT.replace("<", "+ADw-").replace(">", "+AD4-")),
    clean("mark", _BOM, BOM_UTF8 + ROBOT.encode()),
    clean("mark-space-declaration", _BOM, BOM_UTF8 + b" \n" + DECLARED.encode()),
    clean("mark-twice", "a second mark is text before the root", BOM_UTF8 * 2 + ROBOT.encode()),
    rejected("mark-twice-declaration", "a second mark is text before the root", BOM_UTF8 * 2 + DECLARED.encode()),
    rejected("mark-after-declaration-twice", _POSITION, DECLARATION.encode() + BOM_UTF8 + DECLARED.encode()),
    clean("mark-after-declaration", _BEFORE, DECLARATION.encode() + BOM_UTF8 + ROBOT.encode()),
    rejected("mark-after-root", _AFTER, DECLARED.encode() + BOM_UTF8),
    rejected("mark-only", "the document must not be empty", BOM_UTF8),
    rejected("mark-in-tag-name", "bytes from 128 are part of a name", ROBOT.replace("robot ", "robot\ufeff ", 1)),
    clean("invalid-utf-8-in-link-name", _BYTES, with_bytes(robot(links("@")), b"\xff")),
    clean("invalid-utf-8-in-comment", _BYTES, with_bytes(one_link("<!-- @ -->"), b"\xe9")),
    clean("invalid-utf-8-in-text", _BYTES, with_bytes(one_link("@"), b"\x80\x81")),
    clean("invalid-utf-8-in-cdata", _BYTES, with_bytes(one_link("<![CDATA[@]]>"), b"\xfe")),
    clean("invalid-utf-8-in-declaration", _BYTES, b"<?xml \xff?>" + ROBOT.encode()),
    clean("invalid-utf-8-in-tag-name", _BYTES, with_bytes(one_link("<@/>"), b"\xff")),
    clean("invalid-utf-8-in-attribute-name", _BYTES, with_bytes(one_link('<a @="1"/>'), b"\xff")),
    rejected("invalid-utf-8-in-vector", "a number is ASCII", with_bytes(one_joint('<origin xyz="@ 0 0"/>'), b"\xff")),
    rejected("latin-1-and-utf-8-names-differ", _SPELLING, with_bytes(reference("é", "@"), b"\xe9")),
    clean("two-invalid-names-agree", _SPELLING, with_bytes(reference("@", "@"), b"\xff")),
    rejected("composed-and-decomposed-names-differ", _SPELLING, reference("\u00e9", "e\u0301")),
    clean("noncharacter-fffe-in-name", _CONTROL, robot(links("\ufffe"))),
    clean("noncharacter-ffff-in-text", _CONTROL, one_link("\uffff")),
    clean("astral-name", _BYTES, robot(links("\U0001f916"))),
    clean("control-in-comment", _CONTROL, one_link("<!-- \x02 -->")),
    clean("control-between-links", _CONTROL, robot(f"\x1f{links('a')}")),
    clean("control-before-root", _BEFORE, f"\x04{ROBOT}"),
    clean("control-delete-in-name", _CONTROL, robot(links("\x7f"))),
    rejected("control-between-attributes", "no control character in a tag", robot(links("a"), 'name="r" \x01')),
    clean("nul-after-root", _NUL, f"{ROBOT}\0"),
    rejected("nul-before-root", _NUL, f"\0{ROBOT}"),
    rejected("nul-after-declaration", _NUL, f"{DECLARATION}\0{ROBOT}"),
    rejected("nul-in-link-name", _NUL, robot(links("a\0b"))),
    rejected("nul-between-links", _NUL, robot(f"{links('a')}\0")),
    rejected("nul-in-comment", _NUL, one_link("<!-- \0 -->")),
    rejected("nul-in-comment-after-root", _NUL, f"{ROBOT}<!-- \0 -->"),
    rejected("nul-in-text-after-root", _AFTER, f"{ROBOT} x\0"),
)

ROOTS = (
    clean("text-before-root", _BEFORE, f"my robot\n{ROBOT}"),
    clean("entity-before-root", _BEFORE, f"&nope; ]]> {ROBOT}"),
    clean("closing-angle-before-root", _BEFORE, f">{ROBOT}"),
    rejected("opening-angle-before-root", "a tag name must start with a letter", f"<{ROBOT}"),
    rejected("text-after-root", _AFTER, f"{ROBOT}\nend"),
    rejected("control-z-after-root", _AFTER, f"{ROBOT}\r\n\x1a"),
    rejected("code-fence-around-root", _AFTER, f"```xml\n{ROBOT}\n```\n"),
    clean("text-between-roots", "text before another root is ignored", f"{ROBOT} text <a/>"),
    rejected("text-between-root-and-comment-end", _AFTER, f"{ROBOT} <!-- a --> text"),
    clean("text-between-root-and-comment", "text before more markup is ignored", f"{ROBOT} text <!-- a -->"),
    clean("blank-after-root", _AFTER, f"{ROBOT} \t\r\n\v\f\n"),
    clean("comment-after-root", _AFTER, f"{ROBOT}<!-- end -->"),
    clean("cdata-before-root", _BEFORE, f"<![CDATA[ <robot> ]]>{ROBOT}"),
    clean("cdata-after-root", "CDATA is no plain text", f"{ROBOT}<![CDATA[ end ]]>"),
    clean("comment-before-root", "comments are skipped", f"<!-- <robot> -->{ROBOT}"),
    clean("element-after-root", _ROOTS, f"{ROBOT}<a/>"),
    rejected("unclosed-element-after-root", "every tag must be closed", f"{ROBOT}<a>"),
    clean("robot-second", _ROOTS, f"<world/>{ROBOT}"),
    clean("robot-third", _ROOTS, f"<world/><sdf><model/></sdf>{ROBOT}"),
    clean("robot-twice-second-has-two-roots", _ROOTS, f"{ROBOT}{robot(links('a', 'b'))}"),
    clean("robot-twice-same-link-names", _ROOTS, ROBOT * 2),
    rejected("robot-twice-first-empty", _ROOTS, f'<robot name="x"/>{ROBOT}'),
    rejected("robot-twice-first-nameless", _ROOTS, f"{_NAMELESS}{ROBOT}"),
    rejected("robot-nested", "robot must be at the top", f"<sdf>{ROBOT}</sdf>"),
    rejected("robot-nested-in-robot", "no links", robot(ROBOT)),
    rejected("root-is-model", "no robot", f'<model name="r">{links("a")}</model>'),
    rejected("root-is-robot-in-capitals", "names are case-sensitive", f'<Robot name="r">{links("a")}</Robot>'),
    rejected("root-has-prefix", "a prefix is part of the name", f'<urdf:robot name="r">{links("a")}</urdf:robot>'),
    rejected("robot-without-name", "robot needs a name", _NAMELESS),
    rejected("robot-name-in-capitals", "names are case-sensitive", robot(links("a"), 'Name="r"')),
    clean("robot-empty-name", "an empty robot name is fine", robot(links("a"), 'name=""')),
    clean("robot-blank-name", "any robot name is fine", robot(links("a"), 'name=" "')),
    rejected("robot-without-links", "a robot needs a link", robot("")),
    rejected("robot-with-only-a-joint", "a robot needs a link", robot('<joint name="j" type="fixed"/>')),
    rejected("robot-with-only-a-material", "a robot needs a link", robot('<material name="m"/>')),
    rejected("links-in-group", _NESTED, robot(f"<group>{links('a')}</group>")),
    clean("more-links-in-group", _NESTED, robot(f"{links('a')}<group>{links('a')}</group>")),
    rejected("stray-tag-before-root", _STRAY, f"</a>{ROBOT}"),
    rejected("stray-tag-after-declaration", _STRAY, f"{DECLARATION}</robot>{ROBOT}"),
    clean("stray-tag-after-root", _STRAY, f"{ROBOT}</robot>"),
    clean("stray-tag-then-text", _STRAY, f"{ROBOT}</robot> text"),
    clean("stray-tag-then-garbage", _STRAY, f"{ROBOT}</robot><<<\0<!--"),
    clean("stray-tag-then-declaration", _STRAY, f"{ROBOT}</robot>{DECLARED}"),
    clean("stray-tag-with-attribute-then-garbage", _STRAY, f'{ROBOT}</robot name="r">< garbage'),
    clean("stray-tag-with-leading-space", _STRAY, f"{ROBOT}< /robot>text"),
    clean("text-then-stray-tag", "text before more markup is ignored", f"{ROBOT} text </robot> text"),
    rejected("stray-tag-without-name", "a closing tag needs a name", f"{ROBOT}</>"),
    rejected("stray-tag-cut-short", "a tag must end", f"{ROBOT}</robot"),
    rejected("stray-tag-with-bad-attribute", "attributes are quoted", f"{ROBOT}</robot name=r>"),
    clean("stray-tag-self-closed", "a self-closed closing tag is an element", f"{ROBOT}</robot/>"),
    rejected("stray-tag-self-closed-then-text", "a self-closed closing tag is an element", f"{ROBOT}</robot/>text"),
    rejected("text-file", _AFTER, "robot"),
    rejected("comment-file", "no robot", "<!-- robot -->"),
    rejected("declaration-file", "no robot", DECLARATION),
    rejected("doctype-file", "no robot", "<!DOCTYPE robot>"),
    rejected("stray-tag-file", "no robot", "</robot>"),
    rejected("angle-file", "a tag name must start with a letter", "<"),
)


def _subset(body: str, root: str = ROBOT) -> str:
    return f"<!DOCTYPE robot [{body}]>\n{root}"


_ORIGIN = '<origin xyz="&e; 0 0"/>'

DOCTYPES = (
    clean("doctype-plain", _DOCTYPE, f"{DECLARATION}<!DOCTYPE robot>{ROBOT}"),
    clean("doctype-lower-case", _DOCTYPE, f"<!doctype robot>{ROBOT}"),
    clean("doctype-twice", _DOCTYPE, f"<!DOCTYPE robot><!DOCTYPE robot>{ROBOT}"),
    clean("doctype-after-comment", _DOCTYPE, f"<!-- a --><!DOCTYPE robot>{ROBOT}"),
    rejected("doctype-unterminated", _DOCTYPE, f"{ROBOT}<!DOCTYPE robot"),
    rejected("doctype-without-end-before-root", "a DOCTYPE swallows up to >", f"<!DOCTYPE robot {ROBOT}"),
    clean("subset-unused-entity", _DOCTYPE, _subset('<!ENTITY e "1">')),
    clean("subset-two-entities", _DOCTYPE, _subset('<!ENTITY e "1"><!ENTITY f "2">')),
    rejected("subset-default-name", "robot needs a name", _subset('<!ATTLIST robot name CDATA "r">', _NAMELESS)),
    clean("subset-external-entity", _DOCTYPE, _subset('<!ENTITY e SYSTEM "file:///etc/passwd">', one_link("&e;"))),
    clean("subset-comment", _DOCTYPE, _subset("<!-- a > b -->")),
    clean("subset-instruction", "the first > may be that of an instruction", _subset("<?a?>")),
    rejected("subset-instruction-after-entity", _POSITION, _subset('<!ENTITY e "1"><?a?>')),
    clean("subset-entity-in-text", _LITERAL, _subset('<!ENTITY e "1">', one_link("&e;"))),
    clean("subset-entity-in-name", _LITERAL, _subset('<!ENTITY e "1">', robot(links("&e;")))),
    rejected("subset-entity-and-its-value-differ", _LITERAL, _subset('<!ENTITY e "b">', reference("b", "&e;"))),
    rejected("subset-entity-in-joint-origin", _LITERAL, _subset('<!ENTITY e "1">', one_joint(_ORIGIN))),
    degraded("subset-entity-in-visual-origin", _LITERAL, _subset('<!ENTITY e "1">', one_link(visual(_ORIGIN)))),
    clean("subset-nested-entities", _LITERAL, _subset('<!ENTITY a "x"><!ENTITY b "&a;&a;">', robot(links("&b;")))),
    rejected("subset-entity-holds-element", _STRAY, _subset('<!ENTITY e "<a>1</a>">')),
    clean("subset-entity-holds-two-tags", _DOCTYPE, _subset('<!ENTITY e "<a/><b/>">')),
    rejected("subset-entity-holds-robot", _ROOTS, _subset("<!ENTITY e \"<a/><robot name='x'/>\">")),
    clean("subset-entity-holds-whole-robot", _ROOTS, _subset(f"<!ENTITY e '<a/>{ROBOT}'>", "<robot/>")),
    rejected("subset-not-closed", "a tag must end", f'<!DOCTYPE robot [<!ENTITY e "1"\n{ROBOT}'),
)

CASES = DECLARATIONS + ENCODINGS + ROOTS + DOCTYPES
