"""The files of a learning management system: a gradebook of Canvas, a grading worksheet of Moodle, filled with our totals."""
