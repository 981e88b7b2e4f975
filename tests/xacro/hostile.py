"""Hostile documents. xacro itself must never get them: it would run code, read files or need all memory."""

from tests.xacro.documents.document import (
    Document,
    Documents,
    bodies,
    expressions,
    merged,
    named,
    part,
    robot,
    shown,
)

_ESCAPES = expressions(
    (
        "().__class__.__bases__[0].__subclasses__()",
        "''.__class__.__mro__",
        "[].append.__self__.__class__",
        "sin.__self__",
        "math.__dict__",
        "xacro.load_yaml.__globals__",
        "().__\uff43lass__",
        "python.type([]).mro()",
        "python.type('X', (), dict())",
        "python.vars(python)",
        "python.list.mro()",
        "xacro.__dict__",
        "xacro.arg.__globals__['os']",
        "(x for x in [1]).gi_frame.f_builtins",
        "[g.gi_frame.f_back.f_globals for g in [(0 for _ in [1])]]",
        "(lambda: 1).__code__",
        "(lambda f: f(f))(lambda f: f(f))",
        "__builtins__",
        "__import__('os').system('id')",
        "open('/etc/passwd').read()",
        "eval('1')",
        "exec('import os')",
        "compile('1', '', 'eval')",
        "globals()",
        "breakpoint()",
        "getattr(1, '__class__')",
        "math.update(pi=3)",
        "python.clear()",
        "xacro.update(load_yaml=len)",
        "(math := 5)",
        "math.root.clear()",
        "xacro.parent",
        "import os",
        "[].__reduce_ex__(2)",
        "'%c' * 10 ** 9 % 95",
        "sorted([1], key=python.vars)",
        "python.map(python.vars, [xacro])",
        "python.filter.__class__",
        "await 1",
        "yield 1",
        "[*open('/etc/passwd')]",
        "max('a', key=eval)",
    )
)

_FORMATS = bodies(
    format_attribute=named("f", "{0.__class__.__mro__}") + shown("${f.format(1)}"),
    format_index=named("f", "{0[__class__]}") + shown("${f.format(math)}"),
    format_map=named("f", "{a.__class__}") + shown("${f.format_map(dict(a=1))}"),
    format_width=named("f", "{:>1000000000}") + shown("${f.format(1)}"),
    format_precision=named("f", "{:.1000000000f}") + shown("${f.format(1.0)}"),
    format_nested=named("f", "{:{}}") + shown("${f.format(1, 10 ** 9)}"),
    format_method_of_class=named("f", "{0.__class__}") + shown("${str.format(f, 1)}"),
    f_string=shown("$(eval f'{[].append}')"),
    eval_builtins=shown("$(eval open)", "$(eval [].append)"),
    eval_call=named("close", "')'") + shown("$(eval ${'open(\"/etc/passwd\"' + close})"),
    eval_import=named("close", "')'") + shown("$(eval ${'_' + '_import_' + '_(\"os\"' + close})"),
    eval_power=shown("$(eval 9**9**9)"),
    name_runs=named("${open('/etc/passwd').read()}", "1"),
    condition_runs="<xacro:if value=\"${__import__('os')}\"><a/></xacro:if>",
    argument_runs="<xacro:arg name='a' default=\"${__import__('os')}\"/>",
    element_runs="<xacro:element xacro:name=\"${__import__('os')}\"/>",
    default_runs="<xacro:macro name='m' params=\"a:=${__import__('os')}\"><b/></xacro:macro><xacro:m/>",
)

