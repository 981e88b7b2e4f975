"""The tree of links: roots, cycles, second parents."""

from itertools import pairwise

from tests.robot.edge_cases.case import EdgeCase, clean, degraded, joint, links, rejected, robot

_ONE = "one root"
_TWO = "two roots"
_NONE = "no root"
_DETACHED = "what hangs on a detached cycle is left out"
_REACHED = "a cycle that the root reaches is followed without end"
_PARENTS = "a link may have two parents"
_WAYS = "a link is walked once for each way to it"
_DEEP = "a tree may be deep or wide"


def _tree(*joints: str, extra: str = "") -> str:
    """Return a robot of joints written `ab`, for one from a to b, and named in this order; `extra` names more links."""
    names = "".join(dict.fromkeys("".join(joints) + extra))
    return robot(links(*names) + "".join(joint(ends[0], ends[1], f"j{index}") for index, ends in enumerate(joints)))


def _chain(length: int) -> str:
    names = [f"l{index}" for index in range(length)]
    ends = pairwise(names)
    return robot(links(*names) + "".join(joint(parent, child, f"j{child}") for parent, child in ends))


def _diamonds(count: int) -> str:
    names = [chr(ord("a") + index) for index in range(count + 1)]
    return _tree(*(f"{parent}{child}" for parent, child in pairwise(names) for _ in range(2)))


CASES: tuple[EdgeCase, ...] = (
    clean("tree-chain", _ONE, _tree("ab", "bc", "cd")),
    clean("tree-chain-of-300", _DEEP, _chain(300)),
    rejected("roots-two", _TWO, robot(links("a", "b"))),
    rejected("roots-two-trees", _TWO, _tree("ab", "cd")),
    rejected("roots-ends-swapped", _TWO, _tree("ab", "cb")),
    rejected("roots-two-and-detached-cycle", _TWO, _tree("cd", "dc", extra="ab")),
    rejected("roots-none-self-joint", _NONE, _tree("aa")),
    degraded("detached-self-joint", _DETACHED, _tree("bb", extra="a")),
    degraded("detached-cycle-beside-tree", _DETACHED, _tree("ab", "ac", "de", "ed")),
    degraded("detached-cycles-joined", _DETACHED, _tree("bc", "cb", "cd", "de", "ed", extra="a")),
    degraded("detached-cycle-leads-into-tree", _DETACHED, _tree("ad", "bc", "cb", "bd")),
    rejected("reached-self-joint-on-leaf", _REACHED, _tree("ab", "bb"), "hangs"),
    rejected("reached-self-joint-in-middle", _REACHED, _tree("ab", "bb", "bc"), "hangs"),
    rejected("reached-cycle-at-far-end", _REACHED, _tree("ab", "bc", "cd", "de", "ef", "fe"), "hangs"),
    rejected("reached-cycle-and-detached-cycle", _REACHED, _tree("ab", "bb", "cd", "dc"), "hangs"),
    rejected(
        "reached-cycle-with-bad-visual", _REACHED, _tree("ab", "bb").replace("/>", "><visual/></link>", 1), "hangs"
    ),
    clean("parents-two", _PARENTS, _tree("ab", "ac", "bd", "cd")),
    clean("parents-two-joints-between-two-links", _PARENTS, _tree("ab", "ab")),
    clean("parents-ten-diamonds", _WAYS, _diamonds(10)),
    rejected("parents-28-diamonds", _WAYS, _diamonds(28), "hangs"),
)
