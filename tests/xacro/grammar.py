"""Random documents: properties, macros, blocks, conditions, arguments, included files and YAML, sometimes with a defect."""

from dataclasses import dataclass
from random import Random
from xml.sax.saxutils import quoteattr

from tests.xacro.documents.document import Document, named, part, robot
from tests.xacro.random_expressions import Expressions, Names

_YAML = "radius: 0.1\nname: left\nsizes: [0.6, 0.4, 0.2]\ninner: {mass: 5, ok: true}\nangle: !degrees 90\n"


@dataclass
class Macro:
    """A macro that can be called: the kinds of its parameters, those with a default, the number of its blocks."""

    name: str
    parameters: dict[str, str]
    optional: set[str]
    blocks: int


def document(seed: int) -> Document:
    """Return the document of a seed: the same in every run."""
    return _Writer(Random(seed)).document()


class _Writer:
    def __init__(self, random: Random) -> None:
        self._random = random
        self._defect = 0.03 if random.random() < 0.15 else 0.0
        self._write = Expressions(random, self._defect)
        self._macros: list[Macro] = []
        self._names = Names()
        self._files: dict[str, str | bytes] = {}
        self._arguments: dict[str, str] = {}
        self._count = 0
        self._is_in_macro = False

    def document(self) -> Document:
        pieces = [self._piece(self._names) for _ in range(self._random.randint(3, 12))]
        body = "\n".join([*pieces, self._link(self._names), self._link(self._names)])
        return Document(robot(body), self._files, self._arguments)

    def _name(self, beginning: str) -> str:
        self._count += 1
        return f"{beginning}{self._count}"

    def _maybe(self, probability: float) -> bool:
        return self._random.random() < probability

    def _piece(self, names: Names, depth: int = 2) -> str:
        """Return one of all things that can stand in a robot; definitions add to the names."""
        pieces = [self._link, self._property, self._property, self._property, self._call, self._call]
        pieces += [self._comment, self._argument, self._element, self._block]
        if depth > 0:
            pieces += [
                lambda names: self._condition(names, depth),
                lambda names: self._macro(names, depth),
                self._include,
                self._yaml,
            ]
        return self._random.choice(pieces)(names)

    def _inside(self, names: Names, depth: int, number: int) -> list[str]:
        """Return pieces whose definitions may be unknown after them."""
        macros = list(self._macros)
        pieces = [self._piece(names, depth) for _ in range(number)]
        self._macros = macros
        return pieces

    def _value(self, names: Names, kind: str) -> str:
        """Return the text of an attribute, or of a parameter, whose value is of a kind."""
        match kind:
            case "numbers" if self._maybe(0.3):
                return self._random.choice(
                    ("0.1", "5", " 2 ", "1e-2", "-.5", "01", "+3", "1_0" if self._defect else "4.0")
                )
            case "numbers":
                return f"${{{self._write.number(names)}}}"
            case "texts" if self._maybe(0.4):
                return self._random.choice(
                    ("wheel", "base link", "'quoted'", "0 0 ${1 + 1}", "$${kept}", "a_${2 * 3}", "'5'x", "$5 off")
                )
            case "texts":
                return f"${{{self._write.text(names)}}}"
            case "lists":
                return f"${{{self._write.values(names)}}}"
        return self._random.choice(("true", "false", "1", "0", f"${{{self._write.flag(names)}}}"))

    def _property(self, names: Names) -> str:
        kind = self._random.choice(("numbers", "numbers", "numbers", "texts", "lists", "flags"))
        known = getattr(names, kind)
        own = [name for name in known if name.isidentifier()] if self._maybe(0.15) else []
        name = self._random.choice(
            own or [self._name("p")]
        )  # a new value that is made of the old one is evaluated at once
        more = 'lazy_eval="false"' if own else self._random.choice(("", "", "", 'lazy_eval="false"', 'scope="global"'))
        if not own and self._is_in_macro and self._maybe(0.3):
            more = 'scope="parent"'  # refused outside of macros
        text = named(name, self._value(names, kind), more)
        if name not in known:
            known.append(name)
        return text.replace(" value=", " default=", 1) if not more and self._maybe(0.1) else text

    def _block(self, names: Names) -> str:
        name = self._name("block_")
        block = f"<xacro:property name='{name}'><in x={quoteattr(self._value(names, 'numbers'))}/>{self._call(names)}</xacro:property>"
        return block + f"<out><xacro:insert_block name='{name}'/></out>" * self._random.randint(0, 2)

    def _link(self, names: Names) -> str:
        numbers = [f"${{{self._write.number(names)}}}" for _ in range(6)]
        name, joint = self._name("link_"), self._name("joint_")
        shape = self._random.choice(
            (
                f"box size={quoteattr(' '.join(numbers[:3]))}",
                f"cylinder radius={quoteattr(numbers[0])} length='1'",
                "sphere radius='1'",
            )
        )
        visual = f"<visual><origin xyz={quoteattr(' '.join(numbers[3:]))}/><geometry><{shape}/></geometry></visual>"
        note = f"<note text={quoteattr(self._value(names, 'texts'))}>{self._random.choice(('', 'a ${1 + 1} b', '$${c}'))}</note>"
        joined = (
            f'<joint name="{joint}" type="fixed"><parent link="base"/><child link="{name}"/>'
            f"<origin rpy={quoteattr(f'0 {numbers[5]} 0')}/></joint>"
        )
        return f'<link name="{name}">{visual}{note if self._maybe(0.4) else ""}</link>{joined}'

    def _condition(self, names: Names, depth: int) -> str:
        tag = self._random.choice(("if", "unless"))
        content = "".join(self._inside(names.inner(), depth - 1, self._random.randint(0, 3)))
        value = "maybe" if self._maybe(self._defect) else self._value(names, "flags")
        return f"<xacro:{tag} value={quoteattr(value)}>{content}</xacro:{tag}>"

    def _macro(self, names: Names, depth: int) -> str:
        kinds = self._random.choices(("numbers", "numbers", "texts", "flags", "lists"), k=self._random.randint(0, 3))
        macro = Macro(
            self._name("m"), {self._name("a"): kind for kind in kinds}, set(), self._random.choice((0, 0, 0, 1, 2))
        )
        specified = [self._parameter(macro, name, names) for name in macro.parameters]
        blocks = [(self._random.choice(("*", "**")), self._name("b")) for _ in range(macro.blocks)]
        specified += [stars + name for stars, name in blocks]
        inner = names.inner()
        for name, kind in macro.parameters.items():
            getattr(inner, kind).append(name)
        outside, self._is_in_macro = self._is_in_macro, True
        content = self._inside(inner, depth - 1, self._random.randint(1, 3))
        self._is_in_macro = outside
        content += [f'<group><xacro:insert_block name="{name}"/></group>' for _, name in blocks if self._maybe(0.9)]
        self._macros.append(macro)
        params = quoteattr(self._random.choice((" ", "  ", " \t")).join(specified)).replace("&#9;", "\n")
        return f"<xacro:macro name='{macro.name}' params={params}>{''.join(content)}</xacro:macro>"

    def _parameter(self, macro: Macro, name: str, names: Names) -> str:
        if self._maybe(0.6):
            return name
        macro.optional.add(name)
        kind = macro.parameters[name]
        plain = {"numbers": "0.5", "texts": "'a b'", "flags": "true", "lists": "${[1, 2]}"}[kind]
        expression = f"${{{self._write.number(names, 1)}}}" if kind == "numbers" else plain
        return name + self._random.choice(("=", ":=")) + self._random.choice((plain, expression, f"^|{plain}"))

    def _call(self, names: Names) -> str:
        if not self._macros:
            return "<xacro:nothing/>" if self._maybe(self._defect) else "<plain/>"
        macro = self._random.choice(self._macros)
        given = {
            name: kind for name, kind in macro.parameters.items() if name not in macro.optional or self._maybe(0.5)
        }
        if given and self._maybe(self._defect):
            given.pop(next(iter(given)))
        attributes = " ".join(f"{name}={quoteattr(self._value(names, kind))}" for name, kind in given.items())
        blocks = "".join(
            f"<block x={quoteattr(self._value(names, 'numbers'))}><in/></block>" for _ in range(macro.blocks)
        )
        if self._maybe(0.15):
            return f'<xacro:call macro="{macro.name}" {attributes}>{blocks}</xacro:call>'
        return f"<xacro:{macro.name} {attributes}>{blocks}</xacro:{macro.name}>"

    def _argument(self, names: Names) -> str:
        name = self._name("arg")
        if self._maybe(0.3):
            self._arguments[name] = self._random.choice(("3", "0.25", "true", "some text"))
        declared = f"<xacro:arg name='{name}' default={quoteattr(self._value(names, 'numbers'))}/>"
        used = self._random.choice(
            ("$(arg {})", "a $(arg {}) b", "${{'$(arg {})' + '_x'}}", "$(eval {} == 3)", "${{xacro.arg('{}')}}")
        )
        return f"{declared}<used x={quoteattr(used.format(name))}/>"

    def _element(self, names: Names) -> str:
        attribute = (
            f"<xacro:attribute name='{self._name('k')}' value={quoteattr('v ' + self._value(names, 'numbers'))}/>"
        )
        return f'<xacro:element xacro:name="{self._random.choice(("e", "e_${1 + 1}"))}">{attribute}</xacro:element>'

    def _comment(self, names: Names) -> str:
        return f"<!-- ${{not evaluated}} -->{self._call(names)}"

    def _include(self, names: Names) -> str:
        path = self._name("part") + ".xacro"
        folder = self._random.choice(("urdf/", "urdf/parts/", "common/"))
        namespace = self._name("n") if self._maybe(0.3) else ""
        names_of_file = Names()
        content = "".join(self._property(names_of_file) for _ in range(self._random.randint(1, 3)))
        if self._maybe(0.5):
            content += self._macro(names_of_file, 0)
            macro = self._macros[-1]
            macro.name = f"{namespace}.{macro.name}".removeprefix(".")
        self._files[folder + path] = part(content + self._link(names_of_file))
        for kind in ("numbers", "texts", "lists", "flags"):
            found = [f"{namespace}.{name}" if namespace else name for name in getattr(names_of_file, kind)]
            getattr(names, kind).extend(found)
        way = {"urdf/": path, "urdf/parts/": f"parts/{path}", "common/": f"../common/{path}"}[folder]
        way = f"$(find my_robot)/{folder}{path}" if self._maybe(0.3) else way
        space = f' ns="{namespace}"' if namespace else ""
        return f'<xacro:include filename="{way}"{space}/>'

    def _yaml(self, names: Names) -> str:
        self._files["config/values.yaml"] = _YAML
        name = self._name("y")
        names.numbers += [f"{name}.radius", f"{name}['inner']['mass']", f"{name}.angle", f"{name}.sizes[1]"]
        names.texts.append(f"{name}.name")
        names.lists.append(f"{name}.sizes")
        names.flags.append(f"{name}.inner.ok")
        return named(name, "${xacro.load_yaml('../config/values.yaml')}")
