"""Files of learning management systems: a Canvas gradebook or a Moodle grading worksheet, filled with the totals."""
