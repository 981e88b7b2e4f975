"""Random documents: properties, macros, blocks, conditions, arguments, included files and YAML, sometimes with a defect."""

from dataclasses import dataclass
from random import Random
from xml.sax.saxutils import escape, quoteattr

from tests.xacro.documents.document import Document, part, robot
from tests.xacro.random_definitions import Definitions
from tests.xacro.random_expressions import Names


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


class _Writer(Definitions):
    def __init__(self, random: Random) -> None:
        super().__init__(random)
        self._macros: list[Macro] = []
        self._names = Names()

    def document(self) -> Document:
        pieces = [self._piece(self._names) for _ in range(self._random.randint(3, 12))]
        body = "\n".join(
            ['<link name="base"/>', *pieces, self._link(self._names), self._link(self._names)]
        )
        return Document(robot(body), self._files, self._arguments)

    def _piece(self, names: Names, depth: int = 2) -> str:
        """Return one of all things that can stand in a robot; definitions add to the names."""
        pieces = [
            self._link,
            self._property,
            self._property,
            self._property,
            self._call,
            self._call,
        ]
        pieces += [
            self._comment,
            self._argument,
            self._element,
            self._block,
            self._later,
            self._removed,
            self._text,
        ]
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

    def _block(self, names: Names) -> str:
        name = self._name("block_")
        block = f"<xacro:property name='{name}'><in x={quoteattr(self._value(names, 'numbers'))}/>{self._call(names)}</xacro:property>"
        return block + f"<out><xacro:insert_block name='{name}'/></out>" * self._random.randint(
            0, 2
        )

    def _text(self, names: Names) -> str:
        texts = [escape(self._value(names, kind)) for kind in ("texts", "lists", "numbers")]
        return f"<text>{texts[0]} and {texts[1]}<in/>{texts[2]}</text>"

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
        kinds = self._random.choices(
            ("numbers", "numbers", "texts", "flags", "lists"), k=self._random.randint(0, 3)
        )
        forwarded = [name for name in names.numbers if name.isidentifier() and self._maybe(0.2)][:1]
        parameters = {self._name("a"): kind for kind in kinds} | dict.fromkeys(forwarded, "numbers")
        name = self._name("m")
        if self._macros and self._maybe(0.1) and "." not in self._macros[-1].name:
            name = self._macros.pop().name
        macro = Macro(name, parameters, set(forwarded), self._random.choice((0, 0, 0, 1, 2)))
        specified = [self._parameter(macro, name, names) for name in macro.parameters]
        blocks = [(self._random.choice(("*", "**")), self._name("b")) for _ in range(macro.blocks)]
        specified += [stars + name for stars, name in blocks]
        inner = names.inner()
        for name, kind in macro.parameters.items():
            getattr(inner, kind).append(name)
        outside, self._is_in_macro = self._is_in_macro, True
        content = self._inside(inner, depth - 1, self._random.randint(1, 3))
        self._is_in_macro = outside
        content += [
            f'<group><xacro:insert_block name="{name}"/></group>'
            for _, name in blocks
            if self._maybe(0.9)
        ]
        self._macros.append(macro)
        params = quoteattr(self._random.choice((" ", "  ", " \t")).join(specified)).replace(
            "&#9;", "\n"
        )
        return f"<xacro:macro name='{macro.name}' params={params}>{''.join(content)}</xacro:macro>"

    def _parameter(self, macro: Macro, name: str, names: Names) -> str:
        if name in macro.optional:
            return name + ":=^"
        if self._maybe(0.6):
            return name
        macro.optional.add(name)
        kind = macro.parameters[name]
        plain = {"numbers": "0.5", "texts": "'a b'", "flags": "true", "lists": "${[1, 2]}"}[kind]
        expression = f"${{{self._write.number(names, 1)}}}" if kind == "numbers" else plain
        return (
            name
            + self._random.choice(("=", ":="))
            + self._random.choice((plain, expression, f"^|{plain}"))
        )

    def _call(self, names: Names) -> str:
        if not self._macros:
            return "<xacro:nothing/>" if self._maybe(self._defect) else "<plain/>"
        macro = self._random.choice(self._macros)
        given = {
            name: kind
            for name, kind in macro.parameters.items()
            if name not in macro.optional or self._maybe(0.5)
        }
        if given and self._maybe(self._defect):
            given.pop(next(iter(given)))
        attributes = " ".join(
            f"{name}={quoteattr(self._value(names, kind))}" for name, kind in given.items()
        )
        blocks = "".join(
            f"<block x={quoteattr(self._value(names, 'numbers'))}><in/></block>"
            for _ in range(macro.blocks)
        )
        if self._maybe(0.15):
            return f'<xacro:call macro="{macro.name}" {attributes}>{blocks}</xacro:call>'
        return f"<xacro:{macro.name} {attributes}>{blocks}</xacro:{macro.name}>"

    def _element(self, names: Names) -> str:
        value = quoteattr("v " + self._value(names, "numbers"))
        return f'<xacro:element xacro:name="{self._random.choice(("e", "e_${1 + 1}"))}" k={value}/>'

    def _comment(self, names: Names) -> str:
        return f"<!-- ${{not evaluated}} -->{self._call(names)}"

    def _include(self, names: Names) -> str:
        path = self._name("part") + ".xacro"
        folder = self._random.choice(("urdf/", "urdf/parts/", "common/"))
        names_of_file = Names()
        content = "".join(self._property(names_of_file) for _ in range(self._random.randint(1, 3)))
        if self._maybe(0.5):
            content += self._macro(names_of_file, 0)
        self._files[folder + path] = part(content + self._link(names_of_file))
        for kind in ("numbers", "texts", "lists", "flags"):
            getattr(names, kind).extend(getattr(names_of_file, kind))
        way = {"urdf/": path, "urdf/parts/": f"parts/{path}", "common/": f"../common/{path}"}[
            folder
        ]
        way = f"$(find my_robot)/{folder}{path}" if self._maybe(0.3) else way
        return f'<xacro:include filename="{way}"/>'
