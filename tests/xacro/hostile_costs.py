"""Documents that would cost much time or memory where work is not charged to the budget of a submission before it is done."""

from tests.xacro.documents.document import Document, Documents, merged, named, part, robot, shown

_MIB = 1024 * 1024
_LINK = '<link name="base_link"/>'
_LONG = named("t", "${'a'*20000}") + named("u", "${t+t+t+t+t}")
_CALLED = 20_000


def _macro(body: str, calls: int = 3_000, params: str = "", given: str = "") -> str:
    """Return a macro, and calls of it."""
    return (
        f'<xacro:macro name="m" params="{params}">{body}</xacro:macro>'
        + f"<xacro:m {given}/>" * calls
    )


def _deep(body: str, depth: int = 96, before: str = "") -> str:
    """Return macros that call each other, the innermost with this body."""
    inner = (f"<xacro:m{n + 1}/>" for n in range(depth - 1))
    levels = "".join(
        f"<xacro:macro name='m{n}' params=''>{before}{text}</xacro:macro>"
        for n, text in enumerate((*inner, body))
    )
    return f"{levels}<xacro:m0/>"


def _many(count: int, text: str) -> str:
    """Return a text many times, {n} being its number."""
    return "".join(text.replace("{n}", str(n)) for n in range(count))


