"""A page about one robot, with three views of it, for each report and inspection."""

from collections.abc import Mapping
from typing import Any

from markupsafe import Markup

from grader.report.drawing.picture import Picture
from grader.report.drawing.space import space_data
from grader.report.drawing.three_views import STYLE, callout_lines, drawing_element
from grader.report.pages.shell import SPACE_SCRIPTS, Assets, render_page
from grader.report.pages.viewing import SCRIPT, SOURCES, STYLES, Viewing
from grader.ros.api import Mesh


def render_robot_page(
    template: str,
    values: Mapping[str, object],
    picture: Picture | None,
    assets: Assets,
    cards: Mapping[str, str],
    viewing: Viewing | None,
) -> str:
    """Return a page about the robot of a picture, if there is one.

    `cards` are the entries of its criteria.
    """
    drawn = ""
    space: dict[str, Any] | None = None
    legend: list[Any] = []
    if picture:
        drawn = drawing_element(picture, legend=False)
        meshes: Mapping[Mesh, str] = {}
        if viewing:
            picture, meshes = viewing.with_meshes(picture)
        space = space_data(picture, cards, meshes)
        if viewing and viewing.playback is not None and space is not None:
            space["playback"] = viewing.playback.data(picture.scene.robot)
        legend = callout_lines(picture)
    views = Markup(drawn)  # noqa: S704  an element, whose text is escaped
    shown = {"picture": picture, "views": views, "legend": legend, "has_space": space is not None}
    data: dict[str, Any] = {"robot": space} if space is not None else {}
    scripts = assets.scripts
    rules = STYLE
    styles = f"text.css robot.css student.css {assets.styles}"
    if viewing:  # the same for each version: the policy of a page stays
        scripts = f"{scripts} {SPACE_SCRIPTS} {SCRIPT}"
        styles = f"{styles} {STYLES}"
        assets = assets._replace(sources=SOURCES)
        data["view"] = viewing.data
    elif space is not None:
        scripts = f"{scripts} {SPACE_SCRIPTS}"
    if not drawn and not viewing:
        rules = ""
    assets = assets._replace(scripts=scripts, styles=styles, rules=rules)
    return render_page(template, {**values, **shown, "viewing": viewing}, data, assets)
