"""Plugins of Nav2 that a parameter file configures: whether a list of the node names them."""

from grader.base.text import quoted
from grader.ros.config.yaml_nodes import YamlNode
from grader.workspace.model.workspace import Workspace
from grader.workspace.rules.names import (
    Facts,
    Mismatches,
    warning,
)
from grader.workspace.rules.rule_table import (
    NO_EFFECT,
    Rule,
)

_COSTMAPS = ("global_costmap", "local_costmap")
_LISTS = ("plugins", "filters")
_COPIED = ("local_costmap", "static_layer")


def listed_plugin_facts(workspace: Workspace) -> Facts:
    """Yield the layers of costmaps that are configured, and that no list of plugins names.

    The parameters of nav2_bringup, which many copy, have a static layer in the local costmap.
    """
    for keys, section in workspace.installed.sections:
        if keys and keys[-1] in _COSTMAPS:
            yield from _unlisted(keys[-1], section)


_PLUGIN_LISTED = Rule(
    "plugin-listed",
    "parameters",
    NO_EFFECT,
    "A list of plugins names each layer that is configured.",
    why=(
        "The costmap loads only listed layers and does not report others. Without "
        "inflation_layer, for example, paths run close to obstacles."
    ),
    wrong="""
global_costmap:
  global_costmap:
    ros__parameters:
      plugins: [static_layer]
      static_layer: {plugin: "nav2_costmap_2d::StaticLayer"}
      inflation_layer: {plugin: "nav2_costmap_2d::InflationLayer"}
""",
    right="""
global_costmap:
  global_costmap:
    ros__parameters:
      plugins: [static_layer, inflation_layer]
      static_layer: {plugin: "nav2_costmap_2d::StaticLayer"}
      inflation_layer: {plugin: "nav2_costmap_2d::InflationLayer"}
""",
    frame="nav/costmap.yaml",
)


def _unlisted(costmap: str, section: YamlNode) -> Mismatches:
    """Yield the sections with a plugin that is in no list of a costmap."""
    plugins = section.get("plugins")
    if not plugins or not plugins.items:
        return
    listed = set()
    for key in _LISTS:
        names = section.get(key)
        listed |= {name.text for name in (names.items if names else ())}
    for name, inner in section.pairs:
        kind = inner.get("plugin")
        is_copied = (costmap, name) == _COPIED
        if kind and name not in listed and not is_copied:
            message = f"the {costmap} does not use {quoted(name)}: its plugins do not name it"
            yield warning(_PLUGIN_LISTED, message, kind.location, plugins.location)