def _filled(text: str) -> str:
    """Return a text as often as it fits into a file."""
    return text * (_MIB // len(text) - 1)


def _yaml(text: str, *uses: str) -> tuple[str, dict[str, str]]:
    return named("y", "${xacro.load_yaml('a.yaml')}") + shown(*(uses or ("${y}",))), {
        "urdf/a.yaml": text
    }


_PRIME = 2**61 - 1
_START = '<robot name="r"><link name="l"/><xacro:if value="1"/>'
_ROWS: dict[str, str | tuple[str, dict[str, str]]] = {
    # values and their operators
    "enum": _LONG
    + named("e", "${python.enumerate}")
    + named("b", "${" + "+".join(["list(e(u))"] * 100) + "}")
    + shown("${b}"),
    "sets": named("s", "${python.set([" + ",".join(f"{n}*{_PRIME}" for n in range(150)) + "])}")
    + shown(*["${s == s}"] * 60),
    "expandtabs": named("u", r"${'\t'*90}") + shown(*["${u.expandtabs(1000)}"] * 2000),
    "percent": named("d", "${dict(a='x'*900)}")
    + named("f", "${'%(a)99s'*2200}")
    + shown(*["${f % d}"] * 1000),
    "split": named("t", "${'a '*10000}") + shown(*["${t.split()[0]}"] * 3000),
    "in": named("t", "${list(range(9000))}") + shown(*["${0.5 in t}"] * 3000),
    "find": named("t", "${'a'*19000}")
    + named("n", "${'a'*9000+'b'}")
    + shown(*["${n in t}"] * 3000),
    "comprehension": shown(*["${[i*j for i in range(140) for j in range(140)]}"] * 1000),
    "loops": shown(*["${[1 " + "for i in [1] " * 300 + "for i in range(9000)]}"] * 200),
    "sorted": named("t", "${[str(i)*3 for i in range(6000)]}") + shown(*["${sorted(t)[0]}"] * 3000),
    "big-numbers": named("n", "9" * 1200) + shown(*["${str(n)+str(n)+str(n*n)+str(n)}"] * 8000),
    "tuple-key": named("d", "${dict(a=1)}")
    + named("t", "${(1,)*9000}")
    + shown(*["${d[t]}"] * 20_000),
    "text-key": named("d", "${dict(a=1)}") + _LONG + shown(*["${d[u]}"] * 20_000),
    "colliding-keys": named("s", "${[[i*65536,i] for i in range(2400)]}")
    + shown(*["${dict(s)}"] * 3000),
    "separators": _many(3000, "<a b=\"${xacro.tokenize('a', '" + "bcdefghij" * 30 + "{n}')}\"/>"),
    "numbers-of-text": named("u", "${('123456789' * 10000)+'1'}") + shown(*["${float(u)}"] * 3000),
    "numbers-in-bases": named("u", "${'z' * 4300}") + shown(*["${int(u, 36)}"] * 9000),
    "products": shown(*["${math.prod([200]*190, start=9**1000)}"] * 9000),
    "kept-expressions": shown(
        *("${" + "+".join([str(n % 10)] * 90 + [str(n)]) + "}" for n in range(2000))
    ),
    "syntax-errors": shown(*("${" + "f(" * 90 + str(n) + "}" for n in range(4000))),
    "syntax-errors-of-brackets": shown(*("${" + "[(" * 80 + str(n) + "}" for n in range(4000))),
    "nested-values": named("p0", "1")
    + _many(900, "<xacro:property name='p{n}' value='${[p{n},1]}'/>").replace("[p", "[q")
    + shown("${q1}"),
    "failing-value": named("p", "${1/0}") + shown(*["${p}"] * 40_000),
    "failing-include": "<xacro:include filename='none.xacro'/>" + shown(*["${p}"] * 40_000),
    "unknown-names": _many(2000, "<xacro:property name='p{n}' value='1'/>")
    + _many(3000, "<a b='${q{n}}'/>"),
    "unknown-name-in-many": _many(9_000, "<xacro:property name='property{n}' value='1'/>")
    + shown(*["${q}"] * 20_000),
    "unknown-name-in-long": _many(180, f"<xacro:property name='p{'x' * 4000}{{n}}' value='1'/>")
    + shown(*["${q}"] * 9_000),
    # texts
    "dollars": shown("$a" * 500_000),
    "open-dollars": shown("$" * 1_000_000),
    "open-expressions": shown("${" * 500_000),
    "open-substitutions": shown("$(" * 500_000),
    "nested-substitutions": shown("$(" * 500_000 + ")"),
    "empty-values": named("v", "")
    + _deep("<a b='" + "${v}" * 24_000 + "'/>" * 1 + ("<a b='" + "${v}" * 24_000 + "'/>") * 8),
    "long-argument": f"<xacro:arg name='a' default='{'1' * 500_000}x'/>"
    + shown(*["$(eval 1 or " + " or ".join("a" * 40) + ")"] * 2000)
    + _macro(shown("$(eval " + "+".join(["len(a)"] * 200) + ")")),
    "find-of-argument": f"<xacro:arg name='a' default='{'$$(find  ' * 90_000}'/>"
    + shown(*["$(arg a)"] * 9000),
    "condition-of-long": named("t", "${'1_'*49999}") + "<xacro:if value='${t}'/>" * 40_000,
    "condition-is-long": _macro(f"<xacro:if value='{'1_' * 250_000}'/>", _CALLED),
    "lazy-number": _macro(f"<xacro:property name='p' value='{'1' * 800_000}x'/>", _CALLED),
    "forwarded-number": named("a", "${'1'*90000+'x'}") + _macro("", _CALLED, "a:=^"),
    "literal": named("t", "x" * 100_000) + _macro("<b/>", _CALLED, "a", "a='${t}'"),
    "long-name-of-property": _macro(f"<xacro:property name='{'x' * 700_000}' value='1'/>", _CALLED),
    "long-name-of-block": _macro(f"<xacro:insert_block name='{'x' * 700_000}'/>", _CALLED),
    "long-messages": named("t", "${'a'*90000}")
    + _many(200, "<a b='${xacro.fatal(t, t, t, {n})}'/>"),
    "long-names-of-arguments": named("t", "${'a'*40000}") + _many(9000, "<a b='$(arg ${t}{n})'/>"),
    # macros, blocks, scopes
    "many-parameters-in-a-macro": "<xacro:macro name='m' params='"
    + " ".join(f"p{n}" for n in range(1500))
    + "'/><xacro:macro name='n' params=''><xacro:m "
    + " ".join(f"p{n}='1'" for n in reversed(range(1500)))
    + "/></xacro:macro>"
    + "<xacro:n/>" * 3000,
    "missing-parameters": _macro("", 3, " ".join(f"p{n}" for n in range(60_000))),
    "missing-parameters-often": _macro("", 9000, " ".join(f"p{n}" for n in range(300))),
    "unknown-parameter": _macro("", 20_000, " ".join(f"p{n}:=1" for n in range(300)), "q='1'"),
    "quotes-in-parameters": _many(
        300, "<xacro:macro name='m{n}' params=\"a:='" + ("x" * 140 + "'") * 24 + 'x"/>'
    ),
    "quotes-far-apart": "<xacro:macro name='m' params=\"a:='" + ("x" * 30_000 + "'") * 22 + 'x"/>',
    "quotes-of-many": _many(3000, "<xacro:macro name='m{n}' params=\"a:='x" + "'x" * 24 + '"/>'),
    "dynamic-calls": "<xacro:macro name='n' params=''/>"
    + _macro("<xacro:call macro='n' " + " ".join(f"a{n}='1'" for n in range(3000)) + "/>", _CALLED),
    "unknown-blocks": _macro(
        _many(9000, "<xacro:property name='p{n}' value='1'/>")
        + "<xacro:insert_block name='z'/>" * 15_000,
        1,
    ),
    "unknown-macros": _many(3000, "<xacro:macro name='some_macro_{n}' params=''/>")
    + _many(9000, "<xacro:other_macro_{n}/>"),
    "deep-macros": named("v", "1") + _deep("<a b='${v+v+v+v+v+v+v+v+v+v+v+v}'/>" * 9_000),
    "deep-problems": _deep("<link/>" * 30_000),
    "deep-conditions": "<xacro:if value='1'>" * 180 + "<a/>" * 40_000 + "</xacro:if>" * 180,
    "removed-in-deep": _deep(
        "<xacro:property name='v' value='1' scope='global'/><xacro:property name='v' remove='true'/>"
        * 9_000
    ),
    "parent-of-deep": _deep("<xacro:property name='v' value='1' scope='parent'/>" * 15_000),
    "blocks": "<xacro:macro name='m' params='**b'>"
    + "<xacro:insert_block name='b'/>" * 3000
    + "</xacro:macro><xacro:m><b>"
    + "<a/>" * 3000
    + "</b></xacro:m>",
    "long-attributes": _LONG + "<g " + _many(3000, "a{n}='${u}' ") + "/>",
    "element-of-list": named("t", "${list(range(9000))}")
    + "<xacro:element xacro:name='${t}'/>" * 15_000,
    "long-elements": _LONG + "<xacro:element xacro:name='${u}'/>" * 15_000,
    "long-tags": _macro(f"<{'a' * 49_000}/>", _CALLED),
    "long-tag-of-macro": _macro(f"<xacro:{'a.' * 24_000}a/>", _CALLED),
    "texts-in-pieces": "<t>" + "xxxxxxxxxxxxxxxxxxxx<xacro:if value='0'/>" * 20_000 + "</t>",
    "texts": "<t>" + "x ${1} " * 120_000 + "</t>",
    "attribute-in-macro": _macro(f"<g a='{'x' * 100_000}'/>"),
    # more
    "forwarded-failing": named("p", "${1/0}") + _macro("", 15_000, "p:=^"),
    "failing-macros": "<xacro:include filename='none.xacro'/>" + "<xacro:z/>" * 50_000,
    "kept-scopes": _macro(
        "<xacro:property name='p' value='${[n]*400}'/><g a='${len(p)}'/>", 9_000, "n", "n='1'"
    ),
    "kept-texts": named("t", "${'a'*9000}")
    + "".join(
        f"<xacro:m n='{n}'/>"
        if n
        else _macro("<xacro:property name='p' value='${t}${n}'/><g a='${len(p)}'/>", 0, "n")
        for n in range(9_000)
    ),
    "kept-wide-texts": named("t", "\U0001f600" * 9000)
    + "".join(
        f"<xacro:m n='{n}'/>"
        if n
        else _macro("<xacro:property name='p' value='${t}${n}'/><g a='${len(p)}'/>", 0, "n")
        for n in range(9_000)
    ),
    "empty-dicts": shown(*["${[dict() for i in range(1500)]}"] * 100)
    + _many(
        900,
        "<xacro:property name='p{n}' value='${[dict(a=[]) for i in range(300)]}'/><a b='${len(p{n})}'/>",
    ),
    "patterns-of-steps": (
        "<xacro:include filename='*/*/*/*/*/*'/>" * 9000,
        {"urdf/" + "a/" * 5 + f"{n}": "" for n in range(300)},
    ),
    "same-file-in-pattern": (
        "<xacro:include filename='*.inc'/>" * 400,
        {f"urdf/{n}.inc": part("<a/>") for n in range(300)},
    ),
    "optional-files": (
        "<xacro:include filename='none.xacro' optional='true'/>" * 15_000,
        {f"urdf/{n}": "" for n in range(300)},
    ),
    "percent-words": named("d", "${dict(a=1)}")
    + named("f", "${'%(' + 'a'*900 + ')s'}")
    + shown(*["${f % d}"] * 20_000),
    "percent-floats": shown(*["${'%99f' % 1e308}"] * 20_000),
    "percent-of-list": named("l", "${list(range(900))}")
    + shown(*["${'%s%s%s%s%s%s' % (l,l,l,l,l,l)}"] * 9_000),
    "map": named("l", "${list(range(4000))}") + shown(*["${list(map(str, l))}"] * 3_000),
    "joined": named("l", "${['a'*60]*1500}") + shown(*["${l[0].join(l)}"] * 3_000),
    "replaced": named("t", "${'a'*9000}") + shown(*["${t.replace('a','aaaaaaaaaa')}"] * 9_000),
    "titles": named("t", "${'\u0390'*9000}") + shown(*["${t.upper().lower().title()}"] * 9_000),
    "stripped": named("t", "${'ab'*9000}") + shown(*["${t.strip(t)}"] * 9_000),
    "searched-backwards": named("t", "${'a'*60000}")
    + named("n", "${'b'+'a'*200}")
    + shown(*["${t.rsplit(n)}"] * 9_000),
    "negations": shown(*["${" + "-" * 900 + "1}"] * 1100),
    "nots": shown(*["${" + "not " * 220 + "1}"] * 1100),
    "indexes": named("l", "${[0]}") + shown(*["${l" + "[0:]" * 90 + "}"] * 2700),
    "powers": shown(*["${" + "+".join(["3**2500"] * 20) + "}"] * 5_000),
    "float-powers": shown(*["${" + "+".join(["1.1**0.5"] * 20) + "}"] * 5_000),
    "gcd-of-large": shown(*["${gcd(3**2500, 7**1400)}"] * 20_000),
    "divided-large": shown(*["${3**2500 // 7**700 % 11**300}"] * 20_000),
    "rounded-large": shown(*["${round(3**2500, -399)}"] * 20_000),
    "isqrt-of-large": shown(*["${isqrt(3**2500)}"] * 20_000),
    "shown-large": named("n", "${3**2500}") + shown(*["${n}"] * 50_000),
    "large-in-list": named("n", "${[3**2500]*900}") + shown(*["${n}"] * 20_000),
    "constants": shown(*["${" + "9" * 1200 + "}"] * 800),
    "text-constants": shown(*["${'" + "\\x41" * 900 + "'}"] * 280),
    "wide-expressions": shown(*["${'\U0001f600'}"] * 40_000),
    "arguments": _many(9_000, "<xacro:arg name='a{n}' default='$(arg a)$(arg a{n})'/>")
    + shown("$(arg a)"),
    "evals": shown(*["$(eval 1+1+1+1)"] * 30_000),
    "packages": shown(*["$(find my_robot)"] * 30_000),
    "long-packages": shown(*["$(find " + "a" * 9_000 + ")"] * 50)
    + named("t", "${'a'*9000}")
    + shown(*["$(find ${t})"] * 20_000),
    "removed-blocks": _many(20_000, "<xacro:property name='p{n}'><a/></xacro:property>")
    + "<xacro:property name='p1' remove='true'/>",
    "global-names": _macro(
        _many(9_000, "<xacro:property name='p{n}' value='1' scope='global'/>"), 20
    ),
    "shown-spaces": "<a b='" + " " * 900_000 + "${1}'/>",
    "spaces-in-expressions": "<a b='${" + " " * 900_000 + "1}'/>",
    "spaces-in-parameters": "<xacro:macro name='m' params='"
    + " " * 900_000
    + "'/>"
    + "<xacro:macro name='m' params='a"
    + " " * 90_000
    + "b'/>",
    "equals-in-parameters": "<xacro:macro name='m' params='" + "a=b " * 200_000 + "'/>",
    "colons-in-parameters": "<xacro:macro name='m' params='" + ":" * 900_000 + "'/>",
    "braces-in-parameters": "<xacro:macro name='m' params='a:=${" + "}" * 900_000 + "x'/>",
    "parameters-of-many": _many(
        900, "<xacro:macro name='m{n}' params='" + "a b c d " * 120 + "'/>"
    ),
    "names-in-expressions": shown(*["${" + "+".join(f"n{n}" for n in range(300)) + "}"] * 600),
    "dotted-names": shown("${" + "a." * 400_000 + "a}"),
    "quotes-in-expressions": shown("${" + "'" * 900_001 + "}"),
    "equals-in-expressions": shown("${a" + " " * 900_000 + "}"),
    # files
    "patterns": named("p", "[a-z]*" * 150) + _many(9000, "<xacro:include filename='${p}{n}'/>"),
    "patterns-of-many": (
        "<xacro:include filename='*a*a*a*a*b'/>" * 9000,
        {f"urdf/{'a' * 90}{n}": "" for n in range(900)},
    ),
    "includes": ("<xacro:include filename='b.xacro'/>" * 10_000, {"urdf/b.xacro": part("<a/>")}),
    "missing-files": (
        "".join(f"<xacro:include filename='c{n}.xacro'/>" for n in range(10_000)),
        {f"urdf/f{n}.xacro": "" for n in range(500)},
    ),
    "large-file-again": (
        "<xacro:include filename='b.xacro'/>" * 9000,
        {"urdf/b.xacro": f"<!--{'x' * 600_000}-->" + part("")},
    ),
    "broken-file-again": (
        "<xacro:include filename='b.xacro'/>" * 9000,
        {"urdf/b.xacro": part("<a>" + "x" * 9000)},
    ),
    "too-large-file-again": (
        "<xacro:include filename='b.xacro'/>" * 9000,
        {"urdf/b.xacro": part(f"<!--{'x' * 12_000_000}-->")},
    ),
    "endings": (
        "<xacro:include filename='none.xacro'/>" * 0
        + _many(9000, "<xacro:include filename='c{n}'/>"),
        {},
    ),
    # YAML
    "yaml-base60": _yaml("a: 1" + ":1" * 50_000),
    "yaml-merge": _yaml(
        "a0: &a0 {k0: x}\n"
        + "".join(f"a{n}: &a{n}\n  <<: [{', '.join([f'*a{n - 1}'] * 10)}]\n" for n in range(1, 16))
    ),
    "yaml-again": _yaml("a: 1\n" * 5000, *["${xacro.load_yaml('a.yaml')['a']}"] * 5000),
    "yaml-aliases": _yaml("a: &a [" + "1," * 9000 + "]\nb: [" + "*a," * 90_000 + "]"),
    "yaml-sequences": _yaml("- " * 500_000),
    "yaml-questions": _yaml("? " * 500_000),
    "yaml-brackets": _yaml("[" * 1_000_000),
    "yaml-flow-keys": _yaml("[" + "{a: " * 900 + "1" + "}" * 900 + "]"),
    "yaml-empty": _yaml("[" + "{}," * 340_000 + "]"),
    "yaml-lines": _yaml("a: x" + "\n x" * 340_000),
    "yaml-quoted": _yaml('a: "' + "\\x41" * 250_000 + '"'),
    "yaml-digits": _yaml("a: 0x" + "f" * 1_000_000),
    "yaml-comments": _yaml("#\n" * 500_000),
    "yaml-anchors": _yaml("".join(f"- &a{n} x\n" for n in range(80_000))),
    "yaml-anchor-long": _yaml("- &" + "a" * 500_000 + " x\n- *" + "a" * 500_000),
    "yaml-units": _yaml("".join(f"- !degrees {n}*pi/180+sin(1)\n" for n in range(30_000))),
    "yaml-tags": _yaml("%TAG !a! !" + "d" * 400_000 + "\n---\n" + "- !a!x 1\n" * 60_000),
    "yaml-timestamps": _yaml("- " + "1" * 99 + "\n" + ("- " + "1_" * 49 + ":\n") * 9000),
}

# Documents that are XML only in part, and those with a document type: all of the text.
_TEXTS = {
    "declarations": _START + "<?xml " * 20_000 + "x" * 900_000,
    "sections-in-a-comment": robot(
        f"<!--{'<![CDATA[' * 50_000}{'x' * 500_000}-->" + _LINK + "${1}"
    ),
    "comments-open": _START + "<!--" * 20_000 + "x" * 900_000,
    "comments-in-broken": _START + "<!-- " * 20_000 + "x" * 900_000,
    "tags-open": robot("${1}" + "<a><b>" * 10_000),
    "tags-crossed": _START + "<link><joint></link>" * 7_000,
    "tags-broken": _START + '<link name="' * 15_000,
    "tags-unquoted": _START + "<a " + "b=c " * 200_000 + "></robot>",
    "quotes-broken": _START + "<a b=" + "'\"" * 400_000,
    "long-broken": _START + "<a>" + "x" * 1_000_000,
    "spaces-broken": _START + "<" + " " * 1_000_000,
    "declaration-of-spaces": "<?xml" + " " * 1_000_000,
    "declaration-of-attributes": '<?xml version="1.0"' + ' a="b"' * 170_000 + "<",
    "many-attributes": robot("${1}<a " + _many(55_000, "b{n}='' ") + "/>"),
    "many-attributes-of-broken": _START + "<a " + _many(55_000, "b{n}='' "),
    "many-elements": robot("${1}" + "<a/>" * 105_000),
    "many-elements-small-tags": robot("${1}" + "<a>" * 90 + "<b/>" * 80_000 + "</a>" * 90),
    "default-attributes": f"<!DOCTYPE robot [<!ATTLIST a b CDATA '{'x' * 3_000}'>]>"
    + robot("${1}" + _LINK + "<a/>" * 50_000).partition("\n")[2],
    "default-attributes-many": "<!DOCTYPE robot [<!ATTLIST a "
    + _many(200, "b{n} CDATA 'x' ")
    + ">]>"
    + robot("${1}" + _LINK + "<a/>" * 50_000).partition("\n")[2],
    "prefixes": robot(
        "${1}<g " + _many(8000, "xmlns:n{n}='u{n}' ") + ">" + "<a n1:b='1'/>" * 30_000 + "</g>"
    ),
    "references": robot("${1}<a b='" + "&#65;" * 170_000 + "'/>"),
    "plain": robot("${1}" + "<link name='l'/>" * 60_000),
    "robot": robot(
        _LINK
        + _many(
            3000,
            "<link name='l{n}'><visual><origin xyz='0 0 ${{n}*0.1}' rpy='0 0 0'/><geometry><box size='1 1 1'/></geometry></visual></link><joint name='j{n}' type='fixed'><parent link='base_link'/><child link='l{n}'/></joint>",
        )
    ),
    "numbers": robot(
        _LINK
        + f"<link name='l'><visual><origin xyz='{'1' * 300_000} {'1' * 300_000} {'1' * 300_000}'/></visual></link>"
        + "${1}"
    ),
}

COSTS: Documents = merged(
    {
        name: Document(robot(_LINK + row))
        if isinstance(row, str)
        else Document(robot(_LINK + row[0]), row[1])
        for name, row in _ROWS.items()
    },
    {name: Document(text) for name, text in _TEXTS.items()},
)