_SIZES = expressions(
    (
        "9**9**9",
        "9**9**9**9",
        "2**10**8",
        "10**100000",
        "str(10**100000)",
        "(10**4000)**(10**3)",
        "10.0**10**9",
        "-9**(9**9)",
        "int('9'*10**6)",
        "int('1' * 10**5, 16)",
        "1 << 10**9",
        "1 << 10**12",
        "'a' * 10**10",
        "[0] * 10**10",
        "(0,) * 10**10",
        "'a' * 1000 * 1000 * 1000 * 1000",
        "[[[[0] * 1000] * 1000] * 1000] * 1000",
        "str([[[0] * 1000] * 1000] * 1000)",
        "'%1000000000d' % 1",
        "'%.1000000000f' % 1",
        "'%*d' % (10**9, 1)",
        "'a'.rjust(10**10)",
        "'a'.ljust(10**9)",
        "'a'.center(10**9)",
        "'1'.zfill(10**9)",
        "'\\t'.expandtabs(10**9)",
        "('a' * 10**5).replace('a', 'b' * 10**5)",
        "('a' * 10**4).join(['b'] * 10**5 + ['c'] * 10**5)",
        "'%s' % ('a' * 10**9)",
        "list(range(10**10))",
        "range(10**10)[5:] + [1]",
        "[i for i in range(10**9)]",
        "[1 for i in range(10**5) for j in range(10**5)]",
        "[[j for j in range(10**4)] for i in range(10**4)]",
        "[[[0 for i in range(500)] for i in range(500)] for i in range(500)]",
        "python.sum(range(10**10))",
        "max(range(10**10))",
        "sorted(range(10**9))",
        "10**9 in list(range(10**9))",
        "[x for x in range(10**9) if x < 0]",
        "python.all(1 for i in range(10**9))",
        "len([0 for i in range(10**8)])",
        "fsum(range(10**9))",
        "prod(range(1, 10**6))",
        "factorial(10**7)",
        "comb(10**8, 10**4)",
        "perm(10**7, 10**6)",
        "isqrt(10**1000000)",
        "lcm(*range(1, 10**5))",
        "round(123, -10**9)",
        "round(10**3000, -2999) ** 10**6",
        "math.pow(10, 10**10)",
        "ldexp(1.0, 10**30)",
        "python.complex(1, 2) ** 10**9",
        "('a' * 10**5 + 'b') in ('a' * 10**7)",
        "('a,' * 10**7).split(',')",
        "dict([(i, 'a' * 1000) for i in range(10**8)])",
        "python.divmod(10**10**7, 3)",
        "10**10**6 % 7",
        "10**10**6 == 10**10**6",
        "str(9**9**6)",
        "hypot(*range(10**8))",
        "python.list(map(str, range(10**9)))",
        "xacro.tokenize('a ' * 10**8)",
        "xacro.tokenize('a' * 30, '[(a+)+')",
        "'a' * 10**6 + 'b' * 10**9",
        "python.slice(10**9)",
        "'a'.encode() * 10**10",
        "python.hash('a' * 10**10)",
        "python.repr('a' * 10**10)",
        "gamma(10**10)",
        "[0, *range(10**9)]",
    )
)

_COUNT = 100_000
_CHAINS = expressions(
    (
        "(" * 10_000 + "1" + ")" * 10_000,
        "-" * 10_000 + "1",
        "not " * 10_000 + "1",
        "[" * 10_000 + "]" * 10_000,
        "1" + "+1" * _COUNT,
        "1" + "**1" * 10_000,
        "1" + "<1" * _COUNT,
        "1 if 1 else " * 10_000 + "1",
        "1 or " * _COUNT + "1",
        "[0]" + "[0]" * 10_000,
        "'a'" + ".upper()" * 10_000,
        "sin(" * 10_000 + "1" + ")" * 10_000,
        "9" * 1_000_000,
        "'" + "a" * 1_000_000,
        "lambda: " * 10_000 + "1",
        "[x for x in " * 1_000 + "[1]" + "]" * 1_000,
        "1." + "0" * 1_000_000 + "e",
        "~" * _COUNT + "1",
    )
)
_CHAINS = {f"chain-{name[:12]}": document for name, document in _CHAINS.items()}


def _levels(count: int, level: str, first: str, last: str) -> str:
    """Return one text for each level, `{n}` being its number and `{m}` that of the one before."""
    return (
        first
        + "".join(level.replace("{n}", str(n)).replace("{m}", str(n - 1)) for n in range(1, count))
        + last
    )


