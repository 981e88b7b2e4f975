"""Which names of nodes, topics, services and actions ROS 2 accepts.

The rules are those of rmw/src/validate_node_name.c, rcl/src/rcl/validate_topic_name.c and rmw/src/
validate_full_topic_name.c, which are asked before a name is remapped.
"""

from grader.base.patterns import on_use

_NODE_NAME = on_use(r"[A-Za-z_][A-Za-z0-9_]*")
_REFUSED = on_use(r"[^A-Za-z0-9_/~{}]")


def is_node_name(name: str) -> bool:
    """Return whether a node may have a name.

    >>> is_node_name("wall_finder"), is_node_name("wall-finder")
    (True, False)
    """
    return _NODE_NAME.fullmatch(name) is not None


def why_no_topic(name: str) -> str:
    """Return why a topic, service or action cannot have a name, as it is written; empty if it can.

    >>> why_no_topic("cmd vel")
    'use letters, digits, _ and /'
    >>> why_no_topic("~/{node}/cmd_vel")
    ''
    """
    if _REFUSED.search(name):
        return "use letters, digits, _ and /"
    if name.endswith("/") or "//" in name:
        return "a / is followed by a name"
    if any(part[:1].isdigit() for part in name.split("/")):
        return "no part of it begins with a digit"
    if "~" in name[1:] or (name.startswith("~") and name[1:2] not in ("", "/")):
        return "a ~ is its first character, and a / follows"
    return ""
