"""Expressions: operators, numbers as text, strings, lists, comprehensions, and the functions of xacro's namespace."""

from tests.xacro.documents.document import Documents, expressions, merged, named

_ARITHMETIC = (
    "1 + 2", "1 - 2", "2 * 3", "7 / 2", "10 / 2", "7 // 2", "-7 // 2", "7 % 3", "-7 % 3", "7.5 % 2", "2 ** 10", "2 ** -1", "2 ** 0.5",
    "-2 ** 2", "2 ** 3 ** 2", "(1 + 2) * 3", "1 + 2 * 3", "-1", "+1", "--1", "- - 1", "~5", "1 << 4", "256 >> 2", "6 & 3", "6 | 1", "6 ^ 3",
    "0.1 + 0.2", "1e-7", "1e16", "1e22", "123456789012345678901234567890", "1.0", "1.", ".5", "1.50", "1_000", "0x10", "0b11", "0o17", "1j",
    "1 + 1.0", "3 * 0.1", "1 / 3", "2 / 3", "0.3 - 0.1", "1e300 * 1e10", "-1e300 * 1e10", "10 ** 20", "10.0 ** 20", "0.0001", "0.00001",
    "1e5", "1.5e5", "1e15 + 0.3", "100 * 1.1", "0.6 / 4", "0.2 + 0.05 / 2", "(0.4 + 0.05) / 2", "1 / 12 * 5.0 * (3 * 0.1 ** 2 + 0.05 ** 2)",
    "True + 1", "True * 2", "-True", "round(2.5)", "round(2.675, 2)", "round(1234.5, -2)", "abs(-1)", "divmod(7, 2)", "1 if True else 2",
    "8/4", "2**0.5*2", "5 // 0.3", "1 - 0.9", "0 * -1.0", "-0.0", "1 if 0 else 2 if 0 else 3", "01", "1__0", "1 2", "1 +", "* 2", "(1", "1)", "",
    "1 / 0", "1 // 0", "1 % 0", "1.0 / 0", "0 ** -1", "'a' + 1", "1 + 'a'", "'a' - 'b'", "'a' * 'b'", "[1] + 1", "None + 1", "-'a'", "~1.5", "1 << -1",
    "2 ** 'a'", "'a' / 2", "1 @ 2", "10.0 ** 400", "(-1) ** 0.5", "(-8) ** (1/3)", "1e400 - 1e400", "9 ** 0.5", "4 ** 0.5", "x = 1", "1; 2", "import os",
    "1,", "1, 2", "()", "(1)", "1 == 1.0", "1 is 1", "1 is not 1", "0.1 + 0.2 == 0.3", "...", "1.real", "(1).real", "(5).bit_length()", "1.5.is_integer()",
    "(0.5).as_integer_ratio()", "(5.0).hex()", "5 .numerator", "1if 1else 2",
)  # fmt: skip

_COMPARISON = (
    "1 < 2", "1 <= 1", "1 > 2", "1 >= 1", "1 == 1", "1 != 1", "1 <> 2", "1 < 2 < 3", "3 > 2 > 2", "1 < 2 > 0", "'a' < 'b'", "'a' == 'a'", "'a' == 1",
    "1 in [1, 2]", "3 not in [1, 2]", "'a' in 'cat'", "'a' in dict(a=1)", "1 in 'a'", "1 in 1", "[1] == [1]", "[1, 2] < [1, 3]", "None is None",
    "None == 0", "not 1", "not not 1", "not ''", "1 and 2", "0 and 2", "0 or 2", "'' or 'a'", "1 or 1 / 0", "0 and 1 / 0", "1 and 1 / 0", "not 1 == 2",
    "1 && 2", "1 || 2", "!1", "True", "False", "true", "false", "None", "null", "1 if 'a' == 'a' else 1 / 0", "'a' if 1 < 2 and 2 < 3 else 'b'", "True == 1",
    "1 == True", "'True' == True", "(1, 2) == (1, 2)", "(1, 2) == [1, 2]", "nan == nan", "inf > 1", "'1' == 1", "[] == False", "not []", "1 < None",
    "[1] < ['a']", "'b' >= 'a' >= 'a'", "any([0, 1])", "all([0, 1])", "isinstance(1, int)",
)  # fmt: skip