_MACRO = "<xacro:macro name='m{n}' params=''><xacro:m{m}/><xacro:m{m}/></xacro:macro>"
_MULTIPLIED = bodies(
    doubling_macros=_levels(
        41, _MACRO, "<xacro:macro name='m0' params=''><a/></xacro:macro>", "<xacro:m40/>"
    ),
    doubling_macros_of_nothing=_levels(
        41, _MACRO, "<xacro:macro name='m0' params=''/>", "<xacro:m40/>"
    ),
    doubling_texts=_levels(
        61,
        '<xacro:property name="p{n}" value="${p{m}}${p{m}}"/>',
        named("p0", "a"),
        shown("${p60}"),
    ),
    doubling_sums=_levels(
        61,
        '<xacro:property name="p{n}" value="${p{m} + p{m}}"/>',
        named("p0", "a"),
        shown("${p60}"),
    ),
    doubling_lists=_levels(
        61,
        '<xacro:property name="p{n}" value="${[p{m}, p{m}]}"/>',
        named("p0", "a"),
        shown("${p60}"),
    ),
    squared_numbers=_levels(
        61,
        '<xacro:property name="p{n}" value="${p{m} * p{m}}"/>',
        named("p0", "9"),
        shown("${p60}"),
    ),
    doubling_blocks=_levels(
        41,
        '<xacro:property name="b{n}"><xacro:insert_block name="b{m}"/><xacro:insert_block name="b{m}"/></xacro:property>',
        '<xacro:property name="b0"><a/></xacro:property>',
        '<xacro:insert_block name="b40"/>',
    ),
    doubling_block_parameters="<xacro:macro name='m' params='n **b'><xacro:if value='${n}'><xacro:m n='${n - 1}'><g>"
    "<xacro:insert_block name='b'/><xacro:insert_block name='b'/></g></xacro:m></xacro:if></xacro:macro>"
    "<xacro:m n='40'><g><a/></g></xacro:m>",
    doubling_arguments=_levels(
        61,
        "<xacro:arg name='p{n}' default='$(arg p{m})$(arg p{m})'/>",
        "<xacro:arg name='p0' default='aa'/>",
        shown("$(arg p60)"),
    ),
    doubling_defaults="<xacro:macro name='m' params='n t'><xacro:m n='${n + 1}' t='${t}${t}'/></xacro:macro><xacro:m n='0' t='a'/>",
    endless_macro="<xacro:macro name='m' params=''><xacro:m/></xacro:macro><xacro:m/>",
    endless_macro_of_two="<xacro:macro name='m' params=''><xacro:n/></xacro:macro><xacro:macro name='n' params=''><xacro:m/></xacro:macro><xacro:m/>",
    endless_call="<xacro:macro name='m' params=''><xacro:call macro='m'/><xacro:call macro='m'/></xacro:macro><xacro:m/>",
    endless_block='<xacro:property name="b"><xacro:insert_block name="b"/><xacro:insert_block name="b"/></xacro:property><xacro:insert_block name="b"/>',
    counting_macro="<xacro:macro name='m' params='n'><xacro:if value='${n}'><a/><xacro:m n='${n - 1}'/></xacro:if></xacro:macro><xacro:m n='1000000'/>",
    chain_of_properties=_levels(
        10_000, '<xacro:property name="p{n}" value="${p{m}}"/>', named("p0", "1"), shown("${p9999}")
    ),
    circle_of_properties=_levels(
        10_000,
        '<xacro:property name="p{n}" value="${p{m}}"/>',
        named("p0", "${p9999}"),
        shown("${p1}"),
    ),
    nested_calls="<xacro:macro name='m' params='*b'><xacro:insert_block name='b'/></xacro:macro>"
    + "<xacro:m>" * 5_000
    + "<a/>"
    + "</xacro:m>" * 5_000,
    nested_conditions="<xacro:if value='1'>" * 20_000 + "<a/>" + "</xacro:if>" * 20_000,
    nested_macros="<xacro:macro name='m' params=''>" * 20_000
    + "</xacro:macro>" * 20_000
    + "<xacro:m/>",
)

