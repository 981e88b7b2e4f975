"""Random documents whose properties, macros, blocks, arguments and files share a few names.

The other grammar writes what students write. This one writes what they do not: names that hide each other, scopes, blocks in blocks,
definitions in included files, defaults of outer scopes, texts that look like numbers, and odd white space.
"""

from random import Random
from xml.sax.saxutils import escape, quoteattr

from tests.xacro.documents.document import Document, part, robot

_NAMES = ("a", "b", "c")
_MACROS = ("m", "k", "a", "n.m", "o.m", "n.o.m", "m.m")
_FILES = ("one.xacro", "two.xacro", "sub/three.xacro")
_BY_NAME = "${a}.xacro"
_PARAMS = (
    "",
    "a",
    "b",
    "a b",
    "a:=1",
    "a=2",
    "a:=^",
    "a:=^|3",
    "b:=^|${a}",
    "a:=${b}",
    "b:=${c + 1}",
    "a:='x y'",
    "a:=^|'x y'",
    "*b",
    "**b",
    "*a",
    "a *b",
    "a **b",
    "*a *b",
    "**a *b",
    "a:=1 b:=${a}",
    "b:=${a} a:=1",
    "a:=^ b:=^|7",
    "a:= ",
    "a:=",
    "  a   b:=2 ",
    "a,b",
    "a a",
    "^a",
    "a:=$(arg a)",
    "a:=true",
    "c:=^|",
    'a:="x"',
    "a:=^|^",
    "n.a",
    "a:=[1,2]",
    "a:=${[1, 2]}",
    "a\nb:=1",
    "*b a:=1",
)
_VALUES = (
    "1",
    "2.50",
    "0.1",
    "1e3",
    "1e-7",
    "007",
    "-0.0",
    " 5 ",
    "+3",
    "1_0",
    "0x10",
    "True",
    "false",
    "None",
    "nan",
    "inf",
    "1e400",
    "'5'",
    '"5"',
    "x y",
    "",
    " ",
    "$",
    "$$",
    "${",
    "$(",
    "}",
    "Über ☃",
    "100000000000000000000",
    "[1, 2]",
    "(1, 2)",
    "{'a': 1}",
    "1,2",
    "1 2",
    "x'y",
    "\\n",
    "%",
    "a",
    "b",
    "é",
)
_EXPRESSIONS = (
    "a",
    "b",
    "c",
    "a + b",
    "a + 1",
    "a * 2",
    "b / 2",
    "b // 2",
    "a % 3",
    "-a",
    "str(a)",
    "a == b",
    "a and b",
    "a or b",
    "not a",
    "a if b else c",
    "n.a",
    "n.o.a",
    "o.b",
    "n",
    "m.a",
    "a.b",
    "[a, b]",
    "(a,)",
    "dict(x=a)",
    "dict(x=a)['x']",
    "len(str(a))",
    "a < b",
    "2 ** 70",
    "1e16",
    "1e22",
    "1 / 3",
    "7 // 2",
    "-7 // 2",
    "-7 % 3",
    "7.5 // 2",
    "True + 1",
    "None",
    "1.0",
    "100.0",
    "1e-5",
    "1e5",
    "123456789.123456789",
    "0.1 + 0.2",
    "'%s' % a",
    "'%g' % 0.1",
    "'%5.2f|%d' % (1, 2.7)",
    "pi",
    "math.pi",
    "radians(180)",
    "sin(a)",
    "sqrt(2)",
    "round(2.5)",
    "round(2.675, 2)",
    "int(2.9)",
    "float('1e3')",
    "bool('')",
    "max(1, 2.0)",
    "min([3, 1])",
    "'a' + 'b'",
    "'a' * 3",
    "'${a}'",
    '"it\'s"',
    "'x' in 'xy'",
    "sorted([3, 1, 2])",
    "list(range(3))",
    "[v * 2 for v in range(3)]",
    "str([1, 'a'])",
    "repr(1)",
    "xacro.arg('a')",
    "xacro.dotify(dict(q=1)).q",
    "'a b'.split()",
    "'1 2'.split()[1]",
    "float(a)",
    "int(a)",
    "a[0]",
    "a[-1]",
    "a.upper()",
    "'ß'.upper()",
    "floor(2.7)",
    "1 if a else",
    "a b",
    "undefined",
    "",
    " ",
    "a +",
    "1 < 2 < 3",
    "0 or ''",
    "(1, 2)[0]",
    "{'x': 1}['x']",
    "[1, 2][::-1]",
    "1 == 1.0",
    "'1' == 1",
    "1_000",
    "0b11",
)
_CONDITIONS = (
    "1",
    "0",
    "true",
    "false",
    "True",
    "False",
    " true ",
    "1.0",
    "0.0",
    "2",
    "",
    "maybe",
    "TRUE",
    "${a}",
    "${b == 1}",
    "${True}",
    "${''}",
    "${[]}",
    "${0.0}",
    "${None}",
    "${'true'}",
    "${'0'}",
    "${1}${0}",
    "$(arg a)",
    "${not a}",
    "${a is None}",
    "-1",
    "${'False'}",
)