_STRINGS = (
    "'a' + 'b'", "'ab' * 3", "3 * 'ab'", "'a' * 0", "'a' * -1", "'abc'[0]", "'abc'[-1]", "'abc'[1:]", "'abc'[:2]", "'abc'[::-1]", "'abc'[::2]", "'abc'[5]",
    "'abc'[1:10]", "len('abc')", "str(1.50)", "str(True)", "str(None)", "str([1, 'a'])", "str('a')", "int('5')", "int('5.5')", "int(5.9)", "int(-5.9)",
    "float('5')", "float('1e3')", "float('a')", "float('inf')", "int('0x10', 16)", "int('ff', 16)", "int('a')", "bool('')", "bool('a')", "'a b c'.split()",
    "'a,b'.split(',')", "'a b'.split()[1]", "'1 2 3'.split(' ')[2]", "' '.join(['a', 'b'])", "' '.join([1, 2])", "' '.join([str(x) for x in [1, 2]])",
    "'abc'.upper()", "'ABC'.lower()", "'abc'.title()", "'abc'.capitalize()", "' a '.strip()", "' a '.lstrip()", "' a '.rstrip()", "'abc'.replace('b', 'x')",
    "'abc'.startswith('a')", "'abc'.endswith('c')", "'abc'.find('c')", "'abc'.index('z')", "'abc'.count('a')", "'5'.isdigit()", "'5'.zfill(3)", "'a'.rjust(3)",
    "'a'.ljust(3) + '|'", "'a'.center(3)", "'a-b'.partition('-')", "'a-b'.rsplit('-')", "'abc'.swapcase()", "'abc'.isalpha()", "'a\\tb'.expandtabs(4)",
    "'a' 'b'", "'%d' % 5", "'%.3f' % 0.12345", "'%s_%s' % ('a', 1)", "'%5.2f|' % 3.14159", "'%d' % 'a'", "'%s' % [1]", "'%(a)s' % dict(a=1)", "'%' % 1", "'%d %d' % 1",
    "'a_' + str(1)", "'link_' + str(1 + 1)", "'a' + str(0.1 + 0.2)", "'left_wheel'[0:4]", "'left' in 'left_wheel'", "'left_wheel'.split('_')[0]",
    "'abc'.nothing()", "'abc'.nothing", "'abc'()", "'a'.join('bc')", "'abc'.removeprefix('a')", "'abc'.removesuffix('c')", "str()", "''", "'a' == \"a\"", "'\\n'",
    "'\\u00e9'", "'é'.upper()", "'a\\\\b'", "r'a\\b'", "'''a'''", "'a", "\"a'", "repr('a')", "'a'.__len__()", "len(5)", "int()", "float()", "str(1, 2)", "int([1])",
    "'abc'['a']", "'abc'[1.0]", "'abc'.split('')", "tuple('ab')", "list('ab')", "sorted('ba')", "max('ab')", "min('b', 'a')", "max([1, 5, 3])", "max(1, 'a')", "max()", "min([])",
    "'a' if 'x' else 'b'", "f'{1 + 1}'", "'abc'.encode()", "'a'.casefold()", "'1.5'.replace('.', ',')", "'abc'.find('z')", "'a b'.title().split()", "str(1e-7)", "str(1/3)",
)  # fmt: skip

