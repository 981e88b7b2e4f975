"""Read a class of Lab 6, whose folders have the name of the lab."""

from functools import partial

from grader.classroom.intake import reading

read_class = partial(reading.read_class, rubric_id="lab6")
