"""Every kind of problem that files have."""

from grader.base.ignore_comments import COMMENT_CATALOGUE
from grader.ros.installation.package_problems import PACKAGE_CATALOGUE
from grader.ros.urdf.urdf_problems import CATALOGUE
from grader.ros.xacro.xacro_problems import XACRO_CATALOGUE
from grader.workspace.rules.rule_table import NAME_CATALOGUE

# The kinds of the problems that any file may have, by which they are explained and selected.
EVERY_KIND = (*CATALOGUE, *XACRO_CATALOGUE, *PACKAGE_CATALOGUE, *NAME_CATALOGUE, *COMMENT_CATALOGUE)