_LISTS = (
    "[1, 2][0]", "[1, 2][-1]", "[1, 2][2]", "[1, 2, 3][1:]", "[1, 2, 3][::-1]", "[1] + [2]", "[0] * 3", "len([1, 2])", "[[1, 2], [3]][1][0]", "(1, 2)[1]", "[]", "[1, 'a', 2.50]",
    "['a', 'b'][1]", "dict(a=1)['a']", "dict(a=1)['b']", "dict(a=1).get('b', 5)", "dict(a=1).get('b')", "dict(a=1, b=2).keys()", "list(dict(a=1, b=2).keys())", "list(dict(a=1).values())",
    "list(dict(a=1).items())", "dict([('a', 1)])['a']", "dict(dict(a=1), b=2)", "len(dict(a=1))", "dict()", "[x * 2 for x in [1, 2]]", "[x for x in [1, 2, 3] if x > 1]", "[x + y for x in [1, 2] for y in [10, 20]]",
    "[i for i in range(3)]", "list(range(3))", "range(3)", "list(range(1, 10, 3))", "list(range(5, 0, -2))", "range(3)[1]", "sum([1, 2])", "sum(x for x in [1, 2])", "sorted([2, 1])", "sorted([2, 1], reverse=True)",
    "[x for x in 'ab']", "list(map(str, [1, 2]))", "list(map(lambda x: x + 1, [1, 2]))", "list(zip([1, 2], [3, 4]))", "' '.join(map(str, [1, 2]))", "[1, 2].index(2)", "[1, 2].count(1)", "[1].append(2)", "[a for a in [1]][0]",
    "[1, 2][True]", "[1]['a']", "[1][1.0]", "[*[1, 2], 3]", "[x for x in 5]", "x", "[x for x in [1]] + [x]", "1[0]", "None[0]", "dict(a=[1, 2])['a'][1]", "dict(a=1).a", "tuple([1, 2])", "(1, 2) + (3,)", "list((1, 2))", "list()",
    "[1, 2, 3][0:2]", "[1, 2, 3][-2:]", "[1, 2] == [1, 2]", "[[0] * 2] * 2", "[i ** 2 for i in range(4)]", "[str(i) + 'a' for i in range(2)]", "len(range(10))", "max([x * 2 for x in [1, 2]])", "dict(a=1) == dict(a=1)",
    "[(i, j) for i in range(2) for j in range(2) if i != j]", "[[j for j in range(i)] for i in range(3)]", "[1, 2, 3].pop()", "['b', 'a'].sort()", "bool([])", "reversed([1, 2])", "enumerate(['a'])", "set([1])", "list(enumerate(['a']))",
    "list(filter(None, [0, 1]))", "[x if x else 'z' for x in [0, 1]]", "dict(zip(['a'], [1]))", "[y for x in [[1, 2], [3]] for y in x]", "sum([0.1] * 3)", "sum([])", "sum(['a'])", "sum([1], 5)", "min([3, 1, 2])", "min(3, 1, 2)",
    "max(1, 2.0)", "max(2, 2.0)", "max([1, 2], key=lambda v: -v)", "len(())", "(lambda x: x + 1)(2)", "(lambda: 5)()", "(y := 5)", "[1, 2, 3][slice(1)]", "any(x > 1 for x in [1, 2])", "(x for x in [1])", "list(x for x in [1])", "[1, 2].reverse()",
    "[1, 2].copy()", "dict(a=1).pop('a')", "dict(a=1).update(b=2)", "dict(a=1).items()", "dict(a=1).values()", "'a' in ['a']", "dict(a=1, a=2)", "dict(1)", "list(1)", "range('a')", "range(1, 2, 0)", "[1,,2]", "[1 2]", "[", "len()", "len([], [])",
)  # fmt: skip

