"""The modules that worker processes start with, which grade submissions and write reports."""

# Late imports included; the last one loads the checks.
PRELOAD = (
    "grader.classroom.run.batch_worker",
    "grader.ros.urdf.edge_overlap",
    "grader.lab.submission.selection",
    "grader.ros.package.found_problems",
    "grader.classroom.run.fork_server",
)
