"""Results, marks, roster and deadlines as the grade of each student."""