_FUNCTIONS = (
    "pi", "e", "tau", "inf", "nan", "sin(0)", "cos(0)", "tan(0)", "sin(pi / 2)", "cos(pi)", "sin(pi)", "asin(1)", "acos(0)", "atan(1)", "atan2(1, 2)", "sqrt(2)", "sqrt(4)", "sqrt(-1)", "log(2)", "log(8, 2)", "log10(100)", "log2(8)", "log(0)",
    "exp(1)", "exp(1000)", "pow(2, 3)", "floor(1.5)", "ceil(1.5)", "trunc(-1.5)", "fabs(-1)", "fmod(7, 3)", "hypot(3, 4)", "radians(90)", "degrees(pi)", "factorial(5)", "factorial(-1)", "gcd(12, 8)", "isclose(0.1 + 0.2, 0.3)", "isnan(nan)", "copysign(1, -2)",
    "sinh(1)", "cosh(1)", "tanh(1)", "fsum([0.1] * 10)", "prod([1, 2, 3])", "dist([0, 0], [3, 4])", "comb(5, 2)", "modf(1.5)", "frexp(8)", "isqrt(17)", "cbrt(27)", "erf(1)", "gamma(5)", "ldexp(1, 3)", "remainder(7, 3)", "isfinite(1)", "lcm(4, 6)", "perm(5, 2)", "exp2(3)",
    "math.pi", "math.sin(0)", "math.radians(180)", "math.nothing", "math", "math.pi.real", "math.sqrt(16)", "math['pi']", "math.pow(2, 3)", "math.floor(2.7)", "math.max(1, 2)", "math.inf", "radians(45)", "radians('a')", "radians()", "radians(1, 2)", "degrees(1.5707963267948966)",
    "python.len([1])", "python.abs(-2)", "python.sorted([2, 1])", "python.range(3)", "python.sum([1, 2])", "python.nothing(1)", "python.round(2.567, 1)", "python.max(1, 2)", "python.str(5)", "python.list(python.range(2))", "python.isinstance(1, python.int)", "python.isinstance('a', python.str)",
    "python.tuple([1])", "python.set([1])", "python.any([1])", "python.all([1])", "python.enumerate([1])", "list(python.enumerate(['a']))", "list(python.zip([1], [2]))", "list(python.reversed([1, 2]))", "python.ord('a')", "python.repr('a')", "python.divmod(7, 2)", "python.complex(1, 2)",
    "python.frozenset([1])", "python.slice(1)", "list(python.filter(None, [0, 1]))", "python.True", "python.bool(0)", "python.float('1')", "python.dict(a=1)", "python.int(1.5)", "python.min([1])", "python.map(str, [1])", "list(python.map(str, [1]))",
    "xacro.tokenize('a b;c,d')", "xacro.tokenize('a b', ',')", "xacro.tokenize('a,,b', ',', False)", "xacro.tokenize('1 2 3')[1]", "xacro.dotify(dict(a=1)).a", "xacro.dotify(dict(a=dict(b=2))).a.b", "xacro.nothing", "xacro.fatal('no')", "xacro.warning('no')", "xacro.message('no')", "xacro.error('no')",
    "xacro.print_location()", "tokenize('a')", "dotify(dict(a=1)).a", "fatal('no')", "xacro.arg('missing')", "hash(1)", "abs", "open('a')", "eval('1')", "exec('1')", "print(1)", "input()", "type(1)", "id(1)", "dir()", "globals()", "locals()", "vars()", "chr(65)", "ord('a')", "hex(16)", "bin(2)",
    "format(1.5, '.3f')", "getattr(1, 'real')", "object()", "isinstance(1, 1)", "sin", "len", "sin('a')", "sin()", "sin(1, 2)", "sin(x=1)", "round('a')", "round(1.23456, 3)", "round(1e-7, 3)", "round(5)", "round(5.0)", "round(-0.4)", "max(1, 2, 3)", "min(0.1, 0.01)", "int(1e3)", "int(True)",
    "float(1)", "float(True)", "str(float(1))", "bool(0.0)", "nothing(1)", "sin(cos(0))", "max(sin(0), cos(0))", "sin (0)", "sin(0,)", "sin(*[0])", "max(*[1, 2])", "dict(**dict(a=1))", "Sin(0)", "PI", "M_PI", "numpy.pi", "np.sin(0)", "os.getcwd()", "sys", "time", "random()", "i",
    "sqrt(0.1 ** 2 + 0.2 ** 2)", "atan2(0.1, 0.2) * 180 / pi", "-pi / 2", "pi/2", "2*pi", "pi*2/360*90", "sin(radians(30))", "cos(radians(60))", "round(sin(radians(30)), 3)", "int(round(2.5))", "int('1_000')", "float('1_0')", "abs(1)", "isnan(1)",
)  # fmt: skip
_MORE = (
    "len([map(int, ['a'])])",
    "list(map(int, ['a']))",
    "'a'.center()",
    "'a'.split(1)",
    "'a'.replace('a')",
    "'a'.upper(1)",
    "'a'.join(1)",
    "'a'.startswith(1)",
    "'a'.strip(1)",
    "'a'.find()",
    "'a'.zfill('a')",
    "xacro.tokenize(1)",
    "xacro.dotify(1.5)",
    "dict(a=1).get()",
    "[1].index(2)",
    "[1].index()",
    "round()",
    "round(1, 'a')",
    "round(1, 2, 3)",
    "int('1', 99)",
    "float([])",
    "min(1)",
    "max(1)",
    "len(1, 2)",
    "sorted(1)",
    "sorted([1, 'a'])",
    "range()",
    "range(1.5)",
    "list(range(2.0))",
    "math.sin('a')",
    "atan2(1)",
    "hypot('a')",
    "factorial(1.5)",
    "factorial(2.0)",
    "gcd(1.5, 2)",
    "floor('a')",
    "ceil(inf)",
    "int(inf)",
    "int(nan)",
    "round(inf)",
    "floor(nan)",
    "fmod(1, 0)",
    "pow(0, -1)",
    "pow(-1, 0.5)",
    "[1, 2, 3][::0]",
    "'abc'[::0]",
    "'abc'['a':]",
    "[1, 2][1.5:]",
    "'%s %s' % ('a',)",
    "'%s' % ()",
    "'%z' % 1",
    "'%d' % 1.9",
    "'%i' % 2.5",
    "'%g' % 0.00001",
    "'%e' % 12345.678",
    "'%05d' % 42",
    "'%+d' % 5",
    "'%x' % 255",
    "'%c' % 65",
    "'%%' % ()",
    "'%s' % None",
    "'%r' % 'a'",
    "'%d' % True",
    "'%s' % 1e-7",
    "'%.0f' % 0.5",
    "'%.0f' % 1.5",
    "'a' % 1",
    "'%(a)s' % 1",
    "'%(b)s' % dict(a=1)",
    "5 % '%d'",
    "True and 'a' or 'b'",
    "1 < 2 == True",
    "not 1 in [2]",
    "-1 ** 2",
    "2 * -3",
    "7 // -2",
    "-7 % -3",
    "7.5 // 2",
    "-7.5 % 2",
    "1e308 * 10",
    "2 ** 0",
    "0 ** 0",
    "0.0 ** 0",
    "1 / 3 * 3",
    "10 % 3.5",
    "1 // 1.0",
    "True + True",
    "True / 2",
    "5 & 2.0",
    "1 << 2.0",
    "'a' and 1",
    "[] or 'b'",
    "None or 0",
    "1 if [] else 2",
    "python.hash('a')",
    "python.type(1)",
    "python.vars",
    "math.sin",
    "python.len",
    "python.issubclass(python.int, python.int)",
)

