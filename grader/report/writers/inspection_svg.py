"""The drawing of an inspected robot as an SVG file."""

from grader.report.drawing.picture import plain_picture
from grader.report.drawing.three_views import NO_PICTURE, drawing_file
from grader.report.inspection import Inspection, effect

_SEVERAL = "No picture: there are several robots; name one with --robot."


def inspection_svg(inspection: Inspection) -> str:
    """Return the drawing of an inspected robot as a file.

    Its joints are at the given positions.
    """
    title = inspection.path
    words = f"{inspection.path}: {effect(inspection)}"
    reason = NO_PICTURE if not inspection.robots else _SEVERAL
    robot = inspection.robot
    if not robot:
        return drawing_file(None, title, (words,), reason)
    words = f"{robot.path}: {effect(inspection)}"
    configuration = robot.configuration
    if configuration and configuration.positions:
        positions = configuration.positions.items()
        words += f"; {', '.join(f'{joint} = {position}' for joint, position in positions)}"
    title = (configuration.robot.name if configuration else "") or robot.path
    picture = plain_picture(configuration, robot.relative_to, robot.meshes)
    return drawing_file(picture, title, (words,), NO_PICTURE)