# These are only large: they can be expanded, as fast as their size allows.
LARGE: Documents = bodies(
    nested_elements="<a>" * 20_000 + "</a>" * 20_000,
    large_attribute=shown("a" * 2_000_000),
    many_attributes="<a " + " ".join(f"a{n}='${{1}}'" for n in range(2_000)) + "/>",
    many_expressions=shown("${1}" * 5_000),
    many_dollars=shown("$a" * 100_000),
    many_escapes=shown("$${" * 20_000),
    many_open_expressions=shown("${" * 100_000),
    many_open_brackets=shown("$(" * 100_000),
    many_braces=shown("${{" * 50_000),
    many_arguments="".join(f"<xacro:arg name='a{n}' default='1'/>" for n in range(3_000)),
    many_properties="".join(named(f"p{n}", "${1 + 1}") for n in range(3_000)),
    many_parameters="<xacro:macro name='m' params='"
    + " ".join(f"a{n}:=1" for n in range(2_000))
    + "'><a/></xacro:macro><xacro:m/>",
    many_comments="<!-- a -->" * 20_000,
    many_macros="".join(f"<xacro:macro name='m{n}' params='a'/>" for n in range(3_000)),
    backtracking_parameters=f"<xacro:macro name='m' params='a:={'x' * 60}&quot;'><a/></xacro:macro>",
    backtracking_quotes=f"<xacro:macro name='m' params=\"a:={'x y' * 40}'\"><a/></xacro:macro>",
    backtracking_spaces=f"<xacro:macro name='m' params='a{' ' * 100_000}b'><a/></xacro:macro>",
    backtracking_patterns='<xacro:include filename="'
    + "*a" * 200
    + '.xacro"/><xacro:include filename="'
    + "[" * 5_000
    + '"/>',
)


def _included(name: str) -> str:
    return f'<xacro:include filename="{name}"/>'


_BOMB = (
    '<!DOCTYPE robot [<!ENTITY e0 "aaaaaaaaaa">'
    + "".join(f'<!ENTITY e{n} "{f"&e{n - 1};" * 10}">' for n in range(1, 12))
    + "]>"
)
_OUTSIDE = merged(
    bodies(
        absolute=_included("/etc/passwd"),
        parents=_included("../../../../../../../../etc/passwd"),
        parents_inside=_included("parts/../../../../../../etc/passwd"),
        url=_included("file:///etc/passwd"),
        web=_included("http://localhost/a.xacro"),
        home=_included("~/.ssh/id_rsa"),
        device=_included("/dev/zero"),
        process=_included("/proc/self/environ"),
        by_expression=_included("${'/' + 'etc/passwd'}"),
        by_package=_included("$(find my_robot)/../../../../etc/passwd"),
        by_package_name=_included("$(find ../../etc)/passwd"),
        by_package_root=_included("$(find /)/etc/passwd"),
        by_environment=_included("$(env HOME)/.profile"),
        by_optional_environment=_included("$(optenv HOME)/.profile"),
        by_working_folder=_included("$(cwd)/pyproject.toml"),
        by_pattern_parents=_included("../../../../etc/pass*") + "<xacro:none/>",
        by_pattern_absolute=_included("/etc/pass*") + "<xacro:none/>",
        zero_byte=_included("${'a\\x00b'}"),
        long_name=_included("a" * 100_000),
        long_path=_included("a/" * 50_000 + "b"),
        optional="<xacro:include filename='/etc/passwd' optional='true'/><xacro:none/>",
        yaml_absolute=shown("${xacro.load_yaml('/etc/passwd')}"),
        yaml_parents=shown("${xacro.load_yaml('../../../../../../etc/passwd')}"),
        yaml_device=shown("${xacro.load_yaml('/dev/zero')}"),
        abs_filename=shown("${xacro.load_yaml(xacro.abs_filename('/etc/passwd'))}"),
        itself=_included("robot.urdf.xacro"),
        itself_twice=_included("robot.urdf.xacro") * 2,
    ),
    {
        "mutual": Document(
            robot(_included("a.xacro")),
            {
                "urdf/a.xacro": part(_included("b.xacro")),
                "urdf/b.xacro": part(_included("a.xacro")),
            },
        ),
        "mutual-doubling": Document(
            robot(_included("a.xacro")),
            {
                "urdf/a.xacro": part(_included("b.xacro") * 2),
                "urdf/b.xacro": part(_included("a.xacro") * 2),
            },
        ),
        "doubling-files": Document(
            robot(_included("f0.xacro")),
            {f"urdf/f{n}.xacro": part(_included(f"f{n + 1}.xacro") * 2) for n in range(40)}
            | {"urdf/f40.xacro": part("<a/>")},
        ),
        "entities": Document(_BOMB + robot(shown("&e11;")).partition("\n")[2]),
        "entities-in-text": Document(_BOMB + robot("<a>&e11;</a>").partition("\n")[2]),
        "entities-in-a-file": Document(
            robot(_included("a.xacro")), {"urdf/a.xacro": _BOMB + part("<a>&e11;</a>")}
        ),
        "entity-of-a-file": Document(
            '<!DOCTYPE robot [<!ENTITY e SYSTEM "file:///etc/passwd">]>'
            + robot("<a>&e;</a><xacro:none/>").partition("\n")[2]
        ),
        "parameter-entity": Document(
            '<!DOCTYPE robot [<!ENTITY % e SYSTEM "file:///etc/passwd">%e;]>'
            + robot("<xacro:none/>").partition("\n")[2]
        ),
        "document-type-of-a-file": Document(
            '<!DOCTYPE robot SYSTEM "file:///etc/passwd">'
            + robot("<xacro:none/>").partition("\n")[2]
        ),
        "quadratic-entity": Document(
            f'<!DOCTYPE robot [<!ENTITY e "{"a" * 100_000}">]>'
            + robot(f"<a>{'&e;' * 10_000}</a><xacro:none/>").partition("\n")[2]
        ),
        "xinclude": Document(
            robot(
                '<xi:include xmlns:xi="http://www.w3.org/2001/XInclude" href="/etc/passwd" parse="text"/><xacro:none/>'
            )
        ),
        "style-sheet": Document(
            '<?xml-stylesheet href="file:///etc/passwd"?>'
            + robot("<xacro:none/>").partition("\n")[2]
        ),
    },
)