# What no public robot uses: it shows an address in memory, changes values in place, or is a rare function, method or operator.
_BEYOND = {
    "1 is 1", "1 is not 1", "'a\\tb'.expandtabs(4)", "xacro.arg('missing')",
    "sin", "len", "range(3)", "reversed([1, 2])", "enumerate(['a'])", "(x for x in [1])", "python.enumerate([1])", "python.map(str, [1])", "'abc'.nothing", "math", "abs",
    "python.hash('a')", "python.type(1)", "python.vars", "math.sin", "python.len", "python.issubclass(python.int, python.int)", "1j", "(-1) ** 0.5", "(-8) ** (1/3)", "...",
    "1 @ 2", "(1).real", "(5).bit_length()", "1.5.is_integer()", "(0.5).as_integer_ratio()", "(5.0).hex()", "5 .numerator", "'abc'.encode()", "dict(a=1, b=2).keys()", "dict(a=1).items()",
    "dict(a=1).values()", "[1].append(2)", "[1, 2, 3].pop()", "['b', 'a'].sort()", "[1, 2].reverse()", "[1, 2].copy()", "dict(a=1).pop('a')", "dict(a=1).update(b=2)", "list(map(lambda x: x + 1, [1, 2]))",
    "max([1, 2], key=lambda v: -v)", "(lambda x: x + 1)(2)", "(lambda: 5)()", "(y := 5)", "math.pi.real", "math['pi']", "python.range(3)", "python.set([1])", "python.complex(1, 2)", "python.frozenset([1])",
    "python.slice(1)", "sin(*[0])", "max(*[1, 2])", "dict(**dict(a=1))", "python.isinstance(1, python.int)", "python.isinstance('a', python.str)", "str(1, 2)", "dict(a=1).a", "'abc'.nothing()",
    "'abc'()", "python.repr('a')", "[*[1, 2], 3]", "list(x for x in [1])", "len([map(int, ['a'])])", "list(map(int, ['a']))",
    "~5", "1 << 4", "256 >> 2", "6 & 3", "6 | 1", "6 ^ 3", "~1.5", "1 << -1", "5 & 2.0", "1 << 2.0", "'5'.zfill(3)", "'a'.rjust(3)",
    "'a'.ljust(3) + '|'", "'a'.center(3)", "'a'.center()", "'a'.zfill('a')", "'a-b'.partition('-')", "'abc'.swapcase()",
    "'abc'.isalpha()", "'abc'.removeprefix('a')", "'abc'.removesuffix('c')", "'a'.casefold()", "[1, 2].index(2)", "[1, 2].count(1)",
    "[1].index(2)", "[1].index()", "python.tuple([1])", "python.any([1])", "python.all([1])", "list(python.enumerate(['a']))",
    "list(python.zip([1], [2]))", "list(python.reversed([1, 2]))", "python.divmod(7, 2)", "list(python.filter(None, [0, 1]))",
}  # fmt: skip
_BEYOND_USES = {"width.real", "width . real", "n.bit_length()", "name.nothing", "width(2)", "width is length"}