def document(seed: int) -> Document:
    """Return the document of a seed: the same in every run."""
    random = Random(seed)
    writer = _Writer(random)
    writer.has_optional = random.random() < 0.5
    files: dict[str, str | bytes] = {
        f"urdf/{name}": part(writer.body(2)) for name in _FILES if random.random() < 0.6
    }
    writer.is_main = True
    arguments = {name: random.choice(_VALUES) for name in _NAMES if random.random() < 0.8}
    body = "".join(writer.definition() for _ in range(random.randint(0, 3))) + writer.body(3)
    # These need manual grading: who starts xacro may give the argument, a name of a file may be a pattern.
    text = body + "".join(map(str, files.values()))
    is_open = len(arguments) < len(_NAMES) or _BY_NAME in text
    return Document(robot(body), files, arguments, "perhaps" if is_open else "never")


class _Writer:
    """Writes pieces of a document."""

    def __init__(self, random: Random) -> None:
        self._random, self._pick = random, random.choice
        self.has_optional = self.is_main = False

    def body(self, depth: int) -> str:
        """Return one to four pieces."""
        return "".join(self._piece(depth) for _ in range(self._random.randint(1, 4)))

    def definition(self) -> str:
        """Return a property with a name that many expressions use."""
        return f"<xacro:property name='{self._pick(_NAMES)}' value={quoteattr(self._pick(('1', '2.50', 'x y', 'true', '${1 + 1}', '${[1, 2]}')))}/>"

    def _text(self) -> str:
        """Return the text of an attribute: a value, an expression, or several of them."""
        forms = (
            lambda: self._pick(_VALUES),
            lambda: f"${{{self._pick(_EXPRESSIONS)}}}",
            lambda: f"${{{self._pick(_EXPRESSIONS[:12])}}}",
            lambda: f"{self._pick(_VALUES)} ${{{self._pick(_EXPRESSIONS)}}}",
            lambda: f"${{ {self._pick(_EXPRESSIONS[:30])} }}${{{self._pick(_EXPRESSIONS[:4])}}}",
            lambda: f"$(arg {self._pick(_NAMES)})",
            lambda: f"$${{{self._pick(_NAMES)}}}",
            lambda: f"$$(arg {self._pick(_NAMES)})$${self._pick(_NAMES)}",
            lambda: f"${{'$(arg {self._pick(_NAMES)})'}}",
        )
        return self._pick(forms)()

    def _piece(self, depth: int) -> str:
        simple = (
            self._property,
            self._property,
            self._shown,
            self._shown,
            self._call,
            self._call,
            self._insert,
            self._argument,
            self._block,
            self._element,
            self._comment,
            self.definition,
        )
        nested = (self._macro, self._macro, self._condition, self._include, self._plain)
        if depth and self._random.random() < 0.3:
            return self._pick(nested)(depth - 1)
        return self._pick(simple)()

    def _shown(self) -> str:
        return f"<s x={quoteattr(self._text())}>{escape(self._text()) if self._random.random() < 0.2 else ''}</s>"

    def _property(self) -> str:
        more = self._pick(
            (
                "",
                "",
                "",
                'scope="parent"',
                'scope="global"',
                'lazy_eval="false"',
                'lazy_eval="true"',
                'scope="local"',
                'remove="true"',
            )
        )
        value = self._pick(("value", "value", "value", "default")) + f"={quoteattr(self._text())}"
        if "remove" in more and self._random.random() < 0.8:
            value = ""
        return (
            f"<xacro:property name='{self._pick((*_NAMES, *_NAMES, 'n.a', 'm'))}' {value} {more}/>"
        )

    def _macro(self, depth: int) -> str:
        name = self._pick((*_MACROS[:3], *_MACROS))
        return f"<xacro:macro name='{name}' params={quoteattr(self._pick(_PARAMS))}>{self.body(depth)}</xacro:macro>"

    def _call(self) -> str:
        given = self._random.sample(_NAMES, self._random.choice((0, 1, 1, 2)))
        attributes = " ".join(f"{name}={quoteattr(self._text())}" for name in given)
        blocks = "".join(
            self._pick(
                (
                    "<x/>",
                    "<x><y v='${a}'/></x>",
                    "<xacro:insert_block name='b'/>",
                    "<!-- c --><x/>",
                    "<x>t</x>",
                    "<xacro:k/>",
                )
            )
            for _ in range(self._random.choice((0, 0, 1, 1, 2)))
        )
        name = self._pick((*_MACROS[:3], *_MACROS))
        if self._random.random() < 0.15:
            return f"<xacro:call macro={quoteattr(self._pick((name, '${a}', '')))} {attributes}>{blocks}</xacro:call>"
        return f"<xacro:{name} {attributes}>{blocks}</xacro:{name}>"

    def _insert(self) -> str:
        return (
            f"<xacro:insert_block name={quoteattr(self._pick((*_NAMES, *_NAMES, 'n.b', '${a}')))}/>"
        )

    def _block(self) -> str:
        content = self._pick(("<x/>", "<x/><y v='${b}'/>", "text", "<xacro:m/>", ""))
        return f"<xacro:property name='{self._pick(_NAMES)}'>{content}</xacro:property>"

    def _argument(self) -> str:
        default = f" default={quoteattr(self._text())}" if self._random.random() < 0.9 else ""
        return f"<xacro:arg name='{self._pick(_NAMES)}'{default}/>"

    def _condition(self, depth: int) -> str:
        tag = self._pick(("if", "unless"))
        return f"<xacro:{tag} value={quoteattr(self._pick(_CONDITIONS))}>{self.body(depth)}</xacro:{tag}>"

    def _include(self, _: int) -> str:
        if self.has_optional and not self.is_main:
            return (
                self._shown()
            )  # docs/xacro.md: what is missing inside of an optional file is a known difference
        more = ' optional="true"' if self.has_optional and self._random.random() < 0.5 else ""
        name = self._pick((*_FILES, "./one.xacro", "$(find my_robot)/urdf/two.xacro", _BY_NAME))
        return f"<xacro:include filename={quoteattr(name)}{more}/>"

    def _element(self) -> str:
        name = quoteattr(self._pick(("e", "${a}", "")))
        return self._pick(
            (
                f"<xacro:element xacro:name={name} k={quoteattr(self._text())}><z/></xacro:element>",
                f"<xacro:element name={name}/>",
            )
        )

    def _comment(self) -> str:
        return self._pick(
            (
                "<!-- ${a} -->",
                "<!-- $(arg a) --> ",
                "<?pi ${a}?>",
                "\n\n",
                "text ${a}",
                "&amp;&lt;",
                "<![CDATA[x]]>",
            )
        )

    def _plain(self, depth: int) -> str:
        return f"<g y={quoteattr(self._text())}>{self.body(depth)}</g>"