_YAML: dict[str, str | bytes] = {
    "aliases": "a0: &a0 [x, x]\n"
    + "".join(f"a{n}: &a{n} [*a{n - 1}, *a{n - 1}]\n" for n in range(1, 40)),
    "aliases-of-dicts": "a0: &a0 {k: x}\n"
    + "".join(f"a{n}: &a{n} {{k: *a{n - 1}, l: *a{n - 1}}}\n" for n in range(1, 40)),
    "merges": "a0: &a0 {k0: x}\n"
    + "".join(f"a{n}: &a{n} {{<<: [*a{n - 1}, *a{n - 1}], k{n}: x}}\n" for n in range(1, 30)),
    "alias-of-itself": "&a [*a, *a]\n",
    "dict-of-itself": "&a {k: *a}\n",
    "nested": "[" * 20_000 + "]" * 20_000,
    "nested-blocks": "".join(" " * n + f"k{n}:\n" for n in range(1_000)) + " " * 1_000 + "v",
    "python-apply": "!!python/object/apply:os.system ['id']\n",
    "python-name": "!!python/name:os.system\n",
    "python-module": "!!python/module:os\n",
    "python-new": "!!python/object/new:subprocess.Popen [['id']]\n",
    "unit-power": "a: !degrees 9**9**9\n",
    "unit-import": "a: !degrees __import__('os').getpid()\n",
    "unit-class": "a: !meters ().__class__.__base__.__subclasses__()\n",
    "large-number": "a: " + "9" * 100_000 + "\n",
    "large-power": "a: 0b" + "1" * 100_000 + "\n",
    "sexagesimal": "a: 1" + ":59" * 50_000 + "\n",
    "large-key": "? " + "[" * 500 + "a" + "]" * 500 + "\n: b\n",
    "many-entries": "".join(f"k{n}: {n}\n" for n in range(100_000)),
    "not-text": b"\xff\xfe\x00\x00",
}
_YAML_DOCUMENTS: Documents = {
    f"yaml-{name}": Document(
        robot(
            named("y", "${xacro.load_yaml('a.yaml')}")
            + shown("${y}", "${python.repr(y)}")
            + "<xacro:none/>"
        ),
        {"urdf/a.yaml": text},
    )
    for name, text in _YAML.items()
}

_GIVEN: Documents = {
    "argument-is-code": Document(
        robot(shown("$(eval ${'$(arg a)'})")), arguments={"a": "open('/etc/passwd')"}
    ),
    "argument-is-expression": Document(
        robot(shown("${$(arg a)}")), arguments={"a": "__import__('os')"}
    ),
    "argument-is-path": Document(robot(_included("$(arg a)")), arguments={"a": "/etc/passwd"}),
    "argument-is-power": Document(robot(shown("${$(arg a)}")), arguments={"a": "9**9**9"}),
    "argument-is-class": Document(robot(shown("$(eval a.__class__)")), arguments={"a": "1"}),
}

HOSTILE: Documents = merged(
    _ESCAPES, _FORMATS, _SIZES, _CHAINS, _MULTIPLIED, _OUTSIDE, _YAML_DOCUMENTS, _GIVEN
)