_VALUES = (
    named("width", "0.4")
    + named("length", "0.6")
    + named("name", "base")
    + named("xyz", "0 0 0.1")
    + named("n", "3")
    + named("flag", "true")
    + named("sizes", "${[0.1, 0.2]}")
    + named("table", "${dict(left=1, right=-1)}")
)
_USES = (
    "width / 2", "-width/2", "width*length", "(width + length) / 2", "width**2", "1/12*n*(width**2+length**2)", "name + '_link'", "xyz.split()[2]", "float(xyz.split()[2]) + width", "xyz.split()[2] + 1", "n * 2", "n / 2", "n // 2", "'a' * n", "range(n)[1]", "flag", "not flag", "flag and n",
    "sizes[0] + sizes[1]", "sum(sizes)", "len(sizes)", "table['left'] * width", "table['up']", "table.get('up', 0)", "name[0]", "name.upper()", "width if flag else length", "name == 'base'", "width + 'a'", "name + width", "name * 2", "str(width) + name", "Width", "width length", "width.real", "name.nothing",
    "[width * i for i in range(n)]", "[s * n for s in sizes]", "max(width, length)", "round(width / 3, 4)", "width < length", "width == 0.4", "n == 3", "n == '3'", "int(width * 100)", "'%.2f' % width", "'{}'.format(width)", "'{:.2f}'.format(width)", "'{0}_{1}'.format(name, n)", "f'{width}'", "width * -1", "width - - 1",
    "sizes[n]", "sizes[-1]", "name[n]", "xyz[0]", "xyz.split(' ')", "table", "sizes", "sqrt(width**2 + length**2)", "atan2(width, length)", "radians(n * 10)", "width*.5", "2width", "width(2)", "width . real", "n.bit_length()", "xyz + ' 1'", "xyz * 2", "name in ['base', 'arm']", "width is length", "flag == True", "flag == 'true'",
)  # fmt: skip

_FORMATTED = named("f", "{}") + named("g", "{:.2f}") + named("h", "{0}_{1}") + named("k", "{a}")
_FORMATS = (
    "f.format(1.50)",
    "g.format(1.005)",
    "h.format('a', 1)",
    "k.format(a=2)",
    "f.format()",
    "g.format('a')",
    "f.format(1, 2)",
)


def _marked(listed: tuple[str, ...], beyond: set[str], before: str = "") -> Documents:
    assert not beyond - set(listed)
    return merged(
        expressions((text for text in listed if text not in beyond), before),
        expressions((text for text in listed if text in beyond), before, "perhaps"),
    )


_ONLY_OF_PYTHON = (
    "range(2**70)[1]", "len(range(2**70)[:9])", "len([k for k in math.keys()])", "len(list(math))", "math.get('pi')", "'pi' in math", "len(math)", "1 if math else 2",
)  # fmt: skip

DOCUMENTS: Documents = merged(
    _marked(_ARITHMETIC + _COMPARISON + _STRINGS + _LISTS + _FUNCTIONS + _MORE, _BEYOND),
    _marked(_USES, _BEYOND_USES, _VALUES),
    expressions(_FORMATS, _FORMATTED, "perhaps"),
    expressions(_ONLY_OF_PYTHON, undetermined="perhaps"),
)
