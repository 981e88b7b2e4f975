"""Checks of the colour in which a link is shown."""

from grader.checks.check import About
from grader.checks.outcome import SLACK, Outcome, failed, judged, place, point, within
from grader.checks.toml_types import Colour, NonNegative
from grader.checks.visuals import VISIBLE, ShapeName, all_within, main_visual
from grader.errors import NotDecided
from grader.robot.kinematics import Configuration
from grader.robot.model import Material, Visual

ABOUT = {
    "shows_colour": About(("material",)),
    "shows_grey": About(("material",)),
}


def shows_colour(
    robot: Configuration, *, link: str, colour: Colour, tolerance: NonNegative, shape: ShapeName = "any"
) -> Outcome:
    """A link is shown in a colour: red, green, blue and, if a fourth channel is given, opacity, each from 0 to 1.

    With an opacity below 0.01 it is invisible, which is never correct, unless the fourth channel demands it.

    Args:
        link: The link that is examined.
        colour: Red, green, blue and, if it is to be checked, opacity, each from 0 to 1.
        tolerance: How far each channel may be off, on the scale from 0 to 1.
        shape: Which of several visuals counts: the largest of this shape or, without one, the largest of all.
    """
    visual = main_visual(robot, link, shape)
    if visual.material is None or _has_only_texture(visual.material):
        return _colourless(link, visual)
    actual = visual.material.rgba[: len(colour)]
    fine = all_within(actual, colour, tolerance)
    message = f"{link!r} is shown in {'rgba' if len(colour) == 4 else 'rgb'} {point(actual)}"
    if not fine:
        message += f"; it should be {point(colour)}"
    is_wanted = len(colour) == 4 and colour[3] < VISIBLE
    invisible = "" if is_wanted else _invisible(visual.material)
    return judged(
        fine and not invisible,
        message + invisible,
        actual,
        colour,
        tolerance,
        at=place(visual.material.location, "rgba"),
    )


def shows_grey(robot: Configuration, *, link: str, at_least: float, tolerance: NonNegative) -> Outcome:
    """A link is shown in a grey (red = green = blue) of at least the given level, from 0 to 1, and not invisible.

    Below 0.01, the opacity makes it invisible; otherwise opacity is not checked.

    Args:
        link: The link that is examined.
        at_least: The darkest grey that passes, from 0 (black) to 1 (white).
        tolerance: How far red, green and blue may be apart, on the scale from 0 to 1.
    """
    visual = main_visual(robot, link)
    if visual.material is None or _has_only_texture(visual.material):
        return _colourless(link, visual)
    actual = visual.material.rgba[:3]
    message = f"{link!r} is shown in rgb {point(actual)}"
    is_grey = within(max(actual), min(actual), tolerance)
    is_light = min(actual) >= at_least - SLACK
    if not is_grey:
        message += ", which is not grey; red, green and blue should be equal"
    elif not is_light:
        message += f"; each should be at least {at_least:g}"
    invisible, at = _invisible(visual.material), place(visual.material.location, "rgba")
    return judged(is_grey and is_light and not invisible, message + invisible, actual, at_least, tolerance, at=at)


def _invisible(material: Material) -> str:
    """Return the end of a message on a colour that nobody sees; empty for one that shows."""
    alpha = material.rgba[3]
    return (
        "" if alpha >= VISIBLE else f"; its alpha is {alpha:g}, so it is invisible; it should be at least {VISIBLE:g}"
    )


def _has_only_texture(material: Material) -> bool:
    # ROS 2 gives a material black where it has a texture and no colour.
    return material.rgba == Material("").rgba and material.texture != ""


def _colourless(link: str, visual: Visual) -> Outcome:
    if visual.material is not None:
        raise NotDecided(f"{link!r} is shown with a texture, which the grader does not open", "textures are not opened")
    if visual.has_unreadable_colour:
        at = place(visual.location, None, "material")
        return failed(f"{link!r} has no colour: ROS 2 cannot read that of its material {visual.material_name!r}", at)
    if visual.material_name:
        message = f"{link!r} has no colour: the material {visual.material_name!r} is not defined here"
        at = place(visual.location, "name", "material")
        return failed(message, at, mistake=f"{link!r} has no colour: its material is not defined")
    return failed(f"{link!r} has no material, so RViz shows it in its default colour, red", place(visual.location))
